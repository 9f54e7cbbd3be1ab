// Smooth building blocks of the walk: filters and soft limits. They use + - * / alone, so they give
// the same bits everywhere. No heap; everything may be called in a tick.
#pragma once
#include <array>
#include <cstddef>

#include "gaitpad/math.h"

namespace gaitpad {

// The coefficients of a critically damped second-order filter of a value x and its rate v, by
// implicit Euler, which is stable for every tick:
//   v = (v + (goal - x) * pull) * keep, x = x + v * dt_s
struct Damping {
  double pull, keep, dt_s;
  Damping(double time_constant_s, double tick_s) noexcept : dt_s(tick_s) {
    const double w = tick_s / time_constant_s;
    pull = w / time_constant_s;
    keep = 1.0 / ((1.0 + w) * (1.0 + w));
  }
};

// max(x, 0) with its corner rounded by a parabola over |x| < width.
inline double soft_positive(double x, double width) noexcept {
  const double rounded = (x + width) * (x + width) / (4.0 * width);
  return x <= -width ? 0.0 : x >= width ? x : rounded;
}

}  // namespace gaitpad
