// The animation module: a character that walks where the gait parameters say.
// Meredith & Maddock 2005, section 3.3: the two-stage cycle of Table I, feet along the flight paths
// of the data, legs posed by weighted half-Jacobian inverse kinematics, the rest of the body from
// the data by a time-warp. Section 5 (future work): weights for arms, spine and head.
//
// Model, state and step are apart. A WalkModel is immutable and may be shared by many walkers. A
// WalkState and a Pose belong to one walker; both are plain data in the caller's memory and may be
// copied, kept and compared. standing() makes a state, and advance() moves it on by one tick:
//
//   Pose pose;
//   WalkState state = standing(model, vec3(0.0), pose);
//   for (;;) advance(model, params, IkMode::robust, 1.0 / 240.0, state, pose);
//
// advance() is noexcept and uses no heap, lock, clock or libm trigonometry. The same model,
// parameters and tick length give the same bits on every machine.
#pragma once
#include <array>
#include <cstdint>

#include "gaitpad/gait_params.h"
#include "gaitpad/skeleton.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

// A tick lasts at least and at most so long.
inline constexpr double kLeastTick_s = 1e-4, kMostTick_s = 0.1;
// A place in the world has coordinates of at most so much.
inline constexpr double kFarthest_m = 1e6;

// paper: the paper's steps 1-7 to the letter; no joint limits, and the solver may fail.
// robust: damped, within joint limits, continuous; for characters that people look at.
enum class IkMode : std::uint8_t { paper, robust };
enum class Stage : std::uint8_t {
  idle,    // both feet planted
  flight,  // Table I (a): one heel flies, the other foot's toe is planted
  roll,    // Table I (b): the landed heel and the other foot's toe are planted
};

// Where coordinates lie in the world: turned by `heading_rad` about the vertical through their
// origin, which is at `place_m`.
struct Placement {
  vec3 place_m{0.0};         // world; each coordinate at most kFarthest_m
  double heading_rad = 0.0;  // to the left positive, at most kFarthest_m of them
  bool operator==(const Placement&) const = default;
};
// A place in the world, and back.
vec3 to_world(const Placement& placed, const vec3& place_m) noexcept;
vec3 from_world(const Placement& placed, const vec3& world_m) noexcept;
// Where `placed` lies after the world has been turned and shifted by `by`.
Placement moved(const Placement& by, const Placement& placed) noexcept;

// What one tick did, for export, tests and panels; advance() fills it. World frame, metres: y up,
// floor 0, heading 0 along +z, x to the left at heading 0. Arrays are indexed by Side.
struct WalkFrame {
  Stage stage = Stage::idle;
  Side swing = kLeftSide;    // flight: the flying foot; roll: the foot that has just landed
  double heading_rad = 0.0;  // positive to the left; whole turns add up
  double turn_rate_rad_s = 0.0;
  double speed_m_s = 0.0;  // (left + right step) / cycle time of the running cycle; 0 when idle
  vec3 pelvis_m{0.0};
  // Root motion: the hips' place on the ground; what the tick has added to it, in axes of the
  // heading before (x left, z ahead); and to the heading. For engines that move their own capsule.
  vec3 root_m{0.0}, root_moved_m{0.0};
  double root_turned_rad = 0.0;
  std::array<double, 2>
      stride_m{};  // length of that foot's running or last step; backwards negative
  std::array<bool, 2> heel_planted{true, true}, toe_planted{true, true};
  std::array<vec3, 2> heel_m{}, toe_m{};
  std::array<int, 2> ik_iterations{};  // of all solves of that leg in this tick
  std::array<double, 2> ik_error_m{};  // of the last one of them
  std::array<bool, 2> ik_failed{};     // it did not converge
  std::array<int, 2> steps{};          // landings so far
  // Height of the ground under heel and toe, planted or not.
  std::array<double, 2> heel_ground_m{}, toe_ground_m{};
  int overhangs = 0;  // landings so far on a tread too short for the foot
  // Numbers so far that advance(), standing(), move_walk() or put_walk() did not take.
  int bad_inputs = 0;
};

// support: on its toe; flight: in the air; roll: landed on its heel, the toe comes down.
enum class FootMode : std::uint8_t { support, flight, roll };

// --- What a walk remembers -----------------------------------------------------------------------
// A tick computes several walks side by side, one in each lane of the processor's registers
// (gaitpad/math.h). What all of them compute alike is a template of the number V: a double, or a
// register of as many as it holds. The structs of V hold numbers alone.

// The plane that a foot stands on or flies to: the best fit to the ground under its sole.
struct FootPlane {
  vec3 place_m{0.0};      // of the heel, world
  vec3 normal = kUp;      // unit
  quat tilt = kIdentity;  // from level ground
};

