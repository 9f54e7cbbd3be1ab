// A character's bones and one posture of them.
// Meredith & Maddock 2005, section 3.2: the data module hands out "limb degree-of-freedom values"
// in one format, whether the motion was captured, computed or key-framed.
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

// A joint and the bone to its parent. A motion's reader or a program with its own skeleton fills
// it; it does not change after that. Joints are in depth-first order, parents before children;
// joint 0 is the root (parent -1).
struct Joint {
  std::string name;          // name; for an End Site its parent's name + "_End"
  int parent = -1;           // index of the parent, which is an earlier joint
  vec3 offset_m{0.0};        // place relative to the parent joint, in the parent joint's frame;
                             // finite
  bool is_end_site = false;  // it is the tip of a bone in a BVH file, which nothing turns
};
struct Skeleton {
  std::vector<Joint> joints;
  // Index of the joint with exactly this name; -1: there is none.
  int find(const std::string& name) const;
};

// Joint indices of one leg. Further joints (twist joints) may be between hip and knee or knee and
// ankle; they keep a fixed rotation. find_legs() fills it; -1: not set.
struct LegJoints {
  int hip = -1, knee = -1, ankle = -1;
  int toe = -1;      // the ball of the foot; an End Site if the skeleton has no toe joint
  int toe_end = -1;  // the toe's End Site or last descendant; the toe itself if it is an End Site
};

// A posture of at most kMaxJoints joints; a walk or a program fills it. Plain, trivially copyable.
// local[j] turns joint j's frame into its parent's, local[0] into the world.
struct Pose {
  vec3 root_m{0.0};  // world position of joint 0
  std::array<quat, kMaxJoints> local;
  int joint_count = 0;
};

// World frames of the joints, from forward_kinematics(): the place of each joint, and the rotation
// from its frame to the world's.
struct JointFrames {
  std::array<vec3, kMaxJoints> position_m;
  std::array<quat, kMaxJoints> rotation;
};

// Forward kinematics, eq. (1): a joint's frame is its parent's, moved by the joint's offset and
// turned by its local rotation. Writes the frames of the first pose.joint_count joints.
void forward_kinematics(const Skeleton& skeleton, const Pose& pose, JointFrames& frames) noexcept;

// Forward kinematics of some joints only, parents before children. Frames of parents that are not
// among them are read from `frames`.
void forward_kinematics(const Skeleton& skeleton, const vec3& root_m, std::span<const quat> local,
                        std::span<const int> joints, JointFrames& frames) noexcept;

// Forward kinematics for local rotations of all joints, with the root at the origin.
void forward_kinematics(const Skeleton& skeleton, std::span<const quat> local,
                        JointFrames& frames) noexcept;

}  // namespace gaitpad
