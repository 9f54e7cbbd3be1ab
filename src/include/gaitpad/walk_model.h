// A character's build, as far as it differs from the motion's own skeleton.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/anatomy.h"
#include "gaitpad/curve.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/ik.h"
#include "gaitpad/limbs.h"
#include "gaitpad/result.h"
#include "gaitpad/terrain.h"

namespace gaitpad {

struct Character {
  std::string name = "as in the motion file";
  double scale = 1.0;      // all bones
  double leg_ratio = 1.0;  // thigh, shank and foot bones, on top of scale
  std::string skeleton;    // BVH file whose skeleton the character brings, empty: the motion's own
};

// What is above the hips, as far as a walk poses it anew: arms, spine and head of one character.
// Meredith & Maddock 2005, section 5 (future work): weights and posture for the upper body.

// Bounds what a tick walks through; a longer way has no IK.
inline constexpr int kMaxBodyPath = 48;
inline constexpr int kMaxSpineIk = 5;  // joints of the spine that share the work: 3 DOFs each

// One arm. Its *hanging* axes: x the elbow's hinge (to the left), y from elbow to shoulder.
struct ArmBuild {
  bool is_there = false;
  ArmChain joints;
  std::vector<int> path;            // joints from the root to the wrist
  quat swing_shoulder = kIdentity,  // local rotations, middle of the data's swing
      swing_elbow = kIdentity;
  double most_elbow_swing = 1.0;   // factor on the data's swing that would stretch the elbow
  quat hanging = kIdentity;        // the hanging axes in the shoulder joint's frame
  quat chest = kIdentity;          // the walker's axes, standing, in the frame above the shoulder
  vec3 grip_m{0.0};                // middle of the hand, in the wrist's frame
  double length_m = 0.0;           // shoulder to wrist
  ArmAngles min_rad{}, max_rad{};  // a person's limits, widened to what the data do
  ArmAngles middle_rad{};          // of the data's swing
};

struct SpineJoint {
  int joint = -1;
  quat standing = kIdentity;  // its world rotation in the standing pose
  double upper = 0.0;         // 0 the lowest of the spine .. 1 the uppermost
};

struct UpperBodyModel {
  UpperBodyJoints joints;  // what a figure is drawn from, too
  std::array<ArmBuild, 2> arm;
  double arm_m = kReferenceArm_m;  // shoulder to wrist, mean of the arms
  double shoulder_height_m = 0.0;  // standing
  double own_step_s = 0.5;         // the data's step, with the time that this character's legs give
  std::vector<int> spine_path;     // from the root to what carries neck and arms
  std::vector<SpineJoint> spine;   // those that share the work; fewer than two: none
  quat spine_base = kIdentity;     // standing rotation of what the spine stands on
  vec3 neck_m{
      0.0};  // from the uppermost of them to the middle between the shoulders, standing axes
  std::vector<int> head_path;  // from the root to the head; empty: there is none
  int neck_at = 0;             // in head_path: the first neck joint (or the head)
  quat head_standing = kIdentity, chest_standing = kIdentity;  // world rotations
};

// Of a cycle that has the character's lengths. Total: what it does not find stays off.
// `leg_ratio`: the character's leg over the leg of the data.
UpperBodyModel upper_body_model(const GaitCycle& cycle, double leg_ratio, double pelvis_height_m);

// Everything about one character's walk that does not change while it walks: the data module's gait
// cycle retargeted to the character's legs (Meredith & Maddock 2005, sections 3.2 and 3.3).

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
  UpperBodyModel body;
};

// Retargets by the leg-length ratio. Fails only on a character that the skeleton cannot be.
Result<WalkModel> walk_model(const GaitCycle& cycle, const Character& character);

// How much larger a terrain is to be for this walker, 1 where it fits: where a sole, with some room
// of the walker's own size, does not lie on the shortest tread, all the ground grows by the ratio
// of the leg to the adult's, and farther if need be.
double terrain_scale(const Terrain& terrain, const WalkModel& model) noexcept;

}  // namespace gaitpad
