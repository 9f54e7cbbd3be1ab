// Forward kinematics of a motion's frames, with the translations that some files give their joints.
#pragma once
#include <vector>

#include "motion/motion.h"

namespace gaitpad {

// World positions and rotations of all joints in one frame.
void forward_kinematics(const Motion& motion, const MotionFrame& frame,
                        JointFrames& frames) noexcept;

// World positions of some joints over all frames: result[i][frame] belongs to joints[i].
std::vector<std::vector<vec3>> joint_tracks_m(const Motion& motion, std::span<const int> joints);

// Hip to knee to ankle, the middle frame's: where twist joints bend between them it is not
// constant.
double leg_length_m(const Motion& motion, const LegJoints& leg);

// The mean of both legs.
double leg_length_m(const Motion& motion);

}  // namespace gaitpad
