// Functions and types that the files of the walk share. walk.cpp holds the tick that calls them.
#pragma once
#include <span>

#include "base/lanes.h"
#include "gaitpad/walk.h"
#include "motion/stride_lanes.h"

namespace gaitpad {

// Data that do not change within a tick.
struct Tick {
  const WalkModel& model;
  const GaitParams& params;
  IkMode mode;
  double dt_s;
  bool flat;              // there is no terrain, so the tick leaves out all of walk_terrain.cpp
  Placement placed = {};  // place of the walk in the world
};

// --- One walk, or several side by side -----------------------------------------------------------
// V is a double, or a register of as many (base/lanes.h).

template <class V>
constexpr bool kAlone = std::is_same_v<V, double>;

// The walks' progress in their steps: StepClock and the feet's modes as numbers and masks.
template <class V>
struct CountsOf {
  std::array<V, 2> mode_ticks;
  V tick, stage_ticks, roll_ticks, flight_ticks, last_step_ticks;
  V phase, phase_rate, stage_phase, stage_end, end_rate;
  // Phases at which the step begins and strikes, and the rate at its strike.
  V step_phase, strike_phase, strike_rate;
  V rest_ticks, closing_ticks, fade_ticks, led_from;
};
template <class V>
struct MomentOf : CountsOf<V> {
  using Mask = MaskOf<V>;
  Mask idle, flies, rolls, started, starting, stopping, closing, led, replanned, backward;
  Mask was_led;            // the hips led in the step before
  Mask right_steps;        // the right foot flies in this step (also during the roll before its
                           // flight)
  Mask walking, finishes;  // the parameters ask for a walk, for its end
  // Modes of the feet, by Side; without one a foot supports.
  std::array<Mask, 2> in_flight, in_roll;

