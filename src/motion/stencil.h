// How a cycle's samples are read between them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

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
  s.weight[0] = 0.5 * t * (-1.0 + t * (2.0 - t));
  s.weight[1] = 1.0 + 0.5 * t * t * (3.0 * t - 5.0);
  s.weight[2] = 0.5 * t * (1.0 + t * (4.0 - 3.0 * t));
  s.weight[3] = 0.5 * t * t * (t - 1.0);
  return s;
}

}  // namespace gaitpad
