// Everything about one character's walk that does not change while it walks: the data module's gait
// cycle retargeted to the character's legs (Meredith & Maddock 2005, sections 3.2 and 3.3).
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "animation/body_model.h"
#include "animation/character.h"
#include "animation/curve.h"
#include "animation/ik.h"
#include "animation/terrain.h"
#include "motion/gait_cycle.h"

namespace gaitpad {

inline constexpr int kMaxBetween = 8;  // joints between two of a leg's chain

using PhaseTable = PeriodicTable<kCycleSamples>;
inline constexpr int kFlightSamples = 65;
using FlightCurve = Curve<kFlightSamples>;

// The heel's flight from toe-off (u = 0) to its next strike (u = 1), from the data: the paper's
// flight path, its height in metres of the character, its progress from 0 to 1.
struct FootFlight {
  FlightCurve progress, height_m;
};

struct LegBuild {
  LegModel model;            // character's metres
  IkChain chain;             // hip joint to foot frame, even weights, joint limits
  double foot_m = 0;         // heel to toe
  double elevation_rad = 0;  // of the heel-toe line above the floor when standing
  vec3 forward{0.0, 0.0, 1.0}, side{1.0, 0.0, 0.0};  // foot frame: along and across the foot, level
  // The sole, foot frame: on the floor when standing, from the heel under the ball to the tip.
  vec3 ball_m{0.0}, tip_m{0.0};
  double half_width_m = 0;
  FootFlight flight;
  PhaseTable pitch_rad;  // own phase (0 at own strike); of the heel-toe line, toe down positive
  double toe_off = 0.6;  // own phase
  double track_m = 0;    // sideways place of the heel from the pelvis' path, + left
};

struct WalkModel {
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  GaitCycle cycle;  // of the source; skeleton replaced by the character's
  std::array<LegBuild, 2> leg;
  double size = 1.0;        // leg length over kReferenceLeg_m
  double time_scale = 1.0;  // how much longer than the adult's its times are
  double leg_length_m = 0, source_leg_length_m = 0;
  double source_step_m = 0;  // retargeted: mean step of the data on this character
  double step_front = 0.5;   // alpha: at a strike, front heel to hips over the step, from the data
  double rest_lead_m = 0;    // c0: hips before the heels when standing
  double stand_m = 0;        // pelvis height when standing
  PhaseTable sway_m, bounce_m, surge_m;  // pelvis: sideways, about the mean height, fore-aft
  PhaseTable yaw_rad;                    // pelvis about the vertical
  std::array<PhaseTable, 3> tilt;        // the rest of its rotation, as a rotation vector
  std::array<std::array<PhaseTable, kLegDofs>, 2> reference_rad;  // leg angles of the data
  // Shares of the cycle in walking order: roll right, flight left, roll left, flight right.
  std::array<double, 4> share{};
  std::vector<int>
      kept;  // joints that the legs' chains pass through: fixed at their standing rotation
  BodyModel body;
};

// Retargets by the leg-length ratio. Fails only on a character that the skeleton cannot be.
Result<WalkModel> walk_model(const GaitCycle& cycle, const Character& character);

// How much larger a terrain is to be for this walker, 1 where it fits: where a sole, with some room
// of the walker's own size, does not lie on the shortest tread, all the ground grows by the ratio
// of the leg to the adult's, and farther if need be.
double terrain_scale(const Terrain& terrain, const WalkModel& model) noexcept;

}  // namespace gaitpad
