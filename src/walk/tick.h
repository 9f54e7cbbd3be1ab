// One tick of the walks of a block, in the order of its data.
#pragma once
#include "walk/paper.h"
#include "walk/pose.h"

namespace gaitpad::anew {
namespace {

// The step frame of the walks that strike goes to the new footprint.
template <int kWidth>
void move_frame(const Landing<Floats<kWidth>>& landing, const Mask<Floats<kWidth>>& strikes,
                Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  const Way<V> frame = {
      state.frame_sine, state.frame_cosine, 2.0f * state.frame_sine * state.frame_cosine,
      state.frame_cosine * state.frame_cosine - state.frame_sine * state.frame_sine};
  const Vec<V> moved = frame * Vec<V>{landing.x_m, V{}, landing.z_m};
  const V is = chosen<V>(strikes, 1.0f, 0.0f);
  V half_rad{};
  for (int w = 0; w < kWidth; ++w) {
    Origin& origin = block.origin[w];
    if (lane(is, w) != 0.0f) {
      origin.x_m += lane(moved.x, w);
      origin.z_m += lane(moved.z, w);
      origin.heading_rad += lane(landing.rad, w);
    }
    set_lane(static_cast<float>(0.5 * wrapped(origin.heading_rad)), w, half_rad);
  }
  V sine, cosine;
  sin_cos(half_rad, sine, cosine);
  state.frame_sine = strikes ? sine : state.frame_sine;
  state.frame_cosine = strikes ? cosine : state.frame_cosine;
}

// A stand that is asked for very little waits whether it is meant: a stick that is touched in
// passing would else cost two slow steps.
template <class V>
Mask<V> is_meant(const Tables& tables, const State<V>& state, const Change<V>& change) noexcept {
  constexpr float kHesitation_s = 0.2f;  // for next to nothing; less for more, none from
  constexpr float kSureRatio = 0.3f, kSureTurn_rad_s = 0.15f;  // this stride or turn on
  const V ratio = most(V(state.asked.length_m[0] * (1.0f / tables.leg[0].own_step_m)),
                       V(state.asked.length_m[1] * (1.0f / tables.leg[1].own_step_m))),
          sure = most(V(ratio * (1.0f / kSureRatio)),
                      V(size(state.asked.turn_rad_s) * (1.0f / kSureTurn_rad_s)));
  return change.asked_ticks * tables.tick_s >=
         kHesitation_s * tables.time_scale * (1.0f - least(sure, all<V>(1.0f)));
}

// Where one that stands is to walk: the foot on the side of the turn goes first.
template <int kWidth>
void begin_walks(const Tables& tables, Block<kWidth>& block) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  const auto asked = both(change.stands != V{}, state.asked.walks != V{});
  if (!any(either(asked, change.asked_ticks != V{}))) return;
  change.asked_ticks = asked ? V(change.asked_ticks + 1.0f) : V{};
  const auto begins = both(asked, is_meant(tables, state, change));
  if (!any(begins)) return;
  change.asked_ticks = begins ? V{} : change.asked_ticks;
  const auto right = state.right_swings != V{},
             other = both(begins, right != (state.asked.turn_rad_s < V{}));
  if (any(other)) {
    Landing<V> beside{state.print_x_m, state.print_z_m, state.print_rad, way_of(state.print_rad)};
    Feet<V> feet;
    feet.sole[1] = sole_of<V>(tables, no(right));
    move_frame<kWidth>(beside, other, block);
    change_feet(beside, other, feet, Stride<V>{}, state);
    change_weighted_legs(other, block.weighted);
    state.right_swings = other ? V(1.0f - state.right_swings) : state.right_swings;
  }
  const auto set = [&](const V& to, V& number) { number = begins ? to : number; };
  const auto first = state.right_swings != V{};
  const auto& share = tables.stage_share;
  const V begin = chosen<V>(first, share[0] + share[1], 0.0f),
          middle = 0.5f * chosen<V>(first, share[2] + share[3], share[0] + share[1]);
  set(V{}, change.stands), set(all<V>(1.0f), change.starting), set(all<V>(1.0f), change.led);
  set(V{}, change.was_led), set(V{}, change.off_phase.x), set(V{}, change.off_ticks);
  // The tables' hips are over the foot that stands in the middle of its support.
  set(V(begin + middle), change.phase), set(V{}, change.phase_rate);
  set(begin, state.phase), set(V{}, state.phase_rate), set(V{}, state.strike_rate);
  set(V{}, state.tick), set(V{}, state.flies), set(V{}, state.late_s);
  set(V{}, state.ratio_behind), set(V{}, state.stand_pitch_rad);
  for (Smoothed<V>& length_m : state.length_m) set(V{}, length_m.x), set(V{}, length_m.v);
  go_on_from_here(tables, begins, state, change);
}

// Where both feet stand no clock runs, and nothing is left of the last step.
template <class V>
void rest(const Change<V>& change, State<V>& state) noexcept {
  const auto stands = change.stands != V{};
  const auto set = [&](float to, V& number) { number = stands ? all<V>(to) : number; };
  set(1.0f, state.roll_ticks), set(1.0f, state.flight_ticks), set(0.0f, state.stand_pitch_rad);
  set(0.0f, state.ratio_behind), set(0.0f, state.phase), set(0.0f, state.phase_rate);
  set(0.0f, state.wider_m), set(0.0f, state.next_wider_m);
}

// kPaper: with the paper's own solver, of one walk; the body leans into nothing then.
template <int kWidth, bool kPaper = false>
void advance_block(const Tables& tables, Block<kWidth>& block, const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  begin_walks(tables, block);
  smooth_asked(tables, change, state);
  if constexpr (kPaper) state.lean_rad = state.chest_ahead_rad = state.head_ahead_rad = {};
  const Time<V> time = advance_clock(tables, change, state);
  const Landing<V> landing = plan_landing(tables, time, change, state);
  const Stride<V> by_clock =
      read_by_clock(tables, time, landing, state.phase, time.share, time.u, change, state);
  Hips<V> hips = move_hips(tables, time, landing, by_clock, change, state);
  Stride<V> stride;
  const V phase = lead_hips(tables, time, landing, by_clock, state, change, hips, stride);
  keep_pelvis(hips, state);
  Feet<V> feet = plan_feet(tables, time, landing, by_clock, stride, hips, change, state);
  Pelvis<V> pelvis = pelvis_over(tables, time, hips, stride, state);
  Idle<V> idle;
  if constexpr (!kPaper) {
    idle = advance_idle(tables, change, state, block.styled);
    sway(idle, hips.heading, pelvis);
  }
  V asked_rad[2]{};
  keep_heels_low(tables, time, phase, stride, change, state, block.styled, pelvis, feet, asked_rad);
  const Vec<V> ankle_m[2] = {ankle_of(feet.foot[0], feet.sole[0]),
                             ankle_of(feet.foot[1], feet.sole[1])};
  sink(tables, time, stride, ankle_m, state, pelvis);
  reach_with_toe(tables, time, change, pelvis, feet);
  Leg<V> legs[2];
  if constexpr (kPaper) {
    solve_by_paper(tables, time, phase, change, feet, pelvis, state, block.weighted, legs);
  } else {
    solve_legs(tables, time, stride, feet, pelvis, state, legs);
    weigh_legs(tables, time, stride, feet, pelvis, phase, change, state, block.weighted, legs);
  }
  const V swing = kPaper ? all<V>(1.0f) : arm_swing(tables, state);
  write_upper_body(tables, hips, pelvis, idle, phase, change.shown, swing, state, block.styled,
                   poses);
  write_legs(tables, time, feet, legs, poses);
  write_root<kWidth>(tables, pelvis, block, poses);

  take_back(asked_rad, feet);
  const auto lifts = both(no(time.flies), state.tick >= state.roll_ticks),
             strikes = both(time.flies, state.tick >= state.flight_ticks);
  if (any(lifts)) lift_off(tables, time, lifts, landing, hips, feet, by_clock, change, state);
  keep_swing(feet.foot[0], state);
  if (any(strikes)) {
    move_frame<kWidth>(landing, strikes, block);
    change_feet(landing, strikes, feet, by_clock, state);
    change_weighted_legs(strikes, block.weighted);
    change_styled_feet(strikes, block.styled);
    const auto keeps = either(change.led != V{}, change.off_phase.x != V{});
    const V rate = keeps ? change.phase_rate : state.phase_rate;
    begin_lead(tables, strikes, phase, rate, state, change);
    begin_step(tables, time, strikes, change, state);
    rest(change, state);
  }
  if (any(lifts)) begin_flight(tables, time, lifts, state);
}

}  // namespace
}  // namespace gaitpad::anew
