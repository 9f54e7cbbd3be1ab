// The part of a tick that every walk computes, for one walk or for several side by side (V: a
// double, or a register of several): smoothed parameters, landing place, tables of strides, hips
// and feet. Beginnings of stages, and the effects of terrain, are computed for one walk at a time
// (walk.cpp, walk_feet.cpp, walk_terrain.cpp).
//
// Walks side by side share a model and walk on flat ground. If their stages differ, the parts of a
// tick are computed for all of them and chosen by masks; a part that none of them is in is left
// out. Every lane gets the same bits as its walk alone.
#pragma once
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

// --- What is side by side ------------------------------------------------------------------------

template <class V>
inline V value(const MaskOf<V>& mask, const V& a, const V& b) noexcept {
  return mask ? a : b;
}
// Chooses one of two doubles, each the same for all lanes.
template <class V>
inline V value(const MaskOf<V>& mask, double a, double b) noexcept {
  return mask ? all_of<V>(a) : all_of<V>(b);
}

template <class V>
FootPoseOf<V> chosen_pose(const MaskOf<V>& mask, const FootPoseOf<V>& a,
                          const FootPoseOf<V>& b) noexcept {
  return {chosen(mask, a.heel_m, b.heel_m), chosen(mask, a.toe_m, b.toe_m),
          chosen(mask, a.yaw, b.yaw),       mask ? a.pitch_rad : b.pitch_rad,
          chosen(mask, a.edge, b.edge),     chosen(mask, a.rotation, b.rotation),
          mask ? a.toe_rad : b.toe_rad};
}
inline FootPose chosen_pose(bool mask, const FootPose& a, const FootPose& b) noexcept {
  return mask ? a : b;
}

// Copies the numbers of one walk into a lane, and back: both structs have the same numbers in the
// same order.
template <class One, class Several>
inline void set_lanes(const One& one, int lane, Several& several) noexcept {
  constexpr int kNumbers = sizeof(One) / sizeof(double), kLanes = sizeof(Several) / sizeof(One);
  static_assert(sizeof(Several) == kLanes * sizeof(One));
  const auto* from = reinterpret_cast<const double*>(&one);
  auto* to = reinterpret_cast<double*>(&several) + lane;
  for (int k = 0; k < kNumbers; ++k) to[k * kLanes] = from[k];
}
template <class One, class Several>
inline void get_lane(const Several& several, int lane, One& one) noexcept {
  constexpr int kNumbers = sizeof(One) / sizeof(double), kLanes = sizeof(Several) / sizeof(One);
  static_assert(sizeof(Several) == kLanes * sizeof(One));
  const auto* from = reinterpret_cast<const double*>(&several) + lane;
  auto* to = reinterpret_cast<double*>(&one);
  for (int k = 0; k < kNumbers; ++k) to[k] = from[k * kLanes];
}

inline ParamsOf<double> params_of(const GaitParams& params,
                                  const std::array<double, 2>& arm_swing) noexcept {
  ParamsOf<double> one;
  for (int side : {0, 1}) {
    one.length_m[side] = params.stride[side].length_m;
    one.flight_height[side] = params.stride[side].flight_height;
  }
  one.weight = params.weight;
  one.turn_rate_rad_s = params.turn_rate_rad_s;
  one.hip_sway = params.hip_sway;
  one.hip_bounce = params.hip_bounce;
  one.arm_swing = arm_swing;
  return one;
}

// --- The parameters, smoothed --------------------------------------------------------------------

// Time constants in seconds at the reference leg; they scale with pendulum time.
inline constexpr double kStepSmoothing = 0.12, kFirstStepSmoothing = 0.05;
inline constexpr double kFirstStep = 0.9;  // share of the asked length that a first step has
inline constexpr double kTurnGoalSmoothing = 0.02;
inline constexpr double kTurnSmoothing = 0.10;
inline constexpr double kBounceSmoothing = 0.30;
inline constexpr double kWeightSmoothing = 0.15;
inline constexpr double kLeanSmoothing = 0.12, kPostureSmoothing = 0.06;
inline constexpr double kGravity_m_s2 = 9.81, kLeastCycle_s = 0.2;
inline constexpr double kStillTurn = 1e-5;  // rad/s; a slower turn counts as straight ahead
// Largest swing beyond the data's that pace alone can give.
inline constexpr double kMostExtraSwing = 0.4;
inline constexpr double kLeastPace =
    0.5;  // pace below which the data's posture fades, and the swing with it

// Factor on the data's arm swing: proportional to speed (Boulic et al. 1990), bounded, and 1 at the
// data's own pace.
template <class V>
V pace_swing(const WalkModel& model, const GaitFlow<V>& gait) noexcept {
  const double own_s = model.body.own_step_s;
  const V quicker = own_s / max_of(gait.step_time_s.x, all_of<V>(0.25 * own_s));
  const V extra = max_of(gait.pace.x, all_of<V>(kLeastPace)) * quicker - 1.0;
  return 1.0 + (extra > V{} ? extra / (1.0 + extra / kMostExtraSwing) : extra);
}

template <class V>
void settle_still(const V& goal, Damped<V>& value_of) noexcept {
  const auto still = (goal == V{}) & (abs_of(value_of.x) < all_of<V>(kStillTurn));
  value_of.x = still ? V{} : value_of.x;
  value_of.v = still ? V{} : value_of.v;
}

template <class V>
Damped<V> chosen_damped(const MaskOf<V>& mask, const Damped<V>& a, const Damped<V>& b) noexcept {
  return {mask ? a.x : b.x, mask ? a.v : b.v};
}

template <class V>
void smooth_parameters(const Tick& tick, const MomentOf<V>& at, const ParamsOf<V>& params,
                       StateOf<V>& state) noexcept {
  GaitFlow<V>& gait = state.gait;
  const double scale = tick.model.time_scale, dt = tick.dt_s;
  // A walk that is about to end keeps its running step's length, also for the step that closes it.
  const Damping step(kStepSmoothing * scale, dt), first_step(kFirstStepSmoothing * scale, dt),
      weights(kWeightSmoothing * scale, dt), hips(kBounceSmoothing * scale, dt);
  for (int side : {0, 1}) {
    const V kept_m = value<V>(at.finishes, gait.length_m[side].x, V{});
    const V goal_m = value<V>(at.walking, params.length_m[side], kept_m);
    // In the first step the push still grows, so it is followed faster than in later steps.
    Damped<V> first = gait.length_m[side];
    first.advance(at.steps(static_cast<Side>(side)) ? kFirstStep * goal_m : goal_m, first_step);
    gait.length_m[side].advance(goal_m, step);
    gait.length_m[side] = chosen_damped<V>(at.starting, first, gait.length_m[side]);
    gait.flight_height[side].advance(params.flight_height[side], step);
    for (int j = 0; j < kLegDofs; ++j)
      gait.weight[side][j].advance(params.weight[side][j], weights);
  }
  gait.step_time_s.advance(0.5 * (gait.time_s[0] + gait.time_s[1]), step);
  const V turn = value<V>(at.walking, params.turn_rate_rad_s, V{});
  gait.turn_goal.advance(turn, Damping(kTurnGoalSmoothing * scale, dt));
  settle_still(turn, gait.turn_goal);
  gait.turn_rate.advance(gait.turn_goal.x, Damping(kTurnSmoothing * scale, dt));
  settle_still(gait.turn_goal.x, gait.turn_rate);
  gait.bounce.advance(params.hip_bounce, hips);
  gait.sway.advance(params.hip_sway, hips);
  const V mean = 0.5 * (gait.length_m[0].x + gait.length_m[1].x);
  gait.pace.advance(mean * gait.ground_share.x / tick.model.source_step_m, step);
  gait.posture.advance(within(V(2.0 * gait.pace.x), 0.0, 1.0),
                       Damping(kPostureSmoothing * scale, dt));
  // A lean of v w / g brings the weight over the edge of the standing foot, as on a bicycle.
  const V speed_m_s = (gait.length_m[0].x + gait.length_m[1].x) /
                      max_of(gait.time_s[0] + gait.time_s[1], all_of<V>(kLeastCycle_s));
  const V lean = speed_m_s * gait.turn_rate.x / kGravity_m_s2;
  const bool is_paper = tick.mode == IkMode::paper;
  state.path.lean_rad.advance(is_paper ? V{} : lean, Damping(kLeanSmoothing * scale, dt));
  // In paper mode the data's upper body is unchanged.
  const V pace = is_paper ? all_of<V>(1.0) : pace_swing(tick.model, gait);
  for (int side : {0, 1}) gait.arm_swing[side] = pace * params.arm_swing[side];
}

// The share of the data's oscillations and postures that shows: 0 at rest, 1 from half of the
// data's pace on.
template <class V>
V presence_of(const GaitFlow<V>& gait) noexcept {
  return within(gait.shown, 0.0, 1.0) * within(gait.posture.x, 0.0, 1.0);
}

// True for legs whose weights are not all 1.
template <class V>
MaskOf<V> has_weights(const GaitFlow<V>& gait, int side) noexcept {
  const V one = all_of<V>(1.0);
  MaskOf<V> uneven = gait.weight[side][0].x != one;
  for (int j = 1; j < kLegDofs; ++j) uneven = uneven | (gait.weight[side][j].x != one);
  return uneven;
}

// --- The strides' tables -------------------------------------------------------------------------

// The strides of each walk.
template <class V>
TablesOf<V> tables_of(const WalkModel& model, const MaskOf<V>& backward) noexcept {
  const StrideFamily& family = *model.cycle.strides;
  TablesOf<V> tables;
  for (int lane = 0; lane < kWidthOf<V>; ++lane)
    tables[lane] = is_set(backward, lane) ? &family.back : &family.table;
  return tables;
}

// The footprints of a stride of the character.
template <class V>
FootprintsOf<V> track_of(const WalkModel& model, const MaskOf<V>& backward,
                         const V& ratio) noexcept {
  const FootprintLine &forward = model.forward, &back = model.back;
  const V at = min_of(max_of(ratio, V{}), value<V>(backward, back.most_ratio, forward.most_ratio));
  FootprintsOf<V> track;
  constexpr int kNumbers = sizeof(Footprints) / sizeof(double);
  const auto numbers = [](const Footprints& from) {
    return reinterpret_cast<const double*>(&from);
  };
  auto* to = reinterpret_cast<V*>(&track);
  for (int k = 0; k < kNumbers; ++k)
    to[k] = value<V>(backward, numbers(back.at_zero)[k], numbers(forward.at_zero)[k]) +
            value<V>(backward, numbers(back.per_ratio)[k], numbers(forward.per_ratio)[k]) * at;
  return track;
}
// Length of the running step, relative to the step of the data that it follows.
template <class V>
V ratio_of_step(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state) noexcept {
  // In a cycle that is run back, a foot makes the step that the other one makes forwards.
  const V own_m = value<V>(at.right_steps != at.backward, model.own_step_m[kRightSide],
                           model.own_step_m[kLeftSide]);
  const V step_m =
      value<V>(at.right_steps, state.path.stride_m[kRightSide], state.path.stride_m[kLeftSide]);
  return at.started ? abs_of(step_m) / own_m : V{};
}
template <class V>
V ratio_ahead(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state) noexcept {
  // A closing step keeps the rest of the last ratio, and a step whose stop was withdrawn its own.
  return (at.closing | not_of(at.started))
             ? state.path.last_ratio
             : max_of(V{}, V(ratio_of_step<V>(model, at, state) + state.gait.off_ratio.x +
                             state.gait.off_ahead.x));
}

