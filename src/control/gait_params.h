// What the control module hands to the animation module every tick.
// Meredith & Maddock 2005, section 3.1: a first group drives the motion (stride length, speed,
// direction, hip sway and bounce), a second one weights the inverse kinematics.
#pragma once
#include <array>

#include "base/leg.h"

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

struct GaitParams {
  bool walking = false;   // false: stand (finish the step, bring the feet together)
  bool backward = false;  // the steps lead backwards; a change takes effect from standing alone
  std::array<StrideParams, 2> stride;
  double turn_rate_rad_s = 0.0;  // positive to the left
  double hip_sway = 1.0;         // factor on the pelvis' rotation about the vertical axis
  double hip_bounce = 1.0;       // factor on the pelvis' vertical travel
  std::array<LegWeights, 2> weight{kEvenWeights, kEvenWeights};
};

}  // namespace gaitpad
