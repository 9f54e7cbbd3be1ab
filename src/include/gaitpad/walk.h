// The upper body of a walk: the data's, but for arms that swing as far as the pace asks, hands and
// head that are to be somewhere, and joints that follow by their weights (equation 5). Nothing in
// here moves pelvis or legs. Internal to the walk.
#pragma once
#include <array>
#include <cstdint>

#include "gaitpad/gait_params.h"
#include "gaitpad/skeleton.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

struct Tick;
struct WalkModel;
struct WalkState;
enum class IkMode : unsigned char;

// Plain, trivially copyable.
struct UpperBodyState {
  BodyParams goal, now;                   // asked for; smoothed
  std::array<double, sizeof(BodyParams) / sizeof(double)> per_s{};  // rates of `now`
  int unsettled_ticks = 0;                // until `now` is `goal`
  std::array<double, 2> swing{1.0, 1.0};  // factor on the data's arm swing in this tick
  std::array<double, 2> rail_ground_m{};  // smoothed ground under a rail
  std::array<double, 2> rail_ground_m_s{};
};

// The animation module: a character that walks where the gait parameters say.
// Meredith & Maddock 2005, section 3.3: the two-stage cycle of Table I, feet along the flight paths
// of the data, legs posed by weighted half-Jacobian IK, the rest of the body from the data by a
// time-warp.

enum class IkMode : std::uint8_t { paper, robust };
enum class Stage : std::uint8_t {
  idle,    // both feet planted
  flight,  // Table I (a): one heel flies, the other foot's toe is planted
  roll,    // Table I (b): the landed heel and the other foot's toe are planted
};

// What one tick did, for export, tests and panels. World frame: y up, floor 0, heading 0 along +z.
struct WalkFrame {
  Stage stage = Stage::idle;
  Side swing = kLeftSide;    // flight: the flying foot; roll: the foot that has just landed
  double heading_rad = 0.0;  // not wrapped, positive to the left
  double turn_rate_rad_s = 0.0;
  double speed_m_s = 0.0;  // (left + right step) / cycle time of the running cycle; 0 when idle
  vec3 pelvis_m{0.0};
  std::array<double, 2> stride_m{};  // length in force for that foot's step; backwards negative
  std::array<bool, 2> heel_planted{true, true}, toe_planted{true, true};
  std::array<vec3, 2> heel_m{}, toe_m{};
  std::array<int, 2> ik_iterations{};
  std::array<double, 2> ik_error_m{};
  std::array<bool, 2> ik_failed{};
  std::array<int, 2> steps{};  // landings so far
  // Height of the ground under the points, planted or not.
  std::array<double, 2> heel_ground_m{}, toe_ground_m{};
  int overhangs = 0;  // landings so far on a tread too short for the foot
};

enum class FootMode : std::uint8_t { support, flight, roll };

// The plane that a foot stands on or flies to: the ground under its sole.
struct FootPlane {
  vec3 place_m{0.0};      // of the heel
  vec3 normal = kUp;      // unit
  quat tilt = kIdentity;  // from level ground
};

// Where a foot is to be: one of its points on a place, its direction and its pitch.
struct FootPose {
  vec3 heel_m{0.0}, toe_m{0.0};  // world
  quat tilt = kIdentity;         // from level ground to the foot's own
  double yaw_rad = 0.0;          // about the vertical, 0: as in the standing pose at heading 0
  double pitch_rad = 0.0;        // of the heel-toe line, toe down positive, 0: flat on its ground
  double toe_rad = 0.0;          // toe joint
};

// What keeps a flying foot off the ground that lies between its two planes: the inner control
// points of two uniform cubic B-splines over the flight.
inline constexpr int kFlightKnots = 8;
using FlightSpline = std::array<double, kFlightKnots - 1>;
struct FlightRoom {
  FlightSpline raise_m{}, shift_m{};  // wanted: up; along z, away from a riser
  std::array<Damped<double>, kFlightKnots - 1> raise, shift;  // in force
  vec3 planned_for_m{0.0};                                    // landing
};

