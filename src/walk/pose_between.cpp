// The pose between two ticks of a walk, with the feet where the ticks have them.
#include <algorithm>
#include <cmath>

#include "gaitpad/walk_output.h"

namespace gaitpad {
namespace {

// The joints from the root to the toe of a leg.
struct LegPath {
  std::array<int, kMaxJoints> joint;
  int count = 0;
  // Index on the path; `toe` is `count` if the path ends at the ankle.
  int hip = 0, knee = 0, ankle = 0, toe = 0;
};

LegPath path_of(const Skeleton& skeleton, const LegJoints& leg) noexcept {
  const bool has_toe = leg.toe >= 0 && !skeleton.joints[leg.toe].is_end_site;
  LegPath path;
  for (int j = has_toe ? leg.toe : leg.ankle; j >= 0; j = skeleton.joints[j].parent)
    path.joint[path.count++] = j;
  std::reverse(path.joint.begin(), path.joint.begin() + path.count);
  const auto place_of = [&](int joint) {
    return static_cast<int>(std::find(path.joint.begin(), path.joint.begin() + path.count, joint) -
                            path.joint.begin());
  };
  path.hip = place_of(leg.hip), path.knee = place_of(leg.knee), path.ankle = place_of(leg.ankle);
  path.toe = has_toe ? path.count - 1 : path.count;
  return path;
}

// Their frames in the world.
struct PathFrames {
  std::array<vec3, kMaxJoints> place_m;
  std::array<quat, kMaxJoints> turn;
};
void set_frames(const Skeleton& skeleton, const LegPath& path, const Pose& pose,
                PathFrames& frames) noexcept {
  for (int i = 0; i < path.count; ++i) {
    const int joint = path.joint[i];
    const quat& local = pose.local[joint];
    frames.place_m[i] =
        i == 0 ? pose.root_m
               : frames.place_m[i - 1] + frames.turn[i - 1] * skeleton.joints[joint].offset_m;
    frames.turn[i] = i == 0 ? local : frames.turn[i - 1] * local;
  }
}

// Where a foot is between two ticks: its ankle joint, and the rotations of ankle and toe joint.
struct FootGoal {
  vec3 ankle_m;
  quat ankle, toe;
};
// The foot turns about the point between heel and toe that moves least: heel or toe, if it stands
// on it. That point goes along the line between its two places.
FootGoal foot_between(const LegModel& leg, const LegPath& path, const PathFrames& from,
                      const PathFrames& to, double share) noexcept {
  constexpr double kStill_m2 = 1e-18;  // a foot that turns by less turns about its heel
  const int ankle = path.ankle;
  const quat out = glm::conjugate(leg.standing[2]);  // from the foot's frame to its joint's
  const auto place_m = [&](const PathFrames& frames, const vec3& point_m) {
    return frames.place_m[ankle] + frames.turn[ankle] * (out * point_m);
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
  goal.ankle = nlerp(from.turn[ankle], to.turn[ankle], share);
  if (path.toe < path.count) goal.toe = nlerp(from.turn[path.toe], to.turn[path.toe], share);
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
void end_leg(const LegModel& leg, const LegPath& path, const PathFrames& blend,
             const FootGoal& goal, Pose& pose) noexcept {
  const auto [hip, knee, ankle] = std::array{path.hip, path.knee, path.ankle};
  const vec3 hip_m = blend.place_m[hip], thigh_m = blend.place_m[knee] - hip_m,
             shank_m = blend.place_m[ankle] - blend.place_m[knee], reach_m = goal.ankle_m - hip_m;
  const vec3 hinge = blend.turn[hip] * (glm::conjugate(leg.standing[0]) * kLeft);
  const Bend was = bend_between(thigh_m, shank_m, hinge);
  const double a = glm::dot(thigh_m, thigh_m), b = glm::dot(shank_m, shank_m),
               cosine = std::clamp((glm::dot(reach_m, reach_m) - a - b) / (2.0 * std::sqrt(a * b)),
                                   -1.0, 1.0),
               sine = std::copysign(std::sqrt(1.0 - cosine * cosine), was.sine);
  const quat bends = turn_about(
      hinge, {cosine * was.cosine + sine * was.sine, sine * was.cosine - cosine * was.sine});
  const quat turns =
      rotation_between(glm::normalize(thigh_m + bends * shank_m), glm::normalize(reach_m));
  const auto parent = [&](int i) { return i == 0 ? kIdentity : blend.turn[i - 1]; };
  const auto set = [&](int i, const quat& above, const quat& turn) {
    pose.local[path.joint[i]] = glm::normalize(glm::conjugate(above) * turn);
  };
  set(hip, parent(hip), turns * blend.turn[hip]);
  set(knee, parent(knee), bends * blend.turn[knee]);
  set(ankle, turns * bends * parent(ankle), goal.ankle);
  if (path.toe == path.count) return;
  const quat of_foot = goal.ankle * glm::conjugate(blend.turn[ankle]);
  set(path.toe, of_foot * parent(path.toe), goal.toe);
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
  std::array<LegPath, 2> paths;
  std::array<FootGoal, 2> goals;
  for (const int side : {0, 1}) {
    const LegModel& leg = model.leg[side].model;
    paths[side] = path_of(skeleton, leg.joints);
    PathFrames before, after;
    set_frames(skeleton, paths[side], from, before);
    set_frames(skeleton, paths[side], to, after);
    goals[side] = foot_between(leg, paths[side], before, after, share);
  }
  pose.root_m = mix(from.root_m, to.root_m, share);
  for (int j = 0; j < joints; ++j) pose.local[j] = nlerp(from.local[j], to.local[j], share);
  for (const int side : {0, 1}) {
    PathFrames blend;
    set_frames(skeleton, paths[side], pose, blend);
    end_leg(model.leg[side].model, paths[side], blend, goals[side], pose);
  }
  return true;
}

}  // namespace gaitpad
