// A character's build, as far as it differs from the motion's own skeleton.
#pragma once
#include <string>

#include "base/result.h"

namespace gaitpad {

struct Character {
  std::string name = "as in the motion file";
  double scale = 1.0;      // all bones
  double leg_ratio = 1.0;  // thigh, shank and foot bones, on top of scale
  std::string skeleton;    // BVH file whose skeleton the character brings, empty: the motion's own
};
Result<Character> load_character(const std::string& path);

}  // namespace gaitpad