  Mask strikes() const noexcept { return rolls & (this->tick == all_of<V>(1.0)); }
  Mask on_way() const noexcept { return not_of(idle) & started; }
  Mask steps(Side side) const noexcept {
    return side == kRightSide ? right_steps : not_of(right_steps);
  }
  // The share of the flight that is over; 0 outside of flights.
  V flight_progress() const noexcept { return flies ? this->tick / this->stage_ticks : V{}; }
  // The share of the running step's time that is over; 0 for a walk that has closed.
  V step_share() const noexcept { return share_at(V{}); }
  V step_share_ahead() const noexcept { return share_at(V{} + 1.0); }
  V share_at(const V& ahead) const noexcept {
    const V begun = this->tick + ahead + (flies ? this->roll_ticks : V{});
    const V ticks = this->roll_ticks + this->flight_ticks;
    return started ? begun / (ticks < 1.0 ? V{} + 1.0 : ticks) : V{};
  }
  V ticks_to_strike() const noexcept {
    const V left = this->stage_ticks - this->tick;
    return flies ? left : left + this->flight_ticks;
  }
};

template <class V>
struct FootLanes : FootFlow<V> {
  FootPoseOf<V> pose;
};
template <class V>
struct StateLanes {
  GaitFlow<V> gait;
  PathFlow<V> path;
  std::array<FootLanes<V>, 2> foot;
  LegFlow<V> legs;
};
// One walk is referred to in its state; several are copied.
template <class V>
using StateOf = std::conditional_t<kAlone<V>, WalkState, StateLanes<V>>;
template <class V>
using PoseOf = std::conditional_t<kAlone<V>, FootPose, FootPoseOf<V>>;

// The flying foot as on level ground between its two planes, the height of that ground, and the
// height of the plane that it left above the other.
template <class V>
struct FlightOf {
  PoseOf<V> pose;
  V base_m{}, lifted_m{};
};
using FlightPoint = FlightOf<double>;

// The parameters of each walk in this tick.
template <class V>
struct ParamsOf {
  std::array<V, 2> length_m, flight_height;
  std::array<std::array<V, kLegDofs>, 2> weight;
  V turn_rate_rad_s, hip_sway, hip_bounce;
  std::array<V, 2> arm_swing;  // factor on the arms' swing that is used
};

// A place on the ground that moves evenly with the phase.
template <class V>
struct LineOf {
  Vec<V> at_zero_m{}, per_phase_m{};
  Vec<V> at(const V& phase) const noexcept { return at_zero_m + per_phase_m * phase; }
};

// The tables' values at one moment of a step. A step leads from the stride of the last step to its
// own stride: the hips first follow the last stride's table from the footprint that they come from,
// then this one's towards the next footprint, and change over smoothly.
template <class V>
struct PlanOf {
  V phase{};                             // phase of the data, unwrapped, so that it does not jump
                                         // within this step
  V change{};                            // change from the last stride, 0, to this one, 1
  V shown{};                             // share of the tables that shows; 0 when standing
  V ratio_ahead{};                       // ratio of the stride with which the step is taken
  std::array<RatiosOf<V>, 2> ratios;     // ratios of the two strides
  std::array<FootprintsOf<V>, 2> track;  // footprints of the two strides
  // The hips' path in each of them, by phase; in the last stride only if hips lead or a step
  // begins.
  std::array<LineOf<V>, 2> hips_m;
  std::array<Vec<V>, 2> flying_m;  // place of the flying heel in each of them
  StrideCellOf<V> cell;            // both strides, mixed by `change` and `shown`
  StrideFootOf<V> flying;          // the foot that flies, or will fly
  V heel_up_m{};                   // height of its heel
  FootprintsOf<V> short_track;     // the stride in which it flies at a start or stop
  // Unit directions of the footprint that the flying foot left and of that on which it will land.
  Vec<V> lifted{}, lands{};
};

template <class V>
struct PelvisOf {
  Vec<V> position_m{};  // place in the world
  // Heading of the walk, about the vertical; segment rotation, world.
  Quat<V> heading{}, rotation{};
  Vec<V> hip(const LegBuild& leg) const noexcept {
    return position_m + rotation * all_of<V>(leg.model.hip_m);
  }
  // Converts a place from the pelvis' frame, counted from the hip joint, to the world.
  Vec<V> place(const LegBuild& leg, const Vec<V>& from_hip_m) const noexcept {
    return hip(leg) + rotation * from_hip_m;
  }
};

// The solution of one leg. Heel and toe in the world.
template <class V>
struct PosedLegOf {
  V iterations{}, squares{};  // number of iterations; squared error, square metres
  V failed{};                 // 1 if the solve did not converge, else 0
  Vec<V> heel_m{}, toe_m{};
  V pitch_rad{};  // pitch of the foot
};
using PosedLeg = PosedLegOf<double>;

using Moment = MomentOf<double>;
using StridePlan = PlanOf<double>;
using Pelvis = PelvisOf<double>;

// --- walk.cpp: clock, landing place, hips --------------------------------------------------------

inline constexpr double kEvenSpread = 1e-9;  // weights count as even if they differ by less
// The share of its change that a joint of relative weight `w` (0 locked .. 1 free) leaves to the
// other joints: 0.8 (1 - w^4), fitted to the hip's range after two iterations.
template <class V>
V held_back(const V& w) noexcept {
  return 0.8 * (1.0 - (w * w) * (w * w));
}

// The foot that flies in this step (also during the roll before its flight).
Side step_foot(const WalkState& state) noexcept;
Moment moment_of(const WalkModel& model, const WalkState& state) noexcept;
// The phase after `ticks` more ticks of the running stage.
double phase_ahead(const WalkModel& model, const WalkState& state, double ticks) noexcept;
// The phase at which the running stage ends.
double stage_end_phase(const WalkModel& model, const WalkState& state) noexcept;
// True if the parameters ask for the running walk to go on, or for a walk to begin. A walk in the
// other direction begins only after standing.
bool walks_on(const GaitParams& params, const WalkState& state) noexcept;
// Signed length of that foot's step on level ground: negative backwards, 0 when closing a walk.
double step_length(const WalkState& state, Side side) noexcept;

// The share of the cycle that a stage takes: the roll of `swing`, or its flight.
double stage_share(const WalkModel& model, Stage stage, Side swing) noexcept;

// --- walk_changes.cpp: how a walk comes to rest, and goes on -------------------------------------
inline constexpr double kCarry_s = 0.15;  // time in which the difference from the last plan fades
// Begins a plan that differs from the last tick's; the difference fades in `time_s`.
void replan(double time_s, const Tick& tick, WalkState& state) noexcept;
// Plans where and when the hips come to rest, if the stick was released or asks for the other
// direction.
void plan_rest(const Tick& tick, WalkState& state) noexcept;
// Plans the place where the hips rest, as soon as it is known which foot closes.
void plan_rest_place(const Tick& tick, WalkState& state) noexcept;
// Called when the stick is pushed again: turns a stop that has not gone far back into a walk.
void walk_on(const Tick& tick, WalkState& state) noexcept;
// Takes what step_to() and push_walk() have asked for.
void take_asked_step(const Tick& tick, WalkState& state) noexcept;
// Gives the running step the present duration of steps.
void time_step_again(const Tick& tick, WalkState& state) noexcept;
// Plans when the closing foot lifts off and lands, while it still stands.
void time_closing_step(const Tick& tick, WalkState& state) noexcept;
// Ticks until the hips are as far over the standing foot as they are at the lift-off of the other.
int ticks_to_lift_off(const WalkModel& model, const WalkState& state) noexcept;

// --- walk_terrain.cpp: footholds, and flights over what lies between them ------------------------
// Height of the plane at a place.
double height_on(const FootPlane& plane, const vec3& place_m) noexcept;
// True if a riser lies between two footholds.
bool crosses_riser(const Terrain& terrain, const FootPlane& a, const FootPlane& b) noexcept;
// The plane of a single standing foot nearest to `heel_m` without an edge under it.
FootPlane standing_plane(const WalkModel& model, Side side, const vec3& heel_m,
                         double yaw_rad) noexcept;
// Smooths the lean of the trunk on the slope or stair over which the running step leads.
void lean_into_slope(const Tick& tick, WalkState& state) noexcept;
// Chooses the landing place nearest to where the step would go on level ground: along `forward`,
// the heading at landing, and `across_m` from the standing heel.
void choose_foothold(const Tick& tick, WalkState& state, const vec3& forward,
                     const vec3& across_m) noexcept;
// Updates the share of the running step's length that the ground leaves, and the ratio that the
// tables are read for.
void follow_ground(const Tick& tick, WalkState& state) noexcept;
// Moves the height of the ground below the hips.
void advance_base(const Tick& tick, WalkState& state) noexcept;

// The height of the ground line under a flying heel at `place_m`, and how far the flight rises.
struct GroundLine {
  double base_m = 0.0, rise_legs = 0.0;
};
GroundLine ground_line_of(const WalkModel& model, const WalkState& state, Side side,
                          const vec3& place_m, double u) noexcept;
// Tilts a flying foot from the plane that it left to the one that it will land on. `gone` is the
// share of the flight that is over, smoothed.
void tilt_in_flight(const WalkState& state, Side side, double gone, FlightPoint& point) noexcept;
// Plans how the flying foot clears the ground between its two footholds.
void plan_room(const Tick& tick, WalkState& state, Side side) noexcept;
// Moves the foot by its FlightRoom, and up with the hips.
void clear_ground(const Tick& tick, WalkState& state, const StridePlan& plan, Side side, double u,
                  FlightPoint& point) noexcept;
// Lifts a standing foot on its toe if the hips have risen over its ground.
void rise_on_toe(const Tick& tick, WalkState& state, const StridePlan& plan, Side side) noexcept;

// --- walk_feet.cpp: the feet's modes -------------------------------------------------------------
// Turns a foot about its pivot: the toe in support, else the heel.
void pitch_foot(const LegBuild& leg, double pitch_rad, FootPose& pose, FootMode mode) noexcept;
// At the end of a tick: stores what the derivatives of the next ticks need.
void remember_feet(const WalkModel& model, WalkState& state) noexcept;
void begin_support(FootState& foot) noexcept;
void begin_flight(const Tick& tick, WalkState& state, Side side) noexcept;
// From now on the foot that lands stands on its heel.
void plant_foot(WalkState& state, Side side) noexcept;
void begin_roll(const Tick& tick, WalkState& state, Side side) noexcept;

// --- idle.cpp: breath, sway and glances of a person who stands -----------------------------------
void advance_idle(const Tick& tick, WalkState& state) noexcept;

// --- upper_body.cpp: what is above the hips ------------------------------------------------------
// Where a pose is written: the root's place, and the local rotations by joint.
struct PosePart {
  vec3 root_m{0.0};
  std::span<quat> local;
};
// Smooths the parameters of the upper body.
void smooth_upper_body(const Tick& tick, WalkState& state) noexcept;
// Poses spine, arms and head after the legs.
void pose_upper_body(const Tick& tick, WalkState& state, const PosePart& pose) noexcept;

// --- walk_legs.cpp: inverse kinematics -----------------------------------------------------------
// Steps 1-7 of the paper to the letter.
PosedLeg pose_paper(const Tick& tick, WalkState& state, const Pelvis& pelvis, Side side) noexcept;
// Solves a leg again whose ankle bends too far, and returns how its foot stands.
PosedLeg mended_leg(const Tick& tick, WalkState& state, const Pelvis& pelvis, Side side,
                    PosedLeg solved) noexcept;

// --- walk.cpp: the tick in parts -----------------------------------------------------------------
// One walk's tick, between its plan and its pose.
struct PlannedTick {
  const Tick* tick = nullptr;
  WalkState* state = nullptr;
  Moment at;
  StridePlan plan;
  Pelvis pelvis;
};
void plan_tick(const Tick& tick, WalkState& state, PlannedTick& planned) noexcept;
void pose_legs(const PlannedTick& planned) noexcept;
void finish_tick(const PlannedTick& planned, Pose& pose) noexcept;

// The parts of a tick before and after those that walks share: before, beginnings and the clock;
// after, the report and ends.
void begin_tick(const Tick& tick, WalkState& state, Moment& at) noexcept;
void end_tick(const Tick& tick, const vec3& pelvis_m, WalkState& state) noexcept;

// --- walk_lanes.h: walks side by side ------------------------------------------------------------
struct Walking {
  const GaitParams* params = nullptr;
  WalkState* state = nullptr;
  vec3* root_m = nullptr;
  quat* local = nullptr;  // local rotations by joint
  std::size_t joints = 0;
};
// One tick of walks that share a model and walk on flat ground, at most kWidth of them, in robust
// mode. kWidth: 2, 4 or 8.
template <int kWidth>
void advance_lanes(const WalkModel& model, double dt_s, std::span<const Walking> walks) noexcept;

}  // namespace gaitpad
