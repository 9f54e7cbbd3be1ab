#include "animation/walk.h"

#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

void write_leg(const WalkModel& model, const WalkState& state, Side side, JointFrames& frames,
               Pose& pose) noexcept {
  const LegBuild& leg = model.leg[side];
  const LegJoints& joints = leg.model.joints;
  const LegAngles& q = state.angles_rad[side];
  const Skeleton& skeleton = model.cycle.skeleton;
  const quat pelvis =
      frames.rotation[model.cycle.pelvis] * glm::inverse(model.cycle.pelvis_standing);
  const quat thigh = pelvis * (rotation_x(q[kHipX]) * rotation_z(q[kHipZ]) * rotation_y(q[kHipY]));
  const quat shank = thigh * rotation_x(q[kKneeX]);
  const quat foot =
      shank * (rotation_x(q[kAnkleX]) * rotation_z(q[kAnkleZ]) * rotation_y(q[kAnkleY]));
  const quat toes = foot * rotation_about(leg.side, state.foot[side].pose.toe_rad);
  const std::array<int, 4> chain = {joints.hip, joints.knee, joints.ankle, joints.toe};
  const std::array<quat, 4> segment = {thigh, shank, foot, toes};
  int last = model.cycle.pelvis;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const int j = chain[i];
    if (skeleton.joints[j].is_end_site) break;
    // Joints between two of the chain keep their standing rotation.
    quat parent = frames.rotation[last];
    std::array<int, kMaxBetween> between{};
    int n = 0;
    for (int p = skeleton.joints[j].parent; p != last && n < kMaxBetween;
         p = skeleton.joints[p].parent) {
      between[n++] = p;
    }
    while (n > 0) parent = parent * pose.local[between[--n]];
    frames.rotation[j] = segment[i] * leg.model.standing[i];
    pose.local[j] = glm::inverse(parent) * frames.rotation[j];
    last = j;
  }
}

void write_pose(const WalkModel& model, const WalkState& state, const Pelvis& pelvis,
                Pose& pose) noexcept {
  const GaitCycle& cycle = model.cycle;
  pose.joint_count = static_cast<int>(cycle.skeleton.joints.size());
  sample_local(cycle, data_phase(model, state), pose);
  swing_arms(model, state, pose);
  const double a = presence(state);
  if (a < 1.0) {
    for (int j = 0; j < pose.joint_count; ++j) {
      const quat& rest = cycle.standing_local[j];
      const quat& walk = pose.local[j];
      const double sign = glm::dot(rest, walk) < 0.0 ? -1.0 : 1.0;
      pose.local[j] = glm::normalize(rest * (1.0 - a) + walk * (sign * a));
    }
  }
  for (int j : model.kept) pose.local[j] = cycle.standing_local[j];
  // What hangs between root and pelvis turns with the heading and else moves as in the data.
  JointFrames frames;
  pose.root_m = pelvis.position_m;
  pose.local[0] = rotation_y(state.heading_rad) * pose.local[0];
  quat above = kIdentity;
  for (int j = cycle.skeleton.joints[cycle.pelvis].parent; j >= 0;
       j = cycle.skeleton.joints[j].parent) {
    above = pose.local[j] * above;
  }
  frames.rotation[cycle.pelvis] = pelvis.rotation * cycle.pelvis_standing;
  pose.local[cycle.pelvis] = glm::inverse(above) * frames.rotation[cycle.pelvis];
  for (Side side : {kLeftSide, kRightSide}) write_leg(model, state, side, frames, pose);
  pose_body(model, state, pose);
}

void report_ground(const Tick& tick, WalkFrame& frame) noexcept {
  if (tick.flat) return;
  const Terrain& terrain = *tick.model.terrain;
  for (int side : {0, 1}) {
    const vec3 &heel = frame.heel_m[side], &toe = frame.toe_m[side];
    frame.heel_ground_m[side] = ground_at(terrain, heel.x, heel.z).height_m;
    frame.toe_ground_m[side] = ground_at(terrain, toe.x, toe.z).height_m;
  }
}

