// Lets a walk come to rest at any moment of a step, and go on if the stick is pushed again.
//
// A stop takes the first of three ends that brakes softly: the flying foot closes beside the
// standing one; it lands ahead and the other foot closes; one more step comes before that. The hips
// go to their place between the feet along a quintic, whose duration is chosen for the least
// braking.
//
// A program may ask for another landing of the running step, and push the hips; both are changes of
// the running step, as a stop is.
#include "animation/placement.h"
#include "animation/sound_input.h"
#include "animation/walk_flow.h"

namespace gaitpad {
namespace {

// A quintic from speed v to rest brakes with about kNeed v^2 / way. Times are in seconds at the
// reference leg.
constexpr double kNeed = 0.72, kBrake_m_s2 = 3.0, kCloseBrake_m_s2 = 3.3, kMostBrake_m_s2 = 3.9;
constexpr double kLeastRest_s = 0.25, kMostRest_s = 1.6;
// Limits of a step, in shares of the foot's own step.
constexpr double kShortestStep = 0.25, kFurtherStep = 0.3;
constexpr double kToClose_s = 0.40, kWayWhileClosing = 0.44;
constexpr double kMoves_m_s = 1.1,
                 kMovesFrom = 0.5;  // share of the flight from which on a landing moves no faster
                                    // than kMoves_m_s
constexpr double kBehind_m = 0.02;
// Distance of the hips behind the foot that lands, as a share of a step.
constexpr double kLandsAhead = 0.42;
constexpr double kInPlace = 0.1;  // steps with a smaller ratio turn on the spot
// A flight that has covered at most this share may become quicker.
constexpr double kNewFlight = 0.1;
// Share of a closing flight until which the walk may still go on.
constexpr double kTurnsBack = 0.45;
constexpr double kGoesOn = 0.7;  // share of the asked step that a walk goes on with
constexpr double kNearStrike_s = 0.15, kLands_s = 0.08, kRollsOn_s = 0.05;
constexpr double kLow_m = 0.001;
// Factor on the data's height from which on a flight counts as high.
constexpr double kHighFlight = 1.5;
constexpr double kStandAgain_s = 0.45;

vec3 left_of(double heading_rad) noexcept {
  return glm::cross(kUp, heading_direction(heading_rad));
}

// A bound: `time_s` from now the hips must still have `way_m` to go, so that the foot that lands
// then is ahead of them.
struct Behind {
  double time_s = 0.0, way_m = 0.0;
};

// The duration in which the hips come to rest most softly, without passing their place or moving
// back, and not before the feet. Hips that move away from the place turn round soon.
double best_rest_s(double way_m, double speed_m_s, double bend_m_s2, double scale,
                   std::span<const Behind> landings) noexcept {
  constexpr int kTimes = 20, kPoints = 40;
  // Smallest factor on speed times duration that gives the way.
  constexpr double kLeastShare = 0.30, kShare = 0.02;
  // Costs of each violation, in m/s2.
  constexpr double kOver = 200.0, kBack = 50.0, kLate = 0.8, kAhead = 40.0;
  double best_s = kLeastRest_s * scale, least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < kTimes; ++k) {
    const double share = kLeastShare + kShare * k;
    const double time_s = std::clamp(way_m / (share * std::max(std::abs(speed_m_s), 0.05)),
                                     kLeastRest_s * scale, kMostRest_s * scale);
    const double point_s = time_s / kPoints;
    SmoothFade<double> off{-way_m, speed_m_s * point_s, bend_m_s2 * point_s * point_s};
    double brakes = 0.0, over = 0.0, back = 0.0, ahead = 0.0;
    for (int n = kPoints; n > 1; --n) {
      off.move(static_cast<double>(n));
      brakes = std::max(brakes, std::abs(off.a) / (point_s * point_s));
      over = std::max({over, off.x, -way_m - off.x});
      back = std::max(back, -off.v / point_s);
      const double now_s = (kPoints - n + 1) * point_s;
      for (const Behind& landing : landings) {
        if (now_s <= landing.time_s) ahead = std::max(ahead, off.x + landing.way_m);
      }
    }
    for (const Behind& landing : landings) {
      if (time_s < landing.time_s) ahead = std::max(ahead, landing.way_m);
    }
    const double cost = brakes + kOver * over + kBack * back + kLate * time_s + kAhead * ahead;
    if (cost < least) {
      least = cost;
      best_s = time_s;
    }
  }
  return best_s;
}

// Heel and pitch of the flying foot by the present plan, now and a tick later.
struct Flown {
  std::array<vec3, 2> heel_m;
  std::array<double, 2> pitch_rad{};
  double base_m = 0.0;
};
Flown flown(const Tick& tick, const WalkState& state) noexcept {
  const Moment at = moment_of(tick.model, state);
  const Side side = state.clock.swing;
  const FootState& foot = state.foot[side];
  Flown flown;
  for (int k : {0, 1}) {
    StridePlan plan;
    plan_stride<double>(tick, at, state, phase_ahead(tick.model, state, k),
                        k == 0 ? at.step_share() : at.step_share_ahead(), plan);
    const double u = (at.tick + k) / at.stage_ticks;
    flown.heel_m[k] = flight_heel<double>(tick, at, state, plan, side, u, flown.base_m);
    flown.pitch_rad[k] = table_pitch<double>(at, state, plan, side) +
                         foot.pitch_fade.at(at.tick + k - foot.fade_begin);
  }
  return flown;
}

// Changes the end of the running step by `change`. A foot in flight changes over to its new path
// until it lands.
template <class Change>
void change_step(const Tick& tick, WalkState& state, const Change& change) noexcept {
  const bool flies = state.clock.stage == Stage::flight;
  Flown was;
  if (flies) was = flown(tick, state);
  const double ratio = ratio_ahead<double>(tick.model, moment_of(tick.model, state), state),
               heading = state.path.landing_heading_rad;
  if (!state.clock.led) state.clock.led_from = state.clock.tick;
  change();
  state.clock.led = true;
  // A foot that rolls down needs a least time for that.
  const int least =
      state.clock.tick + static_cast<int>(kRollsOn_s * tick.model.time_scale / tick.dt_s + 0.5);
  if (!flies && state.clock.stage_ticks < least)
    state.clock.stage_ticks = state.clock.roll_ticks = least;
  replan(2.0 * kCarry_s, tick, state);
  plan_landing<double>(tick, moment_of(tick.model, state), state);
  state.gait.off_ahead = {};
  state.gait.off_ahead.x =
      ratio - ratio_ahead<double>(tick.model, moment_of(tick.model, state), state);
  if (!flies) return;
  FootState& foot = state.foot[state.clock.swing];
  const double ticks = state.clock.stage_ticks;
  foot.gap_m = foot.gap_slope_m = vec3(0.0);
  foot.pitch_fade = {};
  foot.gap_begin = state.clock.tick / ticks;
  foot.gap_lasts = std::max(1.0 - foot.gap_begin, 1.0 / ticks);
  const double gone = 1.0 - h00(foot.gap_begin);
  foot.gap_yaw_rad = gone * (heading - state.path.landing_heading_rad);
  const Flown is = flown(tick, state);
  foot.gap_m = was.heel_m[0] - is.heel_m[0];
  foot.gap_slope_m = ((was.heel_m[1] - is.heel_m[1]) - foot.gap_m) * ticks;
  // If the foot is lower than the new plan, the offset shrinks in proportion to the planned height:
  // a constant offset would take the foot through the ground.
  foot.gap_high_m = std::max(is.heel_m[0].y - is.base_m, kLow_m * tick.model.size);
  if (foot.gap_m.y < 0.0)
    foot.gap_slope_m.y -=
        foot.gap_m.y * (is.heel_m[1].y - is.heel_m[0].y) / foot.gap_high_m * ticks;
  const double pitch = was.pitch_rad[0] - is.pitch_rad[0];
  foot.fade_begin = state.clock.tick;
  foot.pitch_fade = {pitch, was.pitch_rad[1] - is.pitch_rad[1] - pitch, foot.gap_lasts * ticks};
}

}  // namespace

