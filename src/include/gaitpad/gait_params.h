// What the control module hands to the animation module every tick.
// Meredith & Maddock 2005, section 3.1: a first group drives the motion (stride length, speed,
// direction, hip sway and bounce), a second one weights the inverse kinematics.
#pragma once
#include <array>

#include "gaitpad/limbs.h"

namespace gaitpad {

// One foot's step, from its lift to its landing.
struct StrideParams {
  double length_m = 0.0;  // from the standing heel to the landing heel, along the heading
  double time_s = 0.5;    // half a cycle at this foot's pace; its flight and roll take their share
  double flight_height = 1.0;  // factor on the height that the data give
};

// W of equation (5): per degree of freedom, 0 locked .. 1 free.
using LegWeights = std::array<double, kLegDofs>;
inline constexpr LegWeights kEvenWeights = {1, 1, 1, 1, 1, 1, 1};

// The same for an arm's and the spine's joints.
using ArmWeights = std::array<double, kArmDofs>;
inline constexpr ArmWeights kEvenArmWeights = {1, 1, 1, 1, 1, 1};
using SpineWeights = std::array<double, kSpineParts>;
inline constexpr SpineWeights kEvenSpineWeights = {1, 1};

// Where a hand is to be; at 0 shares it swings. Metres of an adult: a carried place grows with the
// arm, a rail's place with the height of the shoulders.
struct HandParams {
  double carry = 0.0;  // share: at a place before the chest
  // From the middle between the shoulders, in the upright frame that turns with them: outwards (to
  // that hand's side), up, forward. At first a tray at the height of the elbows.
  double x_m = 0.16, y_m = -0.30, z_m = 0.36;
  double rail = 0.0;  // share: on a rail along the way, which wins over what is carried
  double rail_height_m = 0.90, rail_side_m = 0.36;  // above the ground; from the hips' path
  bool operator==(const HandParams&) const = default;
};

// Where the head looks. Degrees, as in a file, which is to be written back as it was read; yaw from
// the heading, positive to the left, pitch positive up.
struct HeadParams {
  double look = 0.0;  // share: in a direction
  double yaw_deg = 0.0, pitch_deg = 0.0;
  double look_at = 0.0;                    // share: at a place in the world, which wins
  double x_m = 0.0, y_m = 1.6, z_m = 5.0;  // world, metres as they are
  double lead = 0.0;                       // share: to where the walk will head in a while
  bool operator==(const HeadParams&) const = default;
};

struct BodyParams {
  std::array<double, 2> arm_swing{1.0, 1.0};  // factor on the arm's swing
  std::array<ArmWeights, 2> arm_weight{kEvenArmWeights, kEvenArmWeights};
  SpineWeights spine_weight = kEvenSpineWeights;
  std::array<HandParams, 2> hand;
  HeadParams head;
  bool operator==(const BodyParams&) const = default;
};

struct GaitParams {
  bool walking = false;   // false: stand (finish the step, bring the feet together)
  bool backward = false;  // the steps lead backwards; a change takes effect from standing alone
  std::array<StrideParams, 2> stride;
  double turn_rate_rad_s = 0.0;  // positive to the left
  double hip_sway = 1.0;         // factor on the pelvis' rotation about the vertical axis
  double hip_bounce = 1.0;       // factor on the pelvis' vertical travel
  std::array<LegWeights, 2> weight{kEvenWeights, kEvenWeights};
  BodyParams body;  // above the hips
};

}  // namespace gaitpad
