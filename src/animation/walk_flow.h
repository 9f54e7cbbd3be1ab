// What every walk computes in every tick, of one walk or of several side by side (V: a double, or a
// register of as many): the parameters smoothed, the landing place, the strides' tables, hips and
// feet. What begins now and then, and what terrain adds, is computed for one walk at a time
// (walk.cpp, walk_feet.cpp, walk_terrain.cpp).
//
// Walks side by side share a model and walk on flat ground. Where their stages differ, the parts of
// a tick are computed for all of them and chosen by masks; a part that none of them is in is left
// out. Every lane gets the bits that its walk gets alone.
#pragma once
#include "animation/walk_parts.h"
#include "motion/stride_lanes.h"

namespace gaitpad {
namespace {

// --- What is side by side ------------------------------------------------------------------------

template <class V>
inline V value(const MaskOf<V>& mask, const V& a, const V& b) noexcept {
  return mask ? a : b;
}
// Of two doubles that do not differ from lane to lane.
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

// Numbers of one walk into a lane, and back: both structs are the same numbers in the same order.
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
inline constexpr double kStepSmoothing = 0.12;
inline constexpr double kTurnGoalSmoothing = 0.03;
inline constexpr double kTurnSmoothing = 0.12;
inline constexpr double kBounceSmoothing = 0.30;
inline constexpr double kAmplitudeSmoothing = 0.18, kAmplitudeFading = 0.07;
inline constexpr double kWeightSmoothing = 0.15;
inline constexpr double kSettling = 0.35;
inline constexpr double kLeanSmoothing = 0.12;
inline constexpr double kGravity_m_s2 = 9.81, kLeastCycle_s = 0.2;
inline constexpr double kAllShown = 1.0 - 1e-9;  // from here on nothing is mixed with the stand
inline constexpr double kStillTurn = 1e-5;       // rad/s: slower than this is straight ahead
inline constexpr double kMostExtraSwing = 0.4;   // swing beyond the data's that pace alone can give
inline constexpr double kLeastPace =
    0.5;  // below it the data's posture fades, and the swing with it

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
void smooth_parameters(const Tick& tick, const MomentOf<V>& at, const ParamsOf<V>& params,
                       StateOf<V>& state) noexcept {
  GaitFlow<V>& gait = state.gait;
  const double scale = tick.model.time_scale, dt = tick.dt_s;
  // A walk that is to end takes the running step as it was begun, and one that closes it.
  const Damping step(kStepSmoothing * scale, dt), weights(kWeightSmoothing * scale, dt),
      hips(kBounceSmoothing * scale, dt);
  for (int side : {0, 1}) {
    const V kept_m = value<V>(at.finishes, gait.length_m[side].x, V{});
    gait.length_m[side].advance(value<V>(at.walking, params.length_m[side], kept_m), step);
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
  Damped<V> shown = gait.amplitude, fading = gait.amplitude;
  shown.advance(all_of<V>(1.0), Damping(kAmplitudeSmoothing * scale, dt));
  fading.advance(V{}, Damping(kAmplitudeFading * scale, dt));
  const auto all_shown = at.started & (shown.x > all_of<V>(kAllShown));
  gait.amplitude.x = at.started ? shown.x : fading.x;
  gait.amplitude.v = at.started ? shown.v : fading.v;
  gait.amplitude.x = all_shown ? all_of<V>(1.0) : gait.amplitude.x;
  gait.amplitude.v = all_shown ? V{} : gait.amplitude.v;
  gait.bounce.advance(params.hip_bounce, hips);
  gait.sway.advance(params.hip_sway, hips);
  const V mean = 0.5 * (gait.length_m[0].x + gait.length_m[1].x);
  gait.pace.advance(mean * gait.ground_share.x / tick.model.source_step_m, step);
  gait.settled_pace.advance(gait.pace.x, Damping(kSettling * scale, dt));
  // A lean of v w / g puts the weight on the standing foot's edge, as on a bicycle.
  const V speed_m_s = (gait.length_m[0].x + gait.length_m[1].x) /
                      max_of(gait.time_s[0] + gait.time_s[1], all_of<V>(kLeastCycle_s));
  const V lean = speed_m_s * gait.turn_rate.x / kGravity_m_s2;
  const bool is_paper = tick.mode == IkMode::paper;
  state.path.lean_rad.advance(is_paper ? V{} : lean, Damping(kLeanSmoothing * scale, dt));
  // In paper mode the data's upper body is left as it is.
  const V pace = is_paper ? all_of<V>(1.0) : pace_swing(tick.model, gait);
  for (int side : {0, 1}) gait.arm_swing[side] = pace * params.arm_swing[side];
}

// How much of the data's oscillations and postures shows: 0 at rest, 1 from half the data's pace
// on.
template <class V>
V presence_of(const GaitFlow<V>& gait) noexcept {
  return within(gait.amplitude.x, 0.0, 1.0) * within(V(2.0 * gait.pace.x), 0.0, 1.0);
}

// True where a leg's weights are not all 1.
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

// In the character's lengths (StrideScale): where a stride goes, and all of it at one phase.
template <class V>
StrideTrackOf<V> track_of(const WalkModel& model, const MaskOf<V>& backward,
                          const V& ratio) noexcept {
  StrideTrackOf<V> track;
  track_at<V>(ratios_at<V>(tables_of<V>(model, backward), ratio), track);
  scale_track<V>(model.stride_scale, track);
  return track;
}
// The running step's length over the data's.
template <class V>
V ratio_of_step(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state) noexcept {
  // Run back, a foot makes the step that the other one makes forwards.
  const V own_m = value<V>(at.right_steps != at.backward, model.own_step_m[kRightSide],
                           model.own_step_m[kLeftSide]);
  const V step_m =
      value<V>(at.right_steps, state.path.stride_m[kRightSide], state.path.stride_m[kLeftSide]);
  return at.started ? abs_of(step_m) / own_m : V{};
}
template <class V>
V ratio_ahead(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state) noexcept {
  return max_of(V{}, V(ratio_of_step<V>(model, at, state) + state.gait.off_ratio.x));
}

// A walk limps from the one difference of both feet's strides on, wholly from the other.
inline constexpr double kEvenSteps = 0.03, kUnevenSteps = 0.2, kLeastAsked = 1e-9;

// Where one foot's steps are shorter than the other's, the tables of short strides would keep both
// feet low: then a heel flies as high as in strides in which both go as far as the longer one, and
// comes down as the tables have it.
template <class V>
void raise_limping_heel(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                        const TablesOf<V>& tables, const KnotsOf<V>& knots, const V& ahead,
                        PlanOf<V>& plan) noexcept {
  const WalkModel& model = tick.model;
  const auto& foot = plan.cell.foot;
  plan.heel_up_m = at.right_steps ? foot[kRightSide].heel_m.y : foot[kLeftSide].heel_m.y;
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
  const auto is_limping = at.flies & (limps != V{});
  if (!any(is_limping)) return;
  const V own = at.right_steps ? asked[kRightSide] : asked[kLeftSide];
  const Vec<V> heel_m =
      heel_at<V>(ratios_at<V>(tables, V(ahead * longer / max_of(own, all_of<V>(kLeastAsked)))),
                 knots, at.right_steps);
  const V high_m = plan.shown * model.stride_scale.length * heel_m.y;
  plan.heel_up_m = is_limping ? mix(plan.heel_up_m, high_m, limps) : plan.heel_up_m;
}

// More bounce lets the pelvis sink deeper, less keeps it as low as it is at its lowest: no leg has
// to be longer for it.
template <class V>
V bounced(const GaitFlow<V>& gait, const PlanOf<V>& plan) noexcept {
  const V y = plan.cell.pelvis_m.y, more = gait.bounce.x - 1.0;
  const auto bounces = more != V{};
  if (!any(bounces)) return y;
  const auto of = [&](V StrideTrackOf<V>::*height) {
    return V(plan.shown * mix(plan.track[0].*height, plan.track[1].*height, plan.change));
  };
  const V stays = more > V{} ? of(&StrideTrackOf<V>::high_m) : of(&StrideTrackOf<V>::low_m);
  return bounces ? y + more * (y - stays) : y;
}

// At a phase of the walk and a share of the running step's time.
template <class V>
void plan_stride(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state, const V& phase,
                 const V& step_share, PlanOf<V>& plan) noexcept {
  plan.phase = phase;
  plan.change = smootherstep(step_share);
  plan.shown = within(state.gait.amplitude.x, 0.0, 1.0);
  const KnotsOf<V> knots = knots_at<V>(phase);
  const V behind = state.gait.ratio_behind, ahead = ratio_ahead<V>(tick.model, at, state);
  const TablesOf<V> tables = tables_of<V>(tick.model, at.backward);
  const std::array<RatiosOf<V>, 2> ratios = {ratios_at<V>(tables, behind),
                                             ratios_at<V>(tables, ahead)};
  const StrideScale& scale = tick.model.stride_scale;
  for (int k : {0, 1}) {
    track_at<V>(ratios[k], plan.track[k]);
    scale_track<V>(scale, plan.track[k]);
    plan.flying_m[k] = Vec<V>{};
    if (!any(at.flies)) continue;
    const Vec<V> heel_m = heel_at<V>(ratios[k], knots, at.right_steps);
    plan.flying_m[k] = chosen(at.right_steps, scaled_heel<V>(scale, heel_m, kRightSide),
                              scaled_heel<V>(scale, heel_m, kLeftSide));
  }
  stride_between<V>(ratios[0], ratios[1], plan.change, knots, plan.cell);
  scale_stride<V>(scale, plan.cell);
  constexpr int kNumbers = sizeof(StrideCell) / sizeof(double);
  auto* to = reinterpret_cast<V*>(&plan.cell);
  for (int k = 0; k < kNumbers; ++k) to[k] = plan.shown * to[k];
  raise_limping_heel<V>(tick, at, state, tables, knots, ahead, plan);
  plan.cell.pelvis_m.y = bounced<V>(state.gait, plan);
}
// Now.
template <class V>
void plan_stride(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                 PlanOf<V>& plan) noexcept {
  const V begun = at.tick + (at.flies ? at.roll_ticks : V{});
  // A walk that has closed fades from the stride of its last step.
  const V share =
      at.started ? begun / max_of(V(at.roll_ticks + at.flight_ticks), all_of<V>(1.0)) : V{};
  plan_stride<V>(tick, at, state, at.phase, share, plan);
}

// Where a point of the travel frame of a stride is, seen from the footprint of `side` in the
// running step: of the flying foot the one that it left (which 0) or will land on (1).
template <class V>
Vec<V> from_footprint(const MomentOf<V>& at, const StrideTrackOf<V>& track, const V& phase,
                      Side side, int which, const Vec<V>& travel_m) noexcept {
  // The right foot goes from its footprint of this stride to the next one's, the left foot from the
  // last one's to this one's.
  const double turns_right = which, turns_left = which - 1;
  const V turns = at.steps(side) ? all_of<V>(side == kRightSide ? turns_right : turns_left) : V{};
  Vec<V> p = travel_m - track.footprint_m[side];
  p.z += track.stride_m * (phase - turns);
  return p;
}

// --- Hips and landing place ----------------------------------------------------------------------

// Lengths in metres at the reference leg.
inline constexpr double kChangeDrop_m = 0.012, kChange = 0.2;
inline constexpr double kReach = 0.9994;  // of the leg: a knee bent by 4 degrees
inline constexpr double kSoftReach_m = 0.006, kKnown_m = 0.0015, kWiderReach = 0.6,
                        kWidest_m = 0.06;
inline constexpr double kFreeze = 0.55;  // of the flight: after it the landing place is settled

// A power to a whole number, at least 0.
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

// The heading n ticks ahead if the turn rate's goal stays. The filter is a linear recurrence with
// the double eigenvalue q, so its error is e_k = (e_0 + c k) q^k, and the sum has a closed form.
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

template <class V>
void plan_landing(const Tick& tick, const MomentOf<V>& at, StateOf<V>& state) noexcept {
  const auto on_way = at.on_way();
  if (!any(on_way)) return;
  PathFlow<V>& path = state.path;
  const V heading = heading_ahead<V>(tick, state, at.ticks_to_strike() + 1.0);
  V sine, cosine;
  sin_cos_of(heading, sine, cosine);
  const Vec<V> forward{sine, V{}, cosine}, left = cross_of(all_of<V>(kUp), forward);
  const Vec<V> standing = chosen(at.right_steps, state.foot[kLeftSide].heel_anchor_m,
                                 state.foot[kRightSide].heel_anchor_m);
  const auto open = on_way & (at.flight_progress() <= all_of<V>(kFreeze));
  if (any(open)) {
    const double track_m[] = {tick.model.leg[0].track_m, tick.model.leg[1].track_m};
    const V width = value<V>(at.right_steps, track_m[1] - track_m[0], track_m[0] - track_m[1]);
    const V length_m = value<V>(at.right_steps, state.gait.length_m[kRightSide].x,
                                state.gait.length_m[kLeftSide].x);
    path.landing_heading_rad = open ? heading : path.landing_heading_rad;
    path.landing_m = chosen(open, standing + forward * step_length<V>(at, length_m) + left * width,
                            path.landing_m);
    if constexpr (kAlone<V>) {
      if (!tick.flat) choose_foothold(tick, state, forward, left * width);
    }
  }
  // Along the heading at the landing, which may still turn after the place is settled.
  const V step_m = dot_of(path.landing_m - standing, forward);
  for (const Side side : {kLeftSide, kRightSide})
    path.stride_m[side] = (on_way & at.steps(side)) ? step_m : path.stride_m[side];
  if constexpr (kAlone<V>) {
    if (!tick.flat) follow_ground(tick, state);
  }
}

// The hips' place on the tables' path, without their oscillation: of the stride before, from the
// footprint of the foot that stands; of this one, to the next landing.
template <class V>
Vec<V> path_from_standing(const MomentOf<V>& at, const StateOf<V>& state,
                          const StrideTrackOf<V>& track, const V& phase) noexcept {
  const auto from = [&](Side stand) {
    const auto& foot = state.foot[stand];
    return foot.heel_anchor_m + rotation_about_y(foot.lift_yaw_rad) *
                                    from_footprint<V>(at, track, phase, stand, 0, Vec<V>{});
  };
  return chosen(at.right_steps, from(kLeftSide), from(kRightSide));
}
template <class V>
Vec<V> path_to_landing(const MomentOf<V>& at, const StrideTrackOf<V>& track, const V& phase,
                       const Vec<V>& landing_m, const V& heading_rad) noexcept {
  const Vec<V> seen =
      chosen(at.right_steps, from_footprint<V>(at, track, phase, kRightSide, 1, Vec<V>{}),
             from_footprint<V>(at, track, phase, kLeftSide, 1, Vec<V>{}));
  return landing_m + rotation_about_y(heading_rad) * seen;
}

// A step takes the hips from the path of the stride before it over to its own.
template <class V>
SmoothFade<Vec<V>> path_at_strike(const WalkModel& model, const MomentOf<V>& at,
                                  const StateOf<V>& state, const V& ratio) noexcept {
  const PathFlow<V>& path = state.path;
  const StrideTrackOf<V> behind = track_of<V>(model, at.backward, state.gait.ratio_behind),
                         ahead = track_of<V>(model, at.backward, ratio);
  V phase = at.stage_phase, rate = at.phase_rate;
  std::array<Vec<V>, 3> off;
  for (int k : {0, 1, 2}) {
    Vec<V> from = path_from_standing<V>(at, state, behind, phase);
    const auto at_rest = at.last_step_ticks == V{};
    from.x = at_rest ? path.hips_m.x : from.x;
    from.z = at_rest ? path.hips_m.z : from.z;
    off[k] = from - path_to_landing<V>(at, ahead, phase, path.landing_m, path.landing_heading_rad);
    approach(phase, rate, at.stage_end, at.end_rate, V(at.stage_ticks - double(k)), 1.0);
  }
  return {off[0], 0.5 * (4.0 * off[1] - 3.0 * off[0] - off[2]), off[0] - 2.0 * off[1] + off[2]};
}

template <class V>
SmoothFade<Vec<V>> chosen_fade(const MaskOf<V>& mask, const SmoothFade<Vec<V>>& a,
                               const SmoothFade<Vec<V>>& b) noexcept {
  return {chosen(mask, a.x, b.x), chosen(mask, a.v, b.v), chosen(mask, a.a, b.a)};
}

// The hips follow the tables' path to the next landing. What they differ by from it, from the step
// before or because the landing has moved, fades until the strike.
template <class V>
void advance_hips(const Tick& tick, const MomentOf<V>& at, StateOf<V>& state,
                  const PlanOf<V>& plan) noexcept {
  if constexpr (kAlone<V>) {
    if (!tick.flat) advance_base(tick, state);
  }
  PathFlow<V>& path = state.path;
  const auto on_way = at.on_way();
  path.hips_velocity_m_s = chosen(on_way, path.hips_velocity_m_s, Vec<V>{});
  if (!any(on_way)) return;
  const Vec<V> before = path.hips_m;
  const Vec<V> to =
      path_to_landing<V>(at, plan.track[1], plan.phase, path.landing_m, path.landing_heading_rad);
  const V ratio = ratio_ahead<V>(tick.model, at, state);
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
    // The path has moved, and the hips have not.
    const StrideTrackOf<V> last = track_of<V>(tick.model, at.backward, path.last_ratio);
    const Vec<V> was =
        path_to_landing<V>(at, last, plan.phase, path.last_landing_m, path.last_heading_rad);
    off.x = chosen(moved, off.x + (was - to), off.x);
  }
  if (any(strikes))
    off = chosen_fade<V>(strikes, path_at_strike<V>(tick.model, at, state, ratio), off);
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
  path.hips_velocity_m_s = chosen(on_way, (hips - before) / tick.dt_s, path.hips_velocity_m_s);
}

// --- Feet: their place, direction and pitch ------------------------------------------------------

// A flying toe may be that far below where it stands: then the tables' own toes, which only just
// leave the floor, are let through.
inline constexpr double kMostSink_m = 0.0015, kSoftPitch = 0.4 * kDegree, kWiderPitch = 0.25;
inline constexpr double kRiseBegin = 0.20, kHeelRiseLasts = 0.18;  // own phase: the heel may rise
inline constexpr double kReachOnToe =
    0.99995;  // of the leg: with the hip further away, the heel rises
// A low foot rises when its leg is longer than this, of the leg, with hips that are lower by this.
inline constexpr double kLowHips_m = 0.022, kLowReach = 0.995, kSoftRise = 8.0 * kDegree;
inline constexpr double kMostUpright = 0.99, kSoftUpright = 0.12;
inline constexpr double kMaxPitch = 85.0 * kDegree, kWidePitch = 25.0 * kDegree;
// A foot that goes far up is lifted less: its way over the riser is lift enough, and the knee folds
// only so far.
inline constexpr double kLiftUp = 0.5, kHighUp = 0.2, kHighestUp = 0.345;
inline constexpr double kLiftFade = 0.5;  // of the flight: the lift-off's own motion has faded
inline constexpr double kEdgeUp = 0.25,
                        kEdgeDown = 0.9;  // of the flight: between them soles clear the floor
inline constexpr double kLiftGround =
    0.5;                                  // of the flight: until then the plane left bounds the toe
inline constexpr double kLowPitch = 0.5;  // of the flight: until then a low foot's pitch is less
// Of the flight: from kLiftGrown until kLiftFalls all of a style's factor on its height acts.
inline constexpr double kLiftGrown = 0.4, kLiftFalls = 0.5, kLiftEnds = 0.85;

// How far a standing foot may leave the floor with its heel: 0 flat .. 1 freely.
template <class V>
V heel_rise(const WalkModel& model, const MomentOf<V>& at, Side side) noexcept {
  const double strike = side == kRightSide ? 0.0 : model.share[0] + model.share[1];
  const V p = at.phase - strike, own = p - floor_of(p);
  const double begin = std::max(kRiseBegin, model.share[side == kRightSide ? 0 : 2]);
  const auto stays = not_of(at.on_way()) | (at.closing & not_of(at.steps(side)));
  return stays ? V{} : smoothstep(begin, begin + kHeelRiseLasts, own);  // after the roll
}

template <class V>
Quat<V> edge_of(const LegBuild& leg, const V& twist_rad, const V& roll_rad) noexcept {
  return rotation_by_vector<V>(all_of<V>(kUp) * twist_rad + all_of<V>(leg.forward) * roll_rad);
}

// Segment rotation, world.
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

// The toes' rotation from their foot: bent by `toe_rad`, and level across however the foot rolls.
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

// How much steeper the line from heel to toe is in a foot that twists and rolls.
template <class V>
V rolled_elevation(const LegBuild& leg, const PoseOf<V>& pose) noexcept {
  const Vec<V> line = pose.edge * all_of<V>(leg.model.toe_m - leg.model.heel_m);
  return atan2_of(line.y, dot_of(line, all_of<V>(leg.forward))) - leg.elevation_rad;
}

// The greatest pitch at which the toe of a heel at this height is `clearance_m` above its rest.
template <class V>
V highest_pitch(const LegBuild& leg, const V& heel_m, const V& clearance_m) noexcept {
  const V low = (leg.model.toe_rest_m + clearance_m - heel_m) / leg.foot_m;
  return leg.elevation_rad - asin_of(within(low, -1.0, 1.0));
}

// The factor on a rising heel's height, at most 1: a lame foot stays low.
template <class V>
V low_lift(const StateOf<V>& state, Side side) noexcept {
  return min_of(state.gait.flight_height[side].x, all_of<V>(1.0));
}

// The foot's pitch in the tables, less where its heel is to rise less.
template <class V>
V table_pitch(const MomentOf<V>& at, const StateOf<V>& state, const PlanOf<V>& plan,
              Side side) noexcept {
  // The foot that stands when a walk begins has not landed: its toe is down.
  const auto stands = at.in_roll[side] & (at.last_step_ticks == V{});
  const V pitch = (at.started & not_of(stands)) ? plan.cell.foot[side].pitch_rad : V{};
  const V low = low_lift<V>(state, side);
  const auto is_low = not_of(at.in_roll[side]) & (low != all_of<V>(1.0));
  if (!any(is_low)) return pitch;
  const V u = at.in_flight[side] ? at.flight_progress() : V{};
  return is_low ? pitch * mix(low, 1.0, smootherstep(V(u / kLowPitch))) : pitch;
}

// How much of the tables' twist and roll a foot on the ground shows: when standing it is flat.
template <class V>
V on_its_edges(const MomentOf<V>& at) noexcept {
  const V fading = at.idle ? V{} : 1.0 - smootherstep(V(at.tick / at.stage_ticks));
  return at.started ? all_of<V>(1.0) : fading;
}

// The heel's place, and the height of the ground line below it: the tables' path from the footprint
// that the foot left to the one where it lands. Where both steps are equal, both say the same.
template <class V>
Vec<V> flight_heel(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                   const PlanOf<V>& plan, Side side, const V& u, V& base_m) noexcept {
  const auto& foot = state.foot[side];
  const PathFlow<V>& path = state.path;
  const Quat<V> old = rotation_about_y(foot.lift_yaw_rad),
                next = rotation_about_y(path.landing_heading_rad);
  const V gone = smootherstep(u);
  const Vec<V> from_old =
                   from_footprint<V>(at, plan.track[0], plan.phase, side, 0, plan.flying_m[0]),
               from_next =
                   from_footprint<V>(at, plan.track[1], plan.phase, side, 1, plan.flying_m[1]);
  Vec<V> p = (foot.heel_anchor_m + old * from_old) * (1.0 - gone) +
             (path.landing_m + next * from_next) * gone;
  // A greater factor acts while the foot is high, a smaller one from the lift-off on.
  const V one = all_of<V>(1.0), factor = state.gait.flight_height[side].x;
  const V more = mix(1.0, max_of(factor, one), V(1.0 - smoothstep(kLiftFalls, kLiftEnds, u)));
  V lifted = more;
  base_m = V{};
  if constexpr (kAlone<V>) {
    if (!tick.flat) {
      const Climb climb = climb_of(tick.model, state, side, p, u);
      base_m = climb.base_m;
      lifted = more * mix(1.0, kLiftUp, smoothstep(kHighUp, kHighestUp, climb.rise_legs));
    }
  }
  const V height = min_of(factor, one) * mix(1.0, lifted, smootherstep(V(u / kLiftGrown)));
  p.y = base_m + plan.heel_up_m * height;
  const V s = u / kLiftFade;
  const auto fading = u < all_of<V>(kLiftFade);
  const V of_gap = fading ? h00(s) : V{}, of_slope = fading ? h10(s) * kLiftFade : V{};
  p += foot.gap_m * of_gap + foot.gap_slope_m * of_slope;
  p.y = max_of(p.y, base_m);
  return p;
}

// Where the foot flies, still without its pitch.
template <class V>
FlightOf<V> flight_point(const Tick& tick, const MomentOf<V>& at, const StateOf<V>& state,
                         const PlanOf<V>& plan, Side side, const V& u) noexcept {
  const auto& foot = state.foot[side];
  const StrideFootOf<V>& cell = plan.cell.foot[side];
  FlightOf<V> point;
  auto& pose = point.pose;
  pose.heel_m = flight_heel<V>(tick, at, state, plan, side, u, point.base_m);
  const V gone = 1.0 - h00(u);
  const V turn = state.path.landing_heading_rad - foot.lift_yaw_rad;
  pose.yaw = rotation_about_y(V(foot.lift_yaw_rad + turn * gone + foot.lift_turn_rad * h10(u)));
  // A lame foot that hardly leaves the floor does not roll onto an edge.
  const V low = mix(1.0, low_lift<V>(state, side),
                    V(smootherstep(V(u / 0.5)) * (1.0 - smootherstep(V((u - 0.6) / 0.4)))));
  pose.edge = edge_of<V>(tick.model.leg[side], low * cell.twist_rad, low * cell.roll_rad);
  point.lifted_m = V{};
  if constexpr (kAlone<V>) {
    if (!tick.flat) tilt_in_flight(state, side, gone, point);
  }
  return point;
}

// Its pitch: the tables', as far as the toe stays off that ground.
template <class V>
void pitch_in_flight(const WalkModel& model, const MomentOf<V>& at, const StateOf<V>& state,
                     const PlanOf<V>& plan, Side side, const V& u, FlightOf<V>& point) noexcept {
  const LegBuild& leg = model.leg[side];
  const auto& foot = state.foot[side];
  // The toe leaves the plane that it stood on, which may be another one than the line over ground.
  const V ground_m = point.base_m + point.lifted_m * (1.0 - smootherstep(V(u / kLiftGround)));
  V height = point.pose.heel_m.y - ground_m;
  if constexpr (kAlone<V>) height *= foot.plane.normal.y;
  // The tables keep the toe off the floor. What differs from them must do so itself.
  const V fade = foot.pitch_fade.at(u * at.stage_ticks);
  const V pitch = table_pitch<V>(at, state, plan, side) + fade;
  // A low foot that rolls onto its edge keeps this edge off the floor.
  point.pose.pitch_rad = pitch;
  const Vec<V> across = foot_rotation<V>(leg, point.pose) * all_of<V>(leg.side);
  V steep = across.y;
  if constexpr (kAlone<V>) steep = glm::dot(across, point.pose.tilt * kUp);
  const V edge_m = leg.half_width_m * abs_of(steep) * smoothstep(0.0, kEdgeUp, u) *
                   (1.0 - smoothstep(kEdgeDown, 1.0, u));
  const V limit =
      highest_pitch<V>(leg, height, edge_m - kMostSink_m) + rolled_elevation<V>(leg, point.pose);
  const V soft =
      kSoftPitch + kWiderPitch * abs_of(fade) * smoothstep(0.0, 0.1, u) + edge_m / leg.foot_m;
  const MaskOf<V> on_toe{};  // none
  set_pitch<V>(leg, soft_min(pitch, limit, soft), on_toe, point.pose);
}

// The foot's pose of this tick, before the reach and the weights act on it.
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
  if (any(not_of(flies))) {
    const StrideFootOf<V>& cell = plan.cell.foot[side];
    const V pitch = table_pitch<V>(at, state, plan, side) + foot.pitch_fade.at(at.mode_ticks[side]);
    const V shows = on_its_edges<V>(at);
    pose.edge = edge_of<V>(leg, shows * cell.twist_rad, shows * cell.roll_rad);
    pose.toe_m = chosen(supports, foot.toe_anchor_m, pose.toe_m);
    pose.heel_m = chosen(supports, pose.heel_m, foot.heel_anchor_m);
    set_pitch<V>(leg, supports ? max_of(V{}, pitch) : min_of(V{}, pitch), supports, pose);
  }
  if (any(flies)) {
    const V u = flies ? at.flight_progress() : V{};
    FlightOf<V> point = flight_point<V>(tick, at, state, plan, side, u);
    if constexpr (kAlone<V>) {
      if (!tick.flat) clear_ground(tick, state, plan, side, u, point);
      foot.base_m = point.base_m;
    }
    pitch_in_flight<V>(model, at, state, plan, side, u, point);
    point.pose.toe_rad = foot.pose.toe_rad;
    pose = chosen_pose(flies, point.pose, pose);
  }
  foot.pose = pose;
  if constexpr (kAlone<V>) {
    if (!tick.flat && supports) rise_on_toe(tick, state, plan, side);
  }
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

// Lets a standing foot rise on its toe where its leg would be too short.
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

// A standing foot whose heel stays low rises as far as its leg asks, with hips a little lower.
template <class V>
void rise_as_asked(const WalkModel& model, const MomentOf<V>& at, StateOf<V>& state, Side side,
                   const Vec<V>& hip_m) noexcept {
  auto& foot = state.foot[side];
  const LegBuild& leg = model.leg[side];
  const auto is_low = not_of(at.in_flight[side]) & not_of(at.in_roll[side]) &
                      (low_lift<V>(state, side) != all_of<V>(1.0));
  if (!any(is_low)) return;
  const Vec<V> hip = hip_m - all_of<V>(kUp) * all_of<V>(kLowHips_m * model.size);
  auto pose = foot.pose;
  const V asked = pitch_in_reach<V>(leg, pose, hip, kLowReach * leg.model.length_m());
  const V more = soft_positive(V(asked - pose.pitch_rad), kSoftRise);
  set_pitch<V>(leg, pose.pitch_rad + heel_rise<V>(model, at, side) * more, is_low, pose);
  foot.pose = chosen_pose(is_low, pose, foot.pose);
}

// --- The pelvis ----------------------------------------------------------------------------------

// The pelvis of this tick, still without the height that the legs ask for.
template <class V>
PelvisOf<V> pelvis_over_ground(const WalkModel& model, const StateOf<V>& state,
                               const PlanOf<V>& plan) noexcept {
  const StrideCellOf<V>& cell = plan.cell;
  PelvisOf<V> pelvis;
  const Quat<V>& heading = pelvis.heading = rotation_about_y(state.path.heading_rad);
  const Vec<V> forward{2.0 * heading.w * heading.y, V{},
                       heading.w * heading.w - heading.y * heading.y},
      left = cross_of(all_of<V>(kUp), forward);
  pelvis.position_m = state.path.hips_m + left * cell.pelvis_m.x + forward * cell.pelvis_m.z;
  // In a turn the body leans as a whole, about the ground below the hips.
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
    // Into a slope the trunk leans about the hip joints.
    const vec3 hips = 0.5 * (model.leg[kLeftSide].model.hip_m + model.leg[kRightSide].model.hip_m);
    pelvis.position_m += pelvis.rotation * hips;
    pelvis.rotation = upright * rotation_x(state.path.slope_lean_rad.x) * turned;
    pelvis.position_m -= pelvis.rotation * hips;
  }
  return pelvis;
}

// From hip to ankle, with a knee that is bent so far.
template <class V>
V span_of(const LegModel& leg, const V& knee_rad) noexcept {
  const double a = leg.thigh_m, b = leg.shank_m;
  V sine, cosine;
  sin_cos_of(knee_rad, sine, cosine);
  return sqrt_of(V(a * a + b * b + 2.0 * a * b * cosine));
}

// The pelvis' height: the tables', lowered where ground or turn ask more of a leg than they know.
template <class V>
V pelvis_height(const WalkModel& model, const StateOf<V>& state, const PlanOf<V>& plan,
                const PelvisOf<V>& pelvis) noexcept {
  // Legs that are about to change their pace are bent a little, so that they have room.
  const V one = all_of<V>(1.0), change = state.gait.pace.x - state.gait.settled_pace.x;
  V y = pelvis.position_m.y;
  y -= kChangeDrop_m * model.size * min_of(one, V(2.0 * state.gait.pace.x)) * change * change /
       (change * change + kChange * kChange);
  V squares{};
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    const V known =
        span_of<V>(leg.model, V(model.stand_rad[side][kKneeX] + plan.cell.leg_rad[side][kKneeX]));
    const auto& pose = state.foot[side].pose;
    const Vec<V> ankle = pose.heel_m - pose.rotation * all_of<V>(leg.model.heel_m),
                 hip = pelvis.hip(leg);
    const V span = length_of(ankle - hip);
    // What the tables ask for is let through.
    const V beyond = (span - known) / model.size;
    const auto asked = beyond > V{};
    if (!any(asked)) continue;
    const V soft = model.size * (kSoftReach_m + kWiderReach * min_of(beyond, all_of<V>(kWidest_m)));
    const double longest = kReach * leg.model.length_m();
    const V times = beyond / kKnown_m;
    const V excess = soft_positive(V(span - longest), soft) * times * times / (1.0 + times * times);
    const V upright = max_of(V(0.3 * span), V(hip.y - ankle.y)) / span;
    squares += asked ? excess * excess / (upright * upright) : V{};
  }
  return y - sqrt_of(squares);
}

// --- The whole plan ------------------------------------------------------------------------------

template <class V>
void plan_walks(const Tick& tick, const MomentOf<V>& at, const ParamsOf<V>& params,
                StateOf<V>& state, PlanOf<V>& plan, PelvisOf<V>& pelvis) noexcept {
  smooth_parameters<V>(tick, at, params, state);
  state.path.heading_rad += state.gait.turn_rate.x * tick.dt_s;
  plan_landing<V>(tick, at, state);
  plan_stride<V>(tick, at, state, plan);
  advance_hips<V>(tick, at, state, plan);
  for (const Side side : {kLeftSide, kRightSide}) plan_foot<V>(tick, at, state, plan, side);
  pelvis = pelvis_over_ground<V>(tick.model, state, plan);
  for (const Side side : {kLeftSide, kRightSide})
    rise_as_asked<V>(tick.model, at, state, side, pelvis.hip(tick.model.leg[side]));
  pelvis.position_m.y = pelvis_height<V>(tick.model, state, plan, pelvis);
  for (const Side side : {kLeftSide, kRightSide})
    reach_with_toe<V>(tick.model, at, state, side, pelvis.hip(tick.model.leg[side]));
}

}  // namespace
}  // namespace gaitpad
