// Numbers as status lines and the window show them: without a negative zero, which would look like
// a movement.
#pragma once
#include <string>

namespace gaitpad {

// The value with `decimals` digits after the point, with a '-' if one of the digits is not 0. "-"
// if it is not finite.
std::string shown_number(double value, int decimals);
// The same with a '+' if there is no '-'.
std::string signed_number(double value, int decimals);

}  // namespace gaitpad
