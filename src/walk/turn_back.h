// Plans how a walk that comes to rest goes the other way without standing first. The foot of its
// last step closes beside the other one; early in that flight it gets a landing behind it, which is
// the first one of the new walk. The hips go on from their place and speed along one quintic to
// their place in the tables of the new direction at that landing, and turn round on their way. A
// stride that is run back has the same poses, so the phase runs back from the one that is shown.
// What the tables of both directions differ by fades.
#pragma once
#include "walk/rest.h"

namespace gaitpad {
namespace {

// True early in the last flight of a walk ahead that is asked to go back. A first step ahead is too
// long for that: its hips would sink by up to 9 cm.
template <class V>
Mask<V> is_to_turn_back(const State<V>& state, const Change<V>& change) noexcept {
  const Asked<V>& asked = state.asked;
  const auto other = both(asked.walks != V{}, both(asked.backward != V{}, state.backward == V{})),
             goes = most(asked.length_m[0], asked.length_m[1]) > V{},
             flies = both(state.flies != V{}, both(state.tick >= all<V>(2.0f),
                                                   state.tick < kStays * state.flight_ticks)),
             is_new = either(change.is_new != V{}, change.was_new != V{});
  return both(both(both(other, goes), both(flies, no(is_new))),
              both(change.closing != V{}, change.is_aimed == V{}));
}

// The stride that is shown at a phase, by the plan in force.
inline Stride<float> shown_stride(const Tables& tables, const Change<float>& change,
                                  const State<float>& state, const Shares& share,
                                  float phase) noexcept {
  const Time<float> time = time_of(tables, state);
  const Landing<float> landing =
      planned_landing(tables, time, way_at_strike(tables, time, state), change, state);
  const StrideMix<float> mix =
      mix_of_strides(tables, time, state.ratio_behind, landing.ratio, share.over, true);
  Stride<float> stride = read_stride(mix, time, phase);
  show(share.shown, stride);
  round_lift_off(tables, time, phase, mix, state, change, stride);
  return stride;
}

inline constexpr float kMostTurn_m_s2 = 5.4f;  // of hips that turn round

// Times the landing of the first step the other way: soon, but so that the hips turn round softly.
// Returns their hardest acceleration, in m/s^2; it is above kMostTurn_m_s2 if no time is soft
// enough.
inline float time_turning_step(const Tables& tables, State<float>& state,
                               const Change<float>& change) noexcept {
  constexpr float kLeastLeft_s = 0.34f, kMostLeft_s = 0.7f;  // of the flight
  // Costs in m/s^2: of a second, and of 1 m/s^2 above the bound.
  constexpr float kLateTurn = 9.0f, kTooHard = 1000.0f;
  constexpr int kTimes = 16, kPoints = 32;  // times that are tried; points of each quintic
  const float tick_s = tables.tick_s, scale = tables.time_scale;
  const bool right = state.right_swings != 0.0f;
  const Stages<float> next = stages_of(tables, change, state, !right);
  const float next_rate = next.roll / ticks_of(next.roll_s, tick_s), begun = state.tick;
  float best = 0.0f, best_rate = 0.0f, hardest = 0.0f,
        least_cost = std::numeric_limits<float>::infinity();
  for (int k = 0; k < kTimes; ++k) {
    const float share = static_cast<float>(k) / (kTimes - 1.0f),
                ticks = ticks_of(scale * mix(kLeastLeft_s, kMostLeft_s, share), tick_s);
    state.flight_ticks = begun + ticks;
    const Time<float> time = time_of(tables, state);
    const Landing<float> landing =
        planned_landing(tables, time, way_at_strike(tables, time, state), change, state);
    const Path<float> path =
        path_to(landing, footprints_of(tables, time, landing.ratio), right ? 1.0f : 0.0f);
    const float rate = 0.5f * ((time.stage_end - state.phase) / ticks + next_rate),
                aim = aim_ticks(tables), sign = time.back ? -1.0f : 1.0f;
    const auto along = [&](float x, float z) { return sign * landing.way.ahead(x, z); };
    float m[3];
    for (int i : {0, 1, 2}) {
      const float at = time.stage_end + static_cast<float>(i - 1) * aim * rate;
      m[i] = along(path.x_m + path.per_cycle_x_m * at, path.z_m + path.per_cycle_z_m * at) +
             sign * read_pelvis(tables, time, at, landing.ratio).z;
    }
    const Off<float> there = middle_of(m, aim), &x = change.pelvis_x_m, &z = change.pelvis_z_m;
    const float point = ticks / static_cast<float>(kPoints);  // ticks
    Off<float> off{along(x.x, z.x) - (there.x - ticks * (there.v - 0.5f * ticks * there.a)),
                   (along(x.v, z.v) - (there.v - there.a * ticks)) * point,
                   (along(x.a, z.a) - there.a) * point * point};
    float most_a = 0.0f;
    for (int n = kPoints; n > 1; --n) {
      fade(static_cast<float>(n), off);
      most_a = most(most_a, size(off.a / (point * point) + there.a));
    }
    most_a = most_a / (tick_s * tick_s);
    const float cost =
        most_a + kLateTurn * ticks * tick_s + kTooHard * most(most_a - kMostTurn_m_s2, 0.0f);
    if (cost < least_cost) best = ticks, best_rate = rate, hardest = most_a, least_cost = cost;
  }
  state.flight_ticks = begun + best;
  state.step_s = (state.roll_ticks + state.flight_ticks) * tick_s;
  state.end_rate = best_rate;
  return hardest;
}

// Turns a walk back in its last flight, if that is soft enough. It mostly is in the first tick.
// Hips that are still too fast may turn in a later one: without that two rough captures take 0.1 s
// more.
inline void turn_back(const Tables& tables, Block<1>& block) noexcept {
  const Block<1> before = block;
  State<float>& state = block.state;
  Change<float>& change = block.change;
  NoFooting level;
  const bool right = state.right_swings != 0.0f;
  const int swing = right ? 1 : 0;
  State<float> next = state;
  next.tick += 1.0f;
  const Shares shares[2] = {shares_of(tables, change, state), next_shares(tables, change, state)};
  // The stride that is shown now and a tick later.
  const auto shown = [&](int k) {
    return shown_stride(tables, change, k == 0 ? state : next, shares[k],
                        change.phase + static_cast<float>(k) * change.phase_rate);
  };
  Stride<float> was[2] = {shown(0), shown(1)};
  float hardest = 0.0f;
  change_step(tables, true, block, level, [&] {
    state.backward = state.asked.backward;
    change.stops = change.closing = change.further = change.resumes = change.catch_ticks = 0.0f;
    change.starting = change.turns = 1.0f;
    const auto& share = tables.stage_share;
    change.phase = share[0] + share[1] + share[2] - change.phase;
    change.phase_rate = -change.phase_rate;
    const Time<float> time = time_of(tables, state);
    const float length_m = kFirstStep * state.asked.length_m[swing];
    change.length_m[swing] = length_m, change.length_m[1 - swing] = state.asked.length_m[1 - swing];
    state.length_m[swing] = {length_m, 0.0f};
    state.length_m[1 - swing] = {change.length_m[1 - swing], 0.0f};
    change.gap_begin = time.u;  // from here the landing may move again
    plan_landing_anew(tables, time, block, level);
    // The steps' time is smoothed: the arms swing by it. The next step is timed without that.
    const Smoothed<float> smoothed_s = state.step_time_s;
    state.step_time_s = {0.5f * (state.asked.time_s[0] + state.asked.time_s[1]), 0.0f};
    hardest = time_turning_step(tables, state, change);
    state.step_time_s = smoothed_s;
  });
  if (hardest > kMostTurn_m_s2) {
    block = before;
    return;
  }
  next = state;
  next.tick += 1.0f;
  Stride<float> is[2] = {shown(0), shown(1)};
  std::array<float*, kTurnedNumbers> from[2] = {turned_numbers(was[0]), turned_numbers(was[1])},
                                     to[2] = {turned_numbers(is[0]), turned_numbers(is[1])};
  for (int k = 0; k < kTurnedNumbers; ++k) {
    const float off = *from[0][k] - *to[0][k];
    change.off_turned[k] = {off, *from[1][k] - *to[1][k] - off, 0.0f};
  }
  if (change.by_paper == 0.0f) {
    for (int k : {0, 1}) {
      for (int j = 0; j < kLegAngles; ++j) {
        if (j == 3) continue;
        const float off = was[0].leg_rad[k][j] - is[0].leg_rad[k][j],
                    rate = was[1].leg_rad[k][j] - is[1].leg_rad[k][j] - off;
        state.leg_rad[k][j] += off;
        state.last_leg_rad[k][j] += off - rate;
      }
    }
  }
}

}  // namespace
}  // namespace gaitpad
