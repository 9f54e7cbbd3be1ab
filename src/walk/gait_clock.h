// First part of a tick: smooths the parameters that are asked for and moves the clock of the step.
#pragma once
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {
namespace {

// Place of a tick in its step.
template <class V>
struct Time {
  Mask<V> right, flies, back;   // the right foot swings; it has lifted off; steps lead backward
  V u{};                        // share of the flight that is over, 0 in the roll
  V share{};                    // share of the step that is over
  V to_strike{};                // ticks
  V step_phase{}, stage_end{};  // phases at which the step began and this roll or flight ends
};

template <class V>
V by_side(const Mask<V>& right, const V (&of)[2]) noexcept {
  return right ? of[1] : of[0];
}
template <class V>
Vec<V> by_side(const Mask<V>& right, const std::array<float, 3>& left_of,
               const std::array<float, 3>& right_of) noexcept {
  if constexpr (kLanes<V> == 1) {
    const std::array<float, 3>& of = right ? right_of : left_of;
    return {of[0], of[1], of[2]};
  }
  return {chosen<V>(right, right_of[0], left_of[0]), chosen<V>(right, right_of[1], left_of[1]),
          chosen<V>(right, right_of[2], left_of[2])};
}

// A number of the right or the left leg, and an angle of its standing pose.
template <class V>
V of_leg(const Tables& tables, const Mask<V>& right, float LegBones::*number) noexcept {
  if constexpr (kLanes<V> == 1) return tables.leg[right ? 1 : 0].*number;
  return chosen<V>(right, tables.leg[1].*number, tables.leg[0].*number);
}
template <class V>
V stand_rad(const Tables& tables, const Mask<V>& right, int angle) noexcept {
  if constexpr (kLanes<V> == 1) return tables.leg[right ? 1 : 0].stand_rad[angle];
  return chosen<V>(right, tables.leg[1].stand_rad[angle], tables.leg[0].stand_rad[angle]);
}
// Whether foot k, 0 for swing and 1 for stand, is the right one.
template <class V>
Mask<V> is_right(const Time<V>& time, int k) noexcept {
  return k == 0 ? time.right : no(time.right);
}

// The style's factor on the height of the flight.
template <class V>
V lift_of(const Mask<V>& right, const State<V>& state) noexcept {
  return right ? state.lift[1].x : state.lift[0].x;
}
// The same, but at most 1: a lame foot stays low.
template <class V>
V low_lift(const Mask<V>& right, const State<V>& state) noexcept {
  return least(lift_of<V>(right, state), all<V>(1.0f));
}
template <class V>
void follow(const V& goal, const V& pull, const V& keep, float tick_s,
            Smoothed<V>& value) noexcept {
  value.v = (value.v + (goal - value.x) * pull) * keep;
  value.v = size(value.v) < all<V>(1e-30f) ? V{} : value.v;  // flush denormals, which are slow
  value.x = value.x + value.v * tick_s;
}
template <class V>
void follow(const V& goal, const Filter& filter, Smoothed<V>& value) noexcept {
  follow(goal, all<V>(filter.pull), all<V>(filter.keep), filter.tick_s, value);
}
// Where `quick`, with the quicker filter.
template <class V>
void follow(const V& goal, const Mask<V>& quick, const Filter& quicker, const Filter& filter,
            Smoothed<V>& value) noexcept {
  follow(goal, chosen<V>(quick, quicker.pull, filter.pull),
         chosen<V>(quick, quicker.keep, filter.keep), filter.tick_s, value);
}
// The same for a turn. A filter alone never reaches 0: below `least` of a goal of 0 the value is 0.
template <class V>
void follow_turn(const V& goal, float least, const Filter& filter, Smoothed<V>& value) noexcept {
  follow(goal, filter, value);
  const auto ends = both(goal == V{}, size(value.x) < all<V>(least));
  value.x = ends ? V{} : value.x;
  value.v = ends ? V{} : value.v;
}

// Step length of the swing foot in the data. Run backwards, the data give a foot the step that the
// other foot makes forwards.
template <class V>
V own_step_m(const Tables& tables, const Mask<V>& right, const Mask<V>& back) noexcept {
  return of_leg<V>(tables, right != back, &LegBones::own_step_m);
}
// The longer of both steps over the data's: a limp does not change the time of the other foot.
template <class V>
V longer_ratio(const Tables& tables, const V (&length_m)[2], const V& backward) noexcept {
  const auto back = backward != V{}, left = V{} != V{};
  return most(V(length_m[0] / own_step_m<V>(tables, left, back)),
              V(length_m[1] / own_step_m<V>(tables, no(left), back)));
}
template <class V>
V asked_ratio(const Tables& tables, const State<V>& state) noexcept {
  return longer_ratio(tables, state.asked.length_m, state.backward);
}
// The ratio asked for, with the difference that an arc makes to the step of the swing foot, whose
// own is `ratio`, unless the hips lead.
template <class V>
V ratio_on_arc(const Tables& tables, const Time<V>& time, const V& ratio, const Change<V>& change,
               const State<V>& state) noexcept {
  constexpr float kMostOnArc = 0.06f;  // a greater one comes from a change of plan
  const V asked = asked_ratio(tables, state),
          length_m = time.right ? state.length_m[1].x : state.length_m[0].x,
          more = ratio - length_m / own_step_m<V>(tables, time.right, time.back);
  return change.led != V{} ? asked : V(asked + within(more, -kMostOnArc, kMostOnArc));
}
// Ratio to the data's stride: shorter steps are those of a turn on the spot.
inline constexpr float kTiny = 0.2f;
// True if a turn on the spot is asked for. On level ground one with tiny steps counts, too: where a
// stick points, the turn itself leads from one to the other.
template <class V>
Mask<V> is_asked_onto_spot(const Tables& tables, const State<V>& state) noexcept {
  constexpr float kTurns_rad_s = 0.5f;  // a stick that is let go asks for tiny steps, too
  const Asked<V>& asked = state.asked;
  auto stays = both(asked.length_m[0] == V{}, asked.length_m[1] == V{});
  const auto turns = size(asked.turn_rad_s) > all<V>(kTurns_rad_s);
  if (tables.terrain == nullptr && any(turns))
    stays = either(stays, both(turns, asked_ratio(tables, state) < all<V>(kTiny)));
  return both(asked.walks != V{}, stays);
}
// True if the walk is to go on. To walk the other way it first comes to rest; on level ground to
// turn on the spot, too. Elsewhere such stops stretched legs, by up to 2.6 degrees a tick^2.
template <class V>
Mask<V> is_to_walk(const Tables& tables, const State<V>& state, const Change<V>& change) noexcept {
  const Asked<V>& asked = state.asked;
  const auto onto_spot = is_asked_onto_spot(tables, state),
             same_way = both(asked.walks != V{}, asked.backward == state.backward);
  if (!any(onto_spot)) return same_way;
  if (tables.terrain != nullptr) return either(onto_spot, same_way);
  const auto may_turn = either(
      change.stands != V{}, longer_ratio(tables, change.length_m, state.backward) < all<V>(kTiny));
  return onto_spot ? may_turn : same_way;
}
// A landing follows the parameters at once until kSettles of the flight, then ever more slowly, and
// from kFreeze on it stays. If it stopped at once, the flying foot would jerk.
inline constexpr float kSettles = 0.25f, kFreeze = 0.6f;
// How far a landing has settled at the share `u` of its flight: it follows up to 0 and stays from 1
// on. If the plan changes during the flight, the landing follows the new plan at once.
template <class V>
V settled(const V& u, const Change<V>& change) noexcept {
  const V changed_u = most(V(change.gap_begin - kSettles), V{});
  return (u - kSettles - changed_u) * (1.0f / (kFreeze - kSettles));
}
// True where the last foot of a stop for a turn on the spot flies: the turn begins. Its landing
// turns with the body.
template <class V>
Mask<V> may_turn_early(const Tables& tables, const State<V>& state,
                       const Change<V>& change) noexcept {
  // Longest time before the strike, at the reference leg. Earlier, a slow last step would turn so
  // far that the hips of the next one went by 11 m/s^2.
  constexpr float kTurnsBefore_s = 0.55f;
  const auto closes = both(state.flies != V{}, change.closing != V{});
  if (!any(closes)) return closes;
  const V left_s = (state.flight_ticks - state.tick) * tables.tick_s;
  const auto lands = left_s <= all<V>(kTurnsBefore_s * tables.time_scale);
  return both(is_asked_onto_spot(tables, state), both(closes, lands));
}
// The turn rate that head and chest follow, in rad/s: in a stop for a turn on the spot already that
// turn's.
template <class V>
V looked_turn(const Tables& tables, const State<V>& state) noexcept {
  const Asked<V>& asked = state.asked;
  const auto turns = either(asked.backward == state.backward, is_asked_onto_spot(tables, state));
  return both(asked.walks != V{}, turns) ? asked.turn_rad_s : V{};
}

// People turn their heads up to 0.3 s before their pelvis, and the chest in between.
inline constexpr float kChestAhead_s = 0.13f, kHeadAhead_s = 0.30f;
inline constexpr float kGravity_m_s2 = 9.81f;  // standard gravity, rounded
inline constexpr float kLeastCycle_s =
    0.2f;  // of both steps: a time of 0 would be an endless speed

// A tick turns by multiples of 2^-24 rad, and a strike turns the step frame by multiples of 2^-21.
inline constexpr float kTurned_rad = 5.9604645e-8f, kFrameTurned_rad = 8.0f * kTurned_rad;

inline constexpr float kStill_rad = 1e-7f;    // a turn too small to see
inline constexpr float kFirstStep = 0.88f;    // of the length asked for: a first step is shorter
inline constexpr float kLonger_ticks = 2.0f;  // most by which a tick lengthens a planned flight

// `left`: share of the lengths asked for that uneven ground leaves.
template <class V>
void smooth_asked(const Tables& tables, const Change<V>& change, const V& left,
                  State<V>& state) noexcept {
  constexpr float kStraight_rad_s = 1e-5f;  // too small to see
  const Asked<V>& asked = state.asked;
  const auto walks = is_to_walk(tables, state, change),
             rests = either(change.stands != V{}, change.closing != V{});
  for (int side : {0, 1}) {
    // A first step follows a stick that is still on its way, so its filter is quicker.
    const auto starts = change.starting != V{},
               steps = both(starts, state.right_swings == all<V>(static_cast<float>(side)));
    const auto stops = change.stops != V{}, turns = change.turns != V{},
               is_quick = either(starts, stops),
               goes_on = both(change.catch_ticks != V{},
                              state.right_swings == all<V>(static_cast<float>(side)));
    const V kept_m = rests ? V{} : state.length_m[side].x,
            asked_m = walks ? asked.length_m[side] : kept_m,
            goal_m = either(either(stops, turns), goes_on) ? change.length_m[side] : asked_m;
    follow(both(steps, no(either(stops, turns))) ? V(kFirstStep * goal_m) : goal_m, is_quick,
           tables.first_step, tables.step, state.length_m[side]);
    follow(asked.lift[side], tables.step, state.lift[side]);
  }
  const V cycle_s = asked.time_s[0] + asked.time_s[1];
  follow(walks ? V(0.5f * cycle_s) : state.step_time_s.x, change.starting != V{}, tables.first_step,
         tables.step, state.step_time_s);
  // Where the ground makes steps slower, turns are as much slower: a step turns by as much.
  const auto turns = either(walks, may_turn_early(tables, state, change));
  const V turn_rad_s = turns ? V(asked.turn_rad_s / change.slowness) : V{},
          looked_rad_s = looked_turn(tables, state) / change.slowness;
  // A stick that crosses the heading asks for the other turn within 60 ms. The landing of a foot in
  // the air would turn by 0.1 rad a tick; a goal that is near turns it by half as much.
  constexpr float kNear_rad_s = 0.8f;
  const V turns_rad_s = state.turn_goal_rad_s.x,
          near_rad_s =
              least(most(turn_rad_s, V(turns_rad_s - kNear_rad_s)), V(turns_rad_s + kNear_rad_s)),
          goal_rad_s = state.flies != V{} ? near_rad_s : turn_rad_s;
  follow_turn(goal_rad_s, kStraight_rad_s, tables.turn_goal, state.turn_goal_rad_s);
  follow_turn(state.turn_goal_rad_s.x, kStraight_rad_s, tables.turn, state.turn_rad_s);
  follow_turn(V(kChestAhead_s * looked_rad_s), kStill_rad, tables.chest, state.chest_ahead_rad);
  follow_turn(V(kHeadAhead_s * looked_rad_s), kStill_rad, tables.head, state.head_ahead_rad);
  follow(asked.bounce, tables.bounce, state.bounce);
  follow(asked.sway, tables.bounce, state.sway);
  const V both_m = state.length_m[0].x + state.length_m[1].x;
  follow(V(0.5f * both_m * left * (1.0f / tables.source_step_m)), tables.step, state.pace);
  follow(within(V(2.0f * state.pace.x), 0.0f, 1.0f), tables.posture, state.posture);
  // A lean of v w / g puts the weight on the standing foot's edge, as on a bicycle. Hips that come
  // to rest do not lean into the turn that follows.
  const V speed_m_s = rests ? V{} : V(both_m / most(cycle_s, all<V>(kLeastCycle_s)));
  follow(V(speed_m_s * state.turn_rad_s.x * (1.0f / kGravity_m_s2)), tables.lean, state.lean_rad);
  // Sums of multiples of 2^-24 are exact, so mirrored sticks give exactly mirrored headings,
  // although their walks strike at other ticks.
  state.heading_rad =
      state.heading_rad +
      rounded_to(kTurned_rad, V(state.turn_rad_s.x * (tables.ticks * tables.tick_s)));
}

// Share of a cycle that a roll takes in strides of a ratio to the data's: longer in shorter steps.
// roll_time_share() of stride_family.h in floats.
template <class V>
V roll_share(const V& data_share, const V& ratio) noexcept {
  constexpr auto kLonger = static_cast<float>(kLongerRoll),
                 kShorter = static_cast<float>(kShorterRoll),
                 kLeast = static_cast<float>(kLeastRollShare),
                 kMost = static_cast<float>(kMostRollShare);
  const V less = 1.0f - ratio, share = data_share * (less > V{} ? 1.0f + kLonger * less
                                                                : 1.0f / (1.0f - kShorter * less));
  return least(most(share, least(all<V>(kLeast), data_share)), most(all<V>(kMost), data_share));
}

// Rounds the time of a stage to beats of 1/240 s, so that a steady walk is periodic and has the
// same rhythm at every tick rate.
template <class V>
V whole_beats(const V& time_s, float least_beats) noexcept {
  return most(floored(V(time_s * 240.0f + 0.5f)), all<V>(least_beats)) * (1.0f / 240.0f);
}
template <class V>
V ticks_of(const V& time_s, float tick_s) noexcept {
  return most(floored(V(time_s * (1.0f / tick_s) + 0.5f)), all<V>(2.0f));
}

// Cycles of the data in which the step of the swing foot `right` begins, rolls and flies.
template <class V>
V step_phase_of(const Tables& tables, const Mask<V>& right) noexcept {
  return chosen<V>(right, tables.stage_share[0] + tables.stage_share[1], 0.0f);
}
template <class V>
V roll_cycles(const Tables& tables, const Mask<V>& right) noexcept {
  return chosen<V>(right, tables.stage_share[2], tables.stage_share[0]);
}
template <class V>
V flight_cycles(const Tables& tables, const Mask<V>& right) noexcept {
  return chosen<V>(right, tables.stage_share[3], tables.stage_share[1]);
}

// The factor on the steps' times that are asked for: the mean of both is smoothed, because a thumb
// that lets go passes through deflections of slow steps.
template <class V>
V smoothed_times(const State<V>& state) noexcept {
  const V(&time_s)[2] = state.asked.time_s;
  return 2.0f * (state.step_time_s.x / most(V(time_s[0] + time_s[1]), all<V>(kLeastCycle_s)));
}

// Roll and flight of the step in which `right` swings: cycles of the data, and times.
template <class V>
struct Stages {
  V roll, flight, roll_s, flight_s;
};
template <class V>
Stages<V> stages_of(const Tables& tables, const Change<V>& change, const State<V>& state,
                    const Mask<V>& right, const V& ratio) noexcept {
  constexpr float kLeastRoll = 6.0f, kLeastFlight = 12.0f;  // beats: 0.025 s, 0.05 s
  const Asked<V>& asked = state.asked;
  const V roll = roll_cycles<V>(tables, right), flight = flight_cycles<V>(tables, right);
  const V rolls = roll_share(roll, ratio), flies = roll + flight - rolls;
  const V lands_s = by_side<V>(no(right), asked.time_s), swings_s = by_side<V>(right, asked.time_s),
          factor = 2.0f * smoothed_times(state) * change.slowness;
  return {roll, flight, whole_beats(V(lands_s * factor * rolls), kLeastRoll),
          whole_beats(V(swings_s * factor * flies), kLeastFlight)};
}
template <class V>
Stages<V> stages_of(const Tables& tables, const Change<V>& change, const State<V>& state,
                    const Mask<V>& right) noexcept {
  return stages_of(tables, change, state, right, asked_ratio(tables, state));
}

// Times a first step, again in each tick of its roll, because the thumb still moves. On uneven
// ground the flight takes at least `least_s` (0: no bound), to which it changes by 2 ticks a tick.
template <class V>
void time_first_flight(const Tables& tables, const Mask<V>& where, const V& least_s,
                       const Change<V>& change, State<V>& state) noexcept {
  constexpr float kFirstRoll_s = 0.25f;  // from the stick to the lift-off
  constexpr float kFirstFlight = 0.9f;   // of a steady flight, within these bounds
  constexpr float kLeastFirstFlight_s = 0.38f, kMostFirstFlight_s = 0.62f;
  const float tick_s = tables.tick_s, scale = tables.time_scale;
  const Stages<V> here = stages_of(tables, change, state, state.right_swings != V{});
  const V roll_s = whole_beats(all<V>(kFirstRoll_s * scale), 1.0f), roll = ticks_of(roll_s, tick_s),
          flight_s = whole_beats(within(V(kFirstFlight * here.flight_s),
                                        kLeastFirstFlight_s * scale, kMostFirstFlight_s * scale),
                                 1.0f),
          step_s = roll_s + flight_s, level = ticks_of(V(step_s - roll * tick_s), tick_s),
          was = state.tick == V{} ? level : state.flight_ticks,
          slow = least(most(floored(V(least_s * (1.0f / tick_s))), V(was - kLonger_ticks)),
                       V(was + kLonger_ticks)),
          flight = least_s == V{} ? level : most(level, slow);
  state.step_s = where ? most(step_s, V((roll + flight - 0.5f) * tick_s)) : state.step_s;
  state.roll_ticks = where ? roll : state.roll_ticks;
  state.flight_ticks = where ? flight : state.flight_ticks;
  state.end_rate = where ? V(0.5f * (here.roll / roll + here.flight / flight)) : state.end_rate;
}

template <class V>
V ticks_of_stage(const State<V>& state) noexcept {
  return state.flies != V{} ? state.flight_ticks : state.roll_ticks;
}
// Phase at which the roll or the flight ends.
template <class V>
V stage_end_of(const Tables& tables, const State<V>& state) noexcept {
  const auto right = state.right_swings != V{};
  return step_phase_of<V>(tables, right) + roll_cycles<V>(tables, right) +
         (state.flies != V{} ? flight_cycles<V>(tables, right) : V{});
}
template <class V>
Time<V> time_of(const Tables& tables, const State<V>& state) noexcept {
  Time<V> time;
  time.right = state.right_swings != V{};
  time.flies = state.flies != V{};
  time.back = state.backward != V{};
  time.step_phase = step_phase_of<V>(tables, time.right);
  time.stage_end = stage_end_of(tables, state);
  time.u = time.flies ? V(state.tick / state.flight_ticks) : V{};
  time.to_strike = ticks_of_stage(state) - state.tick + (time.flies ? V{} : state.flight_ticks);
  time.share = (state.tick + (time.flies ? state.roll_ticks : V{})) /
               (state.roll_ticks + state.flight_ticks);
  return time;
}

// A phase that moves along a cubic over a stage: `way` cycles, at rates of v0 and v1 per stage.
template <class V>
struct PhaseCubic {
  PhaseCubic(const V& way, const V& v0, const V& v1) noexcept
      : v0(v0), c2(3.0f * way - 2.0f * v0 - v1), c3(v0 + v1 - 2.0f * way) {}
  // Cycles gone after the share s of the stage, and the rate per stage.
  V at(const V& s) const noexcept { return (v0 + (c2 + c3 * s) * s) * s; }
  V rate(const V& s) const noexcept { return v0 + (2.0f * c2 + 3.0f * c3 * s) * s; }
  V v0, c2, c3;
};

// Moves the clock on by a tick, or by several, but not beyond the end of a stage. `least_s`: bound
// of time_first_flight().
template <class V>
Time<V> advance_clock(const Tables& tables, const V& least_s, const Change<V>& change,
                      State<V>& state) noexcept {
  const auto follows = both(both(change.starting != V{}, change.turns == V{}), state.flies == V{}),
             runs = change.stands == V{};
  if (any(follows)) time_first_flight(tables, follows, least_s, change, state);
  const V left = ticks_of_stage(state) - state.tick, per_tick = 1.0f / left,
          goes = least(all<V>(tables.ticks), left), s = goes * per_tick;
  const PhaseCubic<V> moves(stage_end_of(tables, state) - state.phase, state.phase_rate * left,
                            state.end_rate * left);
  state.phase = runs ? V(state.phase + moves.at(s)) : state.phase;
  state.phase_rate = runs ? V(moves.rate(s) * per_tick) : V{};
  state.tick = runs ? V(state.tick + goes) : V{};
  return time_of(tables, state);
}

// Begins the flight, where `lifts`: after the last tick of the roll. `ratio`: of its landing.
template <class V>
void begin_flight(const Tables& tables, const Time<V>& time, const Mask<V>& lifts, const V& ratio,
                  const Change<V>& change, State<V>& state) noexcept {
  const Stages<V> here = stages_of(tables, change, state, time.right),
                  next = stages_of(tables, change, state, no(time.right),
                                   ratio_on_arc(tables, time, ratio, change, state));
  // At the flight's end the phase runs at the mean of both stages' rates, so that it has no kink.
  const V end_rate =
      0.5f * (here.flight / state.flight_ticks + next.roll / ticks_of(next.roll_s, tables.tick_s));
  state.end_rate = lifts ? end_rate : state.end_rate;
  state.flies = lifts ? all<V>(1.0f) : state.flies;
  state.tick = lifts ? V{} : state.tick;
}

// Begins the other foot's step, where `strikes`: after the last tick of the flight. The step makes
// up for the roundings of the steps before. If it is slower than the last one (`led`), the hips are
// still fast and would sink for the rear foot, so its roll is shorter. Except on stairs it is also
// short enough that slowing hips need not go back.
template <class V>
void begin_step(const Tables& tables, const Time<V>& time, const Mask<V>& strikes,
                const Change<V>& change, State<V>& state) noexcept {
  const float tick_s = tables.tick_s;
  const Stages<V> next = stages_of(tables, change, state, no(time.right));
  const V short_s = state.late_s + state.step_s - (state.roll_ticks + state.flight_ticks) * tick_s;
  constexpr float kLeastWay = 0.52f;  // of speed times time: on a shorter way a quintic goes back
  // Onto the spot, which has no back: in less time hips brake by 14.7 m/s^2, in this by 12.2.
  constexpr float kLeastWayOnSpot = 0.42f;
  constexpr float kLeastTime = 0.5f;  // of the step's own time
  constexpr float kWalked = 0.2f;     // ratio from which on the last step was not on the spot
  const auto led = change.led != V{};
  const V asked_m = by_side<V>(no(time.right), state.asked.length_m),
          way_m =
              0.5f * (state.ratio_behind * own_step_m<V>(tables, time.right, time.back) + asked_m),
          least_way = chosen<V>(asked_m == V{}, kLeastWayOnSpot, kLeastWay),
          x = change.pelvis_x_m.v, z = change.pelvis_z_m.v,
          speed_m = most(root(V(x * x + z * z)), all<V>(1e-5f)),
          own_s = next.roll_s + next.flight_s,
          least_time = change.slowness > all<V>(1.0f) ? all<V>(1.0f) : all<V>(kLeastTime),
          longest_s = most(V(tick_s * way_m / (least_way * speed_m)), V(least_time * own_s));
  // After a flight that the ground has made long, the phase is slow. The roll lasts as long as it
  // takes to become as fast as in the flight. In its own time it would first become faster: at 0.83
  // of the steady rate hips surge and brake by 10 m/s^2.
  constexpr float kSlow = 0.84f;  // of the phase's steady rate at a strike
  const V flight_rate = next.flight * tick_s / next.flight_s,
          roll_rate = next.roll * tick_s / next.roll_s;
  const auto is_slow = both(no(led), state.phase_rate < 0.5f * kSlow * (flight_rate + roll_rate));
  // The roll shows the last step's stride, whose length on an arc is not the asked one. In another
  // time than its own, its hips would surge and brake, by 10 m/s^2.
  const Stages<V> shown = stages_of(tables, change, state, no(time.right),
                                    ratio_on_arc(tables, time, state.ratio_behind, change, state));
  V roll_s = shown.roll_s, longer_s{};
  if (tables.terrain != nullptr) {
    longer_s =
        is_slow ? V(tick_s * next.roll * 2.0f / (state.phase_rate + flight_rate) - roll_s) : V{};
    roll_s = roll_s + longer_s;
  }
  const V late_s = within(short_s, -tick_s, tick_s),
          step_s = both(both(led, change.stops == V{}), state.ratio_behind > all<V>(kWalked))
                       ? least(own_s, longest_s)
                       : V(own_s + longer_s),
          own_roll = ticks_of(V(roll_s + late_s), tick_s),
          last_roll = next.roll / most(state.phase_rate, all<V>(1e-4f)),
          led_roll = most(floored(root(V(own_roll * last_roll))), all<V>(2.0f)),
          shorter_roll = most(floored(V(own_roll * (step_s / own_s))), all<V>(2.0f)),
          roll = led ? least(shorter_roll, led_roll) : own_roll,
          flight = ticks_of(V(step_s + late_s - roll * tick_s), tick_s);
  state.late_s = strikes ? late_s : state.late_s;
  state.step_s = strikes ? step_s : state.step_s;
  state.roll_ticks = strikes ? roll : state.roll_ticks;
  state.flight_ticks = strikes ? flight : state.flight_ticks;
  state.end_rate = strikes ? V(0.5f * (next.roll / roll + next.flight / flight)) : state.end_rate;
  state.strike_rate = strikes ? state.phase_rate : state.strike_rate;
  state.phase = strikes ? (time.right ? V{} : time.stage_end) : state.phase;
  state.right_swings = strikes ? V(1.0f - state.right_swings) : state.right_swings;
  state.flies = strikes ? V{} : state.flies;
  state.tick = strikes ? V{} : state.tick;
}

}  // namespace
}  // namespace gaitpad
