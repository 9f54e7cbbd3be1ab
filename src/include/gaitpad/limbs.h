// The two legs and a leg's degrees of freedom: names that the control, data and animation modules
// share.
#pragma once
#include <array>

namespace gaitpad {

enum Side : int { kLeftSide = 0, kRightSide = 1 };
inline constexpr Side other(Side s) noexcept { return s == kLeftSide ? kRightSide : kLeftSide; }

// Radians about axes fixed in the standing pose (x left, y up, z forward), applied outwards:
// thigh = pelvis Rx Rz Ry, shank = thigh Rx, foot = shank Rx Rz Ry. +x swings the segment's lower
// end backwards: hip flexion and dorsiflexion are negative, knee flexion is positive.
enum LegDof : int { kHipX, kHipZ, kHipY, kKneeX, kAnkleX, kAnkleZ, kAnkleY, kLegDofs };
using LegAngles = std::array<double, kLegDofs>;

// Thigh + shank of the adult that constants given in metres and seconds are for.
inline constexpr double kReferenceLeg_m = 0.84;

// An arm's and the spine's degrees of freedom: names that the control and animation modules share.

// Radians about axes fixed in the hanging arm (x left, y up, z forward), applied outwards: upper
// arm = chest Rx Rz Ry, forearm = upper arm Rx, hand = forearm Rx Rz, the wrist's counted from
// where the data have it. +x swings the lower end backwards: flexion is negative.
enum ArmDof : int { kShoulderX, kShoulderZ, kShoulderY, kElbowX, kWristX, kWristZ, kArmDofs };
using ArmAngles = std::array<double, kArmDofs>;

// The spine's joints in two halves, from the pelvis up.
enum SpinePart : int { kLowerSpine, kUpperSpine, kSpineParts };

// Shoulder to wrist and shoulder's height of the adult that lengths given in metres are for (0.332
// and 0.818 of the stature that goes with kReferenceLeg_m).
inline constexpr double kReferenceArm_m = 0.568;
inline constexpr double kReferenceShoulder_m = 1.40;

}  // namespace gaitpad
