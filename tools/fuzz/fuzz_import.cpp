// libFuzzer target: a calibration of another tool, for pads of 8 and of 16 bits. An accepted
// calibration can be saved and loaded.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "stick/calibration_import.h"
#include "tools/fuzz/made_pads.h"

namespace {

struct Pad {
  gaitpad::DeviceInfo device;
  gaitpad::PadLayout layout;
};

Pad made_pad(std::int32_t min, std::int32_t max) {
  Pad pad;
  pad.device = gaitpad::made_evdev_pad(min, max);
  auto layout = gaitpad::pad_layout(pad.device, {});
  if (!layout) std::abort();
  pad.layout = std::move(*layout);
  return pad;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Pad pads[] = {made_pad(0, 255), made_pad(-32768, 32767)};
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Pad& pad : pads) {
    const auto file = gaitpad::calibration_import(text, "fuzz", pad.device, pad.layout);
    if (!file) continue;
    const auto back = gaitpad::parse_calibration(gaitpad::calibration_text(*file), "again.toml");
    if (!back) std::abort();
    const gaitpad::vec2 p = gaitpad::stick_position(file->calibration.left, {0.5, 0.5});
    if (!(p.x * p.x + p.y * p.y < 1.0 + 1e-9)) std::abort();
  }
  return 0;
}
