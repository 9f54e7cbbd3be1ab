// The robust solver of ik.cpp in floats, for chains side by side with up to three rows:
// theta += W J^T (J W J^T + l^2 I)^-1 dX inside joint limits (equation 5), repeated until the
// chain's point is at its goal.
#pragma once
#include "animation/solver_numbers.h"
#include "walk/lanes.h"

namespace gaitpad {
namespace {

inline constexpr float kLeastDamping_m2 = 1e-8f;  // above the rounding of floats
inline constexpr float kSolved_m = 1e-6f;         // an error that ends a solve
inline constexpr float kMostTurn_rad = 0.3f;      // of an angle, in one step
inline constexpr int kMostSolves = 40;            // steps of a solve
using Solver = SolverNumbers<float>;

// Solves (J W J^T + damping I) y = b by L D L^T; b becomes y.
template <class V>
void solve_three(int dofs, const V (*column)[3], const V* weight, const V& damping,
                 V (&b)[3]) noexcept {
  V m[3][3];
  for (int r = 0; r < 3; ++r)
    for (int s = 0; s <= r; ++s) m[r][s] = r == s ? damping : V{};
  for (int j = 0; j < dofs; ++j) {
    for (int r = 0; r < 3; ++r) {
      const V weighted = weight[j] * column[j][r];
      for (int s = 0; s <= r; ++s) m[r][s] = m[r][s] + weighted * column[j][s];
    }
  }
  V over[3];
  for (int k = 0; k < 3; ++k) {
    over[k] = 1.0f / most(m[k][k], all<V>(kLeastDamping_m2));
    for (int r = k + 1; r < 3; ++r) {
      const V l = m[r][k] * over[k];
      for (int s = k + 1; s <= r; ++s) m[r][s] = m[r][s] - l * m[s][k];
      m[k][r] = l;
    }
  }
  b[1] = b[1] - m[0][1] * b[0];
  b[2] = b[2] - m[0][2] * b[0] - m[1][2] * b[1];
  for (int k = 0; k < 3; ++k) b[k] = b[k] * over[k];
  b[1] = b[1] - m[1][2] * b[2];
  b[0] = b[0] - m[0][1] * b[1] - m[0][2] * b[2];
}

// Computes a step within the limits: an angle that it would carry past a limit goes to the limit
// exactly, and the others are solved again for what is left of the error.
template <class V, class Chain, std::size_t kDofs>
void step_within(const Chain& chain, const V (&column)[kDofs][3], const V (&angle_rad)[kDofs],
                 V (&error_m)[3], const V& damping, const Mask<V>& open,
                 V (&turn_rad)[kDofs]) noexcept {
  V weight[kDofs];
  for (int j = 0; j < chain.dofs; ++j) weight[j] = chain.weight[j], turn_rad[j] = V{};
  for (int round = 0; round <= chain.dofs; ++round) {
    V y[3] = {error_m[0], error_m[1], error_m[2]};
    solve_three(chain.dofs, column, weight, damping, y);
    bool stopped = false;
    for (int j = 0; j < chain.dofs; ++j) {
      const auto moves = weight[j] != V{};
      const V turn = weight[j] * (column[j][0] * y[0] + column[j][1] * y[1] + column[j][2] * y[2]);
      turn_rad[j] = moves ? turn : turn_rad[j];
      const V wanted = angle_rad[j] + turn_rad[j],
              allowed = least(most(wanted, chain.min_rad[j]), chain.max_rad[j]);
      const auto stops = both(both(open, moves), allowed != wanted);
      if (!any(stops)) continue;
      stopped = true;
      turn_rad[j] = stops ? V(allowed - angle_rad[j]) : turn_rad[j];
      weight[j] = stops ? V{} : weight[j];
      for (int r = 0; r < 3; ++r)
        error_m[r] = stops ? V(error_m[r] - column[j][r] * turn_rad[j]) : error_m[r];
    }
    if (!stopped) return;
  }
}

// Solves the chains that are `open` and leaves the best angles found. A Chain has the number type
// V, dofs (its number of angles, at most kDofs), weight (the greatest is 1), min_rad,
// max_rad, a type Place with error_m (0 in rows that do not count), place(), set_columns().
template <class Chain, class V, std::size_t kDofs>
void solve_chains(const Chain& chain, Mask<V> open, V (&angle_rad)[kDofs]) noexcept {
  typename Chain::Place places[2]{}, *place = &places[0], *best = &places[1];
  V next[kDofs], growth = all<V>(Solver::kGrowth), best_m2 = all<V>(1e30f), seen_m = all<V>(1e15f),
                 patience = all<V>(Solver::kPatience);
  for (int j = 0; j < chain.dofs; ++j)
    next[j] = angle_rad[j] = least(most(angle_rad[j], chain.min_rad[j]), chain.max_rad[j]);
  for (int k = 0;; ++k) {
    chain.place(next, *place);
    const V* e = place->error_m;
    const V m2 = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
    const auto better = both(open, m2 < best_m2);
    if (k > 0) {
      const V down = most(V(growth * Solver::kGrowthDown), all<V>(Solver::kGrowth)),
              up = growth * Solver::kGrowthUp;
      growth = better ? down : up;
    }
    for (int j = 0; j < chain.dofs; ++j) angle_rad[j] = better ? next[j] : angle_rad[j];
    // Usually all get better. A chain that is not open is placed where it was.
    if (!any(both(open, no(better)))) {
      std::swap(place, best);
    } else if (any(better)) {
      put_where<V>(better, *place, *best);
    }
    best_m2 = better ? m2 : best_m2;
    open = both(open, best_m2 > all<V>(kSolved_m * kSolved_m));
    const V error_m = root(best_m2);
    const auto falls =
        error_m < seen_m - Solver::kLeastGain * least(error_m, all<V>(Solver::kGainFrom_m));
    patience = falls ? all<V>(Solver::kPatience) : V(patience - 1.0f);
    seen_m = falls ? error_m : seen_m;
    open = both(open, patience > V{});
    if (k >= kMostSolves || !any(open)) return;
    V column[kDofs][3], error[3], turn[kDofs];
    chain.set_columns(*best, column);
    const V share = Solver::kFarthest_m / most(error_m, all<V>(Solver::kFarthest_m));
    for (int r = 0; r < 3; ++r) error[r] = share * best->error_m[r];
    const V damping = kLeastDamping_m2 +
                      growth * least(best_m2, all<V>(Solver::kFarthest_m * Solver::kFarthest_m));
    step_within(chain, column, angle_rad, error, damping, open, turn);
    V greatest{};
    for (int j = 0; j < chain.dofs; ++j) greatest = most(greatest, size(turn[j]));
    const V cap = kMostTurn_rad / most(greatest, all<V>(kMostTurn_rad));
    for (int j = 0; j < chain.dofs; ++j) {
      const V wanted = angle_rad[j] + cap * turn[j];
      next[j] = open ? least(most(wanted, chain.min_rad[j]), chain.max_rad[j]) : angle_rad[j];
    }
  }
}

// Divides weights by the greatest one.
template <class V, std::size_t kDofs>
void make_relative(int dofs, V (&weight)[kDofs]) noexcept {
  V largest = all<V>(1e-6f);
  for (int j = 0; j < dofs; ++j) largest = most(largest, weight[j]);
  const V over = 1.0f / largest;
  for (int j = 0; j < dofs; ++j) weight[j] = within(V(weight[j] * over), 0.0f, 1.0f);
}
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