void replan(double time_s, const Tick& tick, WalkState& state) noexcept {
  state.clock.replanned = true;
  state.clock.fade_ticks = static_cast<int>(time_s * tick.model.time_scale / tick.dt_s + 0.5);
}

int ticks_to_lift_off(const WalkModel& model, const WalkState& state) noexcept {
  constexpr double kLongest_s = 1.0;
  const double part_s = state.clock.tick_s / tick_parts(state.clock.tick_s);
  const int most = static_cast<int>(kLongest_s / part_s + 0.5);
  const Side stands = state.clock.swing;
  const double phase = moment_of(model, state).step_phase + stage_share(model, Stage::roll, stands);
  const StridePlace lifts = stride_of(model, state.clock.backward, phase, state.gait.ratio_behind);
  const Moment at = moment_of(model, state);
  const FootState& foot = state.foot[stands];
  const vec3 forward = heading_direction(foot.lift_yaw_rad),
             place = path_from_standing<double>(at, state, lifts.track, forward).at(phase) +
                     over_ground<double>(forward, lifts.cell.pelvis_m),
             ahead = forward * (state.clock.backward ? -1.0 : 1.0);
  const SmoothFade<vec3>& pelvis = state.path.pelvis_m;
  SmoothFade<vec3> off{pelvis.x - state.path.rest_m, pelvis.v, pelvis.a};
  for (int n = 1; n < std::min(most, state.clock.rest_ticks); ++n) {
    off.move(static_cast<double>(state.clock.rest_ticks + 1 - n));
    if (glm::dot(state.path.rest_m + off.x - place, ahead) >= 0.0) return n;
  }
  return most;
}

