// The pose between two ticks of a walk, with the feet where the ticks have them.
#include <algorithm>
#include <cmath>

#include "gaitpad/walk_output.h"

namespace gaitpad {
namespace {

bool has_toe(const Skeleton& skeleton, const LegModel& leg) noexcept {
  return leg.joints.toe >= 0 && !skeleton.joints[leg.joints.toe].is_end_site;
}

// Where a foot is between two ticks: its ankle joint, and the rotations of ankle and toe joint.
struct FootGoal {
  vec3 ankle_m;
  quat ankle, toe;
};
// The foot turns about the point between heel and toe that moves least: heel or toe, if it stands
// on it. That point goes along the line between its two places.
FootGoal foot_between(const Skeleton& skeleton, const LegModel& leg, const JointFrames& from,
                      const JointFrames& to, double share) noexcept {
  constexpr double kStill_m2 = 1e-18;  // a foot that turns by less turns about its heel
  const int ankle = leg.joints.ankle, toe = leg.joints.toe;
  const quat out = glm::conjugate(leg.standing[2]);  // from the foot's frame to its joint's
  const auto place_m = [&](const JointFrames& frames, const vec3& point_m) {
    return frames.position_m[ankle] + frames.rotation[ankle] * (out * point_m);
  };
  const vec3 heel_moves = place_m(to, leg.heel_m) - place_m(from, leg.heel_m),
             toe_moves = place_m(to, leg.toe_m) - place_m(from, leg.toe_m),
             turns = toe_moves - heel_moves;
  const double square = glm::dot(turns, turns),
               along = square > kStill_m2
                           ? std::clamp(-glm::dot(heel_moves, turns) / square, 0.0, 1.0)
                           : 0.0;
  const vec3 point_m = mix(leg.heel_m, leg.toe_m, along);
  FootGoal goal;
  goal.ankle = nlerp(from.rotation[ankle], to.rotation[ankle], share);
  if (has_toe(skeleton, leg)) goal.toe = nlerp(from.rotation[toe], to.rotation[toe], share);
  goal.ankle_m =
      mix(place_m(from, point_m), place_m(to, point_m), share) - goal.ankle * (out * point_m);
  return goal;
}

// The cosine and sine of the angle between two vectors about an axis at right angles to both.
struct Bend {
  double cosine, sine;
};
Bend bend_between(const vec3& a, const vec3& b, const vec3& axis) noexcept {
  const double length = glm::length(a) * glm::length(b);
  return {glm::dot(a, b) / length, glm::dot(glm::cross(a, b), axis) / length};
}
quat turn_about(const vec3& axis, const Bend& bend) noexcept {
  const double half = std::sqrt(0.5 + 0.5 * bend.cosine);
  return glm::normalize(quat(half, axis * (bend.sine / (2.0 * half))));
}

// Ends a leg at its foot: bends the knee to the distance of the ankle, turns the leg the shortest
// way from where the blend has the ankle, and turns ankle and toes as the foot lies.
void end_leg(const Skeleton& skeleton, const LegModel& leg, const JointFrames& blend,
             const FootGoal& goal, Pose& pose) noexcept {
  const int hip = leg.joints.hip, knee = leg.joints.knee, ankle = leg.joints.ankle,
            toe = leg.joints.toe;
  const std::array<vec3, kMaxJoints>& place_m = blend.position_m;
  const vec3 thigh_m = place_m[knee] - place_m[hip], shank_m = place_m[ankle] - place_m[knee],
             reach_m = goal.ankle_m - place_m[hip];
  const vec3 hinge = blend.rotation[hip] * (glm::conjugate(leg.standing[0]) * kLeft);
  const Bend was = bend_between(thigh_m, shank_m, hinge);
  const double a = glm::dot(thigh_m, thigh_m), b = glm::dot(shank_m, shank_m),
               cosine = std::clamp((glm::dot(reach_m, reach_m) - a - b) / (2.0 * std::sqrt(a * b)),
                                   -1.0, 1.0),
               sine = std::copysign(std::sqrt(1.0 - cosine * cosine), was.sine);
  const quat bends = turn_about(
      hinge, {cosine * was.cosine + sine * was.sine, sine * was.cosine - cosine * was.sine});
  const quat turns =
      rotation_between(glm::normalize(thigh_m + bends * shank_m), glm::normalize(reach_m));
  const auto parent = [&](int joint) {
    const int above = skeleton.joints[joint].parent;
    return above < 0 ? kIdentity : blend.rotation[above];
  };
  const auto set = [&](int joint, const quat& above, const quat& turn) {
    pose.local[joint] = glm::normalize(glm::conjugate(above) * turn);
  };
  set(hip, parent(hip), turns * blend.rotation[hip]);
  set(knee, parent(knee), bends * blend.rotation[knee]);
  set(ankle, turns * bends * parent(ankle), goal.ankle);
  if (!has_toe(skeleton, leg)) return;
  const quat of_foot = goal.ankle * glm::conjugate(blend.rotation[ankle]);
  set(toe, of_foot * parent(toe), goal.toe);
}

}  // namespace

bool pose_between(const WalkModel& model, const Pose& from, const Pose& to, double share,
                  Pose& pose) noexcept {
  const Skeleton& skeleton = model.cycle.skeleton;
  const int joints = static_cast<int>(skeleton.joints.size());
  if (std::isnan(share) || from.joint_count != joints || to.joint_count != joints) return false;
  pose.joint_count = joints;
  if (share <= 0.0 || share >= 1.0) {
    const Pose& end = share <= 0.0 ? from : to;
    pose.root_m = end.root_m;
    std::copy_n(end.local.begin(), joints, pose.local.begin());
    return true;
  }
  JointFrames before, after;
  forward_kinematics(skeleton, from, before);
  forward_kinematics(skeleton, to, after);
  pose.root_m = mix(from.root_m, to.root_m, share);
  for (int j = 0; j < joints; ++j) pose.local[j] = nlerp(from.local[j], to.local[j], share);
  JointFrames blend;
  forward_kinematics(skeleton, pose, blend);
  for (const LegBuild& leg : model.leg)
    end_leg(skeleton, leg.model, blend, foot_between(skeleton, leg.model, before, after, share),
            pose);
  return true;
}

}  // namespace gaitpad
