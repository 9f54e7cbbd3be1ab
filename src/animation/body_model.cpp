#include "animation/body_model.h"

#include <memory>

#include "animation/curve.h"
#include "motion/cycle_leg.h"

namespace gaitpad {
namespace {

// Limits in radians (degrees here) of a left arm, after AAOS; a right one's z and y are mirrored.
constexpr ArmAngles kMin = {-170, -35, -90, -150, -60, -25};
constexpr ArmAngles kMax = {60, 150, 80, -2, 60, 35};
constexpr double kLeastFlexion = 4.0 * kDegree;  // of an elbow whose swing is magnified
constexpr double kGrip = 0.075;       // wrist to the middle of the hand, of the adult; shares of a
constexpr double kHandPart = 0.5;     // short hand
constexpr double kClearHinge = 0.05;  // mean sine of the elbow's bend that shows where its hinge is
constexpr double kWidestTurn = 1.45;  // radians of shoulder z: beyond it x and y mean nothing

struct Frames {  // of the standing pose
  std::vector<quat> rotation;
  std::vector<vec3> position_m;
};

Frames frames_of(const Skeleton& skeleton, const quat* local) {
  Frames frames;
  frames.rotation = world_rotations(skeleton, local);
  for (const Joint& joint : skeleton.joints) {
    const bool is_root = joint.parent < 0;
    frames.position_m.push_back(is_root ? vec3(0.0)
                                        : frames.position_m[joint.parent] +
                                              frames.rotation[joint.parent] * joint.offset_m);
  }
  return frames;
}

std::vector<int> path_to(const Skeleton& skeleton, int joint) {
  std::vector<int> path;
  for (int j = joint; j >= 0; j = skeleton.joints[j].parent) path.push_back(j);
  std::reverse(path.begin(), path.end());
  return path;
}

quat mean_local(const GaitCycle& cycle, int joint) {
  const std::size_t joints = cycle.skeleton.joints.size();
  const quat& first = cycle.local[joint];
  quat sum(0.0, 0.0, 0.0, 0.0);
  for (int i = 0; i < kCycleSamples; ++i) {
    const quat& q = cycle.local[i * joints + joint];
    sum = sum + (glm::dot(q, first) < 0.0 ? -q : q);
  }
  return glm::dot(sum, sum) > 1e-12 ? glm::normalize(sum) : first;
}

vec3 perpendicular(const vec3& v, const vec3& to) { return v - to * glm::dot(v, to); }

// The hanging axes in the shoulder joint's frame: y along the bone, x along the elbow's hinge,
// which is where the data bend it, or else to the walker's left.
quat hanging_axes(const GaitCycle& cycle, const ArmChain& joints, const Frames& standing) {
  const std::size_t count = cycle.skeleton.joints.size();
  vec3 bone(0.0), hinge(0.0);
  for (int i = 0; i < kCycleSamples; ++i) {
    const Frames at = frames_of(cycle.skeleton, cycle.local.data() + i * count);
    const quat back = glm::conjugate(at.rotation[joints.shoulder]);
    const vec3& elbow_m = at.position_m[joints.elbow];
    const vec3 upper = glm::normalize(elbow_m - at.position_m[joints.shoulder]);
    const vec3 fore = glm::normalize(at.position_m[joints.wrist] - elbow_m);
    bone += back * upper;
    hinge -= back * glm::cross(upper, fore);
  }
  const vec3 y = -glm::normalize(bone);
  hinge = perpendicular(hinge / double(kCycleSamples), y);
  const vec3 left = perpendicular(glm::conjugate(standing.rotation[joints.shoulder]) * kLeft, y);
  const bool is_clear = glm::length(hinge) > kClearHinge && glm::dot(hinge, left) > 0.0;
  vec3 x = is_clear ? hinge : left;
  if (glm::length(x) < 1e-3) x = perpendicular(std::abs(y.x) < 0.9 ? kLeft : kUp, y);
  x = glm::normalize(x);
  return from_axes(x, y, glm::cross(x, y));
}

// Middle of the hand: beyond the wrist on the way to what hangs on it, else along the forearm.
vec3 grip_of(const GaitCycle& cycle, const ArmBuild& arm, const Frames& standing) {
  vec3 sum(0.0);
  double longest_m = 0.0;
  for (const Joint& joint : cycle.skeleton.joints) {
    if (joint.parent != arm.joints.wrist) continue;
    sum += joint.offset_m;
    longest_m = std::max(longest_m, glm::length(joint.offset_m));
  }
  const double usual_m = kGrip * arm.length_m / kReferenceArm_m;
  if (glm::length(sum) < 1e-6) {
    const vec3 fore = standing.position_m[arm.joints.wrist] - standing.position_m[arm.joints.elbow];
    return glm::conjugate(standing.rotation[arm.joints.wrist]) * glm::normalize(fore) * usual_m;
  }
  return glm::normalize(sum) * std::min(usual_m, std::max(kHandPart * longest_m, 0.3 * usual_m));
}

// The angles that the data's arm has in one sample; the wrist's count from there.
ArmAngles angles_of(const Frames& at, const Skeleton& skeleton, const ArmBuild& arm) {
  const ArmChain& j = arm.joints;
  const quat base = at.rotation[skeleton.joints[j.shoulder].parent] * arm.chest;
  const quat upper = at.rotation[j.shoulder] * arm.hanging;
  const AnglesXzy a = angles_xzy(glm::conjugate(base) * upper);
  const vec3 fore = glm::conjugate(upper) * (at.position_m[j.wrist] - at.position_m[j.elbow]);
  ArmAngles angles{};
  angles[kShoulderX] = a.x, angles[kShoulderZ] = a.z, angles[kShoulderY] = a.y;
  angles[kElbowX] = gaitpad::atan2(-fore.z, -fore.y);
  return angles;
}

void fill_ranges(const GaitCycle& cycle, Side side, const Frames& standing, ArmBuild& arm) {
  const std::size_t count = cycle.skeleton.joints.size();
  const ArmAngles rest = angles_of(standing, cycle.skeleton, arm);
  ArmAngles low = rest, high = rest, before = rest;
  double straightest = -1e9;
  for (int i = 0; i < kCycleSamples; ++i) {
    const Frames at = frames_of(cycle.skeleton, cycle.local.data() + i * count);
    ArmAngles now = angles_of(at, cycle.skeleton, arm);
    for (int d = 0; d < kArmDofs; ++d) {
      now[d] = before[d] + wrapped(now[d] - before[d]);
      low[d] = std::min(low[d], now[d]), high[d] = std::max(high[d], now[d]);
      arm.middle_rad[d] += now[d] / kCycleSamples;
    }
    straightest = std::max(straightest, now[kElbowX]);
    before = now;
  }
  for (int d = 0; d < kArmDofs; ++d) {
    const bool is_mirrored =
        side == kRightSide && (d == kShoulderZ || d == kShoulderY || d == kWristZ);
    const double min = (is_mirrored ? -kMax[d] : kMin[d]) * kDegree;
    const double max = (is_mirrored ? -kMin[d] : kMax[d]) * kDegree;
    const double room = d == kElbowX ? 0.0 : 5.0 * kDegree;
    arm.min_rad[d] = std::min(min, low[d] - room), arm.max_rad[d] = std::max(max, high[d] + room);
  }
  const double middle = arm.middle_rad[kElbowX];
  const double room = std::max(0.0, -kLeastFlexion - middle);
  arm.most_elbow_swing = std::max(1.0, room / std::max(1e-3, straightest - middle));
  arm.is_there = std::max(std::abs(low[kShoulderZ]), std::abs(high[kShoulderZ])) < kWidestTurn;
}

ArmBuild arm_build(const GaitCycle& cycle, const ArmChain& joints, Side side,
                   const Frames& standing) {
  ArmBuild arm;
  arm.joints = joints;
  if (!joints.is_found() || cycle.skeleton.joints[joints.shoulder].parent < 0) return arm;
  arm.path = path_to(cycle.skeleton, joints.wrist);
  if (arm.path.size() > kMaxBodyPath) return arm;
  arm.swing_shoulder = mean_local(cycle, joints.shoulder);
  arm.swing_elbow = mean_local(cycle, joints.elbow);
  arm.chest = glm::conjugate(standing.rotation[cycle.skeleton.joints[joints.shoulder].parent]);
  arm.length_m =
      glm::distance(standing.position_m[joints.shoulder], standing.position_m[joints.elbow]) +
      glm::distance(standing.position_m[joints.elbow], standing.position_m[joints.wrist]);
  if (!(arm.length_m > 1e-3)) return arm;
  arm.hanging = hanging_axes(cycle, joints, standing);
  arm.grip_m = grip_of(cycle, arm, standing);
  fill_ranges(cycle, side, standing, arm);
  return arm;
}

// At most kMaxSpineIk of the spine's joints, spread over it.
void fill_spine(const GaitCycle& cycle, const std::vector<int>& spine, const Frames& standing,
                BodyModel& body) {
  if (spine.size() < 2) return;
  body.spine_path = path_to(cycle.skeleton, spine.back());
  if (body.spine_path.size() > kMaxBodyPath) return;
  const int below = cycle.skeleton.joints[spine.front()].parent;
  body.spine_base = standing.rotation[below];
  const int n = static_cast<int>(std::min<std::size_t>(spine.size(), kMaxSpineIk));
  for (int i = 0; i < n; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * (spine.size() - 1) / (n - 1);
    body.spine.push_back(
        {spine[at], standing.rotation[spine[at]], static_cast<double>(i) / (n - 1)});
  }
  double arms = 0.0;
  for (const ArmBuild& arm : body.arm) {
    if (!arm.is_there) continue;
    body.neck_m += standing.position_m[arm.joints.shoulder] - standing.position_m[spine.back()];
    arms += 1.0;
  }
  if (arms > 0.0) body.neck_m /= arms;
}

void fill_head(const GaitCycle& cycle, const BodyJoints& joints, const Frames& standing,
               BodyModel& body) {
  if (joints.head <= 0) return;
  const std::vector<int> path = path_to(cycle.skeleton, joints.head);
  if (path.size() > kMaxBodyPath) return;
  const int first = joints.neck.empty() ? joints.head : joints.neck.front();
  body.head_path = path;
  body.neck_at = static_cast<int>(std::find(path.begin(), path.end(), first) - path.begin());
  body.head_standing = standing.rotation[joints.head];
  body.chest_standing = standing.rotation[cycle.skeleton.joints[first].parent];
}

}  // namespace

BodyModel body_model(const GaitCycle& cycle, double leg_ratio, double pelvis_height_m) {
  BodyModel body;
  const Frames standing = frames_of(cycle.skeleton, cycle.standing_local.data());
  const BodyJoints joints = find_body(cycle.skeleton, {cycle.leg[0].joints, cycle.leg[1].joints},
                                      cycle.pelvis, standing.position_m);
  body.own_step_s = 0.5 * cycle.duration_s * std::sqrt(std::sqrt(leg_ratio));
  double height_m = 0.0, length_m = 0.0, arms = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    body.arm[side] = arm_build(cycle, joints.arm[side], side, standing);
    if (!body.arm[side].is_there) continue;
    height_m = std::max(height_m, standing.position_m[joints.arm[side].shoulder].y);
    length_m += body.arm[side].length_m;
    arms += 1.0;
  }
  if (arms > 0.0) body.arm_m = length_m / arms;
  body.shoulder_height_m = pelvis_height_m + height_m - standing.position_m[cycle.pelvis].y;
  fill_spine(cycle, joints.spine, standing, body);
  fill_head(cycle, joints, standing, body);
  return body;
}

}  // namespace gaitpad