void plan_rest_place(const Tick& tick, WalkState& state) noexcept {
  const WalkModel& model = tick.model;
  const Side stands = other(step_foot(state));
  const FootState& foot = state.foot[stands];
  state.path.rest_m = foot.heel_anchor_m +
                      heading_direction(foot.lift_yaw_rad) * model.rest_lead_m -
                      left_of(foot.lift_yaw_rad) * model.leg[stands].track_m;
  state.path.rest_m.y = 0.0;
}

void plan_rest(const Tick& tick, WalkState& state) noexcept {
  const WalkModel& model = tick.model;
  StepClock& clock = state.clock;
  PathState& path = state.path;
  const double scale = model.time_scale, sign = clock.backward ? -1.0 : 1.0;
  const Side swing = step_foot(state), stands = other(swing);
  const vec3 forward = heading_direction(path.landing_heading_rad), ahead = forward * sign,
             left = left_of(path.landing_heading_rad);
  const auto along = [&](const vec3& v) { return glm::dot(v, ahead); };
  const double speed = along(path.pelvis_m.v) / tick.dt_s,
               bend = along(path.pelvis_m.a) / (tick.dt_s * tick.dt_s);
  const vec3& standing = state.foot[stands].heel_anchor_m;
  const double from = along(standing) + sign * model.rest_lead_m - along(path.pelvis_m.x);
  const auto to_rest = [&](double way_m, std::span<const Behind> landings) {
    double time_s = best_rest_s(way_m, speed, bend, scale, landings);
    if (path.foothold.next_rise > 0.0)
      time_s = std::max(time_s, tick.dt_s * moment_of(model, state).ticks_to_strike());
    clock.rest_ticks = std::max(2, static_cast<int>(time_s / tick.dt_s + 0.5));
    clock.closing_ticks = clock.rest_ticks;
    clock.stopping = clock.led = true;
  };
  // The remaining steps take as long as the last one, and so does the running one if it has just
  // begun: a thumb that releases the stick asks for slow ones in passing.
  const int running = clock.roll_ticks + clock.flight_ticks,
            usual = clock.last_step_ticks > 0 ? std::min(running, clock.last_step_ticks) : running;
  for (double& time_s : state.gait.time_s) time_s = usual * tick.dt_s / clock.slowness;
  state.gait.asked_ratio = ratio_ahead<double>(model, moment_of(model, state), state);
  const bool flies = clock.stage == Stage::flight;
  // A foot that will land soon, that is high, or whose landing was asked for keeps its place. Over
  // uneven ground every flying foot does, because the way to its foothold is planned.
  const double lands_s = (clock.stage_ticks - clock.tick) * tick.dt_s;
  const bool is_high = state.gait.flight_height[swing].x > kHighFlight;
  if (path.asked.waits || path.asked.is_taken) return;
  if (flies && (!tick.flat || is_high || lands_s < kLands_s * scale)) return;
  if (clock.starting && !flies) {  // true before the foot has left the floor
    path.rest_m = 0.5 * (standing + state.foot[swing].heel_anchor_m) + forward * model.rest_lead_m -
                  left * (0.5 * (model.leg[0].track_m + model.leg[1].track_m));
    path.rest_m.y = 0.0;
    to_rest(0.0, {});
    clock.rest_ticks = clock.closing_ticks =
        static_cast<int>(kStandAgain_s * scale / tick.dt_s + 0.5);
    clock.starting = clock.started = false;
    FootState& lifts = state.foot[swing];
    clock.stage_ticks = clock.tick + clock.rest_ticks;
    lifts.fade_begin = lifts.mode_ticks;
    lifts.pitch_fade = {lifts.pose.pitch_rad, 0.0, static_cast<double>(clock.rest_ticks)};
    replan(kStandAgain_s, tick, state);
    return;
  }
  const double own_m = model.own_step_m[clock.backward ? stands : swing],
               other_own_m = model.own_step_m[clock.backward ? swing : stands];
  const double need = kNeed * speed * speed;
  const bool is_new =
      usual < running && clock.tick < kNewFlight * (flies ? clock.stage_ticks : 1e9);
  const auto time_again = [&] {
    if (is_new) time_step_again(tick, state);
  };
  const StepClock as_begun = clock;
  time_again();
  const double left_s = std::max(0.0, tick.dt_s * moment_of(model, state).ticks_to_strike());
  clock = as_begun;
  const double planned = sign * glm::dot(path.landing_m - standing, forward);
  const double gone = flies ? double(clock.tick) / clock.stage_ticks : 0.0;
  const double foot_ahead = along(state.foot[swing].pose.heel_m - standing);
  const bool may_close =
      (from >= need / kCloseBrake_m_s2 && foot_ahead < -kBehind_m) || planned < kInPlace * own_m;
  if (may_close && !clock.starting) {
    change_step(tick, state, [&] {
      time_again();
      to_rest(std::max(from, 0.0), {});
      clock.closing = true;
      plan_rest_place(tick, state);
      if (!flies) time_closing_step(tick, state);
    });
    return;
  }
  const double room = gone > kMovesFrom ? kMoves_m_s * left_s : 9.0;
  const double least =
      std::max({kShortestStep * own_m, planned - room, gone > 0.3 ? foot_ahead + kBehind_m : 0.0});
  const auto wanted = [&](double time_s) {
    return std::max(need / kBrake_m_s2, kWayWhileClosing * speed * (left_s + time_s * scale)) -
           from;
  };
  double step = std::clamp(wanted(kToClose_s), std::min(least, planned), planned), further = 0.0;
  if (from + step < need / kMostBrake_m_s2) {
    further = std::clamp(wanted(kToClose_s + 0.35) - step, kFurtherStep * other_own_m, other_own_m);
  }
  const double lead_m = sign * model.rest_lead_m;
  const std::array<Behind, 2> landings = {
      {{left_s, kLandsAhead * step + lead_m + further},
       {left_s + state.gait.time_s[stands], kLandsAhead * further + lead_m}}};
  change_step(tick, state, [&] {
    time_again();
    to_rest(from + step + further, std::span(landings).first(further > 0.0 ? 2 : 1));
    clock.further_steps = further > 0.0 ? 1 : 0;
    state.gait.length_m[swing] = {step, 0.0};
    if (further > 0.0) state.gait.length_m[stands] = {further, 0.0};
  });
  path.rest_m = path.landing_m + ahead * further + forward * model.rest_lead_m -
                left * model.leg[swing].track_m;
  path.rest_m.y = 0.0;
}

