// What is above the hips, as far as a walk poses it anew: arms, spine and head of one character.
// Meredith & Maddock 2005, section 5 (future work): weights and posture for the upper body.
#pragma once
#include <array>
#include <vector>

#include "animation/ik.h"
#include "base/arm.h"
#include "motion/body_joints.h"
#include "motion/gait_cycle.h"

namespace gaitpad {

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

struct BodyModel {
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
BodyModel body_model(const GaitCycle& cycle, double leg_ratio, double pelvis_height_m);

}  // namespace gaitpad
