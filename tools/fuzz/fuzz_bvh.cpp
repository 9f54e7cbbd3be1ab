// libFuzzer target: any text through the BVH reader, the loader, the flight rules and the writer.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "gaitpad/bvh.h"
#include "gaitpad/flight.h"
#include "gaitpad/motion_file.h"

namespace {

bool is_finite(const gaitpad::Motion& motion) {
  const auto finite = [](double v) { return v - v == 0.0; };
  for (const auto& frame : motion.frames) {
    if (!finite(frame.root_m.x + frame.root_m.y + frame.root_m.z)) return false;
    for (const auto& q : frame.local) {
      if (!finite(q.w + q.x + q.y + q.z)) return false;
    }
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaitpad;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto motion = motion_from_bvh(text, "fuzz.bvh");
  if (!motion) return 0;
  if (!is_finite(*motion)) std::abort();
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const Swing& s : swings(*motion, side)) {
      if (s.heel_off < 0 || s.heel_off > s.lift || s.lift > s.peak || s.peak > s.land) std::abort();
    }
    (void)robust_flight(*motion, side);
    (void)paper_flight(*motion, side);
  }
  std::stringstream out;
  BvhLayout layout;
  layout.metres_per_unit = motion->metres_per_unit;
  layout.frame_time_s = motion->frame_time_s;
  layout.orders = euler_orders(motion->skeleton, motion->frames[0].local);
  BvhWriter writer(out, motion->skeleton, layout);
  Pose pose;
  pose.joint_count = static_cast<int>(motion->skeleton.joints.size());
  pose.root_m = motion->frames[0].root_m;
  std::ranges::copy(motion->frames[0].local, pose.local.begin());
  writer.write(pose);
  if (!writer.finish()) std::abort();
  (void)parse_bvh(out.str(), "out.bvh");
  return 0;
}
