#include "animation/walk_parts.h"

namespace gaitpad {

namespace {

constexpr double kClearance_m = 0.012;     // least toe clearance in flight, at the reference leg
constexpr double kToeUpAtStrike_m = 0.05;  // toe's height over its rest when the heel strikes
constexpr double kRiseBegin = 0.20, kRiseLasts = 0.18;  // own phase: the heel may rise
// Of the leg: with the hip further away, a standing foot rises on its toe.
constexpr double kReachOnToe = 0.993, kReachOfLame = 0.9965, kReachUpright = 1.01;
constexpr double kRiseAhead = 22.0;  // 1/s: the most of the way to its highest
constexpr double kAhead = 0.1;       // of the leg: the hip before the toe
constexpr double kSoftPitch = 8.0 * kDegree, kWidePitch = 25.0 * kDegree;
// Near its highest the ankle hardly rises any more: there the reach is given up softly.
constexpr double kMostUpright = 0.99, kSoftUpright = 0.12;
constexpr double kMaxPitch = 85.0 * kDegree, kMaxPlannedPitch = 80.0 * kDegree;
constexpr double kMinPitch = -28.0 * kDegree;      // toe up
constexpr double kRollEnd = 0.95;                  // of the roll: the toe is down
constexpr double kMostOvershoot = 12.0 * kDegree;  // of the push-off's pitch rate
constexpr double kLamePeak = 0.9;       // an able foot's peak lags behind its curve by as much
constexpr double kLameFade = 0.15;      // of kLiftFade, for a foot that does not lift at all
constexpr double kBackwardPitch = 0.6;  // of the data's: the foot reaches back, toe down
constexpr double kStopping = 0.6;       // of the flight: from here the heel comes to a stop
// A foot that goes down is lifted less: as much of it over a fall of this share of the leg. So is
// one that goes up far: its way over the riser is lift enough, and the knee folds only so much.
constexpr double kLiftDown = 0.4, kDown = 0.2;
constexpr double kLiftUp = 0.5, kHighUp = 0.2, kHighestUp = 0.345;
constexpr double kInPlace_m = 0.1;  // a way shorter than this is gone by time, not by place
constexpr double kLiftFade = 0.5;   // of the flight: what the lift-off brought has faded

constexpr double kPushUp = 0.1;  // of the leg: backwards a foot pushes off for such a rise

double asin(double x) noexcept { return kPi / 2.0 - acos(x); }

vec3 heel_to_toe(const LegBuild& leg, const FootPose& pose) noexcept {
  return foot_rotation(leg, pose) * (leg.model.toe_m - leg.model.heel_m);
}

// Scale of the data's pitch: smaller steps roll less, a lame foot rises less.
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
    // It lands flat, the toe a moment ahead of the heel.
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

// A lame foot does not swing up with the push-off: what the lift brought fades sooner.
double lift_share(const WalkState& state, Side side) noexcept {
  return mix(kLameFade, 1.0, std::clamp(state.flight_height[side].x, 0.0, 1.0));
}

// In a turn the foot pivots on its planted toe as its heel rises.
double pivot_rate(const WalkModel& model, const WalkState& state, Side side) noexcept {
  return state.turn_rate.x * heel_rise(model, state, side);
}

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

// How much of the way from one plane's height to the other's is behind a flying foot: as much as of
// its way over the ground (in place, by the time); nothing where a riser is between, see
// FlightRoom.
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

// The heel's place, and the height of the ground line below it from one plane to the other.
vec3 flight_heel(const WalkModel& model, const WalkState& state, Side side, double u,
                 double& base_m) noexcept {
  const LegBuild& leg = model.leg[side];
  const FootState& foot = state.foot[side];
  const vec3 way = state.landing_m - foot.lift_m;
  const FlightPath path = {leg.flight, state.backward};
  // The data's heel still moves when it strikes, ours stops: the difference is made up at the end.
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

// From a standing foot's ground to that where the other one stands or lands.
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
    // With what the reach asked for last, run on: the hips' height and the reach depend on each
    // other.
    const double last = foot.planned_rad + foot.reach_rad[0];
    foot.planned_rad = support_pitch(model, state, side) + fade;
    double reach = std::max(0.0, 2.0 * foot.reach_rad[0] - foot.reach_rad[1]);
    // But no further than a foot soon at its highest can follow: the hips would be left without it.
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
  // Under the hips the leg may be longer: a standing foot stays flat.
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
  // A cubic that starts faster than 3 h / T would undershoot: the toe would go through the floor.
  double ticks = kRollEnd * state.stage_ticks;
  const double pitch = foot.pose.pitch_rad;
  if (rate > 0.0) ticks = std::min(ticks, 2.9 * -pitch / rate);
  foot.pitch_fade = {pitch, rate, std::max(4.0, ticks)};
}

void hold_pitch(const WalkModel& model, WalkState& state, Side side, int ticks) noexcept {
  FootState& foot = state.foot[side];
  if (foot.mode != FootMode::support) return;
  const double held = foot.planned_rad + foot.reach_rad[0];  // without what the weights made of it
  foot.mode_ticks = 0;
  foot.pitch_fade = {held - support_pitch(model, state, side), 0.0, static_cast<double>(ticks)};
}

// How a flying foot clears what lies between two footholds. Its flight is planned over a ground
// line; the control points of a spline that makes this line are the greatest heights of the ground
// below the sole in their neighbourhood, and a B-spline stays within the hull of its control
// points: above all of that ground and never higher than its highest. Between footholds without a
// riser the line is straight, and the spline is what it lacks. At a riser close to a foothold,
// where height comes too late (or goes too early), the foot keeps away from it. Down stairs the
// foot goes ahead of its flight, and the line is drawn taut over the edges.

namespace {

constexpr int kProbes = 48;            // along a flight
constexpr double kRoomAbove_m = 0.02;  // at the reference leg, as the following
constexpr double kRoomBeside_m = 0.005, kRoomAhead_m = 0.016, kMostShift_m = 0.25, kRiser_m = 0.01;
constexpr double kLack_m = 0.008, kEasyShift_m = 0.2, kSharper = 1.5;
constexpr int kTries = 4;
constexpr double kOver = 0.67;  // of the flight: a falling foot is over its landing's piece
constexpr int kMostRisers = 4, kTautRounds = 24;
constexpr double kTautRoom = 0.5;  // of kRoomAbove_m
constexpr double kLeastWeight = 1e-6, kLeastLeft_m = 1e-6;
constexpr double kLeastWanted_m = 0.004, kMostGain = 6.0;
constexpr double kRoomSmoothing_s = 0.04;
constexpr double kReplan_m = 0.005;  // of the landing

// The spline through 0 and `end` with slope 0 there.
template <class Knots, class Value>
constexpr double spline_at(const Knots& knots, double end, double u, const Value& value) noexcept {
  constexpr int n = kFlightKnots;
  const auto control = [&](int k) {
    if (k <= 0) return value(knots[0]) * (k == 0 ? -0.5 : 1.0);
    if (k < n) return value(knots[k - 1]);
    return k == n ? 1.5 * end - 0.5 * value(knots[n - 2]) : value(knots[n - 2]);
  };
  const double x = std::clamp(u, 0.0, 1.0) * n;
  const int i = std::min(static_cast<int>(x), n - 1);
  const double t = x - i, t2 = t * t, t3 = t2 * t;
  return (control(i - 1) * (1.0 - 3.0 * t + 3.0 * t2 - t3) +
          control(i) * (4.0 - 6.0 * t2 + 3.0 * t3) +
          control(i + 1) * (1.0 + 3.0 * t + 3.0 * t2 - 3.0 * t3) + control(i + 2) * t3) /
         6.0;
}
constexpr double spline_at(const FlightSpline& knots, double end, double u) noexcept {
  return spline_at(knots, end, u, [](double k) { return k; });
}

// 1 in mid-flight, 0 at its ends.
double in_flight(double u) noexcept {
  return smoothstep(0.0, 0.2, u) * (1.0 - smoothstep(0.8, 1.0, u));
}

using Wanted = std::array<double, kProbes + 1>;

// Outer knots over their neighbours: the less, the gentler the ends.
struct Ends {
  double first = 0.2, last = 0.2;
};

// At each knot the greatest value within its reach; the outer ones end the spline gently.
FlightSpline envelope(const Wanted& wanted, const Ends& ends) noexcept {
  FlightSpline knots;
  for (int k = 1; k < kFlightKnots; ++k) {
    double& knot = knots[k - 1];
    knot = wanted[k * kProbes / kFlightKnots];
    for (int i = 0; i <= kProbes; ++i) {
      if (std::abs(i * kFlightKnots - k * kProbes) < 2 * kProbes) knot = std::max(knot, wanted[i]);
    }
  }
  const auto gentle = [](double knot, double end, double next, double share) {
    const double most = share * std::abs(next - end);
    return std::clamp(knot, end - most, end + most);
  };
  knots.front() = gentle(knots.front(), 0.0, knots[1], ends.first);
  knots.back() = gentle(knots.back(), wanted.back(), knots[kFlightKnots - 3], ends.last);
  return knots;
}

// The same of the greatest magnitudes; where it falls short of them, all of it times a gain,
// up to `most`.
FlightSpline wide_envelope(const Wanted& wanted, double most) noexcept {
  Wanted positive, negative;
  for (int i = 0; i <= kProbes; ++i) {
    positive[i] = std::max(0.0, wanted[i]);
    negative[i] = std::max(0.0, -wanted[i]);
  }
  FlightSpline knots = envelope(positive, Ends{});
  const FlightSpline other = envelope(negative, Ends{});
  for (int k = 0; k < kFlightKnots - 1; ++k) knots[k] -= other[k];
  double gain = 1.0;
  for (int i = 1; i < kProbes; ++i) {
    if (std::abs(wanted[i]) < kLeastWanted_m) continue;
    const double got = spline_at(knots, 0.0, static_cast<double>(i) / kProbes);
    gain = std::max(gain, got * wanted[i] > 0.0 ? wanted[i] / got : 1.0);
  }
  for (double& knot : knots) knot = std::clamp(knot * std::min(gain, kMostGain), -most, most);
  return knots;
}

// Makes an end less gentle where the way beside is long or not got. False: both do.
bool sharpen(const Wanted& beside, const FlightSpline& shift, double size, Ends& ends) noexcept {
  Ends more = ends;
  for (int i = 1; i < kProbes; ++i) {
    const double got = spline_at(shift, 0.0, static_cast<double>(i) / kProbes);
    const double lack = beside[i] > 0.0 ? beside[i] - got : beside[i] < 0.0 ? got - beside[i] : 0.0;
    if (lack < kLack_m * size && std::abs(beside[i]) < kEasyShift_m * size) continue;
    (2 * i < kProbes ? more.first : more.last) =
        kSharper * (2 * i < kProbes ? ends.first : ends.last);
  }
  const bool any = more.first > ends.first || more.last > ends.last;
  ends = more;
  return any;
}

using Sole = std::array<vec3, 5>;  // heel and tip on both sides, ball
Sole sole_of(const LegBuild& leg, const FootPose& pose) noexcept {
  const quat foot = foot_rotation(leg, pose);
  const quat toes = foot * rotation_about(leg.side, -std::max(0.0, pose.pitch_rad));
  const vec3 ball = pose.heel_m + foot * (leg.ball_m - leg.model.heel_m);
  const vec3 tip = ball + toes * (leg.tip_m - leg.ball_m);
  const vec3 side = foot * leg.side * leg.half_width_m;
  return {pose.heel_m - side, pose.heel_m + side, ball, tip - side, tip + side};
}

// The plane through the heel's ground that the pose is tilted to.
double base_under(const FlightPoint& point, const vec3& p) noexcept {
  const vec3 n = point.pose.tilt * kUp;
  return point.base_m -
         (n.x * (p.x - point.pose.heel_m.x) + n.z * (p.z - point.pose.heel_m.z)) / n.y;
}

// How far to move along z so that no part of the sole is beyond a riser at an end of `piece` that
// leads up from `height_m`.
double way_back(const Terrain& terrain, const Sole& sole, const Stretch& piece, double height_m,
                double room, double size) noexcept {
  double shift = 0.0;
  for (const vec3& p : sole) {
    const bool ahead_up =
        ground_at(terrain, p.x, piece.to_m + kRiser_m).height_m > height_m + kRiser_m;
    const bool behind_up =
        ground_at(terrain, p.x, piece.from_m - kRiser_m).height_m > height_m + kRiser_m;
    if (ahead_up) shift = std::min(shift, piece.to_m - room - p.z);
    if (behind_up) shift = std::max(shift, piece.from_m + room - p.z);
  }
  return std::clamp(shift, -kMostShift_m * size, kMostShift_m * size);
}

// Of the ground line, from lift-off to landing, where the spline has to make it.
double climb(const WalkState& state, const FootState& foot) noexcept {
  return foot.crosses_riser ? state.landing_m.y - height_on(foot.plane, foot.lift_m) : 0.0;
}

// A flight as planned over its ground line.
struct Flight {
  std::array<FlightPoint, kProbes + 1> point;
  std::array<Sole, kProbes + 1> sole;
  Wanted left{};  // of the way along z
  Stretch begin, end;
  double begin_room = 0.0;
  double climb = 0.0;
};
Flight planned_flight(const Tick& tick, const WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  const FootState& foot = state.foot[side];
  Flight flight;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    flight.point[i] =
        flight_point(model, state, side, u, foot.pitch_fade.at(u * state.stage_ticks));
    flight.sole[i] = sole_of(model.leg[side], flight.point[i].pose);
    flight.left[i] = state.landing_m.z - flight.point[i].pose.heel_m.z;
  }
  flight.begin = piece_at(*model.terrain, foot.plane.place_m.z);
  flight.end = piece_at(*model.terrain, state.landing_m.z);
  flight.begin_room = kRoomAhead_m * model.size;  // as the pitch may still come out otherwise
  for (const vec3& p : flight.sole.front())
    flight.begin_room = std::min(
        {flight.begin_room, 0.7 * (flight.begin.to_m - p.z), 0.7 * (p.z - flight.begin.from_m)});
  flight.climb = climb(state, foot);
  return flight;
}

// How far the ground line has to rise for the sole, moved along z by `shift`.
Wanted wanted_raise(const Tick& tick, const Flight& flight, bool crosses_riser,
                    const FlightSpline& shift) noexcept {
  const Terrain& terrain = *tick.model.terrain;
  const double above_m = kRoomAbove_m * tick.model.size;
  Wanted above;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes, moved = spline_at(shift, 0.0, u);
    double over = -tick.model.leg_length_m;
    for (const vec3& p : flight.sole[i])
      over = std::max(
          over, ground_at(terrain, p.x, p.z + moved).height_m - base_under(flight.point[i], p));
    above[i] = crosses_riser ? over + above_m * in_flight(u)
                             : std::max(0.0, over) + std::clamp(over, 0.0, above_m);
  }
  above.front() = 0.0;
  above.back() = flight.climb;
  return above;
}

// Takes what leads towards the landing, in the second half of a flight, out of `beside`: it becomes
// a share of the way that is left, and one that only grows, so that the foot is over its landing
// early and sinks to it, it does not go beyond it and come back.
FlightSpline lead_in(const Flight& flight, Wanted& beside) noexcept {
  FlightSpline knots;
  double share = 0.0;
  for (int k = 1; k < kFlightKnots; ++k) {
    for (int i = kProbes / 2; i < std::min(kProbes, (k + 2) * kProbes / kFlightKnots); ++i) {
      if (beside[i] * flight.left[i] > 0.0)
        share = std::max(share, std::min(1.0, beside[i] / flight.left[i]));
    }
    knots[k - 1] = share * flight.left[k * kProbes / kFlightKnots];
  }
  for (int i = kProbes / 2; i < kProbes; ++i) {
    if (beside[i] * flight.left[i] > 0.0) beside[i] = 0.0;
  }
  return knots;
}

// Every flight that does not only lead down.
void plan_over(const Tick& tick, const WalkState& state, const FootState& foot,
               const Flight& flight, FlightRoom& room) noexcept {
  const double size = tick.model.size;
  const Terrain& terrain = *tick.model.terrain;
  const Wanted above = wanted_raise(tick, flight, foot.crosses_riser, FlightSpline{});
  Wanted beside{};
  // As gently as it does.
  Ends ends;
  for (int tries = 0; tries < kTries; ++tries) {
    room.raise_m = envelope(above, ends);
    for (int i = 1; i < kProbes; ++i) {
      beside[i] = 0.0;
      if (above[i] <= spline_at(room.raise_m, above.back(), static_cast<double>(i) / kProbes))
        continue;
      beside[i] = 2 * i < kProbes ? way_back(terrain, flight.sole[i], flight.begin,
                                             foot.plane.place_m.y, flight.begin_room, size)
                                  : way_back(terrain, flight.sole[i], flight.end, state.landing_m.y,
                                             kRoomBeside_m * size, size);
    }
    Wanted away = beside;
    room.shift_m = lead_in(flight, away);
    const FlightSpline back = wide_envelope(away, kMostShift_m * size);
    for (int k = 0; k < kFlightKnots - 1; ++k) room.shift_m[k] += back[k];
    if (!sharpen(beside, room.shift_m, size, ends)) break;
  }
}

// The smallest way on to where no part of the sole is before the landing's piece and over ground
// higher than the ground line with `raise`.
double way_on(const Tick& tick, const Flight& flight, int i, double raise) noexcept {
  const Terrain& terrain = *tick.model.terrain;
  const double room = kRoomBeside_m * tick.model.size, least = kLeastWanted_m * tick.model.size;
  const bool ahead = flight.left[i] > 0.0;
  double on = 0.0;
  for (int risers = 0; risers < kMostRisers; ++risers) {
    for (const vec3& p : flight.sole[i]) {
      const double z = p.z + on;
      if (ahead ? z >= flight.end.from_m : z <= flight.end.to_m) continue;
      if (ground_at(terrain, p.x, z).height_m <= base_under(flight.point[i], p) + raise + least)
        continue;
      const Stretch piece = piece_at(terrain, z);
      on += ahead ? piece.to_m + room - z : piece.from_m - room - z;
    }
  }
  return on;
}

// Of each knot along the flight.
constexpr auto kKnotWeights = [] {
  std::array<Wanted, kFlightKnots - 1> weights;
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    FlightSpline alone{};
    alone[k] = 1.0;
    for (int i = 0; i <= kProbes; ++i)
      weights[k][i] = spline_at(alone, 0.0, static_cast<double>(i) / kProbes);
  }
  return weights;
}();

