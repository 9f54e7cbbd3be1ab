// Numbers of the robust solver, for ik.cpp in doubles and for a tick's chains in floats.
#pragma once

namespace gaitpad {

template <class T>
struct SolverNumbers {
  // l^2 is kGrowth of the squared error; this share grows after a step that makes the error
  // greater, and falls again after others.
  static constexpr T kGrowth = T(0.1), kGrowthUp = T(8.0), kGrowthDown = T(0.25);
  static constexpr T kFarthest_m = T(0.5);  // the greatest error that one step uses
  // The error counts as constant if kPatience steps together reduce it by less than the share
  // kLeastGain of itself, or of kGainFrom_m if that is less.
  static constexpr int kPatience = 6;
  static constexpr T kLeastGain = T(0.001), kGainFrom_m = T(0.1);
};

}  // namespace gaitpad
