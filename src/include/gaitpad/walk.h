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
#include <optional>

#include "gaitpad/gait_params.h"
#include "gaitpad/skeleton.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

// The shortest and the longest tick.
inline constexpr double kLeastTick_s = 1e-4, kMostTick_s = 0.1;
// The greatest coordinate of a place in the world, positive or negative.
inline constexpr double kFarthest_m = 1e6;

// paper: the paper's steps 1-7, followed literally; no joint limits, and the solver may fail.
// robust: damped, within joint limits, continuous; for characters that people look at.
enum class IkMode : std::uint8_t { paper, robust };
enum class Stage : std::uint8_t {
  idle,    // both feet planted
  flight,  // Table I (a): one heel flies, the other foot's toe is planted
  roll,    // Table I (b): the landed heel and the other foot's toe are planted
};

// A frame in the world, turned by `heading_rad` about the vertical through its origin, which is at
// `place_m`.
struct Placement {
  vec3 place_m{0.0};         // place of the origin in the world; each coordinate at most
                             // kFarthest_m
  double heading_rad = 0.0;  // turn to the left, radians, at most kFarthest_m
  bool operator==(const Placement&) const = default;
};
// Convert a place from the frame to the world, and back.
vec3 to_world(const Placement& placed, const vec3& place_m) noexcept;
vec3 from_world(const Placement& placed, const vec3& world_m) noexcept;
// `placed` after the world has been turned and shifted by `by`.
Placement moved(const Placement& by, const Placement& placed) noexcept;

// The results of one tick, for export, tests and panels; advance() fills them. World frame, metres:
// y up, floor 0, heading 0 along +z, x to the left at heading 0. Arrays are indexed by Side.
struct WalkFrame {
  Stage stage = Stage::idle;
  Side swing = kLeftSide;    // flight: the flying foot; roll: the foot that has just landed
  double heading_rad = 0.0;  // heading, positive to the left; whole turns add up
  double turn_rate_rad_s = 0.0;
  double speed_m_s = 0.0;  // (left + right step) / cycle time of the running cycle; 0 when idle
  vec3 pelvis_m{0.0};
  // Root motion: the hips' place on the ground; what the tick has added to it, in axes of the
  // heading before the tick (x left, z ahead); and what it has added to the heading. For engines
  // that move their own capsule.
  vec3 root_m{0.0}, root_moved_m{0.0};
  double root_turned_rad = 0.0;
  std::array<double, 2>
      stride_m{};  // length of each foot's running or last step; negative backwards
  std::array<bool, 2> heel_planted{true, true}, toe_planted{true, true};
  std::array<vec3, 2> heel_m{}, toe_m{};
  std::array<int, 2> ik_iterations{};  // iterations of all solves of that leg in this tick
  std::array<double, 2> ik_error_m{};  // error of the last of these solves
  std::array<bool, 2> ik_failed{};     // the last solve did not converge
  std::array<int, 2> steps{};          // number of landings so far
  // Height of the ground under heel and toe, planted or not.
  std::array<double, 2> heel_ground_m{}, toe_ground_m{};
  int overhangs = 0;  // number of landings so far on a tread that is too short for the foot
  // Number of inputs so far that advance(), standing(), move_walk() or put_walk() refused.
  int bad_inputs = 0;
};

// support: the foot stands on its toe; flight: it is in the air; roll: it has landed on its heel,
// and the toe comes down.
enum class FootMode : std::uint8_t { support, flight, roll };

// --- What a walk remembers -----------------------------------------------------------------------
// A tick computes several walks side by side, one in each lane of the processor's registers
// (gaitpad/math.h). What all of them compute alike is a template of the number V: a double, or a
// register of as many as it holds. The structs of V hold numbers alone.

// The plane that a foot stands on or flies to: the best fit to the ground under its sole.
struct FootPlane {
  vec3 place_m{0.0};      // place of the heel, world
  vec3 normal = kUp;      // unit vector
  quat tilt = kIdentity;  // rotation from level ground to the plane
};

