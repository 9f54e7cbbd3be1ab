// Keeps knees that are nearly straight from jumping: there a tenth of a millimetre between hip and
// ankle turns the knee by a degree, so the hips give way by so little.
#pragma once

#include "walk/leg_solve.h"
#include "walk/reach.h"

namespace gaitpad {
namespace {

// A leg between hip and ankle.
template <class V>
struct Span {
  V thigh_m, shank_m;
  V far_m;    // distance of hip and ankle
  V below_m;  // of that, how far the ankle is below the hip
};

template <class V>
Span<V> span_of(const Tables& tables, const Time<V>& time, int k, const Vec<V>& ankle_m,
                const Pelvis<V>& pelvis) noexcept {
  const auto right = is_right(time, k);
  const Vec<V> way = ankle_m - (pelvis.place_m + pelvis.hip_m[k]);
  const V far_m = root(dot(way, way));
  return {of_leg<V>(tables, right, &LegBones::thigh_m),
          of_leg<V>(tables, right, &LegBones::shank_m), far_m,
          most(V(-way.y), V(kLeastBelow * far_m))};
}

template <class V>
V knee_of(const Span<V>& span) noexcept {
  const V squares = span.thigh_m * span.thigh_m + span.shank_m * span.shank_m,
          cosine =
              within(V((span.far_m * span.far_m - squares) / (2.0f * span.thigh_m * span.shank_m)),
                     kFoldedCosine, kStraightCosine);
  return angle_of(V(root(V(1.0f - cosine * cosine))), cosine);
}

// How far up the hips make the knee bend by this angle, to first order.
template <class V>
V raise_to(const V& knee_rad, const Span<V>& span) noexcept {
  return (span_of_knee_m(span.thigh_m, span.shank_m, knee_rad) - span.far_m) * span.far_m /
         span.below_m;
}

// Raises or lowers the hips where the second difference of a nearly straight knee would be too
// large.
template <class V>
void ease_knees(const Tables& tables, const Time<V>& time, const Vec<V> (&ankle_m)[2],
                Change<V>& change, Pelvis<V>& pelvis) noexcept {
  // The bound is 1 degree a tick^2 of 240 Hz. Knees that bend farther than kStraight_rad turn too
  // little with the hips. Hips give way by at most kMostRaised_m, and are back in kFades_s; both at
  // the reference leg.
  constexpr float kMostBend_rad_s2 = 1005.0f, kStraight_rad = 25.0f * kDegree_rad,
                  kLeast_rad = 1.1f * kDegree_rad, kMostRaised_m = 0.012f, kFades_s = 0.1f;
  Off<V>& off = change.raised_m;
  fade(change.raised_ticks, off);
  change.raised_ticks = most(V(change.raised_ticks - 1.0f), V{});
  pelvis.place_m.y = pelvis.place_m.y + off.x;
  const V most_rad = all<V>(kMostBend_rad_s2 * tables.tick_s * tables.tick_s);
  V knee_rad[2], bent_rad[2], stretched_rad[2];
  Span<V> span[2];
  Mask<V> is_straight[2], jumps{};
  for (int k : {0, 1}) {
    const V last = change.knee_rad[0][k], before = change.knee_rad[1][k],
            goes_on_rad = 2.0f * last - before, left_rad = most(V(last - kLeastKnee_rad), V{}),
            brake_rad = 0.5f * (root(V(most_rad * (most_rad + 8.0f * left_rad))) - most_rad);
    span[k] = span_of(tables, time, k, ankle_m[k], pelvis);
    knee_rad[k] = knee_of(span[k]);
    bent_rad[k] = goes_on_rad + most_rad;
    stretched_rad[k] = least(most(V(goes_on_rad - most_rad), V(last - brake_rad)), bent_rad[k]);
    is_straight[k] = both(before != V{}, knee_rad[k] < all<V>(kStraight_rad));
    jumps = either(jumps, both(is_straight[k],
                               either(knee_rad[k] > bent_rad[k], knee_rad[k] < stretched_rad[k])));
    jumps = either(jumps, both(off.x > V{}, knee_rad[k] < all<V>(kLeast_rad)));
  }
  if (any(jumps)) {
    // The straighter knee is heard last.
    const auto stand_last = knee_rad[1] < knee_rad[0];
    const auto clamp = [&](int k, const V& by_m) {
      const V clamped_m =
          least(most(by_m, raise_to(bent_rad[k], span[k])), raise_to(stretched_rad[k], span[k]));
      return is_straight[k] ? clamped_m : by_m;
    };
    const V room_m = all<V>(kMostRaised_m * tables.size),
            wanted_m = stand_last ? clamp(1, clamp(0, V{})) : clamp(0, clamp(1, V{})),
            down_m = least(V(-room_m - off.x), V{});
    // No leg is stretched: hips that are raised come down for it.
    V up_m = most(V(room_m - off.x), V{});
    for (int k : {0, 1})
      up_m = least(up_m, most(raise_to(all<V>(kLeast_rad), span[k]), least(V(-off.x), V{})));
    const V by_m = jumps ? least(most(wanted_m, down_m), up_m) : V{};
    off.x = off.x + by_m;
    off.v = off.v + by_m;
    change.raised_ticks =
        jumps ? all<V>(kFades_s * tables.time_scale / tables.tick_s) : change.raised_ticks;
    pelvis.place_m.y = pelvis.place_m.y + by_m;
    for (int k : {0, 1})
      knee_rad[k] = jumps ? knee_of(span_of(tables, time, k, ankle_m[k], pelvis)) : knee_rad[k];
  }
  for (int k : {0, 1}) {
    change.knee_rad[1][k] = change.knee_rad[0][k];
    change.knee_rad[0][k] = knee_rad[k];
  }
}

}  // namespace
}  // namespace gaitpad
