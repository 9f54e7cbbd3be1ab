#include "gaitpad/stride_family.h"

#include "gaitpad/curve.h"
#include "motion/rows.h"

namespace gaitpad {
namespace {

// Double support takes about a quarter of an adult's cycle at an easy pace, a third at a stroll and
// a fifth at a brisk one.
constexpr double kLongerRoll = 0.9;   // a roll's share grows by this for a stride of length 0,
constexpr double kShorterRoll = 2.4;  // and falls so steeply for longer ones
constexpr double kLeastRoll = 0.04, kMostRoll = 0.22;

// Catmull-Rom weights of four neighbours.
std::array<double, 4> cubic(double t) noexcept {
  return {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
          0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
}

// Weights of four neighbouring knots of a uniform cubic B-spline.
std::array<double, 4> spline(double t) noexcept {
  const double s = 1.0 - t;
  return {s * s * s / 6.0, (4.0 + t * t * (3.0 * t - 6.0)) / 6.0,
          (4.0 + s * s * (3.0 * s - 6.0)) / 6.0, t * t * t / 6.0};
}

static_assert(sizeof(StrideCell) == 33 * sizeof(double));
static_assert(sizeof(StrideChange) == 25 * sizeof(double));

// Both kinds of cells are numbers alone.
template <class Cell>
void add(Cell& sum, const Cell& cell, double weight) noexcept {
  double* to = &sum.pelvis_m.x;
  const double* from = &cell.pelvis_m.x;
  for (std::size_t k = 0; k < sizeof(Cell) / sizeof(double); ++k) to[k] += weight * from[k];
}

// What a cell is summed from, in this order.
template <class Cell, int kMost>
class Sum {
 public:
  void add(const Cell& cell, double weight) noexcept {
    from_[count_] = &cell.pelvis_m.x, weight_[count_] = weight, ++count_;
  }
  void total(Cell& cell) const noexcept {
    sum_rows({from_.data(), weight_.data(), count_, static_cast<int>(sizeof(Cell) / sizeof(double)),
              &cell.pelvis_m.x});
  }

 private:
  std::array<const double*, kMost> from_;
  std::array<double, kMost> weight_;
  int count_ = 0;
};

// The inverse of [1 4 1] / 6: the samples, filtered forwards and back by the filter's pole (Unser
// 1993). Its response is cut off where it is below the rounding of a double.
template <class Cell>
std::array<Cell, kCycleSamples> knots_of(const std::array<Cell, kCycleSamples>& samples) noexcept {
  constexpr double kPole = -0.26794919243112270;  // sqrt(3) - 2
  constexpr int kReach = 28;
  const auto at = [](int i) { return (i + 2 * kCycleSamples) % kCycleSamples; };
  const auto filtered = [](const Cell& cell, double gain, const Cell& before) {
    Cell sum;
    add(sum, cell, gain);
    add(sum, before, kPole);
    return sum;
  };
  std::array<Cell, kCycleSamples> once, knots;
  Cell sum;
  for (int i = -kReach; i < kCycleSamples; ++i) {
    sum = filtered(samples[at(i)], 1.0, sum);
    if (i >= 0) once[i] = sum;
  }
  sum = Cell{};
  for (int i = kCycleSamples - 1 + kReach; i >= 0; --i) {
    sum = filtered(once[at(i)], -6.0 * kPole, sum);
    if (i < kCycleSamples) knots[i] = sum;
  }
  return knots;
}

}  // namespace

StrideCell mixed(const StrideCell& a, const StrideCell& b, double share_a,
                 double share_b) noexcept {
  Sum<StrideCell, 2> sum;
  sum.add(a, share_a);
  sum.add(b, share_b);
  StrideCell cell;
  sum.total(cell);
  return cell;
}

std::array<StrideCell, kCycleSamples> knots_through(
    const std::array<StrideCell, kCycleSamples>& samples) noexcept {
  return knots_of(samples);
}
std::array<StrideChange, kCycleSamples> knots_through(
    const std::array<StrideChange, kCycleSamples>& samples) noexcept {
  return knots_of(samples);
}

StrideChange change_at(const std::vector<StrideResponse>& response, const StrideWishes& granted,
                       double phase) noexcept {
  const double x = (phase - std::floor(phase)) * kCycleSamples;
  const int i = std::min(static_cast<int>(x), kCycleSamples - 1);
  const std::array<double, 4> by_phase = spline(x - i);
  Sum<StrideChange, 4 * kStrideWishes> change;
  for (int wish = 0; wish < kStrideWishes; ++wish) {
    if (granted[wish] == 0.0) continue;
    for (int m = 0; m < 4; ++m) {
      const int k = (i + m - 1 + kCycleSamples) % kCycleSamples;
      change.add(response[wish].knot[k], granted[wish] * by_phase[m]);
    }
  }
  StrideChange sum;
  change.total(sum);
  return sum;
}

namespace {

// Four neighbouring tables and their weights, those without one left out.
struct Ratios {
  std::array<const StrideTable*, 4> table;
  std::array<double, 4> weight;
  int count = 0;
};
Ratios ratios_at(const std::vector<StrideTable>& tables, double ratio) noexcept {
  const int last = static_cast<int>(tables.size()) - 1;
  const double y = std::clamp(ratio / kRatioStep, 0.0, double(last));
  const int r = std::min(static_cast<int>(y), last - 1);
  std::array<double, 4> by_ratio = cubic(y - r);
  // Beyond the ends the tables go on straight.
  if (r == 0) by_ratio[1] += 2.0 * by_ratio[0], by_ratio[2] -= by_ratio[0], by_ratio[0] = 0.0;
  if (r == last - 1) {
    by_ratio[2] += 2.0 * by_ratio[3], by_ratio[1] -= by_ratio[3], by_ratio[3] = 0.0;
  }
  Ratios at;
  for (int n = 0; n < 4; ++n) {
    if (by_ratio[n] == 0.0) continue;
    at.table[at.count] = &tables[r + n - 1];
    at.weight[at.count++] = by_ratio[n];
  }
  return at;
}

StrideTrack track_at(const Ratios& at) noexcept {
  StrideTrack track;
  for (int n = 0; n < at.count; ++n) {
    track.stride_m += at.weight[n] * at.table[n]->stride_m;
    for (int side : {0, 1})
      track.footprint_m[side] += at.table[n]->footprint_m[side] * at.weight[n];
  }
  return track;
}

}  // namespace

StrideTrack track_at(const std::vector<StrideTable>& tables, double ratio) noexcept {
  return track_at(ratios_at(tables, ratio));
}

StridePlace stride_at(const std::vector<StrideTable>& tables, double phase, double ratio) noexcept {
  const double x = (phase - std::floor(phase)) * kCycleSamples;
  const int i = std::min(static_cast<int>(x), kCycleSamples - 1);
  const std::array<double, 4> by_phase = spline(x - i);
  const Ratios at = ratios_at(tables, ratio);
  Sum<StrideCell, 16> cell;
  for (int n = 0; n < at.count; ++n) {
    for (int m = 0; m < 4; ++m) {
      const int k = (i + m - 1 + kCycleSamples) % kCycleSamples;
      cell.add(at.table[n]->knot[k], at.weight[n] * by_phase[m]);
    }
  }
  StridePlace place;
  place.track = track_at(at);
  cell.total(place.cell);
  return place;
}

double low_lift(double u, double lift) noexcept {
  constexpr double kAtLiftOff = 0.0, kAll = 0.5, kUntil = 0.6;  // shares of it, of the flight
  const double grown = mix(kAtLiftOff, 1.0, smootherstep(u / kAll));
  return mix(1.0, lift, grown * (1.0 - smootherstep((u - kUntil) / (1.0 - kUntil))));
}

double roll_time_share(double data_share, double ratio) noexcept {
  const double share = data_share * (ratio < 1.0 ? 1.0 + kLongerRoll * (1.0 - ratio)
                                                 : 1.0 / (1.0 + kShorterRoll * (ratio - 1.0)));
  return std::clamp(share, std::min(kLeastRoll, data_share), std::max(kMostRoll, data_share));
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
