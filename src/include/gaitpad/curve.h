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

// Cubic Hermite basis on [0, 1]: h00 carries the start value, h10 the start slope, h11 the end
// slope.
template <class V>
V h00(const V& s) noexcept {
  return 1.0 + s * s * (2.0 * s - 3.0);
}
template <class V>
V h10(const V& s) noexcept {
  return s * (1.0 - s) * (1.0 - s);
}
template <class V>
V h11(const V& s) noexcept {
  return s * s * (s - 1.0);
}

// Moves a point for one tick along the cubic from its position x and velocity v to the goal's,
// which it reaches after `remaining_s`. A goal that stays gives one cubic; a goal that moves bends
// it.
template <class T, class R>
void approach(T& x, T& v, const T& goal_x, const T& goal_v, const R& remaining_s,
              double dt_s) noexcept {
  const auto s = dt_s / remaining_s;
  const T d = goal_x - x;
  const T v0 = v * remaining_s, v1 = goal_v * remaining_s;
  const T c2 = 3.0 * d - 2.0 * v0 - v1, c3 = v0 + v1 - 2.0 * d;
  x = x + (v0 + (c2 + c3 * s) * s) * s;
  v = (v0 + (2.0 * c2 + 3.0 * c3 * s) * s) / remaining_s;
}

// A difference that fades away along a cubic: `value` and `slope` at 0, both 0 from `duration` on.
// This type and those below may hold values of several walkers side by side (V as in
// gaitpad/math.h).
template <class V>
struct FadeOf {
  V value{}, slope{};  // slope per unit of the argument
  V duration = V{} + 1.0;
  V at(const V& x) const noexcept {
    const V s = x / duration;
    return x >= duration ? V{} : value * h00(s) + slope * duration * h10(s);
  }
};
using Fade = FadeOf<double>;

// A difference that fades away smoothly: its value, rate and acceleration, per tick. advance()
// moves it on by one tick along the quintic that ends in 0, at rest, after `remaining` ticks.
template <class T>
struct SmoothFade {
  T x{}, v{}, a{};
  void advance(double remaining) noexcept {
    if (remaining > 1.0) {
      move(remaining);
    } else {
      *this = {};
    }
  }
  // Advances a fade with more than one remaining tick.
  template <class V>
  void move(const V& n) noexcept {
    const V s = 1.0 / n;
    // Slope and half the curvature, for the whole of the remaining time.
    const T p = v * n, q = a * (0.5 * n * n);
    const T c3 = -10.0 * x - 6.0 * p - 3.0 * q, c4 = 15.0 * x + 8.0 * p + 3.0 * q,
            c5 = -6.0 * x - 3.0 * p - q;
    x = x + (p + (q + (c3 + (c4 + c5 * s) * s) * s) * s) * s;
    v = (p + (2.0 * q + (3.0 * c3 + (4.0 * c4 + 5.0 * c5 * s) * s) * s) * s) * s;
    a = (2.0 * q + (6.0 * c3 + (12.0 * c4 + 20.0 * c5 * s) * s) * s) * (s * s);
  }
};

// The coefficients of a Damped filter, computed once for all values with the same time constant and
// tick.
struct Damping {
  double pull, keep, dt_s;
  Damping(double time_constant_s, double tick_s) noexcept : dt_s(tick_s) {
    const double w = tick_s / time_constant_s;
    pull = w / time_constant_s;
    keep = 1.0 / ((1.0 + w) * (1.0 + w));
  }
};

// Critically damped second-order filter of a value x and its rate v. Implicit Euler: stable for
// every dt.
template <class V>
struct Damped {
  V x{};
  V v{};
  void advance(const V& goal, const Damping& damping) noexcept {
    v = (v + (goal - x) * damping.pull) * damping.keep;
    // Flush denormals, which are slow to compute with.
    v = ((v < 1e-100) & (v > -1e-100)) ? V{} : v;
    x = x + v * damping.dt_s;
  }
  void advance(const V& goal, double time_constant_s, double dt_s) noexcept {
    advance(goal, Damping(time_constant_s, dt_s));
  }
};

// max(x, 0), min(a, b) and max(a, b) with their corner rounded by a parabola over |x| < width.
// Arguments that are equal for all walkers may be doubles.
template <class V, class W>
V soft_positive(const V& x, const W& width) noexcept {
  const V rounded = (x + width) * (x + width) / (4.0 * width);
  const V above = x >= width ? x : rounded;
  return x <= -width ? V{} : above;
}
template <class V, class B, class W>
V soft_min(const V& a, const B& b, const W& width) noexcept {
  return a - soft_positive(a - b, width);
}
template <class V, class B, class W>
V soft_max(const V& a, const B& b, const W& width) noexcept {
  return a + soft_positive(b - a, width);
}

// Slope at the last of three evenly spaced values, per spacing (second order).
template <class T>
T end_slope(const T& before_last, const T& last, const T& now) noexcept {
  return 0.5 * (3.0 * now - 4.0 * last + before_last);
}

}  // namespace gaitpad
