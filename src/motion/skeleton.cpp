#include "motion/skeleton.h"

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

}  // namespace gaitpad