struct FootState {
  FootMode mode = FootMode::support;
  FootPose pose;
  vec3 heel_anchor_m{0.0}, toe_anchor_m{0.0};  // where they were planted last
  std::array<vec3, 2> last_heel_m{};           // one and two ticks ago
  std::array<double, 2> last_pitch_rad{};
  Fade pitch_fade;                                 // over the running mode, argument in ticks
  int mode_ticks = 0;                              // since the mode began
  double planned_rad = 0.0;                        // pitch in support, as the data have it
  std::array<double, 2> reach_rad{};               // pitch beyond the plan, one and two ticks ago
  vec3 lift_m{0.0}, lift_slope_m{0.0};             // heel at lift-off and its slope per flight
  double lift_yaw_rad = 0.0, lift_turn_rad = 0.0;  // and its slope per flight
  LegAngles anchor_rad{};      // even pose when the mode began: what stiff joints hold on to
  FootPlane plane;             // stood on last
  double base_m = 0.0;         // height of the ground that the pose is planned over
  bool crosses_riser = false;  // the running flight
  FlightRoom room;
};

// What terrain makes of a step; on flat ground all of it stays as it is here.
struct Foothold {
  vec3 wanted_m{0.0};        // heel's place as stick and heading have it
  double yaw_rad = 0.0;      // of the foot
  Stretch piece;             // the landing's, settled when the flight begins
  double share = 1.0;        // of the wanted length that a slope leaves
  double next_m = 0.0;       // length of the step after it
  double next_base_m = 0.0;  // and the height of that one's landing
  double next_rise = 0.0;    // up or down to it, over the leg length
  bool fits = true;
};

// Plain, trivially copyable: all that a walk remembers.
struct WalkState {
  WalkFrame frame;
  // Clock. A step is a roll and the flight after it; phases count from the right foot's strike.
  Stage stage = Stage::idle;
  Side swing = kLeftSide;
  int tick = 0, stage_ticks = 1;  // in the stage
  int roll_ticks = 0, flight_ticks = 0;
  int last_step_ticks = 0;  // of the step before
  bool closing = false;     // the running step brings the feet together
  bool started = false;
  bool backward = false;  // the running walk's steps lead backwards
  double slowness = 1.0;  // of the running step: times are as much longer on steep ground
  double phase = 0.0, phase_rate = 0.0;  // per tick
  double stage_phase = 0.0;              // where the running stage began
  // Smoothed parameters.
  std::array<Damped<double>, 2> length_m, flight_height;
  std::array<double, 2> time_s{};
  Damped<double> step_time_s;  // mean of both feet
  Damped<double> turn_goal,    // what turn_rate follows: a landing is planned with it
      turn_rate, amplitude, bounce, sway, pace;  // pace: step length over the data's
  std::array<std::array<Damped<double>, kLegDofs>, 2> weight;
  // Path.
  double heading_rad = 0.0;
  vec3 hips_m{0.0}, hips_velocity_m_s{0.0};  // on the ground, without the data's oscillations
  vec3 landing_m{0.0};
  double landing_heading_rad = 0.0;
  FootPlane landing_plane;
  Foothold landing;
  double base_m = 0.0, base_velocity_m_s = 0.0;  // height of the ground that the hips go over
  Damped<double> ground_share{1.0, 0.0};         // of the wanted lengths that the ground leaves
  std::array<FootState, 2> foot;
  std::array<LegAngles, 2> data_rad{}, even_rad{}, angles_rad{};  // data's, IK even, IK weighted
  UpperBodyState body;
};

// A character standing at `place_m` on the floor, facing +z, and its pose.
WalkState standing(const WalkModel& model, const vec3& place_m, Pose& pose) noexcept;

// One tick of dt_s seconds (a constant of the run). Total: never fails; what the IK could not reach
// is flagged in state.frame.
void advance(const WalkModel& model, const GaitParams& params, IkMode mode, double dt_s,
             WalkState& state, Pose& pose) noexcept;

// How much of the data's oscillations and postures shows: none at rest, all from half its pace on.
double presence(const WalkState& state) noexcept;

}  // namespace gaitpad
