// Stick and stylization state to gait parameters (Meredith & Maddock 2005, section 3.1).
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gaitpad/gait_params.h"
#include "gaitpad/stick.h"
#include "gaitpad/style.h"

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

// Gait parameters that somebody has taken over from the stick, one by one: the window's sliders,
// a `gait` command of a script.

enum class GaitKey : std::uint8_t {
  speed_m_s,  // (left + right step) / cycle time, backwards negative
  stride_left_m,
  stride_right_m,
  flight_left,  // factor on the flight's height
  flight_right,
  turn_rate_rad_s,
  hip_sway,
  hip_bounce,
};
inline constexpr int kGaitKeys = 8;

struct GaitKeyInfo {
  std::string_view name;  // as in a command
  std::string_view unit;  // "m", "m/s", "rad/s"; "x": a factor
  double min, max;        // what a command may give; range_of() bounds it further
};
const GaitKeyInfo& info_of(GaitKey key) noexcept;
std::optional<GaitKey> gait_key(std::string_view name) noexcept;
// What `params` say of it.
double value_of(GaitKey key, const GaitParams& params) noexcept;

struct GaitRange {
  double min, max;
};
// What has an effect on a character with these limits: as far as its stick, or else a style, goes.
GaitRange range_of(GaitKey key, const GaitLimits& limits) noexcept;

// Plain, trivially copyable.
struct GaitOverrides {
  std::array<double, kGaitKeys> value{};
  std::array<bool, kGaitKeys> is_set{};
};
// The stick's parameters with what is taken over. Total: a value that is no number counts as not
// taken over, others are bounded by range_of().
// - Speed takes the place of the forward deflection: strides as at that speed by stick, style and
//   fatigue, both step times stretched alike until the speed is met or a foot would step quicker or
//   slower than any stick and style let it (in the sharpest turn: than a stick). 0 stands, whatever
//   else is given.
// - The turn rate takes the place of the sideways deflection. Without speed and with a neutral
//   stick it turns in place.
// - A stride holds wherever one is asked for, by stick or speed: standing and turning in place ask
//   for none. Without speed the step keeps the stick's time.
// - What is not taken over stays as the stick and the style give it; of nothing all of it, bit by
//   bit.
GaitParams gait_params(const Stick& stick, const StyleValues& style, const GaitOverrides& overrides,
                       const GaitLimits& limits) noexcept;

}  // namespace gaitpad
