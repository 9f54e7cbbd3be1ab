// The character's bones and one posture of them.
// Meredith & Maddock 2005, section 3.2: the data module hands out "limb degree-of-freedom values"
// in one format, whatever the source (captured, procedural, key-framed).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gaitpad/limbs.h"
#include "gaitpad/math.h"

namespace gaitpad {

inline constexpr int kMaxJoints = 320;

// Immutable after load. Joints stand in depth-first order, parents before children; joint 0 is the
// root (parent -1). A BVH End Site is a joint too (is_end_site), named after its parent + "_End".
struct Joint {
  std::string name;
  int parent = -1;
  vec3 offset_m{0.0};  // from the parent joint, in the parent joint's frame
  bool is_end_site = false;
};
struct Skeleton {
  std::vector<Joint> joints;
  int find(const std::string& name) const;  // exact name, -1 where there is none
};

// Joint indices of one leg. Between hip and knee (or knee and ankle) further joints may stand
// (twist joints); they keep a fixed rotation. toe is an End Site where the skeleton has no toe
// joint; toe_end is the toe joint's End Site or last descendant (== toe where toe is itself an End
// Site).
struct LegJoints {
  int hip = -1, knee = -1, ankle = -1, toe = -1, toe_end = -1;
};

// Plain, trivially copyable. local[j] turns joint j's frame into its parent's; local[0] into the
// world.
struct Pose {
  vec3 root_m{0.0};  // world position of joint 0
  std::array<quat, kMaxJoints> local;
  int joint_count = 0;
};

struct JointFrames {  // world
  std::array<vec3, kMaxJoints> position_m;
  std::array<quat, kMaxJoints> rotation;
};
// Forward kinematics, eq. (1). Frames of the first joint_count joints are written.
void forward_kinematics(const Skeleton& skeleton, const Pose& pose, JointFrames& frames) noexcept;

}  // namespace gaitpad
