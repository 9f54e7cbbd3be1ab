// What the files of the walk call of each other. walk.cpp holds the tick that calls all of it.
#pragma once
#include <span>

#include "gaitpad/walk.h"

namespace gaitpad {

// --- walk.cpp: clock, landing place, hips --------------------------------------------------------
// What does not change within a tick.
struct Tick {
  const WalkModel& model;
  const GaitParams& params;
  double dt_s;
  bool flat;  // no terrain: all that walk_terrain.cpp does is left out
};

inline constexpr double kEvenSpread = 1e-9;  // weights closer to each other than this are even
// The share of its change that a joint of relative weight `w` (0 locked .. 1 free) leaves to the
// other joints. Its fourth power stands for the few iterations of a solve, each of which multiplies
// by W.
inline double held_back(double w) noexcept { return 0.8 * (1.0 - (w * w) * (w * w)); }

// Progress of the running flight, 0 .. 1; 0 outside of flights.
double flight_progress(const WalkState& state) noexcept;
// The foot that flies in this step (also during the roll before its flight).
Side step_foot(const WalkState& state) noexcept;
// The phase counted from that foot's own strike.
double own_phase(const WalkModel& model, const WalkState& state, Side side) noexcept;
// The phase at which the data are read. Walking backwards is walking forwards run back
// (Thorstensson 1986), so a foot lands where the data lift it.
double data_phase(const WalkModel& model, const WalkState& state) noexcept;
// The phase so many ticks ahead in the running stage.
double phase_ahead(const WalkModel& model, const WalkState& state, double ticks) noexcept;
// The phase at which the running stage ends.
double stage_end_phase(const WalkModel& model, const WalkState& state) noexcept;
// True if the parameters ask for the running walk to go on, or for one to begin. A walk in the
// other direction begins only after standing.
bool walks_on(const GaitParams& params, const WalkState& state) noexcept;

// What the tables say of one moment of a step. A step leads from the stride that the last step was
// taken with to the one that it is taken with itself: the hips follow the first one's table from
// the footprint that they come from, the second one's towards the next, and change over smoothly.
struct StridePlan {
  double phase = 0.0;             // of the data, unwrapped: within this step it does not jump
  double change = 0.0;            // from the one stride, at 0, to the other, at 1
  double shown = 0.0;             // how much of the tables shows: 0 when standing
  std::array<StridePlace, 2> at;  // the two strides at this phase
  StrideCell cell;                // both, mixed by `change` and `shown`, and what a style changes
  std::array<vec3, 2> heel_m{};   // of that: what flying heels change by, in the travel frame
  StrideChange injury;            // and what one stiff leg alone changes
};
// The running step's length over the data's.
double ratio_ahead(const WalkModel& model, const WalkState& state) noexcept;
// At a phase of the walk and a share of the running step's time.
void plan_stride(const WalkModel& model, const WalkState& state, double phase, double step_share,
                 StridePlan& plan) noexcept;
// Now.
void plan_stride(const WalkModel& model, const WalkState& state, StridePlan& plan) noexcept;
// Where a point of the travel frame of a stride is, seen from the footprint of `side` in the
// running step: of the flying foot the one that it left (which 0) or will land on (1).
vec3 from_footprint(const WalkState& state, const StrideTrack& track, double phase, Side side,
                    int which, const vec3& travel_m) noexcept;

// Signed length of that foot's step on level ground: negative backwards, 0 when closing a walk.
double step_length(const WalkState& state, Side side) noexcept;
struct Pelvis {
  vec3 position_m{0.0};                      // world
  quat heading = quat(1.0, 0.0, 0.0, 0.0);   // of the walk: about the vertical
  quat rotation = quat(1.0, 0.0, 0.0, 0.0);  // segment rotation, world
  vec3 hip(const LegBuild& leg) const noexcept { return position_m + rotation * leg.model.hip_m; }
};
// The pelvis of this tick, still without the height that the legs ask for.
Pelvis pelvis_over_ground(const WalkModel& model, const WalkState& state,
                          const StridePlan& plan) noexcept;

// --- walk_style.cpp: what a style asks of the stride
// ---------------------------------------------- From the smoothed parameters. In paper mode
// weights act on the inverse kinematics alone.
void grant_wishes(IkMode mode, WalkState& state) noexcept;
// Changes the tables' cell by what is granted in a stride of this ratio.
void change_stride(const WalkModel& model, const WalkState& state, double ratio,
                   StridePlan& plan) noexcept;

// --- walk_terrain.cpp: footholds, and flights over what lies between them ------------------------
// Height of the plane at a place.
double height_on(const FootPlane& plane, const vec3& place_m) noexcept;
// True if a riser lies between two footholds.
bool crosses_riser(const Terrain& terrain, const FootPlane& a, const FootPlane& b) noexcept;
// Where a single foot stands nearest to `heel_m` without an edge under it.
FootPlane standing_plane(const WalkModel& model, Side side, const vec3& heel_m,
                         double yaw_rad) noexcept;
// Chooses the landing place nearest to where the step would go on level ground: along `forward`,
// the heading at landing, and `across_m` from the standing heel.
void choose_foothold(const Tick& tick, WalkState& state, const vec3& forward,
                     const vec3& across_m) noexcept;

// Moves the height of the ground that the hips go over.
void advance_base(const Tick& tick, WalkState& state) noexcept;
// How far a foot over ground of height `base_m` rises because the hips are over higher ground.
double rise_with_hips(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                      Side side, double base_m) noexcept;

// Plans how the flying foot clears the ground between its two footholds.
void plan_room(const Tick& tick, WalkState& state, Side side) noexcept;
// The flying foot as on level ground between its two planes, the height of that ground, and how
// much higher the plane that it left is.
struct FlightPoint {
  FootPose pose;
  double base_m = 0.0, lifted_m = 0.0;
};
// Moves it by what its room asks for.
void keep_room(const Tick& tick, WalkState& state, Side side, double u,
               FlightPoint& point) noexcept;

// --- walk_feet.cpp: where the feet are to be -----------------------------------------------------
// How far a standing foot may leave the floor with its heel: 0 flat .. 1 freely.
double heel_rise(const WalkModel& model, const WalkState& state, Side side) noexcept;
quat foot_rotation(const LegBuild& leg, const FootPose& pose) noexcept;  // segment rotation, world
// The toes' rotation from their foot: bent by `toe_rad`, and level across however the foot rolls.
quat toes_turn(const LegBuild& leg, const FootPose& pose, double toe_rad) noexcept;
// The foot's pose of this tick, before the reach and the weights act on it.
void plan_foot(const Tick& tick, WalkState& state, const StridePlan& plan, Side side) noexcept;
// Where the foot flies, still without its pitch.
FlightPoint flight_point(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                         Side side, double u) noexcept;
// Its pitch: the tables', as far as the toe stays off that ground.
void pitch_in_flight(const WalkModel& model, const WalkState& state, const StridePlan& plan,
                     Side side, double u, FlightPoint& point) noexcept;
// Height of the heel over the plane that the foot is planned on.
double heel_height(const FootState& foot) noexcept;
// Lets a standing foot rise on its toe where its leg would be too short.
void reach_with_toe(const WalkModel& model, WalkState& state, Side side,
                    const vec3& hip_m) noexcept;
// Turns a foot about its pivot: the toe in support, else the heel.
void set_pitch(const LegBuild& leg, double pitch_rad, FootPose& pose, FootMode mode) noexcept;
// The greatest pitch at which the toe of a heel at this height is `clearance_m` above its rest.
double highest_pitch(const LegBuild& leg, double heel_m, double clearance_m) noexcept;
// At the end of a tick: keeps what the next ticks' derivatives need.
void remember_foot(FootState& foot) noexcept;
void begin_support(FootState& foot) noexcept;
void begin_flight(const Tick& tick, WalkState& state, Side side) noexcept;
void begin_roll(const Tick& tick, WalkState& state, Side side) noexcept;

// --- upper_body.cpp: what is above the hips ------------------------------------------------------
// Smooths the parameters of the upper body. In paper mode the pace does not act on the arms: the
// data's upper body is left as it is.
void smooth_upper_body(const Tick& tick, IkMode mode, WalkState& state) noexcept;
// On the data's local rotations of this phase, before they fade to a stand.
void swing_arms(const WalkModel& model, const WalkState& state, Pose& pose) noexcept;
// Spine, arms and head of a pose whose legs are done.
void pose_upper_body(const WalkModel& model, const WalkState& state, Pose& pose) noexcept;

// --- walk_legs.cpp: inverse kinematics -----------------------------------------------------------
// One character's tick between its plan and its pose.
struct PlannedTick {
  const Tick* tick = nullptr;
  WalkState* state = nullptr;
  StridePlan plan;
  Pelvis pelvis;
};
// Solves both legs of each of them, as many legs side by side as lanes are in use: their angles go
// to the states, what the solver took to state.frame.
void pose_legs(std::span<const PlannedTick> planned, IkMode mode) noexcept;

// --- walk.cpp: the tick in parts, for crowds
// ------------------------------------------------------- Everything before the legs, and
// everything after them.
void plan_tick(const Tick& tick, IkMode mode, WalkState& state, PlannedTick& planned) noexcept;
void finish_tick(const PlannedTick& planned, Pose& pose) noexcept;

}  // namespace gaitpad
