// The robust solver: theta += W J^T (J W J^T + l^2 I)^-1 dX inside joint limits, of one chain (V is
// a double: ik.cpp) and of legs side by side (a register of several: leg_ik_lanes.h). Every lane
// gets the bits that it gets alone.
//
// l^2 = damping^2 + growth |dX|^2 (after Sugihara 2011, "Solvability-unconcerned inverse kinematics
// by the Levenberg-Marquardt method"); growth rises where a step makes the error greater.
#pragma once
#include <limits>

#include "base/lanes.h"
#include "gaitpad/ik.h"

namespace gaitpad {
namespace {

inline constexpr double kLeastDampingSquared = 1e-20;
inline constexpr double kGrowth = 0.1;
inline constexpr double kGrowthUp = 8.0, kGrowthDown = 0.25;
inline constexpr double kFarthest = 0.5;  // the largest |dX| that one step uses, metres
// The error counts as constant if kPatience iterations together reduce it by less than the share
// kLeastGain of itself, or of kGainFrom metres if that is larger.
inline constexpr int kPatience = 6;
inline constexpr double kLeastGain = 0.001;
inline constexpr double kGainFrom = 0.1;

// Turns a frame about its own first axis: (y, z) are the other two, in cyclic order.
template <class Axis, class V>
inline void turn(Axis& y, Axis& z, const V& sine, const V& cosine) noexcept {
  const Axis old = y;
  y = cosine * old + sine * z;
  z = cosine * z - sine * old;
}

// An entry of the Jacobian is d . (a x (p - q)), for direction d, point p and an axis a through q.
// It equals a . m + n . d with the moments m = p x d and n = q x a.
template <class Axis>
inline auto jacobian_entry(const Axis& a, const Axis& n, const Axis& d, const Axis& m) noexcept {
  return (a.x * m.x + a.y * m.y) + (a.z * m.z + n.x * d.x) + (n.y * d.y + n.z * d.z);
}

// What a System provides: kRows, kDofs (at most) and `dofs`; weight, min_rad and max_rad of each
// DOF; a Place with dx, the distance of each row from its goal, and the sum of their squares;
// place(), set_columns(), keep() and trace(). kWeighted: lanes that are `shared` take their steps
// from share_step().
template <class System>
using RowsIn = std::array<typename System::V, System::kRows>;
template <class System>
using AnglesIn = std::array<typename System::V, System::kDofs>;
template <class System>
using ColumnsIn = std::array<RowsIn<System>, System::kDofs>;

// The linear system of one step.
template <class System>
struct StepIn {
  AnglesIn<System> weight, first_rad;  // first_rad: a turn that is made before the rows are closed
  RowsIn<System> give, error;          // allowance of each row, and the error that is left to close
};

// Solves (J W J^T + a diagonal) y = b by L D L^T. No pivot is less than the diagonal, so none is
// checked.
template <class System>
inline void solve_rows(const ColumnsIn<System>& column, int dofs, const StepIn<System>& step,
                       RowsIn<System>& y) noexcept {
  using V = typename System::V;
  constexpr int n = System::kRows;
  std::array<RowsIn<System>, n> m;
  for (int r = 0; r < n; ++r) {
    for (int s = 0; s <= r; ++s) m[r][s] = (step.weight[0] * column[0][r]) * column[0][s];
  }
  for (int j = 1; j < dofs; ++j) {
    for (int r = 0; r < n; ++r) {
      const V weighted = step.weight[j] * column[j][r];
      for (int s = 0; s <= r; ++s) m[r][s] += weighted * column[j][s];
    }
  }
  for (int r = 0; r < n; ++r) m[r][r] += step.give[r];
  RowsIn<System> reciprocal;
  for (int k = 0; k < n; ++k) {
    reciprocal[k] = 1.0 / m[k][k];
    for (int r = k + 1; r < n; ++r) {
      const V l = m[k][r] = m[r][k] * reciprocal[k];
      for (int s = k + 1; s <= r; ++s) m[r][s] -= l * m[s][k];
    }
  }
  y = step.error;
  for (int k = 0; k < n; ++k) {
    for (int r = k + 1; r < n; ++r) y[r] -= m[k][r] * y[k];
  }
  for (int k = 0; k < n; ++k) y[k] *= reciprocal[k];
  for (int k = n - 1; k > 0; --k) {
    for (int r = 0; r < k; ++r) y[r] -= m[r][k] * y[k];
  }
}

// Row j of J^T times y.
template <class Rows>
inline auto product(const Rows& column, const Rows& y) noexcept {
  auto even = column[0] * y[0], odd = column[1] * y[1];
  for (std::size_t r = 2; r < y.size(); r += 2)
    even += column[r] * y[r], odd += column[r + 1] * y[r + 1];
  return even + odd;
}

// Solves for a step within the limits. A DOF that the step would carry past a limit moves exactly
// to the limit, its column leaves the system, and the system is solved again for the others. The
// result depends continuously on goal and pose. A lane that is done finds the same step again.
template <class System>
inline void limited_step(const System& system, const ColumnsIn<System>& column,
                         StepIn<System>& step, const AnglesIn<System>& angles_rad,
                         const MaskOf<typename System::V>& lanes,
                         AnglesIn<System>& delta) noexcept {
  using V = typename System::V;
  RowsIn<System> y;
  for (int j = 0; j < system.dofs; ++j) delta[j] = V{};
  for (int round = 0; round <= system.dofs; ++round) {
    solve_rows<System>(column, system.dofs, step, y);
    bool frozen = false;
    for (int j = 0; j < system.dofs; ++j) {
      const auto moves = step.weight[j] != V{};
      V turn = step.weight[j] * product(column[j], y);
      if constexpr (System::kWeighted) turn += step.first_rad[j];
      delta[j] = moves ? turn : delta[j];
      const V wanted = angles_rad[j] + delta[j],
              allowed = min_of(max_of(wanted, system.min_rad[j]), system.max_rad[j]);
      const auto stops = lanes & moves & (allowed != wanted);
      if (!any(stops)) continue;
      frozen = true;
      delta[j] = stops ? allowed - angles_rad[j] : delta[j];
      step.weight[j] = stops ? V{} : step.weight[j];
      V closes = delta[j];
      if constexpr (System::kWeighted) closes -= step.first_rad[j];
      for (int r = 0; r < System::kRows; ++r)
        step.error[r] = stops ? step.error[r] - column[j][r] * closes : step.error[r];
    }
    if (!frozen) return;
  }
}

template <class V>
struct RobustSolution {
  V squares, iterations;  // squared error of the best pose; number of iterations, a whole number
};

// Iterates from `angles_rad` until the tolerance is met, the error no longer falls or the
// iterations are used up, and leaves the best pose there. `lanes`: the lanes to be solved.
template <class System>
inline RobustSolution<typename System::V> iterate(System& system, const RobustOptions& options,
                                                  int max_iterations,
                                                  MaskOf<typename System::V> lanes,
                                                  AnglesIn<System>& angles_rad,
                                                  typename System::Place& best) noexcept {
  using V = typename System::V;
  AnglesIn<System> next = angles_rad;
  typename System::Place place;
  const V infinite = all_of<V>(std::numeric_limits<double>::infinity());
  V growth = all_of<V>(kGrowth), iterations{}, seen_m = infinite, seen_at{};
  MaskOf<V> settled = V{} != V{};
  const double enough = options.tolerance_m * options.tolerance_m;
  for (int k = 0;; ++k) {
    system.place(next, k == 0 ? best : place);
    if (k > 0) {
      MaskOf<V> better = lanes & (place.squares < best.squares);
      if constexpr (System::kWeighted) better |= lanes & system.shared;
      growth = better ? max_of(V(growth * kGrowthDown), all_of<V>(kGrowth)) : growth * kGrowthUp;
      for (int j = 0; j < system.dofs; ++j) angles_rad[j] = better ? next[j] : angles_rad[j];
      if (any(better)) system.keep(better, place, best);
    }
    iterations = lanes ? all_of<V>(k) : iterations;
    system.trace(angles_rad, best.squares);
    MaskOf<V> done = best.squares <= all_of<V>(enough);
    if constexpr (System::kWeighted) done = settled | (done & not_of(system.shared));
    lanes &= not_of(done);
    if (!any(lanes) || k >= max_iterations) break;
    const V error_m = sqrt_of(best.squares);
    const auto falls = error_m < seen_m - kLeastGain * min_of(error_m, all_of<V>(kGainFrom));
    seen_at = falls ? all_of<V>(k) : seen_at;
    seen_m = falls ? error_m : seen_m;
    MaskOf<V> falling = all_of<V>(k) - seen_at < all_of<V>(kPatience);
    if constexpr (System::kWeighted) falling |= system.shared;
    lanes &= falling & (best.squares < infinite);
    if (!any(lanes)) break;

    ColumnsIn<System> column;
    system.set_columns(best, column);
    constexpr double most = kFarthest * kFarthest;
    const V share = best.squares > all_of<V>(most) ? kFarthest / error_m : all_of<V>(1.0);
    StepIn<System> step;
    step.weight = system.weight;
    const V damping = std::max(options.damping * options.damping, kLeastDampingSquared) +
                      growth * min_of(best.squares, all_of<V>(most));
    // A loop instead of std::array's fill(), for which the linker might take the copy compiled for
    // wider registers.
    for (int r = 0; r < System::kRows; ++r) {
      step.give[r] = damping;
      step.error[r] = share * best.dx[r];
    }
    if constexpr (System::kWeighted) system.share_step(best, angles_rad, column, step);
    AnglesIn<System> delta;
    limited_step<System>(system, column, step, angles_rad, lanes, delta);
    V greatest{};
    for (int j = 0; j < system.dofs; ++j) greatest = max_of(greatest, abs_of(delta[j]));
    V cap_rad = all_of<V>(options.max_step_rad);
    if constexpr (System::kWeighted) {
      cap_rad = system.shared ? all_of<V>(System::kMostStep_rad) : cap_rad;
      settled = system.settles(best, greatest, k + 1);
    }
    const V cap = greatest > cap_rad ? cap_rad / greatest : all_of<V>(1.0);
    for (int j = 0; j < system.dofs; ++j) {
      const V wanted = angles_rad[j] + cap * delta[j];
      next[j] = min_of(max_of(wanted, system.min_rad[j]), system.max_rad[j]);
      next[j] = lanes ? next[j] : angles_rad[j];
    }
  }
  return {best.squares, iterations};
}

}  // namespace
}  // namespace gaitpad
