// Reads the strides' tables. For each walk the rows around its phase and ratio are summed; then the
// sums are transposed, so that a register holds one number of all walks.
#pragma once
#include <algorithm>
#include <cstddef>

#include "walk/footholds.h"

namespace gaitpad {
namespace {

// The numbers of a row that fit in a register. Sums go across rows, never along them, so their bits
// do not depend on the register's width.
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

// Transposes rows, one for each walk, to registers, one for each number. `numbers` is a multiple of
// four.
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

// Four neighbouring rows: the number of the first, and their weights.
template <class V>
struct Knots {
  V first;
  V weight[4];
};
// Cubic B-spline weights of the knots around a place: the share t of the way from knot `first + 1`
// to the next one.
template <class V>
Knots<V> spline_knots(const V& first, const V& t) noexcept {
  const V s = 1.0f - t;
  return {first,
          {s * s * s * (1.0f / 6.0f), (4.0f + t * t * (3.0f * t - 6.0f)) * (1.0f / 6.0f),
           (4.0f + s * s * (3.0f * s - 6.0f)) * (1.0f / 6.0f), t * t * t * (1.0f / 6.0f)}};
}
template <class V>
Knots<V> knots_at(const V& phase) noexcept {
  const V x = (phase - floored(phase)) * float(kKnots),
          i = least(floored(x), all<V>(kKnots - 1.0f));
  return spline_knots(i, V(x - i));
}
// The four ratios around one and their Catmull-Rom weights. The first row may be -1, with weight 0:
// beyond the ends the tables go on straight.
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
// The tables at one phase, mixed from the last step's stride and this step's stride. Pairs are
// swing and stand. Places are in the travel frame of the stride.
template <class V>
struct Stride {
  Vec<V> heel_behind_m, heel_ahead_m;  // swing heel in the last step's stride; in this step's
  V heel_high_m{};                     // its height, mixed
  FootInStride<V> foot[2];
  Vec<V> pelvis_m, pelvis_tilt_rad;
  V pelvis_yaw_rad{};
  V pelvis_low_m{}, pelvis_high_m{};  // lowest and highest place of the pelvis in the stride
  V leg_rad[2][kLegAngles]{};
  V stood_pitch_rad{};  // of the swing foot by the phase of the hips, not of the clock
};

// Sorts the numbers of left and right by swing and stand.
template <class V>
inline void by_foot(const Mask<V>& right, const V& of_left, const V& of_right, V& swing,
                    V& stand) noexcept {
  swing = right ? of_right : of_left;
  stand = right ? of_left : of_right;
}

// The rows of a table, in order of knots, and at each knot in order of ratios.
struct Rows {
  const float* first;
  int of_knot;
  const float* at(int knot, int ratio) const noexcept {
    return first + knot * of_knot + ratio * kRowNumbers;
  }
};
inline Rows rows_of(const Tables& tables, bool back) noexcept {
  const StrideRow* first = back ? &tables.build.back[0][0] : &tables.build.forward[0][0];
  return {reinterpret_cast<const float*>(first),
          (back ? kBackRatios : kStrideRatios) * kRowNumbers};
}
template <class V>
V last_ratio(const Mask<V>& back) noexcept {
  return chosen<V>(back, kBackRatios - 1.0f, kStrideRatios - 1.0f);
}

// Ratio of the strides whose half is the way of the flying foot, ahead or aside, for a first or a
// last step. Turning on the spot it may be set down behind where it stood; no stride of these
// tables leads there. A difference that a change of plan leaves in the ratio fades with the change;
// one that makes the stride shorter than the way fades by kComesUp of the flight.
template <class V>
V short_ratio(const Tables& tables, const Landing<V>& landing, const Change<V>& change,
              const State<V>& state) noexcept {
  constexpr float kComesUp = 0.3f;
  // Rounds the least ratio, of a landing that passes the footprint; at the reference leg. A first
  // step's passes it at up to 18 mm a tick, where a stick crosses the heading. A last step may end
  // in its place, so it is rounded less.
  constexpr float kSoftFirst_m = 0.03f, kSoftLast_m = 0.01f;
  const V x = landing.x_m - state.print_x_m, z = landing.z_m - state.print_z_m,
          goes_m = landing.way.ahead(x, z),
          ahead_m = most(state.backward != V{} ? -goes_m : goes_m, V{}),
          aside_m = landing.way.left(x, z);
  const V soft_m = tables.size * chosen<V>(change.starting != V{}, kSoftFirst_m, kSoftLast_m);
  const V own = root(V(ahead_m * ahead_m + aside_m * aside_m + soft_m * soft_m)) *
                (1.0f / (tables.leg[0].own_step_m + tables.leg[1].own_step_m)),
          off = 0.5f * landing.off_ratio,
          flown = state.flies != V{} ? V(state.tick / state.flight_ticks) : V{},
          low = off * (1.0f - smoother(0.0f, kComesUp, flown));
  return most(V(own + (off < V{} ? low : off)), V{});
}

// Walks for which a stride is read: only its plan, which is the flying foot and the pelvis' place,
// or the whole of it, legs and turn of the pelvis as well. What is not read is 0. `plan` holds
// wherever `whole` does.
template <class V>
struct Reads {
  Mask<V> plan, whole;
};

// The swing heel of both heels of a row, and a row's other numbers.
template <class V>
Vec<V> swing_heel(const Time<V>& time, const V* of) noexcept {
  return chosen(time.right, Vec<V>{of[3], of[4], of[5]}, Vec<V>{of[0], of[1], of[2]});
}
template <class V>
Stride<V> stride_of(const Time<V>& time, const V* n) noexcept {
  Stride<V> stride;
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
  return stride;
}

// Indices in a row: pitch of the left foot, then of the right one; place of the pelvis.
inline constexpr int kPitchAt = offsetof(StrideRow, pitch_rad) / sizeof(float),
                     kPelvisAt = offsetof(StrideRow, pelvis_m) / sizeof(float);

// The rows that a mix of two strides reads at each knot, and the weight of each. Reads at several
// phases share it.
template <class V>
struct StrideMix {
  struct OfWalk {
    Rows rows{};  // none: this walk is not read
    int begin = 0, end = 0;
    float weight[kStrideRatios + 4]{};  // by ratio + 1
  };
  OfWalk walk[kLanes<V>];
  // Leaves out all walks but these.
  void keep(const Mask<V>& where) noexcept {
    const V is = chosen<V>(where, 1.0f, 0.0f);
    for (int w = 0; w < kLanes<V>; ++w)
      if (lane(is, w) == 0.0f) walk[w].rows.first = nullptr;
  }
};
// The mix of strides around the ratios of two others, for walks `where` it is asked for. `change`:
// the share of the second one.
template <class V>
StrideMix<V> mix_of_ratios(const Tables& tables, const Time<V>& time, const Knots<V>& old,
                           const Knots<V>& next, const V& change, const Mask<V>& where) noexcept {
  const V last = last_ratio<V>(time.back), back = chosen<V>(time.back, 1.0f, 0.0f),
          is = chosen<V>(where, 1.0f, 0.0f);
  StrideMix<V> mix;
  for (int w = 0; w < kLanes<V>; ++w) {
    if (lane(is, w) == 0.0f) continue;
    auto& of = mix.walk[w];
    const int first[2] = {static_cast<int>(lane(old.first, w)),
                          static_cast<int>(lane(next.first, w))};
    const float share = lane(change, w), left = 1.0f - share;
    for (int k = 0; k < 4; ++k) of.weight[first[0] + 1 + k] = lane(old.weight[k], w) * left;
    for (int k = 0; k < 4; ++k) of.weight[first[1] + 1 + k] += lane(next.weight[k], w) * share;
    of.begin = std::max(0, std::min(first[0], first[1]));
    of.end = std::min(static_cast<int>(lane(last, w)), std::max(first[0], first[1]) + 3);
    of.rows = rows_of(tables, lane(back, w) != 0.0f);
  }
  return mix;
}
// The mix of the strides of ratios `behind` and `ahead`; and the stride of one ratio.
template <class V>
StrideMix<V> mix_of_strides(const Tables& tables, const Time<V>& time, const V& behind,
                            const V& ahead, const V& change, const Mask<V>& where) noexcept {
  const V last = last_ratio<V>(time.back);
  return mix_of_ratios(tables, time, ratios_at(behind, last), ratios_at(ahead, last), change,
                       where);
}
template <class V>
StrideMix<V> mix_of_strides(const Tables& tables, const Time<V>& time, const V& ratio,
                            const Mask<V>& where) noexcept {
  return mix_of_strides(tables, time, ratio, ratio, V{}, where);
}

// Reads the numbers of a stride. `change`: share by which the last step's stride, of ratio
// `behind`, has changed into this step's, of ratio `ahead`.
template <class V>
Stride<V> read_stride(const Tables& tables, const Time<V>& time, const V& phase, const V& behind,
                      const V& ahead, const V& change, const Reads<V>& reads) noexcept {
  constexpr int kWidth = kLanes<V>, kPart = kLanes<RowPart>, kParts = kRowNumbers / kPart,
                kHeelParts = kHeelNumbers / kPart, kPlanParts = kPlanNumbers / kPart,
                kNumbers = kRowNumbers + 2 * kHeelNumbers;
  const V last = last_ratio<V>(time.back), is_whole = chosen<V>(reads.whole, 1.0f, 0.0f);
  const Knots<V> knots = knots_at(phase), old = ratios_at(behind, last),
                 next = ratios_at(ahead, last);
  const StrideMix<V> mix = mix_of_ratios(tables, time, old, next, change, reads.plan);
  alignas(64) float row[kWidth][kNumbers];
  for (int w = 0; w < kWidth; ++w) {
    const auto& of_walk = mix.walk[w];
    const Rows& rows = of_walk.rows;
    if (rows.first == nullptr) {
      std::memset(row[w], 0, sizeof row[w]);
      continue;
    }
    const bool whole = lane(is_whole, w) != 0.0f;
    const int i = static_cast<int>(lane(knots.first, w));
    float of_old[kStrideRatios + 4] = {}, of_next[kStrideRatios + 4] = {};  // by ratio + 1
    for (int k = 0; k < 4; ++k) {
      of_old[static_cast<int>(lane(old.first, w)) + 1 + k] = lane(old.weight[k], w);
      of_next[static_cast<int>(lane(next.first, w)) + 1 + k] = lane(next.weight[k], w);
    }
    const float k0 = lane(knots.weight[0], w), k1 = lane(knots.weight[1], w),
                k2 = lane(knots.weight[2], w), k3 = lane(knots.weight[3], w);
    RowPart sum[kParts] = {}, heel_old[kHeelParts] = {}, heel_next[kHeelParts] = {};
    for (int r = of_walk.begin; r <= of_walk.end; ++r) {
      const float a = of_old[r + 1], b = of_next[r + 1], mixed = of_walk.weight[r + 1];
      const float *p0 = rows.at(i, r), *p1 = rows.at(i + 1, r), *p2 = rows.at(i + 2, r),
                  *p3 = rows.at(i + 3, r);
      const auto here = [&](int n) {
        const int o = n * kPart;
        return RowPart(part<RowPart>(p0 + o) * k0 + part<RowPart>(p1 + o) * k1 +
                       part<RowPart>(p2 + o) * k2 + part<RowPart>(p3 + o) * k3);
      };
#pragma GCC unroll 4
      for (int n = 0; n < kPlanParts; ++n) {
        const RowPart of = here(n);
        sum[n] += of * mixed;
        if (n < kHeelParts) {
          heel_old[n] += of * a;
          heel_next[n] += of * b;
        }
      }
      if (!whole) continue;
#pragma GCC unroll 10
      for (int n = kPlanParts; n < kParts; ++n) sum[n] += here(n) * mixed;
    }
    std::memcpy(row[w], sum, sizeof sum);
    std::memcpy(row[w] + kRowNumbers, heel_old, kHeelNumbers * sizeof(float));
    std::memcpy(row[w] + kRowNumbers + kHeelNumbers, heel_next, kHeelNumbers * sizeof(float));
  }
  V n[kNumbers];
  to_lanes(&row[0][0], kNumbers, n);

  Stride<V> stride = stride_of(time, n);
  const auto heel = [&](const V* of) { return swing_heel(time, of); };
  stride.heel_high_m = heel(n).y;
  stride.heel_behind_m = heel(n + kRowNumbers);
  stride.heel_ahead_m = heel(n + kRowNumbers + kHeelNumbers);
  return stride;
}

// Sums kParts registers of the rows of a mix, from number `at` on, around a walk's knots.
template <class R, int kParts, class OfWalk, class V>
[[gnu::always_inline]] inline void sum_rows(const OfWalk& of, int at, const Knots<V>& knots, int w,
                                            R (&sum)[kParts]) noexcept {
  const float* row = of.rows.at(static_cast<int>(lane(knots.first, w)), of.begin) + at;
  const float k0 = lane(knots.weight[0], w), k1 = lane(knots.weight[1], w),
              k2 = lane(knots.weight[2], w), k3 = lane(knots.weight[3], w);
  const int knot = of.rows.of_knot;
  for (int r = of.begin; r <= of.end; ++r, row += kRowNumbers) {
    const float weight = of.weight[r + 1];
#pragma GCC unroll 10
    for (int n = 0; n < kParts; ++n) {
      const float* const from = row + n * kLanes<R>;
      const R here = part<R>(from) * k0 + part<R>(from + knot) * k1 +
                     part<R>(from + 2 * knot) * k2 + part<R>(from + 3 * knot) * k3;
      sum[n] += here * weight;
    }
  }
}

// Reads kNumbers neighbouring numbers of a row, from number `at` on; 0 for walks that the mix
// leaves out.
template <class R, int kNumbers, class V>
void read_row(const StrideMix<V>& mix, int at, const V& phase, V (&to)[kNumbers]) noexcept {
  const Knots<V> knots = knots_at(phase);
  alignas(64) float row[kLanes<V>][kNumbers];
  for (int w = 0; w < kLanes<V>; ++w) {
    R sum[kNumbers / kLanes<R>] = {};
    if (mix.walk[w].rows.first != nullptr) sum_rows(mix.walk[w], at, knots, w, sum);
    std::memcpy(row[w], sum, sizeof sum);
  }
  to_lanes(&row[0][0], kNumbers, to);
}

// Reads a stride but for its heels, which are 0; all of it is 0 for walks that the mix leaves out.
template <class V>
Stride<V> read_stride(const StrideMix<V>& mix, const Time<V>& time, const V& phase) noexcept {
  V n[kRowNumbers];
  read_row<RowPart>(mix, 0, phase, n);
  return stride_of(time, n);
}

// Reads four neighbouring numbers of a row.
template <class V>
void read_four(const StrideMix<V>& mix, int at, const V& phase, V (&to)[4]) noexcept {
  read_row<Four>(mix, at, phase, to);
}

// The same at several phases. The knots of one walk's phases are found side by side.
template <class V, int kPhases>
void read_fours(const StrideMix<V>& mix, int at, const V (&phase)[kPhases],
                V (&to)[kPhases][4]) noexcept {
#ifndef GAITPAD_NO_VECTORS
  if constexpr (kLanes<V> == 1) {
    using Phases = Floats<kPhases <= 4 ? 4 : 8>;
    static_assert(kPhases <= kLanes<Phases>);
    Phases phases{};
    std::memcpy(&phases, phase, sizeof phase);
    const Knots<Phases> knots = knots_at(phases);
    for (int i = 0; i < kPhases; ++i) {
      Four sum[1] = {};
      if (mix.walk[0].rows.first != nullptr) sum_rows(mix.walk[0], at, knots, i, sum);
      std::memcpy(to[i], sum, sizeof sum);
    }
    return;
  }
#endif
  for (int i = 0; i < kPhases; ++i) read_four(mix, at, phase[i], to[i]);
}

// Plans the limp of a flight at its lift-off; if it followed a style that changes during the
// flight, the heel would jump. In a limp the mean stride is short, and its tables would keep the
// heels of both feet low. So a heel flies as high as in strides in which both feet go as far as the
// longer step, and comes down as in the tables.
template <class V>
void plan_limp(const Tables& tables, const Time<V>& time, const Mask<V>& lifts,
               const State<V>& state, Change<V>& change) noexcept {
  // The limp begins where the steps' ratios differ by kEvenSteps and is whole from kUnevenSteps on.
  // kLeastAsked, of the data's step, keeps tiny steps from counting as uneven.
  constexpr float kEvenSteps = 0.03f, kUnevenSteps = 0.2f, kLeastAsked = 0.1f;
  // An even style asks for equal lengths or for equal ratios to the data, whose steps may differ.
  const V &left_m = state.length_m[0].x, &right_m = state.length_m[1].x;
  const auto none = V{} != V{};
  const V per_left_m = 1.0f / own_step_m<V>(tables, none, time.back),
          per_right_m = 1.0f / own_step_m<V>(tables, no(none), time.back),
          left = left_m * per_left_m, right = right_m * per_right_m, longer = most(left, right),
          shorter = least(left, right);
  // Stops, and walks that go on after all, choose their own lengths: that is no limp.
  const auto walks = both(both(change.stops == V{}, change.closing == V{}), change.resumes == V{}),
             limps = both(walks, longer - shorter > kEvenSteps * (longer + kLeastAsked));
  change.limp = lifts ? V{} : change.limp;
  if (!any(both(lifts, limps))) return;
  const auto evenness = [](const V& a, const V& b, float least_asked) {
    return V((least(a, b) + least_asked) / (most(a, b) + least_asked));
  };
  const auto even_of = [&](const V& of_left_m, const V& of_right_m) {
    return most(evenness(V(of_left_m * per_left_m), V(of_right_m * per_right_m), kLeastAsked),
                evenness(of_left_m, of_right_m, kLeastAsked * tables.source_step_m));
  };
  // Nor is it a limp if steps are still on their way to the even lengths that are asked for.
  const V even = most(even_of(left_m, right_m),
                      even_of(state.asked.length_m[0], state.asked.length_m[1])),
          uneven = 1.0f - even, own = time.right ? right : left;
  const auto begins = both(lifts, limps);
  change.limp = begins ? smooth(kEvenSteps, kUnevenSteps, uneven) : change.limp;
  change.limp_far = begins ? V(longer / most(own, all<V>(kLeastAsked))) : change.limp_far;
}
// Raises a limping heel by the plan: from 0 to 0.2 of the flight, and back from 0.5 to 0.9.
template <class V>
void raise_limping_heel(const Tables& tables, const Time<V>& time, const V& phase, const V& ratio,
                        const V& u, const Change<V>& change, Stride<V>& stride) noexcept {
  const auto limps = both(time.flies, change.limp != V{});
  if (!any(limps)) return;
  const V shows = change.limp * smoother(V(u * 5.0f)) * (1.0f - smoother(V((u - 0.5f) * 2.5f))),
          as_far = ratio * change.limp_far;
  V heel_m[4];  // 0: height of the left heel, 3: of the right one
  read_four(mix_of_strides(tables, time, as_far, limps), 1, phase, heel_m);
  const V high_m = most(stride.heel_high_m, time.right ? heel_m[3] : heel_m[0]);
  stride.heel_high_m = limps ? mix(stride.heel_high_m, high_m, shows) : stride.heel_high_m;
}

// Walks whose last step went somewhere, on level ground.
template <class V>
Mask<V> goes_level(const Tables& tables, const State<V>& state) noexcept {
  constexpr float kGoes = 0.1f;  // least ratio of the last step's stride
  return state.ratio_behind > all<V>(tables.terrain == nullptr ? kGoes : kNever);
}
// The share by which a last foot flies low. On uneven ground it has risers to pass, and on the spot
// it is lifted for a short way.
template <class V>
V closes_low(const Tables& tables, const Change<V>& change, const State<V>& state) noexcept {
  // Factors on the height: such a style's feet keep their flight. A style may come or go in it.
  constexpr float kLow = 1.05f, kHigh = 1.25f;
  const V high = most(state.lift[0].x, state.lift[1].x);
  return both(change.closing != V{}, goes_level(tables, state))
             ? V(1.0f - smoother(kLow, kHigh, high))
             : V{};
}
// The share that is shown of a last flight's height and of its difference from its even way.
// Captured feet leave the floor at once in short strides, and the phase of a last flight is fast.
template <class V>
V comes_in(const V& u) noexcept {
  constexpr float kComesIn = 0.3f;  // of the flight
  return smoother(0.0f, kComesIn, u);
}

// The stride at a phase of the clock, for the flying foot. In a first and in a last step the foot
// flies as in half a stride of its own length (short_ratio()); in the roll it is read at its
// lift-off. In the last step it lands flat, and is lifted no higher than people's.
template <class V>
Stride<V> read_by_clock(const Tables& tables, const Time<V>& time, const Landing<V>& landing,
                        const V& phase, const V& share, const V& u, const Reads<V>& reads,
                        const Change<V>& change, const State<V>& state) noexcept {
  // Captured feet rise by up to 17 cm and 50 degrees in the shortest strides, which were solved
  // from whole steps. Bounds of a last flight, beside what is left of its lift-off.
  constexpr float kMostHigh_m = 0.08f, kSoftHigh_m = 0.05f;      // at the reference leg
  constexpr float kMostPitch_rad = 0.5f, kSoftPitch_rad = 0.2f;  // of the foot's pitch
  if (!any(reads.plan)) return {};
  const auto closes = change.closing != V{}, is_short = either(change.starting != V{}, closes);
  if (!any(is_short)) {
    Stride<V> stride =
        read_stride(tables, time, phase, state.ratio_behind, landing.ratio, smoother(share), reads);
    raise_limping_heel(tables, time, phase, landing.ratio, u, change, stride);
    return stride;
  }
  Stride<V> stride = read_stride(
      tables, time, both(is_short, no(time.flies)) ? most(phase, time.stage_end) : phase,
      is_short ? short_ratio(tables, landing, change, state) : state.ratio_behind, landing.ratio,
      closes ? V{} : smoother(is_short ? u : share), reads);
  const V flat = closes ? V(1.0f - smoother(u)) : all<V>(1.0f);
  FootInStride<V>& flies = stride.foot[0];
  flies.pitch_rad = flat * flies.pitch_rad;
  flies.twist_rad = flat * flies.twist_rad, flies.roll_rad = flat * flies.roll_rad;
  raise_limping_heel(tables, time, phase, landing.ratio, u, change, stride);
  stride.heel_high_m = is_short ? stride.heel_behind_m.y : stride.heel_high_m;
  const V low = closes_low(tables, change, state),
          low_m = soft_least(stride.heel_high_m, all<V>(kMostHigh_m * tables.size),
                             all<V>(kSoftHigh_m * tables.size));
  stride.heel_high_m = closes ? mix(stride.heel_high_m, low_m, low) : stride.heel_high_m;
  const V pitch_rad = soft_least(flies.pitch_rad, all<V>(kMostPitch_rad), all<V>(kSoftPitch_rad));
  // In a first flight, too: the toe of a foot that points down would stay at the floor for longer.
  const auto starts = tables.terrain == nullptr ? change.starting != V{} : Mask<V>{};
  flies.pitch_rad = starts   ? pitch_rad
                    : closes ? mix(flies.pitch_rad, pitch_rad, low)
                             : flies.pitch_rad;
  return stride;
}

// Share that is left of the differences of yaw, twist and roll after a change of plan.
template <class V>
V edge_left(const V& u, const Change<V>& change) noexcept {
  return 1.0f - smoother(V((u - change.gap_begin) / change.gap_lasts));
}

// Share of a flight that is over. It does not jump where a changed plan gives the flight another
// duration, as u does.
template <class V>
V flight_share(const V& u, const Change<V>& change) noexcept {
  const V share =
      change.gap_share + (u - change.gap_begin) * ((1.0f - change.gap_share) / change.gap_lasts);
  return change.gap_begin != V{} ? share : u;
}

// Reads the place of the pelvis alone, at several phases or at one.
template <class V, int kPhases>
void read_pelvis(const StrideMix<V>& mix, const V (&phase)[kPhases],
                 Vec<V> (&pelvis_m)[kPhases]) noexcept {
  V n[kPhases][4];
  read_fours(mix, kPelvisAt, phase, n);
  for (int i = 0; i < kPhases; ++i) pelvis_m[i] = {n[i][0], n[i][1], n[i][2]};
}
template <class V>
Vec<V> read_pelvis(const Tables& tables, const Time<V>& time, const V& phase,
                   const V& ratio) noexcept {
  V n[4];
  read_four(mix_of_strides(tables, time, ratio, V{} == V{}), kPelvisAt, phase, n);
  return {n[0], n[1], n[2]};
}

// The footprints of a stride, in its travel frame: its length, and the heels of swing and stand.
template <class V>
struct FootprintsIn {
  V stride_m{};
  Vec<V> swing_m, stand_m;
};
template <class V>
FootprintsIn<V> footprints_of(const Tables& tables, const Time<V>& time, const V& ratio) noexcept {
  const FootprintLines &ahead = tables.build.footprints, &back = tables.build.back_footprints;
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
