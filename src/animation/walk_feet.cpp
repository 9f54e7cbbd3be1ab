// Where the feet are to be, before any inverse kinematics.
//
// A foot is always in one of three modes. In support it stands on its toe, and the heel may rise.
// In flight its heel follows the flight path of the data, stretched to go from where it lifted to
// where it is to land. In roll it has landed on its heel, and the toe comes down. A foot's pose is
// a place (of the heel or the toe), a direction and a pitch. When the mode changes, what the pose
// and its rate differ by from the new mode's plan fades away as a cubic, so nothing jumps.
//
// Heights and pitches count from the plane that the foot is planned on: the ground under its sole,
// and in flight a line from the plane it left to the plane it will land on.
#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

constexpr double kClearance_m = 0.012;     // least toe clearance in flight, at the reference leg
constexpr double kToeUpAtStrike_m = 0.05;  // toe's height over its rest when the heel strikes
constexpr double kRiseBegin = 0.20, kRiseLasts = 0.18;  // own phase: the heel may rise
// Of the leg: with the hip further away, a standing foot rises on its toe.
constexpr double kReachOnToe = 0.993, kReachOfLame = 0.9965, kReachUpright = 1.01;
constexpr double kRiseAhead =
    22.0;                       // 1/s: the rate at which a heel may approach its greatest pitch
constexpr double kAhead = 0.1;  // of the leg: a hip so far before the toe lets the foot push off
constexpr double kSoftPitch = 8.0 * kDegree, kWidePitch = 25.0 * kDegree;
// Near the greatest pitch the ankle hardly rises any more, so the reach is given up softly there.
constexpr double kMostUpright = 0.99, kSoftUpright = 0.12;
constexpr double kMaxPitch = 85.0 * kDegree, kMaxPlannedPitch = 80.0 * kDegree;
constexpr double kMinPitch = -28.0 * kDegree;      // toe up
constexpr double kRollEnd = 0.95;                  // of the roll: the toe is down
constexpr double kMostOvershoot = 12.0 * kDegree;  // of the push-off's pitch rate
constexpr double kLamePeak = 0.9;       // height of a lame foot's flight, over what it asks for
constexpr double kLameFade = 0.15;      // of kLiftFade, for a foot that does not lift at all
constexpr double kBackwardPitch = 0.6;  // of the data's: the foot reaches back, toe down
constexpr double kStopping = 0.6;       // of the flight: from here the heel comes to a stop
// A foot that goes down is lifted less: by the factor kLiftDown from a fall of kDown legs on. So is
// a foot that goes far up: its way over the riser is lift enough, and the knee folds only so far.
constexpr double kLiftDown = 0.4, kDown = 0.2;
constexpr double kLiftUp = 0.5, kHighUp = 0.2, kHighestUp = 0.345;
constexpr double kInPlace_m = 0.1;  // a flight shorter than this climbs by time, not by place
constexpr double kLiftFade = 0.5;   // of the flight: the lift-off's own motion has faded
constexpr double kPushUp = 0.1;     // of the leg: backwards, a foot pushes off for such a rise

double asin(double x) noexcept { return kPi / 2.0 - acos(x); }

vec3 heel_to_toe(const LegBuild& leg, const FootPose& pose) noexcept {
  return foot_rotation(leg, pose) * (leg.model.toe_m - leg.model.heel_m);
}

// Factor on the data's pitch: shorter steps roll the foot less.
double pitch_scale(const WalkModel& model, const WalkState& state, Side side) noexcept {
  const double r = pace(model, state, side);
  return state.amplitude.x * std::min(1.2, 0.25 + 0.75 * r);
}

double support_pitch(const WalkModel& model, const WalkState& state, Side side) noexcept {
  if (state.backward) return 0.0;  // the front foot leaves the ground as a whole
  const double own = own_phase(model, state, side);
  const double height = std::min(1.0, state.flight_height[side].x);
  const double pitch =
      pitch_scale(model, state, side) * std::max(0.0, model.leg[side].pitch_rad.at(own));
  return heel_rise(model, state, side) * height * soft_min(pitch, kMaxPlannedPitch, kWidePitch);
}

