// Smooth building blocks of the walk: tables, Hermite curves, filters, soft limits. They use + - *
// / alone, so they give the same bits everywhere. No heap; everything may be called in a tick.
#pragma once
#include <array>
#include <cstddef>

#include "gaitpad/math.h"

namespace gaitpad {

// Catmull-Rom through four neighbouring samples, t in [0,1] between b and c.
template <class T>
T catmull_rom(const T& a, const T& b, const T& c, const T& d, double t) noexcept {
  const double t2 = t * t, t3 = t2 * t;
  return 0.5 * ((2.0 * b) + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t2 +
                (3.0 * b - a - 3.0 * c + d) * t3);
}

// A periodic function of a phase, given by even samples over [0, 1).
template <std::size_t N>
struct PeriodicTable {
  std::array<double, N> value{};
  double at(double phase) const noexcept {
    const double x = (phase - std::floor(phase)) * N;
    const auto i = static_cast<std::size_t>(x) % N;
    return catmull_rom(value[(i + N - 1) % N], value[i], value[(i + 1) % N], value[(i + 2) % N],
                       x - std::floor(x));
  }
};

// A function of u in [0, 1], given by even samples including both ends; its slopes at the ends are
// one-sided.
template <std::size_t N>
struct Curve {
  std::array<double, N> value{};
  double at(double u) const noexcept {
    const double x = std::clamp(u, 0.0, 1.0) * (N - 1);
    const auto i = std::min(static_cast<std::size_t>(x), N - 2);
    const double before = i == 0 ? 2.0 * value[0] - value[1] : value[i - 1];
    const double after = i + 2 == N ? 2.0 * value[N - 1] - value[N - 2] : value[i + 2];
    return catmull_rom(before, value[i], value[i + 1], after, x - static_cast<double>(i));
  }
  double start_slope() const noexcept { return (value[1] - value[0]) * (N - 1); }
  double end_slope() const noexcept { return (value[N - 1] - value[N - 2]) * (N - 1); }
};

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