// A walk begins to count as limping at a difference of kEvenSteps between both feet's strides, and
// counts fully at kUnevenSteps.
inline constexpr double kEvenSteps = 0.03, kUnevenSteps = 0.2, kLeastAsked = 0.1;

// The additional height of a limp's heel. If one foot's steps are shorter than the other's, the
// tables of short strides would keep both feet low. So a heel flies as high as in strides in which
// both feet go as far as the longer one, and comes down as in the tables.
template <class V>
void raise_limping_heel(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                        const TablesOf<V>& tables, const KnotsOf<V>& knots, const V& ahead,
                        PlanOf<V>& plan) noexcept {
  const WalkModel& model = tick.model;
  plan.heel_up_m = plan.flying.heel_m.y;
  // Even styles ask for equal steps, or for the data's own, which may differ.
  std::array<V, 2> asked;
  std::array<V, 2> length_m;
  for (int side : {0, 1}) {
    const V own_m = value<V>(at.backward, model.own_step_m[1 - side], model.own_step_m[side]);
    length_m[side] = state.gait.length_m[side].x;
    asked[side] = length_m[side] / own_m;
  }
  const auto evenness = [](const std::array<V, 2>& of) {
    return V((min_of(of[0], of[1]) + kLeastAsked) / (max_of(of[0], of[1]) + kLeastAsked));
  };
  const V longer = max_of(asked[0], asked[1]);
  const V limps =
      smoothstep(kEvenSteps, kUnevenSteps, V(1.0 - max_of(evenness(asked), evenness(length_m)))) *
      smootherstep(V(at.flight_progress() / 0.2)) *
      (1.0 - smootherstep(V((at.flight_progress() - 0.5) / 0.4)));
  // A stop shortens one step as well, but does not limp.
  const auto is_limping = at.flies & not_of(at.stopping) & (limps != V{});
  if (!any(is_limping)) return;
  const V own = at.right_steps ? asked[kRightSide] : asked[kLeftSide];
  const Vec<V> heel_m =
      heel_at<V>(ratios_at<V>(tables, V(ahead * longer / max_of(own, all_of<V>(kLeastAsked)))),
                 knots, at.right_steps);
  const V high_m = max_of(plan.heel_up_m, V(model.stride_scale.length * heel_m.y));
  plan.heel_up_m = is_limping ? mix(plan.heel_up_m, high_m, limps) : plan.heel_up_m;
}

// The pelvis' height with a style's bounce. With more bounce the pelvis sinks deeper; with less it
// keeps its lowest height: in neither case a leg has to be longer.
template <class V>
V bounced(const StrideScale& scale, const GaitFlow<V>& gait, const PlanOf<V>& plan) noexcept {
  const V y = plan.cell.pelvis_m.y, more = gait.bounce.x - 1.0;
  const auto bounces = more != V{};
  if (!any(bounces)) return y;
  std::array<StrideTrackOf<V>, 2> track;
  for (int k : {0, 1}) track_at<V>(plan.ratios[k], track[k]);
  const auto of = [&](V StrideTrackOf<V>::*height) {
    return V(plan.shown * scale.length * mix(track[0].*height, track[1].*height, plan.change));
  };
  const V stays = more > V{} ? of(&StrideTrackOf<V>::high_m) : of(&StrideTrackOf<V>::low_m);
  return bounces ? y + more * (y - stays) : y;
}

template <class V>
Vec<V> direction_of(const V& heading_rad) noexcept {
  V sine, cosine;
  sin_cos_of(heading_rad, sine, cosine);
  return {sine, V{}, cosine};
}
template <class V>
Vec<V> side_of(const Vec<V>& forward) noexcept {
  return {forward.z, V{}, V{} - forward.x};
}

// Converts a point from the travel frame of a stride to the frame of a footprint of `side` in the
// running step: for the flying foot the footprint that it left (`which` 0) or will land on (1).
template <class V>
Vec<V> from_footprint(const MomentOf<V>& at, const FootprintsOf<V>& track, const V& phase,
                      Side side, int which, const Vec<V>& travel_m) noexcept {
  // The right foot goes from its footprint of this stride to the next one's, the left foot from the
  // last one's to this one's.
  const double turns_right = which, turns_left = which - 1;
  const V turns = at.steps(side) ? all_of<V>(side == kRightSide ? turns_right : turns_left) : V{};
  Vec<V> p = travel_m - track.footprint_m[side];
  p.z += track.stride_m * (phase - turns);
  return p;
}

// Turns a place so that its z axis points along `forward`.
template <class V>
Vec<V> turned(const Vec<V>& forward, const Vec<V>& p) noexcept {
  return {forward.z * p.x + forward.x * p.z, p.y, forward.z * p.z - forward.x * p.x};
}
// Turns a place on the ground so that its z axis points along `forward`.
template <class V>
Vec<V> over_ground(const Vec<V>& forward, const Vec<V>& p) noexcept {
  return {forward.z * p.x + forward.x * p.z, V{}, forward.z * p.z - forward.x * p.x};
}

// The hips' path in the strides of a track, without their oscillation: in the stride before, from
// the footprint of the standing foot; in this one, to the next landing.
template <class V>
LineOf<V> path_past(const Vec<V>& heel_m, const Vec<V>& forward, const Vec<V>& footprint_m,
                    const V& stride_m, const V& turns) noexcept {
  const Vec<V> along = forward * stride_m;
  return {heel_m - turned<V>(forward, footprint_m) - along * turns, along};
}
template <class V>
LineOf<V> path_from_standing(const MomentOf<V>& at, const StateOf<V>& state,
                             const FootprintsOf<V>& track, const Vec<V>& forward) noexcept {
  return path_past<V>(
      chosen(at.right_steps, state.foot[kLeftSide].heel_anchor_m,
             state.foot[kRightSide].heel_anchor_m),
      forward, chosen(at.right_steps, track.footprint_m[kLeftSide], track.footprint_m[kRightSide]),
      track.stride_m, V{});
}
template <class V>
LineOf<V> path_to_landing(const MomentOf<V>& at, const FootprintsOf<V>& track,
                          const Vec<V>& landing_m, const Vec<V>& forward) noexcept {
  return path_past<V>(
      landing_m, forward,
      chosen(at.right_steps, track.footprint_m[kRightSide], track.footprint_m[kLeftSide]),
      track.stride_m, value<V>(at.right_steps, 1.0, 0.0));
}

// Share of a first step after which all of the tables shows.
inline constexpr double kShownAfter = 0.55;

// The planned share of the tables: in the first step it grows, and in a stop it is the share of the
// way that is left to rest.
template <class V>
V planned_share(const MomentOf<V>& at, const V& step_share, const V& rest_ticks) noexcept {
  const V begins = at.starting ? smootherstep(V(step_share / kShownAfter)) : all_of<V>(1.0);
  const V ends = smootherstep(V(rest_ticks / at.closing_ticks));
  return (at.stopping & (at.closing | not_of(at.started))) ? ends : at.started ? begins : V{};
}
// The change from the stride behind (0) to the stride ahead (1): a first step has none behind, a
// closing step none ahead.
template <class V>
V planned_change(const MomentOf<V>& at, const V& step_share) noexcept {
  const V walks = at.starting ? all_of<V>(1.0) : smootherstep(step_share);
  return at.closing ? V{} : walks;
}

template <class V>
StrideFootOf<V> chosen_foot(const MaskOf<V>& mask, const StrideFootOf<V>& a,
                            const StrideFootOf<V>& b) noexcept {
  return {chosen(mask, a.heel_m, b.heel_m), mask ? a.pitch_rad : b.pitch_rad,
          mask ? a.twist_rad : b.twist_rad, mask ? a.roll_rad : b.roll_rad};
}

// If a step begins or ends at rest, its foot flies as in strides of its own length, which is half a
// stride's; a closing foot lands flat.
template <class V>
void plan_short_flight(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                       const TablesOf<V>& tables, const V& ahead, const V& phase,
                       PlanOf<V>& plan) noexcept {
  const WalkModel& model = tick.model;
  const auto& left = state.foot[kLeftSide];
  const auto& right = state.foot[kRightSide];
  const Vec<V> way =
      state.path.landing_m - chosen(at.right_steps, right.heel_anchor_m, left.heel_anchor_m);
  const V length_m = sqrt_of(V(way.x * way.x + way.z * way.z));
  const V ratio = length_m / (model.own_step_m[0] + model.own_step_m[1]);
  const RatiosOf<V> own = ratios_at<V>(tables, ratio), next = ratios_at<V>(tables, ahead);
  // Before lift-off, plan for the moment of lift-off.
  const V at_phase = at.flies ? phase : at.stage_end;
  const V u = at.flies ? at.flight_progress() : V{};
  const KnotsOf<V> knots = knots_at<V>(at_phase);
  StrideCellOf<V> cell;
  stride_between<V>(own, next, at.closing ? V{} : smootherstep(u), knots, cell);
  StrideFootOf<V> flying =
      chosen_foot<V>(at.right_steps, cell.foot[kRightSide], cell.foot[kLeftSide]);
  const V flat = at.closing ? 1.0 - smootherstep(u) : all_of<V>(1.0);
  flying.pitch_rad = flying.pitch_rad * flat;
  flying.twist_rad = flying.twist_rad * flat;
  flying.roll_rad = flying.roll_rad * flat;
  const Vec<V> heel_m = heel_at<V>(own, knots, at.right_steps);
  flying.heel_m = chosen(at.right_steps, scaled_heel<V>(model.stride_scale, heel_m, kRightSide),
                         scaled_heel<V>(model.stride_scale, heel_m, kLeftSide));
  const auto is_short = at.starting | at.closing;
  plan.short_track = track_of<V>(model, at.backward, ratio);
  plan.flying = chosen_foot<V>(is_short, flying, plan.flying);
  plan.heel_up_m = is_short ? flying.heel_m.y : plan.heel_up_m;
}