// The planned place and attitude of a foot, on level ground.
template <class V>
struct FootPoseOf {
  Vec<V> heel_m{}, toe_m{};  // places in the world
  Quat<V> yaw{};             // rotation about the vertical from the standing pose at heading 0
  V pitch_rad{};             // pitch of the heel-toe line: 0 flat on its ground, toe down positive
  Quat<V> edge{};            // twist and roll, as in StrideFoot
  Quat<V> rotation{};        // the foot's segment rotation that follows from these, world
  V toe_rad{};               // bend of the toe joint, toe end down positive
};
// The planned place and attitude of a foot, on any ground.
struct FootPose : FootPoseOf<double> {
  quat tilt = kIdentity;  // rotation from level ground to the foot's own plane
  FootPose() noexcept : FootPoseOf{.yaw = kIdentity, .edge = kIdentity, .rotation = kIdentity} {}
};

// The curve that keeps a flying foot off the ground between its two footholds: two uniform cubic
// B-splines over the flight, given by their inner control points.
inline constexpr int kFlightKnots = 8;
using FlightSpline = std::array<double, kFlightKnots - 1>;
struct FlightRoom {
  // Planned knots: a shift up, and one along z away from a riser.
  FlightSpline raise_m{}, shift_m{};
  std::array<Damped<double>, kFlightKnots - 1> raise, shift;  // the present knots, smoothed
  vec3 planned_for_m{0.0};                                    // landing for which it is planned
};

// A value that may not jump, with its first and second differences; its offset from the goal, and
// the number of ticks in which the offset fades.
template <class T, class V>
struct EasedOf {
  T value{}, rate{}, bend{};
  SmoothFade<T> off;
  V ticks{};
};

template <class V>
struct FootFlow {
  Vec<V> heel_anchor_m{}, toe_anchor_m{};  // places where heel and toe were planted last
  std::array<Vec<V>, 2> last_heel_m{};     // places one and two ticks ago
  std::array<V, 2> last_pitch_rad{};
  FadeOf<V> pitch_fade;  // fade of the pitch over the running mode; its argument is in ticks
  V fade_begin{};        // tick of the mode in which the fade begins
  Vec<V> lift_m{};       // place of the heel at lift-off
  // The difference between the heel's place at lift-off and the tables', and its slope per flight.
  Vec<V> gap_m{}, gap_slope_m{};
  V gap_begin{}, gap_lasts{};  // begin and duration of the gap's fade, in shares of the flight
  V gap_yaw_rad{};
  V gap_high_m{};  // the tables' height at lift-off: a foot that was lower stays off the ground
  V lift_yaw_rad{}, lift_turn_rad{};  // yaw at lift-off, and its slope over the flight
  EasedOf<Vec<V>, V> eased_heel;
  EasedOf<V, V> eased_pitch;
  EasedOf<Vec<V>, V> eased_edge;  // twist and roll, which may not jump
};
struct FootState : FootFlow<double> {
  FootPose pose;
  FootMode mode = FootMode::support;
  int mode_ticks = 0;  // ticks since the mode began
  // On flat ground the members below keep these values.
  FootPlane plane;                      // plane that the foot stands on or stood on last
  double base_m = 0.0;                  // height of the ground over which the pose is planned
  double rise_m = 0.0;                  // height by which the foot rises with the hips
  std::array<double, 2> last_rise_m{};  // the rise one and two ticks ago
  bool crosses_riser = false;           // the running flight crosses a riser
  FlightRoom room;
};

// A step as terrain changes it. On flat ground all members keep these values.
struct Foothold {
  vec3 wanted_m{0.0};      // place of the heel if the ground were level
  double yaw_rad = 0.0;    // heading of the foot
  Stretch piece;           // piece of ground for the landing, settled when the flight begins
  double share = 1.0;      // share of the wanted length that a slope leaves
  double next_rise = 0.0;  // rise of the step after this one, in legs; negative downwards
  bool fits = true;        // the sole does not overhang an edge
};

// The height of the ground that the hips go over. On flat ground all of it stays 0.
struct HipsGround {
  // Height with its rate and acceleration.
  double height_m = 0.0, per_tick_m = 0.0, per_tick2_m = 0.0;
  double level_m = 0.0;                 // height at which it settles over the standing foot
  SmoothFade<double> off_m;             // present distance from that height
  int settle_ticks = 0;                 // ticks after the strike until it has settled
  double drop_m = 0.0;                  // depth by which it then sinks until the next landing
  double early_m = 0.0, yield_m = 0.0;  // depth below that landing, at it and after it
};

