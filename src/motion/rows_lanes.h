// The bodies of rows.h, for one width and one set of instructions at a time.
#pragma once
#include <array>

#include "base/lanes.h"
#include "motion/rows.h"

namespace gaitpad {
namespace {

template <int kWidth>
inline QuatOf<Lanes<kWidth>> quat_lanes(const double* from, int stride) noexcept {
  QuatOf<Lanes<kWidth>> q;
  std::memcpy(&q.w, from, sizeof q.w);
  std::memcpy(&q.x, from + stride, sizeof q.x);
  std::memcpy(&q.y, from + 2 * stride, sizeof q.y);
  std::memcpy(&q.z, from + 3 * stride, sizeof q.z);
  return q;
}

}  // namespace

// Neighbouring samples differ by a few degrees, so it is enough to blend the components and to
// normalize. Each is brought into the second one's hemisphere first.
template <int kWidth>
void blend_rows(const BlendedRows& rows) noexcept {
  using V = Lanes<kWidth>;
  for (int j = 0; j < rows.stride; j += kWidth) {
    const QuatOf<V> nearest = quat_lanes<kWidth>(rows.sample[1] + j, rows.stride);
    QuatOf<V> sum = nearest * all_of<V>(rows.weight[1]);
    for (const int k : {0, 2, 3}) {
      const QuatOf<V> q = quat_lanes<kWidth>(rows.sample[k] + j, rows.stride);
      const V weight = all_of<V>(rows.weight[k]);
      sum = sum + q * (dot_of(q, nearest) < V{} ? -weight : weight);
    }
    sum = normalized(sum);
    std::memcpy(rows.blend + j, &sum.w, sizeof sum.w);
    std::memcpy(rows.blend + rows.stride + j, &sum.x, sizeof sum.x);
    std::memcpy(rows.blend + 2 * rows.stride + j, &sum.y, sizeof sum.y);
    std::memcpy(rows.blend + 3 * rows.stride + j, &sum.z, sizeof sum.z);
  }
}

// Eight numbers at a time stay in registers.
template <int kWidth>
void sum_rows(const SummedRows& rows) noexcept {
  using V = Lanes<kWidth>;
  constexpr int kTogether = 8, kParts = kTogether / kWidth;
  int at = 0;
  for (; at + kTogether <= rows.numbers; at += kTogether) {
    std::array<V, kParts> sum{};
    for (int i = 0; i < rows.rows; ++i) {
      const V weight = all_of<V>(rows.weight[i]);
      for (int k = 0; k < kParts; ++k) {
        V number;
        std::memcpy(&number, rows.row[i] + at + k * kWidth, sizeof number);
        sum[k] += weight * number;
      }
    }
    std::memcpy(rows.sum + at, &sum, sizeof sum);
  }
  for (; at < rows.numbers; ++at) {
    double sum = 0.0;
    for (int i = 0; i < rows.rows; ++i) sum += rows.weight[i] * rows.row[i][at];
    rows.sum[at] = sum;
  }
}

}  // namespace gaitpad