double flight_pitch(const WalkModel& model, const WalkState& state, Side side, double u) noexcept {
  const LegBuild& leg = model.leg[side];
  const double scale = pitch_scale(model, state, side);
  if (state.backward) {
    // Backwards a foot lands flat, the toe a moment ahead of the heel.
    const double share = kBackwardPitch * scale * (1.0 - smoothstep(0.55, 1.0, u));
    const double pitch = share * leg.pitch_rad.at(1.0 - u * (1.0 - leg.toe_off));
    return soft_max(soft_min(pitch, kMaxPlannedPitch, kWidePitch), kMinPitch, kSoftPitch);
  }
  const double own = leg.toe_off + u * (1.0 - leg.toe_off);
  const double at_strike = scale * leg.pitch_rad.at(1.0);
  const double wanted = -scale * asin(kToeUpAtStrike_m * model.size / leg.foot_m);
  const double pitch = soft_min(scale * leg.pitch_rad.at(own), kMaxPlannedPitch, kWidePitch) +
                       std::min(0.0, wanted - at_strike) * smoothstep(0.4, 1.0, u);
  return soft_max(pitch, kMinPitch, kSoftPitch);
}

// A lame foot does not swing up with the push-off, so the lift-off's motion fades sooner.
double lift_share(const WalkState& state, Side side) noexcept {
  return mix(kLameFade, 1.0, std::clamp(state.flight_height[side].x, 0.0, 1.0));
}

// In a turn the foot pivots on its planted toe as its heel rises.
double pivot_rate(const WalkModel& model, const WalkState& state, Side side) noexcept {
  return state.turn_rate.x * heel_rise(model, state, side);
}

// --- The flight path -----------------------------------------------------------------------------

// The data's flight, or the same run back.
struct FlightPath {
  const FootFlight& data;
  bool backward;
  double progress(double u) const noexcept {
    return backward ? 1.0 - data.progress.at(1.0 - u) : data.progress.at(u);
  }
  double start_slope() const noexcept {
    return backward ? data.progress.end_slope() : data.progress.start_slope();
  }
  double end_slope() const noexcept {
    return backward ? data.progress.start_slope() : data.progress.end_slope();
  }
  double height_m(double u) const noexcept { return data.height_m.at(backward ? 1.0 - u : u); }
  double start_climb_m() const noexcept {
    return backward ? 0.0 - data.height_m.end_slope() : data.height_m.start_slope();
  }
};

// The share of the climb, from one plane's height to the other's, that a flying foot has behind it:
// the same as the share of its way over the ground, or of its time where it flies in place. It is 0
// where a riser is crossed: then FlightRoom raises the foot.
struct Ascent {
  vec3 along_1_m{0.0};
  double by_time = 0.0;
  double at(const vec3& gone_m, double u) const noexcept {
    return glm::dot(gone_m, along_1_m) + by_time * (1.0 - h00(u));
  }
};
Ascent ascent(const WalkModel& model, const FootState& foot, const vec3& way_m) noexcept {
  Ascent a;
  if (foot.crosses_riser) return a;
  const double square = way_m.x * way_m.x + way_m.z * way_m.z;
  const double in_place = kInPlace_m * kInPlace_m * model.size * model.size;
  a.along_1_m = vec3(way_m.x, 0.0, way_m.z) / (square + in_place);
  a.by_time = in_place / (square + in_place);
  return a;
}

