// A walk whose pose is the tables' (Detail::tables): its plan goes on as ever, and its pose comes
// over within a moment, so that nothing jumps.
#pragma once
#include "walk/upper_body.h"

namespace gaitpad {
namespace {

// A pose that has begun to come over, or back, goes on to the end.
template <class V>
void come_to_tables(const Tables& tables, Change<V>& change) noexcept {
  constexpr float kComes_s = 0.25f;  // at the reference leg
  V& at = change.to_tables;
  const V one = all<V>(1.0f), next = at + tables.tick_s / (kComes_s * tables.time_scale);
  const auto asked = change.asks_tables != V{}, comes = at < one,
             rests = either(both(at == V{}, no(asked)), both(at == one, asked));
  const V over = least(next, one), back = next < all<V>(2.0f) ? next : V{};
  at = rests ? at : (comes ? over : back);
}

// Leg k, 0 for swing and 1 for stand, as the tables have it.
template <class V>
Leg<V> leg_of_tables(const Tables& tables, const Mask<V>& right, const Stride<V>& stride,
                     int k) noexcept {
  V table_rad[kLegAngles];
  set_table_angles(tables, right, stride, k, table_rad);
  return leg_at(table_rad);
}

// A walk that the tables alone pose begins anew with its legs and its upper body, should it come
// back.
template <class V>
void forget_pose(const Mask<V>& alone, State<V>& state, Change<V>& change, Weighted<V>& weighted,
                 Poise<V>& poise) noexcept {
  const auto drop = [&](V& number) { number = alone ? V{} : number; };
  for (int k : {0, 1})
    for (int j = 0; j < kLegAngles; ++j) drop(state.leg_rad[k][j]), drop(state.last_leg_rad[k][j]);
  drop(change.by_paper), drop(weighted.acts);
  drop(poise.acts), drop(poise.chest.ticks), drop(poise.head.ticks);
}

// Poses walks of which some show the tables. `pose` poses all in full, and is left out if the
// tables alone pose each.
template <int kWidth, class PoseInFull>
[[gnu::noinline]] void pose_with_tables(const Tables& tables, const BodyTick<Floats<kWidth>>& tick,
                                        const Floats<kWidth>& swing, Block<kWidth>& block,
                                        Feet<Floats<kWidth>>& feet, Leg<Floats<kWidth>> (&legs)[2],
                                        const Poses& poses, const PoseInFull& pose) noexcept {
  using V = Floats<kWidth>;
  Change<V>& change = block.change;
  Styled<V>& styled = block.styled;
  const auto alone = change.to_tables == all<V>(1.0f);
  if (any(no(alone))) {
    const Weighted<V> weighted = block.weighted;
    const Smoothed<V> rail[2] = {styled.rail_ground_m[0], styled.rail_ground_m[1]};
    const Poise<V> poise = block.poise;
    const Feet<V> planned = feet;
    pose();
    put_where<V>(alone, weighted, block.weighted), put_where<V>(alone, rail, styled.rail_ground_m);
    put_where<V>(alone, poise, block.poise), put_where<V>(alone, planned, feet);
  }
  forget_pose(alone, block.state, change, block.weighted, block.poise);
  const V share = smoother(V(1.0f - size(V(1.0f - change.to_tables))));
  for (int k : {0, 1}) {
    const Leg<V> by_tables = leg_of_tables(tables, is_right(tick.time, k), tick.stride, k);
    Leg<V>& leg = legs[k];
    const auto mixed = [&](const Turn<V>& full, const Turn<V>& of_tables) {
      return chosen(alone, of_tables, chosen(share != V{}, between(full, of_tables, share), full));
    };
    leg.hip = mixed(leg.hip, by_tables.hip), leg.knee = mixed(leg.knee, by_tables.knee);
    leg.ankle = mixed(leg.ankle, by_tables.ankle);
    leg.short_m = alone ? V{} : leg.short_m, leg.iterations = alone ? V{} : leg.iterations;
    leg.failed = both(leg.failed, no(alone));
    leg.more_pitch_rad *= 1.0f - share;
  }
  write_data(tables, data_read(tables, tick, {swing, swing}, block.state), share, poses);
}

}  // namespace
}  // namespace gaitpad
