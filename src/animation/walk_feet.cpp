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

// A flying toe may be that far below where it stands: then the tables' own toes, which only just
// leave the floor, are let through.
constexpr double kMostSink_m = 0.0015, kSoftPitch = 0.4 * kDegree, kWiderPitch = 0.25;
constexpr double kRiseBegin = 0.20, kRiseLasts = 0.18;  // own phase: the heel may rise
constexpr double kReachOnToe = 0.99995;  // of the leg: with the hip further away, the heel rises
constexpr double kMostUpright = 0.99, kSoftUpright = 0.12;
constexpr double kMaxPitch = 85.0 * kDegree, kWidePitch = 25.0 * kDegree;
// A foot that goes far up is lifted less: its way over the riser is lift enough, and the knee folds
// only so far.
constexpr double kLiftUp = 0.5, kHighUp = 0.2, kHighestUp = 0.345;
constexpr double kInPlace_m = 0.1;  // a flight shorter than this climbs by time, not by place
constexpr double kLiftFade = 0.5;   // of the flight: the lift-off's own motion has faded
constexpr double kPitchFade = 0.2;
constexpr double kHeelStays = 0.85;  // of the flight: from here on a style leaves its end alone
constexpr double kEdgeUp = 0.25,
                 kEdgeDown = 0.9;    // of the flight: between them soles clear the floor
constexpr double kLiftGround = 0.5;  // of the flight: until then the plane left bounds the toe
constexpr double kRollEnd = 0.9;     // of the roll: the toe is down
// Of the flight: from kLiftGrown until kLiftFalls all of a style's factor on its height acts.
constexpr double kLiftGrown = 0.4, kLiftFalls = 0.5, kLiftEnds = 0.85;

double asin(double x) noexcept { return kPi / 2.0 - acos(x); }

quat edge_of(const LegBuild& leg, double twist_rad, double roll_rad) noexcept {
  return from_rotation_vector(kUp * twist_rad + leg.forward * roll_rad);
}

// How much steeper the line from heel to toe is in a foot that twists and rolls.
double rolled_elevation(const LegBuild& leg, const FootPose& pose) noexcept {
  const vec3 line = pose.edge * (leg.model.toe_m - leg.model.heel_m);
  return atan2(line.y, glm::dot(line, leg.forward)) - leg.elevation_rad;
}

// The foot's pitch in the tables.
double table_pitch(const WalkState& state, const StridePlan& plan, Side side) noexcept {
  // The foot that stands when a walk begins has not landed: its toe is down.
  const bool stands = state.foot[side].mode == FootMode::roll && state.clock.last_step_ticks == 0;
  if (!state.clock.started || stands) return 0.0;
  return plan.cell.foot[side].pitch_rad;
}

// How much of the tables' twist and roll a foot on the ground shows: when standing it is flat.
double on_its_edges(const WalkState& state) noexcept {
  if (state.clock.started) return 1.0;
  return state.clock.stage == Stage::idle
             ? 0.0
             : 1.0 - smootherstep(static_cast<double>(state.clock.tick) / state.clock.stage_ticks);
}

// In a turn the foot pivots on its planted toe as its heel rises.
double pivot_rate(const WalkModel& model, const WalkState& state, Side side) noexcept {
  return state.gait.turn_rate.x * heel_rise(model, state, side);
}

// --- The flight path -----------------------------------------------------------------------------

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

