// The animation module: one tick of a walk, and what drives it.
//
// Clock. A walk is a sequence of steps; a step is a roll (Table I (b): the landed foot comes down
// while the other one still pushes off) and a flight (Table I (a)). The stick decides how long both
// last; a phase runs through the data's cycle at a rate that meets these times (the time-warp of
// section 3.3). Parameters are smoothed on the way in, so a stick may jump.
//
// Hips. They follow the tables of clean strides (gaitpad/stride_family.h) from the footprint of the
// foot that stands to the next landing. A step leads from the stride of the last step to its own,
// so both tables are read and mixed. The hips' offset from that path, which a moved landing causes,
// fades until the strike.
//
// The pose. Feet and pelvis are planned first, then the inverse kinematics connects them (section
// 3.3.2), and everything else comes from the data at this phase.
#include "gaitpad/walk.h"

#include "animation/floor.h"
#include "animation/placement.h"
#include "animation/sound_input.h"
#include "animation/walk_figure.h"

namespace gaitpad {

// --- Queries about the walk that all parts of a tick use -----------------------------------------

Side step_foot(const WalkState& state) noexcept {
  return state.clock.stage == Stage::flight ? state.clock.swing : other(state.clock.swing);
}

double presence(const WalkState& state) noexcept { return presence_of(state.gait); }

bool walks_on(const GaitParams& params, const WalkState& state) noexcept {
  const bool on_the_spot = params.stride[0].length_m == 0.0 && params.stride[1].length_m == 0.0;
  return params.walking &&
         (!state.clock.started || on_the_spot || params.backward == state.clock.backward);
}

double step_length(const WalkState& state, Side side) noexcept {
  if (state.clock.closing) return 0.0;
  return state.clock.backward ? 0.0 - state.gait.length_m[side].x : state.gait.length_m[side].x;
}

double stage_share(const WalkModel& model, Stage stage, Side swing) noexcept {
  // The share of the cycle's time that a stage takes. Walking order: roll right, flight left, roll
  // left, flight right.
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

Moment moment_of(const WalkModel& model, const WalkState& state) noexcept {
  const StepClock& clock = state.clock;
  Moment at{};
  at.idle = clock.stage == Stage::idle;
  at.flies = clock.stage == Stage::flight;
  at.rolls = clock.stage == Stage::roll;
  at.started = clock.started;
  at.starting = clock.starting;
  at.stopping = clock.stopping;
  at.closing = clock.closing;
  at.led = clock.led;
  at.was_led = clock.was_led;
  at.replanned = clock.replanned;
  at.backward = clock.backward;
  at.right_steps = step_foot(state) == kRightSide;
  for (int side : {0, 1}) {
    at.in_flight[side] = state.foot[side].mode == FootMode::flight;
    at.in_roll[side] = state.foot[side].mode == FootMode::roll;
    at.mode_ticks[side] = state.foot[side].mode_ticks;
  }
  at.tick = clock.tick;
  at.stage_ticks = clock.stage_ticks;
  at.roll_ticks = clock.roll_ticks;
  at.flight_ticks = clock.flight_ticks;
  at.last_step_ticks = clock.last_step_ticks;
  at.phase = clock.phase;
  at.phase_rate = clock.phase_rate;
  at.stage_phase = clock.stage_phase;
  at.stage_end = stage_end_phase(model, state);
  at.end_rate = clock.end_rate;
  at.strike_rate = clock.strike_rate;
  at.strike_phase = at.stage_end;
  at.step_phase = clock.stage_phase;
  if (clock.stage == Stage::roll)
    at.strike_phase += stage_share(model, Stage::flight, other(clock.swing));
  if (clock.stage == Stage::flight)
    at.step_phase -= stage_share(model, Stage::roll, other(clock.swing));
  at.rest_ticks = clock.rest_ticks;
  at.closing_ticks = clock.closing_ticks;
  at.fade_ticks = clock.fade_ticks;
  at.led_from = clock.led_from;
  return at;
}

namespace {

// --- Clock: stages, steps, phases ----------------------------------------------------------------

// Rises are in legs. A riser of 17 cm takes an adult at least 0.84 s.
constexpr double kSlowerOnStairs = 1.2, kSlowestRise = 0.34, kSteepRise = 0.15;
constexpr double kStairStep_s = 0.84, kStairRise = 0.2;
constexpr double kSlowerBack = 2.05;
// Times of the first step: from the stick's push to the lift-off (kFirstRollOn_s if the hips still
// move), then the flight, kFirstFlight of a steady one within the two bounds.
constexpr double kFirstRoll_s = 0.25, kFirstRollOn_s = 0.13, kLeastFirstFlight_s = 0.38,
                 kMostFirstFlight_s = 0.62, kFirstFlight = 0.9;
// A closing foot lands kLandsBefore_s before the hips rest; its flight lasts at most kMostClosing
// times as long as a steady one.
constexpr double kLandsBefore_s = 0.04, kLeastClosing_s = 0.30, kMostClosing = 1.25;
constexpr double kLongestClosingRoll = 1.6, kLeastClosingRoll_s = 0.11, kLeastRollLeft_s = 0.05;
constexpr double kOtherPace = 0.02;   // a larger change of the ratio needs a step of transition
constexpr double kLastRoll_s = 0.17;  // duration of the last roll, until both feet are flat
// Share of the tables that shows, below which another step may begin.
constexpr double kShownAtRest = 0.08;
// Longest wait of a stand before a tiny command starts a walk. It waits less before a larger
// command, and not at all from this stride ratio or turn (rad/s) on.
constexpr double kHesitation = 0.2;
constexpr double kSureRatio = 0.3, kSureTurn = 0.15;

// The share of the cycle's time that a stage takes.
double time_share(const WalkModel& model, const WalkState& state, Stage stage,
                  Side swing) noexcept {
  const Side rolling = stage == Stage::roll ? swing : other(swing);
  const double roll = stage_share(model, Stage::roll, rolling);
  const double flight = stage_share(model, Stage::flight, other(rolling));
  const double rolls = roll_time_share(roll, state.gait.asked_ratio);
  return stage == Stage::roll ? rolls : roll + flight - rolls;
}

// The unit of a stage's duration. Stages last whole beats, so a steady gait is exactly periodic,
// and has the same rhythm at every rate. At 240 Hz a beat is a tick. At another rate a stage ends
// at the tick that is nearest to its end in beats, so rounding errors do not add up.
constexpr double kBeat_s = 1.0 / 240.0;
constexpr int kLeastRoll = 6, kLeastFlight = 12;  // least durations of both stages, in beats
constexpr int kLeastTicks = 2;

int ticks_of(double time_s, double dt_s) noexcept { return static_cast<int>(time_s / dt_s + 0.5); }
double on_beat(double time_s) noexcept { return kBeat_s * ticks_of(time_s, kBeat_s); }

double stage_time(const WalkModel& model, const WalkState& state, Stage stage,
                  Side swing) noexcept {
  const double beats = 2.0 * state.gait.time_s[swing] * state.clock.slowness *
                       time_share(model, state, stage, swing) / kBeat_s;
  return kBeat_s *
         std::max(stage == Stage::roll ? kLeastRoll : kLeastFlight, static_cast<int>(beats + 0.5));
}

int stage_length(const WalkModel& model, const WalkState& state, Stage stage, Side swing,
                 double dt_s) noexcept {
  return std::max(kLeastTicks, ticks_of(stage_time(model, state, stage, swing), dt_s));
}

void begin_stage(Stage stage, Side swing, int ticks, WalkState& state) noexcept {
  state.clock.stage = stage;
  state.clock.swing = swing;
  state.clock.tick = state.clock.led_from = 0;
  state.clock.stage_ticks = ticks;
}

// Plans the phase's rate: at the end of the stage that has begun it will be the mean of both
// stages' rates, so the time-warp of the upper body has no kink.
void aim_phase(const Tick& tick, WalkState& state) noexcept {
  const bool rolls = state.clock.stage == Stage::roll;
  const Stage next = rolls ? Stage::flight : Stage::roll;
  const Side next_swing = rolls ? other(state.clock.swing) : state.clock.swing;
  const double here =
      stage_share(tick.model, state.clock.stage, state.clock.swing) / state.clock.stage_ticks;
  const double there = stage_share(tick.model, next, next_swing) /
                       stage_length(tick.model, state, next, next_swing, tick.dt_s);
  state.clock.end_rate = 0.5 * (here + there);
  state.clock.strike_rate = state.clock.end_rate;
  if (!rolls) return;
  const double flight =
      stage_share(tick.model, Stage::flight, next_swing) / std::max(1, state.clock.flight_ticks);
  const double roll = stage_share(tick.model, Stage::roll, next_swing) /
                      stage_length(tick.model, state, Stage::roll, next_swing, tick.dt_s);
  state.clock.strike_rate = 0.5 * (flight + roll);
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

// Sets the duration of both stages of the running step. It compensates for the rounding of the
// steps before it.
void time_step(const Tick& tick, double roll_s, double flight_s, StepClock& clock) noexcept {
  clock.roll_s = roll_s;
  clock.step_s = roll_s + flight_s;
  clock.roll_ticks = std::max(kLeastTicks, ticks_of(roll_s + clock.late_s, tick.dt_s));
  const double left_s = clock.step_s + clock.late_s - clock.roll_ticks * tick.dt_s;
  clock.flight_ticks = std::max(kLeastTicks, ticks_of(left_s, tick.dt_s));
  clock.step_ticks = clock.roll_ticks + clock.flight_ticks;
}

// Begins a step: `rolling` has just landed, the other foot flies next.
void begin_step(const Tick& tick, Side rolling, WalkState& state) noexcept {
  // A step that was changed while it ran passes no rounding on to the next one.
  if (state.clock.step_ticks == state.clock.roll_ticks + state.clock.flight_ticks)
    state.clock.late_s =
        std::clamp(state.clock.late_s + state.clock.step_s - state.clock.step_ticks * tick.dt_s,
                   -tick.dt_s, tick.dt_s);
  state.clock.last_step_ticks = state.clock.roll_ticks + state.clock.flight_ticks;
  state.clock.slowness = slowness_of_step(tick.model, state, other(rolling));
  time_step(tick, stage_time(tick.model, state, Stage::roll, rolling),
            stage_time(tick.model, state, Stage::flight, other(rolling)), state.clock);
  state.clock.stage_phase = rolling == kRightSide ? 0.0 : tick.model.share[0] + tick.model.share[1];
  // The phase may differ from the clock's by whole turns.
  state.clock.phase = state.clock.stage_phase;
  begin_stage(Stage::roll, rolling, state.clock.roll_ticks, state);
  aim_phase(tick, state);
}

// Times the first flight. It follows the stick until the foot lifts off, because a thumb takes some
// time.
void time_first_flight(const Tick& tick, WalkState& state) noexcept {
  const double scale = tick.model.time_scale;
  const Side first = other(state.clock.swing);
  const double steady_s = stage_time(tick.model, state, Stage::flight, first);
  const double flight_s =
      std::clamp(kFirstFlight * steady_s, kLeastFirstFlight_s * scale, kMostFirstFlight_s * scale);
  StepClock& clock = state.clock;
  const int roll_ticks = ticks_of(clock.roll_s, tick.dt_s);
  clock.step_s = clock.roll_s + on_beat(flight_s);
  clock.flight_ticks = ticks_of(clock.step_s - roll_ticks * tick.dt_s, tick.dt_s);
  clock.step_ticks = roll_ticks + clock.flight_ticks;
  aim_phase(tick, state);
}

void begin_walk(const Tick& tick, WalkState& state) noexcept {
  // The first foot follows the turn, so that a mirrored stick gives a mirrored walk. While the foot
  // that landed last still rolls down, the other one goes.
  const Side turns_to = tick.params.turn_rate_rad_s < 0.0 ? kRightSide : kLeftSide,
             first = state.clock.stage == Stage::roll ? other(state.clock.swing) : turns_to;
  const bool moves = state.clock.stage == Stage::roll;
  state.clock.started = state.clock.starting = true;
  state.clock.stopping = state.clock.closing = false;
  state.clock.backward = tick.params.backward;
  state.gait.ratio_behind = 0.0;
  state.clock.flight_ticks = state.clock.roll_ticks = state.clock.step_ticks = 0;
  state.clock.step_s = state.clock.late_s = 0.0;
  begin_step(tick, other(first), state);
  state.clock.roll_s = on_beat((moves ? kFirstRollOn_s : kFirstRoll_s) * tick.model.time_scale);
  state.clock.stage_ticks = state.clock.roll_ticks = ticks_of(state.clock.roll_s, tick.dt_s);
  time_first_flight(tick, state);
  state.clock.phase_rate = 0.0;
  state.clock.led = true;
  replan(0.5 * kFirstRoll_s, tick, state);
  // The tables' hips are over the standing foot in the middle of its support.
  state.gait.phase_rate = 0.0;
  state.gait.phase = state.clock.stage_phase +
                     0.5 * stage_share(tick.model, Stage::roll, other(first)) +
                     0.5 * stage_share(tick.model, Stage::flight, first);
  for (Damped<double>& length_m : state.gait.length_m) length_m = {};
  state.foot[other(first)].mode = FootMode::roll;
}

void begin_idle(WalkState& state) noexcept {
  begin_stage(Stage::idle, state.clock.swing, 1, state);
  state.clock.started = state.clock.stopping = state.clock.led = state.clock.was_led = false;
  state.clock.roll_ticks = state.clock.flight_ticks = 0;
  state.path.foothold.next_rise = 0.0;
}

// Begins the last roll, with the feet together: the toe comes down, then the character rests.
void begin_settling(const Tick& tick, Side landed, WalkState& state) noexcept {
  const int flat = ticks_of(kLastRoll_s * tick.model.time_scale, tick.dt_s);
  begin_stage(Stage::roll, landed, std::max(flat, state.clock.rest_ticks + 1), state);
  state.clock.stage_phase = state.clock.phase;
  state.clock.started = state.clock.closing = false;
  begin_roll(tick, state, landed);
  FootState& stays = state.foot[other(landed)];
  stays.fade_begin = stays.mode_ticks;
  stays.pitch_fade = {stays.pose.pitch_rad, 0.0, static_cast<double>(flat)};
}

void land_foot(const Tick& tick, WalkState& state) noexcept {
  StepClock& clock = state.clock;
  const Side landed = clock.swing;
  // After a stop that was withdrawn the tables may not have reached the step's own stride.
  const double change = std::clamp(state.gait.change, 0.0, 1.0);
  if (!clock.closing)
    state.gait.ratio_behind =
        mix(state.gait.ratio_behind,
            ratio_ahead<double>(tick.model, moment_of(tick.model, state), state), change);
  state.gait.off_ahead = {};
  plant_foot(state, landed);
  if (clock.closing) {
    begin_settling(tick, landed, state);
    return;
  }
  const bool begins = clock.starting;
  clock.was_led = clock.led;
  clock.starting = false;
  if (clock.stopping && clock.further_steps-- <= 0) clock.closing = true;
  begin_step(tick, landed, state);
  if (clock.closing) {
    // The hips rest between the feet as these then stand, and not before the foot can be there.
    clock.rest_ticks =
        std::max(clock.rest_ticks,
                 ticks_of((kLeastClosing_s + kLeastRollLeft_s) * tick.model.time_scale, tick.dt_s));
    clock.closing_ticks = clock.rest_ticks;
    plan_rest_place(tick, state);
    time_closing_step(tick, state);
  }
  const double own_m = tick.model.own_step_m[clock.backward ? landed : other(landed)];
  const double asked = tick.params.stride[other(landed)].length_m / own_m;
  // A limp's steps differ from each other, and uneven ground shortens them, so the pace counts as
  // changed only if the step that is asked for changes.
  const double last =
      begins && tick.flat ? state.gait.ratio_behind : state.gait.length_m[other(landed)].x / own_m;
  clock.led = clock.stopping || std::abs(asked - last) > kOtherPace;
  if (clock.led || clock.was_led) replan(kCarry_s, tick, state);
  begin_roll(tick, state, landed);
}

// Takes new parameters. Step times, and the duration of double support, follow them at the next
// step.
void ask_for(const GaitParams& params, const WalkModel& model, WalkState& state) noexcept {
  for (int side : {0, 1}) state.gait.time_s[side] = params.stride[side].time_s;
  // Use the larger of both feet's ratios: a limp, which shortens one step, does not change the
  // other foot's time.
  state.gait.asked_ratio = 0.0;
  for (int side : {0, 1}) {
    const double own_m = model.own_step_m[params.backward ? 1 - side : side];
    state.gait.asked_ratio = std::max(state.gait.asked_ratio, params.stride[side].length_m / own_m);
  }
}

// True if a command is large enough, or has lasted long enough. A stand waits up to kHesitation
// before it follows a very small command: a stick that is touched in passing would otherwise cause
// two slow steps before a full push in another direction is followed.
bool is_meant(const Tick& tick, WalkState& state) noexcept {
  const double sure = std::max(state.gait.asked_ratio / kSureRatio,
                               std::abs(tick.params.turn_rate_rad_s) / kSureTurn);
  return ++state.clock.asked_ticks * tick.dt_s >=
         kHesitation * tick.model.time_scale * (1.0 - std::min(sure, 1.0));
}

// Moves the clocks on by one tick.
void advance_clock(const Tick& tick, WalkState& state) noexcept {
  for (FootState& foot : state.foot) ++foot.mode_ticks;
  if (state.clock.rest_ticks > 0) --state.clock.rest_ticks;
  if (state.clock.stage == Stage::idle) return;
  const bool resting = !state.clock.started;  // in the last roll the data's clock does not run
  const double remaining = state.clock.stage_ticks - state.clock.tick;
  ++state.clock.tick;
  if (resting) return;
  approach(state.clock.phase, state.clock.phase_rate, stage_end_phase(tick.model, state),
           state.clock.end_rate, remaining, 1.0);
}

// Begins the next stage if this one is over.
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

}  // namespace

void time_step_again(const Tick& tick, WalkState& state) noexcept {
  StepClock& clock = state.clock;
  const bool flies = clock.stage == Stage::flight;
  const Side swing = step_foot(state);
  if (!flies) {
    const int rolls = stage_length(tick.model, state, Stage::roll, other(swing), tick.dt_s);
    clock.roll_ticks = clock.stage_ticks = std::max(clock.tick + 1, rolls);
  }
  clock.flight_ticks = stage_length(tick.model, state, Stage::flight, swing, tick.dt_s);
  if (flies) clock.stage_ticks = clock.flight_ticks;
  aim_phase(tick, state);
}

// Times the closing step. The closing foot lifts off when the hips are as far ahead of the standing
// foot as in a walk.
void time_closing_step(const Tick& tick, WalkState& state) noexcept {
  StepClock& clock = state.clock;
  const double scale = tick.model.time_scale;
  // On stairs a closing step takes as long as any other.
  const int least = state.path.foothold.next_rise > 0.0
                        ? clock.flight_ticks
                        : ticks_of(kLeastClosing_s * scale, tick.dt_s),
            left = clock.rest_ticks - ticks_of(kLandsBefore_s * scale, tick.dt_s),
            longest = std::max(least, static_cast<int>(kMostClosing * clock.flight_ticks)),
            least_roll = std::max(
                std::min(ticks_of(kLeastClosingRoll_s * scale, tick.dt_s), clock.roll_ticks) -
                    clock.tick,
                ticks_of(kLeastRollLeft_s * scale, tick.dt_s)),
            most_roll =
                std::min(left - least, static_cast<int>(kLongestClosingRoll * clock.roll_ticks));
  const int rolls =
      std::clamp(ticks_to_lift_off(tick.model, state), least_roll, std::max(least_roll, most_roll));
  clock.roll_ticks = clock.stage_ticks = clock.tick + rolls;
  clock.flight_ticks = std::clamp(left - rolls, least, longest);
  aim_phase(tick, state);
}

namespace {

// --- Report --------------------------------------------------------------------------------------

void report_ground(const Tick& tick, WalkFrame& frame) noexcept {
  if (tick.flat) return;
  const Floor terrain{*tick.model.terrain, tick.placed};
  const std::array<double, 4> ground =
      heights_at<4>(terrain, {frame.heel_m[0], frame.heel_m[1], frame.toe_m[0], frame.toe_m[1]});
  frame.heel_ground_m = {ground[0], ground[1]};
  frame.toe_ground_m = {ground[2], ground[3]};
}

void fill_report(const vec3& pelvis_m, double dt_s, WalkState& state) noexcept {
  WalkFrame& frame = state.frame;
  frame.stage = state.clock.stage;
  frame.swing = state.clock.swing;
  frame.heading_rad = state.path.heading_rad;
  frame.turn_rate_rad_s = state.gait.turn_rate.x;
  frame.pelvis_m = pelvis_m;
  const bool idle = frame.stage == Stage::idle;
  if (idle) state.path.stride_m = {};
  frame.stride_m = state.path.stride_m;
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
  return standing(model, place_m, 0.0, pose);
}

WalkState standing(const WalkModel& model, const vec3& place_m, double heading_rad,
                   Pose& pose) noexcept {
  WalkState state;
  const double yaw_rad = wrapped(mended_place(heading_rad, state));
  const quat yaw = rotation_y(yaw_rad);
  state.path.heading_rad = state.path.landing_heading_rad = state.path.last_heading_rad = yaw_rad;
  state.path.hips_m = vec3(mended_place(place_m.x, state), 0.0, mended_place(place_m.z, state));
  state.path.pelvis_m.x = state.path.last_pelvis_m = state.path.hips_m;
  state.gait.flight_height = {Damped<double>{1.0, 0.0}, Damped<double>{1.0, 0.0}};
  state.gait.bounce.x = state.gait.sway.x = state.gait.ground_share.x = 1.0;
  state.gait.step_time_s.x = 0.5;
  for (Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = model.leg[side];
    FootState& foot = state.foot[side];
    for (Damped<double>& w : state.gait.weight[side]) w.x = 1.0;
    state.gait.time_s[side] = 0.5;
    foot.lift_yaw_rad = yaw_rad;
    foot.pose.yaw = yaw;
    foot.heel_anchor_m = state.path.hips_m + yaw * vec3(leg.track_m, 0.0, -model.rest_lead_m);
    if (!is_flat(*model.terrain)) {
      foot.plane = standing_plane(model, side, foot.heel_anchor_m, yaw_rad);
      foot.heel_anchor_m = foot.plane.place_m;
      foot.pose.tilt = foot.plane.tilt;
    }
    foot.pose.heel_m = foot.heel_anchor_m;
    pitch_foot(leg, 0.0, foot.pose, FootMode::roll);
    foot.toe_anchor_m = foot.pose.toe_m;
    foot.lift_m = foot.heel_anchor_m;
  }
  for (int ticks = 0; ticks < 2; ++ticks) remember_feet(model, state);
  state.path.landing_m = state.foot[kLeftSide].heel_anchor_m;
  state.path.landing_plane = state.foot[kLeftSide].plane;
  state.path.base.height_m = state.path.base.level_m =
      std::min(state.foot[kLeftSide].plane.place_m.y, state.foot[kRightSide].plane.place_m.y);
  advance(model, GaitParams{}, IkMode::robust, 1.0 / 240.0, state, pose);
  // Values that may not jump reach their goals in this tick and then stay.
  state.path.eased_height.rate = state.path.eased_height.bend = 0.0;
  for (auto* turn : {&state.body.eased_chest, &state.body.eased_head})
    turn->rate = turn->bend = vec3(0.0);
  state.legs.mean_rad = state.legs.lagging_rad = state.legs.even_rad;
  return state;
}

// Starts a walk from standing when the parameters ask for one.
void begin_tick(const Tick& tick, WalkState& state, Moment& at) noexcept {
  const GaitParams& params = tick.params;
  // A walk may begin when both feet stand, also while the hips still come to rest.
  const bool stands = !state.clock.started && state.gait.shown <= kShownAtRest &&
                      state.frame.stage != Stage::flight &&
                      (tick.flat || state.clock.stage == Stage::idle);
  bool hesitates = false;
  if (stands && params.walking) {
    ask_for(params, tick.model, state);
    hesitates = !is_meant(tick, state);
    if (!hesitates) begin_walk(tick, state);
  } else {
    state.clock.asked_ticks = 0;
  }
  const bool walks = walks_on(params, state);
  if (walks) ask_for(params, tick.model, state);
  if (state.clock.started && !walks && !state.clock.stopping) plan_rest(tick, state);
  if (state.clock.started && walks && state.clock.stopping) walk_on(tick, state);
  if (state.clock.starting && state.clock.stage == Stage::roll) time_first_flight(tick, state);
  take_asked_step(tick, state);
  smooth_upper_body(tick, state);
  advance_idle(tick, state);
  if (!tick.flat && tick.mode != IkMode::paper) lean_into_slope(tick, state);
  advance_clock(tick, state);
  at = moment_of(tick.model, state);
  at.walking = walks && !state.clock.stopping && !hesitates;
  at.finishes = state.clock.started && !state.clock.closing && !at.walking;
}

void end_tick(const Tick& tick, const vec3& pelvis_m, WalkState& state) noexcept {
  fill_report(pelvis_m, tick.dt_s, state);
  report_ground(tick, state.frame);
  state.clock.replanned = false;
  finish_stage(tick, state);
  remember_feet(tick.model, state);
}

void plan_tick(const Tick& tick, WalkState& state, PlannedTick& planned) noexcept {
  planned.tick = &tick;
  planned.state = &state;
  begin_tick(tick, state, planned.at);
  plan_walks<double>(tick, planned.at, params_of(tick.params, state.body.now.arm_swing), state,
                     planned.plan, planned.pelvis);
}

// Solves both legs side by side, first with even weights.
void pose_robust(const PlannedTick& planned, std::array<PosedLeg, 2>& posed) noexcept {
  const Tick& tick = *planned.tick;
  WalkState& state = *planned.state;
  const Pelvis& pelvis = planned.pelvis;
  std::array<LegToClose, 2> closed;
  std::array<LegToSolve, 2> legs;
  for (const Side side : {kLeftSide, kRightSide}) {
    advance_weighted_leg<double>(tick, planned.at, side, state);
    set_start<double>(tick, planned.plan, side, state, closed[side].angles_rad);
    set_planned_leg<double>(tick.model.leg[side], state.foot[side].pose, pelvis,
                            closed[side].planned);
  }
  close_two_legs(closed);
  const bool missed = closed[0].reached * closed[1].reached == 0.0;
  if (missed) {
    for (const Side side : {kLeftSide, kRightSide}) {
      legs[side].angles_rad = closed[side].angles_rad;
      set_even_goals<double>(tick.model.leg[side], state, pelvis, side, legs[side].goals);
    }
    solve_two_legs<false>(legs);
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    const bool solves = closed[side].reached == 0.0;
    state.legs.even_rad[side] = solves ? legs[side].angles_rad : closed[side].angles_rad;
    posed[side] = closed_leg<double>(state.foot[side].pose);
    if (solves)
      keep_solved<double>(tick.model.leg[side], true, legs[side].solution, pelvis, posed[side]);
    const double ankle = state.legs.even_rad[side][kAnkleX];
    if (!needs_mending<double>(tick.model, planned.at, side, ankle, posed[side].failed)) continue;
    posed[side] = mended_leg(tick, state, pelvis, side, posed[side]);
  }
  if (!has_weights(state.gait, kLeftSide) && !has_weights(state.gait, kRightSide)) {
    state.legs.angles_rad = state.legs.even_rad;
    return;
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    set_limits<double>(tick.model.leg[side], legs[side].goals);
    set_leg<double>(tick.model.leg[side], state.foot[side].pose, pelvis, legs[side].goals);
    set_shares<double>(tick, planned.at, planned.plan, pelvis, side, state, legs[side].goals,
                       legs[side].shares, legs[side].angles_rad);
  }
  solve_two_legs<true>(legs);
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegToSolve& leg = legs[side];
    keep_shared<double>(tick.model.leg[side], side, leg.goals, leg.shares, leg.angles_rad,
                        leg.solution, pelvis, state.legs, posed[side]);
  }
}

void pose_legs(const PlannedTick& planned) noexcept {
  const Tick& tick = *planned.tick;
  WalkState& state = *planned.state;
  const Pelvis& pelvis = planned.pelvis;
  std::array<PosedLeg, 2> posed;
  if (tick.mode == IkMode::paper) {
    for (const Side side : {kLeftSide, kRightSide})
      posed[side] = pose_paper(tick, state, pelvis, side);
  } else {
    pose_robust(planned, posed);
  }
  WalkFrame* const frame = &state.frame;
  for (const Side side : {kLeftSide, kRightSide})
    report_leg<double>(planned.at, side, posed[side], state, {&frame, 1});
}

void finish_tick(const PlannedTick& planned, Pose& pose) noexcept {
  const Tick& tick = *planned.tick;
  WalkState& state = *planned.state;
  const int joints = static_cast<int>(tick.model.cycle.skeleton.joints.size());
  pose.joint_count = joints;
  pose.root_m = planned.pelvis.position_m;
  write_pose<double>(tick.model, planned.at, state, planned.pelvis, {pose.local.data()});
  pose_upper_body(tick, state,
                  {pose.root_m, {pose.local.data(), static_cast<std::size_t>(joints)}});
  end_tick(tick, planned.pelvis.position_m, state);
}

void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept {
  if (!is_sound_tick(dt_s)) return advance(model, params, mode, mended_tick(state), state, pose);
  if (!is_sound(params, state))
    return advance(model, mended_params(params, state), mode, dt_s, state, pose);
  state.clock.tick_s = dt_s;
  const int parts = tick_parts(dt_s);
  const Tick tick = {model, params, mode, dt_s / parts, is_flat(*model.terrain), state.placed};
  const RootBefore before = root_of(state);
  // Static, because clearing it takes longer than a leg's solve.
  static thread_local PlannedTick planned;
  for (int part = 0; part < parts; ++part) {
    plan_tick(tick, state, planned);
    pose_legs(planned);
    finish_tick(planned, pose);
  }
  report_root(before, state);
  place_in_world(state.placed, state.frame, pose.root_m, pose.local[0]);
}

}  // namespace gaitpad