// Where a foot is to be, on level ground.
template <class V>
struct FootPoseOf {
  Vec<V> heel_m{}, toe_m{};  // world
  Quat<V> yaw{};             // about the vertical; none as in the standing pose at heading 0
  V pitch_rad{};             // of the heel-toe line: 0 flat on its ground, toe down positive
  Quat<V> edge{};            // twist and roll of StrideFoot
  Quat<V> rotation{};        // of all these: the foot segment's, world
  V toe_rad{};               // of the toe joint, toe end down positive
};
// And on any.
struct FootPose : FootPoseOf<double> {
  quat tilt = kIdentity;  // from level ground to the foot's own
  FootPose() noexcept : FootPoseOf{.yaw = kIdentity, .edge = kIdentity, .rotation = kIdentity} {}
};

// What keeps a flying foot off the ground between its two footholds: two uniform cubic B-splines
// over the flight, given by their inner control points.
inline constexpr int kFlightKnots = 8;
using FlightSpline = std::array<double, kFlightKnots - 1>;
struct FlightRoom {
  FlightSpline raise_m{}, shift_m{};  // planned: up, and along z, away from a riser
  std::array<Damped<double>, kFlightKnots - 1> raise, shift;  // the same, smoothed and in force
  vec3 planned_for_m{0.0};                                    // the landing that it is planned for
};

// A value that may not jump: it, and its first and second differences; by what it is kept off its
// goal, and for how many ticks still.
template <class T, class V>
struct EasedOf {
  T value{}, rate{}, bend{};
  SmoothFade<T> off;
  V ticks{};
};

template <class V>
struct FootFlow {
  Vec<V> heel_anchor_m{}, toe_anchor_m{};  // where they were planted last
  std::array<Vec<V>, 2> last_heel_m{};     // one and two ticks ago
  std::array<V, 2> last_pitch_rad{};
  FadeOf<V> pitch_fade;  // over the running mode, argument in ticks of it
  V fade_begin{};        // from this one on
  Vec<V> lift_m{};       // heel at lift-off
  // What the heel's place at lift-off differs by from the tables', and its slope per flight.
  Vec<V> gap_m{}, gap_slope_m{};
  V gap_begin{}, gap_lasts{};  // in shares of the flight
  V gap_yaw_rad{};
  V gap_high_m{};  // the tables' height there: a foot that was lower stays off the ground
  V lift_yaw_rad{}, lift_turn_rad{};  // yaw at lift-off and its slope per flight
  EasedOf<Vec<V>, V> eased_heel;
  EasedOf<V, V> eased_pitch;
  EasedOf<Vec<V>, V> eased_edge;  // twist and roll
};
struct FootState : FootFlow<double> {
  FootPose pose;
  FootMode mode = FootMode::support;
  int mode_ticks = 0;  // since the mode began
  // On flat ground the rest keeps these values.
  FootPlane plane;                      // that it stands on or stood on last
  double base_m = 0.0;                  // height of the ground that the pose is planned over
  double rise_m = 0.0;                  // how far the foot rises with the hips
  std::array<double, 2> last_rise_m{};  // one and two ticks ago
  bool crosses_riser = false;           // in the running flight
  FlightRoom room;
};

// What terrain makes of a step. On flat ground all of it keeps these values.
struct Foothold {
  vec3 wanted_m{0.0};      // the heel's place if the ground were level
  double yaw_rad = 0.0;    // of the foot
  Stretch piece;           // piece of ground for the landing, settled when the flight begins
  double share = 1.0;      // of the wanted length that a slope leaves
  double next_rise = 0.0;  // how far up or down the step after this one leads, in legs
  bool fits = true;        // the sole does not overhang an edge
};

// The height of the ground that the hips go over. On flat ground all of it stays 0.
struct HipsGround {
  double height_m = 0.0, per_tick_m = 0.0, per_tick2_m = 0.0;  // its rate and acceleration
  double level_m = 0.0;                 // where it settles over the standing foot,
  SmoothFade<double> off_m;             // by how much it is still off,
  int settle_ticks = 0;                 // and how long after the strike it is not any more
  double drop_m = 0.0;                  // how far it then sinks to the next landing,
  double early_m = 0.0, yield_m = 0.0;  // and how far below that landing, at it and after it
};