// The plan at a phase of the walk and a share of the running step's time.
template <class V>
void plan_stride(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state, const V& phase,
                 const V& step_share, PlanOf<V>& plan) noexcept {
  plan.phase = phase;
  plan.change = planned_change<V>(at, step_share) + state.gait.off_change.x;
  plan.shown = planned_share<V>(at, step_share, at.rest_ticks) + state.gait.off_shown.x;
  const KnotsOf<V> knots = knots_at<V>(phase);
  const V behind = state.gait.ratio_behind, ahead = ratio_ahead<V>(tick.model, at, state);
  const TablesOf<V> tables = tables_of<V>(tick.model, at.backward);
  plan.ratio_ahead = ahead;
  auto& ratios = plan.ratios = {ratios_at<V>(tables, behind), ratios_at<V>(tables, ahead)};
  plan.track = {track_of<V>(tick.model, at.backward, behind),
                track_of<V>(tick.model, at.backward, ahead)};
  const V left_rad = state.foot[kLeftSide].lift_yaw_rad,
          right_rad = state.foot[kRightSide].lift_yaw_rad;
  if (any(at.flies)) plan.lifted = direction_of<V>(at.right_steps ? right_rad : left_rad);
  plan.lands = direction_of<V>(state.path.landing_heading_rad);
  plan.hips_m[1] = path_to_landing<V>(at, plan.track[1], state.path.landing_m, plan.lands);
  if (any(at.led | at.strikes())) {
    const Vec<V> stands = direction_of<V>(at.right_steps ? left_rad : right_rad);
    plan.hips_m[0] = path_from_standing<V>(at, state, plan.track[0], stands);
  }
  const StrideScale& scale = tick.model.stride_scale;
  for (int k : {0, 1}) {
    plan.flying_m[k] = Vec<V>{};
    if (!any(at.flies)) continue;
    const Vec<V> heel_m = heel_at<V>(ratios[k], knots, at.right_steps);
    plan.flying_m[k] = chosen(at.right_steps, scaled_heel<V>(scale, heel_m, kRightSide),
                              scaled_heel<V>(scale, heel_m, kLeftSide));
  }
  stride_between<V>(ratios[0], ratios[1], plan.change, knots, plan.cell);
  scale_stride<V>(scale, plan.cell);
  // A flying foot always shows fully, even if only a share of the tables shows.
  const auto& feet = plan.cell.foot;
  plan.flying = chosen_foot<V>(at.right_steps, feet[kRightSide], feet[kLeftSide]);
  constexpr int kNumbers = sizeof(StrideCell) / sizeof(double);
  auto* to = reinterpret_cast<V*>(&plan.cell);
  for (int k = 0; k < kNumbers; ++k) to[k] = plan.shown * to[k];
  raise_limping_heel<V>(tick, at, state, tables, knots, ahead, plan);
  if (any(at.starting | at.closing))
    plan_short_flight<V>(tick, at, state, tables, ahead, phase, plan);
  plan.cell.pelvis_m.y = bounced<V>(scale, state.gait, plan);
}
// The plan of the present moment.
template <class V>
void plan_stride(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                 PlanOf<V>& plan) noexcept {
  plan_stride<V>(tick, at, state, at.phase, at.step_share(), plan);
}

// --- Hips and landing place ----------------------------------------------------------------------

// Lengths in metres at the reference leg.
// Share of the leg's length: the reach with a knee bent by 4 degrees.
inline constexpr double kReach = 0.9994;
// The reach in an unsteady walk, with a knee bent by 11 degrees.
inline constexpr double kUnsteadyReach = 0.997, kUnsteadySoft_m = 0.016;
inline constexpr double kSoftReach_m = 0.006, kKnown_m = 0.0015, kWiderReach = 0.6,
                        kWidest_m = 0.06;
// The most by which hips sink. A leg that would need more, as in a step that jumps while it turns,
// does not reach its foot.
inline constexpr double kMostSunk_m = 0.34, kSoftSunk_m = 0.12;
// Share of the flight after which the landing place is settled.
inline constexpr double kFreeze = 0.55;

// A power with a whole exponent of at least 0.
template <class V>
V power(double base, V exponent) noexcept {
  V result = all_of<V>(1.0);
  for (; any(exponent > V{}); base *= base) {
    const V half = floor_of(V(0.5 * exponent));
    result = exponent != 2.0 * half ? result * base : result;
    exponent = half;
  }
  return result;
}

// The heading n ticks ahead if the turn rate's goal does not change. The filter is a linear
// recurrence with the double eigenvalue q, so its error is e_k = (e_0 + c k) q^k, and the sum has a
// closed form.
template <class V>
V heading_ahead(const Tick& tick, const StateOf<V>& state, const V& n) noexcept {
  const V goal = state.gait.turn_goal.x, rate = state.gait.turn_rate.v;
  const double w = tick.dt_s / (kTurnSmoothing * tick.model.time_scale), q = 1.0 / (1.0 + w);
  const V e0 = state.gait.turn_rate.x - goal;
  const auto steady = (e0 == V{}) & (rate == V{});
  const V straight = state.path.heading_rad + goal * n * tick.dt_s;
  if (!any(not_of(steady))) return straight;
  const V e1 = e0 * (1.0 - w * w * q * q) + q * q * rate * tick.dt_s;
  const V c = e1 / q - e0, qn = power<V>(q, n);
  const V s0 = q * (1.0 - qn) / (1.0 - q);
  const V s1 = q * (1.0 - (n + 1.0) * qn + n * qn * q) / ((1.0 - q) * (1.0 - q));
  const V turning = state.path.heading_rad + (goal * n + e0 * s0 + c * s1) * tick.dt_s;
  return steady ? straight : turning;
}

// Signed length of that foot's step on level ground: negative backwards, 0 when closing a walk.
template <class V>
V step_length(const MomentOf<V>& at, const V& length_m) noexcept {
  const V signed_m = at.backward ? 0.0 - length_m : length_m;
  return at.closing ? V{} : signed_m;
}

// The angle by which the walk turns in the time of the running step.
template <class V>
V turn_ahead(const Tick& tick, const StateOf<V>& state, const MomentOf<V>& at) noexcept {
  return state.gait.turn_goal.x * (at.roll_ticks + at.flight_ticks) * tick.dt_s;
}

// Feet land on both sides of the path, which is an arc in a turn. In a turn on the spot they stand
// wider apart, and point to where the body will face. The way from one footprint to the next turns
// by kWayTurns of the turn between them.
inline constexpr double kWayTurns = 0.82;
inline constexpr double kInPlaceLength_m = 0.2, kFootAhead = 0.45;
inline constexpr double kWiderInTurns_s = 0.045, kWidestInTurns_m = 0.045, kStance_m = 0.105,
                        kLeastWider_m = 0.03;

template <class V>
void plan_landing(const Tick& tick, const MomentOf<V>& at, StateOf<V>& state) noexcept {
  const auto on_way = at.on_way();
  if (!any(on_way)) return;
  auto& path = state.path;
  const V ticks = at.ticks_to_strike() + 1.0, heading = heading_ahead<V>(tick, state, ticks);
  const Vec<V> standing = chosen(at.right_steps, state.foot[kLeftSide].heel_anchor_m,
                                 state.foot[kRightSide].heel_anchor_m);
  const Vec<V> to = direction_of<V>(heading);
  const V stands_rad =
      at.right_steps ? state.foot[kLeftSide].lift_yaw_rad : state.foot[kRightSide].lift_yaw_rad;
  const auto open = on_way & (at.replanned | (at.flight_progress() <= all_of<V>(kFreeze)));
  if (any(open)) {
    const double track_m[] = {tick.model.leg[0].track_m, tick.model.leg[1].track_m};
    const V length_m =
        step_length<V>(at, value<V>(at.right_steps, state.gait.length_m[kRightSide].x,
                                    state.gait.length_m[kLeftSide].x));
    const V lands_m = value<V>(at.right_steps, track_m[kRightSide], track_m[kLeftSide]),
            stands_m = value<V>(at.right_steps, track_m[kLeftSide], track_m[kRightSide]);
    // The path runs between the footprints on an arc, from the direction of the first to that of
    // the second.
    const V turn = heading - stands_rad, round = abs_of(state.gait.turn_goal.x);
    const V in_place = 1.0 - smoothstep(0.0, kInPlaceLength_m * tick.model.size, abs_of(length_m));
    const V outwards = value<V>(at.right_steps, -1.0, 1.0);
    const double size = tick.model.size;
    const V wider =
        mix(min_of(V(size * kWiderInTurns_s * round), all_of<V>(size * kWidestInTurns_m)),
            max_of(V(size * kStance_m - abs_of(lands_m)), all_of<V>(size * kLeastWider_m)) *
                min_of(round, all_of<V>(1.0)),
            in_place);
    const auto steps_on = not_of(at.closing);
    const V asides_m = lands_m + (steps_on ? outwards * max_of(wider, V{}) : V{});
    const V stood_m = stands_m - (steps_on ? outwards * state.path.wider_m : V{});
    const V lands_rad =
        heading + (steps_on ? in_place * kFootAhead * turn_ahead<V>(tick, state, at) : V{});
    const Vec<V> along = direction_of<V>(V(stands_rad + kWayTurns * turn)),
                 from = direction_of<V>(stands_rad);
    const V lead_m = in_place * tick.model.rest_lead_m;
    const Vec<V> across =
        side_of<V>(to) * asides_m - side_of<V>(from) * stood_m + (from - to) * lead_m;
    path.landing_heading_rad = open ? lands_rad : path.landing_heading_rad;
    path.landing_m = chosen(open, standing + along * length_m + across, path.landing_m);
    if constexpr (kAlone<V>) {
      const AskedStep& asked = path.asked;
      if (asked.is_taken && !at.closing) {
        path.landing_heading_rad = asked.heading_rad;
        path.landing_m = vec3(asked.heel_m.x, standing.y, asked.heel_m.z);
      }
    }
    path.next_wider_m = open ? (steps_on ? max_of(wider, V{}) : V{}) : path.next_wider_m;
    if constexpr (kAlone<V>) {
      if (!tick.flat) choose_foothold(tick, state, along, across);
    }
  }
  // The landing goes along the heading, which may still turn after the place is settled.
  const V step_m = dot_of(path.landing_m - standing, to);
  for (const Side side : {kLeftSide, kRightSide})
    path.stride_m[side] = (on_way & at.steps(side)) ? step_m : path.stride_m[side];
  if constexpr (kAlone<V>) {
    if (!tick.flat) follow_ground(tick, state);
  }
}

// The pelvis' place in the tables at a phase, between two ratios.
template <class V>
Vec<V> pelvis_between(const StrideScale& scale, const RatiosOf<V>& behind, const RatiosOf<V>& ahead,
                      const V& change, const V& phase) noexcept {
  PelvisCellOf<V> cell;
  stride_between<V>(behind, ahead, change, knots_at<V>(phase), cell);
  scale_pelvis<V>(scale, cell);
  return cell.pelvis_m;
}

// The pelvis' place in the stride ahead, on its way to the landing.
template <class V>
Vec<V> pelvis_to_landing(const StrideScale& scale, const PlanOf<V>& plan, const V& phase) noexcept {
  return plan.hips_m[1].at(phase) +
         over_ground<V>(plan.lands,
                        pelvis_between<V>(scale, plan.ratios[1], plan.ratios[1], V{}, phase));
}

