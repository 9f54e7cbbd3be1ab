// Makes a gait cycle from a captured stride in three steps: the stride becomes a periodic function
// of its phase (straight, without its travel, without a seam); the function is sampled as poses;
// and from these the standing pose and the angles of the legs are measured.
#pragma once
#include <array>
#include <vector>

#include "gaitpad/gait_cycle.h"
#include "motion/stride.h"

namespace gaitpad {

inline constexpr int kStrideHarmonics = 16;  // harmonics of a periodic stride

// mean + sum of a cos 2 pi k p + b sin 2 pi k p, k = 1 .. kStrideHarmonics, at phase p.
struct Fourier {
  vec3 mean{0.0};
  std::array<vec3, kStrideHarmonics> a{}, b{};
};

// Rotations are rotation vectors from each joint's mean, so that every channel is a plain vector.
struct PeriodicMotion {
  double duration_s = 0.0, stride_m = 0.0;
  std::vector<quat> mean;         // mean rotation of each joint; joint 0 in the travel frame
  std::vector<Fourier> rotation;  // harmonics of each joint's rotation vector
  Fourier pelvis_m;  // harmonics of its place in the travel frame, x and z without their means
};
PeriodicMotion periodic_motion(const Motion& motion, const StrideWindow& window);

struct CapturedLeg {  // one leg: rotations of joint frames in the travel frame
  std::vector<vec3> knee_m, ankle_m, toe_m, hip_m;
  std::vector<quat> hip, above_knee, knee, ankle, toe;  // above_knee: the knee's parent
};
// The periodic stride as kCycleSamples poses.
struct CapturedCycle {
  Skeleton skeleton;  // the skeleton with its root at the pelvis, as in GaitCycle
  int pelvis = 0;
  std::array<LegJoints, 2> legs;
  double duration_s = 0.0, stride_m = 0.0;
  std::vector<quat> local;            // kCycleSamples x joints local rotations
  std::vector<vec3> pelvis_m;         // places of the pelvis; heights count from the file's zero
  std::vector<quat> pelvis_rotation;  // world rotations of the pelvis joint
  std::array<CapturedLeg, 2> leg;
  std::size_t joints() const { return skeleton.joints.size(); }
};

// `shift` is the phase of `periodic` at which sample 0 stands.
CapturedCycle captured_cycle(const Motion& motion, const PeriodicMotion& periodic, double shift);

// A cycle without movement from one frame of a motion, turned so that the line of the hips is +x.
CapturedCycle captured_pose(const Motion& motion, const MotionFrame& frame);

// Speed over the ground of a point that is periodic in the travel frame, m/s, at each sample.
std::vector<double> ground_speed(const CapturedCycle& cycle, const std::vector<vec3>& point_m);

// The samples [middle - reach, middle + reach] (wrapping) in which a foot stands flat: there its
// ankle and toe are slowest and lowest.
struct FlatFoot {
  int middle = 0;
  static constexpr int reach = 3;
};
FlatFoot flat_foot(const CapturedCycle& cycle, int side);

vec3 mean_around(const std::vector<vec3>& p, int middle, int reach);
inline int wrapped_index(int i) { return (i % kCycleSamples + kCycleSamples) % kCycleSamples; }

// Measures the standing pose on the walk: fills skeleton, pelvis_standing, leg models and
// standing_local of `out`. From here on, joints between pelvis and hip, hip and knee, knee and
// ankle, ankle and toe keep their mean rotation. Returns the floor's height in `captured`. The
// error does not name the file.
Result<double> build_standing(const CapturedCycle& captured, GaitCycle& out);

// Fills `samples` and `local` of `out` with the angles that put the model's ankles and feet at the
// captured places.
void build_samples(const CapturedCycle& captured, double floor_m, GaitCycle& out);

}  // namespace gaitpad