// --- Steps that are asked for --------------------------------------------------------------------

namespace {

// True if a program may still change where the running step ends.
bool is_open_step(const WalkModel& model, const WalkState& state) noexcept {
  constexpr double kLatest = 0.5;  // share of the flight
  const StepClock& clock = state.clock;
  if (!clock.started || clock.stopping || clock.closing) return false;
  if (clock.stage == Stage::roll) return true;
  return is_flat(*model.terrain) && clock.tick <= kLatest * clock.stage_ticks;
}

// The nearest landing that the running step's foot can reach, in the walk's own coordinates.
Placement reachable_step(const WalkModel& model, const WalkState& state,
                         const Placement& heel) noexcept {
  // From heel to heel, in legs, so that feet neither touch nor do a split; and the turn of a foot.
  constexpr double kAhead = 0.95, kBack = 0.45, kLeastAside = 0.07, kMostAside = 0.45,
                   kMostTurn_rad = 0.7;
  const Side swing = step_foot(state);
  const FootState& stands = state.foot[other(swing)];
  const Placement frame = {stands.heel_anchor_m, stands.lift_yaw_rad};
  const vec3 asked = from_world(frame, heel.place_m);
  const bool backward = state.clock.backward;
  const double way = backward ? -1.0 : 1.0, outwards = swing == kRightSide ? -1.0 : 1.0,
               leg_m = model.leg_length_m,
               own_m = model.own_step_m[backward ? other(swing) : swing],
               ahead_m = std::min(kAhead * leg_m, kMostRatio * own_m);
  const vec3 near(
      outwards * std::clamp(outwards * asked.x, kLeastAside * leg_m, kMostAside * leg_m), 0.0,
      way * std::clamp(way * asked.z, -kBack * leg_m, ahead_m));
  const double turn_rad = wrapped(heel.heading_rad - frame.heading_rad);
  return {to_world(frame, near),
          frame.heading_rad + std::clamp(turn_rad, -kMostTurn_rad, kMostTurn_rad)};
}

bool is_finite(const Placement& place) noexcept {
  return std::isfinite(place.place_m.x + place.place_m.z + place.heading_rad);
}

}  // namespace

