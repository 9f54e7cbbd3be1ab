// The robust solver: theta += W J^T (J W J^T + l^2 I)^-1 dX (equation 5, damped) inside joint
// limits, repeated until the chain's points are at their goals. l^2 = damping^2 + growth |dX|^2
// (after Sugihara 2011, "Solvability-unconcerned inverse kinematics by the Levenberg-Marquardt
// method"). In doubles for ik.cpp; in floats, side by side, for a tick's chains.
#pragma once
#include <algorithm>
#include <limits>

#include "base/masks.h"
#include "gaitpad/ik.h"

namespace gaitpad {

template <class T>
struct SolverNumbers {
  // l^2 is kGrowth of the squared error; this share grows after a step that makes the error
  // greater, and falls again after others.
  static constexpr T kGrowth = T(0.1), kGrowthUp = T(8.0), kGrowthDown = T(0.25);
  static constexpr T kFarthest_m = T(0.5);  // the greatest error that one step uses
  // The error counts as constant if kPatience steps together reduce it by less than the share
  // kLeastGain of itself, or of kGainFrom_m if that is less.
  static constexpr int kPatience = 6;
  static constexpr T kLeastGain = T(0.001), kGainFrom_m = T(0.1);
};

// Without a name: units with different instruction sets have a copy each.
namespace {

// Solves (J W J^T + diag(damping)) y = b by L D L^T; b becomes y. J is given by its columns, one
// for each angle. But for rounding no pivot is less than its damping.
template <int kRows, class Columns, class Weights, class Row>
void solve_rows(const Columns& column, int dofs, const Weights& weight, const Row& damping,
                Row& b) noexcept {
  using V = std::remove_cvref_t<decltype(b[0])>;
  V m[kRows][kRows], reciprocal[kRows];
  for (int r = 0; r < kRows; ++r)
    for (int s = 0; s <= r; ++s) m[r][s] = (weight[0] * column[0][r]) * column[0][s];
  for (int j = 1; j < dofs; ++j) {
    for (int r = 0; r < kRows; ++r) {
      const V weighted = weight[j] * column[j][r];
      for (int s = 0; s <= r; ++s) m[r][s] = m[r][s] + weighted * column[j][s];
    }
  }
  for (int r = 0; r < kRows; ++r) m[r][r] = m[r][r] + damping[r];
  for (int k = 0; k < kRows; ++k) {
    reciprocal[k] = 1.0f / most(m[k][k], damping[k]);
    for (int r = k + 1; r < kRows; ++r) {
      const V l = m[k][r] = m[r][k] * reciprocal[k];
      for (int s = k + 1; s <= r; ++s) m[r][s] = m[r][s] - l * m[s][k];
    }
  }
  for (int k = 0; k < kRows; ++k)
    for (int r = k + 1; r < kRows; ++r) b[r] = b[r] - m[k][r] * b[k];
  for (int k = 0; k < kRows; ++k) b[k] = b[k] * reciprocal[k];
  for (int k = kRows - 1; k > 0; --k)
    for (int r = 0; r < k; ++r) b[r] = b[r] - m[r][k] * b[k];
}
// An angle's change by y.
template <int kRows, class Column, class Row>
auto product(const Column& column, const Row& y) noexcept {
  auto sum = column[0] * y[0];
  for (int r = 1; r < kRows; ++r) sum = sum + column[r] * y[r];
  return sum;
}

// Computes a step within the limits: an angle that it would carry past a limit goes to the limit
// exactly, its column leaves the system, and the others are solved again for what is left of the
// error. The result depends continuously on goal and pose.
template <class V, class Chain, class Columns, class Angles, class Row>
void step_within(const Chain& chain, const Columns& column, const Angles& angle_rad, Row& error_m,
                 const V& damping, const Mask<V>& open, Angles& turn_rad) noexcept {
  Angles weight;
  Row y, give;
  for (int j = 0; j < chain.dofs; ++j) weight[j] = chain.weight[j], turn_rad[j] = V{};
  for (V& of_row : give) of_row = damping;
  for (int round = 0; round <= chain.dofs; ++round) {
    std::copy_n(&error_m[0], Chain::kRows, &y[0]);
    solve_rows<Chain::kRows>(column, chain.dofs, weight, give, y);
    bool stopped = false;
    for (int j = 0; j < chain.dofs; ++j) {
      const auto moves = weight[j] != V{};
      const V turn = weight[j] * product<Chain::kRows>(column[j], y);
      turn_rad[j] = moves ? turn : turn_rad[j];
      const V wanted = angle_rad[j] + turn_rad[j],
              allowed = least(most(wanted, chain.min_rad[j]), chain.max_rad[j]);
      const auto stops = both(both(open, moves), allowed != wanted);
      if (!any(stops)) continue;
      stopped = true;
      turn_rad[j] = stops ? V(allowed - angle_rad[j]) : turn_rad[j];
      weight[j] = stops ? V{} : weight[j];
      for (int r = 0; r < Chain::kRows; ++r)
        error_m[r] = stops ? V(error_m[r] - column[j][r] * turn_rad[j]) : error_m[r];
    }
    if (!stopped) return;
  }
}

// Divides weights by the greatest one.
template <class Weights>
void make_relative(int dofs, Weights& weight) noexcept {
  using V = std::remove_cvref_t<decltype(weight[0])>;
  V largest = all<V>(1e-6f);
  for (int j = 0; j < dofs; ++j) largest = most(largest, weight[j]);
  const V over = 1.0f / largest;
  for (int j = 0; j < dofs; ++j) weight[j] = least(most(V(weight[j] * over), V{}), all<V>(1.0f));
}

template <class V>
struct Solved {
  V squares{};  // |dX|^2 of the best angles
  int steps = 0;
};
struct Unseen {
  template <class Angles, class V>
  void operator()(const Angles&, const V&) const noexcept {}
};

// Solves the chains that are `open` and leaves the best angles found. A Chain has the number type
// V, kRows, dofs (its number of angles), weight (the greatest is 1), min_rad, max_rad, a type Place
// of numbers V alone with error_m (0 in rows that do not count), place(), set_columns(). `seen` is
// called with the best angles after each step. It ends when the tolerance is met, the error no
// longer falls or `max_iterations` are used up; `max_tries` is not read.
template <class Chain, class Angles, class Seen = Unseen>
Solved<typename Chain::V> solve_chains(const Chain& chain, const RobustOptions& options,
                                       Mask<typename Chain::V> open, Angles& angle_rad,
                                       const Seen& seen = {}) noexcept {
  using V = typename Chain::V;
  using T = Scalar<V>;
  using Numbers = SolverNumbers<T>;
  constexpr int kRows = Chain::kRows;
  constexpr T kFar = std::numeric_limits<T>::infinity();
  const T tolerance_m = T(options.tolerance_m), damping_m = T(options.damping),
          most_turn_rad = T(options.max_step_rad);
  typename Chain::Place places[2]{}, *place = &places[0], *best = &places[1];
  Angles next;
  V growth = all<V>(Numbers::kGrowth), best_m2 = all<V>(kFar), seen_m = all<V>(kFar),
    patience = all<V>(Numbers::kPatience);
  for (int j = 0; j < chain.dofs; ++j)
    next[j] = angle_rad[j] = least(most(angle_rad[j], chain.min_rad[j]), chain.max_rad[j]);
  for (int k = 0;; ++k) {
    chain.place(next, *place);
    const V m2 = product<kRows>(place->error_m, place->error_m);
    const auto better = both(open, m2 < best_m2);
    if (k > 0) {
      const V down = most(V(growth * Numbers::kGrowthDown), all<V>(Numbers::kGrowth)),
              up = growth * Numbers::kGrowthUp;
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
    seen(angle_rad, best_m2);
    open = both(open, best_m2 > all<V>(tolerance_m * tolerance_m));
    const V error_m = root(best_m2);
    const auto falls =
        error_m < seen_m - Numbers::kLeastGain * least(error_m, all<V>(Numbers::kGainFrom_m));
    patience = falls ? all<V>(Numbers::kPatience) : V(patience - T(1));
    seen_m = falls ? error_m : seen_m;
    open = both(open, patience > V{});
    if (k >= options.max_iterations || !any(open)) return {best_m2, k};
    V column[sizeof(Angles) / sizeof(V)][kRows], error[kRows];
    Angles turn;
    chain.set_columns(*best, column);
    const V share = Numbers::kFarthest_m / most(error_m, all<V>(Numbers::kFarthest_m));
    for (int r = 0; r < kRows; ++r) error[r] = share * best->error_m[r];
    const V damping = damping_m * damping_m +
                      growth * least(best_m2, all<V>(Numbers::kFarthest_m * Numbers::kFarthest_m));
    step_within<V>(chain, column, angle_rad, error, damping, open, turn);
    V greatest{};
    for (int j = 0; j < chain.dofs; ++j) greatest = most(greatest, size(turn[j]));
    const V cap = most_turn_rad / most(greatest, all<V>(most_turn_rad));
    for (int j = 0; j < chain.dofs; ++j) {
      const V wanted = angle_rad[j] + cap * turn[j];
      next[j] = open ? least(most(wanted, chain.min_rad[j]), chain.max_rad[j]) : angle_rad[j];
    }
  }
}

}  // namespace
}  // namespace gaitpad
