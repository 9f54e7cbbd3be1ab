// Plans how one walk comes to rest at any moment of a step, and how it goes on if the stick comes
// back. Both are rare, so the walks of a block are planned one after the other.
//
// A stop takes the first of three ends that brakes softly: the flying foot closes beside the
// standing foot; it lands ahead and the other foot closes; one more step comes between. The hips go
// to their place between the feet along a quintic, whose time is chosen for the least braking. On
// uneven ground the foothold is chosen anew and the flight is planned anew; if the new flight would
// not clear the ground, the landing stays.
#pragma once
#include <limits>

#include "walk/feet.h"
#include "walk/ground_plan.h"

namespace gaitpad {
namespace {

// Times are in seconds at the reference leg.
inline constexpr float kLeastStep = 0.25f;  // share of the foot's own step: shortest landing ahead
inline constexpr float kStays = 0.45f;      // share of a flight from which on its landing stays
// Later, until this share, it comes nearer by at most kNearer_m (at the reference leg): hips that
// brake lag behind it, and the leg, nearly straight, would pull them down.
// In a turn that would stretch the other leg.
inline constexpr float kNearUntil = 0.7f, kNearer_m = 0.05f, kStraight_rad = 0.02f;
inline constexpr float kBehind_m = 0.02f;  // a flying foot is at least so far behind its landing
inline constexpr float kLandsAhead =
    0.42f;  // of a step: least way of the hips to a foot that lands
inline constexpr float kLeastRest_s = 0.25f;  // shortest time in which hips come to rest
// Bounds of the last step: a roll or flight over the planned or the steady one.
inline constexpr float kMostClosing = 1.25f, kLongestClosingRoll = 1.6f;
inline constexpr float kLeastRollLeft_s = 0.05f;  // of a roll whose plan changes
// Costs when a time is chosen, in m/s^2 of braking: of a second, and of 1 m/s backwards.
inline constexpr float kLate = 0.8f, kBack = 50.0f;

// The hips are at least `way_m` from their place until `time_s`, when a foot lands ahead of them.
struct Behind {
  float time_s = 0.0f, way_m = 0.0f;
};

// The time in which hips come to rest most softly, neither beyond their place nor back, and not
// before their feet. `goes`, `aside`: place, rate and acceleration ahead and to the left, from
// their place at rest, per second. A turn on the spot (`on_spot`) has no direction to go beyond or
// back.
inline float best_rest_s(const Off<float>& goes, const Off<float>& aside, bool on_spot,
                         float least_s, float most_s, const Behind (&landings)[2],
                         float late = kLate) noexcept {
  constexpr int kTimes = 20, kPoints = 40;         // times that are tried; points of each quintic
  constexpr float kOver = 200.0f, kAhead = 40.0f;  // costs of a metre, in m/s^2
  float best_s = least_s, least = std::numeric_limits<float>::infinity();
  for (int k = 0; k < kTimes; ++k) {
    const float time_s = least_s + (most_s - least_s) * static_cast<float>(k) / (kTimes - 1.0f),
                point_s = time_s / static_cast<float>(kPoints);
    const auto of_point = [&](const Off<float>& of) {
      return Off<float>{of.x, of.v * point_s, of.a * point_s * point_s};
    };
    Off<float> off = of_point(goes), sways = of_point(aside);
    float brakes = 0.0f, over = 0.0f, back = 0.0f, ahead = 0.0f;
    for (int n = kPoints; n > 1; --n) {
      fade(static_cast<float>(n), off);
      fade(static_cast<float>(n), sways);
      brakes = most(brakes, root(off.a * off.a + sways.a * sways.a) / (point_s * point_s));
      over = most(over, most(off.x, goes.x - off.x));
      back = most(back, -off.v / point_s);
      const float now_s = static_cast<float>(kPoints - n + 1) * point_s;
      for (const Behind& landing : landings)
        if (now_s <= landing.time_s) ahead = most(ahead, off.x + landing.way_m);
    }
    if (on_spot) over = back = 0.0f;
    const float cost = brakes + kOver * over + kBack * back + late * time_s + kAhead * ahead;
    if (cost < least) best_s = time_s, least = cost;
  }
  return best_s;
}

// The flying foot by the plan in force, without its rise with the hips; pairs are now and a tick
// later.
struct Flown {
  Vec<float> heel_m[2];
  float pitch_rad[2], over_m[2];       // the latter: height of the heel above the ground line
  float line_m[2]{}, room_m[2]{};      // height of the ground line, and of what clears the ground
  float loose_rad = 0.0f;              // width in which the floor's bound on the pitch is rounded
  float yaw_rad, twist_rad, roll_rad;  // now
};
template <class F>
Flown flown(const Tables& tables, const Change<float>& change, const State<float>& state,
            F footing) noexcept {
  Flown flown;
  State<float> at = state;
  for (int k : {0, 1}) {
    const Time<float> time = time_of(tables, at);
    const Landing<float> landing =
        landing_over(tables, time, way_at_strike(tables, time, at), change, at, footing);
    const Stride<float> stride = read_by_clock(tables, time, landing, at.phase, time.share, time.u,
                                               Reads<float>{true, false}, change, at);
    Hips<float> hips;
    hips.behind = footprints_of(tables, time, at.ratio_behind);
    hips.ahead = footprints_of(tables, time, landing.ratio);
    hips.own = footprints_of(tables, time, short_ratio(tables, landing, change, at));
    float base_m = 0.0f;
    const Vec<float> heel_m = flight_heel(tables, time, landing, stride, hips, at.phase, time.u,
                                          change, at, footing, base_m);
    flown.heel_m[k] = with_gap(tables, time, landing, stride, heel_m, base_m, change, at, footing);
    flown.over_m[k] = flown.heel_m[k].y - base_m;
    if constexpr (kIsUneven<F>) {
      if (k == 1) follow_room(tables, footing);
      const Vec<float> room_m = room_at(time.u, at, footing);
      flown.heel_m[k] = flown.heel_m[k] + room_m;
      const float line_m = base_m + gap_left(time.u, footing.gap_line_m, change);
      flown.room_m[k] = room_m.y + gap_left(time.u, footing.gap_room_m, change);
      flown.line_m[k] = line_to_keep(line_m + flown.room_m[k], base_m + room_m.y, time.u, change) -
                        flown.room_m[k];
    }
    const float pitch_off_rad = pitch_off(time, at.tick, change, at);
    if (k == 0) {
      flown.yaw_rad = flying_yaw(time, landing, change, at);
      const float edge = edge_left(time.u, change);
      flown.twist_rad = stride.foot[0].twist_rad + edge * change.gap_twist_rad;
      flown.roll_rad = stride.foot[0].roll_rad + edge * change.gap_roll_rad;
      flown.loose_rad = loose_pitch(time.u, pitch_off_rad, change);
    }
    flown.pitch_rad[k] =
        low_pitch(low_lift<float>(time.right, at), time.u) * stride.foot[0].pitch_rad +
        pitch_off_rad;
    at.tick += 1.0f, at.phase += at.phase_rate;
  }
  return flown;
}

// Plans the landing of the running step again, by the parameters of now.
template <class F>
void plan_landing_anew(const Tables& tables, const Time<float>& time, Block<1>& block,
                       F& footing) noexcept {
  State<float>& state = block.state;
  Change<float>& change = block.change;
  const AskedStep<float> asked = plan_landing(tables, time, change, state, footing);
  if constexpr (kIsUneven<F>) {
    footing.asked_x_m = footing.level_x_m, footing.asked_z_m = footing.level_z_m;
    footing.asked_rad = state.landing_rad;
    choose_foothold(tables,
                    {asked.along.sine, asked.along.cosine, asked.length_m, false, true,
                     goes_on(tables, state, change)},
                    block);
    footing.step_m = asked.to.ahead(state.landing_x_m, state.landing_z_m);
    footing.step_ratio = ratio_of_step(tables, time, footing.step_m);
    footing.off_ratio = {};
  }
}

// Gives a flight that is to land on another tread the time that it needs to get there.
inline void take_time_for_rise(const Tables& tables, Block<1>& block) noexcept {
  State<float>& state = block.state;
  Change<float>& change = block.change;
  Block<1> there = block;
  const Time<float> time = time_of(tables, state);
  there.change.gap_begin = time.u;
  plan_landing_anew(tables, time, there, there.footing);
  const float rise_m = there.footing.landing_y_m - block.footing.landing_y_m,
              least_ticks = state.tick + ticks_of(flight_to_tread_s(tables, rise_m), tables.tick_s),
              more = most(least_ticks - state.flight_ticks, 0.0f);
  state.flight_ticks += more;
  if (change.stops == 0.0f) return;
  if (change.closing != 0.0f) {
    change.closing_ticks += more;
  } else {
    change.rest_ticks += more;
  }
}

// The shares that a plan sets, with their differences from it: of the tables that is shown, of the
// step's own stride, of the standing foot's pitch, and by which the flying foot's edges follow it.
struct Shares {
  float shown, over, pitch, edge;
};
inline Shares shares_of(const Tables& tables, const Change<float>& change,
                        const State<float>& state) noexcept {
  const Time<float> time = time_of(tables, state);
  return {planned_shown(time, change) + change.off_shown.x,
          planned_over(time, change) + change.off_over.x,
          planned_pitch(time, change) + change.off_pitch.x, edge_by_clock(time, change)};
}
// The same a tick later.
inline Shares next_shares(const Tables& tables, Change<float> change, State<float> state) noexcept {
  state.tick += 1.0f;
  fade_differences(time_of(tables, state), state, change);
  return shares_of(tables, change, state);
}

// Changes the plan of the running step: `work` sets the new one. Differences between both plans
// fade. If the landing `moves`, it is planned again, and a flying foot changes over to its new path
// until it lands.
template <class F, class Work>
void change_step(const Tables& tables, bool moves, Block<1>& block, F& footing,
                 const Work& work) noexcept {
  State<float>& state = block.state;
  Change<float>& change = block.change;
  const bool flies = state.flies != 0.0f;
  const auto ratio = [&] {
    const Time<float> time = time_of(tables, state);
    return landing_over(tables, time, way_at_strike(tables, time, state), change, state, footing)
        .ratio;
  };
  const Flown was = flies ? flown(tables, change, state, footing) : Flown{};
  const Time<float> time = time_of(tables, state);
  const Shares share_was = shares_of(tables, change, state),
               next_was = next_shares(tables, change, state);
  const float ratio_was = ratio(), flown_share = flight_share(time.u, change);
  if (change.led == 0.0f) {
    go_on_from_here(tables, true, state, change);
    if (change.was_led == 0.0f && change.off_ticks == 0.0f)
      change.phase = state.phase, change.phase_rate = state.phase_rate;
  }
  // A foot that rolls down goes on from its pitch, without the tables.
  if (!flies) {
    State<float> next = state;
    next.tick += 1.0f;
    const auto pitch = [&](const State<float>& at, const Shares& share, float phase) {
      float n[4];
      read_four(mix_of_strides(tables, time, state.ratio_behind, ratio_was, share.over, true),
                kPitchAt, phase, n);
      const float table_rad = share.shown * share.pitch * (time.right ? n[0] : n[1]);
      return table_rad + landed_pitch(change, at);
    };
    const float pitch_rad = pitch(state, share_was, change.phase),
                rate_rad = pitch(next, next_was, change.phase + change.phase_rate) - pitch_rad;
    roll_on(true, pitch_rad, rate_rad, change, state);
  }
  if (change.led == 0.0f && flies) change.led_from = least(-state.tick, -1.0f);
  Slope<float> lands{};
  if constexpr (kIsUneven<F>) lands = plane_in_flight(time, change, footing);
  work();
  if constexpr (kIsUneven<F>)
    if (moves && flies) take_time_for_rise(tables, block);
  change.led = change.is_new = 1.0f;
  change.off_ticks = floored(2.0f * kCarry_s * tables.time_scale / tables.tick_s + 0.5f);
  const Time<float> now = time_of(tables, state);
  for (Off<float>* off : {&change.off_shown, &change.off_over, &change.off_pitch, &change.off_edge})
    *off = {};
  const Shares share = shares_of(tables, change, state), next = next_shares(tables, change, state);
  const auto go_on = [&](float Shares::*of) {
    const float off = share_was.*of - share.*of;
    return Off<float>{off, next_was.*of - next.*of - off, 0.0f};
  };
  change.off_shown = go_on(&Shares::shown), change.off_over = go_on(&Shares::over);
  // Without its rate, with which it would go on beyond 0, where the foot lies flat.
  if (flies) change.off_pitch.x = share_was.pitch - share.pitch;
  if (flies) change.off_edge = go_on(&Shares::edge);
  if (!moves) return;
  change.limp = 0.0f;  // the hips choose the step's length, see plan_limp()
  if constexpr (kIsUneven<F>) footing.is_new = 1.0f;
  change.gap_begin = now.u, change.gap_share = flown_share;
  plan_landing_anew(tables, now, block, footing);
  change.off_ratio = {};
  // Without its rate: the hips' place at the strike is that of the ratio now, which would run
  // ahead.
  // A walk that turns back has its hips in time for their place in the other tables.
  if (change.turns == 0.0f) change.off_ratio.x = ratio_was - ratio();
  if (!flies) return;
  constexpr float kLow_m = 0.001f;  // least height that a difference is scaled by
  const float ticks = state.flight_ticks;
  change.gap_lasts = most(1.0f - change.gap_begin, 1.0f / ticks);
  change.pitch_begin = state.tick, change.pitch_lasts = change.gap_lasts * ticks;
  state.gap_m = state.gap_slope_m = {};
  change.gap_high_m = 1.0f;
  state.swing_pitch_rad = state.swing_pitch_rate = 0.0f;
  change.gap_rad = change.gap_twist_rad = change.gap_roll_rad = 0.0f;
  change.gap_loose_rad = was.loose_rad;
  // The foot keeps apart from the standing one by its direction.
  change.gap_rad = was.yaw_rad - flown(tables, change, state, footing).yaw_rad;
  const auto fit_gap = [&](const Flown& is) {
    state.gap_m = was.heel_m[0] - is.heel_m[0];
    state.gap_slope_m = ((was.heel_m[1] - is.heel_m[1]) - state.gap_m) * ticks;
  };
  if constexpr (kIsUneven<F>) {
    footing.gap_under_m = 0.0f, footing.gap_line_m = footing.gap_room_m = {};
    const float goes = 1.0f - value_left(now.u), goes_was = 1.0f - value_left(time.u);
    const auto left = [&](float was_x, float from, float to) {
      return from + (was_x - from) * (goes_was / most(goes, 1e-3f)) - to;
    };
    footing.gap_plane = {left(lands.x, footing.print.x, footing.landing.x),
                         left(lands.z, footing.print.z, footing.landing.z)};
    // How the new flight clears the ground is planned without the height of the old one.
    for (int k = 0; k < kRoomKnots; ++k) footing.raise[k] = footing.shift[k] = {};
    fit_gap(flown(tables, change, state, footing));
    state.gap_m.y = state.gap_slope_m.y = 0.0f;
    plan_room(tables, true, block);
    state.gap_m = state.gap_slope_m = {};
  }
  const Flown is = flown(tables, change, state, footing);
  fit_gap(is);
  change.gap_high_m = most(is.over_m[0], kLow_m * tables.size);
  if constexpr (kIsUneven<F>) {
    const auto gap = [&](const float(&from)[2], const float(&to)[2]) {
      const float gap_m = from[0] - to[0];
      return Gap<float>{gap_m, (from[1] - to[1] - gap_m) * ticks};
    };
    footing.gap_line_m = gap(was.line_m, is.line_m);
    footing.gap_room_m = gap(was.room_m, is.room_m);
    footing.gap_under_m = most(-state.gap_m.y - change.gap_high_m, 0.0f);
    state.gap_m.y += footing.gap_under_m;
  }
  if (state.gap_m.y < 0.0f)
    state.gap_slope_m.y -=
        state.gap_m.y * (is.over_m[1] - is.over_m[0]) / change.gap_high_m * ticks;
  change.gap_twist_rad = was.twist_rad - is.twist_rad;
  change.gap_roll_rad = was.roll_rad - is.roll_rad;
  state.swing_pitch_rad = was.pitch_rad[0] - is.pitch_rad[0];
  state.swing_pitch_rate = (was.pitch_rad[1] - is.pitch_rad[1]) - state.swing_pitch_rad;
}

// Where the tables have the hips at the lift-off that ends a roll: ahead of the footprint that the
// foot leaves, or of the standing foot.
inline float lift_off_m(const Tables& tables, const Time<float>& time, float ratio,
                        bool of_print) noexcept {
  const float phase = time.step_phase + roll_cycles<float>(tables, time.right);
  const FootprintsIn<float> prints = footprints_of(tables, time, ratio);
  const float foot_m =
      of_print ? prints.swing_m.z - (time.right ? 0.0f : prints.stride_m) : prints.stand_m.z;
  return prints.stride_m * phase - foot_m + read_pelvis(tables, time, phase, ratio).z;
}
// Ticks until hips that come to rest at `rest_m` ahead of the standing foot are at `place_m`.
inline float ticks_to_place(float place_m, float rest_m, const State<float>& state,
                            const Change<float>& change) noexcept {
  Off<float> off = change.pelvis_z_m;
  off.x -= rest_m;
  float ticks = 1.0f;
  for (; ticks < change.rest_ticks; ticks += 1.0f) {
    fade(change.rest_ticks + 1.0f - ticks, off);
    if ((rest_m + off.x - place_m) * (state.backward != 0.0f ? -1.0f : 1.0f) >= 0.0f) break;
  }
  return ticks;
}

// How far the hips may go ahead in a roll: from there on the leg behind would be straight.
inline float farthest_m(const Tables& tables, const State<float>& state) noexcept {
  constexpr float kWhole = 1.0f;  // ratio of the data's stride
  return state.print_z_m +
         lift_off_m(tables, time_of(tables, state), most(state.ratio_behind, kWhole), true);
}

// Times a roll in a stop, in ticks from now. It ends when the hips are as far ahead of the standing
// foot as in the tables, but the toe has time to come down. Only hips that would go too far end it
// sooner.
struct RollLeft {
  float least, lifts;
};
inline RollLeft roll_left(const Tables& tables, float rest_m, const State<float>& state,
                          const Change<float>& change) noexcept {
  constexpr float kEvenRoll_s = 0.11f;  // in which a toe comes down as softly as in a walk
  const float scale = tables.time_scale / tables.tick_s;
  const auto ticks_of_time = [&](float time_s) { return floored(time_s * scale + 0.5f); };
  const auto ticks_to = [&](float place_m) {
    return ticks_to_place(place_m, rest_m, state, change);
  };
  float even = least(ticks_of_time(kEvenRoll_s), state.roll_ticks) - state.tick;
  if (tables.terrain == nullptr) even = least(even, ticks_to(farthest_m(tables, state)));
  return {most(even, ticks_of_time(kLeastRollLeft_s)),
          ticks_to(lift_off_m(tables, time_of(tables, state), state.ratio_behind, false))};
}

// Sets the ticks of a roll and the flight after it.
inline void set_step_ticks(const Tables& tables, float roll, float flight,
                           State<float>& state) noexcept {
  const bool right = state.right_swings != 0.0f;
  state.roll_ticks = roll, state.flight_ticks = flight;
  state.end_rate = 0.5f * (roll_cycles<float>(tables, right) / roll +
                           flight_cycles<float>(tables, right) / flight);
}

// Times the last step in its roll: the foot lands when the hips rest, or later.
inline void time_closing_step(const Tables& tables, State<float>& state,
                              Change<float>& change) noexcept {
  constexpr float kLeastClosing_s = 0.30f;  // of the flight
  const float shortest = floored(
                  kLeastClosing_s * change.slowness * (tables.time_scale / tables.tick_s) + 0.5f),
              longest = most(shortest, floored(kMostClosing * state.flight_ticks));
  const RollLeft roll = roll_left(tables, tables.rest_lead_m, state, change);
  // The hips may come to rest before the foot lands.
  const float all_ticks = most(change.rest_ticks, shortest + roll.least),
              most_roll =
                  least(all_ticks - shortest, floored(kLongestClosingRoll * state.roll_ticks)),
              rolls = least(most(roll.lifts, roll.least), most(roll.least, most_roll)),
              flight = least(most(all_ticks - rolls, shortest), longest);
  set_step_ticks(tables, state.tick + rolls, flight, state);
  change.closing_ticks = rolls + flight;
  change.rest_ticks = least(change.rest_ticks, change.closing_ticks);
}

// Times the roll of a step between, where it begins: by its own time it would last longer than the
// hips, which are as fast as the walk was, take to the lift-off.
inline void time_step_between(const Tables& tables, State<float>& state,
                              const Change<float>& change) noexcept {
  const float length_m = change.length_m[state.right_swings != 0.0f ? 1 : 0],
              to_m = state.backward != 0.0f ? -length_m : length_m;
  const RollLeft roll = roll_left(tables, tables.rest_lead_m + to_m, state, change);
  const float rolls = least(most(roll.lifts, roll.least), state.roll_ticks);
  set_step_ticks(tables, rolls, state.flight_ticks + state.roll_ticks - rolls, state);
}

// Ends the roll of a slower step in time, where it begins: hips that are as fast as the walk was
// would go too far in it.
inline void time_slower_step(const Tables& tables, State<float>& state,
                             const Change<float>& change) noexcept {
  const float sign = state.backward != 0.0f ? -1.0f : 1.0f,
              way_m = sign * (farthest_m(tables, state) - change.pelvis_z_m.x),
              goes_m = sign * change.pelvis_z_m.v,
              shortest = floored(kLeastRollLeft_s * tables.time_scale / tables.tick_s + 0.5f);
  if (way_m >= goes_m * state.roll_ticks) return;
  const float rolls = least(most(floored(way_m / goes_m), shortest), state.roll_ticks);
  set_step_ticks(tables, rolls, state.flight_ticks + state.roll_ticks - rolls, state);
}

// The longest last step, in seconds, if its times were those of the running step.
inline float longest_closing_s(const Tables& tables, const State<float>& state) noexcept {
  return (kLongestClosingRoll * state.roll_ticks + kMostClosing * state.flight_ticks) *
         tables.tick_s;
}

// On uneven ground: length of the step, from foothold to foothold, if `asked_m` is asked for.
inline float foothold_m(const Tables& tables, float asked_m, Block<1> block) noexcept {
  State<float>& state = block.state;
  const Time<float> time = time_of(tables, state);
  state.length_m[time.right ? 1 : 0] = {asked_m, 0.0f};
  block.change.gap_begin = time.u;
  plan_landing_anew(tables, time, block, block.footing);
  return (time.back ? -1.0f : 1.0f) *
         way_of(state.landing_rad).ahead(state.landing_x_m, state.landing_z_m);
}

// Plans the stop of a walk. `may_move`: the landing of a flight may still move.
template <class F>
void plan_rest(const Tables& tables, bool may_move, Block<1>& block, F& footing) noexcept {
  State<float>& state = block.state;
  Change<float>& change = block.change;
  const bool flies = state.flies != 0.0f, right = state.right_swings != 0.0f;
  if (!flies && state.tick == 0.0f) return;  // the step's landing is planned in this tick
  // A quintic to rest brakes with at most about the factor kNeed times v^2 / way. The ends are
  // chosen for a soft braking, in a hurry for a harder one; above the hardest one, one more step
  // comes between.
  constexpr float kNeed = 0.72f;
  constexpr float kBrake_m_s2 = 3.0f, kMostBrake_m_s2 = 3.9f;
  // Of a walk that is to go the other way: to close at once. If it will turn back without standing:
  // to close after the landing, and the hardest one, with which it or one that is to turn on the
  // spot closes at once, too.
  constexpr float kHastyClose_m_s2 = 3.3f, kHastyBrake_m_s2 = 3.9f, kMostHasty_m_s2 = 4.7f;
  constexpr float kLateOnSpot = 4.0f;  // cost of a second, in m/s^2, before a turn on the spot
  // From the landing to the end of a closing step, and of a step between; the share of speed times
  // time that braking hips go in it.
  constexpr float kToClose_s = 0.40f, kNextStep_s = 0.35f, kWayWhileClosing = 0.44f;
  // Share of speed times time above which hips that have all that time would first get faster.
  constexpr float kWayInTime = 0.5f;
  constexpr float kSwings = 1.3f;  // greatest ratio of the hips' speed in a step to its mean
  // Of the mean speed: hips count as at most so fast, in a hurry and else.
  constexpr float kSlowsInHurry = 0.9f, kSlows = 1.06f;
  constexpr float kLurch = 1.35f;       // ratio of the speed of hips that lurch to the walk's mean
  constexpr float kFurtherStep = 0.3f;  // shortest step between, a share of the foot's own
  constexpr float kTurnsOnSpot = 0.1f;  // steps below this ratio are on the spot
  constexpr float kMostClosingOnSpot = 1.7f;
  constexpr float kAfterLanding_s = 0.15f;  // hips rest at least this long after the landing
  const float tick_s = tables.tick_s, scale = tables.time_scale;
  const Time<float> time = time_of(tables, state);
  const Way<float> way = way_of(state.landing_rad);
  const float sign = time.back ? -1.0f : 1.0f;
  const auto along = [&](float x, float z) { return sign * way.ahead(x, z); };
  const float planned = along(state.landing_x_m, state.landing_z_m),
              own_m = own_step_m<float>(tables, right, time.back);
  const bool on_spot = planned < kTurnsOnSpot * own_m;
  const float mean_m_s = 0.5f * (state.length_m[0].x + state.length_m[1].x) / state.step_time_s.x;
  Change<float> here = change;
  if (change.led == 0.0f) go_on_from_here(tables, true, state, here);
  Off<float>&x = here.pelvis_x_m, &z = here.pelvis_z_m;
  // Hips may swing back for a moment in a walk whose one foot stays. A plan that goes on from there
  // leads them away from their feet.
  if (change.led == 0.0f && !on_spot && along(x.v, z.v) < 0.0f) return;
  // The hips of a limp lurch: they are fast for a moment alone. A plan that goes on from there
  // leads them far beyond their feet. It waits for the end of a roll; in a flight they speed up no
  // more.
  if (change.led == 0.0f && !on_spot && along(x.v, z.v) > kLurch * tick_s * mean_m_s) {
    if (!flies) return;
    if (along(x.a, z.a) > 0.0f) x.a = z.a = 0.0f;
  }
  // Hips that are faster than the mean swing back by themselves; a plan must not lead them on.
  const bool leads_on = along(x.v, z.v) > tick_s * mean_m_s && along(x.a, z.a) > 0.0f;
  if (!on_spot && change.starting == 0.0f && leads_on) x.a = z.a = 0.0f;
  const float speed = along(x.v, z.v) / tick_s, bend = along(x.a, z.a) / (tick_s * tick_s),
              from = sign * tables.rest_lead_m - along(x.x, z.x), left_s = time.to_strike * tick_s,
              next_own_m = own_step_m<float>(tables, !right, time.back),
              foot_m = flies ? along(state.last_heel_m[0].x, state.last_heel_m[0].z)
                             : along(state.print_x_m, state.print_z_m);
  // By the walk's mean speed a stop has much the same way from any moment of a step, so a player
  // learns it. Hips of a walk that starts or changes its pace may be far from the mean.
  // One that is to go the other way is in a hurry: it brakes as hard as it may at that moment.
  const bool to_spot = is_asked_onto_spot(tables, state),
             hurries = state.asked.walks != 0.0f && !to_spot;
  // Hips that are fast about a strike slow down by themselves after it, which saves a step. The
  // steps are long enough for their own speed.
  const bool walks_evenly = change.led == 0.0f && change.starting == 0.0f && !on_spot;
  const float slows = hurries ? kSlowsInHurry : kSlows,
              fast_m_s = walks_evenly ? least(speed, slows * mean_m_s) : speed,
              need = kNeed * fast_m_s * fast_m_s, own_need = kNeed * speed * speed;
  const float pace = hurries ? fast_m_s : most(least(mean_m_s, kSwings * speed), speed / kSwings),
              paced_need = kNeed * pace * pace;
  const float most_closing = on_spot ? kMostClosingOnSpot : kMostClosing;
  const float longest_s = longest_closing_s(tables, state);
  // `aside_m`: place at which the hips are to rest, to the left of the standing foot.
  const auto to_rest = [&](float way_m, float aside_m, float least_s, float most_s,
                           const Behind(&landings)[2]) {
    const Off<float> aside{way.left(x.x, z.x) - aside_m, way.left(x.v, z.v) / tick_s,
                           way.left(x.a, z.a) / (tick_s * tick_s)};
    const float time_s =
        best_rest_s({-way_m, speed, bend}, aside, on_spot, least_s, most(least_s, most_s), landings,
                    to_spot ? kLateOnSpot : kLate);
    change.rest_ticks = ticks_of(time_s, tick_s);
    change.stops = 1.0f;
    change.pelvis_x_m = x, change.pelvis_z_m = z;
  };
  const bool turns = hurries && !kIsUneven<F> && !time.back;
  const bool is_hasty = turns || to_spot;
  const float close_m_s2 = is_hasty  ? kMostHasty_m_s2
                           : hurries ? kHastyClose_m_s2
                                     : kBrake_m_s2,
              brake_m_s2 = turns ? kHastyBrake_m_s2 : kBrake_m_s2,
              most_m_s2 = is_hasty ? kMostHasty_m_s2 : kMostBrake_m_s2;
  const bool may_close = (from >= need / close_m_s2 && foot_m < -kBehind_m) || on_spot;
  const bool moves = !flies || (may_move && time.u < kStays);
  if (may_close && change.starting == 0.0f && moves) {
    change_step(tables, true, block, footing, [&] {
      const Behind none[2] = {};
      to_rest(most(from, 0.0f), -tables.leg[right ? 0 : 1].stance_m, kLeastRest_s * scale,
              flies ? left_s + (most_closing - 1.0f) * state.flight_ticks * tick_s : longest_s,
              none);
      change.closing = 1.0f;
      if (flies) {
        state.flight_ticks = most(state.flight_ticks, state.tick + change.rest_ticks);
        change.closing_ticks = state.flight_ticks - state.tick;
      } else {
        time_closing_step(tables, state, change);
      }
    });
    return;
  }
  const float least_m = most(kLeastStep * own_m, foot_m + kBehind_m);
  const auto wanted = [&](float time_s) {
    const float longest = left_s + longest_s + (time_s > kToClose_s ? kNextStep_s * scale : 0.0f),
                brakes_m = most(least(paced_need / brake_m_s2, kWayInTime * pace * longest),
                                own_need / most_m_s2);
    return most(brakes_m, kWayWhileClosing * pace * (left_s + time_s * scale)) - from;
  };
  float step_m = planned, further_m = 0.0f;
  const bool nears = !kIsUneven<F> && !hurries && !moves && may_move && change.starting == 0.0f &&
                     time.u < kNearUntil && !on_spot && size(state.landing_rad) < kStraight_rad;
  const float nearest_m = nears ? most(least_m, planned - kNearer_m * tables.size) : least_m;
  if (moves || nears) step_m = least(most(wanted(kToClose_s), least(nearest_m, planned)), planned);
  float asked_m = step_m, share = 1.0f;
  if constexpr (kIsUneven<F>) {
    share = footing.share;
    // A landing that stays is asked for as before: its foothold is not where it was asked for.
    asked_m = moves ? step_m / share : state.length_m[right ? 1 : 0].x;
    if (moves) step_m = foothold_m(tables, asked_m, block);
  }
  // A landing turned aside, or beside a riser, may be behind the other foot: that is no step's
  // length.
  const bool keeps = on_spot && (!kIsUneven<F> || planned < 0.0f);
  if (!keeps && from + step_m < need / most_m_s2)
    further_m = least(most(wanted(kToClose_s + kNextStep_s) - step_m, kFurtherStep * next_own_m),
                      next_own_m);
  const float step_s = (state.roll_ticks + state.flight_ticks) * tick_s,
              between_s = further_m > 0.0f ? step_s : 0.0f;
  const float lead_m = sign * tables.rest_lead_m;
  const Behind landings[2] = {{left_s, kLandsAhead * step_m + lead_m + further_m},
                              {left_s + between_s, kLandsAhead * further_m + lead_m}};
  change_step(tables, moves || nears, block, footing, [&] {
    to_rest(from + step_m + further_m,
            way.left(state.landing_x_m, state.landing_z_m) - tables.leg[right ? 1 : 0].stance_m,
            left_s + between_s + kAfterLanding_s * scale, left_s + between_s + longest_s, landings);
    change.further = further_m > 0.0f ? 1.0f : 0.0f;
    if (keeps) return;
    const int swing = right ? 1 : 0;
    change.length_m[swing] = asked_m;
    change.length_m[1 - swing] = further_m / share;
    // In the roll of a first step the length stays smoothed, so that the foot's rise follows it.
    if (flies || change.starting == 0.0f) state.length_m[swing] = {asked_m, 0.0f};
    if (further_m > 0.0f) state.length_m[1 - swing] = {further_m / share, 0.0f};
  });
}

// The ticks in which hips that have braked come most softly to their place in the tables: at the
// coming strike or later.
template <class F>
float catch_ticks(const Tables& tables, const State<float>& state, const Change<float>& change,
                  const F& footing) noexcept {
  constexpr int kTimes = 12;            // that are tried
  constexpr float kMostCatch_s = 0.8f;  // longest of them
  const Time<float> time = time_of(tables, state);
  const float tick_s = tables.tick_s, share = flight_cycles<float>(tables, time.right),
              strike_phase = time.stage_end + (time.flies ? 0.0f : share),
              rate = share / state.flight_ticks, aim = aim_ticks(tables), left = time.to_strike;
  const Landing<float> landing =
      landing_over(tables, time, way_at_strike(tables, time, state), change, state, footing);
  const Path<float> path =
      path_to(landing, footprints_of(tables, time, landing.ratio), time.right ? 1.0f : 0.0f);
  Vec<float> places_m[3];
  for (int k : {0, 1, 2}) {
    const float at = strike_phase + static_cast<float>(k - 1) * aim * rate;
    const Vec<float> off_m = landing.way * read_pelvis(tables, time, at, landing.ratio);
    places_m[k] = {path.x_m + path.per_cycle_x_m * at + off_m.x, 0.0f,
                   path.z_m + path.per_cycle_z_m * at + off_m.z};
  }
  // Ahead and to the left: the hips' place there, which moves on, and their difference from it.
  struct Goal {
    Off<float> there, off;
  };
  const auto goal = [&](const auto& along) {
    float m[3];
    for (int k : {0, 1, 2}) m[k] = along(places_m[k].x, places_m[k].z);
    const Off<float> there = middle_of(m, aim);
    const Off<float>&x = change.pelvis_x_m, &z = change.pelvis_z_m;
    return Goal{there,
                {along(x.x, z.x) - there.x + left * (there.v - 0.5f * left * there.a),
                 along(x.v, z.v) - there.v + there.a * left, along(x.a, z.a) - there.a}};
  };
  const float sign = time.back ? -1.0f : 1.0f;
  const Goal ahead = goal([&](float x, float z) { return sign * landing.way.ahead(x, z); }),
             aside = goal([&](float x, float z) { return landing.way.left(x, z); });
  const float longest = most(left, ticks_of(kMostCatch_s * tables.time_scale, tick_s));
  float best = left, least_cost = std::numeric_limits<float>::infinity();
  for (int k = 0; k < kTimes; ++k) {
    const float all = floored(left + (longest - left) * static_cast<float>(k) / (kTimes - 1.0f));
    Off<float> goes = ahead.off, sways = aside.off;
    float pushes = 0.0f, back = 0.0f;
    for (float n = all; n > 1.0f; n -= 1.0f) {
      fade(n, goes), fade(n, sways);
      const float bends = goes.a + ahead.there.a, sways_by = sways.a + aside.there.a;
      pushes = most(pushes, root(bends * bends + sways_by * sways_by));
      back = most(back, -(goes.v + ahead.there.v - ahead.there.a * (left - (all - n) - 1.0f)));
    }
    const float cost = pushes / (tick_s * tick_s) + kBack * back / tick_s + kLate * all * tick_s;
    if (cost < least_cost) best = all, least_cost = cost;
  }
  return best;
}

// Plans how a walk that comes to rest goes on, because the stick has come back.
template <class F>
void walk_on(const Tables& tables, bool may_move, Block<1>& block, F& footing) noexcept {
  State<float>& state = block.state;
  Change<float>& change = block.change;
  const bool flies = state.flies != 0.0f, closes = change.closing != 0.0f,
             right = state.right_swings != 0.0f;
  constexpr float kNearStrike_s = 0.15f;
  if (!flies && state.tick == 0.0f) return;
  const Time<float> time = time_of(tables, state);
  if (closes && flies && (time.u > kStays || !may_move)) return;
  // Hips that have braked cannot reach their place in the tables before a strike that is near.
  if (flies && time.to_strike * tables.tick_s < kNearStrike_s * tables.time_scale) return;
  // The step becomes so long that hips that have braked reach their place at its strike.
  const int swing = right ? 1 : 0;
  float share = 1.0f;  // of the length that the ground leaves
  if constexpr (kIsUneven<F>) share = footing.share;
  const float asked_m = share * state.asked.length_m[swing], tick_s = tables.tick_s;
  const Stages<float> own = stages_of(tables, change, state, right);
  const Way<float> way = way_of(state.landing_rad);
  const float sign = time.back ? -1.0f : 1.0f;
  const auto along = [&](float x, float z) { return sign * way.ahead(x, z); };
  const bool moves = !flies || (may_move && (closes || time.u < kStays));
  const float at_m = along(change.pelvis_x_m.x, change.pelvis_z_m.x),
              speed = along(change.pelvis_x_m.v, change.pelvis_z_m.v) / tick_s,
              foot_m = flies ? along(state.last_heel_m[0].x, state.last_heel_m[0].z) : 0.0f;
  change_step(tables, moves, block, footing, [&] {
    if (closes) {
      constexpr float kFlightLeft = 0.45f;  // least part of a steady flight that is still to come
      const float least_left = floored(kLeastRollLeft_s * tables.time_scale / tick_s + 0.5f);
      if (!flies)
        state.roll_ticks = least(most(state.tick + least_left, ticks_of(own.roll_s, tick_s)),
                                 state.roll_ticks + least_left);
      const float flight = ticks_of(own.flight_s, tick_s);
      state.flight_ticks = most(state.tick + floored(kFlightLeft * flight), flight);
      // The phase's rate at the end of a flight is as in begin_flight(), not that of the last step.
      const Stages<float> next = stages_of(tables, change, state, !right);
      state.end_rate = 0.5f * (own.flight / state.flight_ticks +
                               (flies ? next.roll / ticks_of(next.roll_s, tick_s)
                                      : own.roll / state.roll_ticks));
    }
    if (change.stops == 0.0f && flies && moves) {
      constexpr float kLeaves_s = 0.3f;  // to leave the spot softly
      state.flight_ticks =
          most(state.flight_ticks, state.tick + floored(kLeaves_s * tables.time_scale / tick_s));
      state.end_rate = 0.5f * (own.flight / state.flight_ticks + own.roll / state.roll_ticks);
    }
    const float left_s = time_of(tables, state).to_strike * tick_s,
                goes = 0.5f * left_s / (own.roll_s + own.flight_s),
                reach_m = (at_m + 0.5f * speed * left_s) / most(1.0f - kLandsAhead - goes, 0.05f);
    const float shortest_m =
        least(most(kLeastStep * own_step_m<float>(tables, right, time.back), foot_m + kBehind_m),
              asked_m);
    if (moves) state.length_m[swing] = {least(most(reach_m, shortest_m), asked_m) / share, 0.0f};
    change.length_m[swing] = state.length_m[swing].x;
    change.stops = change.closing = change.further = 0.0f;
    change.resumes = 1.0f;
  });
  change.catch_ticks = catch_ticks(tables, state, change, footing);
}

// Times the hips' rest again at the last step's beginning, because on uneven ground its foothold
// may differ from the plan.
inline void time_rest(const Tables& tables, const State<float>& state,
                      Change<float>& change) noexcept {
  const float tick_s = tables.tick_s, sign = state.backward != 0.0f ? -1.0f : 1.0f,
              stands_m = tables.leg[state.right_swings != 0.0f ? 0 : 1].stance_m;
  const auto of_time = [&](const Off<float>& of, float goal_m, float to) {
    return Off<float>{to * (of.x - goal_m), to * of.v / tick_s, to * of.a / (tick_s * tick_s)};
  };
  const Behind none[2] = {};
  const float least_s = kLeastRest_s * tables.time_scale;
  change.rest_ticks =
      ticks_of(best_rest_s(of_time(change.pelvis_z_m, tables.rest_lead_m, sign),
                           of_time(change.pelvis_x_m, -stands_m, 1.0f), false, least_s,
                           most(least_s, longest_closing_s(tables, state)), none),
               tick_s);
}

}  // namespace
}  // namespace gaitpad
