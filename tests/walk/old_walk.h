// Takes over a walk of the old code at a strike, so that both may be compared from there on.
#pragma once
#include <bit>

#include "gaitpad/walk.h"
#include "tests/walk/ask.h"

namespace gaitpad::anew {

inline bool has_just_struck(const WalkState& old) {
  return old.clock.stage == gaitpad::Stage::roll && old.clock.tick == 0 && old.clock.started;
}

inline Block<1> taken_over(const WalkState& old, const GaitParams& params) {
  Block<1> block{};
  State<float>& to = block.state;
  ask(params, to.asked);
  block.change.foreseen_m = to.asked.length_m[0] + to.asked.length_m[1];
  const int stand = old.clock.swing, swing = 1 - stand;
  const FootState &stands = old.foot[stand], &swings = old.foot[swing];
  const double yaw = stands.lift_yaw_rad;
  const Placement frame{stands.heel_anchor_m, yaw};
  block.origin[0] = {frame.place_m.x, frame.place_m.z, yaw, frame.place_m.y};
  const SinCos half = gaitpad::sin_cos(0.5 * wrapped(yaw));
  to.frame_sine = static_cast<float>(half.sin), to.frame_cosine = static_cast<float>(half.cos);
  const auto smoothed = [](const Damped<double>& from, Smoothed<float>& value) {
    value = {static_cast<float>(from.x), static_cast<float>(from.v)};
  };
  const GaitState& gait = old.gait;
  for (int side : {0, 1}) {
    smoothed(gait.length_m[side], to.length_m[side]);
    smoothed(gait.flight_height[side], to.lift[side]);
  }
  smoothed(gait.turn_goal, to.turn_goal_rad_s);
  smoothed(gait.turn_rate, to.turn_rad_s);
  smoothed(gait.bounce, to.bounce);
  smoothed(gait.sway, to.sway);
  smoothed(gait.pace, to.pace);
  smoothed(gait.posture, to.posture);
  smoothed(old.path.lean_rad, to.lean_rad);
  smoothed(gait.step_time_s, to.step_time_s);
  smoothed(old.body.chest_ahead_rad, to.chest_ahead_rad);
  smoothed(old.body.head_ahead_rad, to.head_ahead_rad);
  to.right_swings = swing == kRightSide ? 1.0f : 0.0f;
  to.roll_ticks = static_cast<float>(old.clock.roll_ticks);
  to.backward = old.clock.backward ? 1.0f : 0.0f;
  to.flight_ticks = static_cast<float>(old.clock.flight_ticks);
  to.step_s = static_cast<float>(old.clock.step_s);
  to.late_s = static_cast<float>(old.clock.late_s);
  to.phase = static_cast<float>(old.clock.phase);
  to.phase_rate = to.strike_rate = static_cast<float>(old.clock.phase_rate);
  to.end_rate = static_cast<float>(old.clock.end_rate);
  to.heading_rad = static_cast<float>(old.path.heading_rad - yaw);
  to.wider_m = static_cast<float>(old.path.wider_m);
  to.ratio_behind = static_cast<float>(gait.ratio_behind);
  const auto place = [&](const vec3& world_m, float& x_m, float& z_m) {
    const vec3 p = from_world(frame, world_m);
    x_m = static_cast<float>(p.x), z_m = static_cast<float>(p.z);
  };
  const vec3 &now = old.path.pelvis_m.x, &last = old.path.last_pelvis_m;
  place(now, to.pelvis_x_m[0], to.pelvis_z_m[0]);
  place(last, to.pelvis_x_m[1], to.pelvis_z_m[1]);
  place(2.0 * last - now, to.pelvis_x_m[2], to.pelvis_z_m[2]);
  place(swings.heel_anchor_m, to.print_x_m, to.print_z_m);
  place(swings.toe_anchor_m, to.toe_x_m, to.toe_z_m);
  Footing<float>& footing = block.footing;
  const auto height = [&](double y_m) { return static_cast<float>(y_m - frame.place_m.y); };
  const auto slope = [&](const FootPlane& plane) {
    const vec3 n = from_world({vec3(0.0), yaw}, plane.normal);
    return Slope<float>{static_cast<float>(-n.x / n.y), static_cast<float>(-n.z / n.y)};
  };
  footing.stand = slope(stands.plane), footing.print = slope(swings.plane);
  footing.print_y_m = height(swings.plane.place_m.y);
  footing.toe_y_m = height(swings.toe_anchor_m.y);
  const HipsGround& base = old.path.base;
  footing.hips_m = {height(base.height_m), static_cast<float>(base.per_tick_m),
                    static_cast<float>(base.per_tick2_m)};
  footing.yield_m = static_cast<float>(base.yield_m);
  footing.next_rise = static_cast<float>(old.path.foothold.next_rise);
  footing.step_ratio = static_cast<float>(gait.step_ratio);
  footing.step_m = static_cast<float>(old.path.stride_m[swing]);
  smoothed(gait.ground_share, footing.left);
  smoothed(old.path.slope_lean_rad, footing.lean_rad);
  block.change.slowness = static_cast<float>(old.clock.slowness);
  to.print_rad = static_cast<float>(swings.lift_yaw_rad - yaw);
  to.stand_pitch_rad = static_cast<float>(stands.pitch_fade.value);
  for (int k : {0, 1}) {
    const int side = k == 0 ? swing : stand;
    for (int j = 0; j < kLegAngles; ++j) {
      to.leg_rad[k][j] =
          static_cast<float>(old.legs.even_rad[side][j] - old.legs.data_rad[side][j]);
      to.last_leg_rad[k][j] = static_cast<float>(old.legs.last_off_rad[side][j]);
    }
  }
  return block;
}

// What a style asks for, beyond what ask() hands over.
inline void ask_style(const GaitParams& params, Block<1>& block) {
  Styled<float>& styled = block.styled;
  styled.asked = params.body == UpperBodyParams{} ? 0.0f : 1.0f;
  const auto body = std::bit_cast<std::array<double, kBodyNumbers>>(params.body);
  for (int n = 0; n < kBodyNumbers; ++n) styled.goal[n] = static_cast<float>(body[n]);
  Weighted<float>& weighted = block.weighted;
  weighted.asked = 0.0f;
  for (int side : {0, 1}) {
    for (int j = 0; j < kLegAngles; ++j) {
      weighted.goal[side][j] = static_cast<float>(params.weight[side][j]);
      if (weighted.goal[side][j] != 1.0f) weighted.asked = 1.0f;
    }
  }
}

// What a walk's style has made of it, at the strike.
inline void take_style(const WalkState& old, const GaitParams& params, Block<1>& block) {
  ask_style(params, block);
  Weighted<float>& weighted = block.weighted;
  weighted.acts = weighted.asked;
  block.styled.acts = block.styled.asked;
  for (int n = 0; n < kBodyNumbers; ++n) block.styled.body[n] = {block.styled.goal[n], 0.0f};
  const int stand = old.clock.swing;
  for (int k : {0, 1}) {
    const int side = k == 0 ? 1 - stand : stand;
    block.styled.low[k] = {static_cast<float>(old.legs.low[side].x),
                           static_cast<float>(old.legs.low[side].v)};
    weighted.loose[k] = {static_cast<float>(old.legs.loose[side].x),
                         static_cast<float>(old.legs.loose[side].v)};
    for (int j = 0; j < kLegAngles; ++j) {
      const auto of = [&](const auto& angles_rad) {
        return static_cast<float>(angles_rad[side][j]);
      };
      weighted.lagging_rad[k][j] = of(old.legs.lagging_rad);
      weighted.mean_rad[k][j] = of(old.legs.mean_rad);
      weighted.shift_rad[k][j] = of(old.legs.angles_rad) - of(old.legs.even_rad);
      weighted.last_shift_rad[k][j] = of(old.legs.last_shift_rad);
      const Damped<double>& weight = old.gait.weight[k][j];
      weighted.weight[k][j] = {static_cast<float>(weight.x), static_cast<float>(weight.v)};
    }
  }
}

}  // namespace gaitpad::anew