void report(const Pelvis& pelvis, double dt_s, WalkState& state) noexcept {
  WalkFrame& frame = state.frame;
  frame.stage = state.stage;
  frame.swing = state.swing;
  frame.heading_rad = state.heading_rad;
  frame.turn_rate_rad_s = state.turn_rate.x;
  frame.pelvis_m = pelvis.position_m;
  const bool idle = frame.stage == Stage::idle;
  if (idle) frame.stride_m = {};
  for (Side side : {kLeftSide, kRightSide}) {
    const bool swings = frame.swing == side;
    frame.heel_planted[side] = idle || (frame.stage == Stage::roll && swings);
    frame.toe_planted[side] = idle || !swings;
  }
  const bool landed = frame.stage == Stage::roll && state.tick == 1 && state.last_step_ticks > 0;
  if (landed) {
    ++frame.steps[frame.swing];
    frame.overhangs += !state.landing.fits;
  }
  frame.speed_m_s = 0.0;
  const int ticks = state.roll_ticks + state.flight_ticks;
  if (!idle && state.started && ticks > 0) {
    const int before = state.last_step_ticks > 0 ? state.last_step_ticks : ticks;
    frame.speed_m_s = (frame.stride_m[0] + frame.stride_m[1]) / ((ticks + before) * dt_s);
  }
}

}  // namespace

WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept {
  WalkState state;
  state.hips_m = vec3(place_m.x, 0.0, place_m.z);
  state.flight_height = {Damped<double>{1.0, 0.0}, Damped<double>{1.0, 0.0}};
  state.bounce.x = state.sway.x = 1.0;
  state.step_time_s.x = 0.5;
  for (Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    FootState& foot = state.foot[side];
    for (Damped<double>& w : state.weight[side]) w.x = 1.0;
    state.time_s[side] = 0.5;
    foot.heel_anchor_m = state.hips_m + vec3(leg.track_m, 0.0, -model.rest_lead_m);
    if (!is_flat(*model.terrain)) {
      foot.plane = standing_plane(model, side, foot.heel_anchor_m, 0.0);
      foot.heel_anchor_m = foot.plane.place_m;
      foot.pose.tilt = foot.plane.tilt;
    }
    foot.pose.heel_m = foot.heel_anchor_m;
    set_pitch(leg, 0.0, foot.pose, FootMode::roll);
    foot.toe_anchor_m = foot.pose.toe_m;
    foot.lift_m = foot.heel_anchor_m;
    remember_foot(foot);
    remember_foot(foot);
  }
  state.landing_m = state.foot[kLeftSide].heel_anchor_m;
  state.landing_plane = state.foot[kLeftSide].plane;
  state.base_m =
      std::min(state.foot[kLeftSide].plane.place_m.y, state.foot[kRightSide].plane.place_m.y);
  advance(model, GaitParams{}, IkMode::robust, 1.0 / 240.0, state, pose);
  return state;
}

void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept {
  const Tick tick = {model, params, dt_s, is_flat(*model.terrain)};
  smooth_parameters(tick, state);
  smooth_body(tick, mode, state);
  advance_clock(tick, state);
  plan_landing(tick, state);
  advance_hips(tick, state);
  for (Side side : {kLeftSide, kRightSide}) plan_foot(tick, state, side);
  Pelvis pelvis = pelvis_over_ground(model, state);
  pelvis.position_m.y = pelvis_height(model, state, pelvis);
  for (Side side : {kLeftSide, kRightSide}) {
    reach_with_toe(model, state, side, pelvis.hip(model.leg[side]));
    pose_leg(tick, mode, side, pelvis, state);
  }
  write_pose(model, state, pelvis, pose);
  report(pelvis, dt_s, state);
  report_ground(tick, state.frame);
  finish_stage(tick, state);
  for (FootState& foot : state.foot) remember_foot(foot);
}

}  // namespace gaitpad
