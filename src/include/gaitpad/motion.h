// A motion as it stands in a file: a skeleton and its frames, already in metres.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "gaitpad/skeleton.h"

namespace gaitpad {

// One frame of a file. Every joint's local rotation; the root's position; and for joints below the
// root that carry position channels, their local translation (replaces offset_m), else empty.
struct MotionFrame {
  vec3 root_m{0.0};
  std::vector<quat> local;
  std::vector<vec3> translation_m;  // empty, or one a joint
};

struct Motion {
  std::string name;  // file name without folder, or "procedural"
  Skeleton skeleton;
  int pelvis = 0;  // lowest joint above both legs; its ancestors may be still while it moves
  std::array<LegJoints, 2> legs;  // indexed by Side
  double metres_per_unit = 1.0;   // file units times this are metres
  double frame_time_s = 1.0 / 120.0;
  std::vector<MotionFrame> frames;
};

// Forward kinematics of a motion's frames, with the translations that some files give their joints.

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
