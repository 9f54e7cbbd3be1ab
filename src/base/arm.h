// An arm's and the spine's degrees of freedom: names that the control and animation modules share.
#pragma once
#include <array>

namespace gaitpad {

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
