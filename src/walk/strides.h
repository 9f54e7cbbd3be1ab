// Reads the strides' tables: of each walk its own rows, summed row by row; then one number of all
// walks in a register.
#pragma once
#include <algorithm>
#include <cstddef>

#include "walk/footholds.h"

namespace gaitpad {
namespace {

// As many numbers of a row as a register holds. The sums go across rows, never along them, so their
// bits do not depend on it.
#if defined(__AVX2__)
using RowPart = Floats<8>;
#else
using RowPart = Four;
#endif

template <class R>
inline R part(const float* from) noexcept {
  R r;
  std::memcpy(&r, from, sizeof r);
  return r;
}

// Rows of numbers, one a walk, to registers, one a number. `numbers` is a multiple of four.
template <class V>
inline void to_lanes(const float* rows, int numbers, V* to) noexcept {
  constexpr int kWidth = kLanes<V>;
  if constexpr (kWidth == 1) {
    std::memcpy(to, rows, numbers * sizeof(float));
  } else {
    for (int n = 0; n < numbers; n += 4) {
      for (int w = 0; w < kWidth; w += 4) {
        const float* from = rows + w * numbers + n;
        Four row[4] = {part<Four>(from), part<Four>(from + numbers), part<Four>(from + 2 * numbers),
                       part<Four>(from + 3 * numbers)};
        transpose(row);
        for (int i = 0; i < 4; ++i)
          std::memcpy(reinterpret_cast<float*>(&to[n + i]) + w, &row[i], sizeof(Four));
      }
    }
  }
}

// The four knots around a phase: the row of the first, and weights.
template <class V>
struct Knots {
  V first;
  V weight[4];
};
template <class V>
Knots<V> knots_at(const V& phase) noexcept {
  constexpr float kSixth = 1.0f / 6.0f;
  const V x = (phase - floored(phase)) * float(kKnots),
          i = least(floored(x), all<V>(kKnots - 1.0f)), t = x - i, s = 1.0f - t;
  return {i,
          {s * s * s * kSixth, (4.0f + t * t * (3.0f * t - 6.0f)) * kSixth,
           (4.0f + s * s * (3.0f * s - 6.0f)) * kSixth, t * t * t * kSixth}};
}
// The four ratios around one, the first may be -1, and their Catmull-Rom weights; beyond the ends
// the tables go on straight.
template <class V>
Knots<V> ratios_at(const V& ratio, const V& last) noexcept {
  const V y = least(most(V(ratio * float(1.0 / kRatioStep)), V{}), last),
          r = least(floored(y), V(last - 1.0f)), t = y - r;
  const V w0 = 0.5f * t * (t * (2.0f - t) - 1.0f), w3 = 0.5f * t * t * (t - 1.0f);
  V w1 = 1.0f + 0.5f * t * t * (3.0f * t - 5.0f), w2 = 0.5f * t * (1.0f + t * (4.0f - 3.0f * t));
  const auto low = r == V{}, high = r == last - 1.0f;
  w1 = w1 + (low ? V(2.0f * w0) : V{}) - (high ? w3 : V{});
  w2 = w2 - (low ? w0 : V{}) + (high ? V(2.0f * w3) : V{});
  return {V(r - 1.0f), {low ? V{} : w0, w1, w2, high ? V{} : w3}};
}

template <class V>
struct FootInStride {
  V pitch_rad{}, twist_rad{}, roll_rad{};
};
// The strides at one phase: of the step before, of this step, and both mixed. Swing foot first.
template <class V>
struct Stride {
  Vec<V> heel_behind_m, heel_ahead_m;  // of the swing foot
  V heel_high_m{};                     // mixed
  FootInStride<V> foot[2];
  Vec<V> pelvis_m, pelvis_tilt_rad;
  V pelvis_yaw_rad{}, pelvis_low_m{}, pelvis_high_m{};
  V leg_rad[2][kLegAngles]{};
  V stood_pitch_rad{};  // the swing foot's, as it would stand
  V ratio_ahead{};
};

// The number of the swing foot or leg, and of the other one.
template <class V>
inline void by_foot(const Mask<V>& right, const V& of_left, const V& of_right, V& swing,
                    V& stand) noexcept {
  swing = right ? of_right : of_left;
  stand = right ? of_left : of_right;
}

// A walk's rows: a knot's after the one before, a ratio's after the one before.
struct Rows {
  const float* first;
  int of_knot;
  const float* at(int knot, int ratio) const noexcept {
    return first + knot * of_knot + ratio * kRowNumbers;
  }
};
inline Rows rows_of(const Tables& tables, bool back) noexcept {
  const StrideRow* first = back ? &tables.back[0][0] : &tables.forward[0][0];
  return {reinterpret_cast<const float*>(first), (back ? kBackRatios : kRatios) * kRowNumbers};
}
template <class V>
V last_ratio(const Mask<V>& back) noexcept {
  return chosen<V>(back, kBackRatios - 1.0f, kRatios - 1.0f);
}

// Of strides whose half is the way of the foot that flies, ahead or aside: turning on the spot it
// may be set down behind where it stood, and no stride of these tables leads there.
// What that is off fades; one that flies soon goes at least as far as it is to.
template <class V>
V short_ratio(const Tables& tables, const Landing<V>& landing, const State<V>& state) noexcept {
  constexpr float kComesUp = 0.3f;  // of the flight
  const V x = landing.x_m - state.print_x_m, z = landing.z_m - state.print_z_m,
          goes_m = x * landing.way.sine + z * landing.way.cosine,
          ahead_m = most(state.backward != V{} ? -goes_m : goes_m, V{}),
          aside_m = x * landing.way.cosine - z * landing.way.sine;
  const V own = root(V(ahead_m * ahead_m + aside_m * aside_m)) *
                (1.0f / (tables.leg[0].own_step_m + tables.leg[1].own_step_m)),
          off = 0.5f * landing.off_ratio,
          flown = state.flies != V{} ? V(state.tick / state.flight_ticks) : V{},
          low = off * (1.0f - smoother(V(flown * (1.0f / kComesUp))));
  return most(V(own + (off < V{} ? low : off)), V{});
}

// `change`: from the stride behind, at 0, to the one ahead, at 1.
template <class V>
Stride<V> read_stride(const Tables& tables, const Time<V>& time, const V& phase, const V& behind,
                      const V& ahead, const V& change) noexcept {
  constexpr int kWidth = kLanes<V>, kPart = kLanes<RowPart>, kParts = kRowNumbers / kPart;
  constexpr int kHeelParts = kHeelNumbers <= kPart ? 1 : kHeelNumbers / kPart,
                kHeelRoom = kHeelParts * kPart, kNumbers = kRowNumbers + 2 * kHeelNumbers;
  const V last = last_ratio<V>(time.back), back = chosen<V>(time.back, 1.0f, 0.0f);
  const Knots<V> knots = knots_at(phase), old = ratios_at(behind, last),
                 next = ratios_at(ahead, last);
  alignas(64) float row[kWidth][kNumbers];
  for (int w = 0; w < kWidth; ++w) {
    const int i = static_cast<int>(lane(knots.first, w));
    const int first[2] = {static_cast<int>(lane(old.first, w)),
                          static_cast<int>(lane(next.first, w))};
    float of_old[kRatios + 4] = {}, of_next[kRatios + 4] = {};  // by ratio + 1
    for (int k = 0; k < 4; ++k) {
      of_old[first[0] + 1 + k] = lane(old.weight[k], w);
      of_next[first[1] + 1 + k] = lane(next.weight[k], w);
    }
    const float share = lane(change, w), left = 1.0f - share;
    const float k0 = lane(knots.weight[0], w), k1 = lane(knots.weight[1], w),
                k2 = lane(knots.weight[2], w), k3 = lane(knots.weight[3], w);
    RowPart sum[kParts] = {}, heel_old[kHeelParts] = {}, heel_next[kHeelParts] = {};
    const int begin = std::max(0, std::min(first[0], first[1])),
              end = std::min(static_cast<int>(lane(last, w)), std::max(first[0], first[1]) + 3);
    const Rows rows = rows_of(tables, lane(back, w) != 0.0f);
    for (int r = begin; r <= end; ++r) {
      const float a = of_old[r + 1], b = of_next[r + 1], mixed = a * left + b * share;
      const float *p0 = rows.at(i, r), *p1 = rows.at(i + 1, r), *p2 = rows.at(i + 2, r),
                  *p3 = rows.at(i + 3, r);
#pragma GCC unroll 10
      for (int n = 0; n < kParts; ++n) {
        const int o = n * kPart;
        const RowPart here = part<RowPart>(p0 + o) * k0 + part<RowPart>(p1 + o) * k1 +
                             part<RowPart>(p2 + o) * k2 + part<RowPart>(p3 + o) * k3;
        sum[n] += here * mixed;
        if (n < kHeelParts) {
          heel_old[n] += here * a;
          heel_next[n] += here * b;
        }
      }
    }
    float heels[2][kHeelRoom];
    std::memcpy(heels[0], heel_old, sizeof heel_old);
    std::memcpy(heels[1], heel_next, sizeof heel_next);
    std::memcpy(row[w], sum, sizeof sum);
    std::memcpy(row[w] + kRowNumbers, heels[0], kHeelNumbers * sizeof(float));
    std::memcpy(row[w] + kRowNumbers + kHeelNumbers, heels[1], kHeelNumbers * sizeof(float));
  }
  V n[kNumbers];
  to_lanes(&row[0][0], kNumbers, n);

  Stride<V> stride;
  const auto heel = [&](const V* left_heel) {
    return chosen(time.right, Vec<V>{left_heel[3], left_heel[4], left_heel[5]},
                  Vec<V>{left_heel[0], left_heel[1], left_heel[2]});
  };
  stride.heel_high_m = heel(n).y;
  stride.heel_behind_m = heel(n + kRowNumbers);
  stride.heel_ahead_m = heel(n + kRowNumbers + kHeelNumbers);
  FootInStride<V>&swing = stride.foot[0], &stand = stride.foot[1];
  by_foot(time.right, n[6], n[7], swing.pitch_rad, stand.pitch_rad);
  by_foot(time.right, n[8], n[10], swing.twist_rad, stand.twist_rad);
  by_foot(time.right, n[9], n[11], swing.roll_rad, stand.roll_rad);
  stride.pelvis_m = {n[12], n[13], n[14]};
  stride.pelvis_yaw_rad = n[15];
  stride.pelvis_tilt_rad = {n[16], n[17], n[18]};
  for (int j = 0; j < kLegAngles; ++j)
    by_foot(time.right, n[19 + j], n[26 + j], stride.leg_rad[0][j], stride.leg_rad[1][j]);
  stride.pelvis_low_m = n[33];
  stride.pelvis_high_m = n[34];
  stride.stood_pitch_rad = swing.pitch_rad;
  stride.ratio_ahead = ahead;
  return stride;
}

// Four neighbours of a row's numbers, from `at` on, at any phase.
template <class V>
void read_four(const Tables& tables, const Time<V>& time, int at, const V& phase, const V& behind,
               const V& ahead, const V& change, V (&to)[4]) noexcept {
  constexpr int kWidth = kLanes<V>;
  const V last = last_ratio<V>(time.back), back = chosen<V>(time.back, 1.0f, 0.0f);
  const Knots<V> knots = knots_at(phase), old = ratios_at(behind, last),
                 next = ratios_at(ahead, last);
  alignas(64) float row[kWidth][4];
  for (int w = 0; w < kWidth; ++w) {
    const int i = static_cast<int>(lane(knots.first, w));
    const int first[2] = {static_cast<int>(lane(old.first, w)),
                          static_cast<int>(lane(next.first, w))};
    const float share = lane(change, w), left = 1.0f - share;
    float weight[kRatios + 4] = {};  // by ratio + 1
    for (int k = 0; k < 4; ++k) weight[first[0] + 1 + k] = lane(old.weight[k], w) * left;
    for (int k = 0; k < 4; ++k) weight[first[1] + 1 + k] += lane(next.weight[k], w) * share;
    Four sum{};
    const int begin = std::max(0, std::min(first[0], first[1])),
              end = std::min(static_cast<int>(lane(last, w)), std::max(first[0], first[1]) + 3);
    const Rows rows = rows_of(tables, lane(back, w) != 0.0f);
    for (int r = begin; r <= end; ++r) {
      Four here{};
      for (int k = 0; k < 4; ++k)
        here += part<Four>(rows.at(i + k, r) + at) * lane(knots.weight[k], w);
      sum += here * weight[r + 1];
    }
    std::memcpy(row[w], &sum, sizeof sum);
  }
  to_lanes(&row[0][0], 4, to);
}

// Where one foot's steps are shorter than the other's, the tables of short strides would keep both
// feet low: then a heel flies as high as in strides in which both go as far as the longer one, and
// comes down as the tables have it. A flight limps as was asked when its foot lifted off: a style
// that changes on its way would else let the heel jump.
template <class V>
void plan_limp(const Tables& tables, const Time<V>& time, const Mask<V>& lifts,
               const State<V>& state, Change<V>& change) noexcept {
  // A walk limps from the one difference of both feet's strides on, wholly from the other.
  constexpr float kEvenSteps = 0.03f, kUnevenSteps = 0.2f, kLeastAsked = 0.1f;
  // Even styles ask for equal steps, or for the data's own, which may differ.
  const V &left_m = state.length_m[0].x, &right_m = state.length_m[1].x;
  const float left_1_m = 1.0f / tables.leg[0].own_step_m,
              right_1_m = 1.0f / tables.leg[1].own_step_m;
  const V left = left_m * chosen<V>(time.back, right_1_m, left_1_m),
          right = right_m * chosen<V>(time.back, left_1_m, right_1_m), longer = most(left, right),
          shorter = least(left, right);
  // The last steps of a stop, and one that goes on after all, are as long as hips need them.
  const auto walks = both(both(change.stops == V{}, change.closing == V{}), change.resumes == V{}),
             limps = both(walks, longer - shorter > kEvenSteps * (longer + kLeastAsked));
  change.limp = lifts ? V{} : change.limp;
  if (!any(both(lifts, limps))) return;
  const auto evenness = [](const V& a, const V& b) {
    return V((least(a, b) + kLeastAsked) / (most(a, b) + kLeastAsked));
  };
  // Nor do steps that only come to be as long as both are asked for.
  const V &asked_left_m = state.asked.length_m[0], &asked_right_m = state.asked.length_m[1],
          asked_left = asked_left_m * chosen<V>(time.back, right_1_m, left_1_m),
          asked_right = asked_right_m * chosen<V>(time.back, left_1_m, right_1_m);
  const V even =
              most(most(evenness(left, right), evenness(left_m, right_m)),
                   most(evenness(asked_left, asked_right), evenness(asked_left_m, asked_right_m))),
          uneven = 1.0f - even, own = time.right ? right : left;
  const auto begins = both(lifts, limps);
  change.limp = begins ? smooth(kEvenSteps, kUnevenSteps, uneven) : change.limp;
  change.limp_far = begins ? V(longer / most(own, all<V>(kLeastAsked))) : change.limp_far;
}
template <class V>
void raise_limping_heel(const Tables& tables, const Time<V>& time, const V& phase, const V& ratio,
                        const V& u, const Change<V>& change, Stride<V>& stride) noexcept {
  const auto limps = both(time.flies, change.limp != V{});
  if (!any(limps)) return;
  const V shows = change.limp * smoother(V(u * 5.0f)) * (1.0f - smoother(V((u - 0.5f) * 2.5f))),
          as_far = ratio * change.limp_far;
  V heel_m[4];  // the left one's height, .., the right one's
  read_four(tables, time, 1, phase, as_far, as_far, V{}, heel_m);
  const V high_m = most(stride.heel_high_m, time.right ? heel_m[3] : heel_m[0]);
  stride.heel_high_m = limps ? mix(stride.heel_high_m, high_m, shows) : stride.heel_high_m;
}

// The stride of the foot that flies, at a phase of the clock. In a first
// and in a last step it flies as in strides of its own length, half of one, and before it lifts off
// it is read as it will then be; at the end of the last it lands flat.
template <class V>
Stride<V> read_by_clock(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                        const V& phase, const V& share, const V& u, const Change<V>& change,
                        const State<V>& state) noexcept {
  const auto closes = change.closing != V{}, starts = either(change.starting != V{}, closes);
  if (!any(starts)) {
    Stride<V> stride =
        read_stride(tables, time, phase, state.ratio_behind, landing.ratio, smoother(share));
    raise_limping_heel(tables, time, phase, landing.ratio, u, change, stride);
    return stride;
  }
  Stride<V> stride =
      read_stride(tables, time, both(starts, no(time.flies)) ? most(phase, time.stage_end) : phase,
                  starts ? short_ratio(tables, landing, state) : state.ratio_behind, landing.ratio,
                  closes ? V{} : smoother(starts ? u : share));
  const V flat = closes ? V(1.0f - smoother(u)) : all<V>(1.0f);
  FootInStride<V>& flies = stride.foot[0];
  flies.pitch_rad = flat * flies.pitch_rad;
  flies.twist_rad = flat * flies.twist_rad, flies.roll_rad = flat * flies.roll_rad;
  raise_limping_heel(tables, time, phase, landing.ratio, u, change, stride);
  stride.heel_high_m = starts ? stride.heel_behind_m.y : stride.heel_high_m;
  return stride;
}

// The share of what a change of plan has left of twist and roll of the foot that flies.
template <class V>
V edge_left(const V& u, const Change<V>& change) noexcept {
  return 1.0f - smoother(V((u - change.gap_begin) / change.gap_lasts));
}

// The share of a flight that is over, without the step that it makes where a changed plan gives the
// flight another time.
template <class V>
V flight_share(const V& u, const Change<V>& change) noexcept {
  const V share =
      change.gap_share + (u - change.gap_begin) * ((1.0f - change.gap_share) / change.gap_lasts);
  return change.gap_begin != V{} ? share : u;
}

// The pelvis alone, at any phase.
template <class V>
Vec<V> read_pelvis(const Tables& tables, const Time<V>& time, const V& phase, const V& behind,
                   const V& ahead, const V& change) noexcept {
  V n[4];
  read_four(tables, time, offsetof(StrideRow, pelvis_m) / sizeof(float), phase, behind, ahead,
            change, n);
  return {n[0], n[1], n[2]};
}

// Where a stride of this ratio goes: its length, and the footprints of swing and stand.
template <class V>
struct FootprintsIn {
  V stride_m{};
  Vec<V> swing_m, stand_m;
};
template <class V>
FootprintsIn<V> footprints_of(const Tables& tables, const Time<V>& time, const V& ratio) noexcept {
  const FootprintLines &ahead = tables.footprints, &back = tables.back_footprints;
  const V at =
      least(most(ratio, V{}), chosen<V>(time.back, tables.most_back_ratio, tables.most_ratio));
  const auto of = [&](const Mask<V>& right) {
    const Vec<V> at_zero_m =
                     chosen(time.back, by_side<V>(right, back.at_zero_m[0], back.at_zero_m[1]),
                            by_side<V>(right, ahead.at_zero_m[0], ahead.at_zero_m[1])),
                 per_ratio_m =
                     chosen(time.back, by_side<V>(right, back.per_ratio_m[0], back.per_ratio_m[1]),
                            by_side<V>(right, ahead.per_ratio_m[0], ahead.per_ratio_m[1]));
    return at_zero_m + per_ratio_m * at;
  };
  return {chosen<V>(time.back, back.stride_at_zero_m, ahead.stride_at_zero_m) +
              chosen<V>(time.back, back.stride_per_ratio_m, ahead.stride_per_ratio_m) * at,
          of(time.right), of(no(time.right))};
}

}  // namespace
}  // namespace gaitpad
