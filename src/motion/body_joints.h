// Which joints are spine, neck, head and arms: by name where names are known, else by the
// skeleton's shape. The legs are legs.h's.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "motion/motion.h"

namespace gaitpad {

// -1 where there is none. Between two of them further joints may stand (twist joints).
struct ArmJoints {
  int clavicle = -1;
  int shoulder = -1, elbow = -1, wrist = -1;  // tops of upper arm, forearm, hand
};

struct BodyJoints {
  std::array<ArmJoints, 2> arm;  // by Side; all -1 where the skeleton has no two arms
  std::vector<int> spine;        // above the pelvis, upwards; the last one is the chest
  std::vector<int> neck;         // above the chest, upwards; the last one is the head
  bool has_arms() const { return arm[kLeftSide].shoulder >= 0; }
};

// `standing_m`: where the joints are when the body stands and faces +z, for skeletons whose names
// say nothing: the longest pair of chains to the two sides are the arms, the highest one the neck.
// `hips` are the tops of the legs.
BodyJoints body_joints(const Skeleton& skeleton, int pelvis, const std::array<int, 2>& hips,
                       std::span<const vec3> standing_m);

}  // namespace gaitpad
