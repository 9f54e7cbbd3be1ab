// Reads the tables of clean strides, for one walk or for several in the lanes of a register (V as
// in gaitpad/math.h). Every walk has its own phase and ratio.
#pragma once
#include "base/lanes.h"
#include "gaitpad/stride_family.h"
#include "motion/rows.h"
#include "motion/stencil.h"

namespace gaitpad {

namespace {

// Weighted sums of table rows. Each walk adds its own rows and weights; they are summed in that
// order.
template <class V, template <class> class Numbers, int kMost>
class RowsOf {
 public:
  void add(int lane, const Numbers<double>& row, double weight) noexcept {
    const int at = count_[lane]++;
    row_[lane][at] = reinterpret_cast<const double*>(&row);
    weight_[lane][at] = weight;
  }
  void total(Numbers<V>& sum) const noexcept {
    auto* to = reinterpret_cast<V*>(&sum);
    if constexpr (kLanes == 1) {
      sum_rows({row_[0].data(), weight_[0].data(), count_[0], kNumbers, to});
    } else {
      alignas(64) std::array<std::array<double, kNumbers>, kLanes> of_lane;
      std::array<const double*, kLanes> from;
      for (int lane = 0; lane < kLanes; ++lane) {
        from[lane] = of_lane[lane].data();
        sum_rows<std::min(kLanes, kNumbers < 8 ? 4 : 8)>({row_[lane].data(), weight_[lane].data(),
                                                          count_[lane], kNumbers,
                                                          of_lane[lane].data()});
      }
      load_lanes<V>(from, kNumbers, to);
    }
  }

