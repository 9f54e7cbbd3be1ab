// The bodies of rows.h, for one width and one set of instructions at a time.
#pragma once
#include <algorithm>
#include <array>

#include "base/lanes.h"
#include "motion/rows.h"

namespace gaitpad {
namespace {

template <int kWidth>
inline Quat<Lanes<kWidth>> quat_lanes(const double* from, int stride) noexcept {
  Quat<Lanes<kWidth>> q;
  std::memcpy(&q.w, from, sizeof q.w);
  std::memcpy(&q.x, from + stride, sizeof q.x);
  std::memcpy(&q.y, from + 2 * stride, sizeof q.y);
  std::memcpy(&q.z, from + 3 * stride, sizeof q.z);
  return q;
}
template <int kWidth>
inline void store_quats(const Quat<Lanes<kWidth>>& q, int stride, double* to) noexcept {
  std::memcpy(to, &q.w, sizeof q.w);
  std::memcpy(to + stride, &q.x, sizeof q.x);
  std::memcpy(to + 2 * stride, &q.y, sizeof q.y);
  std::memcpy(to + 3 * stride, &q.z, sizeof q.z);
}

}  // namespace

// Neighbouring samples differ by a few degrees, so it is enough to blend the components and to
// normalize. Each is brought into the second one's hemisphere first.
template <int kWidth>
void blend_rows(const BlendedRows& rows) noexcept {
  using V = Lanes<kWidth>;
  for (int j = 0; j < rows.stride; j += kWidth) {
    const Quat<V> nearest = quat_lanes<kWidth>(rows.sample[1] + j, rows.stride);
    Quat<V> sum = nearest * all_of<V>(rows.weight[1]);
    for (const int k : {0, 2, 3}) {
      const Quat<V> q = quat_lanes<kWidth>(rows.sample[k] + j, rows.stride);
      const V weight = all_of<V>(rows.weight[k]);
      sum = sum + q * (dot_of(q, nearest) < V{} ? -weight : weight);
    }
    store_quats<kWidth>(normalized(sum), rows.stride, rows.blend + j);
  }
}

template <int kWidth>
void fade_rows(const BlendedRows& rows) noexcept {
  using V = Lanes<kWidth>;
  for (int j = 0; j < rows.stride; j += kWidth) {
    const Quat<V> from = quat_lanes<kWidth>(rows.standing + j, rows.stride),
                  to = quat_lanes<kWidth>(rows.blend + j, rows.stride);
    store_quats<kWidth>(nlerp_of<V>(from, to, all_of<V>(rows.shown)), rows.stride, rows.blend + j);
  }
}

// kRegisters registers of numbers at a time. The last ones may be computed twice.
template <int kWidth, int kRegisters>
inline void sum_group(const SummedRows& rows, int at) noexcept {
  using V = Lanes<kWidth>;
  std::array<V, kRegisters> sum{};
  for (int i = 0; i < rows.rows; ++i) {
    const V weight = all_of<V>(rows.weight[i]);
    for (int k = 0; k < kRegisters; ++k) {
      V number;
      std::memcpy(&number, rows.row[i] + std::min(at + k * kWidth, rows.numbers - kWidth),
                  sizeof number);
      sum[k] += weight * number;
    }
  }
  for (int k = 0; k < kRegisters; ++k)
    std::memcpy(rows.sum + std::min(at + k * kWidth, rows.numbers - kWidth), &sum[k], sizeof(V));
}

template <int kWidth>
void sum_rows(const SummedRows& rows) noexcept {
  constexpr int kMost = 5;
  int at = 0;
  for (; at + (kMost - 1) * kWidth < rows.numbers; at += kMost * kWidth)
    sum_group<kWidth, kMost>(rows, at);
  const int left = (rows.numbers - at + kWidth - 1) / kWidth;
  if (left == 4) sum_group<kWidth, 4>(rows, at);
  if (left == 3) sum_group<kWidth, 3>(rows, at);
  if (left == 2) sum_group<kWidth, 2>(rows, at);
  if (left == 1) sum_group<kWidth, 1>(rows, at);
}

}  // namespace gaitpad
