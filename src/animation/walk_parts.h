// The parts of one walking tick, in the order in which walk.cpp calls them. Internal to the walk.
#pragma once
#include "gaitpad/walk.h"

namespace gaitpad {

// --- walk_clock.cpp: smoothing, stages, phases -------------------------------------------------
struct Tick {  // what does not change within a tick
  const WalkModel& model;
  const GaitParams& params;
  double dt_s;
  bool flat;  // the terrain
};
inline constexpr double kTurnSmoothing = 0.25;  // s at the reference leg
inline constexpr double kFreeze = 0.55;         // of the flight: from here the landing place stays
inline constexpr Side rolling_foot(Side swing) noexcept { return other(swing); }

// Smooths the parameters and starts a walk from standing when the parameters ask for one.
void smooth_parameters(const Tick& tick, WalkState& state) noexcept;
void advance_clock(const Tick& tick, WalkState& state) noexcept;
// After the poses of the tick: a stage that is over hands on to the next one.
void finish_stage(const Tick& tick, WalkState& state) noexcept;
// Of the flight, 0 before it and in idle.
double flight_progress(const WalkState& state) noexcept;
int ticks_to_strike(const WalkState& state) noexcept;
// The foot that flies in this step (also during the roll before its flight).
Side step_foot(const WalkState& state) noexcept;
// How far that foot's step goes compared with the data's.
double pace(const WalkModel& model, const WalkState& state, Side side) noexcept;
// The same of the longer step: what a limp, which shortens one, leaves as it is.
double full_pace(const WalkModel& model, const WalkState& state) noexcept;
double own_phase(const WalkModel& model, const WalkState& state, Side side) noexcept;
// Where the data are asked: walking backwards is walking forwards run back (Thorstensson 1986), so
// that a foot lands where the data lift it.
double data_phase(const WalkModel& model, const WalkState& state) noexcept;
// The parameters ask for the walk that runs or may begin: standing lies between the directions.
bool walks_on(const GaitParams& params, const WalkState& state) noexcept;

// --- walk_ground.cpp: footholds ------------------------------------------------------------------
double height_on(const FootPlane& plane, const vec3& place_m) noexcept;
// Between risers, as level as its terrain lets it; the ground's height strays to both sides alike.
FootPlane plane_under(const Terrain& terrain, const LegBuild& leg, const vec3& heel_m,
                      double yaw_rad, const Stretch& piece) noexcept;
// Between two footholds.
bool crosses_riser(const Terrain& terrain, const FootPlane& a, const FootPlane& b) noexcept;
// Where a foot alone would stand nearest to `heel_m` without an edge under it.
FootPlane standing_plane(const WalkModel& model, Side side, const vec3& heel_m,
                         double yaw_rad) noexcept;
// The landing place that the ground offers nearest to where the step would go on level ground:
// along `forward`, the heading at landing, and `across_m` from the standing heel.
void choose_foothold(const Tick& tick, WalkState& state, const vec3& forward,
                     const vec3& across_m) noexcept;

// --- walk_flight.cpp: over what lies between two footholds
// ----------------------------------------
void plan_room(const Tick& tick, WalkState& state, Side side) noexcept;
// The flying foot's pose of this tick, moved by what its room asks for.
void keep_room(const Tick& tick, WalkState& state, Side side, double u) noexcept;

// --- walk_path.cpp: landing place, hips ---------------------------------------------------------
void plan_landing(const Tick& tick, WalkState& state) noexcept;
void advance_hips(const Tick& tick, WalkState& state) noexcept;
double step_length(const WalkState& state, Side side) noexcept;
struct Pelvis {
  vec3 position_m{0.0};                      // world
  quat rotation = quat(1.0, 0.0, 0.0, 0.0);  // segment rotation, world
  vec3 hip(const LegBuild& leg) const noexcept { return position_m + rotation * leg.model.hip_m; }
};
// Place and rotation without the height; then the height within both legs' reach.
Pelvis pelvis_over_ground(const WalkModel& model, const WalkState& state) noexcept;
double pelvis_height(const WalkModel& model, const WalkState& state, const Pelvis& pelvis) noexcept;

// --- walk_feet.cpp: where the feet are to be -----------------------------------------------------
// How far a standing foot may leave the floor with its heel: 0 flat .. 1 freely.
double heel_rise(const WalkModel& model, const WalkState& state, Side side) noexcept;
quat foot_rotation(const LegBuild& leg, const FootPose& pose) noexcept;  // segment rotation, world
void plan_foot(const Tick& tick, WalkState& state, Side side) noexcept;
// The flying foot as on level ground between its two planes, and the height of that ground.
struct FlightPoint {
  FootPose pose;
  double base_m = 0.0;
};
FlightPoint flight_point(const WalkModel& model, const WalkState& state, Side side, double u,
                         double pitch_fade_rad) noexcept;
// Of the heel, over the plane that the foot is planned on.
double heel_height(const FootState& foot) noexcept;
// A standing foot rises on its toe as far as the hips ask for it.
void reach_with_toe(const WalkModel& model, WalkState& state, Side side,
                    const vec3& hip_m) noexcept;
// Pitch limits at the present place of the pivot: heel not below the floor, toe clear of it.
void set_pitch(const LegBuild& leg, double pitch_rad, FootPose& pose, FootMode mode) noexcept;
double highest_pitch(const LegBuild& leg, double heel_m, double clearance_m) noexcept;
// End of the tick: what the next tick's derivatives need.
void remember_foot(FootState& foot) noexcept;
void begin_support(FootState& foot, const LegAngles& even_rad) noexcept;
void begin_flight(const Tick& tick, WalkState& state, Side side) noexcept;
void begin_roll(WalkState& state, Side side) noexcept;  // in the roll's stage
void hold_pitch(const WalkModel& model, WalkState& state, Side side, int ticks) noexcept;

// --- upper_body.cpp: what is above the hips
// Smooths the parameters of the upper body. In paper mode the pace does not act on the arms: the
// data's upper body is left as it is.
void smooth_upper_body(const Tick& tick, IkMode mode, WalkState& state) noexcept;
// On the data's local rotations of this phase, before they fade to a stand.
void swing_arms(const WalkModel& model, const WalkState& state, Pose& pose) noexcept;
// Spine, arms and head of a pose whose legs are done.
void pose_upper_body(const WalkModel& model, const WalkState& state, Pose& pose) noexcept;

// --- walk_legs.cpp: inverse kinematics
// ------------------------------------------------------------
void pose_leg(const Tick& tick, IkMode mode, Side side, const Pelvis& pelvis,
              WalkState& state) noexcept;

}  // namespace gaitpad
