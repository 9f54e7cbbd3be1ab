// Stick and stylization state to gait parameters (Meredith & Maddock 2005, section 3.1).
#pragma once
#include "control/gait_params.h"
#include "control/style.h"
#include "stick/stick.h"

namespace gaitpad {

// What a character can do at full deflection; lengths scale with its legs.
struct GaitLimits {
  double max_speed_m_s = 1.6;
  double max_step_m = 0.746;
  double max_step_time_s = 1.1;
  double max_turn_rate_rad_s = 1.0;
};
GaitLimits gait_limits(double leg_length_m) noexcept;

// Stateless: the walk smooths what changes between ticks. Only stick.left is read.
GaitParams gait_params(const Stick& stick, const Style& style, const GaitLimits& limits) noexcept;

}  // namespace gaitpad