// The hips' place. A step moves the hips from the path of the stride before it to its own. After a
// step in which they led they go on from where they are.
template <class V>
SmoothFade<Vec<V>> path_at_strike(const WalkModel& model, const MomentOf<V>& at,
                                  const StateOf<V>& state, const PlanOf<V>& plan) noexcept {
  const PathFlow<V>& path = state.path;
  const Vec<V> heading = direction_of<V>(path.heading_rad);
  V phase = at.stage_phase, rate = at.phase_rate;
  std::array<Vec<V>, 3> off;
  for (int k : {0, 1, 2}) {
    Vec<V> from = plan.hips_m[0].at(phase);
    if (any(at.was_led)) {
      const Vec<V> pelvis =
          pelvis_between<V>(model.stride_scale, plan.ratios[0], plan.ratios[0], V{}, phase);
      const Vec<V> goes = path.pelvis_m.x + path.pelvis_m.v * all_of<V>(k) +
                          path.pelvis_m.a * all_of<V>(0.5 * k * k);
      from = chosen(at.was_led, goes - over_ground<V>(heading, pelvis), from);
    }
    off[k] = from - plan.hips_m[1].at(phase);
    // A walk that stands has no ticks left in its stage.
    const V left = max_of(V(at.stage_ticks - double(k)), all_of<V>(1.0));
    approach(phase, rate, at.stage_end, at.end_rate, left, 1.0);
  }
  return {off[0], 0.5 * (4.0 * off[1] - 3.0 * off[0] - off[2]), off[0] - 2.0 * off[1] + off[2]};
}

template <class V>
SmoothFade<Vec<V>> chosen_fade(const MaskOf<V>& mask, const SmoothFade<Vec<V>>& a,
                               const SmoothFade<Vec<V>>& b) noexcept {
  return {chosen(mask, a.x, b.x), chosen(mask, a.v, b.v), chosen(mask, a.a, b.a)};
}

// Moves the hips along the tables' path to the next landing. Their offset from the path, which
// comes from the step before or from a landing that has moved, fades until the strike.
template <class V>
void advance_hips(const Tick& tick, const MomentOf<V>& at, StateOf<V>& state,
                  const PlanOf<V>& plan) noexcept {
  if constexpr (kAlone<V>) {
    if (!tick.flat) advance_base(tick, state);
  }
  PathFlow<V>& path = state.path;
  const auto on_way = at.on_way();
  if (!any(on_way)) return;
  const Vec<V> before = path.hips_m;
  const Vec<V> to = plan.hips_m[1].at(plan.phase);
  const V ratio = plan.ratio_ahead;
  SmoothFade<Vec<V>> off = path.off_m;
  const auto strikes = on_way & at.strikes();
  const auto differs = [](const Vec<V>& a, const Vec<V>& b) {
    return (a.x != b.x) | (a.y != b.y) | (a.z != b.z);
  };
  const MaskOf<V> moved =
      on_way & not_of(strikes) &
      (differs(path.landing_m, path.last_landing_m) | (ratio != path.last_ratio) |
       (path.landing_heading_rad != path.last_heading_rad));
  if (any(moved)) {
    // The path has moved, but the hips have not.
    const FootprintsOf<V> last = track_of<V>(tick.model, at.backward, path.last_ratio);
    const Vec<V> was =
        path_to_landing<V>(at, last, path.last_landing_m, direction_of<V>(path.last_heading_rad))
            .at(plan.phase);
    off.x = chosen(moved, off.x + (was - to), off.x);
  }
  if (any(strikes))
    off = chosen_fade<V>(strikes, path_at_strike<V>(tick.model, at, state, plan), off);
  const V ticks = at.ticks_to_strike() + 1.0;
  off.move(ticks);
  off = chosen_fade<V>(ticks > all_of<V>(1.0), off, SmoothFade<Vec<V>>{});
  path.last_landing_m = chosen(on_way, path.landing_m, path.last_landing_m);
  path.last_heading_rad = on_way ? path.landing_heading_rad : path.last_heading_rad;
  path.last_ratio = on_way ? ratio : path.last_ratio;
  path.off_m = chosen_fade<V>(on_way, off, path.off_m);
  Vec<V> hips = to + off.x;
  hips.y = V{};
  path.hips_m = chosen(on_way, hips, before);
}

// --- The hips lead, the phase follows ------------------------------------------------------------

// While a walk begins, ends, or changes its pace, the pelvis moves along a quintic: from its place,
// rate and acceleration to its place in the tables at the coming strike, or to rest. The tables are
// read at the phase at which the pelvis is there in the tables, so that at every tick the posture
// is that of a steady walk with its hips at that place: a start is the second half of a step, a
// stop the first half.

inline constexpr double kPhaseStep = 1e-3, kAimTicks = 4.0, kMostBend_m_s2 = 15.0;
// The cost of a phase that is a cycle off the clock, as the distance of the hips from their place
// (metres at the reference leg) that costs the same. It keeps heights in time with the landing.
inline constexpr double kGoesSomewhere =
    0.2;  // share of the data's stride; the phase of a shorter one follows the clock
inline constexpr double kInTime_m = 1.2, kLeastWay_m2 = 0.02;
// Phases before and after the step's own that are searched.
inline constexpr double kBeforeStep = 0.1, kAfterStep = 0.14;
inline constexpr int kPhaseTries = 6, kFewTries = 2;
inline constexpr double kFastestPhase = 2.5;  // greatest rate of the phase relative to the clock's

// Moves the pelvis by one tick.
template <class V>
void move_pelvis(const WalkModel& model, const MomentOf<V>& at, StateOf<V>& state,
                 const PlanOf<V>& plan) noexcept {
  PathFlow<V>& path = state.path;
  Vec<V> place = path.rest_m, rate{}, bend{};
  V ticks = at.rest_ticks + 1.0;
  const auto strides = at.led & not_of(at.stopping);
  if (any(strides)) {
    std::array<Vec<V>, 3> around;
    const V step = kAimTicks * at.strike_rate;
    for (int k : {0, 1, 2})
      around[k] =
          pelvis_to_landing<V>(model.stride_scale, plan, V(at.strike_phase + double(k - 1) * step));
    place = chosen(strides, around[1], place);
    rate = chosen(strides, (around[2] - around[0]) * all_of<V>(0.5 / kAimTicks), rate);
    bend = chosen(strides,
                  (around[2] - around[1] * all_of<V>(2.0) + around[0]) *
                      all_of<V>(0.5 / (kAimTicks * kAimTicks)),
                  bend);
    ticks = strides ? at.ticks_to_strike() + 1.0 : ticks;
  }
  const auto goal = [&](const V& left) {
    return SmoothFade<Vec<V>>{place - rate * left + bend * (0.5 * left * left), rate - bend * left,
                              bend};
  };
  const SmoothFade<Vec<V>> was = goal(ticks), is = goal(V(ticks - 1.0));
  const SmoothFade<Vec<V>>& pelvis = path.pelvis_m;
  SmoothFade<Vec<V>> off{pelvis.x - was.x, pelvis.v - was.v, pelvis.a - was.a};
  off.move(max_of(ticks, all_of<V>(1.0)));
  off = chosen_fade<V>(ticks > all_of<V>(1.0), off, SmoothFade<Vec<V>>{});
  path.pelvis_m = chosen_fade<V>(at.led, {is.x + off.x, is.v + off.v, is.a + off.a}, pelvis);
}

// The phase at which the pelvis in the tables is where the pelvis is now.
template <class V>
V phase_of_pelvis(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state,
                  const PlanOf<V>& plan, V& rate) noexcept {
  const PathFlow<V>& path = state.path;
  const auto along = [&](const Vec<V>& p) { return V(p.x * plan.lands.x + p.z * plan.lands.z); };
  const auto both = [&](Vec<V> LineOf<V>::*of) {
    return mix(along(plan.hips_m[0].*of), along(plan.hips_m[1].*of), plan.change);
  };
  const V at_zero = both(&LineOf<V>::at_zero_m), per_phase = both(&LineOf<V>::per_phase_m);
  const auto by_tables = [&](const V& p) {
    const Vec<V> pelvis =
        pelvis_between<V>(model.stride_scale, plan.ratios[0], plan.ratios[1], plan.change, p);
    return V(at_zero + per_phase * p + pelvis.z);
  };
  const V wanted = along(path.pelvis_m.x);
  const double least = kLeastWay_m2 * model.size * model.size,
               time = kInTime_m * kInTime_m * model.size * model.size;
  const V goes = smoothstep(0.0, kGoesSomewhere, plan.ratio_ahead);
  const V in_time = (at.starting | at.closing) ? V(time * (1.0 - goes)) : all_of<V>(time);
  const V low = at.step_phase - kBeforeStep, high = at.strike_phase + kAfterStep;
  // Counts the phase from the running step's own strike; it may be far behind the clock.
  V phase = state.gait.phase - state.gait.off_phase.x;
  phase = phase - floor_of(V(phase - 0.5 * (low + high) + 0.5));
  phase = min_of(max_of(phase, low), high);
  const auto all_tries = at.replanned | at.strikes();
  const V last = phase;
  for (int n = 0; n < (any(all_tries) ? kPhaseTries : kFewTries); ++n) {
    const V here = by_tables(phase), slope = (by_tables(V(phase + kPhaseStep)) - here) / kPhaseStep;
    const V step = ((here - wanted) * slope + in_time * (phase - at.phase)) /
                   (slope * slope + in_time + least);
    const V next = min_of(max_of(V(phase - step), low), high);
    const V moves = (along(path.pelvis_m.v) * slope + in_time * at.phase_rate) /
                    (slope * slope + in_time + least);
    const auto tries = all_tries | (all_of<V>(n) < all_of<V>(kFewTries));
    phase = tries ? next : phase;
    rate = tries ? moves : rate;
  }
  // The phase cannot be found from hips that hardly move, so its rate is bounded.
  const V most = kFastestPhase * at.strike_rate;
  return all_tries ? phase : min_of(max_of(phase, V(last - most)), V(last + most));
}

// Reads the tables again at another phase; the flying foot follows the clock.
template <class V>
void read_at(const WalkModel& model, const StateOf<V>& state, const MaskOf<V>& where,
             const V& phase, PlanOf<V>& plan) noexcept {
  StrideCellOf<V> cell;
  stride_between<V>(plan.ratios[0], plan.ratios[1], plan.change, knots_at<V>(phase), cell);
  scale_stride<V>(model.stride_scale, cell);
  constexpr int kNumbers = sizeof(StrideCell) / sizeof(double);
  const auto* from = reinterpret_cast<const V*>(&cell);
  auto* to = reinterpret_cast<V*>(&plan.cell);
  for (int k = 0; k < kNumbers; ++k) to[k] = where ? V(plan.shown * from[k]) : to[k];
  const V bounces = bounced<V>(model.stride_scale, state.gait, plan);
  plan.cell.pelvis_m.y = where ? bounces : plan.cell.pelvis_m.y;
}

// Fades the offset that a changed plan left: `value` now, by the plan `planned` with its rate.
template <class V>
void carry_over(const MaskOf<V>& changed, const V& value, const V& rate, const V& planned,
                const V& planned_rate, SmoothFade<V>& off) noexcept {
  off.x = changed ? value + rate - planned : off.x;
  off.v = changed ? rate - planned_rate : off.v;
  off.a = changed ? V{} : off.a;
}

