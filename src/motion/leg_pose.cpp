#include "motion/leg_pose.h"

#include <memory>

#include "gaitpad/anatomy.h"

namespace gaitpad {

LegPose leg_pose(const LegModel& model, const vec3& pelvis_m, const quat& pelvis,
                 const LegAngles& angles, double toe_x) noexcept {
  LegPose p;
  p.thigh = pelvis * rotation_xzy({angles[kHipX], angles[kHipZ], angles[kHipY]});
  p.shank = p.thigh * rotation_x(angles[kKneeX]);
  p.foot = p.shank * rotation_xzy({angles[kAnkleX], angles[kAnkleZ], angles[kAnkleY]});
  p.toe = p.foot * rotation_x(toe_x);
  p.hip_m = pelvis_m + pelvis * model.hip_m;
  p.knee_m = p.hip_m + p.thigh * vec3(0.0, -model.thigh_m, 0.0);
  p.ankle_m = p.knee_m + p.shank * vec3(0.0, -model.shank_m, 0.0);
  p.heel_m = p.ankle_m + p.foot * model.heel_m;
  p.toe_m = p.ankle_m + p.foot * model.toe_m;
  p.toe_end_m = p.toe_m + p.toe * model.toe_end_m;
  return p;
}

LegPose pose_of(const GaitCycle& cycle, int side, const CycleSample& at) noexcept {
  const LegSample& leg = at.leg[side];
  return leg_pose(cycle.leg[side], at.pelvis_m, at.pelvis, leg.angles, leg.toe_x);
}

vec3 foot_forward(const LegModel& leg) noexcept {
  const vec3 line = leg.toe_m - leg.heel_m;
  return glm::normalize(vec3(line.x, 0.0, line.z));
}

double knee_at_span(const LegModel& leg, double span_m) noexcept {
  const double a = leg.thigh_m, b = leg.shank_m;
  return gaitpad::acos((span_m * span_m - a * a - b * b) / (2.0 * a * b));
}

Stand standing_legs(const std::array<LegModel, 2>& legs, double knee_rad) noexcept {
  constexpr double kMostRoll = 10.0 * kDegree;  // of the pelvis, as a person's
  Stand stand;
  const vec3 across = legs[0].hip_m - legs[1].hip_m;
  const auto length_m = [knee_rad](const LegModel& leg) {
    const double a = leg.thigh_m, b = leg.shank_m;
    return std::sqrt(a * a + b * b + 2.0 * a * b * sin_cos(knee_rad).cos) - leg.heel_m.y;
  };
  const double longer = length_m(legs[0]) - length_m(legs[1]) - across.y;
  stand.roll_rad = std::clamp(gaitpad::atan2(longer, std::abs(across.x)), -kMostRoll, kMostRoll);
  const quat roll = rotation_z(stand.roll_rad);
  const auto height_m = [&](const LegModel& leg) { return length_m(leg) - (roll * leg.hip_m).y; };
  stand.pelvis_m = std::min(height_m(legs[0]), height_m(legs[1]));
  for (int side : {0, 1}) {
    const LegModel& leg = legs[side];
    const double a = leg.thigh_m, b = leg.shank_m;
    const double span = stand.pelvis_m + (roll * leg.hip_m).y + leg.heel_m.y;
    const double knee = knee_at_span(leg, span);
    const SinCos bent = sin_cos(knee);
    LegAngles& angles = stand.angles[side];
    angles[kHipX] = -gaitpad::atan2(b * bent.sin, a + b * bent.cos);
    angles[kHipZ] = -stand.roll_rad;
    angles[kKneeX] = knee;
    angles[kAnkleX] = -angles[kHipX] - knee;
    stand.lead_m += 0.5 * (-leg.heel_m.z - leg.hip_m.z);
  }
  return stand;
}

std::array<double, 4> stage_shares(const GaitCycle& cycle) noexcept {
  const double left_off = cycle.toe_off[kLeftSide], left_strike = cycle.strike[kLeftSide],
               right_off = cycle.toe_off[kRightSide];
  return {left_off, left_strike - left_off, right_off - left_strike, 1.0 - right_off};
}

quat rotation_xzy(const AnglesXzy& a) noexcept {
  return rotation_x(a.x) * rotation_z(a.z) * rotation_y(a.y);
}

AnglesXzy angles_xzy(const quat& q) noexcept {
  const vec3 up = q * kUp;  // (-sin z, cos z cos x, cos z sin x)
  AnglesXzy a;
  a.x = gaitpad::atan2(up.z, up.y);
  a.z = gaitpad::atan2(-up.x, std::sqrt(up.y * up.y + up.z * up.z));
  const quat rest = glm::conjugate(rotation_x(a.x) * rotation_z(a.z)) * q;
  a.y = wrapped(2.0 * gaitpad::atan2(rest.y, rest.w));
  return a;
}

std::vector<int> twist_joints(const Skeleton& skeleton, int pelvis, const LegJoints& leg) {
  std::vector<int> joints = path_below(skeleton, pelvis, skeleton.joints[leg.toe].parent);
  std::erase_if(joints, [&](int j) { return j == leg.hip || j == leg.knee || j == leg.ankle; });
  return joints;
}

vec3 link(const Skeleton& skeleton, std::span<const quat> local, int from, int to) noexcept {
  vec3 v(0.0);
  for (int j = to; j > from; j = skeleton.joints[j].parent)
    v = skeleton.joints[j].offset_m + local[j] * v;
  return v;
}

std::vector<quat> world_rotations(const Skeleton& skeleton, std::span<const quat> local) {
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(skeleton, local, *world);
  const auto& all = world->rotation;
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(skeleton.joints.size())};
}

quat world_rotation(const Skeleton& skeleton, const quat* local, int joint) noexcept {
  quat q = kIdentity;
  for (int j = joint; j >= 0; j = skeleton.joints[j].parent) q = local[j] * q;
  return q;
}

namespace {

void set_local(const Skeleton& skeleton, int joint, const quat& world, quat* local) {
  const int parent = skeleton.joints[joint].parent;
  local[joint] = glm::normalize(glm::conjugate(world_rotation(skeleton, local, parent)) * world);
}

}  // namespace

void set_leg_locals(const Skeleton& skeleton, const LegModel& model, const LegPose& pose,
                    quat* local) {
  const LegJoints& j = model.joints;
  set_local(skeleton, j.hip, pose.thigh * model.standing[0], local);
  set_local(skeleton, j.knee, pose.shank * model.standing[1], local);
  set_local(skeleton, j.ankle, pose.foot * model.standing[2], local);
  if (!skeleton.joints[j.toe].is_end_site) {
    set_local(skeleton, j.toe, pose.toe * model.standing[3], local);
  }
}

}  // namespace gaitpad
