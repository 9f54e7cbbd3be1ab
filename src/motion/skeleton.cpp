#include "gaitpad/skeleton.h"

#include <memory>

#include "gaitpad/motion.h"

namespace gaitpad {
namespace {

// Eq. (1) for one joint: place = parent's place + parent's rotation * offset; rotation = parent's
// rotation * local. The root, which has no parent, stands at `root_m`.
void carry_joint(int joint, int parent, const vec3& root_m, const vec3& offset_m, const quat& local,
                 JointFrames& frames) noexcept {
  const bool is_root = parent < 0;
  frames.position_m[joint] =
      is_root ? root_m : frames.position_m[parent] + frames.rotation[parent] * offset_m;
  frames.rotation[joint] = is_root ? local : frames.rotation[parent] * local;
}

// The first joints, as many as there are local rotations. Offsets, if there are any, replace the
// joints' own.
void carry_all(const std::vector<Joint>& joints, const vec3& root_m, std::span<const quat> local,
               std::span<const vec3> offset_m, JointFrames& frames) noexcept {
  for (std::size_t j = 0; j < local.size(); ++j) {
    carry_joint(static_cast<int>(j), joints[j].parent, root_m,
                offset_m.empty() ? joints[j].offset_m : offset_m[j], local[j], frames);
  }
}

}  // namespace

int Skeleton::find(const std::string& name) const {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].name == name) return static_cast<int>(j);
  }
  return -1;
}

void forward_kinematics(const Skeleton& skeleton, const Pose& pose, JointFrames& frames) noexcept {
  carry_all(skeleton.joints, pose.root_m, {pose.local.data(), std::size_t(pose.joint_count)}, {},
            frames);
}

void forward_kinematics(const Skeleton& skeleton, const vec3& root_m, std::span<const quat> local,
                        std::span<const int> joints, JointFrames& frames) noexcept {
  for (const int j : joints) {
    const Joint& joint = skeleton.joints[j];
    carry_joint(j, joint.parent, root_m, joint.offset_m, local[j], frames);
  }
}

void forward_kinematics(const Skeleton& skeleton, std::span<const quat> local,
                        JointFrames& frames) noexcept {
  carry_all(skeleton.joints, vec3(0.0), local.first(skeleton.joints.size()), {}, frames);
}

void forward_kinematics(const Motion& motion, const MotionFrame& frame,
                        JointFrames& frames) noexcept {
  carry_all(motion.skeleton.joints, frame.root_m, frame.local, frame.translation_m, frames);
}

std::vector<std::vector<vec3>> joint_tracks_m(const Motion& motion, std::span<const int> joints) {
  const int motion_joints = static_cast<int>(motion.skeleton.joints.size());
  std::vector<std::vector<vec3>> tracks(joints.size());
  for (auto& track : tracks) track.reserve(motion.frames.size());
  const auto world = std::make_unique<JointFrames>();
  for (const MotionFrame& frame : motion.frames) {
    forward_kinematics(motion, frame, *world);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (joints[i] >= 0 && joints[i] < motion_joints)
        tracks[i].push_back(world->position_m[joints[i]]);
    }
  }
  return tracks;
}

double leg_length_m(const Motion& motion, const LegJoints& leg) {
  const int joints = static_cast<int>(motion.skeleton.joints.size());
  const auto is_there = [joints](int joint) { return joint >= 0 && joint < joints; };
  if (motion.frames.empty() || !is_there(leg.hip) || !is_there(leg.knee) || !is_there(leg.ankle))
    return 0.0;
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(motion, motion.frames[motion.frames.size() / 2], *world);
  const auto& at = world->position_m;
  return glm::distance(at[leg.hip], at[leg.knee]) + glm::distance(at[leg.knee], at[leg.ankle]);
}

double leg_length_m(const Motion& motion) {
  return 0.5 * (leg_length_m(motion, motion.legs[0]) + leg_length_m(motion, motion.legs[1]));
}

}  // namespace gaitpad