// The state of the upper body.
struct UpperBodyState {
  UpperBodyParams goal, now;  // the parameters asked for, and the smoothed ones that are used
  std::array<double, sizeof(UpperBodyParams) / sizeof(double)>
      per_s{};              // rates of `now`, per second
  int unsettled_ticks = 0;  // ticks until `now` is `goal`
  // Turns of chest and head, rotation vectors in the walker's axes.
  EasedOf<vec3, double> eased_chest, eased_head;
  // The lean of the trunk in this tick, and the spread of the upper arms; not in paper mode.
  double forward_rad = 0.0, left_rad = 0.0;
  // Signs of a change that show before the feet can follow: the mean speed, the lean into another
  // one, and the angles by which chest and head are turned ahead, to the left positive.
  Damped<double> speed_m_s, push_rad, chest_ahead_rad, head_ahead_rad;
  std::array<double, 2> out_rad{};
  // Height of the ground under a rail, smoothed, and its rate.
  std::array<double, 2> rail_ground_m{}, rail_ground_m_s{};
};

// The state of a character that stands: for how long, the share of its movements that shows, the
// rise of the trunk with the breath, and the turn of the head in a glance, to the left and down
// positive. The hips' sway is in PathFlow.
struct IdleState {
  int ticks = 0;
  double share = 0.0;  // share of the movements that shows, 0 none .. 1 all
  double breath_rad = 0.0, glance_rad = 0.0, nod_rad = 0.0;
};

// The walk's progress in its step, in ticks. A step is a roll and the flight after it; phases count
// from the right foot's strike.
struct StepClock {
  Stage stage = Stage::idle;
  Side swing = kLeftSide;
  int tick = 0, stage_ticks = 1;  // ticks since the stage began, and ticks of the stage
  int roll_ticks = 0, flight_ticks = 0;
  int last_step_ticks = 0;                // ticks of the step before
  bool started = false;                   // the walk is between its first lean and its last landing
  bool starting = false;                  // the running step is the first one
  bool stopping = false;                  // the hips are moving to their place of rest
  bool closing = false;                   // the running step brings the feet together
  bool led = false;                       // the hips lead: the tables' phase follows their place
  bool was_led = false;                   // the hips led in the step before
  bool replanned = false;                 // a new plan was made in this tick
  int further_steps = 0;                  // steps of a stop before the closing one
  int rest_ticks = 0, closing_ticks = 1;  // ticks until the hips rest: now, and when closing began
  int fade_ticks = 0;                     // ticks in which the offset from the last plan fades
  int led_from = 0;                       // tick of the stage in which the hips began to lead
  double strike_rate = 0.0;               // phase_rate planned for the coming strike
  int asked_ticks = 0;                    // ticks for which a stand has been asked to walk
  bool backward = false;                  // the running walk's steps lead backwards
  double slowness = 1.0;                  // factor on the running step's times on steep ground
  double phase = 0.0, phase_rate = 0.0;   // phase, and its change per tick
  double stage_phase = 0.0;               // phase at which the running stage began
  double end_rate = 0.0;                  // phase_rate at the end of the stage
  // Planned durations of the running roll and step, not rounded to ticks; the number of ticks that
  // the step was given; and the total time by which the steps so far were too short.
  double roll_s = 0.0, step_s = 0.0;
  int step_ticks = 0;
  double late_s = 0.0;
  double tick_s = 1.0 / 240.0;  // length of the last tick
};

