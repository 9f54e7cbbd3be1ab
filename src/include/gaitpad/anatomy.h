// Which joints are the legs: by name where the names are known, else by the skeleton's shape.
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/result.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {

// Joints of one leg given by hand. Empty: found.
struct LegNames {
  std::string hip, knee, ankle, toe;
};

// What a joint's name says. Prefixes such as "mixamorig:" or "CC_Base_" do not matter.
enum class NamedSide { none, left, right };
enum class NamedPart { none, hip, knee, ankle, toe };
struct NamedJoint {
  NamedSide side = NamedSide::none;
  NamedPart part = NamedPart::none;
};
NamedJoint named_joint(std::string_view name);

// Fills in motion.legs and motion.pelvis. `motion` may still be in file units and have any axis up:
// names come first; where they fail, the two lowest chains of the middle frame that hang on one
// joint, for y up and for z up. Left and right follow the names, else the geometry (toes point
// forward). Error without file name: `no two legs: ...`.
Result<std::array<LegJoints, 2>> find_legs(const Motion& motion,
                                           const std::array<LegNames, 2>& given = {});

// Lowest joint that carries both legs.
int pelvis_of(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs);

bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint);

// Which joints are arms, spine, neck and head: by name where the names are known, else by the
// skeleton's shape.

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