// The pelvis' place in this tick, and the phase for it.
template <class V>
void lead_hips(const Tick& tick, MomentOf<V>& at, StateOf<V>& state, PlanOf<V>& plan) noexcept {
  PathFlow<V>& path = state.path;
  GaitFlow<V>& gait = state.gait;
  const Vec<V> heading = direction_of<V>(path.heading_rad),
               by_tables = path.hips_m + over_ground<V>(heading, plan.cell.pelvis_m);
  const Vec<V> last = path.pelvis_m.x;
  const auto off_clock = at.led | (gait.off_phase.x != V{}) | at.replanned;
  V phase = at.phase, rate = at.phase_rate;
  if (any(at.led)) {
    move_pelvis<V>(tick.model, at, state, plan);
    V moves{};
    const V found = phase_of_pelvis<V>(tick.model, at, state, plan, moves);
    phase = (at.led & at.started) ? found : phase;
    rate = (at.led & at.started) ? moves : rate;
    // While the hips come to rest over both feet, the data's phase stays the same.
    const auto settles = at.led & not_of(at.started);
    phase = settles ? gait.phase - gait.off_phase.x : phase;
    rate = settles ? V{} : rate;
  }
  // If the hips do not lead, the pelvis takes the tables' place; its velocity and acceleration are
  // differences of the last places.
  const Vec<V> moved = by_tables - last, before = last - path.last_pelvis_m;
  // Bounded, because the path moves if a landing jumps to another tread.
  const double most = kMostBend_m_s2 * tick.dt_s * tick.dt_s;
  Vec<V> bend = moved - before;
  bend = bend * min_of(V(most / max_of(length_of(bend), all_of<V>(most))), all_of<V>(1.0));
  path.pelvis_m = chosen_fade<V>(
      at.led, path.pelvis_m, {by_tables, moved * all_of<V>(1.5) - before * all_of<V>(0.5), bend});
  path.last_pelvis_m = last;
  if (!any(off_clock)) {
    gait.phase = at.phase;
    gait.phase_rate = at.phase_rate;
    return;
  }
  const V lasts = gait.phase - floor_of(V(gait.phase - phase + 0.5));
  carry_over<V>(at.replanned, lasts, gait.phase_rate, phase, rate, gait.off_phase);
  phase = phase + gait.off_phase.x;
  const V goes = at.replanned ? rate + gait.off_phase.v : phase - lasts;
  gait.phase_rate = off_clock ? goes : at.phase_rate;
  gait.phase = off_clock ? phase : at.phase;
  read_at<V>(tick.model, state, off_clock, phase, plan);
  at.phase = off_clock ? phase : at.phase;
  const Vec<V> off = over_ground<V>(heading, plan.cell.pelvis_m);
  path.hips_m = chosen(at.led, path.pelvis_m.x - off, path.hips_m);
}

// Advances the offsets that changed plans have left.
template <class V>
void fade_changes(const MomentOf<V>& at, const V& step_share, const V& share_a_tick,
                  GaitFlow<V>& gait) noexcept {
  const V share = planned_share<V>(at, step_share, at.rest_ticks),
          next_share = planned_share<V>(at, V(step_share + share_a_tick), V(at.rest_ticks - 1.0)),
          change = planned_change<V>(at, step_share),
          next_change = planned_change<V>(at, V(step_share + share_a_tick));
  const auto lasts = gait.off_ticks > all_of<V>(1.0);
  for (SmoothFade<V>* off : {&gait.off_shown, &gait.off_change, &gait.off_phase}) {
    SmoothFade<V> moved = *off;
    moved.move(max_of(gait.off_ticks, all_of<V>(1.0)));
    off->x = lasts ? moved.x : V{};
    off->v = lasts ? moved.v : V{};
    off->a = lasts ? moved.a : V{};
  }
  SmoothFade<V> ahead = gait.off_ahead;
  ahead.move(max_of(gait.off_ticks, all_of<V>(1.0)));
  gait.off_ahead.x = at.replanned ? gait.off_ahead.x : lasts ? ahead.x : V{};
  gait.off_ahead.v = at.replanned ? gait.off_ahead.v : lasts ? ahead.v : V{};
  gait.off_ahead.a = at.replanned ? gait.off_ahead.a : lasts ? ahead.a : V{};
  gait.off_ticks = max_of(V(gait.off_ticks - 1.0), V{});
  if (any(at.replanned)) {
    carry_over<V>(at.replanned, gait.shown, gait.shown_rate, share, V(next_share - share),
                  gait.off_shown);
    // At a strike the stride that was reached becomes the stride behind; a first step has none.
    const auto first = at.starting & at.strikes();
    const V last = at.strikes() ? V{} : gait.change;
    carry_over<V>(at.replanned, first ? change : last, at.strikes() ? V{} : gait.change_rate,
                  change, V(next_change - change), gait.off_change);
    gait.off_ticks = at.replanned ? at.fade_ticks : gait.off_ticks;
  }
  const V shown = share + gait.off_shown.x, changed = change + gait.off_change.x;
  gait.shown_rate = at.replanned ? next_share - share + gait.off_shown.v : shown - gait.shown;
  const auto refits = at.replanned | at.strikes();
  gait.change_rate = refits ? next_change - change + gait.off_change.v : changed - gait.change;
  gait.shown = shown;
  gait.change = changed;
}

// --- What is not steady does not jump ------------------------------------------------------------

// Time constants at the reference leg: a walk becomes unsteady in kUnsteady_s and steady again in
// kSteady_s; planned values that may not jump return to their plan in the other times.
inline constexpr double kUnsteady_s = 0.10, kSteady_s = 0.3, kEases_s = 0.12, kHeaveEases_s = 0.07,
                        kRises_s = 0.05;
// Bounds of second differences over time, and for the heel of their growth: a flying foot brakes
// harder in every step than a pelvis is allowed to.
inline constexpr double kMostHeave_m_s2 = 45.0, kMostHeel_m_s3 = 7000.0, kMostPitch_s2 = 300.0,
                        kMostEdge_s2 = 150.0;
inline constexpr double kLeastFade = 6.0;  // ticks; a shorter fade would be a jump

inline double size_of(double x) noexcept { return abs_of(x); }
template <class V>
V size_of(const V& x) noexcept {
  return abs_of(x);
}
template <class V>
V size_of(const Vec3Of<V>& x) noexcept {
  return length_of(x);
}
inline double size_of(const vec3& x) noexcept { return length_of(x); }

// Follows a goal. While the walk is not steady the second difference is at most `most` or, if
// `grows` is not 0, exceeds that of the last tick by at most `grows`. The remaining offset from the
// goal is gone after `lasts` ticks. In a steady walk the result is the goal itself.
template <class V, class T>
T ease(const T& goal, double most, double grows, const V& lasts, const V& unsteady,
       EasedOf<T, V>& eased) noexcept {
  const MaskOf<V> runs = eased.ticks > all_of<V>(1.0);
  const MaskOf<V> eases = (unsteady > V{}) & (lasts > all_of<V>(kLeastFade));
  if (!any(runs | eases)) return goal;
  SmoothFade<T> off = eased.off;
  const V left = min_of(eased.ticks, lasts);
  off.move(max_of(left, all_of<V>(1.0)));
  const auto fades = runs & (left > all_of<V>(1.0));
  off = {chosen(fades, off.x, T{}), chosen(fades, off.v, T{}), chosen(fades, off.a, T{})};
  const T bend = goal + off.x - eased.value - eased.rate;
  const V size = size_of(bend),
          grown = max_of(all_of<V>(most), grows > 0.0 ? V(size_of(eased.bend) + grows) : V{});
  const auto clamps = eases & (size > grown);
  const T less = bend * V((clamps ? grown / size : all_of<V>(1.0)) - 1.0);
  off.x = off.x + less;
  off.v = off.v + less;
  eased.off = off;
  eased.ticks = clamps ? lasts : max_of(V(left - 1.0), V{});
  return chosen(runs | clamps, goal + off.x, goal);
}
// The value in this tick.
template <class T, class V>
void keep(const T& value, EasedOf<T, V>& eased) noexcept {
  const T rate = value - eased.value;
  eased.bend = rate - eased.rate;
  eased.rate = rate;
  eased.value = value;
}

// The share of the walk that is not steady: it rises while hips lead and in the step after that.
template <class V>
void advance_unsteady(const Tick& tick, const MomentOf<V>& at, PathFlow<V>& path) noexcept {
  const double scale = tick.model.time_scale;
  const V step = value<V>(at.led | at.was_led | at.replanned, tick.dt_s / (kUnsteady_s * scale),
                          -tick.dt_s / (kSteady_s * scale));
  if (tick.mode != IkMode::paper) path.unsteady = within(V(path.unsteady + step), 0.0, 1.0);
}

// --- Feet: their place, direction and pitch ------------------------------------------------------

// A flying toe may be lower by kMostSink_m than when it stands, so the tables' own toes, which
// hardly leave the floor, are not changed.
inline constexpr double kMostSink_m = 0.0015, kSoftPitch = 0.4 * kDegree, kWiderPitch = 0.25;
// Share of the foot's own phase at which the heel may rise, and how long the rise lasts.
inline constexpr double kRiseBegin = 0.20, kHeelRiseLasts = 0.18;
inline constexpr double kReachOnToe =
    0.99995;  // share of the leg's length; if the hip is farther away, the heel rises
// A foot whose heel stays low rises when its leg would be longer than kLowReach of its length
// although the hips are lower by kLowHips_m.
inline constexpr double kLowHips_m = 0.045, kLowSmoothing = 0.03, kLowUntil = 0.25,
                        kLowRisen = 45.0 * kDegree, kLowReach = 0.985, kSoftRise = 12.0 * kDegree;
inline constexpr double kMostUpright = 0.99, kSoftUpright = 0.12;
inline constexpr double kMaxPitch = 85.0 * kDegree, kWidePitch = 25.0 * kDegree;
// A foot that goes far up is lifted less: the way over the riser lifts it enough, and the knee can
// only fold to its limit.
inline constexpr double kLiftUp = 0.5, kHighUp = 0.2, kHighestUp = 0.345;
// Share of the flight after which the lift-off's own motion has faded.
inline constexpr double kLiftFade = 0.5;
inline constexpr double kRollEnd = 0.9;  // share of the roll at which the toe is down
inline constexpr double kInPlaceStride_m = 0.02, kLikeAStep = 0.4, kWalksFrom = 0.3;
inline constexpr double kSoftFloor_m = 0.02, kFirstLift_m = 0.03, kLastLift_m = 0.025,
                        kEdgeGoes = 0.4;
// Share of a changed flight from which on the floor is soft.
inline constexpr double kSoftFrom = 0.3;
// kHeelStays: share of the first roll in which the heel stays down. kFirstPitch: share of the
// tables' pitch at the lift-off.
inline constexpr double kHeelStays = 0.25, kFirstPitch = 0.8;
inline constexpr double kEdgeUp = 0.25,
                        kEdgeDown = 0.9;    // shares of the flight between which soles clear the
                                            // floor
