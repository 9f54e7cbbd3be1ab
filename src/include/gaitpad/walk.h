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
#include "gaitpad/placement.h"
#include "gaitpad/skeleton.h"
#include "gaitpad/walk_model.h"
#include "gaitpad/walk_state.h"

namespace gaitpad {

// The shortest and the longest tick.
inline constexpr double kLeastTick_s = 1e-4, kMostTick_s = 0.1;

// paper: the paper's steps 1-7, followed literally; no joint limits, and the solver may fail.
// robust: damped, within joint limits, continuous; for characters that people look at.
enum class IkMode : std::uint8_t { paper, robust };
// How much of a walk is computed.
// full: all of it.
// tables: for a walk that is far away. It goes the same way in the same steps, but legs and upper
// body are the data's at that phase: feet slide and dip by some centimetres, styles of legs, arms,
// trunk and head do not show, and ik_error_m tells nothing. A change of the detail takes 0.25 s;
// then the walk is as if it had always been in full.
enum class Detail : std::uint8_t { full, tables };
enum class Stage : std::uint8_t {
  idle,    // both feet planted
  flight,  // Table I (a): one heel flies, the other foot's toe is planted
  roll,    // Table I (b): the landed heel and the other foot's toe are planted
};

// Where a walk is in its steps; walk_steps() tells it. Arrays are indexed by Side.
struct WalkSteps {
  Stage stage = Stage::idle;
  Side swing = kLeftSide;  // flight: the flying foot; roll: the foot that has just landed
  std::array<bool, 2> heel_planted{true, true}, toe_planted{true, true};
  std::array<int, 2> steps{};  // number of landings so far
};

// The results of one tick, for export, tests and panels; walk_frame() computes them. World frame,
// metres: y up, floor 0, heading 0 along +z, x to the left at heading 0.
struct WalkFrame : WalkSteps {
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
  std::array<vec3, 2> heel_m{}, toe_m{};
  std::array<int, 2> ik_iterations{};  // iterations of all solves of that leg in this tick
  std::array<double, 2> ik_error_m{};  // error of the last of these solves
  std::array<bool, 2> ik_failed{};     // the last solve did not converge
  // Height of the ground under heel and toe, planted or not.
  std::array<double, 2> heel_ground_m{}, toe_ground_m{};
  int overhangs = 0;  // number of landings so far on a tread that is too short for the foot
};

// The whole state of a walk; standing() and advance() fill it. Plain, trivially copyable.
struct WalkState {
  // A walk is computed in its own coordinates, which its terrain's sections share. `placed` is the
  // place of these coordinates in the world; poses and frames are in the world. Writing `placed`
  // between two ticks moves the walk and its ground rigidly, and every other bit stays. For a walk
  // on a platform set it to the platform's place in each tick; for a shifted origin and a teleport
  // see move_walk() and put_walk().
  Placement placed;
  // In the walk's own coordinates: the hips' place on the ground, without the data's oscillations,
  // and the heading; whole turns add up. `root_before`: before the last tick.
  Placement root, root_before;
  // The caller writes it between two ticks; another number counts as a bad input and as the detail
  // in force.
  Detail detail = Detail::full;
  double tick_s = 1.0 / 240.0;  // length of the last tick
  // Number of inputs so far that advance(), standing(), move_walk() or put_walk() refused.
  int bad_inputs = 0;
  Block<1> walk;  // what the next tick begins from
};

// Makes a character stand at `place_m`, facing +z, on its terrain; the height of `place_m` is
// ignored. Sets `pose`. A coordinate or heading that is not finite or beyond kFarthest_m counts as
// 0 (WalkState::bad_inputs).
WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept;

// Makes a character stand there, facing `heading_rad`.
WalkState standing(const WalkModel& model, const vec3& place_m, double heading_rad,
                   Pose& pose) noexcept;

// Turns the walk about the world's vertical through the origin and shifts it, even in the middle of
// a step. Planted feet stay where they are in the moved frame. If a number is not finite or beyond
// kFarthest_m, nothing moves and it is counted (WalkState::bad_inputs).
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
// still reach, in the world; its height is ignored. Nothing if a number of `heel` is not finite, or
// if no step can be changed: the character stands or comes to rest, or the foot has flown more than
// half of its flight or, over uneven ground, flies at all.
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
// fails: a goal that the inverse kinematics could not reach is flagged in WalkFrame::ik_failed. A
// parameter or tick length that is not finite or that check() refuses is replaced by the present
// one; state.bad_inputs counts them.
void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept;

// What a walk did in the last tick. `pose`: that of this tick.
WalkFrame walk_frame(const WalkModel& model, const WalkState& state, const Pose& pose) noexcept;
// The part of it that the state alone tells.
WalkSteps walk_steps(const WalkState& state) noexcept;

// The share of the data's oscillations and postures that shows: 0 at rest, 1 from half the data's
// pace on.
double presence(const WalkState& state) noexcept;
// The data's phase that a walk shows, in cycles from the right foot's strike.
double shown_phase(const WalkState& state) noexcept;
// The legs' angles in a pose of the model, by Side.
std::array<LegAngles, 2> leg_angles(const WalkModel& model, const Pose& pose) noexcept;

}  // namespace gaitpad
