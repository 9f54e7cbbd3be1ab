// One tick of the walks of a block, in the order of its data.
#pragma once
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

template <int kWidth>
void advance_block(const Tables& tables, Block<kWidth>& block, const Poses& poses) noexcept {
  using V = Floats<kWidth>;
  State<V>& state = block.state;
  Change<V>& change = block.change;
  smooth_asked(tables, state);
  const Time<V> time = advance_clock(tables, state);
  const Landing<V> landing = plan_landing(tables, time, state);
  const Stride<V> by_clock = read_stride(tables, time, state.phase, state.ratio_behind,
                                         landing.ratio, smoother(time.share));
  Hips<V> hips = move_hips(tables, time, landing, by_clock, change, state);
  Stride<V> stride;
  const V phase = lead_hips(tables, time, landing, by_clock, state, change, hips, stride);
  keep_pelvis(hips, state);
  const Feet<V> feet = plan_feet(tables, time, landing, stride, hips, change, state);
  Pelvis<V> pelvis = pelvis_over(tables, time, hips, stride, state);
  const Vec<V> ankle_m[2] = {ankle_of(feet.foot[0], feet.sole[0]),
                             ankle_of(feet.foot[1], feet.sole[1])};
  sink(tables, time, stride, ankle_m, pelvis);
  Leg<V> legs[2];
  solve_legs(tables, time, stride, feet, pelvis, state, legs);
  write_upper_body(tables, pelvis, phase, state, poses);
  write_legs(tables, time, feet, legs, poses);
  write_root<kWidth>(tables, pelvis, block, poses);

  const auto lifts = both(no(time.flies), state.tick >= state.roll_ticks),
             strikes = both(time.flies, state.tick >= state.flight_ticks);
  if (any(lifts)) lift_off(tables, time, lifts, landing, hips, feet, by_clock, state);
  keep_swing(feet.foot[0], state);
  if (any(strikes)) {
    move_frame<kWidth>(landing, strikes, block);
    change_feet(landing, strikes, feet, by_clock, state);
    const auto keeps = either(change.led != V{}, change.off_phase.x != V{});
    const V rate = keeps ? change.phase_rate : state.phase_rate;
    begin_lead(tables, strikes, phase, rate, state, change);
    begin_step(tables, time, strikes, change.led, state);
  }
  if (any(lifts)) begin_flight(tables, time, lifts, state);
}

}  // namespace
}  // namespace gaitpad::anew