inline constexpr double kLiftGround = 0.5;  // share of the flight until which the plane of the
                                            // lift-off bounds the toe
inline constexpr double kLowPitch = 0.5;  // share of the flight until which a low foot pitches less
// Shares of the flight. A style's factor on the height acts fully between kLiftGrown and
// kLiftFalls.
inline constexpr double kLiftGrown = 0.4, kLiftFalls = 0.5, kLiftEnds = 0.85;

// The freedom of a standing foot to lift its heel off the floor: 0 none .. 1 full.
template <class V>
V heel_rise(const WalkModel& model, const MomentOf<V>& at, Side side) noexcept {
  const double strike = side == kRightSide ? 0.0 : model.share[0] + model.share[1];
  const V p = at.phase - strike, own = p - floor_of(p);
  const double begin = std::max(kRiseBegin, model.share[side == kRightSide ? 0 : 2]);
  // The heel rises after the roll, and less while a walk comes to rest.
  const V rises = smoothstep(begin, begin + kHeelRiseLasts, own),
          left = smootherstep(V(at.rest_ticks / at.closing_ticks));
  const auto rests = at.stopping & (not_of(at.started) | (at.closing & not_of(at.steps(side))));
  return rests ? rises * left : at.on_way() ? rises : V{};
}

template <class V>
Quat<V> edge_of(const LegBuild& leg, const V& twist_rad, const V& roll_rad) noexcept {
  return rotation_by_vector<V>(all_of<V>(kUp) * twist_rad + all_of<V>(leg.forward) * roll_rad);
}

// The foot's segment rotation, world.
template <class V>
Quat<V> foot_rotation(const LegBuild& leg, const PoseOf<V>& pose) noexcept {
  const Quat<V> level =
      pose.yaw * (rotation_about_axis<V>(all_of<V>(leg.side), pose.pitch_rad) * pose.edge);
  if constexpr (kAlone<V>) {
    return pose.tilt * level;
  } else {
    return level;
  }
}

// The toes' rotation from their foot: bent by `toe_rad`, and level across even if the foot rolls.
template <class V>
Quat<V> toes_turn(const LegBuild& leg, const PoseOf<V>& pose, const V& toe_rad) noexcept {
  return conjugate_of(pose.edge) * rotation_about_axis<V>(all_of<V>(leg.side), toe_rad);
}

// Turns a foot about its pivot: the toe in support, else the heel.
template <class V>
void set_pitch(const LegBuild& leg, const V& pitch_rad, const MaskOf<V>& on_toe,
               PoseOf<V>& pose) noexcept {
  pose.pitch_rad = pitch_rad;
  pose.rotation = foot_rotation<V>(leg, pose);
  const Vec<V> line = pose.rotation * all_of<V>(leg.model.toe_m - leg.model.heel_m);
  const Vec<V> heel = pose.toe_m - line, toe = pose.heel_m + line;
  pose.heel_m = chosen(on_toe, heel, pose.heel_m);
  pose.toe_m = chosen(on_toe, pose.toe_m, toe);
}

// The factor by which twist and roll make the line from heel to toe steeper.
template <class V>
V rolled_elevation(const LegBuild& leg, const PoseOf<V>& pose) noexcept {
  const Vec<V> line = pose.edge * all_of<V>(leg.model.toe_m - leg.model.heel_m);
  return atan2_of(line.y, dot_of(line, all_of<V>(leg.forward))) - leg.elevation_rad;
}

// The largest pitch at which the toe, with the heel at this height, is `clearance_m` above its
// height at rest.
template <class V>
V highest_pitch(const LegBuild& leg, const V& heel_m, const V& clearance_m) noexcept {
  const V low = (leg.model.toe_rest_m + clearance_m - heel_m) / leg.foot_m;
  return leg.elevation_rad - asin_of(within(low, -1.0, 1.0));
}

// The factor on a rising heel's height, at most 1: a limping style keeps its foot low.
template <class V>
V low_lift(const StateOf<V>& state, Side side) noexcept {
  return min_of(state.gait.flight_height[side].x, all_of<V>(1.0));
}

// The foot's pitch in the tables, reduced if its heel is to rise less.
template <class V>
V table_pitch(const MomentOf<V>& at, const StateOf<V>& state, const PlanOf<V>& plan,
              Side side) noexcept {
  // The standing foot has not landed when a walk begins, so its toe is down.
  const auto stands = at.in_roll[side] & (at.last_step_ticks == V{});
  const V own = at.in_flight[side] ? plan.flying.pitch_rad : plan.cell.foot[side].pitch_rad;
  V pitch = (at.started & not_of(stands)) ? own : V{};
  const auto begins = at.starting & at.rolls & at.steps(side);
  if (any(begins)) {
    const V lifts = smootherstep(V((at.tick / at.stage_ticks - kHeelStays) / (1.0 - kHeelStays)));
    pitch = begins ? kFirstPitch * plan.flying.pitch_rad * lifts : pitch;
  }
  // The foot in front stays flat while the other one closes.
  const auto flat =
      at.closing & not_of(at.in_flight[side]) & not_of(at.in_roll[side]) & not_of(at.steps(side));
  pitch = flat ? V{} : pitch;
  // If the hips lead, the toe of the foot that has landed is down when the other foot lifts off.
  const auto stops = at.in_roll[side] & at.led;
  if (any(stops)) {
    const V down = (at.tick - at.led_from) / (kRollEnd * (at.stage_ticks - at.led_from));
    pitch = stops ? pitch * (1.0 - smootherstep(down)) : pitch;
  }
  const V low = low_lift<V>(state, side);
  const auto is_low = not_of(at.in_roll[side]) & (low != all_of<V>(1.0));
  if (!any(is_low)) return pitch;
  const V u = at.in_flight[side] ? at.flight_progress() : V{};
  return is_low ? pitch * mix(low, 1.0, smootherstep(V(u / kLowPitch))) : pitch;
}

// The share of the tables' twist and roll that a foot on the ground has: a standing foot is flat,
// and a closing one lands flat.
template <class V>
V on_its_edges(const MomentOf<V>& at, Side side) noexcept {
  const V fading =
      (at.idle | at.in_roll[side]) ? V{} : 1.0 - smootherstep(V(at.tick / at.stage_ticks));
  return at.started ? all_of<V>(1.0) : fading;
}

// The place of a foot that starts from rest or comes to rest, between its footprint and the next
// one: at the same share of the way as in strides of that length.
template <class V>
Vec<V> short_flight(const MomentOf<V>& at, const StateOf<V>& state, const PlanOf<V>& plan,
                    Side side, const V& u) noexcept {
  const auto& foot = state.foot[side];
  const PathFlow<V>& path = state.path;
  const FootprintsOf<V>& track = plan.short_track;
  const Vec<V> ahead = from_footprint<V>(at, track, plan.phase, side, 1, plan.flying.heel_m);
  const auto in_place = abs_of(track.stride_m) < all_of<V>(kInPlaceStride_m);
  const V gone =
      in_place ? smootherstep(u) : 1.0 + ahead.z / (in_place ? all_of<V>(1.0) : track.stride_m);
  return foot.heel_anchor_m + (path.landing_m - foot.heel_anchor_m) * gone +
         side_of<V>(plan.lands) * ahead.x;
}

// The height added to the heel of a foot that starts from rest or comes to rest: 0 at the ends of
// its flight and greatest in its middle, so that the toe leaves the floor at once.
template <class V>
V short_lift(const WalkModel& model, const MomentOf<V>& at, const V& u) noexcept {
  const V x = 1.0 - u;
  const V high_m = value<V>(at.starting, kFirstLift_m, kLastLift_m);
  return model.size * high_m * 16.0 * (u * u) * (x * x);
}

// The place of the heel, and the height of the ground line below it: on the tables' path from the
// footprint that the foot left to that where it lands. If both strides have equal steps, both give
// the same place.
template <class V>
Vec<V> flight_heel(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                   const PlanOf<V>& plan, Side side, const V& u, V& base_m) noexcept {
  const auto& foot = state.foot[side];
  const PathFlow<V>& path = state.path;
  const V gone = smootherstep(u);
  const Vec<V> from_old =
                   from_footprint<V>(at, plan.track[0], plan.phase, side, 0, plan.flying_m[0]),
               from_next =
                   from_footprint<V>(at, plan.track[1], plan.phase, side, 1, plan.flying_m[1]);
  Vec<V> p = (foot.heel_anchor_m + turned<V>(plan.lifted, from_old)) * (1.0 - gone) +
             (path.landing_m + turned<V>(plan.lands, from_next)) * gone;
  const auto is_short = at.starting | at.closing;
  if (any(is_short)) {
    // Before it lands, the foot of a first step flies as in a steady walk.
    const V lands =
        at.starting ? kLikeAStep * smootherstep(V((u - kWalksFrom) / (1.0 - kWalksFrom))) : V{};
    const Vec<V> short_m = short_flight<V>(at, state, plan, side, u),
                 walks = path.landing_m + turned<V>(plan.lands, from_next);
    p = chosen(is_short, short_m * (1.0 - lands) + walks * lands, p);
  }
  // The heel goes along an arc: the chord would lead through the standing leg, and a mix of both
  // directions would lead far outwards.
  const V turns = path.landing_heading_rad - foot.lift_yaw_rad;
  if (any(turns != V{})) {
    const Vec<V> way = path.landing_m - foot.heel_anchor_m;
    const V square = way.x * way.x + way.z * way.z,
            share = within(
                V(((p.x - foot.heel_anchor_m.x) * way.x + (p.z - foot.heel_anchor_m.z) * way.z) /
                  max_of(square, all_of<V>(1e-6))),
                0.0, 1.0);
    const Vec<V> left = side_of<V>(direction_of<V>(V(foot.lift_yaw_rad + 0.5 * turns)));
    const V arc = share * (1.0 - share), mixed = (1.0 - gone) * share + gone * (1.0 - share);
    const V out = is_short ? arc : arc - mixed;
    p -= left * (turns * sqrt_of(square) * 0.5 * out);
  }
  // A factor above 1 acts while the foot is high, one below 1 from the lift-off on.
  const V one = all_of<V>(1.0), factor = state.gait.flight_height[side].x;
  const V more = mix(1.0, max_of(factor, one), V(1.0 - smoothstep(kLiftFalls, kLiftEnds, u)));
  V lifted = more;
  base_m = V{};
  if constexpr (kAlone<V>) {
    if (!tick.flat) {
      const GroundLine climb = ground_line_of(tick.model, state, side, p, u);
      base_m = climb.base_m;
      lifted = more * mix(1.0, kLiftUp, smoothstep(kHighUp, kHighestUp, climb.rise_legs));
    }
  }
  const V height = min_of(factor, one) * mix(1.0, lifted, smootherstep(V(u / kLiftGrown)));
  p.y = base_m + plan.heel_up_m * height;
  const V s = (u - foot.gap_begin) / foot.gap_lasts;
  const auto changed = foot.gap_begin > V{};
  p.y = is_short ? p.y + short_lift<V>(tick.model, at, u) : p.y;
  p.y = changed ? p.y + short_lift<V>(tick.model, at, s) * foot.gap_lasts : p.y;
  const auto fading = s < all_of<V>(1.0);
  // A changed flight may come down fast; a quintic keeps it higher until then.
  const V w = 1.0 - s, w3 = w * w * w;
  const V value_of = changed ? w3 * (1.0 + s * (3.0 + 6.0 * s)) : h00(s),
          slope_of = changed ? w3 * s * (1.0 + 3.0 * s) : h10(s);
  const V of_gap = fading ? value_of : V{}, of_slope = fading ? slope_of * foot.gap_lasts : V{};
  const V high = p.y - base_m,
          falls = (changed & (foot.gap_m.y < V{})) ? V(high / foot.gap_high_m) : all_of<V>(1.0);
  p.x += foot.gap_m.x * of_gap + foot.gap_slope_m.x * of_slope;
  p.z += foot.gap_m.z * of_gap + foot.gap_slope_m.z * of_slope;
  p.y += foot.gap_m.y * of_gap * falls + foot.gap_slope_m.y * of_slope;
  const V soft_m = kSoftFloor_m * tick.model.size * smootherstep(V(s / kSoftFrom)) *
                   (1.0 - smootherstep(V((u - 0.7) / 0.3)));
  const V above = max_of(V(p.y - base_m), V{}),
          softly = soft_positive(V(p.y - base_m), max_of(soft_m, all_of<V>(1e-6)));
  p.y = base_m + (changed ? softly : above);
  return p;
}