// What a walk remembers of the upper body.
struct UpperBodyState {
  UpperBodyParams goal, now;  // asked for; smoothed and in force
  std::array<double, sizeof(UpperBodyParams) / sizeof(double)>
      per_s{};                                    // rates of `now`, per second
  int unsettled_ticks = 0;                        // until `now` is `goal`
  EasedOf<vec3, double> eased_chest, eased_head;  // turns in the walker's axes, rotation vectors
  // How far the trunk leans in this tick, and how far the upper arms are spread; in paper mode not.
  double forward_rad = 0.0, left_rad = 0.0;
  // What is seen of a change before the feet can follow: the mean speed, the lean into another one,
  // and how far chest and head are turned ahead, to the left positive.
  Damped<double> speed_m_s, push_rad, chest_ahead_rad, head_ahead_rad;
  std::array<double, 2> out_rad{};
  // Height of the ground under a rail, smoothed, and its rate.
  std::array<double, 2> rail_ground_m{}, rail_ground_m_s{};
};

// A person who stands: for how long, how much of it shows, and how far the trunk rises with the
// breath and the head is turned by a glance, to the left and down positive. The hips' sway is of
// the path.
struct IdleState {
  int ticks = 0;
  double share = 0.0;  // 0 none .. 1 all
  double breath_rad = 0.0, glance_rad = 0.0, nod_rad = 0.0;
};

// Where the walk is in its step, in ticks. A step is a roll and the flight after it; phases count
// from the right foot's strike.
struct StepClock {
  Stage stage = Stage::idle;
  Side swing = kLeftSide;
  int tick = 0, stage_ticks = 1;  // in the stage
  int roll_ticks = 0, flight_ticks = 0;
  int last_step_ticks = 0;                // of the step before
  bool started = false;                   // between the first lean and the last landing
  bool starting = false;                  // the running step is the first one
  bool stopping = false;                  // the hips are on their way to rest
  bool closing = false;                   // the running step brings the feet together
  bool led = false;                       // the hips lead, and the tables' phase follows them
  bool was_led = false;                   // in the step before
  bool replanned = false;                 // in this tick
  int further_steps = 0;                  // of a stop, before the one that closes
  int rest_ticks = 0, closing_ticks = 1;  // until the hips rest: now, and when closing began
  int fade_ticks = 0;                     // in which what the last plan left fades
  int led_from = 0;                       // tick of the stage in which the hips began to lead
  double strike_rate = 0.0;               // phase_rate at the coming strike
  int asked_ticks = 0;                    // how long a stand has been asked to walk
  bool backward = false;                  // the running walk's steps lead backwards
  double slowness = 1.0;                  // factor on the running step's times on steep ground
  double phase = 0.0, phase_rate = 0.0;   // per tick
  double stage_phase = 0.0;               // where the running stage began
  double end_rate = 0.0;                  // phase_rate at its end
  // The running roll and step as planned, not rounded to ticks; how many ticks the step was given;
  // and by how much the steps so far were too short.
  double roll_s = 0.0, step_s = 0.0;
  int step_ticks = 0;
  double late_s = 0.0;
  double tick_s = 1.0 / 240.0;  // length of the last tick
};

// How it walks: the parameters, smoothed, and the stride ratios that follow from them.
template <class V>
struct GaitFlow {
  std::array<Damped<V>, 2> length_m, flight_height;
  std::array<V, 2> time_s{};
  V asked_ratio{};        // of the strides, by the parameters
  Damped<V> step_time_s;  // mean of both feet
  Damped<V> turn_goal,    // what turn_rate follows: a landing is planned with it
      turn_rate, bounce, sway;
  Damped<V> pace, posture;  // step length over the data's; the share of the data's posture
  Damped<V> ground_share;   // of the wanted lengths that the ground leaves
  std::array<std::array<Damped<V>, kLegDofs>, 2> weight;
  V ratio_behind{};         // of the step before: the stride ratio at the last strike
  V step_ratio{};           // of the running step,
  SmoothFade<V> off_ratio;  // and how far the tables' is off it
  // What a changed plan left of the last one's share of the tables, change from the stride behind
  // to the one ahead, and phase; gone after so many ticks.
  SmoothFade<V> off_shown, off_change, off_phase;
  V off_ticks{};
  V shown{}, change{}, phase{};                 // in force,
  V shown_rate{}, change_rate{}, phase_rate{};  // and per tick
  std::array<V, 2> arm_swing{};                 // factor on the data's in this tick, by Side
  SmoothFade<V> off_ahead;  // of the ratio that the last plan had for the running step
};
using GaitState = GaitFlow<double>;

