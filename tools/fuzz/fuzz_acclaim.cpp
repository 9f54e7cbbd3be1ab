// libFuzzer target: a skeleton (ASF), a line of ----, a motion (AMC) through readers and loader.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gaitpad/flight.h"
#include "gaitpad/motion_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaitpad;
  constexpr std::string_view kCut = "\n----\n";
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = text.find(kCut);
  const bool has_motion = cut != text.npos;
  const NamedText asf{"fuzz.asf", text.substr(0, cut)};
  const NamedText amc{has_motion ? "fuzz.amc" : "",
                      has_motion ? text.substr(cut + kCut.size()) : ""};
  const auto motion = motion_from_acclaim(asf, amc);
  if (!motion) {
    if (motion.error().message.find('\n') != std::string::npos) std::abort();
    return 0;
  }
  const auto finite = [](double v) { return v - v == 0.0; };
  for (const auto& frame : motion->frames) {
    if (!finite(frame.root_m.x + frame.root_m.y + frame.root_m.z)) std::abort();
    for (const auto& q : frame.local) {
      if (!finite(q.w + q.x + q.y + q.z)) std::abort();
    }
  }
  for (const Side side : {kLeftSide, kRightSide}) (void)robust_flight(*motion, side);
  return 0;
}
