// Where pelvis and legs are in every frame of a motion.
#pragma once
#include <array>
#include <vector>

#include "motion/motion.h"

namespace gaitpad {

struct LegTrack {
  std::vector<vec3> hip_m, knee_m, ankle_m, toe_m;
};
struct BodyTrack {
  std::vector<vec3> pelvis_m;
  std::vector<double> heading_rad;  // where the hips face, unwrapped
  std::array<LegTrack, 2> leg;
  double leg_m = 0.0;  // thigh + shank, mean of both sides
};
BodyTrack body_track(const Motion& motion);

// Frames [first, last] without a jump: no point of the body moves faster than a limb can.
struct FrameRange {
  int first, last;
};
std::vector<FrameRange> unbroken_ranges(const BodyTrack& track, double frame_time_s);

}  // namespace gaitpad