// The gait: the smoothed parameters, and the stride ratios that follow from them.
template <class V>
struct GaitFlow {
  std::array<Damped<V>, 2> length_m, flight_height;
  std::array<V, 2> time_s{};
  V asked_ratio{};        // ratio of the strides that the parameters ask for
  Damped<V> step_time_s;  // step time, the mean of both feet
  Damped<V> turn_goal,    // goal of turn_rate, by which landings are planned
      turn_rate, bounce, sway;
  Damped<V> pace, posture;  // step length over the data's; share of the data's posture
  Damped<V> ground_share;   // share of the wanted lengths that the ground leaves
  std::array<std::array<Damped<V>, kLegDofs>, 2> weight;
  V ratio_behind{};         // stride ratio at the last strike
  V step_ratio{};           // ratio of the running step
  SmoothFade<V> off_ratio;  // distance of the tables' ratio from it
  // The differences from the last plan that a changed plan left: in the share of the tables, in the
  // change from the stride behind to the one ahead, and in phase. They fade in off_ticks.
  SmoothFade<V> off_shown, off_change, off_phase;
  V off_ticks{};
  V shown{}, change{}, phase{};                 // present values
  V shown_rate{}, change_rate{}, phase_rate{};  // their changes per tick
  std::array<V, 2> arm_swing{};                 // factor on the data's swing in this tick, by Side
  SmoothFade<V> off_ahead;  // offset of the ratio that the last plan had for the running step
};
using GaitState = GaitFlow<double>;

// The path: landing places, and the hips on their way to them.
template <class V>
struct PathFlow {
  V heading_rad{};
  Vec<V> hips_m{};  // place of the hips on the ground, without the data's oscillations
  // The pelvis' place on the ground, upright, with its rate and acceleration per tick; and the
  // place one tick before.
  SmoothFade<Vec<V>> pelvis_m;
  Vec<V> last_pelvis_m{};
  Vec<V> rest_m{};  // place where the hips come to rest in a stop
  // The share of the walk that is not steady, 0 .. 1. While it is above 0, planned values may not
  // jump.
  V unsteady{};
  EasedOf<V, V> eased_height;  // height of the pelvis
  Damped<V> sunk_m;            // depth of the pelvis below its height in the tables
  // How much wider, in a turn, the standing footprint and the next one are.
  V wider_m{}, next_wider_m{};
  // The hips' offset from the tables' path to the landing; it fades in the step.
  SmoothFade<Vec<V>> off_m;
  // The landing, heading and ratio of that path one tick ago.
  Vec<V> last_landing_m{};
  V last_heading_rad{}, last_ratio{};
  Vec<V> landing_m{};
  V landing_heading_rad{};
  std::array<V, 2> stride_m{};  // length of each foot's step, as in WalkFrame
  Damped<V> lean_rad;           // lean of the whole body into a turn, to the left positive
  Vec<V> sway_m{};              // sway of a standing character's hips, on the ground
};
// What a program has asked of the running step by step_to() and push_walk(), in the walk's own
// coordinates. standing() and each landing clear it.
struct AskedStep {
  bool waits = false, is_taken = false;  // for the next tick; the step leads there
  vec3 heel_m{0.0};                      // landing place of the heel
  double heading_rad = 0.0;              // heading of the foot there
  vec3 push_m_s{0.0};                    // velocity that waits to be added to the hips
};

struct PathState : PathFlow<double> {
  FootPlane landing_plane;
  Foothold foothold;
  AskedStep asked;
  HipsGround base;
  Damped<double> slope_lean_rad;  // lean of the trunk into a slope or stair, forwards positive
};

// Angles of the legs: in the pose; with even weights, and their running means; in the tables. Also,
// from the tick before: the offset of the even angles from the tables, and the change by the
// weights.
template <class V>
struct LegFlow {
  using Angles = std::array<std::array<V, kLegDofs>, 2>;
  Angles angles_rad{}, even_rad{}, mean_rad{}, lagging_rad{};
  Angles data_rad{}, last_off_rad{}, last_shift_rad{};
  // Share by which uneven weights may turn the foot: 0 none .. 1 all.
  std::array<Damped<V>, 2> loose;
  // The share to which the heel is kept low although it would rise, and the pitch that its leg asks
  // for.
  std::array<Damped<V>, 2> low;
  std::array<V, 2> asked_rad{};
};
using LegState = LegFlow<double>;