// The heel's place, and the height of the ground line below it: the tables' path from the footprint
// that the foot left to the one where it lands. Where both steps are equal, both say the same.
vec3 flight_heel(const WalkModel& model, const WalkState& state, const StridePlan& plan, Side side,
                 double u, double& base_m) noexcept {
  const FootState& foot = state.foot[side];
  const StrideFoot& cell = plan.cell.foot[side];
  const quat old = rotation_y(foot.lift_yaw_rad);
  const bool turns = state.path.landing_heading_rad != foot.lift_yaw_rad;
  const quat next = turns ? rotation_y(state.path.landing_heading_rad) : old;
  const double gone = smootherstep(u);
  vec3 p = (foot.heel_anchor_m + old * from_footprint(state, plan.at[0].track, plan.phase, side, 0,
                                                      plan.at[0].cell.foot[side].heel_m)) *
               (1.0 - gone) +
           (state.path.landing_m + next * from_footprint(state, plan.at[1].track, plan.phase, side,
                                                         1, plan.at[1].cell.foot[side].heel_m)) *
               gone;
  const vec3 styled = plan.heel_m[side] * (1.0 - smoothstep(kHeelStays, 1.0, u));
  if (styled.x != 0.0 || styled.z != 0.0) {
    p += rotation_y(mix(foot.lift_yaw_rad, state.path.landing_heading_rad, gone)) *
         vec3(styled.x, 0.0, styled.z);
  }
  const vec3 way = state.path.landing_m - foot.heel_anchor_m;
  const double begin_m = height_on(foot.plane, foot.heel_anchor_m),
               rise = state.path.landing_m.y - begin_m;
  const double rise_legs = rise / model.leg_length_m;
  // A lame foot is low from its lift-off on (StrideWish::low_left).
  const double factor = state.gait.flight_height[side].x, low = std::min(factor, 1.0);
  // A style's factor acts while the foot is high.
  const double more = mix(1.0, std::max(factor, 1.0), 1.0 - smoothstep(kLiftFalls, kLiftEnds, u));
  const double lifted = more * mix(1.0, kLiftUp, smoothstep(kHighUp, kHighestUp, rise_legs));
  const double height = low_lift(u, low) * mix(1.0, lifted, smootherstep(u / kLiftGrown));
  const Ascent risen = ascent(model, foot, way);
  base_m = begin_m + rise * risen.at(p - foot.heel_anchor_m, u);
  const double up = (cell.heel_m.y + styled.y) * height;
  p.y = base_m + up;
  for (int a : {0, 1, 2}) p[a] += Fade{foot.gap_m[a], foot.gap_slope_m[a], kLiftFade}.at(u);
  p.y = std::max(p.y, base_m);
  return p;
}

// --- The reach of a standing leg -----------------------------------------------------------------

// The pitch at which the ankle, turning about the planted toe, is as far from the hip as the leg
// reaches: P cos + Q sin = K in the foot's own vertical plane.
double pitch_in_reach(const LegBuild& leg, const FootPose& pose, const vec3& hip_m,
                      double reach) noexcept {
  const vec3 d = glm::conjugate(pose.yaw) * (glm::conjugate(pose.tilt) * (hip_m - pose.toe_m)),
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

// Pitches a foot on its toe so that its ankle is higher by `rise_m`.
void rise_on_toe(const LegBuild& leg, double rise_m, FootState& foot) noexcept {
  if (rise_m == 0.0) return;
  const double length = glm::length(leg.model.toe_m);
  const double flat = asin(-leg.model.toe_m.y / length);
  const double sine = sin_cos(std::min(flat + foot.pose.pitch_rad, kPi / 2.0)).sin;
  const double higher = soft_min(sine + rise_m / length, kMostUpright, kSoftUpright);
  const double pitch = std::max(foot.pose.pitch_rad, asin(higher) - flat);
  set_pitch(leg, pitch, foot.pose, foot.mode);
}

}  // namespace

double heel_rise(const WalkModel& model, const WalkState& state, Side side) noexcept {
  const bool stays = state.clock.closing && side != step_foot(state);
  if (state.clock.stage == Stage::idle || !state.clock.started || stays) return 0.0;
  const double begin =
      std::max(kRiseBegin, model.share[side == kRightSide ? 0 : 2]);  // after the roll
  return smoothstep(begin, begin + kRiseLasts, own_phase(model, state, side));
}

quat foot_rotation(const LegBuild& leg, const FootPose& pose) noexcept {
  return pose.tilt * (pose.yaw * (rotation_about(leg.side, pose.pitch_rad) * pose.edge));
}

quat toes_turn(const LegBuild& leg, const FootPose& pose, double toe_rad) noexcept {
  return glm::conjugate(pose.edge) * rotation_about(leg.side, toe_rad);
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
  pose.rotation = foot_rotation(leg, pose);
  const vec3 line = pose.rotation * (leg.model.toe_m - leg.model.heel_m);
  if (mode == FootMode::support) {
    pose.heel_m = pose.toe_m - line;
  } else {
    pose.toe_m = pose.heel_m + line;
  }
}

