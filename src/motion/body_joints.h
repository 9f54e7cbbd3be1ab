// Which joints are arms, spine, neck and head: by name where the names are known, else by the
// skeleton's shape.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "motion/skeleton.h"

namespace gaitpad {

// Joint indices of one arm; all but `collar` are set or none is. Between two of them further joints
// may stand (twist joints). wrist is an End Site where the skeleton has no hand.
struct ArmChain {
  int collar = -1;  // the lowest one above the shoulder
  int shoulder = -1, elbow = -1, wrist = -1;
  bool is_found() const noexcept { return shoulder >= 0; }
};

// What is not there is empty or -1.
struct BodyJoints {
  std::vector<int> spine;  // from above the pelvis up to the joint that carries arms and neck
  std::vector<int> neck;   // from above that joint to below the head
  int head = -1;
  std::array<ArmChain, 2> arm;  // indexed by Side
};

// `position_m`: world positions of all joints in some pose, upright along +y if names say nothing.
// Total: an odd skeleton has no arms.
BodyJoints find_body(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs, int pelvis,
                     std::span<const vec3> position_m);

}  // namespace gaitpad