// The whole state of a walk; standing() and advance() fill it. Plain, trivially copyable.
struct WalkState {
  WalkFrame frame;
  // A walk is computed in its own coordinates, which its terrain's sections share. `placed` is the
  // place of these coordinates in the world; poses and `frame` are in the world. Writing `placed`
  // between two ticks moves the walk and its ground rigidly, and every other bit stays. For a walk
  // on a platform set it to the platform's place in each tick; for a shifted origin and a teleport
  // see move_walk() and put_walk().
  Placement placed;
  StepClock clock;
  GaitState gait;
  PathState path;
  std::array<FootState, 2> foot;
  LegState legs;
  UpperBodyState body;
  IdleState idle;
};

// Makes a character stand at `place_m`, facing +z, on its terrain; the height of `place_m` is
// ignored. Sets `pose`. A coordinate or heading that is not finite or beyond kFarthest_m counts as
// 0 (WalkFrame::bad_inputs).
WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept;

// Makes a character stand there, facing `heading_rad`.
WalkState standing(const WalkModel& model, const vec3& place_m, double heading_rad,
                   Pose& pose) noexcept;

// Turns the walk about the world's vertical through the origin and shifts it, even in the middle of
// a step. Planted feet stay where they are in the moved frame. If a number is not finite or beyond
// kFarthest_m, nothing moves and it is counted (WalkFrame::bad_inputs).
void move_walk(const Placement& by, WalkState& state, Pose& pose) noexcept;
// Moves the walk so that its hips are over a place and face a heading.
void put_walk(const vec3& place_m, double heading_rad, WalkState& state, Pose& pose) noexcept;

// The place, heading and velocity that an engine has given a character's capsule, in the world. The
// engine fills it; if a number is not finite, the walk goes on as before and counts it.
struct CapsuleMotion {
  vec3 place_m{0.0};  // place of the hips on the ground; its height is ignored
  // Heading that the character shall have when it stands, to the left positive.
  double heading_rad = 0.0;
  vec3 velocity_m_s{0.0};        // velocity of the capsule; not faster than the walk can be
  double turn_rate_rad_s = 0.0;  // turn rate of the capsule, to the left positive
};
// The parameters by which a walk follows its capsule in its own steps: feet stay planted, so the
// walk is some centimetres off the capsule. It turns to where the capsule goes.
GaitParams following(const CapsuleMotion& capsule, const WalkState& state, const StyleValues& style,
                     const GaitLimits& limits) noexcept;

// --- What a program asks of the running step beside its stick ------------------------------------

// The landing place and heading nearest to `heel` that the heel of the running step's foot can
// still reach, in the world; its height is ignored. Nothing if no step can be changed: the
// character stands or comes to rest, or the foot has flown more than half of its flight or, over
// uneven ground, flies at all.
std::optional<Placement> nearest_step(const WalkModel& model, const Placement& heel,
                                      const WalkState& state) noexcept;
// Asks the foot that flies, or that flies next, to land with its heel at that place, and to point
// to that heading: a stepping stone. The hips and the tables follow, and the next step is the
// stick's again. Returns false and changes nothing if nearest_step() is not that place within 1 mm
// and 0.1 degrees. On a terrain of sections the foot keeps off edges as always.
bool step_to(const WalkModel& model, const Placement& heel, WalkState& state) noexcept;
// Pushes the hips: adds this velocity to theirs, and moves the landing of the running step to where
// that foot catches the fall, as far as it can reach. If the step cannot be changed any more, the
// next one answers. Returns false and changes nothing if the character stands or comes to rest, or
// if a number is not finite or beyond kMostPush_m_s.
inline constexpr double kMostPush_m_s = 3.0;
bool push_walk(const vec3& velocity_m_s, WalkState& state) noexcept;

// Advances the walk by one tick of `dt_s` seconds, a constant of the run, and writes the pose. The
// walk is the same at every rate; a tick longer than 1/60 s is computed in equal parts. Never
// fails: a goal that the inverse kinematics could not reach is flagged in state.frame.ik_failed. A
// parameter or tick length that is not finite or that check() refuses is replaced by the present
// one; state.frame.bad_inputs counts them.
void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept;

// The share of the data's oscillations and postures that shows: 0 at rest, 1 from half the data's
// pace on.
double presence(const WalkState& state) noexcept;

}  // namespace gaitpad
