// Which joints of a skeleton are legs, spine, neck, head and arms. Joints are found by their names
// where the names say it, else by the skeleton's shape. Whoever solves, retargets or draws a limb
// asks here, so all of them mean the same joints.
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

// What the name of one joint says. A joint is named after the part that it turns or stands at.
enum class NamedSide { none, left, right };
enum class NamedPart {
  none,
  hip,
  knee,
  ankle,
  toe,
  collar,
  shoulder,   // the collar bone where an upper arm follows ("LeftShoulder"), else the upper arm
  upper_arm,  // the joint at the upper end of the upper arm
  elbow,
  wrist,
  neck,
  head,
};
struct NamedJoint {
  NamedSide side = NamedSide::none;  // none for neck and head
  NamedPart part = NamedPart::none;  // none also for twist joints, fingers and the like
};
// Prefixes such as "mixamorig:" or "CC_Base_" do not matter, nor do upper and lower case.
NamedJoint named_joint(std::string_view name);

// Joints of one leg given by hand, by their names in the skeleton; the caller fills it. Empty:
// found.
struct LegNames {
  std::string hip, knee, ankle, toe;
};

// Finds both legs (indexed by Side). `motion` may still be in file units and may have any axis up.
// Names come first. Where they fail, the legs are the two lowest chains that hang on one joint in
// the motion's middle frame, tried with y up, then with z up. Left and right follow the names, else
// the geometry: toes point forward. Errors do not name the file: `no two legs ...`.
Result<std::array<LegJoints, 2>> find_legs(const Motion& motion,
                                           const std::array<LegNames, 2>& given = {});

// The lowest joint that carries both legs.
int pelvis_of(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs);

// True also for a joint and itself.
bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint);

// Joint indices of one arm. Shoulder, elbow and wrist are all set or none is. Further joints may
// stand between two of them (twist joints).
struct ArmChain {
  int collar = -1;  // the lowest collar bone above the shoulder, -1: none
  int shoulder = -1, elbow = -1;
  int wrist = -1;     // an End Site where the skeleton has no hand
  int hand_end = -1;  // the farthest joint below the wrist, not of the thumb; -1: none
  bool is_found() const noexcept { return shoulder >= 0; }
};

// Of find_upper_body(): joint indices. What a skeleton lacks is empty or -1.
struct UpperBodyJoints {
  std::vector<int> spine;  // from above the pelvis up to the joint that carries arms and neck
  std::vector<int> neck;   // from above that joint to below the head
  int head = -1;
  int head_top = -1;            // the highest joint on the head, or the head itself
  std::array<ArmChain, 2> arm;  // indexed by Side
};

// Finds what is above the legs. `position_m`: world positions of all joints in some pose, which has
// to be upright along +y if the names say nothing. Never fails: an odd skeleton has no arms.
UpperBodyJoints find_upper_body(const Skeleton& skeleton, const std::array<LegJoints, 2>& legs,
                                int pelvis, std::span<const vec3> position_m);

}  // namespace gaitpad
