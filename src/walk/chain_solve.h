// How a tick's chains of arms and spine are solved, and the angles of their joints.
#pragma once
#include "animation/robust_solver.h"
#include "walk/lanes.h"

namespace gaitpad {
namespace {

// The damping's square is above the rounding of floats.
inline constexpr RobustOptions kOfTick{.damping = 1e-4, .max_iterations = 40};

// The share of a joint's own movement that the others take over if its relative weight is w.
// Fitted to the range of a hip after two iterations of equation (5).
template <class V>
V held_back(const V& w) noexcept {
  const V square = w * w;
  return 0.8f * (1.0f - square * square);
}

// --- Angles of a joint ---------------------------------------------------------------------------

// The angle with a sine and a cosine that are proportional to y and x, from -pi to pi.
template <class V>
V arc_of(const V& y, const V& x) noexcept {
  const V length = root(V(x * x + y * y)), over = 1.0f / most(length, all<V>(1e-12f)), s = y * over,
          c = x * over;
  // Tangents of a half, a quarter and an eighth of the angle.
  const V behind = (1.0f - c) / (s < V{} ? least(s, all<V>(-1e-6f)) : most(s, all<V>(1e-6f))),
          half = c < V{} ? behind : V(s / (1.0f + most(c, V{}))),
          quarter = half / (1.0f + root(V(1.0f + half * half))),
          eighth = quarter / (1.0f + root(V(1.0f + quarter * quarter)));
  return 8.0f * arc_tangent_small(eighth);
}

// Angles of q = Rx(x) Rz(z) Ry(y), z within a right angle (as angles_xzy() of leg_pose.h).
template <class V>
void angles_xzy(const Turn<V>& q, V& x, V& z, V& y) noexcept {
  const Vec<V> up = q * Vec<V>{V{}, all<V>(1.0f), V{}};
  x = arc_of(up.z, up.y);
  z = arc_of(V(-up.x), V(root(V(up.y * up.y + up.z * up.z))));
  V xs, xc, zs, zc;
  sin_cos(V(0.5f * x), xs, xc);
  sin_cos(V(0.5f * z), zs, zc);
  const Turn<V> first = Turn<V>{xc, xs, V{}, V{}} * Turn<V>{zc, V{}, V{}, zs},
                rest = back(first) * q;
  const auto other = rest.w < V{};
  y = 2.0f * arc_of(other ? V(-rest.y) : rest.y, other ? V(-rest.w) : rest.w);
}
template <class V>
Turn<V> turn_xzy(const V& x, const V& z, const V& y) noexcept {
  V xs, xc, zs, zc, ys, yc;
  sin_cos(V(0.5f * x), xs, xc);
  sin_cos(V(0.5f * z), zs, zc);
  sin_cos(V(0.5f * y), ys, yc);
  return Turn<V>{xc, xs, V{}, V{}} * Turn<V>{zc, V{}, V{}, zs} * Turn<V>{yc, V{}, ys, V{}};
}
template <class V>
V within_half_turn(const V& angle_rad) noexcept {
  return angle_rad - kTurn_rad * rounded(V(angle_rad * 0.15915494f));
}

}  // namespace
}  // namespace gaitpad
