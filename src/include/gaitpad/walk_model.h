// The part of a character's walk that does not change while it walks: the data module's gait cycle,
// retargeted to the character's legs and laid out in tables (Meredith & Maddock 2005, sections 3.2
// and 3.3). A model is immutable after walk_model(), and any number of walkers may share it.
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

// A character's build, as far as it differs from the motion's skeleton. Its file or the caller
// fills it.
struct Character {
  std::string name = "as in the motion file";  // error sentences begin with it
  double scale = 1.0;                          // factor on all bones, 0.05 .. 20
  double leg_ratio = 1.0;  // factor on thigh, shank and foot bones, multiplied by scale; 0.05 .. 20
  std::string skeleton;    // BVH file with the character's own skeleton; empty: the motion's
};
// Errors read `NAME: scale is 0, outside [0.05, 20]`. Both factors and their product have this
// range.
std::optional<Error> check(const Character& character);

// Most joints from the root to a wrist or the head. A longer path has no inverse kinematics: this
// bounds the work of a tick.
inline constexpr int kMaxBodyPath = 48;
// Most joints of the spine that share a bend, with 3 DOFs each.
inline constexpr int kMaxSpineIk = 5;

// One arm, for its inverse kinematics (section 5, future work). Its *hanging* axes are x along the
// elbow's hinge, to the left, and y from the elbow to the shoulder.
struct ArmBuild {
  bool is_there = false;  // false: the skeleton has no such arm, and no other member is set
  ArmChain joints;
  std::vector<int> path;  // joints from the root to the wrist
  // Local rotations in the middle of the data's swing.
  quat swing_shoulder = kIdentity, swing_elbow = kIdentity;
  // Largest factor on the data's swing that does not stretch the elbow.
  double most_elbow_swing = 1.0;
  quat hanging = kIdentity;        // the hanging axes in the shoulder joint's frame
  quat chest = kIdentity;          // the walker's axes in the frame above the shoulder, standing
  vec3 grip_m{0.0};                // middle of the hand, in the wrist's frame
  double length_m = 0.0;           // length from shoulder to wrist
  ArmAngles min_rad{}, max_rad{};  // a person's limits, widened to the range of the data
  ArmAngles middle_rad{};          // angles in the middle of the data's swing
};

// A joint of the spine that shares the bend by its weight.
struct SpineJoint {
  int joint = -1;
  quat standing = kIdentity;  // the joint's world rotation in the standing pose
  double upper = 0.0;         // place in the spine: 0 the lowest .. 1 the uppermost
};

// Arms, spine and head. Parts that the skeleton lacks stay empty, and a walk ignores them.
struct UpperBodyModel {
  UpperBodyJoints
      joints;  // the joints; drawing uses them too, so that it shows the limbs that are solved
  std::array<ArmBuild, 2> arm;
  double arm_m = kReferenceArm_m;  // length from shoulder to wrist, mean of the arms
  double shoulder_height_m = 0.0;  // height of the shoulders when standing
  double own_step_s = 0.5;         // duration of a step in the data, for legs of this length
  std::vector<int> spine_path;     // joints from the root to the one that carries neck and arms
  std::vector<SpineJoint> spine;   // at most kMaxSpineIk joints; with fewer than two the spine does
                                   // not bend
  quat spine_base = kIdentity;     // standing rotation of the joint below the spine
  // From the uppermost spine joint to between the shoulders, in the standing axes.
  vec3 neck_m{0.0};
  std::vector<int> head_path;  // joints from the root to the head; empty: there is no head
  int neck_at = 0;             // index in head_path of the first neck joint (or the head)
  // World rotations of head and chest in the standing pose.
  quat head_standing = kIdentity, chest_standing = kIdentity;
};

inline constexpr int kMaxBetween = 8;  // most twist joints between two joints of a leg

// A joint of a leg in a pose: its local rotation is before * turn * after, where `turn` follows
// from the leg's angles.
struct LegJointFrame {
  int joint = -1;  // index of the joint; -1: the skeleton has none
  quat before = kIdentity, after = kIdentity;
};

struct LegBuild {
  LegModel model;  // the leg, in the character's metres
  // Chain from the hip joint to the foot's frame, with even weights and joint limits.
  IkChain chain;
  // Level directions along the foot and across it, in its frame.
  vec3 forward{0.0, 0.0, 1.0}, side{1.0, 0.0, 0.0};
  std::array<LegJointFrame, 4> joint;  // joints hip, knee, ankle, toe
  // The sole in the foot frame: from the heel under the ball to the tip, on the floor when
  // standing.
  vec3 ball_m{0.0}, tip_m{0.0};
  double toe_off = 0.6;  // phase of its toe-off since the foot's own strike
  double track_m = 0;    // sideways distance of the heel from the pelvis' path, + left
};

struct BuildTables;

// A character's model; walk_model() fills it. A program may replace `terrain` before the first walk
// stands on it, by one that check() accepts. Lengths are the character's, in metres.
struct WalkModel {
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  // The data. Its skeleton and legs have the character's lengths; its strides have the motion's, so
  // that characters of all builds share them.
  GaitCycle cycle;
  StrideScale stride_scale;
  std::array<double, 2> own_step_m{};  // lengths of the data's steps on this character, by Side
  std::array<LegBuild, 2> leg;
  double size = 1.0;        // leg length over kReferenceLeg_m
  double time_scale = 1.0;  // factor on the adult's times
  double leg_length_m = 0, source_leg_length_m = 0;
  double source_step_m = 0;              // mean length of the data's steps, retargeted to this
                                         // character
  double rest_lead_m = 0;                // distance of the hips in front of the heels when standing
  double stand_m = 0;                    // height of the pelvis when standing
  double stand_roll_rad = 0;             // roll of the standing pelvis, left side up positive
  std::array<LegAngles, 2> stand_rad{};  // angles of the standing legs
  // Shares of the cycle in walking order: roll right, flight left, roll left, flight right.
  std::array<double, 4> share{};
  std::vector<int> kept;  // twist joints in the legs, which keep their standing rotation
  // Of the joints that the data set: those that move, and those that are always the identity.
  std::vector<int> moving, still;
  UpperBodyModel body;
  std::shared_ptr<const BuildTables> tables;  // all of this as a tick reads it
};

// Retargets a cycle by the ratio of the leg lengths: lengths grow with the leg, times with the
// fourth root of its ratio to the adult's. Error `NAME: cause` for a cycle without clean strides,
// for a character that check() refuses or that has its own skeleton, and for a leg with more than
// kMaxBetween twist joints between two of its joints.
Result<WalkModel> walk_model(const GaitCycle& cycle, const Character& character);

// A stride of the model at one ratio and one phase, in the character's lengths. No heap.
StridePlace stride_of(const WalkModel& model, bool backward, double phase, double ratio) noexcept;

// The limits of this character at full deflection, by the pace of its motion: the adult's for its
// legs, or the motion's own gait at kOwnStick.
GaitLimits gait_limits(const WalkModel& model) noexcept;

// The forward deflection that gives the data's speed, on the data's own legs. At the own pace that
// is kOwnStick, and the steps are also the data's; at the adult's pace they are an adult's. Nothing
// if the data are faster than full stick.
std::optional<double> own_stick(const GaitCycle& cycle) noexcept;

// The factor by which a terrain has to grow for this walker; 1 if it fits. If the sole and some
// room do not fit on the shortest tread, the ground grows by the ratio of the leg to the adult's,
// and farther if that is not enough.
double terrain_scale(const Terrain& terrain, const WalkModel& model) noexcept;

}  // namespace gaitpad
