// Finds the legs, spine, neck, head and arms of a skeleton: by joint names if they are known ones,
// else by the skeleton's shape. Solving, retargeting and drawing use these functions, so all of
// them mean the same joints.
//
// The functions run when a motion or a character is loaded; they allocate.
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

// The side and the body part that a joint's name states. A joint is named after the part that it
// turns or stands at.
enum class NamedSide { none, left, right };
enum class NamedPart {
  none,
  hip,
  knee,
  ankle,
  toe,
  collar,
  shoulder,   // the collar bone if an upper arm follows it ("LeftShoulder"), else the upper arm
  upper_arm,  // the joint at the upper end of the upper arm
  elbow,
  wrist,
  neck,
  head,
};
struct NamedJoint {
  NamedSide side = NamedSide::none;  // the side that the name states; none for neck and head
  NamedPart part = NamedPart::none;  // none for twist joints, fingers and the like as well
};
// Reads a joint's name. Prefixes such as "mixamorig:" or "CC_Base_" and upper or lower case do not
// matter.
NamedJoint named_joint(std::string_view name);

// Names of one leg's joints in the skeleton, given by hand; the caller fills it. A joint with an
// empty name is searched for.
struct LegNames {
  std::string hip, knee, ankle, toe;
};

// Finds both legs (indexed by Side). `motion` may still be in file units and may have any axis up.
// If the names do not tell them, the legs are the two lowest chains that hang on one joint in the
// motion's middle frame, tried with y up, then with z up. Left and right follow the names, else the
// geometry: toes point forward. Errors do not name the file: `no two legs ...`.
Result<std::array<LegJoints, 2>> find_legs(const Motion& motion,
                                           const std::array<LegNames, 2>& given = {});

// The lowest joint that carries both legs.
int pelvis_of(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs);

// True if `ancestor` is on the way from `joint` to the root; true also for a joint and itself.
bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint);

std::vector<int> children_of(const Skeleton& skeleton, int joint);
// The chain from the child of `top` down to `joint`, inclusive; from the root on if `top` is -1.
// Empty if they are the same joint.
std::vector<int> path_below(const Skeleton& skeleton, int top, int joint);

// Joint indices of one arm. Shoulder, elbow and wrist are all set or none is. Further joints may
// stand between two of them (twist joints).
struct ArmChain {
  int collar = -1;  // the lowest collar bone above the shoulder, -1: none
  int shoulder = -1, elbow = -1;
  int wrist = -1;     // wrist joint; an End Site if the skeleton has no hand
  int hand_end = -1;  // the farthest joint below the wrist, except for the thumb; -1: none
  bool is_found() const noexcept { return shoulder >= 0; }
};

// Indices of the joints above the legs; find_upper_body() fills them. A part that the skeleton
// lacks is empty or -1.
struct UpperBodyJoints {
  // Joints from above the pelvis up to the joint that carries arms and neck.
  std::vector<int> spine;
  std::vector<int> neck;  // joints from above that joint to below the head
  int head = -1;
  int head_top = -1;            // the highest joint on the head; the head itself if it has none
  std::array<ArmChain, 2> arm;  // indexed by Side
};

// Finds the joints above the legs. `position_m`: world positions of all joints in some pose, which
// has to be upright along +y if the names tell nothing. Never fails: in an unusual skeleton no arms
// are found.
UpperBodyJoints find_upper_body(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs,
                                int pelvis, std::span<const vec3> position_m);

}  // namespace gaitpad
