// Interpolation between a cycle's samples.
#pragma once
#include <algorithm>
#include <array>

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

inline double mixed(double a, double b, double share_a, double share_b) noexcept {
  return a * share_a + b * share_b;
}
// The knots of the periodic cubic B-spline through evenly spaced samples: the inverse of the filter
// [1 4 1] / 6, a recursive one with its pole, forwards and backwards (Unser 1993). T has
// mixed().
template <class T, std::size_t kCount>
std::array<T, kCount> spline_through(const std::array<T, kCount>& samples) noexcept {
  constexpr int n = static_cast<int>(kCount);
  constexpr double kPole = -0.26794919243112270;  // sqrt(3) - 2, a ratio
  constexpr int kReach = 28;                      // pole^kReach is below the rounding of a double
  static_assert(n >= kReach);
  std::array<T, kCount> once, knots;
  T sum{};
  for (int i = -kReach; i < n; ++i) {
    sum = mixed(samples[(i + n) % n], sum, 1.0, kPole);
    if (i >= 0) once[i] = sum;
  }
  sum = T{};
  for (int i = n - 1 + kReach; i >= 0; --i) {
    sum = mixed(once[i % n], sum, -6.0 * kPole, kPole);
    if (i < n) knots[i] = sum;
  }
  return knots;
}

// The four samples around a phase and their weights.
struct Stencil {
  std::array<int, 4> index;
  std::array<double, 4> weight;
};

inline Stencil stencil_at(double phase,
                          std::array<double, 4> (*weights)(double) = &cubic_weights) noexcept {
  const double place = fraction(phase) * kCycleSamples;
  const int i = std::min(static_cast<int>(place), kCycleSamples - 1);
  Stencil s;
  for (int k = 0; k < 4; ++k) s.index[k] = (i + k - 1 + kCycleSamples) % kCycleSamples;
  s.weight = weights(place - i);
  return s;
}

}  // namespace gaitpad
