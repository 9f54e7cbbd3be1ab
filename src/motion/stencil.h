// Interpolation between a cycle's samples.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// Catmull-Rom weights of four neighbours, between the second and the third.
inline std::array<double, 4> cubic_weights(double t) noexcept {
  return {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
          0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
}
// Weights of four neighbouring knots of a uniform cubic B-spline.
inline std::array<double, 4> spline_weights(double t) noexcept {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, (4.0 + t * t * (3.0 * t - 6.0)) / 6.0,
          (4.0 + s * s * (3.0 * s - 6.0)) / 6.0, t * t * t / 6.0};
}

// The four samples around a phase and their Catmull-Rom weights.
struct Stencil {
  std::array<int, 4> index;
  std::array<double, 4> weight;
};

inline Stencil stencil_at(double phase) noexcept {
  const double turns = phase - std::floor(phase);
  const double place = turns * kCycleSamples;
  const int i = std::min(static_cast<int>(place), kCycleSamples - 1);
  const double t = place - i;
  Stencil s;
  for (int k = 0; k < 4; ++k) s.index[k] = (i + k - 1 + kCycleSamples) % kCycleSamples;
  s.weight = cubic_weights(t);
  return s;
}

}  // namespace gaitpad
