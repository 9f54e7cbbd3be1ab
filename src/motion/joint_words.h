// The words that joints' names are made of: "CC_Base_L_ToeBase" is cc, base, l, toe, base.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "motion/legs.h"

namespace gaitpad {

// Lower case; what stands before a colon ("mixamorig:"), digits and marks are left out.
std::vector<std::string> name_words(std::string_view name);
NamedSide side_of_word(std::string_view word);
// Of joints beside or inside a bone, never at its end: twist, share, nub ...
bool is_helper_word(std::string_view word);

}  // namespace gaitpad
