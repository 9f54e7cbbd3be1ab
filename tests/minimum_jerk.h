// How a thumb moves a stick.
#pragma once
#include <algorithm>

namespace gaitpad {

// Share of a movement of people that is done after the share `u` of its time: Flash and Hogan's
// path of least jerk, 0 .. 1.
inline double minimum_jerk(double u) {
  const double t = std::clamp(u, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

}  // namespace gaitpad