// Twist and roll of a foot in flight.
template <class V>
Vec<V> flying_edges(const MomentOf<V>& at, const StateOf<V>& state, const PlanOf<V>& plan,
                    Side side, const V& u) noexcept {
  // If the hips lead, the phase of the flight differs from the phases at which the foot stood and
  // will stand.
  const V lands = at.closing ? V{} : smootherstep(V((u - 1.0 + kEdgeGoes) / kEdgeGoes));
  const V goes = at.led ? smootherstep(V(u / kEdgeGoes)) * (1.0 - lands) : all_of<V>(1.0);
  const StrideFootOf<V>& stands = plan.cell.foot[side];
  // A foot with little lift does not roll onto an edge.
  const V low = mix(1.0, low_lift<V>(state, side),
                    V(smootherstep(V(u / 0.5)) * (1.0 - smootherstep(V((u - 0.6) / 0.4)))));
  return {low * mix(stands.twist_rad, plan.flying.twist_rad, goes),
          low * mix(stands.roll_rad, plan.flying.roll_rad, goes), V{}};
}

// The flying foot, before its pitch is applied.
template <class V>
FlightOf<V> flight_point(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                         const PlanOf<V>& plan, Side side, const V& u) noexcept {
  const auto& foot = state.foot[side];
  FlightOf<V> point;
  auto& pose = point.pose;
  pose.heel_m = flight_heel<V>(tick, at, state, plan, side, u, point.base_m);
  const V gone = 1.0 - h00(u);
  const V turn = state.path.landing_heading_rad - foot.lift_yaw_rad;
  // The landing's direction has changed in mid-flight.
  const V s = (u - foot.gap_begin) / foot.gap_lasts;
  const V off = ((foot.gap_begin > V{}) & (s < all_of<V>(1.0)))
                    ? foot.gap_yaw_rad * (1.0 - smootherstep(s))
                    : V{};
  pose.yaw =
      rotation_about_y(V(foot.lift_yaw_rad + turn * gone + foot.lift_turn_rad * h10(u) + off));
  const Vec<V> edges = flying_edges<V>(at, state, plan, side, u);
  pose.edge = edge_of<V>(tick.model.leg[side], edges.x, edges.y);
  point.lifted_m = V{};
  if constexpr (kAlone<V>) {
    if (!tick.flat) tilt_in_flight(state, side, gone, point);
  }
  return point;
}

// The pitch of the flying foot: as planned, limited so that the toe stays off that ground.
// `off_rad`: its difference from the tables'.
template <class V>
void pitch_in_flight(const WalkModel& model, const StateOf<V>& state, Side side, const V& u,
                     const V& pitch, const V& off_rad, FlightOf<V>& point) noexcept {
  const LegBuild& leg = model.leg[side];
  const auto& foot = state.foot[side];
  // The toe leaves the plane on which it stood, which may differ from the ground line.
  const V ground_m = point.base_m + point.lifted_m * (1.0 - smootherstep(V(u / kLiftGround)));
  V height = point.pose.heel_m.y - ground_m;
  if constexpr (kAlone<V>) height *= foot.plane.normal.y;
  // A low foot that rolls onto its edge keeps the edge off the floor.
  point.pose.pitch_rad = pitch;
  const Vec<V> across = foot_rotation<V>(leg, point.pose) * all_of<V>(leg.side);
  V steep = across.y;
  if constexpr (kAlone<V>) steep = glm::dot(across, point.pose.tilt * kUp);
  const V edge_m = leg.half_width_m * abs_of(steep) * smoothstep(0.0, kEdgeUp, u) *
                   (1.0 - smoothstep(kEdgeDown, 1.0, u));
  const V limit =
      highest_pitch<V>(leg, height, edge_m - kMostSink_m) + rolled_elevation<V>(leg, point.pose);
  // The tables keep the toe off the floor, so the limit gets softer as the pitch differs more
  // from theirs.
  const V soft =
      kSoftPitch + kWiderPitch * abs_of(off_rad) * smoothstep(0.0, 0.1, u) + edge_m / leg.foot_m;
  const MaskOf<V> on_toe{};  // no foot of these walks stands on its toe
  set_pitch<V>(leg, soft_min(pitch, limit, soft), on_toe, point.pose);
}

// The foot's pose of this tick, before the reach of the leg and the weights change it.
template <class V>
void plan_foot(const Tick& tick, const MomentOf<V>& at, StateOf<V>& state, const PlanOf<V>& plan,
               Side side) noexcept {
  const WalkModel& model = tick.model;
  const LegBuild& leg = model.leg[side];
  auto& foot = state.foot[side];
  const MaskOf<V> flies = at.in_flight[side], supports = not_of(flies) & not_of(at.in_roll[side]);
  auto pose = foot.pose;
  if constexpr (kAlone<V>) {
    pose.tilt = foot.plane.tilt;
    foot.base_m = foot.plane.place_m.y;
  }
  const double tick_s = tick.dt_s / model.time_scale, per_tick2 = tick_s * tick_s;
  const V eases = all_of<V>(kEases_s * model.time_scale / tick.dt_s),
          unsteady = state.path.unsteady;
  const V fade = foot.pitch_fade.at(at.mode_ticks[side] - foot.fade_begin),
          planned = table_pitch<V>(at, state, plan, side) + fade;
  const auto on_ground = [&](const V& pitch) {
    const V stands = supports ? max_of(V{}, pitch) : min_of(V{}, pitch);
    return V(flies ? pitch : stands);
  };
  const V flat_in = at.in_roll[side] ? max_of(V(kRollEnd * at.stage_ticks - at.tick), V{}) : eases;
  const V goal = on_ground(planned);
  const V pitch = on_ground(ease<V>(goal, kMostPitch_s2 * per_tick2, 0.0, V(min_of(eases, flat_in)),
                                    unsteady, foot.eased_pitch));
  keep(pitch, foot.eased_pitch);
  const V u = flies ? at.flight_progress() : V{}, shows = on_its_edges<V>(at, side);
  const StrideFootOf<V>& stands = plan.cell.foot[side];
  const Vec<V> edges = chosen(flies, flying_edges<V>(at, state, plan, side, u),
                              Vec<V>{shows * stands.twist_rad, shows * stands.roll_rad, V{}});
  const Vec<V> edge_rad =
      ease<V>(edges, kMostEdge_s2 * per_tick2, 0.0, eases, unsteady, foot.eased_edge);
  keep(edge_rad, foot.eased_edge);
  const Quat<V> edge = edge_of<V>(leg, edge_rad.x, edge_rad.y);
  if (any(not_of(flies))) {
    pose.edge = edge;
    pose.toe_m = chosen(supports, foot.toe_anchor_m, pose.toe_m);
    pose.heel_m = chosen(supports, pose.heel_m, foot.heel_anchor_m);
    set_pitch<V>(leg, pitch, supports, pose);
  }
  if (any(flies)) {
    FlightOf<V> point = flight_point<V>(tick, at, state, plan, side, u);
    point.pose.edge = edge;
    if constexpr (kAlone<V>) {
      if (!tick.flat) clear_ground(tick, state, plan, side, u, point);
      foot.base_m = point.base_m;
    }
    const V left = flies ? at.ticks_to_strike() : V{};
    point.pose.heel_m =
        ease<V>(point.pose.heel_m, 0.0, kMostHeel_m_s3 * model.size * per_tick2 * tick_s,
                V(min_of(eases, left)), flies ? unsteady : V{}, foot.eased_heel);
    point.pose.heel_m.y = max_of(point.pose.heel_m.y, point.base_m);
    pitch_in_flight<V>(model, state, side, u, pitch, V(fade + (pitch - goal)), point);
    point.pose.toe_rad = foot.pose.toe_rad;
    pose = chosen_pose(flies, point.pose, pose);
  }
  foot.pose = pose;
  if constexpr (kAlone<V>) {
    if (!tick.flat && supports) rise_on_toe(tick, state, plan, side);
  }
  keep(foot.pose.heel_m, foot.eased_heel);
}

// The pitch at which the ankle, turning about the planted toe, is as far from the hip as the leg
// reaches: P cos + Q sin = K in the foot's own vertical plane.
template <class V>
V pitch_in_reach(const LegBuild& leg, const PoseOf<V>& pose, const Vec<V>& hip_m,
                 double reach) noexcept {
  Vec<V> way = hip_m - pose.toe_m;
  if constexpr (kAlone<V>) way = glm::conjugate(pose.tilt) * way;
  const Vec<V> d = conjugate_of(pose.yaw) * way;
  const vec3 c = -leg.model.toe_m;
  const double cf = glm::dot(c, leg.forward), cs = glm::dot(c, leg.side);
  const V df = dot_of(d, all_of<V>(leg.forward)), ds = dot_of(d, all_of<V>(leg.side));
  const V p = df * cf + d.y * c.y, q = df * c.y - d.y * cf;
  const V k = 0.5 * (dot_of(d, d) + glm::dot(c, c) - reach * reach) - ds * cs;
  const V m = sqrt_of(V(p * p + q * q));
  const V pitch =
      soft_min(V(atan2_of(q, p) - acos_of(soft_min(V(k / m), kMostUpright, kSoftUpright))),
               kMaxPitch, kWidePitch);
  return m < all_of<V>(1e-9) ? V{} : pitch;
}

