#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

// Lengths in metres at the reference leg.
constexpr double kReach = 0.9985;  // of the leg: the longest it gets, knee 6 degrees
constexpr double kEvenFront =
    0.46;  // of the step: front heel to hips where the data's lean is left
constexpr double kBackwardHips = 0.45;  // of a backward step: the weight follows the foot late
// Up a high riser (rises in legs) they go ahead of it, or its ankle would bend up too far.
constexpr double kBackwardHipsUp = 1.075, kHighRiser = 0.2, kHighestRiser = 0.3;
constexpr double kLongDrop_m = 0.05;  // of the hips in steps much longer than the data's
constexpr double kLameDrop_m = 0.1;   // of the hips for a foot that does not lift at all
constexpr double kShortStep = 0.1, kLeastShare = 0.3;  // of the data's step; of the wanted one
constexpr double kGroundSmoothing_s = 0.3;
constexpr double kStrikeSpeed = 0.6;  // of the mean: how fast the hips rise or sink at a strike
constexpr double kStandingKnee = 7.3 * kDegree, kSoftKnee = 4.0 * kDegree;
// Rounding of the hips' height: between the knees' curves and the reach, between the legs' reaches.
// The steps that it suits take this long; quicker ones are rounded more.
constexpr double kSoftBase_m = 0.02, kSoftReach_m = 0.03;
constexpr double kCalmStep_s = 0.52;

double power(double base, int exponent) noexcept {
  double result = 1.0;
  for (int e = exponent; e > 0; e >>= 1, base *= base) {
    if (e & 1) result *= base;
  }
  return result;
}

// The heading after n more ticks of a turn-rate filter whose goal stays: the filter is a linear
// recurrence with the double eigenvalue q, so e_k = (e_0 + c k) q^k, and its sum has a closed form.
double heading_ahead(const Tick& tick, const WalkState& state, int n) noexcept {
  const double goal = state.turn_goal.x;
  const double w = tick.dt_s / (kTurnSmoothing * tick.model.time_scale), q = 1.0 / (1.0 + w);
  const double e0 = state.turn_rate.x - goal;
  if (e0 == 0.0 && state.turn_rate.v == 0.0) return state.heading_rad + goal * n * tick.dt_s;
  const double e1 = e0 * (1.0 - w * w * q * q) + q * q * state.turn_rate.v * tick.dt_s;
  const double c = e1 / q - e0, qn = power(q, n);
  const double s0 = q * (1.0 - qn) / (1.0 - q);
  const double s1 = q * (1.0 - (n + 1) * qn + n * qn * q) / ((1.0 - q) * (1.0 - q));
  return state.heading_rad + (goal * n + e0 * s0 + c * s1) * tick.dt_s;
}

// beta: how much of a step's length the hips have covered, beyond their rest lead, at its strike.
// Steps far longer than the data's take an even stance instead of the data's lean.
double hips_share(const WalkModel& model, const WalkState& state) noexcept {
  if (state.backward) {
    const double rise = state.landing_m.y - state.foot[other(step_foot(state))].plane.place_m.y;
    return mix(kBackwardHips, kBackwardHipsUp,
               smoothstep(kHighRiser, kHighestRiser, rise / model.leg_length_m));
  }
  const double front = mix(model.step_front, kEvenFront, smoothstep(1.05, 1.5, state.pace.x));
  return ((1.0 - front) * model.source_step_m - model.rest_lead_m) / model.source_step_m;
}

// Mean speed of the hips between this step's strike and the one before, and the next one.
double hips_speed_at_strike(const Tick& tick, const WalkState& state) noexcept {
  if (state.closing) return 0.0;
  const Side swing = step_foot(state);
  const double beta = hips_share(tick.model, state);
  const bool goes_on = walks_on(tick.params, state);
  double now = step_length(state, swing), before = state.frame.stride_m[other(swing)],
         next = goes_on ? step_length(state, other(swing)) : 0.0;
  if (!tick.flat) {
    now = state.frame.stride_m[swing];
    next = goes_on ? state.landing.next_m : 0.0;
  }
  const double this_s = (state.roll_ticks + state.flight_ticks) * tick.dt_s;
  const double next_s = state.last_step_ticks > 0 ? state.last_step_ticks * tick.dt_s : this_s;
  return 0.5 * (((1.0 - beta) * before + beta * now) / this_s +
                ((1.0 - beta) * now + beta * next) / next_s);
}

