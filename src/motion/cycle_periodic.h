// A stride of a motion as a periodic function of its phase: straightened, standing still, seam
// closed.
#pragma once
#include <array>
#include <vector>

#include "motion/cycle_stride.h"

namespace gaitpad {

inline constexpr int kHarmonics = 16;

// mean + sum of a cos 2 pi k p + b sin 2 pi k p, k = 1 .. kHarmonics.
struct Fourier {
  double mean = 0.0;
  std::array<double, kHarmonics> a{}, b{};
};

// Rotations are rotation vectors from each joint's mean, so that every channel is a plain number.
struct PeriodicMotion {
  double duration_s = 0.0, stride_m = 0.0;
  std::vector<quat> mean;                        // a joint; joint 0 in the travel frame
  std::vector<std::array<Fourier, 3>> rotation;  // a joint
  std::array<Fourier, 3> pelvis_m;               // travel frame, x and z without their means
};
PeriodicMotion periodic_motion(const Motion& motion, const StrideWindow& window);

struct PeriodicPose {
  vec3 pelvis_m{0.0};
  std::vector<quat> local;
};
PeriodicPose pose_at(const PeriodicMotion& motion, double phase);

}  // namespace gaitpad