FlightPoint flight_point(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                         Side side, double u) noexcept {
  const FootState& foot = state.foot[side];
  const StrideFoot& cell = plan.cell.foot[side];
  FlightPoint point;
  FootPose& pose = point.pose;
  pose.heel_m = flight_heel(model, state, plan, side, u, point.base_m);
  point.lifted_m = height_on(foot.plane, pose.heel_m) - point.base_m;
  const double gone = 1.0 - h00(u);
  const double turn = state.path.landing_heading_rad - foot.lift_yaw_rad;
  pose.yaw = rotation_y(foot.lift_yaw_rad + turn * gone + foot.lift_turn_rad * h10(u));
  // A lame foot that hardly leaves the floor does not roll onto an edge.
  const double low = low_lift(u, std::min(state.gait.flight_height[side].x, 1.0));
  pose.edge = edge_of(model.leg[side], low * cell.twist_rad, low * cell.roll_rad);
  pose.tilt = foot.plane.tilt;
  if (pose.tilt != state.path.landing_plane.tilt) {
    pose.tilt = glm::normalize(pose.tilt * (1.0 - gone) + state.path.landing_plane.tilt * gone);
  }
  return point;
}

void pitch_in_flight(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                     Side side, double u, FlightPoint& point) noexcept {
  const LegBuild& leg = model.leg[side];
  const FootState& foot = state.foot[side];
  // The toe leaves the plane that it stood on, which may be another one than the line over ground.
  const double ground_m = point.base_m + point.lifted_m * (1.0 - smootherstep(u / kLiftGround));
  const double height = (point.pose.heel_m.y - ground_m) * foot.plane.normal.y;
  // The tables keep the toe off the floor. What differs from them must do so itself.
  const double fade = foot.pitch_fade.at(u * state.clock.stage_ticks);
  const double pitch = table_pitch(state, plan, side) + fade;
  // A low foot that rolls onto its edge keeps this edge off the floor.
  point.pose.pitch_rad = pitch;
  const vec3 across = foot_rotation(leg, point.pose) * leg.side;
  const double edge_m = leg.half_width_m * std::abs(glm::dot(across, point.pose.tilt * kUp)) *
                        smoothstep(0.0, kEdgeUp, u) * (1.0 - smoothstep(kEdgeDown, 1.0, u));
  const double limit =
      highest_pitch(leg, height, edge_m - kMostSink_m) + rolled_elevation(leg, point.pose);
  const double soft =
      kSoftPitch + kWiderPitch * std::abs(fade) * smoothstep(0.0, 0.1, u) + edge_m / leg.foot_m;
  set_pitch(leg, soft_min(pitch, limit, soft), point.pose, FootMode::flight);
}

void plan_foot(const Tick& tick, WalkState& state, const StridePlan& plan, Side side) noexcept {
  const WalkModel& model = tick.model;
  const LegBuild& leg = model.leg[side];
  FootState& foot = state.foot[side];
  const double pitch = table_pitch(state, plan, side) + foot.pitch_fade.at(foot.mode_ticks);
  const StrideFoot& cell = plan.cell.foot[side];
  const double shows = on_its_edges(state);
  foot.pose.edge = edge_of(leg, shows * cell.twist_rad, shows * cell.roll_rad);
  foot.pose.tilt = foot.plane.tilt;
  foot.base_m = foot.plane.place_m.y;
  if (foot.mode == FootMode::support) {
    foot.pose.toe_m = foot.toe_anchor_m;
    set_pitch(leg, std::max(0.0, pitch), foot.pose, foot.mode);
    if (tick.flat) return;
    foot.rise_m = rise_with_hips(model, state, plan, side, foot.base_m);
    rise_on_toe(leg, foot.rise_m, foot);
  } else if (foot.mode == FootMode::roll) {
    foot.pose.heel_m = foot.heel_anchor_m;
    set_pitch(leg, std::min(0.0, pitch), foot.pose, foot.mode);
  } else {
    const double u = flight_progress(state);
    FlightPoint point = flight_point(model, state, plan, side, u);
    if (!tick.flat) {
      keep_room(tick, state, side, u, point);
      foot.rise_m = rise_with_hips(model, state, plan, side, point.base_m);
      point.pose.heel_m.y += foot.rise_m;
    }
    pitch_in_flight(model, state, plan, side, u, point);
    point.pose.toe_rad = foot.pose.toe_rad;
    foot.pose = point.pose;
    foot.base_m = point.base_m;
  }
}