// The ground that the hips go over, at a strike that of the lower foot, rises and falls along a
// cubic from strike to strike, as they go.
void advance_base(const Tick& tick, WalkState& state, double remaining_s) noexcept {
  const Side swing = step_foot(state), stand = other(swing);
  const double standing = state.foot[stand].plane.place_m.y, landing = state.landing_m.y;
  double goal = std::min(standing, landing);
  const double before = std::min(state.foot[swing].plane.place_m.y, standing);
  const double next = std::min(landing, state.landing.next_base_m);
  const double this_s = (state.roll_ticks + state.flight_ticks) * tick.dt_s;
  double velocity = state.closing ? 0.0 : kStrikeSpeed * 0.5 * (next - before) / this_s;
  // Upwards, a leg that does not roll far over its toe, in front backwards or closing a walk, would
  // be too short: they wait for its lift-off.
  if ((state.backward || state.closing) && next > before) {
    velocity = 0.0;
    if (state.stage == Stage::roll) {
      goal = before;
      remaining_s -= state.flight_ticks * tick.dt_s;
    }
  }
  approach(state.base_m, state.base_velocity_m_s, goal, velocity, remaining_s, tick.dt_s);
}

// Pelvis height at which a leg is as long from its hip to its ankle as `reach_m`.
double height_over(const LegBuild& leg, const FootPose& foot, const Pelvis& pelvis,
                   double reach_m) noexcept {
  const vec3 ankle = foot.heel_m - foot_rotation(leg, foot) * leg.model.heel_m;
  const vec3 hip = pelvis.hip(leg);  // pelvis.position_m.y is 0 here
  const double dx = hip.x - ankle.x, dz = hip.z - ankle.z;
  const double square = std::max(0.04 * reach_m * reach_m, reach_m * reach_m - dx * dx - dz * dz);
  return ankle.y - hip.y + std::sqrt(square);
}

// The height that a leg's knee curve in the data asks for.
double height_of_knee(const WalkModel& model, const WalkState& state, const Pelvis& pelvis,
                      Side side) noexcept {
  const LegModel& leg = model.leg[side].model;
  // As the data roll the foot: what the reach asks for beyond it follows from the height.
  FootPose foot = state.foot[side].pose;
  if (state.foot[side].mode == FootMode::support) {
    set_pitch(model.leg[side], state.foot[side].planned_rad, foot, FootMode::support);
  }
  const double data = model.reference_rad[side][kKneeX].at(data_phase(model, state));
  const double bend = presence(state) * soft_positive(data - kStandingKnee, kSoftKnee);
  const double a = leg.thigh_m, b = leg.shank_m;
  const double cosine = sin_cos(kStandingKnee + bend).cos;
  return state.base_m - state.foot[side].base_m +
         height_over(model.leg[side], foot, pelvis,
                     std::sqrt(a * a + b * b + 2.0 * a * b * cosine));
}

// Share of the weight on the left foot: it moves over during the roll, from and to both feet at
// rest.
double left_load(const WalkState& state) noexcept {
  if (state.stage == Stage::idle) return 0.5;
  double on_swing = 0.0;
  if (state.stage == Stage::roll) {
    const bool first = state.started && state.last_step_ticks == 0, last = !state.started;
    const double progress = static_cast<double>(state.tick) / state.stage_ticks;
    on_swing = mix(first ? 0.5 : 0.0, last ? 0.5 : 1.0, smoothstep(0.0, 1.0, progress));
  }
  return state.swing == kLeftSide ? on_swing : 1.0 - on_swing;
}

}  // namespace

double step_length(const WalkState& state, Side side) noexcept {
  if (state.closing) return 0.0;
  return state.backward ? 0.0 - state.length_m[side].x : state.length_m[side].x;
}

// Steps that the ground makes shorter roll and rise like short ones.
void follow_ground(const Tick& tick, WalkState& state, Side swing) noexcept {
  const double wanted = std::abs(step_length(state, swing));
  const double share =
      wanted < kShortStep * tick.model.source_step_m
          ? 1.0
          : std::clamp(std::abs(state.frame.stride_m[swing]) / wanted, kLeastShare, 1.0);
  state.ground_share.advance(share, kGroundSmoothing_s * tick.model.time_scale, tick.dt_s);
}

