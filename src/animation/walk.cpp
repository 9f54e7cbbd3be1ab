// The animation module: one tick of a walk, and what drives it.
//
// Clock. A walk is a sequence of steps; a step is a roll (Table I (b): the landed foot comes down
// while the other one still pushes off) and a flight (Table I (a)). The stick decides how long both
// last; a phase runs through the data's cycle at a rate that meets these times (the time-warp of
// section 3.3). Parameters are smoothed on the way in, so a stick may jump.
//
// Hips. They follow the tables of clean strides (gaitpad/stride_family.h) from the footprint of the
// foot that stands to the next landing. A step leads from the stride of the last step to its own,
// so both tables are read and mixed. What the hips differ by from that path, because a landing has
// moved, fades until the strike.
//
// The pose. Feet and pelvis are planned first, then the inverse kinematics connects them (section
// 3.3.2), and everything else comes from the data at this phase.
#include "gaitpad/walk.h"

#include "animation/walk_parts.h"
#include "base/lanes.h"
#include "motion/leg_pose.h"
#include "motion/pose_rows.h"

namespace gaitpad {

// --- What all parts of a tick ask about the walk -------------------------------------------------

Side step_foot(const WalkState& state) noexcept {
  return state.clock.stage == Stage::flight ? state.clock.swing : other(state.clock.swing);
}

double flight_progress(const WalkState& state) noexcept {
  if (state.clock.stage != Stage::flight) return 0.0;
  return static_cast<double>(state.clock.tick) / state.clock.stage_ticks;
}

double presence(const WalkState& state) noexcept {
  return std::clamp(state.gait.amplitude.x, 0.0, 1.0) *
         std::clamp(2.0 * state.gait.pace.x, 0.0, 1.0);
}

double own_phase(const WalkModel& model, const WalkState& state, Side side) noexcept {
  const double p = state.clock.phase - (side == kRightSide ? 0.0 : model.share[0] + model.share[1]);
  return p - std::floor(p);
}

double data_phase(const WalkModel& model, const WalkState& state) noexcept {
  if (!state.clock.backward) return state.clock.phase;
  return model.share[0] + model.share[1] + model.share[2] - state.clock.phase;
}

bool walks_on(const GaitParams& params, const WalkState& state) noexcept {
  const bool on_the_spot = params.stride[0].length_m == 0.0 && params.stride[1].length_m == 0.0;
  return params.walking &&
         (!state.clock.started || on_the_spot || params.backward == state.clock.backward);
}

double step_length(const WalkState& state, Side side) noexcept {
  if (state.clock.closing) return 0.0;
  return state.clock.backward ? 0.0 - state.gait.length_m[side].x : state.gait.length_m[side].x;
}

namespace {
double ratio_of_step(const WalkModel& model, const WalkState& state) noexcept {
  const Side swing = step_foot(state);
  // Run back, a foot makes the step that the other one makes forwards.
  const double own_m = model.own_step_m[state.clock.backward ? other(swing) : swing];
  return state.clock.started ? std::abs(state.frame.stride_m[swing]) / own_m : 0.0;
}
}  // namespace

double ratio_ahead(const WalkModel& model, const WalkState& state) noexcept {
  return std::max(0.0, ratio_of_step(model, state) + state.gait.off_ratio.x);
}

void plan_stride(const WalkModel& model, const WalkState& state, double phase, double step_share,
                 StridePlan& plan) noexcept {
  plan.phase = phase;
  plan.change = smootherstep(step_share);
  plan.shown = std::clamp(state.gait.amplitude.x, 0.0, 1.0);
  plan.heel_m = {};
  plan.injury = {};
  const auto stride = [&](double ratio) {
    return stride_of(model, state.clock.backward, plan.phase, ratio);
  };
  plan.at[0] = stride(state.gait.ratio_behind);
  const double ahead = ratio_ahead(model, state);
  plan.at[1] = ahead == state.gait.ratio_behind ? plan.at[0] : stride(ahead);
  plan.cell = mixed(plan.at[0].cell, plan.at[1].cell, plan.shown * (1.0 - plan.change),
                    plan.shown * plan.change);
  change_stride(model, state, mix(state.gait.ratio_behind, ahead, plan.change), plan);
}

void plan_stride(const WalkModel& model, const WalkState& state, StridePlan& plan) noexcept {
  const double begun =
      state.clock.tick + (state.clock.stage == Stage::flight ? state.clock.roll_ticks : 0);
  // A walk that has closed fades from the stride of its last step.
  const double share = state.clock.started
                           ? begun / std::max(1, state.clock.roll_ticks + state.clock.flight_ticks)
                           : 0.0;
  plan_stride(model, state, state.clock.phase, share, plan);
}

vec3 from_footprint(const WalkState& state, const StrideTrack& track, double phase, Side side,
                    int which, const vec3& travel_m) noexcept {
  // The right foot goes from its footprint of this stride to the next one's, the left foot from the
  // last one's to this one's.
  double turns = 0.0;
  if (side == step_foot(state)) turns = side == kRightSide ? which : which - 1;
  vec3 p = travel_m - track.footprint_m[side];
  p.z += track.stride_m * (phase - turns);
  return p;
}

double stage_share(const WalkModel& model, Stage stage, Side swing) noexcept {
  // Walking order: roll right, flight left, roll left, flight right.
  if (stage == Stage::roll) return model.share[swing == kRightSide ? 0 : 2];
  return model.share[swing == kLeftSide ? 1 : 3];
}

double stage_end_phase(const WalkModel& model, const WalkState& state) noexcept {
  return state.clock.stage_phase + stage_share(model, state.clock.stage, state.clock.swing);
}

double phase_ahead(const WalkModel& model, const WalkState& state, double ticks) noexcept {
  double phase = state.clock.phase, rate = state.clock.phase_rate;
  approach(phase, rate, stage_end_phase(model, state), state.clock.end_rate,
           std::max(1, state.clock.stage_ticks - state.clock.tick), ticks);
  return phase;
}

Pelvis pelvis_over_ground(const WalkModel& model, const WalkState& state,
                          const StridePlan& plan) noexcept {
  const StrideCell& cell = plan.cell;
  Pelvis pelvis;
  const quat& heading = pelvis.heading = rotation_y(state.path.heading_rad);
  const vec3 forward(2.0 * heading.w * heading.y, 0.0,
                     heading.w * heading.w - heading.y * heading.y),
      left = glm::cross(kUp, forward);
  pelvis.position_m = state.path.hips_m + left * cell.pelvis_m.x + forward * cell.pelvis_m.z;
  // In a turn the body leans as a whole, about the ground below the hips.
  const double height_m = model.stand_m + cell.pelvis_m.y;
  const SinCos lean = sin_cos(state.path.lean_rad.x);
  pelvis.position_m += left * (height_m * lean.sin);
  pelvis.position_m.y = state.path.base.height_m + height_m * lean.cos;
  const double yaw = state.gait.sway.x * cell.pelvis_yaw_rad;
  const quat upright = heading * rotation_z(-state.path.lean_rad.x),
             turned = rotation_y(yaw) *
                      from_rotation_vector(cell.pelvis_tilt + vec3(0.0, 0.0, model.stand_roll_rad));
  pelvis.rotation = upright * turned;
  if (state.path.slope_lean_rad.x == 0.0) return pelvis;
  // Into a slope the trunk leans about the hip joints.
  const vec3 hips = 0.5 * (model.leg[kLeftSide].model.hip_m + model.leg[kRightSide].model.hip_m);
  pelvis.position_m += pelvis.rotation * hips;
  pelvis.rotation = upright * rotation_x(state.path.slope_lean_rad.x) * turned;
  pelvis.position_m -= pelvis.rotation * hips;
  return pelvis;
}

namespace {

// --- Clock: stages, steps, phases ----------------------------------------------------------------

// Time constants in seconds at the reference leg; they scale with pendulum time.
constexpr double kStepSmoothing = 0.12;
constexpr double kTurnGoalSmoothing = 0.08;
constexpr double kTurnSmoothing = 0.25;
constexpr double kBounceSmoothing = 0.30;
constexpr double kAmplitudeSmoothing = 0.18, kAmplitudeFading = 0.07;
constexpr double kWeightSmoothing = 0.15;
constexpr double kSettling = 0.35;
constexpr double kLeanSmoothing = 0.12;
// Trunks lean by 5 to 6 degrees up a grade of 15 %, by 7 to 8 up stairs, and back by 2 downhill
// (Leroux, Fung and Barbeau 2002; Nadeau, McFadyen and Malouin 2003).
constexpr double kUphillLean = 8.5 * kDegree, kDownhillLean = 3.0 * kDegree, kHalfLeanGrade = 0.09;
constexpr double kShortestRun = 0.2;  // in legs: a step over less ground has no grade of its own
constexpr double kSlopeLeanSmoothing = 0.3;
constexpr double kGravity_m_s2 = 9.81, kLeastCycle_s = 0.2;
// Rises are in legs. A riser of 17 cm takes an adult at least 0.84 s.
constexpr double kSlowerOnStairs = 1.2, kSlowestRise = 0.34, kSteepRise = 0.15;
constexpr double kStairStep_s = 0.84, kStairRise = 0.2;
constexpr double kSlowerBack = 2.05;
constexpr double kBraking = 2.4;  // way over speed and time of a stop with little jerk
constexpr double kQuickestClosing = 0.8, kSlowestClosing = 1.6;  // of a step's time
constexpr double kStillAmplitude = 0.003;  // a walk starts when the last one has faded
constexpr double kAllShown = 1.0 - 1e-9;   // from here on nothing is mixed with the stand
constexpr double kHesitation = 0.2;        // for next to nothing; less for more, none from
constexpr double kSureRatio = 0.3, kSureTurn = 0.15;  // this stride ratio or turn (rad/s) on
constexpr double kStillTurn = 1e-5;                   // rad/s: slower than this is straight ahead

// Share of the cycle's time.
double time_share(const WalkModel& model, const WalkState& state, Stage stage,
                  Side swing) noexcept {
  const Side rolling = stage == Stage::roll ? swing : other(swing);
  const double roll = stage_share(model, Stage::roll, rolling);
  const double flight = stage_share(model, Stage::flight, other(rolling));
  const double rolls = roll_time_share(roll, state.gait.asked_ratio);
  return stage == Stage::roll ? rolls : roll + flight - rolls;
}

int stage_length(const WalkModel& model, const WalkState& state, Stage stage, Side swing,
                 double dt_s) noexcept {
  // Whole ticks: a steady gait is then exactly periodic.
  const double ticks = 2.0 * state.gait.time_s[swing] * state.clock.slowness *
                       time_share(model, state, stage, swing) / dt_s;
  return std::max(stage == Stage::roll ? 6 : 12, static_cast<int>(ticks + 0.5));
}

void begin_stage(Stage stage, Side swing, int ticks, WalkState& state) noexcept {
  state.clock.stage = stage;
  state.clock.swing = swing;
  state.clock.tick = 0;
  state.clock.stage_ticks = ticks;
}

// At the end of the stage that has begun the phase will run at the mean of both stages' rates, so
// the time-warp of the upper body has no kink.
void aim_phase(const Tick& tick, WalkState& state) noexcept {
  const bool rolls = state.clock.stage == Stage::roll;
  const Stage next = rolls ? Stage::flight : Stage::roll;
  const Side next_swing = rolls ? other(state.clock.swing) : state.clock.swing;
  const double here =
      stage_share(tick.model, state.clock.stage, state.clock.swing) / state.clock.stage_ticks;
  const double there = stage_share(tick.model, next, next_swing) /
                       stage_length(tick.model, state, next, next_swing, tick.dt_s);
  state.clock.end_rate = 0.5 * (here + there);
}

// On stairs a step takes longer, and at least as long as a person takes for a stair. On stairs both
// feet take equally long.
double slowness_of_step(const WalkModel& model, const WalkState& state, Side swing) noexcept {
  const double rise = std::min(state.path.foothold.next_rise, kSlowestRise);
  if (rise == 0.0) return 1.0;
  const double own = state.gait.time_s[swing],
               longer = std::max(own, state.gait.time_s[other(swing)]);
  const double level = mix(own, longer, smoothstep(0.0, kSteepRise, rise));
  const double stair = kStairStep_s * model.time_scale * rise / kStairRise;
  const double slower = state.clock.backward ? kSlowerBack : 1.0;
  return std::max(level * (1.0 + kSlowerOnStairs * rise), slower * stair) / own;
}

// The last step brings the hips to rest over both feet, in the time in which they need no harder
// braking than this way asks for.
double slowness_of_rest(const Tick& tick, const WalkState& state, Side swing) noexcept {
  const vec3 forward = heading_direction(state.path.heading_rad);
  const double way_m = std::abs(glm::dot(state.path.landing_m - state.path.hips_m, forward) +
                                tick.model.rest_lead_m),
               speed_m_s = horizontal_length(state.path.hips_velocity_m_s);
  return std::clamp(kBraking * way_m / std::max(speed_m_s * state.gait.time_s[swing], 1e-6),
                    kQuickestClosing, kSlowestClosing);
}

// Begins a step: `rolling` has just landed, the other foot flies next.
void begin_step(const Tick& tick, Side rolling, WalkState& state) noexcept {
  state.clock.last_step_ticks = state.clock.roll_ticks + state.clock.flight_ticks;
  state.clock.slowness = slowness_of_step(tick.model, state, other(rolling));
  if (state.clock.closing) state.clock.slowness *= slowness_of_rest(tick, state, other(rolling));
  state.clock.roll_ticks = stage_length(tick.model, state, Stage::roll, rolling, tick.dt_s);
  state.clock.flight_ticks =
      stage_length(tick.model, state, Stage::flight, other(rolling), tick.dt_s);
  state.clock.stage_phase = rolling == kRightSide ? 0.0 : tick.model.share[0] + tick.model.share[1];
  // The phase may have come out a whole turn off.
  state.clock.phase = state.clock.stage_phase;
  begin_stage(Stage::roll, rolling, state.clock.roll_ticks, state);
  aim_phase(tick, state);
}

void begin_walk(const Tick& tick, WalkState& state) noexcept {
  // The first foot follows the turn, so that a mirrored stick gives a mirrored walk.
  const Side first = tick.params.turn_rate_rad_s < 0.0 ? kRightSide : kLeftSide;
  state.clock.started = true;
  state.clock.closing = false;
  state.clock.backward = tick.params.backward;
  state.gait.ratio_behind = 0.0;
  state.clock.flight_ticks = 0;
  state.clock.roll_ticks = 0;
  begin_step(tick, other(first), state);
  state.clock.stage_ticks = state.clock.roll_ticks =
      2 * state.clock.roll_ticks;  // from rest: a longer first lean
  aim_phase(tick, state);
  state.clock.phase_rate = 0.0;
  state.foot[other(first)].mode = FootMode::roll;
}

void begin_idle(WalkState& state) noexcept {
  begin_stage(Stage::idle, state.clock.swing, 1, state);
  state.clock.started = false;
  state.clock.roll_ticks = state.clock.flight_ticks = 0;
  state.path.foothold.next_rise = 0.0;
}

void land_foot(const Tick& tick, WalkState& state) noexcept {
  const Side landed = state.clock.swing;
  const bool closed = state.clock.closing;
  state.clock.closing = !walks_on(tick.params, state);
  state.gait.ratio_behind = ratio_ahead(tick.model, state);
  if (closed && state.clock.closing) {  // feet together: the toe comes down, then rest
    const int ticks = state.clock.roll_ticks;
    begin_stage(Stage::roll, landed, std::max(ticks, 12), state);
    state.clock.stage_phase = state.clock.phase;
    state.clock.started = false;
    begin_roll(tick, state, landed);
    FootState& stays = state.foot[other(landed)];
    stays.mode_ticks = 0;
    stays.pitch_fade = {stays.pose.pitch_rad, 0.0, static_cast<double>(state.clock.stage_ticks)};
    return;
  }
  begin_step(tick, landed, state);
  begin_roll(tick, state, landed);
}

// Step times, and how long double support takes, follow the parameters at the next step.
void ask_for(const GaitParams& params, const WalkModel& model, WalkState& state) noexcept {
  for (int side : {0, 1}) state.gait.time_s[side] = params.stride[side].time_s;
  // Of the foot whose step is the longer one beside its own: a limp, which shortens one, does not
  // change the other foot's time.
  state.gait.asked_ratio = 0.0;
  for (int side : {0, 1}) {
    const double own_m = model.own_step_m[params.backward ? 1 - side : side];
    state.gait.asked_ratio = std::max(state.gait.asked_ratio, params.stride[side].length_m / own_m);
  }
}

// Smooths how far the trunk leans into the slope or stair that the running step leads over.
void lean_into_slope(const Tick& tick, WalkState& state) noexcept {
  double lean = 0.0;
  if (state.clock.started) {
    const Side swing = step_foot(state);
    const double rise = state.path.landing_m.y - state.foot[other(swing)].plane.place_m.y,
                 run = std::max(std::abs(state.frame.stride_m[swing]),
                                kShortestRun * tick.model.leg_length_m);
    const double grade = (state.clock.backward ? -rise : rise) / run;
    lean = (grade > 0.0 ? kUphillLean : kDownhillLean) * grade / (std::abs(grade) + kHalfLeanGrade);
  }
  state.path.slope_lean_rad.advance(lean, kSlopeLeanSmoothing * tick.model.time_scale, tick.dt_s);
}

// A stand that is asked for very little waits whether it is meant: a stick that is touched in
// passing would else cost two slow steps before a full push in another direction is followed.
bool is_meant(const Tick& tick, WalkState& state) noexcept {
  const double sure = std::max(state.gait.asked_ratio / kSureRatio,
                               std::abs(tick.params.turn_rate_rad_s) / kSureTurn);
  return ++state.clock.asked_ticks * tick.dt_s >=
         kHesitation * tick.model.time_scale * (1.0 - std::min(sure, 1.0));
}

// Smooths the parameters and starts a walk from standing when the parameters ask for one.
void smooth_parameters(const Tick& tick, IkMode mode, WalkState& state) noexcept {
  const GaitParams& params = tick.params;
  const double scale = tick.model.time_scale, dt = tick.dt_s;
  const bool stood = state.clock.stage == Stage::idle && state.frame.stage == Stage::idle;
  bool hesitates = false;
  if (stood && params.walking && state.gait.amplitude.x < kStillAmplitude) {
    ask_for(params, tick.model, state);
    hesitates = !is_meant(tick, state);
    if (!hesitates) begin_walk(tick, state);
  } else {
    state.clock.asked_ticks = 0;
  }
  const bool walking = walks_on(params, state) && !state.clock.closing && !hesitates;
  if (walks_on(params, state)) ask_for(params, tick.model, state);
  // A walk that is to end takes the running step as it was begun, and one that closes it.
  const Damping step(kStepSmoothing * scale, dt), weights(kWeightSmoothing * scale, dt),
      hips(kBounceSmoothing * scale, dt);
  const bool finishes = state.clock.started && !state.clock.closing && !walking;
  for (int side : {0, 1}) {
    const StrideParams& stride = params.stride[side];
    const double length_m = walking    ? stride.length_m
                            : finishes ? state.gait.length_m[side].x
                                       : 0.0;
    state.gait.length_m[side].advance(length_m, step);
    state.gait.flight_height[side].advance(stride.flight_height, step);
    for (int j = 0; j < kLegDofs; ++j) {
      state.gait.weight[side][j].advance(params.weight[side][j], weights);
    }
  }
  state.gait.step_time_s.advance(0.5 * (state.gait.time_s[0] + state.gait.time_s[1]), step);
  const double goal = walking ? params.turn_rate_rad_s : 0.0;
  state.gait.turn_goal.advance(goal, Damping(kTurnGoalSmoothing * scale, dt));
  if (goal == 0.0 && std::abs(state.gait.turn_goal.x) < kStillTurn) state.gait.turn_goal = {};
  state.gait.turn_rate.advance(state.gait.turn_goal.x, Damping(kTurnSmoothing * scale, dt));
  if (state.gait.turn_goal.x == 0.0 && std::abs(state.gait.turn_rate.x) < kStillTurn)
    state.gait.turn_rate = {};
  state.gait.amplitude.advance(
      state.clock.started ? 1.0 : 0.0,
      Damping((state.clock.started ? kAmplitudeSmoothing : kAmplitudeFading) * scale, dt));
  if (state.clock.started && state.gait.amplitude.x > kAllShown) state.gait.amplitude = {1.0, 0.0};
  state.gait.bounce.advance(params.hip_bounce, hips);
  state.gait.sway.advance(params.hip_sway, hips);
  const double mean = 0.5 * (state.gait.length_m[0].x + state.gait.length_m[1].x);
  state.gait.pace.advance(mean * state.gait.ground_share.x / tick.model.source_step_m, step);
  state.gait.settled_pace.advance(state.gait.pace.x, Damping(kSettling * scale, dt));
  // A lean of v w / g puts the weight on the standing foot's edge, as on a bicycle.
  const double speed_m_s = (state.gait.length_m[0].x + state.gait.length_m[1].x) /
                           std::max(kLeastCycle_s, state.gait.time_s[0] + state.gait.time_s[1]);
  const double lean =
      mode == IkMode::paper ? 0.0 : speed_m_s * state.gait.turn_rate.x / kGravity_m_s2;
  state.path.lean_rad.advance(lean, Damping(kLeanSmoothing * scale, dt));
  if (!tick.flat && mode != IkMode::paper) lean_into_slope(tick, state);
}

void advance_clock(const Tick& tick, WalkState& state) noexcept {
  state.path.heading_rad += state.gait.turn_rate.x * tick.dt_s;
  for (FootState& foot : state.foot) ++foot.mode_ticks;
  if (state.clock.stage == Stage::idle) return;
  const bool resting = !state.clock.started;  // in the last roll the data's clock stands still
  const double remaining = state.clock.stage_ticks - state.clock.tick;
  ++state.clock.tick;
  if (resting) return;
  approach(state.clock.phase, state.clock.phase_rate, stage_end_phase(tick.model, state),
           state.clock.end_rate, remaining, 1.0);
}

// Begins the next stage where this one is over.
void finish_stage(const Tick& tick, WalkState& state) noexcept {
  if (state.clock.stage == Stage::idle || state.clock.tick < state.clock.stage_ticks) return;
  const Side swing = state.clock.swing;
  if (state.clock.stage == Stage::flight) {
    land_foot(tick, state);
  } else if (!state.clock.started) {
    begin_support(state.foot[swing]);
    begin_idle(state);
  } else {
    begin_support(state.foot[swing]);
    state.clock.stage_phase = stage_end_phase(tick.model, state);
    begin_stage(Stage::flight, other(swing), state.clock.flight_ticks, state);
    aim_phase(tick, state);
    begin_flight(tick, state, other(swing));
  }
}

// --- Hips and landing place ----------------------------------------------------------------------

// Lengths in metres at the reference leg.
constexpr double kChangeDrop_m = 0.012, kChange = 0.2;
constexpr double kReach = 0.9994;  // of the leg: a knee bent by 4 degrees
constexpr double kSoftReach_m = 0.006, kKnown_m = 0.0015, kWiderReach = 0.6, kWidest_m = 0.06;
// Of what an injury changes of its leg's reach, so much does not lower or raise the hips: the sound
// leg then changes by less than a degree.
constexpr double kUnseenInjury = 0.85;
constexpr double kShortStep = 0.1;  // of the data's step: shorter ones say nothing about the ground
constexpr double kLeastShare = 0.3;  // the ground leaves at least this much of a step's length
constexpr double kGroundSmoothing_s = 0.3;
constexpr double kRatioJump = 0.01;  // a tick: sticks are slower
constexpr double kFreeze = 0.55;     // of the flight: after it the landing place is settled

double power(double base, int exponent) noexcept {
  double result = 1.0;
  for (int e = exponent; e > 0; e >>= 1, base *= base) {
    if (e & 1) result *= base;
  }
  return result;
}

int ticks_to_strike(const WalkState& state) noexcept {
  if (state.clock.stage == Stage::flight) return state.clock.stage_ticks - state.clock.tick;
  return state.clock.stage_ticks - state.clock.tick + state.clock.flight_ticks;
}

// The heading n ticks ahead if the turn rate's goal stays. The filter is a linear recurrence with
// the double eigenvalue q, so its error is e_k = (e_0 + c k) q^k, and the sum has a closed form.
double heading_ahead(const Tick& tick, const WalkState& state, int n) noexcept {
  const double goal = state.gait.turn_goal.x;
  const double w = tick.dt_s / (kTurnSmoothing * tick.model.time_scale), q = 1.0 / (1.0 + w);
  const double e0 = state.gait.turn_rate.x - goal;
  if (e0 == 0.0 && state.gait.turn_rate.v == 0.0)
    return state.path.heading_rad + goal * n * tick.dt_s;
  const double e1 = e0 * (1.0 - w * w * q * q) + q * q * state.gait.turn_rate.v * tick.dt_s;
  const double c = e1 / q - e0, qn = power(q, n);
  const double s0 = q * (1.0 - qn) / (1.0 - q);
  const double s1 = q * (1.0 - (n + 1) * qn + n * qn * q) / ((1.0 - q) * (1.0 - q));
  return state.path.heading_rad + (goal * n + e0 * s0 + c * s1) * tick.dt_s;
}

// Smooths how much of a step's length the ground leaves: such steps roll and rise like short ones.
void follow_ground(const Tick& tick, WalkState& state, Side swing) noexcept {
  const double wanted = std::abs(step_length(state, swing));
  const double share =
      wanted < kShortStep * tick.model.source_step_m
          ? 1.0
          : std::clamp(std::abs(state.frame.stride_m[swing]) / wanted, kLeastShare, 1.0);
  state.gait.ground_share.advance(share, kGroundSmoothing_s * tick.model.time_scale, tick.dt_s);
}

// A step that is to end on another tread than it was has another ratio at once. The tables are read
// for one that goes there until the flight begins.
void keep_ratio_smooth(const Tick& tick, WalkState& state) noexcept {
  const double ratio = ratio_of_step(tick.model, state);
  const double change = ratio - state.gait.step_ratio;
  state.gait.step_ratio = ratio;
  if (state.clock.stage == Stage::roll && state.clock.tick == 1) {
    state.gait.off_ratio = {};
  } else if (std::abs(change) > kRatioJump) {
    state.gait.off_ratio.x -= change;
  }
  state.gait.off_ratio.advance(
      state.clock.stage == Stage::roll ? state.clock.stage_ticks - state.clock.tick + 1 : 1);
}

void plan_landing(const Tick& tick, WalkState& state) noexcept {
  if (state.clock.stage == Stage::idle || !state.clock.started) return;
  const Side swing = step_foot(state), stand = other(swing);
  const double heading = heading_ahead(tick, state, ticks_to_strike(state) + 1);
  const vec3 forward = heading_direction(heading), left = glm::cross(kUp, forward);
  const vec3 standing = state.foot[stand].heel_anchor_m;
  if (flight_progress(state) <= kFreeze) {
    const double width = tick.model.leg[swing].track_m - tick.model.leg[stand].track_m;
    state.path.landing_heading_rad = heading;
    state.path.landing_m = standing + forward * step_length(state, swing) + left * width;
    if (!tick.flat) choose_foothold(tick, state, forward, left * width);
  }
  // Along the heading at the landing, which may still turn after the place is settled.
  state.frame.stride_m[swing] = glm::dot(state.path.landing_m - standing, forward);
  if (tick.flat) return;
  follow_ground(tick, state, swing);
  keep_ratio_smooth(tick, state);
}

// The hips' place on the tables' path, without their oscillation: of the stride before, from the
// footprint of the foot that stands; of this one, to the next landing.
vec3 path_from_standing(const WalkState& state, const StrideTrack& track, double phase) noexcept {
  const Side stand = other(step_foot(state));
  const FootState& foot = state.foot[stand];
  return foot.heel_anchor_m +
         rotation_y(foot.lift_yaw_rad) * from_footprint(state, track, phase, stand, 0, vec3(0.0));
}
vec3 path_to_landing(const WalkState& state, const StrideTrack& track, double phase,
                     const vec3& landing_m, double heading_rad) noexcept {
  return landing_m + rotation_y(heading_rad) *
                         from_footprint(state, track, phase, step_foot(state), 1, vec3(0.0));
}

// A step takes the hips from the path of the stride before it over to its own.
void begin_path(const Tick& tick, WalkState& state) noexcept {
  const StrideTrack behind = track_of(tick.model, state.clock.backward, state.gait.ratio_behind),
                    ahead =
                        track_of(tick.model, state.clock.backward, ratio_ahead(tick.model, state));
  double phase = state.clock.stage_phase, rate = state.clock.phase_rate;
  std::array<vec3, 3> off;
  for (int k : {0, 1, 2}) {
    vec3 from = path_from_standing(state, behind, phase);
    if (state.clock.last_step_ticks == 0)
      from = vec3(state.path.hips_m.x, from.y, state.path.hips_m.z);  // at rest
    off[k] = from - path_to_landing(state, ahead, phase, state.path.landing_m,
                                    state.path.landing_heading_rad);
    approach(phase, rate, stage_end_phase(tick.model, state), state.clock.end_rate,
             state.clock.stage_ticks - k, 1.0);
  }
  state.path.off_m = {off[0], 0.5 * (4.0 * off[1] - 3.0 * off[0] - off[2]),
                      off[0] - 2.0 * off[1] + off[2]};
}

// The hips follow the tables' path to the next landing. What they differ by from it, from the step
// before or because the landing has moved, fades until the strike.
void advance_hips(const Tick& tick, WalkState& state, const StridePlan& plan) noexcept {
  if (!tick.flat) advance_base(tick, state);
  if (state.clock.stage == Stage::idle || !state.clock.started) {
    state.path.hips_velocity_m_s = vec3(0.0);
    return;
  }
  const vec3 before = state.path.hips_m;
  const vec3 path = path_to_landing(state, plan.at[1].track, plan.phase, state.path.landing_m,
                                    state.path.landing_heading_rad);
  const double ratio = ratio_ahead(tick.model, state);
  if (state.clock.stage == Stage::roll && state.clock.tick == 1) {
    begin_path(tick, state);
  } else if (state.path.landing_m != state.path.last_landing_m || ratio != state.path.last_ratio ||
             state.path.landing_heading_rad != state.path.last_heading_rad) {
    // The path has moved, and the hips have not.
    const StrideTrack last = track_of(tick.model, state.clock.backward, state.path.last_ratio);
    state.path.off_m.x += path_to_landing(state, last, plan.phase, state.path.last_landing_m,
                                          state.path.last_heading_rad) -
                          path;
  }
  state.path.last_landing_m = state.path.landing_m;
  state.path.last_heading_rad = state.path.landing_heading_rad;
  state.path.last_ratio = ratio;
  state.path.off_m.advance(ticks_to_strike(state) + 1);
  state.path.hips_m = path + state.path.off_m.x;
  state.path.hips_m.y = 0.0;
  state.path.hips_velocity_m_s = (state.path.hips_m - before) / tick.dt_s;
}

vec3 ankle_of(const LegBuild& leg, const FootPose& foot) noexcept {
  return foot.heel_m - foot.rotation * leg.model.heel_m;
}

// The pelvis' height: the tables', lowered where ground or turn ask more of a leg than they know.
double pelvis_height(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                     const Pelvis& pelvis) noexcept {
  double y = pelvis.position_m.y;
  // Legs that are about to change their pace are bent a little, so that they have room.
  const double change = state.gait.pace.x - state.gait.settled_pace.x;
  y -= kChangeDrop_m * model.size * std::min(1.0, 2.0 * state.gait.pace.x) * change * change /
       (change * change + kChange * kChange);
  double squares = 0.0;
  for (Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    // The sound leg goes nearly as if the other were sound, too: then the hips are as high.
    const double knee = model.stand_rad[side][kKneeX] + plan.cell.leg_rad[side][kKneeX] -
                        kUnseenInjury * plan.injury.leg_rad[side][kKneeX];
    const double known = span_m(leg.model, knee);
    const FootState& foot = state.foot[side];
    FootPose pose = foot.pose;
    if (plan.injury.pitch_rad[side] != 0.0)
      set_pitch(leg, pose.pitch_rad - kUnseenInjury * plan.injury.pitch_rad[side], pose, foot.mode);
    const vec3 ankle = ankle_of(leg, pose), hip = pelvis.hip(leg);
    const double span = glm::distance(hip, ankle);
    // What the tables ask for is let through.
    const double beyond = (span - known) / model.size;
    if (beyond <= 0.0) continue;
    const double soft = model.size * (kSoftReach_m + kWiderReach * std::min(beyond, kWidest_m));
    const double longest = kReach * leg.model.length_m(), times = beyond / kKnown_m;
    const double excess =
        soft_positive(span - longest, soft) * times * times / (1.0 + times * times);
    const double upright = std::max(0.3 * span, hip.y - ankle.y) / span;
    squares += excess * excess / (upright * upright);
  }
  return y - std::sqrt(squares);
}

// --- Pose and report -----------------------------------------------------------------------------

// Rx(x) Rz(z) Ry(y) of half the angles.
quat turn_xzy(const SinCos& x, const SinCos& z, const SinCos& y) noexcept {
  const double w = x.cos * z.cos, i = x.sin * z.cos, j = -x.sin * z.sin, k = x.cos * z.sin;
  return quat(w * y.cos - j * y.sin, i * y.cos - k * y.sin, w * y.sin + j * y.cos,
              k * y.cos + i * y.sin);
}

void write_legs(const WalkModel& model, const WalkState& state, Pose& pose) noexcept {
  // Both legs side by side.
  const auto& q = state.legs.angles_rad;
  std::array<std::array<SinCos, kLegDofs>, 2> half;
  for (int j = 0; j < kLegDofs; ++j) {
    Lanes<2> sine, cosine;
    sin_cos_of(Lanes<2>{0.5 * q[kLeftSide][j], 0.5 * q[kRightSide][j]}, sine, cosine);
    for (int side : {0, 1}) half[side][j] = {sine[side], cosine[side]};
  }
  for (Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    const auto& h = half[side];
    const FootPose& foot = state.foot[side].pose;
    const std::array<quat, 4> turn = {
        turn_xzy(h[kHipX], h[kHipZ], h[kHipY]), quat(h[kKneeX].cos, h[kKneeX].sin, 0.0, 0.0),
        turn_xzy(h[kAnkleX], h[kAnkleZ], h[kAnkleY]), toes_turn(leg, foot, foot.toe_rad)};
    for (int i = 0; i < 4; ++i) {
      const LegJointFrame& frame = leg.joint[i];
      if (frame.joint >= 0) pose.local[frame.joint] = frame.before * turn[i] * frame.after;
    }
  }
}

void write_pose(const WalkModel& model, const WalkState& state, const Pelvis& pelvis,
                Pose& pose) noexcept {
  const GaitCycle& cycle = model.cycle;
  sample_rows(model.above, data_phase(model, state), pose);
  swing_arms(model, state, pose);
  const double a = presence(state);
  if (a < 1.0) {
    for (const int j : model.above.joint)
      pose.local[j] = nlerp(cycle.standing_local[j], pose.local[j], a);
  }
  for (int j : model.kept) pose.local[j] = cycle.standing_local[j];
  // Joints between root and pelvis turn with the heading and else move as in the data.
  pose.root_m = pelvis.position_m;
  pose.local[0] = pelvis.heading * pose.local[0];
  quat above = kIdentity;
  for (int j = cycle.skeleton.joints[cycle.pelvis].parent; j >= 0;
       j = cycle.skeleton.joints[j].parent) {
    above = pose.local[j] * above;
  }
  pose.local[cycle.pelvis] = glm::conjugate(above) * (pelvis.rotation * cycle.pelvis_standing);
  write_legs(model, state, pose);
  pose_upper_body(model, state, pose);
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

void fill_report(const Pelvis& pelvis, double dt_s, WalkState& state) noexcept {
  WalkFrame& frame = state.frame;
  frame.stage = state.clock.stage;
  frame.swing = state.clock.swing;
  frame.heading_rad = state.path.heading_rad;
  frame.turn_rate_rad_s = state.gait.turn_rate.x;
  frame.pelvis_m = pelvis.position_m;
  const bool idle = frame.stage == Stage::idle;
  if (idle) frame.stride_m = {};
  for (Side side : {kLeftSide, kRightSide}) {
    const bool swings = frame.swing == side;
    frame.heel_planted[side] = idle || (frame.stage == Stage::roll && swings);
    frame.toe_planted[side] = idle || !swings;
  }
  const bool landed =
      frame.stage == Stage::roll && state.clock.tick == 1 && state.clock.last_step_ticks > 0;
  if (landed) {
    ++frame.steps[frame.swing];
    frame.overhangs += !state.path.foothold.fits;
  }
  frame.speed_m_s = 0.0;
  const int ticks = state.clock.roll_ticks + state.clock.flight_ticks;
  if (!idle && state.clock.started && ticks > 0) {
    const int before = state.clock.last_step_ticks > 0 ? state.clock.last_step_ticks : ticks;
    frame.speed_m_s = (frame.stride_m[0] + frame.stride_m[1]) / ((ticks + before) * dt_s);
  }
}

}  // namespace

WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept {
  WalkState state;
  state.path.hips_m = vec3(place_m.x, 0.0, place_m.z);
  state.gait.flight_height = {Damped<double>{1.0, 0.0}, Damped<double>{1.0, 0.0}};
  state.gait.bounce.x = state.gait.sway.x = 1.0;
  state.gait.step_time_s.x = 0.5;
  for (Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    FootState& foot = state.foot[side];
    for (Damped<double>& w : state.gait.weight[side]) w.x = 1.0;
    state.gait.time_s[side] = 0.5;
    foot.heel_anchor_m = state.path.hips_m + vec3(leg.track_m, 0.0, -model.rest_lead_m);
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
  state.path.landing_m = state.foot[kLeftSide].heel_anchor_m;
  state.path.landing_plane = state.foot[kLeftSide].plane;
  state.path.base.height_m = state.path.base.level_m =
      std::min(state.foot[kLeftSide].plane.place_m.y, state.foot[kRightSide].plane.place_m.y);
  advance(model, GaitParams{}, IkMode::robust, 1.0 / 240.0, state, pose);
  return state;
}

void plan_tick(const Tick& tick, IkMode mode, WalkState& state, PlannedTick& planned) noexcept {
  const WalkModel& model = tick.model;
  planned.tick = &tick;
  planned.state = &state;
  smooth_parameters(tick, mode, state);
  grant_wishes(mode, state);
  smooth_upper_body(tick, mode, state);
  advance_clock(tick, state);
  plan_landing(tick, state);
  plan_stride(model, state, planned.plan);
  advance_hips(tick, state, planned.plan);
  for (Side side : {kLeftSide, kRightSide}) plan_foot(tick, state, planned.plan, side);
  planned.pelvis = pelvis_over_ground(model, state, planned.plan);
  planned.pelvis.position_m.y = pelvis_height(model, state, planned.plan, planned.pelvis);
  for (Side side : {kLeftSide, kRightSide})
    reach_with_toe(model, state, side, planned.pelvis.hip(model.leg[side]));
}

void finish_tick(const PlannedTick& planned, Pose& pose) noexcept {
  const Tick& tick = *planned.tick;
  WalkState& state = *planned.state;
  write_pose(tick.model, state, planned.pelvis, pose);
  fill_report(planned.pelvis, tick.dt_s, state);
  report_ground(tick, state.frame);
  finish_stage(tick, state);
  for (FootState& foot : state.foot) remember_foot(foot);
}

void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept {
  const Tick tick = {model, params, dt_s, is_flat(*model.terrain)};
  static thread_local PlannedTick planned;  // as in Crowd::advance_block()
  plan_tick(tick, mode, state, planned);
  pose_legs({&planned, 1}, mode);
  finish_tick(planned, pose);
}

}  // namespace gaitpad