void reach_with_toe(const WalkModel& model, WalkState& state, Side side,
                    const vec3& hip_m) noexcept {
  FootState& foot = state.foot[side];
  if (foot.mode != FootMode::support) return;
  const LegBuild& leg = model.leg[side];
  const vec3 ankle = foot.pose.heel_m - foot.pose.rotation * leg.model.heel_m;
  const double reach = kReachOnToe * leg.model.length_m();
  if (glm::distance(hip_m, ankle) <= reach) return;
  const double pitch = std::max(foot.pose.pitch_rad, pitch_in_reach(leg, foot.pose, hip_m, reach));
  set_pitch(leg, pitch, foot.pose, foot.mode);
}

void remember_foot(FootState& foot) noexcept {
  foot.last_heel_m = {foot.pose.heel_m, foot.last_heel_m[0]};
  foot.last_pitch_rad = {foot.pose.pitch_rad, foot.last_pitch_rad[0]};
  foot.last_rise_m = {foot.rise_m, foot.last_rise_m[0]};
}

void begin_support(FootState& foot) noexcept {
  foot.mode = FootMode::support;
  foot.mode_ticks = 0;
  foot.pitch_fade = {};
}

void begin_flight(const Tick& tick, WalkState& state, Side side) noexcept {
  const WalkModel& model = tick.model;
  FootState& foot = state.foot[side];
  const double ticks = state.clock.stage_ticks;
  const FootPose lifts = foot.pose;
  const vec3 slope_m = end_slope(foot.last_heel_m[1], foot.last_heel_m[0], lifts.heel_m) * ticks;
  const double pitch_rate =
      end_slope(foot.last_pitch_rad[1], foot.last_pitch_rad[0], lifts.pitch_rad);
  foot.mode = FootMode::flight;
  foot.mode_ticks = 0;
  foot.lift_m = lifts.heel_m;
  foot.crosses_riser =
      !tick.flat && crosses_riser(*model.terrain, foot.plane, state.path.landing_plane);
  foot.lift_turn_rad = pivot_rate(model, state, side) * tick.dt_s * ticks;
  // What this foot differs by from the tables fades away.
  foot.gap_m = foot.gap_slope_m = vec3(0.0);
  foot.pitch_fade = {};
  const double step = 1.0 / (state.clock.roll_ticks + state.clock.flight_ticks);
  const double share = state.clock.roll_ticks * step;
  StridePlan now, next;
  plan_stride(model, state, state.clock.phase, share, now);
  plan_stride(model, state, state.clock.phase + state.clock.phase_rate, share + step, next);
  double base_m = 0.0;
  const vec3 from = flight_heel(model, state, now, side, 0.0, base_m);
  const vec3 to = flight_heel(model, state, next, side, 1.0 / ticks, base_m);
  foot.gap_m = lifts.heel_m - from;
  foot.gap_slope_m = slope_m - (to - from) * ticks;
  foot.gap_m.y -= foot.rise_m;
  foot.gap_slope_m.y -= end_slope(foot.last_rise_m[1], foot.last_rise_m[0], foot.rise_m) * ticks;
  const double pitch = table_pitch(state, now, side);
  foot.pitch_fade = {lifts.pitch_rad - pitch, pitch_rate - (table_pitch(state, next, side) - pitch),
                     kPitchFade * ticks};
  if (!tick.flat) plan_room(tick, state, side);
}

void begin_roll(const Tick& tick, WalkState& state, Side side) noexcept {
  FootState& foot = state.foot[side];
  foot.mode = FootMode::roll;
  foot.mode_ticks = 0;
  foot.heel_anchor_m = state.path.landing_m;
  foot.lift_yaw_rad = state.path.landing_heading_rad;
  foot.plane = state.path.landing_plane;
  StridePlan plan;
  plan_stride(tick.model, state, plan);
  const double pitch = foot.pose.pitch_rad - table_pitch(state, plan, side);
  foot.pitch_fade = {pitch, 0.0, kRollEnd * state.clock.stage_ticks};
  FootPose flat = foot.pose;
  flat.heel_m = foot.heel_anchor_m;
  flat.yaw = foot.pose.yaw = rotation_y(foot.lift_yaw_rad);
  flat.edge = kIdentity;
  set_pitch(tick.model.leg[side], 0.0, flat, FootMode::roll);
  foot.toe_anchor_m = flat.toe_m;
}

}  // namespace gaitpad