 private:
  static constexpr int kLanes = kWidthOf<V>, kNumbers = sizeof(Numbers<double>) / sizeof(double);
  std::array<std::array<const double*, kMost>, kLanes> row_;
  std::array<std::array<double, kMost>, kLanes> weight_;
  std::array<int, kLanes> count_{};
};

template <class V>
using TablesOf = std::array<const std::vector<StrideTable>*, kWidthOf<V>>;

// Four neighbouring tables of each walk and their weights.
template <class V>
struct RatiosOf {
  TablesOf<V> tables;
  std::array<int, kWidthOf<V>> first;  // index of the first table; may be -1 if its weight is 0
  std::array<V, 4> weight;
};
template <class V>
RatiosOf<V> ratios_at(const TablesOf<V>& tables, const V& ratio) noexcept {
  V last;
  for (int lane = 0; lane < kWidthOf<V>; ++lane)
    set_lane(static_cast<double>(tables[lane]->size() - 1), lane, last);
  const V y = min_of(max_of(V(ratio / kRatioStep), V{}), last);
  const V r = min_of(floor_of(y), V(last - 1.0));
  RatiosOf<V> at;
  at.tables = tables;
  at.weight = cubic_weights(V(y - r));
  // Beyond the ends the tables are extrapolated linearly.
  auto& weight = at.weight;
  const auto low = r == V{}, high = r == last - 1.0;
  weight[1] += low ? 2.0 * weight[0] : V{};
  weight[2] -= low ? weight[0] : V{};
  weight[0] = low ? V{} : weight[0];
  weight[2] += high ? 2.0 * weight[3] : V{};
  weight[1] -= high ? weight[3] : V{};
  weight[3] = high ? V{} : weight[3];
  for (int lane = 0; lane < kWidthOf<V>; ++lane)
    at.first[lane] = static_cast<int>(lane_of(r, lane)) - 1;
  return at;
}

template <class V>
void track_at(const RatiosOf<V>& at, StrideTrackOf<V>& track) noexcept {
  // A table begins with its track.
  constexpr int kNumbers = sizeof(StrideTrack) / sizeof(double);
  std::array<V, kNumbers> sum{}, numbers;
  for (int n = 0; n < 4; ++n) {
    std::array<const double*, kWidthOf<V>> from;
    for (int lane = 0; lane < kWidthOf<V>; ++lane) {
      const int last = static_cast<int>(at.tables[lane]->size()) - 1;
      const StrideTable& table = (*at.tables[lane])[std::clamp(at.first[lane] + n, 0, last)];
      from[lane] = reinterpret_cast<const double*>(&table);
    }
    load_lanes<V>(from, kNumbers, numbers.data());
    for (int k = 0; k < kNumbers; ++k) sum[k] += at.weight[n] * numbers[k];
  }
  std::copy_n(sum.begin(), kNumbers, reinterpret_cast<V*>(&track));
}

// The four knots around a phase and their weights.
template <class V>
struct KnotsOf {
  std::array<int, kWidthOf<V>> second;
  std::array<V, 4> weight;
  int of(int lane, int m) const noexcept {
    return (second[lane] + m - 1 + kCycleSamples) % kCycleSamples;
  }
};
template <class V>
KnotsOf<V> knots_at(const V& phase) noexcept {
  const V x = (phase - floor_of(phase)) * double(kCycleSamples);
  const V i = min_of(floor_of(x), all_of<V>(kCycleSamples - 1));
  KnotsOf<V> knots;
  knots.weight = spline_weights(V(x - i));
  for (int lane = 0; lane < kWidthOf<V>; ++lane)
    knots.second[lane] = static_cast<int>(lane_of(i, lane));
  return knots;
}

// The first numbers of a StrideCell.
template <class V>
struct PelvisCellOf {
  Vec<V> pelvis_m{};
  V pelvis_yaw_rad{};
  Vec<V> pelvis_tilt{};
  V rest{};
};

// A cubic spline in phase, smooth to the second derivative, and cubic in ratio, which is clamped to
// the tables. Blends two ratios: `change` is 0 at `a` and 1 at `b`. Numbers: a StrideCell, or its
// first numbers.
template <class V, template <class> class Numbers>
void stride_between(const RatiosOf<V>& a, const RatiosOf<V>& b, const V& change,
                    const KnotsOf<V>& knots, Numbers<V>& cell) noexcept {
  RowsOf<V, Numbers, 4 * kStrideRatios> rows;
  std::array<V, 4> weight_a, weight_b;
  for (int n = 0; n < 4; ++n) {
    weight_a[n] = a.weight[n] * (1.0 - change);
    weight_b[n] = b.weight[n] * change;
  }
  for (int lane = 0; lane < kWidthOf<V>; ++lane) {
    // Weights by table index + 1; index -1 has weight 0.
    std::array<double, kStrideRatios + 2> by_table{};
    for (int n = 0; n < 4; ++n) {
      by_table[a.first[lane] + 1 + n] += lane_of(weight_a[n], lane);
      by_table[b.first[lane] + 1 + n] += lane_of(weight_b[n], lane);
    }
    std::array<int, 4> at;
    for (int m = 0; m < 4; ++m) at[m] = knots.of(lane, m);
    const int end = std::max(a.first[lane], b.first[lane]) + 4;
    for (int t = std::max(0, std::min(a.first[lane], b.first[lane])); t < end; ++t) {
      if (by_table[t + 1] == 0.0) continue;
      for (int m = 0; m < 4; ++m)
        rows.add(lane, reinterpret_cast<const Numbers<double>&>((*a.tables[lane])[t].knot[at[m]]),
                 by_table[t + 1] * lane_of(knots.weight[m], lane));
    }
  }
  rows.total(cell);
}

// A foot's heel and the five numbers that follow it in a StrideCell.
template <class V>
struct HeelOf {
  Vec<V> heel_m{};
  std::array<V, 5> rest{};
};
template <class V>
Vec<V> heel_at(const RatiosOf<V>& at, const KnotsOf<V>& knots, const MaskOf<V>& right) noexcept {
  RowsOf<V, HeelOf, 16> rows;
  for (int lane = 0; lane < kWidthOf<V>; ++lane) {
    const int side = is_set(right, lane) ? kRightSide : kLeftSide;
    for (int n = 0; n < 4; ++n) {
      const double weight = lane_of(at.weight[n], lane);
      if (weight == 0.0) continue;
      const StrideTable& table = (*at.tables[lane])[at.first[lane] + n];
      for (int m = 0; m < 4; ++m) {
        // Reads the numbers that follow the heel as well, to fill a register.
        const auto& heel = table.knot[knots.of(lane, m)].foot[side].heel_m;
        rows.add(lane, reinterpret_cast<const HeelOf<double>&>(heel),
                 weight * lane_of(knots.weight[m], lane));
      }
    }
  }
  HeelOf<V> sum;
  rows.total(sum);
  return sum.heel_m;
}

// --- The motion's strides in a character's lengths -----------------------------------------------

template <class V>
void scale_footprints(const StrideScale& to, FootprintsOf<V>& track) noexcept {
  if (to.length == 1.0 && to.pelvis == 1.0) return;
  track.stride_m = track.stride_m * to.length;
  for (int side : {0, 1})
    track.footprint_m[side] = track.footprint_m[side] * to.length + all_of<V>(to.apart_m[side]);
}

template <class V>
Vec<V> scaled_heel(const StrideScale& to, const Vec<V>& heel_m, int side) noexcept {
  return heel_m * to.length + all_of<V>(to.apart_m[side]);
}

// A place relative to the pelvis, turned with the pelvis.
template <class V>
Vec<V> pelvis_turned(const vec3& place_m, const V& yaw_rad, const Vec<V>& tilt) noexcept {
  V sine, cosine;
  sin_cos_of(yaw_rad, sine, cosine);
  const Vec<V> p = rotation_by_vector<V>(tilt) * all_of<V>(place_m);
  return {cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x};
}

// Scales the pelvis of the motion's stride to the character (StrideScale). The legs keep their
// angles: a wider pelvis turns and rolls less, by `length / pelvis`, and the middle of the hips
// follows its scaled path.
template <class V, template <class> class Numbers>
void scale_pelvis(const StrideScale& to, Numbers<V>& cell) noexcept {
  if (to.length == 1.0 && to.pelvis == 1.0) return;
  if (to.length == to.pelvis) {
    cell.pelvis_m = cell.pelvis_m * to.length;
    return;
  }
  const double turns = to.length / to.pelvis;
  const auto hips_m = [&](double share, const vec3& standing_m) {
    Vec<V> tilt = cell.pelvis_tilt;
    tilt.z = share * (tilt.z + to.stand_roll_rad);
    return pelvis_turned<V>(to.hips_m, share * cell.pelvis_yaw_rad, tilt) - all_of<V>(standing_m);
  };
  cell.pelvis_m = to.length * (cell.pelvis_m + hips_m(1.0, to.standing_m[0])) -
                  to.pelvis * hips_m(turns, to.standing_m[1]);
  cell.pelvis_yaw_rad = cell.pelvis_yaw_rad * turns;
  cell.pelvis_tilt.z = cell.pelvis_tilt.z * turns;
}
template <class V>
void scale_stride(const StrideScale& to, StrideCellOf<V>& cell) noexcept {
  if (to.length == 1.0 && to.pelvis == 1.0) return;
  for (int side : {0, 1}) cell.foot[side].heel_m = scaled_heel<V>(to, cell.foot[side].heel_m, side);
  scale_pelvis<V>(to, cell);
}

}  // namespace
}  // namespace gaitpad