// Draws the inner knots to a taut line over what is wanted, less some of its room: the envelope
// alone holds each height for two knots longer than needed. Where the spline lacks more already, it
// sinks no further.
void draw_taut(const Wanted& wanted, double room_m, FlightSpline& knots) noexcept {
  Wanted slack;
  for (int i = 0; i <= kProbes; ++i) {
    const double u = static_cast<double>(i) / kProbes;
    const double spare = (1.0 - kTautRoom) * room_m * in_flight(u);
    slack[i] = std::max(0.0, spline_at(knots, wanted.back(), u) - wanted[i] + spare);
  }
  for (int round = 0; round < kTautRounds; ++round) {
    for (int k = kFlightKnots - 3; k > 0; --k) {
      const Wanted& weight = kKnotWeights[k];
      double fall = knots[k] - 0.5 * (knots[k - 1] + knots[k + 1]);
      for (int i = 0; i <= kProbes; ++i) {
        if (weight[i] > kLeastWeight) fall = std::min(fall, slack[i] / weight[i]);
      }
      knots[k] -= fall;
      for (int i = 0; i <= kProbes; ++i) slack[i] -= fall * weight[i];
    }
  }
}

// Over risers that all lead down.
bool leads_down(const Tick& tick, const Flight& flight) noexcept {
  if (flight.climb > -kRiser_m) return false;
  const Wanted above = wanted_raise(tick, flight, true, FlightSpline{});
  return *std::max_element(above.begin(), above.end()) < kRoomAbove_m * tick.model.size + kRiser_m;
}