// The heel's place, and the height of the ground line below it.
vec3 flight_heel(const WalkModel& model, const WalkState& state, Side side, double u,
                 double& base_m) noexcept {
  const LegBuild& leg = model.leg[side];
  const FootState& foot = state.foot[side];
  const vec3 way = state.landing_m - foot.lift_m;
  const FlightPath path = {leg.flight, state.backward};
  // The data's heel still moves at its strike, but this one has to stop: the difference is made up
  // at the end of the flight.
  const double end = std::max(0.0, (u - kStopping) / (1.0 - kStopping));
  vec3 p = foot.lift_m + way * path.progress(u) +
           (foot.lift_slope_m - way * path.start_slope()) * h10(u) -
           way * (path.end_slope() * (1.0 - kStopping) * h11(end));
  const double able = std::clamp(state.flight_height[side].x, 0.0, 1.0);
  const double begin_m = height_on(foot.plane, foot.lift_m), rise = state.landing_m.y - begin_m;
  const double rise_legs = rise / model.leg_length_m;
  const double k = mix(kLamePeak, 1.0, able) * state.flight_height[side].x *
                   std::min(1.1, 0.35 + 0.65 * full_pace(model, state)) *
                   mix(1.0, kLiftDown, smoothstep(0.0, kDown, -rise_legs)) *
                   mix(1.0, kLiftUp, smoothstep(kHighUp, kHighestUp, rise_legs));
  const Ascent risen = ascent(model, foot, way);
  const double base_slope = rise * glm::dot(foot.lift_slope_m, risen.along_1_m);
  base_m = begin_m + rise * risen.at(p - foot.lift_m, u);
  const Fade lift = {foot.lift_m.y - begin_m - k * path.height_m(0.0),
                     foot.lift_slope_m.y - base_slope - k * path.start_climb_m(),
                     kLiftFade * lift_share(state, side)};
  p.y =
      base_m + std::max(0.0, k * path.height_m(u) + lift.at(u)) * (1.0 - smoothstep(0.65, 1.0, u));
  return p;
}

// --- The reach of a standing leg -----------------------------------------------------------------

// How much higher the other foot stands, or will land, than this one stands.
double rise_to_other(const WalkState& state, Side side) noexcept {
  const FootState& to = state.foot[other(side)];
  const double height_m = to.mode == FootMode::flight ? state.landing_m.y : to.plane.place_m.y;
  return height_m - state.foot[side].plane.place_m.y;
}

// The pitch at which the ankle, turning about the planted toe, is as far from the hip as the leg
// reaches: P cos + Q sin = K in the foot's own vertical plane.
double pitch_in_reach(const LegBuild& leg, const FootPose& pose, const vec3& hip_m,
                      double reach) noexcept {
  const vec3 d = rotation_y(-pose.yaw_rad) * (glm::inverse(pose.tilt) * (hip_m - pose.toe_m)),
             c = -leg.model.toe_m;
  const double df = glm::dot(d, leg.forward), cf = glm::dot(c, leg.forward);
  const double ds = glm::dot(d, leg.side), cs = glm::dot(c, leg.side);
  const double p = df * cf + d.y * c.y, q = df * c.y - d.y * cf;
  const double k = 0.5 * (glm::dot(d, d) + glm::dot(c, c) - reach * reach) - ds * cs;
  const double m = std::sqrt(p * p + q * q);
  if (m < 1e-9) return 0.0;
  return soft_min(atan2(q, p) - acos(soft_min(k / m, kMostUpright, kSoftUpright)), kMaxPitch,
                  kWidePitch);
}

// How far a standing foot may still rise, as the hips were a tick ago.
double left_to_rise(const LegBuild& leg, const WalkState& state, const FootState& foot) noexcept {
  const vec3 hip = state.frame.pelvis_m + rotation_y(state.heading_rad) * leg.model.hip_m;
  return std::max(0.0, pitch_in_reach(leg, foot.pose, hip, 0.0) - foot.pose.pitch_rad);
}

}  // namespace

double heel_rise(const WalkModel& model, const WalkState& state, Side side) noexcept {
  const bool stays = state.closing && side != step_foot(state);
  if (state.stage == Stage::idle || !state.started || stays) return 0.0;
  const double begin =
      std::max(kRiseBegin, model.share[side == kRightSide ? 0 : 2]);  // after the roll
  return smoothstep(begin, begin + kRiseLasts, own_phase(model, state, side));
}

quat foot_rotation(const LegBuild& leg, const FootPose& pose) noexcept {
  return pose.tilt * (rotation_y(pose.yaw_rad) * rotation_about(leg.side, pose.pitch_rad));
}

double heel_height(const FootState& foot) noexcept {
  return (foot.pose.heel_m.y - foot.base_m) * foot.plane.normal.y;
}

double highest_pitch(const LegBuild& leg, double heel_m, double clearance_m) noexcept {
  const double low = (leg.model.toe_rest_m + clearance_m - heel_m) / leg.foot_m;
  return leg.elevation_rad - asin(std::clamp(low, -1.0, 1.0));
}

