// Second part of a tick: plans the landing of the swing foot and the stride that the step takes.
#pragma once
#include "walk/gait_clock.h"

namespace gaitpad {
namespace {

template <class V>
struct Landing {
  V x_m{}, z_m{}, rad{};  // footprint: heel and direction
  Way<V> way;             // the same direction
  V ratio{};              // stride of this step over the data's
  V off_ratio{};          // in a first step: difference of `ratio` from the ratio of the landing
};

// q^n for whole n >= 0.
template <class V>
V power(float q, V n) noexcept {
  V result = all<V>(1.0f);
  for (; any(n > V{}); q *= q) {
    const V half = rounded(V(0.5f * n - 0.25f)), odd = n - 2.0f * half;
    result = result * (odd * q + (1.0f - odd));  // no branch, which could not be foreseen
    n = half;
  }
  return result;
}

// The heading `n` ticks from now if the turn's goal stays. The turn's filter is a linear recurrence
// with the double root q: its error is e_k = (e_0 + c k) q^k, whose sum has a closed form.
template <class V>
V heading_ahead(const Tables& tables, const State<V>& state, const V& n) noexcept {
  const float dt = tables.tick_s, q = std::sqrt(tables.turn_keep), w = 1.0f / q - 1.0f;
  const V goal = state.turn_goal_rad_s.x, e0 = state.turn_rad_s.x - goal;
  const auto turns = either(e0 != V{}, state.turn_rad_s.v != V{});
  const V straight = state.heading_rad + goal * n * dt;
  if (!any(turns)) return straight;
  const V e1 = e0 * (1.0f - w * w * q * q) + q * q * state.turn_rad_s.v * dt, c = e1 / q - e0,
          qn = power(q, n), s0 = q * (1.0f - qn) * (1.0f / (1.0f - q)),
          s1 = q * (1.0f - (n + 1.0f) * qn + n * qn * q) * (1.0f / ((1.0f - q) * (1.0f - q)));
  return turns ? V(state.heading_rad + (goal * n + e0 * s0 + c * s1) * dt) : straight;
}

// Direction of the body at the coming strike.
template <class V>
Way<V> way_at_strike(const Tables& tables, const Time<V>& time, const State<V>& state) noexcept {
  return way_of(heading_ahead(tables, state, V(time.to_strike + 1.0f)));
}

// A program may ask for a landing until kLatestAim of the flight; the landing is there from
// kAimSettles on.
inline constexpr float kLatestAim = 0.5f, kAimSettles = 0.75f;

// The planned landing. The step's length is measured along `to`, the heading at the strike, which
// may still turn when the place is settled. A closing step is taken with the stride of the last
// step.
template <class V>
Landing<V> planned_landing(const Tables& tables, const Time<V>& time, const Way<V>& to,
                           const Change<V>& change, const State<V>& state) noexcept {
  Landing<V> landing{state.landing_x_m, state.landing_z_m, state.landing_rad,
                     way_of(state.landing_rad)};
  const V step_m = to.ahead(landing.x_m, landing.z_m),
          own_m = own_step_m<V>(tables, time.right, time.back);
  landing.off_ratio = change.starting != V{} ? change.off_ratio.x : V{};
  landing.ratio =
      (change.closing != V{} ? state.ratio_behind : V(size(step_m) / own_m)) + change.off_ratio.x;
  return landing;
}

// The step that is asked for.
template <class V>
struct AskedStep {
  V length_m{};  // on level ground, backwards negative; 0 with an aim, which no slope shortens
  Way<V> along;  // from the standing footprint to the landing
  Way<V> to;     // the body's direction at the strike
};

// Moves the landing towards the one that is asked for on level ground.
template <class V, class F>
AskedStep<V> plan_landing(const Tables& tables, const Time<V>& time, Change<V>& change,
                          State<V>& state, F& footing) noexcept {
  // In a turn the path is an arc: its chord points between both headings. Footprints lie a little
  // outside of the data's tracks there. A turn on the spot, with steps below kInPlace_m, needs feet
  // kStance_m from the middle that point ahead of the body. Lengths are at the reference leg.
  constexpr float kWayTurns = 0.82f;  // of the turn, up to the direction of the chord
  constexpr float kWider_m = 0.045f;  // in turns of 1 rad/s and more, less in slower ones
  constexpr float kInPlace_m = 0.2f, kStance_m = 0.105f, kLeastWider_m = 0.03f;
  constexpr float kFootAhead = 0.45f;  // of the turn during the step
  constexpr float kSettling_s = 0.1f;  // time constant at 0.62 of the way from kSettles to kFreeze
  const auto closes = change.closing != V{};
  const V heading = heading_ahead(tables, state, V(time.to_strike + 1.0f));
  const Way<V> to = way_of(heading), along = way_of(V(kWayTurns * heading));
  const float grown = tables.size;
  const V steps_m = time.right ? state.length_m[1].x : state.length_m[0].x,
          ahead_m = time.back ? -steps_m : steps_m, length_m = closes ? V{} : ahead_m,
          lands_m = of_leg<V>(tables, time.right, &LegBones::track_m),
          stands_m = of_leg<V>(tables, no(time.right), &LegBones::track_m),
          outwards = chosen<V>(time.right, -1.0f, 1.0f);
  const V turns = least(size(state.turn_goal_rad_s.x), all<V>(1.0f)),
          in_place = 1.0f - smooth(V(size(length_m) * (1.0f / (kInPlace_m * grown))));
  const V arc_m = grown * kWider_m * turns,
          place_m =
              most(V(grown * kStance_m - size(lands_m)), all<V>(grown * kLeastWider_m)) * turns,
          wider_m = most(mix(arc_m, place_m, in_place), V{});
  // At rest both feet stand at hip width, wherever the standing foot has landed.
  const V rests_m = of_leg<V>(tables, time.right, &LegBones::stance_m),
          rested_m = of_leg<V>(tables, no(time.right), &LegBones::stance_m),
          asides_m = closes ? rests_m : V(lands_m + outwards * wider_m),
          stood_m = closes ? rested_m : V(stands_m - outwards * state.wider_m),
          lead_m = in_place * tables.rest_lead_m;
  const V ahead_rad = state.turn_goal_rad_s.x * (state.roll_ticks + state.flight_ticks) *
                      tables.tick_s * kFootAhead;
  const V y = settled(time.u, change);
  const auto follows = y <= V{}, open = y < all<V>(1.0f);
  const float settling = kSettling_s * tables.time_scale / (tables.ticks * tables.tick_s);
  const V share = 1.0f / (1.0f + settling * y * y / (1.0f - (open ? y : V{})));
  const auto keep = [&](const V& now, V& kept) {
    kept = follows ? now : open ? V(kept + (now - kept) * share) : kept;
  };
  V *kept_x_m = &state.landing_x_m, *kept_z_m = &state.landing_z_m;
  if constexpr (kIsUneven<F>) kept_x_m = &footing.level_x_m, kept_z_m = &footing.level_z_m;
  V x_m = along.sine * length_m + to.cosine * asides_m - stood_m - to.sine * lead_m,
    z_m = along.cosine * length_m - to.sine * asides_m + (1.0f - to.cosine) * lead_m,
    rad = heading + (closes ? V{} : V(in_place * ahead_rad));
  const auto turning = both(no(closes), turns != V{});
  if (any(turning)) {
    // In a tight turn the outer foot would land across the standing one's toe. On the spot, or in a
    // step that turns by more than a steered one does, its own toe, which points inwards, would
    // come to the standing foot. Lengths are at the reference leg: from axis to axis, and beyond
    // the toe, where it ends.
    constexpr float kClear_m = 0.08f, kSoftClear_m = 0.012f, kBeyond_m = 0.15f;
    constexpr float kSteered_rad = 0.8f, kFar_rad = 1.1f;  // between them the toe comes to count
    const LegBones &l = tables.leg[0], &r = tables.leg[1];
    const auto line_m = [&](const Mask<V>& right, int k) {
      return chosen<V>(right, r.toe_m[k] - r.heel_m[k], l.toe_m[k] - l.heel_m[k]);
    };
    const auto other = no(time.right);
    const Way<V> way = way_of(rad);
    const V toe =
                outwards * (way.cosine * line_m(time.right, 0) + way.sine * line_m(time.right, 2)),
            stands = most(V(outwards * line_m(other, 0)), V{}),
            far = smooth(kSteered_rad, kFar_rad, V(size(rad))),
            near_m = outwards * x_m + most(in_place, far) * (least(toe, V{}) - stands),
            past = smooth(V((size(z_m) - line_m(other, 2)) * (1.0f / (kBeyond_m * grown)))),
            short_m = grown * kClear_m * (1.0f - past) - near_m,
            clears_m =
                soft_positive(short_m, all<V>(grown * kSoftClear_m)) * (1.0f - past * past) * turns;
    x_m = x_m + (turning ? V(outwards * clears_m) : V{});
  }
  const auto aimed = change.is_aimed != V{};
  if (any(aimed)) {
    // The landing moves to its aim evenly until it is settled.
    const auto begins = both(no(time.flies), state.tick == all<V>(tables.ticks));
    const V settled = (time.flies ? V{} : state.roll_ticks) +
                      chosen<V>(time.flies, kAimSettles, kSettles) * state.flight_ticks,
            left = most(V(settled - state.tick + tables.ticks), all<V>(tables.ticks));
    const auto aim = [&](const V& at, V& kept, V& now) {
      const V from = begins ? now : kept;
      now = aimed ? V(from + tables.ticks * (at - from) / left) : now;
      kept = aimed ? now : kept;
    };
    aim(change.aim_x_m, *kept_x_m, x_m);
    aim(change.aim_z_m, *kept_z_m, z_m);
    aim(change.aim_rad, state.landing_rad, rad);
  }
  keep(x_m, *kept_x_m);
  keep(z_m, *kept_z_m);
  keep(rad, state.landing_rad);
  keep(wider_m, state.next_wider_m);
  keep(steps_m, change.stepped_m);
  return {aimed ? V{} : length_m, along, to};
}

}  // namespace
}  // namespace gaitpad
