// Sides, and the degrees of freedom of legs, arms and spine: names that the control, data and
// animation modules share.
#pragma once
#include <array>

namespace gaitpad {

enum Side : int { kLeftSide = 0, kRightSide = 1 };
inline constexpr Side other(Side s) noexcept { return s == kLeftSide ? kRightSide : kLeftSide; }
// The names of the sides, by Side, for sentences and files.
inline constexpr std::array<const char*, 2> kSideNames = {"left", "right"};

// A leg's joint angles in radians, about axes fixed in the standing pose (x left, y up, z forward)
// and applied outwards: thigh = pelvis Rx Rz Ry, shank = thigh Rx, foot = shank Rx Rz Ry. A
// positive x swings the segment's lower end backwards: hip flexion and dorsiflexion are negative,
// knee flexion is positive. All angles are 0 in the standing pose.
enum LegDof : int { kHipX, kHipZ, kHipY, kKneeX, kAnkleX, kAnkleZ, kAnkleY, kLegDofs };
using LegAngles = std::array<double, kLegDofs>;

// Thigh + shank, in metres, of the adult that constants in metres and seconds are meant for. Other
// walkers scale them.
inline constexpr double kReferenceLeg_m = 0.84;

// An arm's joint angles in radians, about axes fixed in the hanging arm (x left, y up, z forward)
// and applied outwards: upper arm = chest Rx Rz Ry, forearm = upper arm Rx, hand = forearm Rx Rz.
// The wrist's angles count from where the data have it. A positive x swings the lower end
// backwards: flexion is negative.
enum ArmDof : int { kShoulderX, kShoulderZ, kShoulderY, kElbowX, kWristX, kWristZ, kArmDofs };
using ArmAngles = std::array<double, kArmDofs>;

// The halves of the spine, from the pelvis up.
enum SpinePart : int { kLowerSpine, kUpperSpine, kSpineParts };

// Distance from shoulder to wrist, and height of the shoulders, of the same adult in metres: 0.332
// and 0.818 of the stature that goes with kReferenceLeg_m.
inline constexpr double kReferenceArm_m = 0.568;
inline constexpr double kReferenceShoulder_m = 1.40;

}  // namespace gaitpad
