// The words of a joint's name, for those who look for legs, arms and spine.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "motion/legs.h"

namespace gaitpad {

// "CC_Base_L_ToeBase" -> cc base l toe base; "LHipJoint" -> l hip joint; digits and marks separate,
// what stands before the last colon is left out.
std::vector<std::string> name_words(std::string_view name);

// Of a whole word: l, left, lft, r, right, rgt.
NamedSide named_side(std::string_view word);

}  // namespace gaitpad
