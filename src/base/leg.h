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

}  // namespace gaitpad