// Where it goes: landing places, and the hips on their way there.
template <class V>
struct PathFlow {
  V heading_rad{};
  Vec<V> hips_m{};  // on the ground, without the data's oscillations
  // The pelvis' place on the ground, upright, with its rate and acceleration per tick; and as it
  // was a tick before.
  SmoothFade<Vec<V>> pelvis_m;
  Vec<V> last_pelvis_m{};
  Vec<V> rest_m{};  // where it comes to rest when stopping
  // How much of the walk is not steady: 0 none .. 1 all. Then nothing that is planned may jump.
  V unsteady{};
  EasedOf<V, V> eased_height;   // of the pelvis
  Damped<V> sunk_m;             // how much lower it is than the tables have it
  V wider_m{}, next_wider_m{};  // the footprint that stands, and the next one, in a turn
  // What the hips' place differs by from the tables' path to the landing; it fades in the step.
  SmoothFade<Vec<V>> off_m;
  // What that path led to a tick ago.
  Vec<V> last_landing_m{};
  V last_heading_rad{}, last_ratio{};
  Vec<V> landing_m{};
  V landing_heading_rad{};
  std::array<V, 2> stride_m{};  // as in WalkFrame
  Damped<V> lean_rad;           // of the whole body into a turn, to the left positive
  Vec<V> sway_m{};              // of the hips of one who stands, on the ground
};
struct PathState : PathFlow<double> {
  FootPlane landing_plane;
  Foothold foothold;
  HipsGround base;
  Damped<double> slope_lean_rad;  // of the trunk into a slope or stair, forwards positive
};

// The legs' angles: the pose's; those of even weights, and their running means; the tables', and
// what even ones differed by from them a tick before; what the weights changed then.
template <class V>
struct LegFlow {
  using Angles = std::array<std::array<V, kLegDofs>, 2>;
  Angles angles_rad{}, even_rad{}, mean_rad{}, lagging_rad{};
  Angles data_rad{}, last_off_rad{}, last_shift_rad{};
  std::array<Damped<V>, 2> loose;  // whether uneven weights may turn the foot: 0 not .. 1
  // How low its heel is kept where it would rise, and the pitch that its leg asks for all the same.
  std::array<Damped<V>, 2> low;
  std::array<V, 2> asked_rad{};
};
using LegState = LegFlow<double>;

// All that a walk remembers; standing() and advance() fill it. Plain, trivially copyable.
struct WalkState {
  WalkFrame frame;
  // A walk counts in coordinates of its own, in which the sections of its terrain lie, too. Poses
  // and `frame` are in the world, where these coordinates lie so: writing it between two ticks
  // moves the walk and its ground rigidly, and every bit of the rest stays. For a platform it is
  // the platform's place in each tick; for a shifted origin and a teleport see move_walk() and
  // put_walk().
  Placement placed;
  StepClock clock;
  GaitState gait;
  PathState path;
  std::array<FootState, 2> foot;
  LegState legs;
  UpperBodyState body;
  IdleState idle;
};

// A character that stands at `place_m`, facing +z, on its terrain; the height of `place_m` does not
// matter. Sets `pose`. A coordinate or heading that is not finite or beyond kFarthest_m counts as 0
// (WalkFrame::bad_inputs).
WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept;

// The same, facing `heading_rad`.
WalkState standing(const WalkModel& model, const vec3& place_m, double heading_rad,
                   Pose& pose) noexcept;

// Turns the walk about the world's vertical through the origin and shifts it, in the middle of a
// step, too. Planted feet stay where they are in the moved frame. A number that is not finite or
// beyond kFarthest_m moves nothing and is counted (WalkFrame::bad_inputs).
void move_walk(const Placement& by, WalkState& state, Pose& pose) noexcept;
// The same, so that the hips come to be over a place and face a heading.
void put_walk(const vec3& place_m, double heading_rad, WalkState& state, Pose& pose) noexcept;

// Where an engine has moved a character's capsule to, and how it goes on there. World. The engine
// fills it; with a number that is not finite the walk goes on as it does and counts it.
struct CapsuleMotion {
  vec3 place_m{0.0};             // of the hips on the ground; its height does not matter
  double heading_rad = 0.0;      // that it is to have when it stands, to the left positive
  vec3 velocity_m_s{0.0};        // of the capsule, as quick as the walk can be
  double turn_rate_rad_s = 0.0;  // of the capsule, to the left positive
};
// The parameters by which a walk follows it, in steps of its own: feet stay planted, so the walk is
// some centimetres off its capsule. It turns to where the capsule goes.
GaitParams following(const CapsuleMotion& capsule, const WalkState& state, const StyleValues& style,
                     const GaitLimits& limits) noexcept;

// Moves the walk on by one tick of `dt_s` seconds, a constant of the run, and writes the pose. The
// walk is the same at every rate; a tick longer than 1/60 s is computed in equal parts.
// Never fails: what the inverse kinematics could not reach is flagged in state.frame.ik_failed. A
// parameter that is not finite or that check() refuses counts as what is in force instead, and so
// does such a tick length; state.frame.bad_inputs counts them.
void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept;

// How much of the data's oscillations and postures shows: 0 at rest, 1 from half the data's pace
// on.
double presence(const WalkState& state) noexcept;

}  // namespace gaitpad
