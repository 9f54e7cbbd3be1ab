// What the names of joints above the legs say.
#pragma once
#include <string_view>

#include "motion/legs.h"

namespace gaitpad {

// `shoulder` is the upper arm's joint in some skeletons, the collar bone's in others.
enum class ArmPart { none, clavicle, shoulder, upper_arm, forearm, wrist, hand };
struct NamedArm {
  NamedSide side = NamedSide::none;
  ArmPart part = ArmPart::none;
};
// "mixamorig:LeftForeArm", "lhumerus", "rShldrBend", "UpArm_L", "LeftElbowJoint" ...; nothing for
// twist joints and fingers.
NamedArm named_arm(std::string_view name);
bool is_head_name(std::string_view name);

}  // namespace gaitpad
