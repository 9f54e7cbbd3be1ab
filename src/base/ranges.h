// Sentences on numbers that are out of range, for check(): `scale is -1, outside [0.05, 20]`.
#pragma once
#include <cmath>
#include <optional>
#include <string>

#include "gaitpad/math.h"
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

// Checks each coordinate of a vector, `what.x` first: within -most .. most.
inline std::optional<Error> vector_problem(const std::string& what, const vec3& v, double most) {
  for (int axis = 0; axis < 3; ++axis) {
    if (auto problem = range_problem(what + "." + "xyz"[axis], v[axis], -most, most))
      return problem;
  }
  return std::nullopt;
}

// The error for an enumeration that has none of its values, which are 0 .. `last`.
template <class E>
std::optional<Error> choice_problem(const std::string& what, E value, E last) {
  return range_problem(what, static_cast<int>(value), 0.0, static_cast<int>(last));
}

}  // namespace gaitpad