void plan_landing(const Tick& tick, WalkState& state) noexcept {
  if (state.stage == Stage::idle || !state.started) return;
  const Side swing = step_foot(state), stand = other(swing);
  const double heading = heading_ahead(tick, state, ticks_to_strike(state) + 1);
  const vec3 forward = heading_direction(heading), left = glm::cross(kUp, forward);
  const vec3 standing = state.foot[stand].heel_anchor_m;
  if (flight_progress(state) <= kFreeze) {
    const double width = tick.model.leg[swing].track_m - tick.model.leg[stand].track_m;
    state.landing_heading_rad = heading;
    state.landing_m = standing + forward * step_length(state, swing) + left * width;
    if (!tick.flat) choose_foothold(tick, state, forward, left * width);
  }
  // Along the heading that the landing will have, which may still turn after the place is settled.
  state.frame.stride_m[swing] = glm::dot(state.landing_m - standing, forward);
  if (!tick.flat) follow_ground(tick, state, swing);
}

void advance_hips(const Tick& tick, WalkState& state) noexcept {
  if (state.stage == Stage::idle || !state.started) {
    state.hips_velocity_m_s = vec3(0.0);
    return;
  }
  const WalkModel& model = tick.model;
  const Side swing = step_foot(state), stand = other(swing);
  const vec3 forward = heading_direction(state.landing_heading_rad),
             left = glm::cross(kUp, forward);
  const double lead = model.rest_lead_m + hips_share(model, state) * state.frame.stride_m[swing];
  vec3 goal = state.foot[stand].heel_anchor_m + forward * lead - left * model.leg[stand].track_m;
  goal.y = 0.0;
  const vec3 velocity = forward * hips_speed_at_strike(tick, state);
  const double remaining = (ticks_to_strike(state) + 1) * tick.dt_s;
  approach(state.hips_m, state.hips_velocity_m_s, goal, velocity, remaining, tick.dt_s);
  if (!tick.flat) advance_base(tick, state, remaining);
}

Pelvis pelvis_over_ground(const WalkModel& model, const WalkState& state) noexcept {
  const double a = presence(state), r = std::clamp(state.pace.x, 0.0, 1.0);
  const double phase = data_phase(model, state);
  const vec3 forward = heading_direction(state.heading_rad), left = glm::cross(kUp, forward);
  Pelvis pelvis;
  pelvis.position_m = state.hips_m + left * (a * model.sway_m.at(phase)) +
                      forward * (a * r * model.surge_m.at(phase));
  const double yaw = a * r * state.sway.x * model.yaw_rad.at(phase);
  const vec3 tilt(model.tilt[0].at(phase), model.tilt[1].at(phase), model.tilt[2].at(phase));
  pelvis.rotation = rotation_y(state.heading_rad + yaw) * from_rotation_vector(tilt * (a * r));
  return pelvis;
}

double pelvis_height(const WalkModel& model, const WalkState& state,
                     const Pelvis& pelvis) noexcept {
  const double load = left_load(state);
  double y = load * height_of_knee(model, state, pelvis, kLeftSide) +
             (1.0 - load) * height_of_knee(model, state, pelvis, kRightSide);
  const double r = state.pace.x, scale = presence(state) * std::clamp(r * r, 0.0, 1.5);
  y += scale * (state.bounce.x - 1.0) * model.bounce_m.at(data_phase(model, state));
  // Steps longer than the data's need lower hips, or the rear leg is too short for them.
  y -= kLongDrop_m * model.size * smoothstep(0.95, 1.4, r);
  // A lame foot hardly rises on its toe: the hips come down to it instead, around its lift-off.
  for (Side side : {kLeftSide, kRightSide}) {
    const double lame = 1.0 - std::min(1.0, state.flight_height[side].x);
    const double own = own_phase(model, state, side), lift = model.leg[side].toe_off;
    const double near = smoothstep(0.1, lift - 0.1, own) * (1.0 - smoothstep(lift, 1.0, own));
    y -= kLameDrop_m * model.size * lame * near * presence(state);
  }
  std::array<double, 2> highest;
  for (int side : {0, 1}) {
    const LegBuild& leg = model.leg[side];
    highest[side] = height_over(leg, state.foot[side].pose, pelvis, kReach * leg.model.length_m());
  }
  // Quick steps turn the same corners in less time, so they are cut wider.
  const double quick = kCalmStep_s / std::max(0.1, state.step_time_s.x);
  const double soft = model.size * std::clamp(quick * quick * quick, 1.0, 3.0);
  return soft_min(y, soft_min(highest[0], highest[1], kSoftReach_m * soft), kSoftBase_m * soft);
}

}  // namespace gaitpad
