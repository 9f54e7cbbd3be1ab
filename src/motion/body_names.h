// What a joint's name says about arms, neck and head. Part of body_joints.
#pragma once
#include <string_view>

#include "motion/legs.h"

namespace gaitpad {

enum class BodyPart {
  none,
  collar,
  shoulder,   // "LeftShoulder": the collar where an upper arm follows, else the upper arm itself
  upper_arm,  // the joint at its upper end
  elbow,
  wrist,
  neck,
  head,
};
struct BodyName {
  NamedSide side = NamedSide::none;
  BodyPart part = BodyPart::none;
};
// Twist joints, fingers and the like are none.
BodyName body_name(std::string_view name);

}  // namespace gaitpad
