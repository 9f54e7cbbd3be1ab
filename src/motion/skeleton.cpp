#include "gaitpad/skeleton.h"

#include <memory>

#include "gaitpad/motion.h"

namespace gaitpad {

int Skeleton::find(const std::string& name) const {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].name == name) return static_cast<int>(j);
  }
  return -1;
}

void forward_kinematics(const Skeleton& skeleton, const Pose& pose, JointFrames& frames) noexcept {
  frames.position_m[0] = pose.root_m;
  frames.rotation[0] = pose.local[0];
  for (int j = 1; j < pose.joint_count; ++j) {
    const Joint& joint = skeleton.joints[j];
    const quat& parent = frames.rotation[joint.parent];
    frames.position_m[j] = frames.position_m[joint.parent] + parent * joint.offset_m;
    frames.rotation[j] = parent * pose.local[j];
  }
}

void forward_kinematics(const Motion& motion, const MotionFrame& frame,
                        JointFrames& frames) noexcept {
  const std::vector<Joint>& joints = motion.skeleton.joints;
  frames.position_m[0] = frame.root_m;
  frames.rotation[0] = frame.local[0];
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const auto parent = static_cast<std::size_t>(joints[j].parent);
    const vec3& link = frame.translation_m.empty() ? joints[j].offset_m : frame.translation_m[j];
    frames.position_m[j] = frames.position_m[parent] + frames.rotation[parent] * link;
    frames.rotation[j] = frames.rotation[parent] * frame.local[j];
  }
}

std::vector<std::vector<vec3>> joint_tracks_m(const Motion& motion, std::span<const int> joints) {
  std::vector<std::vector<vec3>> tracks(joints.size());
  for (auto& track : tracks) track.reserve(motion.frames.size());
  const auto world = std::make_unique<JointFrames>();
  for (const MotionFrame& frame : motion.frames) {
    forward_kinematics(motion, frame, *world);
    for (std::size_t i = 0; i < joints.size(); ++i)
      tracks[i].push_back(world->position_m[joints[i]]);
  }
  return tracks;
}

double leg_length_m(const Motion& motion, const LegJoints& leg) {
  const auto world = std::make_unique<JointFrames>();
  forward_kinematics(motion, motion.frames[motion.frames.size() / 2], *world);
  const auto& at = world->position_m;
  return glm::distance(at[leg.hip], at[leg.knee]) + glm::distance(at[leg.knee], at[leg.ankle]);
}

double leg_length_m(const Motion& motion) {
  return 0.5 * (leg_length_m(motion, motion.legs[0]) + leg_length_m(motion, motion.legs[1]));
}

}  // namespace gaitpad
