// How the robust solver steps, of a chain (ik.cpp) and of legs side by side (leg_ik_lanes.h): both
// give the same bits.
#pragma once

namespace gaitpad {

// l^2 = damping^2 + growth |dX|^2 (after Sugihara 2011, "Solvability-unconcerned inverse kinematics
// by the Levenberg-Marquardt method"); growth rises where a step makes the error greater.
inline constexpr double kLeastDampingSquared = 1e-20;
inline constexpr double kGrowth = 0.1;
inline constexpr double kGrowthUp = 8.0, kGrowthDown = 0.25;
inline constexpr double kFarthest = 0.5;  // metres: the greatest |dX| that one step asks for
// The error stands still if kPatience iterations together lower it by less than the share
// kLeastGain of itself, or of kGainFrom metres if it is greater.
inline constexpr int kPatience = 6;
inline constexpr double kLeastGain = 0.001;
inline constexpr double kGainFrom = 0.1;

}  // namespace gaitpad
