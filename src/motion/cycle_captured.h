// The periodic captured stride as sampled poses: what the standing pose and the legs are measured
// on.
#pragma once
#include <array>
#include <vector>

#include "motion/cycle_periodic.h"
#include "motion/gait_cycle.h"

namespace gaitpad {

struct CapturedLeg {  // travel frame, joint frames
  std::vector<vec3> knee_m, ankle_m, toe_m, toe_end_m, hip_m;
  std::vector<quat> hip, above_knee, knee, ankle, toe;  // above_knee: the knee's parent
};
struct CapturedCycle {
  Skeleton skeleton;  // as in GaitCycle: root at the pelvis
  int pelvis = 0;
  std::array<LegJoints, 2> legs;
  double duration_s = 0.0, stride_m = 0.0;
  std::vector<quat> local;            // kCycleSamples x joints
  std::vector<vec3> pelvis_m;         // height above the file's zero
  std::vector<quat> pelvis_rotation;  // world rotation of the joint
  std::array<CapturedLeg, 2> leg;
  std::size_t joints() const { return skeleton.joints.size(); }
};

// `shift` is the phase of `periodic` at which sample 0 stands.
CapturedCycle captured_cycle(const Motion& motion, const PeriodicMotion& periodic, double shift);

// One frame of a motion as a cycle in which nothing moves, turned until the hips' line is +x.
CapturedCycle captured_pose(const Motion& motion, const MotionFrame& frame);

// Speed over the ground of a point that is periodic in the travel frame, m/s, at each sample.
std::vector<double> ground_speed(const CapturedCycle& cycle, const std::vector<vec3>& point_m);

// Samples [middle - reach, middle + reach] (wrapping) in which a foot stands flat: ankle and toe
// are slowest.
struct FlatFoot {
  int middle = 0;
  static constexpr int reach = 3;
};
FlatFoot flat_foot(const CapturedCycle& cycle, int side);

quat mean_of(const std::vector<quat>& q);
quat mean_around(const std::vector<quat>& q, int middle, int reach);
vec3 mean_around(const std::vector<vec3>& p, int middle, int reach);
inline int wrapped_index(int i) { return (i % kCycleSamples + kCycleSamples) % kCycleSamples; }

}  // namespace gaitpad
