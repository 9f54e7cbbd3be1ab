// Numbers of the robust solver, and its linear system: for ik.cpp in doubles, and for a tick's
// chains in floats.
#pragma once
#include <type_traits>

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
// for each angle. No pivot is less than the damping, so none is checked.
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
    reciprocal[k] = 1.0f / m[k][k];
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

}  // namespace
}  // namespace gaitpad
