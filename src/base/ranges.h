// Sentences on numbers that are out of range, for check(): `scale is -1, outside [0.05, 20]`.
#pragma once
#include <cmath>
#include <optional>
#include <string>

#include "gaitpad/result.h"

namespace gaitpad {

// The number as printf's %.6g writes it in the C locale.
std::string short_number(double value);

// The error for a value outside [least, most] or NaN.
inline std::optional<Error> range_problem(const std::string& what, double value, double least,
                                          double most) {
  if (value >= least && value <= most) return std::nullopt;
  return Error{what + " is " + short_number(value) + ", outside [" + short_number(least) + ", " +
               short_number(most) + "]"};
}

}  // namespace gaitpad
