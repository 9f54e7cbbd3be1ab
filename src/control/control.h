// Stick and stylization state to gait parameters (Meredith & Maddock 2005, section 3.1).
#pragma once
#include <cmath>

#include "control/gait_params.h"
#include "control/style.h"
#include "stick/stick.h"

namespace gaitpad {

// An adult with 0.84 m of leg at full deflection. Step length over cadence, the walk ratio, stays
// the same at every speed (adults: 0.52 to 0.64 cm per step/min), so length = sqrt(60 s ratio
// speed).
inline constexpr double kMaxSpeed_m_s = 1.5;
inline constexpr double kWalkRatio_m_min = 0.0058;  // metres per step a minute
inline constexpr double kMaxStepTime_s = 1.1;       // slower walks shorten the step instead
inline constexpr double kTurnInPlaceStepTime_s = 0.6;
inline constexpr double kMaxTurnRate_rad_s = 1.0;
// Backwards a walker goes at this share of its forward speed, in steps this much shorter than
// forward ones at that speed.
inline constexpr double kBackwardShare = 0.45;
inline constexpr double kBackwardStep = 0.8;
// Backward deflection counts beyond this share of the sideways one, 10 degrees behind the side: a
// thumb that turns on the spot is not to step back and forth.
inline constexpr double kBackwardSector = 0.176;
inline constexpr double kFullFatigueLeaves = 0.4;  // of maximum speed and of maximum stride

// What a character can do at full deflection.
struct GaitLimits {
  double max_speed_m_s = kMaxSpeed_m_s;
  double max_step_m = std::sqrt(60.0 * kWalkRatio_m_min * kMaxSpeed_m_s);
  double max_step_time_s = kMaxStepTime_s;
  double turn_step_time_s = kTurnInPlaceStepTime_s;  // of a turn in place, a closing step
  double max_turn_rate_rad_s = kMaxTurnRate_rad_s;   // the same for all: side by side they stay so
};
// Lengths scale with the leg (the paper). Step times scale with its fourth root and speeds with the
// rest, half-way between the paper's plain proportion and equal Froude numbers, at which a child's
// legs would have to turn round faster than they can be followed smoothly at 240 Hz.
GaitLimits gait_limits(double leg_length_m) noexcept;

// What fatigue (0 .. 1) leaves of maximum speed and maximum stride.
double vigour(double fatigue) noexcept;

// Stateless: the walk smooths what changes between ticks. Only stick.left is read. Backward
// deflection walks backwards, sideways alone turns in place.
GaitParams gait_params(const Stick& stick, const StyleValues& style,
                       const GaitLimits& limits) noexcept;

}  // namespace gaitpad
