// One leg of a gait cycle: forward kinematics from its angles, and joint rotations from the result.
#pragma once
#include <array>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// Segment rotations and points in the frame of the pelvis position and rotation given.
struct LegPose {
  quat thigh, shank, foot, toe;
  vec3 hip_m, knee_m, ankle_m, heel_m, toe_m, toe_end_m;
};
LegPose leg_pose(const LegModel& model, const vec3& pelvis_m, const quat& pelvis,
                 const LegAngles& angles, double toe_x) noexcept;
// A leg of a cycle at one of its samples, in the travel frame.
LegPose pose_of(const GaitCycle& cycle, int side, const CycleSample& at) noexcept;

// q = Rx(x) Rz(z) Ry(y), the order of LegDof; z in [-pi/2, pi/2].
struct AnglesXzy {
  double x, z, y;
};
quat rotation_xzy(const AnglesXzy& a) noexcept;
AnglesXzy angles_xzy(const quat& q) noexcept;

// Horizontal unit vector along a standing foot; kUp x it points across the foot.
vec3 foot_forward(const LegModel& leg) noexcept;
inline constexpr double kHalfFoot = 0.054;  // half a foot's breadth in legs, 4.5 cm for an adult

// The knee flexion, in radians, at that distance from hip to ankle; 0 if the leg is too short.
double knee_at_span(const LegModel& leg, double span_m) noexcept;

// The pose of both legs standing upright with flat feet. If one is longer, the pelvis rolls, by 10
// degrees at most, as a person's does; the longer leg bends by the rest.
struct Stand {
  double pelvis_m = 0.0;  // height of the pelvis over the floor
  double roll_rad = 0.0;  // roll of the pelvis about +z, left side up positive
  double lead_m = 0.0;    // of the pelvis ahead of the heels
  std::array<LegAngles, 2> angles{};
};
// No knee is straighter than `knee_rad`.
Stand standing_legs(const std::array<LegModel, 2>& legs, double knee_rad) noexcept;

// The stages' shares of a cycle: right roll, left flight, left roll, right flight.
std::array<double, 4> stage_shares(const GaitCycle& cycle) noexcept;

// The direction that hips face, from the line from the right to the left one.
inline double hips_heading(const vec3& across_m) noexcept {
  return heading_of(glm::cross(across_m, kUp));
}

// Mirror images in the walker's middle plane (x -> -x).
inline vec3 mirrored(const vec3& v) noexcept { return vec3(-v.x, v.y, v.z); }
inline quat mirrored(const quat& q) noexcept { return quat(q.w, q.x, -q.y, -q.z); }

// Of q and -q, which are the same rotation, the one nearer to `to`.
inline quat nearer(const quat& q, const quat& to) noexcept {
  return glm::dot(q, to) < 0.0 ? -q : q;
}

// The mean of so many rotations, which are all near to the first one.
template <class RotationOf>
quat mean_rotation(int count, const RotationOf& rotation) noexcept {
  quat sum = rotation(0);
  for (int i = 1; i < count; ++i) sum = sum + nearer(rotation(i), rotation(0));
  return glm::normalize(sum);
}

// The twist joints of a leg: those between pelvis and toe that are not its own joints. They keep
// their rotation in a walk.
std::vector<int> twist_joints(const Skeleton& skeleton, int pelvis, const LegJoints& leg);

// The vector from joint `from` to joint `to` at or below it, in the frame of `from`, with the
// locals given.
vec3 link(const Skeleton& skeleton, std::span<const quat> local, int from, int to) noexcept;
// World rotation of every joint for the local rotations given.
std::vector<quat> world_rotations(const Skeleton& skeleton, std::span<const quat> local);
// The same of one joint; no rotation for -1, above the root.
quat world_rotation(const Skeleton& skeleton, const quat* local, int joint) noexcept;
// Overwrites the locals of hip, knee, ankle and toe so that their world rotations match the
// segments of `pose`; all other joints keep their locals.
void set_leg_locals(const Skeleton& skeleton, const LegModel& model, const LegPose& pose,
                    quat* local);

}  // namespace gaitpad