void set_pitch(const LegBuild& leg, double pitch_rad, FootPose& pose, FootMode mode) noexcept {
  pose.pitch_rad = pitch_rad;
  const vec3 line = heel_to_toe(leg, pose);
  if (mode == FootMode::support) {
    pose.heel_m = pose.toe_m - line;
  } else {
    pose.toe_m = pose.heel_m + line;
  }
}

FlightPoint flight_point(const WalkModel& model, const WalkState& state, Side side, double u,
                         double pitch_fade_rad) noexcept {
  const LegBuild& leg = model.leg[side];
  const FootState& foot = state.foot[side];
  FlightPoint point;
  FootPose& pose = point.pose;
  pose.heel_m = flight_heel(model, state, side, u, point.base_m);
  const double gone = 1.0 - h00(u);
  const double turn = state.landing_heading_rad - foot.lift_yaw_rad;
  pose.yaw_rad = foot.lift_yaw_rad + turn * gone + foot.lift_turn_rad * h10(u);
  pose.tilt = foot.plane.tilt;
  if (pose.tilt != state.landing_plane.tilt) {
    pose.tilt = glm::normalize(pose.tilt * (1.0 - gone) + state.landing_plane.tilt * gone);
  }
  const double open = smoothstep(0.0, 0.25, u) * (1.0 - smoothstep(0.75, 1.0, u));
  const double height = (pose.heel_m.y - point.base_m) * foot.plane.normal.y;
  const double limit = highest_pitch(leg, height, kClearance_m * model.size * open);
  const double pitch = flight_pitch(model, state, side, u) + pitch_fade_rad;
  set_pitch(leg, soft_min(pitch, limit, std::max(1e-9, kSoftPitch * open)), pose, FootMode::flight);
  return point;
}

void plan_foot(const Tick& tick, WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  const LegBuild& leg = model.leg[side];
  FootState& foot = state.foot[side];
  const double fade = foot.pitch_fade.at(foot.mode_ticks);
  foot.pose.tilt = foot.plane.tilt;
  foot.base_m = foot.plane.place_m.y;
  if (foot.mode == FootMode::support) {
    foot.pose.toe_m = foot.toe_anchor_m;
    // The hips' height and the reach depend on each other, so the reach of the last two ticks is
    // extrapolated.
    const double last = foot.planned_rad + foot.reach_rad[0];
    foot.planned_rad = support_pitch(model, state, side) + fade;
    double reach = std::max(0.0, 2.0 * foot.reach_rad[0] - foot.reach_rad[1]);
    // Limit the reach near the greatest pitch, so that the hips stay supported.
    if (!tick.flat) {
      const double most =
          last - foot.planned_rad + kRiseAhead * tick.dt_s * left_to_rise(leg, state, foot);
      reach = std::clamp(most, 0.0, reach);
    }
    set_pitch(leg, foot.planned_rad + reach, foot.pose, foot.mode);
  } else if (foot.mode == FootMode::roll) {
    foot.pose.heel_m = foot.heel_anchor_m;
    set_pitch(leg, fade, foot.pose, foot.mode);
  } else {
    const double u = flight_progress(state);
    const double toe_rad = foot.pose.toe_rad;
    const FlightPoint point = flight_point(model, state, side, u, fade);
    foot.pose = point.pose;
    foot.pose.toe_rad = toe_rad;
    foot.base_m = point.base_m;
    if (!tick.flat) keep_room(tick, state, side, u);
  }
}

