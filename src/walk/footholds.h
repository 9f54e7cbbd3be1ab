// Second: where the swinging foot will land, and which stride the step is.
#pragma once
#include "walk/gait_clock.h"

namespace gaitpad {
namespace {

template <class V>
struct Landing {
  V x_m{}, z_m{}, rad{};  // the footprint
  Way<V> way;             // where it points
  V ratio{};              // of the stride that the step is taken with
  V off_ratio{};          // of a first step: what it still is off the step's own
};

// q^n of whole numbers n, at least 0.
template <class V>
V power(float q, V n) noexcept {
  V result = all<V>(1.0f);
  for (; any(n > V{}); q *= q) {
    const V half = floored(V(0.5f * n));
    result = n != 2.0f * half ? result * q : result;
    n = half;
  }
  return result;
}

// The heading so many ticks ahead if the turn's goal stays: its filter is a linear recurrence with
// the double root q, so the error is e_k = (e_0 + c k) q^k, and its sum has a closed form.
template <class V>
V heading_ahead(const Tables& tables, const State<V>& state, const V& n) noexcept {
  const float dt = tables.tick_s, q = std::sqrt(tables.turn.keep), w = 1.0f / q - 1.0f;
  const V goal = state.turn_goal_rad_s.x, e0 = state.turn_rad_s.x - goal;
  const auto turns = either(e0 != V{}, state.turn_rad_s.v != V{});
  const V straight = state.heading_rad + goal * n * dt;
  if (!any(turns)) return straight;
  const V e1 = e0 * (1.0f - w * w * q * q) + q * q * state.turn_rad_s.v * dt, c = e1 / q - e0,
          qn = power(q, n), s0 = q * (1.0f - qn) * (1.0f / (1.0f - q)),
          s1 = q * (1.0f - (n + 1.0f) * qn + n * qn * q) * (1.0f / ((1.0f - q) * (1.0f - q)));
  return turns ? V(state.heading_rad + (goal * n + e0 * s0 + c * s1) * dt) : straight;
}

// Footprints lie on both sides of the path, which in a turn is an arc from the one's direction to
// the other's: the way between them leads so far round. Turning on the spot they stand wider apart
// and point ahead of the body.
inline constexpr float kWayTurns = 0.82f, kInPlace_m = 0.2f, kFootAhead = 0.45f, kWider_s = 0.045f,
                       kWidest_m = 0.045f, kStance_m = 0.105f, kLeastWider_m = 0.03f;

// A landing follows what is asked at once until kSettles of the flight, then more and more slowly,
// and from kFreeze on no more. To stop it at once would be a jerk of the foot that flies.
inline constexpr float kSettles = 0.25f, kFreeze = 0.6f, kSettling_s = 0.1f;
// Of a flight: a landing may be asked for until kLatestAim, and is where it was asked to be from
// kAimSettles on.
inline constexpr float kLatestAim = 0.5f, kAimSettles = 0.75f;

// As it is planned. The step's stride counts along the heading `to`, which may still turn after the
// place is settled; a step that closes keeps what is left of the last one.
template <class V>
Landing<V> planned_landing(const Tables& tables, const Time<V>& time, const Way<V>& to,
                           const Change<V>& change, const State<V>& state) noexcept {
  Landing<V> landing{state.landing_x_m, state.landing_z_m, state.landing_rad,
                     way_of(state.landing_rad)};
  const V step_m = landing.x_m * to.sine + landing.z_m * to.cosine,
          own_m = own_step_m<V>(tables, time.right, time.back);
  landing.off_ratio = change.starting != V{} ? change.off_ratio.x : V{};
  landing.ratio =
      (change.closing != V{} ? state.ratio_behind : V(size(step_m) / own_m)) + change.off_ratio.x;
  return landing;
}

// The step that is asked for: its length and the direction of its way, and where it is to point.
template <class V>
struct AskedStep {
  V length_m{};
  Way<V> along, to;
};

// Where it would land on level ground. An aim that is taken has no length that a slope shortens.
template <class V, class F>
AskedStep<V> plan_landing(const Tables& tables, const Time<V>& time, Change<V>& change,
                          State<V>& state, F& footing) noexcept {
  const auto closes = change.closing != V{};
  const V heading = heading_ahead(tables, state, V(time.to_strike + 1.0f));
  const Way<V> to = way_of(heading), along = way_of(V(kWayTurns * heading));
  const float left_m = tables.leg[0].track_m, right_m = tables.leg[1].track_m, grown = tables.size;
  const V steps_m = time.right ? state.length_m[1].x : state.length_m[0].x,
          ahead_m = time.back ? -steps_m : steps_m, length_m = closes ? V{} : ahead_m,
          lands_m = chosen<V>(time.right, right_m, left_m),
          stands_m = chosen<V>(time.right, left_m, right_m),
          outwards = chosen<V>(time.right, -1.0f, 1.0f);
  const V round = size(state.turn_goal_rad_s.x),
          in_place = 1.0f - smooth(V(size(length_m) * (1.0f / (kInPlace_m * grown))));
  const V arc_m = least(V(grown * kWider_s * round), all<V>(grown * kWidest_m)),
          place_m = most(V(grown * kStance_m - size(lands_m)), all<V>(grown * kLeastWider_m)) *
                    least(round, all<V>(1.0f)),
          wider_m = most(mix(arc_m, place_m, in_place), V{});
  // At rest both stand at hip width, wherever the foot that stands has landed.
  const V rests_m = chosen<V>(time.right, tables.leg[1].stance_m, tables.leg[0].stance_m),
          rested_m = chosen<V>(time.right, tables.leg[0].stance_m, tables.leg[1].stance_m),
          asides_m = closes ? rests_m : V(lands_m + outwards * wider_m),
          stood_m = closes ? rested_m : V(stands_m - outwards * state.wider_m),
          lead_m = in_place * tables.rest_lead_m;
  const V ahead_rad = state.turn_goal_rad_s.x * (state.roll_ticks + state.flight_ticks) *
                      tables.tick_s * kFootAhead;
  // A flight whose plan has changed on its way goes where the new one wants it at once.
  const V changed_u = most(V(change.gap_begin - kSettles), V{}),
          y = (time.u - kSettles - changed_u) * (1.0f / (kFreeze - kSettles));
  const auto follows = y <= V{}, open = y < all<V>(1.0f);
  const float settling = kSettling_s * tables.time_scale / tables.tick_s;
  const V share = 1.0f / (1.0f + settling * y * y / (1.0f - (open ? y : V{})));
  const auto keep = [&](const V& now, V& kept) {
    kept = follows ? now : open ? V(kept + (now - kept) * share) : kept;
  };
  V *kept_x_m = &state.landing_x_m, *kept_z_m = &state.landing_z_m;
  if constexpr (kIsUneven<F>) kept_x_m = &footing.level_x_m, kept_z_m = &footing.level_z_m;
  V x_m = along.sine * length_m + to.cosine * asides_m - stood_m - to.sine * lead_m,
    z_m = along.cosine * length_m - to.sine * asides_m + (1.0f - to.cosine) * lead_m,
    rad = heading + (closes ? V{} : V(in_place * ahead_rad));
  const auto aimed = change.is_aimed != V{};
  if (any(aimed)) {
    // It comes there evenly until it is settled.
    const auto begins = both(no(time.flies), state.tick == all<V>(1.0f));
    const V settled = (time.flies ? V{} : state.roll_ticks) +
                      chosen<V>(time.flies, kAimSettles, kSettles) * state.flight_ticks,
            left = most(V(settled - state.tick + 1.0f), all<V>(1.0f));
    const auto aim = [&](const V& at, V& kept, V& now) {
      const V from = begins ? now : kept;
      now = aimed ? V(from + (at - from) / left) : now;
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
