// Gait parameters: what the control module hands to the animation module every tick.
// Meredith & Maddock 2005, section 3.1. One group drives the motion (stride length, speed,
// direction, hip sway and bounce), a second group weights the inverse kinematics.
#pragma once
#include <array>
#include <optional>

#include "gaitpad/limbs.h"
#include "gaitpad/result.h"

namespace gaitpad {

// gait_params() of gaitpad/control.h or a program fills the structs below. The ranges are those
// that check() and a tick accept.

// The step of one foot, from its lift to its landing.
struct StrideParams {
  // Length from the standing heel to the landing heel along the heading, 0 .. 20; positive for
  // backward steps as well.
  double length_m = 0.0;
  double time_s = 0.5;  // half a cycle at this foot's pace: its flight and its roll; 0.05 .. 20
  double flight_height = 1.0;  // factor on the height of the flight in the motion data, 0 .. 3
};

// W of equation (5): one weight for each degree of freedom, 0 locked .. 1 free.
using LegWeights = std::array<double, kLegDofs>;
inline constexpr LegWeights kEvenWeights = {1, 1, 1, 1, 1, 1, 1};
using ArmWeights = std::array<double, kArmDofs>;
inline constexpr ArmWeights kEvenArmWeights = {1, 1, 1, 1, 1, 1};
using SpineWeights = std::array<double, kSpineParts>;
inline constexpr SpineWeights kEvenSpineWeights = {1, 1};

// The place at which a hand is held. With both shares 0 the hand swings with the arm. Lengths are
// an adult's: a carried place scales with the length of the arm, a rail's place with the height of
// the shoulders.
struct HandParams {
  double carry = 0.0;  // share, 0 .. 1: the hand is held in front of the chest
  // The place where it is held, from the middle between the shoulders, in the upright frame that
  // turns with them: x outwards (to the hand's own side), y up, z forward, each -1 .. 1. The
  // default is a tray at elbow height.
  double x_m = 0.16, y_m = -0.30, z_m = 0.36;
  double rail = 0.0;            // share, 0 .. 1: the hand is on a rail along the way; overrides
                                // `carry`
  double rail_height_m = 0.90;  // height of the rail above the ground, 0.3 .. 2
  double rail_side_m = 0.36;    // sideways distance of the rail from the hips' path, 0.1 .. 1
  bool operator==(const HandParams&) const = default;
};

// The direction or the place that the head looks at. Angles are in degrees, as in a file, so that a
// style is written back as it was read.
struct HeadParams {
  double look = 0.0;                       // share, 0 .. 1: the head looks in the direction of the
                                           // next two angles
  double yaw_deg = 0.0;                    // angle from the heading, left positive, -90 .. 90
  double pitch_deg = 0.0;                  // pitch of the direction, up positive, -60 .. 60
  double look_at = 0.0;                    // share, 0 .. 1: the head looks at the place below;
                                           // overrides `look`
  double x_m = 0.0, y_m = 1.6, z_m = 5.0;  // the place, in the world, not scaled; within 1e6
  double lead = 0.0;                       // share, 0 .. 1: the head looks to where the walk is
                                           // about to head
  bool operator==(const HeadParams&) const = default;
};

// The trunk's posture in degrees, added to that of the data.
struct TrunkParams {
  double lean_deg = 0.0;  // forward lean, while walking and when standing, -20 .. 40
  // Sideways lean over the left and over the right leg, while that leg stands alone, 0 .. 30.
  double over_left_deg = 0.0, over_right_deg = 0.0;
  bool operator==(const TrunkParams&) const = default;
};

// A style's values for the body above the hips. Arrays of two are indexed by Side.
struct UpperBodyParams {
  // Factors on the arms' swing in the motion data, 0 .. 3.
  std::array<double, 2> arm_swing{1.0, 1.0};
  std::array<double, 2> arm_out_deg{};  // angles by which the upper arms are spread, 0 .. 45
  std::array<ArmWeights, 2> arm_weight{kEvenArmWeights, kEvenArmWeights};
  SpineWeights spine_weight = kEvenSpineWeights;
  TrunkParams trunk;
  std::array<HandParams, 2> hand;
  HeadParams head;
  double idle = 1.0;  // share of breath, sway and glances that a stand shows: 0 none .. 1
  bool operator==(const UpperBodyParams&) const = default;
};

// All parameters of one tick. Plain, trivially copyable.
struct GaitParams {
  bool walking = false;                // false: the walk finishes its step and brings the feet
                                       // together
  bool backward = false;               // steps go backwards; a change takes effect only from
                                       // standing
  std::array<StrideParams, 2> stride;  // step parameters of both feet, indexed by Side
  double turn_rate_rad_s = 0.0;        // positive to the left, -4 .. 4
  double hip_sway = 1.0;    // factor on the pelvis' rotation about the vertical axis, 0 .. 3
  double hip_bounce = 1.0;  // factor on the pelvis' vertical travel, 0 .. 3
  // Weights of both legs, indexed by Side.
  std::array<LegWeights, 2> weight{kEvenWeights, kEvenWeights};
  UpperBodyParams body;
};

// Returns the first number that is not finite or out of its range, as a sentence: `GaitParams:
// stride[0].time_s is 0, outside [0.05, 20]`. A tick refuses the same numbers one by one
// (gaitpad/walk.h).
std::optional<Error> check(const GaitParams& params);

}  // namespace gaitpad
