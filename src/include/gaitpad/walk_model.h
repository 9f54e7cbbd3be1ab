// Everything about one character's walk that does not change while it walks: the data module's gait
// cycle, retargeted to the character's legs and laid out in tables (Meredith & Maddock 2005,
// sections 3.2 and 3.3). A model is immutable after walk_model(), and any number of walkers may
// share it.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/anatomy.h"
#include "gaitpad/control.h"
#include "gaitpad/curve.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/ik.h"
#include "gaitpad/limbs.h"
#include "gaitpad/result.h"
#include "gaitpad/stride_family.h"
#include "gaitpad/terrain.h"

namespace gaitpad {

// A character's build, as far as it differs from the motion's own skeleton. Its file or the caller
// fills it.
struct Character {
  std::string name = "as in the motion file";  // error sentences begin with it
  double scale = 1.0;                          // factor on all bones, 0.05 .. 20
  double leg_ratio = 1.0;  // on thigh, shank and foot bones, on top of scale; 0.05 .. 20
  std::string skeleton;    // BVH file whose skeleton the character brings, empty: the motion's own
};
// `NAME: scale is 0, outside [0.05, 20]`. Both factors and their product have this range.
std::optional<Error> check(const Character& character);

// Joints from the root to a wrist or the head. A longer path has no inverse kinematics: this bounds
// what a tick goes through.
inline constexpr int kMaxBodyPath = 48;
inline constexpr int kMaxSpineIk = 5;  // joints of the spine that share the work: 3 DOFs each

// One arm, for its inverse kinematics (section 5, future work). Its *hanging* axes are x along the
// elbow's hinge, to the left, and y from the elbow to the shoulder.
struct ArmBuild {
  bool is_there = false;  // else nothing of it is set
  ArmChain joints;
  std::vector<int> path;                        // joints from the root to the wrist
  int shoulder_column = -1, elbow_column = -1;  // in WalkModel::above; -1: they never move
  // Local rotations in the middle of the data's swing.
  quat swing_shoulder = kIdentity, swing_elbow = kIdentity;
  double most_elbow_swing = 1.0;   // factor on the data's swing that would stretch the elbow
  quat hanging = kIdentity;        // the hanging axes in the shoulder joint's frame
  quat chest = kIdentity;          // the walker's axes, standing, in the frame above the shoulder
  vec3 grip_m{0.0};                // middle of the hand, in the wrist's frame
  double length_m = 0.0;           // shoulder to wrist
  ArmAngles min_rad{}, max_rad{};  // a person's limits, widened to what the data do
  ArmAngles middle_rad{};          // of the data's swing
};

// A joint of the spine that shares the work when weights bend it.
struct SpineJoint {
  int joint = -1;
  quat standing = kIdentity;  // its world rotation in the standing pose
  double upper = 0.0;         // 0 the lowest of the spine .. 1 the uppermost
};

// Arms, spine and head. What the skeleton lacks stays empty, and a walk leaves it alone.
struct UpperBodyModel {
  UpperBodyJoints
      joints;  // drawing takes its limbs from here, so they are the ones that are solved
  std::array<ArmBuild, 2> arm;
  double arm_m = kReferenceArm_m;  // shoulder to wrist, mean of the arms
  double shoulder_height_m = 0.0;  // standing
  double own_step_s = 0.5;         // a step's time in the data, for legs of this length
  std::vector<int> spine_path;     // from the root to what carries neck and arms
  std::vector<SpineJoint>
      spine;                    // at most kMaxSpineIk; with fewer than two the spine does not bend
  quat spine_base = kIdentity;  // standing rotation of what the spine stands on
  vec3 neck_m{0.0};  // from the uppermost one to between the shoulders, in the standing axes
  std::vector<int> head_path;  // from the root to the head; empty: there is none
  int neck_at = 0;             // in head_path: the first neck joint (or the head)
  quat head_standing = kIdentity, chest_standing = kIdentity;  // world rotations
};

inline constexpr int kMaxBetween = 8;  // twist joints between two joints of a leg

// A joint of a leg as a pose has it: its local rotation is before * turn * after, where `turn` is
// how far the leg's angles turn it.
struct LegJointFrame {
  int joint = -1;  // -1: the skeleton has none
  quat before = kIdentity, after = kIdentity;
};

struct LegBuild {
  LegModel model;            // in the character's metres
  IkChain chain;             // from the hip joint to the foot frame: even weights, joint limits
  double foot_m = 0;         // heel to toe
  double elevation_rad = 0;  // of the heel-toe line above the floor when standing
  vec3 forward{0.0, 0.0, 1.0}, side{1.0, 0.0, 0.0};  // foot frame, level: along the foot, across it
  vec3 line{0.0, 0.0, 1.0};                          // unit, from heel to toe
  std::array<LegJointFrame, 4> joint;                // hip, knee, ankle, toe
  // The sole in the foot frame: from the heel under the ball to the tip, on the floor when
  // standing.
  vec3 ball_m{0.0}, tip_m{0.0};
  double half_width_m = 0;
  double toe_off = 0.6;  // phase since the foot's own strike
  double track_m = 0;    // sideways place of the heel from the pelvis' path, + left
};

// Where a character's strides go, in its lengths: evenly farther for greater ratios.
struct FootprintLine {
  Footprints at_zero, per_ratio;
  double most_ratio = 0.0;  // of the tables
};

// walk_model() fills it. A program may put another ground in place of `terrain` before the first
// walk stands on it, one that check() accepts. Lengths are the character's, in metres.
struct WalkModel {
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  // The data; its skeleton and legs have the character's lengths, its strides the motion's, so that
  // characters of all builds share them.
  GaitCycle cycle;
  StrideScale stride_scale;
  FootprintLine forward, back;
  std::array<double, 2> own_step_m{};  // by Side: the data's steps on this character
  std::array<LegBuild, 2> leg;
  double size = 1.0;        // leg length over kReferenceLeg_m
  double time_scale = 1.0;  // factor on the adult's times
  double leg_length_m = 0, source_leg_length_m = 0;
  double source_step_m = 0;              // retargeted: mean step of the data on this character
  double rest_lead_m = 0;                // hips before the heels when standing
  double stand_m = 0;                    // pelvis height when standing,
  double stand_roll_rad = 0;             // its roll, left side up positive,
  std::array<LegAngles, 2> stand_rad{};  // and the legs' angles
  // Shares of the cycle in walking order: roll right, flight left, roll left, flight right.
  std::array<double, 4> share{};
  std::vector<int> kept;  // twist joints in the legs: fixed at their standing rotation
  PoseRows above;         // the data's rotations of all joints that the legs do not set
  UpperBodyModel body;
};

// Retargets by the ratio of the leg lengths: lengths grow with the leg, times with the fourth root
// of its ratio to the adult's. Error `NAME: cause` for a cycle without clean strides, for a
// character that check() refuses or that brings a skeleton of its own, and for a leg with more than
// kMaxBetween twist joints between two of its joints.
Result<WalkModel> walk_model(const GaitCycle& cycle, const Character& character);

// Its stride of one ratio in its lengths, at one phase. No heap.
StridePlace stride_of(const WalkModel& model, bool backward, double phase, double ratio) noexcept;

// What the stick asks of this character at full deflection, by the pace of its motion: the adult's
// for its legs, or the motion's own gait at kOwnStick.
GaitLimits gait_limits(const WalkModel& model) noexcept;

// How far forward the stick gives the data's speed, on the data's own legs. At the own pace that is
// kOwnStick, and the steps are the data's too; at the adult's pace they are an adult's. Nothing if
// the data are faster than full stick.
std::optional<double> own_stick(const GaitCycle& cycle) noexcept;

// The factor by which a terrain has to grow for this walker: 1 where it fits. Where the sole and
// some room do not fit on the shortest tread, the ground grows by the ratio of the leg to the
// adult's, and farther if that is not enough.
double terrain_scale(const Terrain& terrain, const WalkModel& model) noexcept;

}  // namespace gaitpad