std::optional<Placement> nearest_step(const WalkModel& model, const Placement& heel,
                                      const WalkState& state) noexcept {
  if (!is_finite(heel) || !is_open_step(model, state)) return std::nullopt;
  const Placement& placed = state.placed;
  const Placement own = {from_world(placed, heel.place_m), heel.heading_rad - placed.heading_rad};
  return moved(placed, reachable_step(model, state, own));
}

bool step_to(const WalkModel& model, const Placement& heel, WalkState& state) noexcept {
  constexpr double kSame_m = 0.001, kSame_rad = 0.1 * kDegree;
  const auto near = nearest_step(model, heel, state);
  if (!near) return false;
  const vec3 off = near->place_m - heel.place_m;
  if (glm::length(vec2(off.x, off.z)) > kSame_m ||
      std::abs(wrapped(near->heading_rad - heel.heading_rad)) > kSame_rad)
    return false;
  AskedStep& asked = state.path.asked;
  asked.waits = true;
  asked.heel_m = from_world(state.placed, near->place_m);
  asked.heading_rad = near->heading_rad - state.placed.heading_rad;
  return true;
}

bool push_walk(const vec3& velocity_m_s, WalkState& state) noexcept {
  const StepClock& clock = state.clock;
  const vec3 v = glm::conjugate(rotation_y(state.placed.heading_rad)) * velocity_m_s;
  if (!(glm::length(vec2(v.x, v.z)) <= kMostPush_m_s) || !clock.started || clock.stopping)
    return false;
  state.path.asked.push_m_s += vec3(v.x, 0.0, v.z);
  return true;
}

void take_asked_step(const Tick& tick, WalkState& state) noexcept {
  // A pendulum as long as the leg falls v sqrt(l / g) far: there a foot catches it (Hof 2008).
  constexpr double kGravity_m_s2 = 9.81;
  // Time constant in which the hips take a push, so that a straight knee does not snap.
  constexpr double kPush_s = 0.05, kLeastPush_m_s = 0.01;
  AskedStep& asked = state.path.asked;
  const bool is_pushed = asked.push_m_s != vec3(0.0);
  if (!asked.waits && !is_pushed) return;
  const bool is_open = is_open_step(tick.model, state);
  if (asked.waits && is_open) change_step(tick, state, [&] { asked.is_taken = true; });
  asked.waits = false;
  if (!is_pushed) return;
  if (!state.clock.started || state.clock.stopping) {
    asked.push_m_s = vec3(0.0);
    return;
  }
  if (!asked.is_taken) {
    // The landing of a step that has just begun is planned in its first tick.
    if (!is_open || state.clock.tick == 0) return;
    const vec3 falls_m = asked.push_m_s * std::sqrt(tick.model.leg_length_m / kGravity_m_s2);
    const Placement heel = reachable_step(
        tick.model, state, {state.path.landing_m + falls_m, state.path.landing_heading_rad});
    change_step(tick, state, [&] {
      asked.is_taken = true;
      asked.heel_m = heel.place_m;
      asked.heading_rad = heel.heading_rad;
    });
  }
  const vec3 part_m_s =
      asked.push_m_s * std::min(1.0, tick.dt_s / (kPush_s * tick.model.time_scale));
  state.path.pelvis_m.v += part_m_s * tick.dt_s;
  asked.push_m_s -= part_m_s;
  if (glm::length(asked.push_m_s) < kLeastPush_m_s) asked.push_m_s = vec3(0.0);
}

void walk_on(const Tick& tick, WalkState& state) noexcept {
  StepClock& clock = state.clock;
  const bool flies = clock.stage == Stage::flight;
  if (clock.closing && flies && (!tick.flat || clock.tick > kTurnsBack * clock.stage_ticks)) return;
  // Hips that have braked cannot reach the tables' place at a near strike, so the walk goes on
  // after that strike. Over uneven ground it does not wait, because the step plans a foothold
  // further on.
  const double left_s = (clock.stage_ticks - clock.tick) * tick.dt_s;
  if (tick.flat && flies && left_s < kNearStrike_s * tick.model.time_scale) return;
  change_step(tick, state, [&] {
    const Side swing = step_foot(state);
    if (clock.closing)
      state.gait.length_m[swing] = {kGoesOn * tick.params.stride[swing].length_m, 0.0};
    clock.stopping = clock.closing = false;
    clock.further_steps = 0;
  });
}

}  // namespace gaitpad
