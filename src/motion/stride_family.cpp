#include "gaitpad/stride_family.h"

#include <algorithm>
#include <cmath>

#include "motion/stencil.h"

namespace gaitpad {
namespace {

static_assert(sizeof(StrideCell) == 33 * sizeof(double));
static_assert(sizeof(StrideTrack) == 9 * sizeof(double));

// Adds weight * part, number by number: both kinds consist of doubles only.
template <class Numbers>
void add(Numbers& sum, const Numbers& part, double weight) noexcept {
  double* to = reinterpret_cast<double*>(&sum);
  const double* from = reinterpret_cast<const double*>(&part);
  for (std::size_t k = 0; k < sizeof(Numbers) / sizeof(double); ++k) to[k] += weight * from[k];
}

}  // namespace

StrideCell mixed(const StrideCell& a, const StrideCell& b, double share_a,
                 double share_b) noexcept {
  StrideCell sum;
  add(sum, a, share_a);
  add(sum, b, share_b);
  return sum;
}

std::array<StrideCell, kCycleSamples> knots_through(
    const std::array<StrideCell, kCycleSamples>& samples) noexcept {
  return spline_through(samples);
}

StridePlace stride_at(const std::vector<StrideTable>& tables, double phase, double ratio) noexcept {
  // Four neighbouring tables; beyond the ends they are extrapolated linearly.
  const double last = static_cast<double>(tables.size() - 1),
               y = std::clamp(ratio / kRatioStep, 0.0, last),
               r = std::min(std::floor(y), last - 1.0);
  const int first = static_cast<int>(r) - 1;
  std::array<double, 4> by_table = cubic_weights(y - r);
  if (first < 0) {
    by_table[1] += 2.0 * by_table[0], by_table[2] -= by_table[0], by_table[0] = 0.0;
  }
  if (r == last - 1.0) {
    by_table[2] += 2.0 * by_table[3], by_table[1] -= by_table[3], by_table[3] = 0.0;
  }
  const Stencil by_knot = stencil_at(phase, &spline_weights);
  StridePlace place;
  for (int n = 0; n < 4; ++n) {
    if (by_table[n] == 0.0) continue;
    const StrideTable& table = tables[first + n];
    add<StrideTrack>(place.track, table, by_table[n]);
    for (int m = 0; m < 4; ++m) {
      if (by_knot.weight[m] == 0.0) continue;  // at a knot
      add(place.cell, table.knot[by_knot.index[m]], by_table[n] * by_knot.weight[m]);
    }
  }
  return place;
}

double roll_time_share(double data_share, double ratio) noexcept {
  const double share = data_share * (ratio < 1.0 ? 1.0 + kLongerRoll * (1.0 - ratio)
                                                 : 1.0 / (1.0 + kShorterRoll * (ratio - 1.0)));
  return std::clamp(share, std::min(kLeastRollShare, data_share),
                    std::max(kMostRollShare, data_share));
}

double StageClock::time_at(double phase) const noexcept {
  const double turns = std::floor(phase);
  double left = phase - turns, begin = 0.0;
  int stage = 0;
  while (stage < 3 && left > phase_share[stage]) {
    left -= phase_share[stage];
    begin += time_share[stage++];
  }
  const auto pace = [&](int k) { return time_share[(k + 4) % 4] / phase_share[(k + 4) % 4]; };
  const double length = phase_share[stage], s = left / length;
  const double v0 = 0.5 * (pace(stage - 1) + pace(stage)) * length,
               v1 = 0.5 * (pace(stage) + pace(stage + 1)) * length;
  const double d = time_share[stage];
  const double c2 = 3.0 * d - 2.0 * v0 - v1, c3 = v0 + v1 - 2.0 * d;
  return turns + begin + (v0 + (c2 + c3 * s) * s) * s;
}

}  // namespace gaitpad