// Lets a standing foot rise on its toe if its leg would otherwise be too short.
template <class V>
void reach_with_toe(const WalkModel& model, const MomentOf<V>& at, StateOf<V>& state, Side side,
                    const Vec<V>& hip_m) noexcept {
  auto& foot = state.foot[side];
  const LegBuild& leg = model.leg[side];
  const Vec<V> ankle = foot.pose.heel_m - foot.pose.rotation * all_of<V>(leg.model.heel_m);
  const double reach = kReachOnToe * leg.model.length_m();
  const MaskOf<V> short_of = not_of(at.in_flight[side]) & not_of(at.in_roll[side]) &
                             (length_of(hip_m - ankle) > all_of<V>(reach));
  if (!any(short_of)) return;
  auto pose = foot.pose;
  set_pitch<V>(leg, max_of(pose.pitch_rad, pitch_in_reach<V>(leg, pose, hip_m, reach)), short_of,
               pose);
  foot.pose = chosen_pose(short_of, pose, foot.pose);
}

// The reach of a leg, which is less in an unsteady walk, because a straight knee would turn fast.
template <class V>
V reach_of(const LegBuild& leg, const PathFlow<V>& path) noexcept {
  return leg.model.length_m() * mix(kReach, kUnsteadyReach, V(smootherstep(path.unsteady)));
}

// Keeps a foot in flight within the reach of its leg.
template <class V>
void keep_in_reach(const WalkModel& model, const MomentOf<V>& at, StateOf<V>& state, Side side,
                   const Vec<V>& hip_m) noexcept {
  auto& foot = state.foot[side];
  const LegBuild& leg = model.leg[side];
  const Vec<V> way = hip_m - (foot.pose.heel_m - foot.pose.rotation * all_of<V>(leg.model.heel_m));
  const V span = length_of(way), beyond = span - reach_of<V>(leg, state.path);
  const double soft = kSoftReach_m * model.size;
  const MaskOf<V> pulls =
      at.in_flight[side] & (state.path.unsteady > V{}) & (beyond > all_of<V>(-soft));
  if (!any(pulls)) return;
  const V shorter = soft_positive(beyond, soft) * smootherstep(state.path.unsteady) *
                    smootherstep(V(at.flight_progress() / 0.1)) *
                    (1.0 - smootherstep(V((at.flight_progress() - 0.7) / 0.3)));
  auto pose = foot.pose;
  pose.heel_m += way * (shorter / span);
  pose.toe_m += way * (shorter / span);
  foot.pose = chosen_pose(pulls, pose, foot.pose);
}

// The share to which a foot whose heel stays low lowers the hips and pitches: from the rise of its
// heel on, until the heel swings forward.
template <class V>
void advance_low_foot(const Tick& tick, const MomentOf<V>& at, StateOf<V>& state,
                      Side side) noexcept {
  const V rises = at.in_flight[side] ? 1.0 - smootherstep(V(at.flight_progress() / kLowUntil))
                                     : heel_rise<V>(tick.model, at, side);
  const V goal = at.in_roll[side]
                     ? V{}
                     : presence_of<V>(state.gait) * rises * (1.0 - low_lift<V>(state, side));
  state.legs.low[side].advance(goal, Damping(kLowSmoothing * tick.model.time_scale, tick.dt_s));
}

// Pitches such a foot as far as its leg needs.
template <class V>
void rise_as_asked(const WalkModel& model, const MomentOf<V>& at, StateOf<V>& state, Side side,
                   const Vec<V>& hip_m) noexcept {
  auto& foot = state.foot[side];
  auto& legs = state.legs;
  const LegBuild& leg = model.leg[side];
  const auto is_low = not_of(at.in_roll[side]) & (legs.low[side].x > V{});
  legs.asked_rad[side] = V{};
  if (!any(is_low)) return;
  auto pose = foot.pose;
  const V asked = pitch_in_reach<V>(leg, pose, hip_m, kLowReach * leg.model.length_m());
  const V more = min_of(all_of<V>(1.0), V(2.0 * legs.low[side].x)) *
                 soft_positive(V(asked - pose.pitch_rad), kSoftRise);
  legs.asked_rad[side] = is_low ? more : V{};
  set_pitch<V>(leg, pose.pitch_rad + more, is_low, pose);
  foot.pose = chosen_pose(is_low, pose, foot.pose);
}

// --- The pelvis ----------------------------------------------------------------------------------

// The pelvis of this tick, before the legs change its height.
template <class V>
PelvisOf<V> pelvis_over_ground(const WalkModel& model, const StateOf<V>& state,
                               const PlanOf<V>& plan) noexcept {
  const StrideCellOf<V>& cell = plan.cell;
  PelvisOf<V> pelvis;
  const Quat<V>& heading = pelvis.heading = rotation_about_y(state.path.heading_rad);
  const Vec<V> left{heading.w * heading.w - heading.y * heading.y, V{},
                    -2.0 * heading.w * heading.y};
  pelvis.position_m = state.path.pelvis_m.x + state.path.sway_m;
  // In a turn the whole body leans, about the ground below the hips.
  const V height_m = model.stand_m + cell.pelvis_m.y;
  V sine, cosine;
  sin_cos_of(state.path.lean_rad.x, sine, cosine);
  pelvis.position_m += left * (height_m * sine);
  pelvis.position_m.y = height_m * cosine;
  Vec<V> tilt = cell.pelvis_tilt;
  tilt.z += model.stand_roll_rad;
  const Quat<V> upright = heading * rotation_about_z(V(-state.path.lean_rad.x)),
                turned = rotation_about_y(V(state.gait.sway.x * cell.pelvis_yaw_rad)) *
                         rotation_by_vector<V>(tilt);
  pelvis.rotation = upright * turned;
  if constexpr (kAlone<V>) {
    pelvis.position_m.y += state.path.base.height_m;
    if (state.path.slope_lean_rad.x == 0.0) return pelvis;
    // On a slope the trunk leans about the hip joints.
    const vec3 hips = 0.5 * (model.leg[kLeftSide].model.hip_m + model.leg[kRightSide].model.hip_m);
    pelvis.position_m += pelvis.rotation * hips;
    pelvis.rotation = upright * rotation_x(state.path.slope_lean_rad.x) * turned;
    pelvis.position_m -= pelvis.rotation * hips;
  }
  return pelvis;
}

// The distance from hip to ankle at this flexion of the knee.
template <class V>
V span_of(const LegModel& leg, const V& knee_rad) noexcept {
  const double a = leg.thigh_m, b = leg.shank_m;
  V sine, cosine;
  sin_cos_of(knee_rad, sine, cosine);
  return sqrt_of(V(a * a + b * b + 2.0 * a * b * cosine));
}

// The pelvis' height: the tables', lowered if ground or turn need more of a leg than in the tables.
template <class V>
V pelvis_height(const WalkModel& model, double tick_s, StateOf<V>& state, const PlanOf<V>& plan,
                const PelvisOf<V>& pelvis) noexcept {
  const V y = pelvis.position_m.y;
  V squares{};
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    const V knee = model.stand_rad[side][kKneeX] + plan.cell.leg_rad[side][kKneeX];
    // Between the tables of two strides a knee may be straighter than in either of them.
    const V table = span_of<V>(leg.model, knee);
    const V low = kLowReach * leg.model.length_m() + V{},
            known = mix(low, table,
                        low_lift<V>(state, side) * (1.0 - smootherstep(state.path.unsteady)));
    const auto& pose = state.foot[side].pose;
    const Vec<V> ankle = pose.heel_m - pose.rotation * all_of<V>(leg.model.heel_m),
                 hip = pelvis.hip(leg);
    const V span = length_of(ankle - hip);
    // A reach that already occurs in the tables is allowed.
    const V beyond = (span - known) / model.size;
    const auto asked = beyond > V{};
    if (!any(asked)) continue;
    const V soft =
        model.size * (kSoftReach_m + kUnsteadySoft_m * smootherstep(state.path.unsteady) +
                      kWiderReach * min_of(beyond, all_of<V>(kWidest_m)));
    const V longest = reach_of<V>(leg, state.path);
    const V times = beyond / kKnown_m;
    const V excess = soft_positive(V(span - longest), soft) * times * times / (1.0 + times * times);
    const V upright = max_of(V(0.3 * span), V(hip.y - ankle.y)) / span;
    squares += asked ? excess * excess / (upright * upright) : V{};
  }
  // The lowering for a foot fades after the foot has left the ground.
  PathFlow<V>& path = state.path;
  const V drop = soft_min(sqrt_of(squares), kMostSunk_m * model.size, kSoftSunk_m * model.size);
  path.sunk_m.advance(drop, Damping(kRises_s * model.time_scale, tick_s));
  const auto holds = (path.unsteady > V{}) & (path.sunk_m.x > drop);
  path.sunk_m.x = holds ? path.sunk_m.x : drop;
  path.sunk_m.v = holds ? path.sunk_m.v : V{};
  const V height = y - mix(drop, path.sunk_m.x, V(smootherstep(path.unsteady)));
  const V eased = ease<V>(height, kMostHeave_m_s2 * tick_s * tick_s, 0.0,
                          all_of<V>(kHeaveEases_s * model.time_scale / tick_s), path.unsteady,
                          path.eased_height);
  keep(eased, path.eased_height);
  return eased;
}

// --- The whole plan ------------------------------------------------------------------------------

template <class V>
void plan_walks(const Tick& tick, MomentOf<V>& at, const ParamsOf<V>& params, StateOf<V>& state,
                PlanOf<V>& plan, PelvisOf<V>& pelvis) noexcept {
  smooth_parameters<V>(tick, at, params, state);
  state.path.heading_rad += state.gait.turn_rate.x * tick.dt_s;
  plan_landing<V>(tick, at, state);
  const V share = at.step_share();
  fade_changes<V>(at, share, V(at.step_share_ahead() - share), state.gait);
  plan_stride<V>(tick, at, state, plan);
  advance_hips<V>(tick, at, state, plan);
  lead_hips<V>(tick, at, state, plan);
  advance_unsteady<V>(tick, at, state.path);
  for (const Side side : {kLeftSide, kRightSide}) plan_foot<V>(tick, at, state, plan, side);
  pelvis = pelvis_over_ground<V>(tick.model, state, plan);
  for (const Side side : {kLeftSide, kRightSide}) {
    advance_low_foot<V>(tick, at, state, side);
    pelvis.position_m.y -= kLowHips_m * tick.model.size * state.legs.low[side].x *
                           smoothstep(0.0, kLowRisen, plan.cell.foot[side].pitch_rad);
  }
  for (const Side side : {kLeftSide, kRightSide})
    rise_as_asked<V>(tick.model, at, state, side, pelvis.hip(tick.model.leg[side]));
  pelvis.position_m.y = pelvis_height<V>(tick.model, tick.dt_s, state, plan, pelvis);
  for (const Side side : {kLeftSide, kRightSide}) {
    const Vec<V> hip_m = pelvis.hip(tick.model.leg[side]);
    reach_with_toe<V>(tick.model, at, state, side, hip_m);
    keep_in_reach<V>(tick.model, at, state, side, hip_m);
  }
}

}  // namespace
}  // namespace gaitpad