// As much ahead of its own way as brings the foot over its landing's piece in time: a growing share
// of what is left, as in lead_in().
FlightSpline early_lead(const Tick& tick, const Flight& flight) noexcept {
  constexpr int over = static_cast<int>(kOver * kProbes);
  const double left = flight.left[over];
  const double needed =
      std::abs(left) < kLeastLeft_m ? 0.0 : way_on(tick, flight, over, flight.climb) / left;
  const double share = std::clamp(needed, 0.0, 1.0);
  FlightSpline knots;
  for (int k = 1; k < kFlightKnots; ++k) {
    knots[k - 1] = share * smoothstep(0.0, kOver, static_cast<double>(k) / kFlightKnots) *
                   flight.left[k * kProbes / kFlightKnots];
  }
  return knots;
}

// Ahead of its own way the foot sinks as soon as an edge is behind it.
void plan_down(const Tick& tick, const Flight& flight, FlightRoom& room) noexcept {
  room.shift_m = early_lead(tick, flight);
  const Wanted above = wanted_raise(tick, flight, true, room.shift_m);
  room.raise_m = envelope(above, Ends{});
  draw_taut(above, kRoomAbove_m * tick.model.size, room.raise_m);
}

}  // namespace

void plan_room(const Tick& tick, WalkState& state, Side side) noexcept {
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  room.planned_for_m = state.landing_m;
  const Flight flight = planned_flight(tick, state, side);
  if (leads_down(tick, flight)) {
    plan_down(tick, flight, room);
  } else {
    plan_over(tick, state, foot, flight, room);
  }
  if (foot.mode_ticks != 0) return;
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    room.raise[k] = {room.raise_m[k], 0.0};
    room.shift[k] = {room.shift_m[k], 0.0};
  }
}

void keep_room(const Tick& tick, WalkState& state, Side side, double u) noexcept {
  FootState& foot = state.foot[side];
  FlightRoom& room = foot.room;
  if (glm::distance(room.planned_for_m, state.landing_m) > kReplan_m * tick.model.size)
    plan_room(tick, state, side);
  for (int k = 0; k < kFlightKnots - 1; ++k) {
    const double time_s = kRoomSmoothing_s * tick.model.time_scale;
    room.raise[k].advance(room.raise_m[k], time_s, tick.dt_s);
    room.shift[k].advance(room.shift_m[k], time_s, tick.dt_s);
  }
  const auto in_force = [](const Damped<double>& k) { return k.x; };
  const double raise = spline_at(room.raise, climb(state, foot), u, in_force);
  const vec3 move(0.0, raise, spline_at(room.shift, 0.0, u, in_force));
  foot.base_m += raise;
  foot.pose.heel_m += move;
  foot.pose.toe_m += move;
}

}  // namespace gaitpad
