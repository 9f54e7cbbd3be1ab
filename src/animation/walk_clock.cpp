#include "animation/walk_parts.h"

namespace gaitpad {
namespace {

// Time constants in seconds at the reference leg; they scale with pendulum time.
constexpr double kStepSmoothing = 0.12;
constexpr double kTurnGoalSmoothing = 0.08;
constexpr double kBounceSmoothing = 0.30;
constexpr double kAmplitudeSmoothing = 0.18;
constexpr double kWeightSmoothing = 0.15;
constexpr double kShortRoll = 0.085, kBriskRoll = 0.11, kLongRoll = 0.20;
// Rises are in legs. A riser of 17 cm takes an adult at least 0.84 s.
constexpr double kSlowerOnStairs = 1.2, kSlowestRise = 0.34, kSteepRise = 0.15;
constexpr double kStairStep_s = 0.84, kStairRise = 0.2;
constexpr double kStillPresence = 0.003;  // a walk starts when the last one has faded
constexpr double kStillTurn = 1e-5;       // rad/s: slower than this is straight ahead

double stage_share(const WalkModel& model, Stage stage, Side swing) noexcept {
  // Walking order: roll right, flight left, roll left, flight right.
  if (stage == Stage::roll) return model.share[swing == kRightSide ? 0 : 2];
  return model.share[swing == kLeftSide ? 1 : 3];
}

// Share of the cycle's time. The roll is as long as in the data within bounds: shorter ones slap
// the toe down, longer ones hold the rear foot back until its leg is too short; at full pace the
// more so.
double time_share(const WalkModel& model, const WalkState& state, Stage stage,
                  Side swing) noexcept {
  const Side rolling = stage == Stage::roll ? swing : other(swing);
  const double roll = stage_share(model, Stage::roll, rolling);
  const double flight = stage_share(model, Stage::flight, other(rolling));
  const double longest = mix(kLongRoll, kBriskRoll, smoothstep(0.5, 1.0, full_pace(model, state)));
  const double bounded = std::clamp(roll, kShortRoll, longest);
  return stage == Stage::roll ? bounded : roll + flight - bounded;
}

int stage_length(const WalkModel& model, const WalkState& state, Stage stage, Side swing,
                 double dt_s) noexcept {
  // Whole ticks: a steady gait is then exactly periodic.
  const double ticks =
      2.0 * state.time_s[swing] * state.slowness * time_share(model, state, stage, swing) / dt_s;
  return std::max(stage == Stage::roll ? 6 : 12, static_cast<int>(ticks + 0.5));
}

double stage_end_phase(const WalkModel& model, const WalkState& state) noexcept {
  return state.stage_phase + stage_share(model, state.stage, state.swing);
}

void begin_stage(Stage stage, Side swing, int ticks, WalkState& state) noexcept {
  state.stage = stage;
  state.swing = swing;
  state.tick = 0;
  state.stage_ticks = ticks;
}

// On stairs a step takes longer, up to a stair's own time, and a foot that is quicker than the
// other one is it no more.
double slowness(const WalkModel& model, const WalkState& state, Side swing) noexcept {
  const double rise = std::min(state.landing.next_rise, kSlowestRise);
  if (rise == 0.0) return 1.0;
  const double own = state.time_s[swing], longer = std::max(own, state.time_s[other(swing)]);
  const double level = mix(own, longer, smoothstep(0.0, kSteepRise, rise));
  const double stair = kStairStep_s * model.time_scale * rise / kStairRise;
  return std::max(level * (1.0 + kSlowerOnStairs * rise), stair) / own;
}

// A step: `rolling` has just landed, the other foot flies next.
void begin_step(const Tick& tick, Side rolling, WalkState& state) noexcept {
  state.last_step_ticks = state.roll_ticks + state.flight_ticks;
  state.slowness = slowness(tick.model, state, other(rolling));
  state.roll_ticks = stage_length(tick.model, state, Stage::roll, rolling, tick.dt_s);
  state.flight_ticks = stage_length(tick.model, state, Stage::flight, other(rolling), tick.dt_s);
  state.stage_phase = rolling == kRightSide ? 0.0 : tick.model.share[0] + tick.model.share[1];
  // Keeps the phase continuous where the step begins at another turn of the same phase.
  state.phase = state.stage_phase;
  begin_stage(Stage::roll, rolling, state.roll_ticks, state);
}

void begin_walk(const Tick& tick, WalkState& state) noexcept {
  // The first foot follows the turn, so that a mirrored stick gives a mirrored walk.
  const Side first = tick.params.turn_rate_rad_s < 0.0 ? kRightSide : kLeftSide;
  state.started = true;
  state.closing = false;
  state.backward = tick.params.backward;
  state.flight_ticks = 0;
  state.roll_ticks = 0;
  begin_step(tick, other(first), state);
  state.stage_ticks = state.roll_ticks = 2 * state.roll_ticks;  // from rest: a longer first lean
  state.phase_rate = 0.0;
  for (int side : {0, 1}) hold_pitch(tick.model, state, static_cast<Side>(side), state.roll_ticks);
}

void begin_idle(WalkState& state) noexcept {
  begin_stage(Stage::idle, state.swing, 1, state);
  state.started = false;
  state.roll_ticks = state.flight_ticks = 0;
  state.landing.next_rise = 0.0;
  for (FootState& foot : state.foot) foot.pitch_fade = {};
}

void land(const Tick& tick, WalkState& state) noexcept {
  const Side landed = state.swing;
  const bool closed = state.closing;
  state.closing = !walks_on(tick.params, state);
  if (closed && state.closing) {  // feet together: the toe comes down, then rest
    const int ticks = state.roll_ticks;
    begin_stage(Stage::roll, landed, std::max(ticks, 12), state);
    state.stage_phase = state.phase;
    state.started = false;
    begin_roll(state, landed);
    return;
  }
  begin_step(tick, landed, state);
  begin_roll(state, landed);
  if (closed) hold_pitch(tick.model, state, other(landed), state.roll_ticks);
}

}  // namespace

Side step_foot(const WalkState& state) noexcept {
  return state.stage == Stage::flight ? state.swing : other(state.swing);
}

double flight_progress(const WalkState& state) noexcept {
  if (state.stage != Stage::flight) return 0.0;
  return static_cast<double>(state.tick) / state.stage_ticks;
}

int ticks_to_strike(const WalkState& state) noexcept {
  if (state.stage == Stage::flight) return state.stage_ticks - state.tick;
  return state.stage_ticks - state.tick + state.flight_ticks;
}

double pace(const WalkModel& model, const WalkState& state, Side side) noexcept {
  return std::clamp(state.length_m[side].x * state.ground_share.x / model.source_step_m, 0.0, 1.5);
}

double presence(const WalkState& state) noexcept {
  return std::clamp(state.amplitude.x, 0.0, 1.0) * std::clamp(2.0 * state.pace.x, 0.0, 1.0);
}

double full_pace(const WalkModel& model, const WalkState& state) noexcept {
  return std::max(pace(model, state, kLeftSide), pace(model, state, kRightSide));
}

double own_phase(const WalkModel& model, const WalkState& state, Side side) noexcept {
  const double p = state.phase - (side == kRightSide ? 0.0 : model.share[0] + model.share[1]);
  return p - std::floor(p);
}

double data_phase(const WalkModel& model, const WalkState& state) noexcept {
  if (!state.backward) return state.phase;
  return model.share[0] + model.share[1] + model.share[2] - state.phase;
}

bool walks_on(const GaitParams& params, const WalkState& state) noexcept {
  const bool on_the_spot = params.stride[0].length_m == 0.0 && params.stride[1].length_m == 0.0;
  return params.walking && (!state.started || on_the_spot || params.backward == state.backward);
}

void smooth_parameters(const Tick& tick, WalkState& state) noexcept {
  const GaitParams& params = tick.params;
  const double scale = tick.model.time_scale, dt = tick.dt_s;
  const bool walking = walks_on(params, state) && !state.closing;
  const bool stood = state.stage == Stage::idle && state.frame.stage == Stage::idle;
  if (stood && params.walking && presence(state) < kStillPresence) {
    for (int side : {0, 1}) state.time_s[side] = params.stride[side].time_s;
    begin_walk(tick, state);
  }
  for (int side : {0, 1}) {
    const StrideParams& stride = params.stride[side];
    if (walks_on(params, state)) state.time_s[side] = stride.time_s;
    state.length_m[side].advance(walking ? stride.length_m : 0.0, kStepSmoothing * scale, dt);
    state.flight_height[side].advance(stride.flight_height, kStepSmoothing * scale, dt);
    for (int j = 0; j < kLegDofs; ++j) {
      state.weight[side][j].advance(params.weight[side][j], kWeightSmoothing * scale, dt);
    }
  }
  state.step_time_s.advance(0.5 * (state.time_s[0] + state.time_s[1]), kStepSmoothing * scale, dt);
  const double goal = walking ? params.turn_rate_rad_s : 0.0;
  state.turn_goal.advance(goal, kTurnGoalSmoothing * scale, dt);
  if (goal == 0.0 && std::abs(state.turn_goal.x) < kStillTurn) state.turn_goal = {};
  state.turn_rate.advance(state.turn_goal.x, kTurnSmoothing * scale, dt);
  if (state.turn_goal.x == 0.0 && std::abs(state.turn_rate.x) < kStillTurn) state.turn_rate = {};
  const bool moving = state.started && !state.closing;
  state.amplitude.advance(moving ? 1.0 : 0.0, kAmplitudeSmoothing * scale, dt);
  state.bounce.advance(params.hip_bounce, kBounceSmoothing * scale, dt);
  state.sway.advance(params.hip_sway, kBounceSmoothing * scale, dt);
  const double mean = 0.5 * (state.length_m[0].x + state.length_m[1].x);
  state.pace.advance(mean * state.ground_share.x / tick.model.source_step_m, kStepSmoothing * scale,
                     dt);
}

void advance_clock(const Tick& tick, WalkState& state) noexcept {
  state.heading_rad += state.turn_rate.x * tick.dt_s;
  for (FootState& foot : state.foot) ++foot.mode_ticks;
  if (state.stage == Stage::idle) return;
  const bool resting = !state.started;  // the last roll: the data's clock stands still
  const double remaining = state.stage_ticks - state.tick;
  ++state.tick;
  if (resting) return;
  // The rate meets the next stage's half-way, so the time-warp of the upper body has no kink.
  const Stage stage = state.stage;
  const Side swing = state.swing;
  const Stage next = stage == Stage::roll ? Stage::flight : Stage::roll;
  const Side next_swing = stage == Stage::roll ? other(swing) : swing;
  const double rate = stage_share(tick.model, stage, swing) / state.stage_ticks;
  const double next_rate = stage_share(tick.model, next, next_swing) /
                           stage_length(tick.model, state, next, next_swing, tick.dt_s);
  approach(state.phase, state.phase_rate, stage_end_phase(tick.model, state),
           0.5 * (rate + next_rate), remaining, 1.0);
}

void finish_stage(const Tick& tick, WalkState& state) noexcept {
  if (state.stage == Stage::idle || state.tick < state.stage_ticks) return;
  const Side swing = state.swing;
  if (state.stage == Stage::flight) {
    land(tick, state);
  } else if (!state.started) {
    begin_support(state.foot[swing], state.even_rad[swing]);
    begin_idle(state);
  } else {
    begin_support(state.foot[swing], state.even_rad[swing]);
    state.stage_phase = stage_end_phase(tick.model, state);
    begin_stage(Stage::flight, other(swing), state.flight_ticks, state);
    begin_flight(tick, state, other(swing));
  }
}

}  // namespace gaitpad
