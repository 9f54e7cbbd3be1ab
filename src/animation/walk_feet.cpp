// Plans the feet, before any inverse kinematics.
//
// A foot is always in one of three modes. In support it stands on its toe, and the heel may rise.
// In flight its heel follows the flight path of the data, stretched to go from where it lifted to
// where it is to land. In roll it has landed on its heel, and the toe comes down. A foot's pose is
// a place (of the heel or the toe), a direction and a pitch. When the mode changes, the difference
// of pose and rate from the new mode's plan fades as a cubic, so nothing jumps.
//
// Heights and pitches count from the plane that the foot is planned on: the ground under its sole,
// and in flight a line from the plane it left to the plane it will land on.
#include "animation/walk_flow.h"

namespace gaitpad {
namespace {

constexpr double kPitchFade = 0.2, kShortPitchFade = 0.6;

}  // namespace

void pitch_foot(const LegBuild& leg, double pitch_rad, FootPose& pose, FootMode mode) noexcept {
  set_pitch<double>(leg, pitch_rad, mode == FootMode::support, pose);
}

// The planned pose of the foot, before it rises for its leg.
FootPose planned_pose(const WalkModel& model, const WalkState& state, Side side) noexcept {
  FootPose pose = state.foot[side].pose;
  const double asked_rad = state.legs.asked_rad[side];
  if (asked_rad != 0.0)
    pitch_foot(model.leg[side], pose.pitch_rad - asked_rad, pose, FootMode::support);
  return pose;
}

void remember_feet(const WalkModel& model, WalkState& state) noexcept {
  for (const Side side : {kLeftSide, kRightSide}) {
    FootState& foot = state.foot[side];
    const FootPose planned = planned_pose(model, state, side);
    foot.last_heel_m = {planned.heel_m, foot.last_heel_m[0]};
    foot.last_pitch_rad = {planned.pitch_rad, foot.last_pitch_rad[0]};
    foot.last_rise_m = {foot.rise_m, foot.last_rise_m[0]};
  }
}

void begin_support(FootState& foot) noexcept {
  foot.mode = FootMode::support;
  foot.mode_ticks = 0;
  foot.fade_begin = 0.0;
  foot.pitch_fade = {};
}

void begin_flight(const Tick& tick, WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  FootState& foot = state.foot[side];
  const double ticks = state.clock.stage_ticks;
  const FootPose lifts = planned_pose(model, state, side);
  const vec3 slope_m = end_slope(foot.last_heel_m[1], foot.last_heel_m[0], lifts.heel_m) * ticks;
  const double pitch_rate =
      end_slope(foot.last_pitch_rad[1], foot.last_pitch_rad[0], lifts.pitch_rad);
  foot.mode = FootMode::flight;
  foot.mode_ticks = 0;
  foot.fade_begin = 0.0;
  const Moment at = moment_of(model, state);
  foot.lift_m = lifts.heel_m;
  foot.crosses_riser =
      !tick.flat && crosses_riser(*model.terrain, foot.plane, state.path.landing_plane);
  // In a turn the foot pivots on its planted toe while its heel rises.
  foot.lift_turn_rad =
      state.gait.turn_rate.x * heel_rise<double>(model, at, side) * tick.dt_s * ticks;
  foot.eased_heel = {.value = lifts.heel_m, .rate = slope_m / ticks, .bend = {}, .off = {}};
  foot.eased_pitch = {.value = lifts.pitch_rad, .rate = pitch_rate, .bend = {}, .off = {}};
  // The foot's difference from the tables fades by its eased values, so no gap is left.
  foot.gap_m = foot.gap_slope_m = vec3(0.0);
  foot.gap_begin = 0.0;
  foot.gap_lasts = kLiftFade;
  foot.pitch_fade = {};
  const double step = 1.0 / (state.clock.roll_ticks + state.clock.flight_ticks);
  const double share = state.clock.roll_ticks * step;
  StridePlan now, next;
  plan_stride<double>(tick, at, state, state.clock.phase, share, now);
  plan_stride<double>(tick, at, state, state.clock.phase + state.clock.phase_rate, share + step,
                      next);
  double base_m = 0.0;
  const vec3 from = flight_heel<double>(tick, at, state, now, side, 0.0, base_m);
  const vec3 to = flight_heel<double>(tick, at, state, next, side, 1.0 / ticks, base_m);
  foot.gap_m = lifts.heel_m - from;
  foot.gap_slope_m = slope_m - (to - from) * ticks;
  foot.gap_m.y -= foot.rise_m;
  foot.gap_slope_m.y -= end_slope(foot.last_rise_m[1], foot.last_rise_m[0], foot.rise_m) * ticks;
  const double pitch = table_pitch<double>(at, state, now, side);
  foot.pitch_fade = {
      lifts.pitch_rad - pitch, pitch_rate - (table_pitch<double>(at, state, next, side) - pitch),
      (state.clock.starting || state.clock.closing ? kShortPitchFade : kPitchFade) * ticks};
  if (!tick.flat) plan_room(tick, state, side);
}

void plant_foot(WalkState& state, Side side) noexcept {
  FootState& foot = state.foot[side];
  foot.heel_anchor_m = state.path.landing_m;
  foot.lift_yaw_rad = state.path.landing_heading_rad;
  foot.plane = state.path.landing_plane;
  state.path.asked.is_taken = false;
  state.path.wider_m = state.path.next_wider_m;
}

void begin_roll(const Tick& tick, WalkState& state, Side side) noexcept {
  FootState& foot = state.foot[side];
  foot.mode = FootMode::roll;
  foot.mode_ticks = 0;
  foot.fade_begin = 0.0;
  foot.eased_pitch.ticks = 0.0;
  foot.eased_pitch.value = foot.pose.pitch_rad;
  StridePlan plan;
  const Moment at = moment_of(tick.model, state);
  plan_stride<double>(tick, at, state, plan);
  const double pitch = foot.pose.pitch_rad - table_pitch<double>(at, state, plan, side);
  foot.pitch_fade = {pitch, 0.0, kRollEnd * state.clock.stage_ticks};
  FootPose flat = foot.pose;
  flat.heel_m = foot.heel_anchor_m;
  flat.yaw = foot.pose.yaw = rotation_y(foot.lift_yaw_rad);
  flat.edge = kIdentity;
  pitch_foot(tick.model.leg[side], 0.0, flat, FootMode::roll);
  foot.toe_anchor_m = flat.toe_m;
}

}  // namespace gaitpad
