#include "motion/leg_pose.h"

#include <memory>

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

std::vector<quat> world_rotations(const Skeleton& skeleton, std::span<const quat> local) {
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(skeleton, local, *world);
  const auto& all = world->rotation;
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(skeleton.joints.size())};
}

namespace {

quat world_rotation(const Skeleton& skeleton, const quat* local, int joint) {
  quat q = kIdentity;
  for (int j = joint; j >= 0; j = skeleton.joints[j].parent) q = local[j] * q;
  return q;
}

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
