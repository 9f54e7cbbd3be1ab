// The linear system of one robust IK step, sized at compile time. Internal to ik*.
#pragma once
#include <utility>

#include "animation/ik_pose.h"

namespace gaitpad {

using IkDofValues = std::array<double, kMaxIkDofs>;

// Two doubles in one SSE2 register: the same bits as one by one, at half the time.
using Pair = double __attribute__((vector_size(16)));

// f(0), f(1) ... with the index as a constant: unrolled on every compiler at -O2.
template <int kCount, class F>
inline void unrolled(F&& f) noexcept {
  [&]<int... i>(std::integer_sequence<int, i...>) { (f(std::integral_constant<int, i>{}), ...); }
  (std::make_integer_sequence<int, kCount>{});
}

// (J W J^T + l^2 I) y = b. kRows is even; where the number of rows is not, the last is all zero.
template <int kRows>
class IkStep {
 public:
  using Rows = std::array<double, kRows>;

  void set_columns(const IkPose& pose, std::span<const IkRow> rows, const IkErrors& errors,
                   int dofs) noexcept;
  // l^2 > 0: no pivot is less, so none is checked.
  void factor(const IkDofValues& weight, int dofs, double damping_squared) noexcept;
  void solve(const Rows& b, Rows& y) const noexcept;
  // Row j of J^T times y, and b -= column j of J times an angle.
  double product(int j, const Rows& y) const noexcept;
  void subtract(int j, double angle_rad, Rows& b) const noexcept;

 private:
  static constexpr int kPairs = kRows / 2;
  template <int kBlock>
  void gram_block(const IkDofValues& weight, int dofs, double damping_squared) noexcept;

  Pair column_[kMaxIkDofs][kPairs];  // of J
  std::array<Rows, kRows> factor_;   // J W J^T + l^2 I = L D L^T: above the diagonal L^T, else L D
  Rows reciprocal_;                  // 1 / D
};

// An entry is d . (a x (p - q)) for direction d, point p and an axis a through q, which is
// a . (p x d) + d . (q x a).
template <int kRows>
void IkStep<kRows>::set_columns(const IkPose& pose, std::span<const IkRow> rows,
                                const IkErrors& errors, int dofs) noexcept {
  Pair d[3][kPairs] = {}, m[3][kPairs] = {};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const vec3& direction = rows[r].direction;
    const vec3 moment = glm::cross(errors.point_m[r], direction);
    for (int i = 0; i < 3; ++i) d[i][r / 2][r % 2] = direction[i], m[i][r / 2][r % 2] = moment[i];
  }
  for (int j = 0; j < dofs; ++j) {
    const vec3& a = pose.axis[j];
    const vec3 n = glm::cross(pose.pivot_m[j], a);
    unrolled<kPairs>([&](auto i) {
      column_[j][i] = (a.x * m[0][i] + a.y * m[1][i]) + (a.z * m[2][i] + n.x * d[0][i]) +
                      (n.y * d[1][i] + n.z * d[2][i]);
    });
  }
}

// Two rows of the lower half at a time: their sums stay in registers.
template <int kRows>
template <int kBlock>
void IkStep<kRows>::gram_block(const IkDofValues& weight, int dofs,
                               double damping_squared) noexcept {
  Pair even[kBlock + 1] = {}, odd[kBlock + 1] = {};
  for (int j = 0; j < dofs; ++j) {
    const Pair weighted = weight[j] * column_[j][kBlock];
    unrolled<kBlock + 1>([&](auto i) {
      even[i] += weighted[0] * column_[j][i];
      odd[i] += weighted[1] * column_[j][i];
    });
  }
  unrolled<2 * kBlock + 2>([&](auto s) {
    factor_[2 * kBlock][s] = even[s / 2][s % 2];
    factor_[2 * kBlock + 1][s] = odd[s / 2][s % 2];
  });
  factor_[2 * kBlock][2 * kBlock] += damping_squared;
  factor_[2 * kBlock + 1][2 * kBlock + 1] += damping_squared;
}

template <int kRows>
void IkStep<kRows>::factor(const IkDofValues& weight, int dofs, double damping_squared) noexcept {
  unrolled<kPairs>([&](auto block) { gram_block<block>(weight, dofs, damping_squared); });
  unrolled<kRows>([&](auto k) {
    reciprocal_[k] = 1.0 / factor_[k][k];
    unrolled<kRows - 1 - k>([&](auto i) {
      constexpr int r = k + 1 + i;
      const double l = factor_[k][r] = factor_[r][k] * reciprocal_[k];
      unrolled<i + 1>([&](auto s) { factor_[r][k + 1 + s] -= l * factor_[k + 1 + s][k]; });
    });
  });
}

template <int kRows>
void IkStep<kRows>::solve(const Rows& b, Rows& y) const noexcept {
  y = b;
  unrolled<kRows>([&](auto k) {
    unrolled<kRows - 1 - k>([&](auto i) { y[k + 1 + i] -= factor_[k][k + 1 + i] * y[k]; });
  });
  unrolled<kRows>([&](auto k) { y[k] *= reciprocal_[k]; });
  unrolled<kRows>([&](auto back) {
    constexpr int k = kRows - 1 - back;
    unrolled<k>([&](auto r) { y[r] -= factor_[r][k] * y[k]; });
  });
}

template <int kRows>
double IkStep<kRows>::product(int j, const Rows& y) const noexcept {
  Pair sum = {};
  unrolled<kPairs>([&](auto i) { sum += column_[j][i] * Pair{y[2 * i], y[2 * i + 1]}; });
  return sum[0] + sum[1];
}

template <int kRows>
void IkStep<kRows>::subtract(int j, double angle_rad, Rows& b) const noexcept {
  unrolled<kRows>([&](auto r) { b[r] -= column_[j][r / 2][r % 2] * angle_rad; });
}

}  // namespace gaitpad