void reach_with_toe(const WalkModel& model, WalkState& state, Side side,
                    const vec3& hip_m) noexcept {
  FootState& foot = state.foot[side];
  if (foot.mode != FootMode::support) return;
  const LegBuild& leg = model.leg[side];
  const double planned = foot.planned_rad;
  const double gate = heel_rise(model, state, side);
  // Under the hips the leg may be longer, so that a standing foot stays flat.
  const vec3 forward = rotation_y(foot.pose.yaw_rad) * leg.forward;
  const double ahead = glm::dot(hip_m - foot.pose.toe_m, forward) / leg.model.length_m();
  const double pushes_off =
      state.backward ? smoothstep(0.0, kPushUp, rise_to_other(state, side) / leg.model.length_m())
                     : smoothstep(0.0, kAhead, ahead);
  const double able = std::clamp(state.flight_height[side].x, 0.0, 1.0);
  const double reach =
      leg.model.length_m() * mix(kReachUpright, mix(kReachOfLame, kReachOnToe, able), pushes_off);
  const double pitch = gate == 0.0
                           ? planned
                           : mix(planned,
                                 soft_max(planned, pitch_in_reach(leg, foot.pose, hip_m, reach),
                                          std::clamp(0.5 * planned, 1e-3, kSoftPitch)),
                                 gate);
  foot.reach_rad = {pitch - planned, foot.reach_rad[0]};
  set_pitch(leg, pitch, foot.pose, foot.mode);
}

void remember_foot(FootState& foot) noexcept {
  foot.last_heel_m = {foot.pose.heel_m, foot.last_heel_m[0]};
  foot.last_pitch_rad = {foot.pose.pitch_rad, foot.last_pitch_rad[0]};
}

void begin_support(FootState& foot, const LegAngles& even_rad) noexcept {
  foot.mode = FootMode::support;
  foot.mode_ticks = 0;
  foot.toe_anchor_m = foot.pose.toe_m;
  foot.pitch_fade = {};
  foot.planned_rad = 0.0;
  foot.reach_rad = {};
  foot.anchor_rad = even_rad;
}

void begin_flight(const Tick& tick, WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  FootState& foot = state.foot[side];
  const double ticks = state.stage_ticks;
  foot.mode = FootMode::flight;
  foot.mode_ticks = 0;
  foot.lift_m = foot.pose.heel_m;
  foot.lift_slope_m = end_slope(foot.last_heel_m[1], foot.last_heel_m[0], foot.pose.heel_m) * ticks;
  foot.lift_yaw_rad = foot.pose.yaw_rad;
  foot.crosses_riser = !tick.flat && crosses_riser(*model.terrain, foot.plane, state.landing_plane);
  foot.lift_turn_rad = pivot_rate(model, state, side) * tick.dt_s * ticks;
  foot.anchor_rad = state.even_rad[side];
  const double rate =
      end_slope(foot.last_pitch_rad[1], foot.last_pitch_rad[0], foot.pose.pitch_rad);
  const double plan = flight_pitch(model, state, side, 0.0);
  const double plan_rate = (flight_pitch(model, state, side, 1.0 / ticks) - plan);
  // A cubic that starts with slope s and ends flat after n ticks swings out by 4/27 s n.
  const double slope = rate - plan_rate;
  const double longest = 27.0 / 4.0 * kMostOvershoot / std::max(1e-9, std::abs(slope));
  foot.pitch_fade = {foot.pose.pitch_rad - plan, slope, std::min(kLiftFade * ticks, longest)};
  if (!tick.flat) plan_room(tick, state, side);
}

void begin_roll(WalkState& state, Side side) noexcept {
  FootState& foot = state.foot[side];
  const double rate =
      end_slope(foot.last_pitch_rad[1], foot.last_pitch_rad[0], foot.pose.pitch_rad);
  foot.mode = FootMode::roll;
  foot.mode_ticks = 0;
  foot.heel_anchor_m = foot.pose.heel_m;
  foot.plane = state.landing_plane;
  foot.anchor_rad = state.even_rad[side];
  // A cubic that starts faster than 3 h / T would undershoot, and the toe would go through the
  // floor.
  double ticks = kRollEnd * state.stage_ticks;
  const double pitch = foot.pose.pitch_rad;
  if (rate > 0.0) ticks = std::min(ticks, 2.9 * -pitch / rate);
  foot.pitch_fade = {pitch, rate, std::max(4.0, ticks)};
}

void hold_pitch(const WalkModel& model, WalkState& state, Side side, int ticks) noexcept {
  FootState& foot = state.foot[side];
  if (foot.mode != FootMode::support) return;
  const double held =
      foot.planned_rad + foot.reach_rad[0];  // the weights' own change does not count
  foot.mode_ticks = 0;
  foot.pitch_fade = {held - support_pitch(model, state, side), 0.0, static_cast<double>(ticks)};
}

}  // namespace gaitpad
