// Stick and stylization state to gait parameters (Meredith & Maddock 2005, section 3.1). All
// functions are stateless, allocate nothing and may be called in every tick; the walk smooths what
// changes between ticks.
//
//   const gaitpad::GaitLimits limits = gaitpad::gait_limits(model);  // of gaitpad/walk_model.h
//   const gaitpad::GaitParams params = gaitpad::gait_params(stick, style, limits);
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "gaitpad/gait_params.h"
#include "gaitpad/result.h"
#include "gaitpad/stick.h"
#include "gaitpad/style.h"

namespace gaitpad {

// An adult with a leg of 0.84 m at full deflection. The walk ratio, step length over cadence, is
// constant over speed (adults: 0.52 to 0.64 cm per step/min): length = sqrt(60 s * ratio * speed).
inline constexpr double kMaxSpeed_m_s = 1.5;
inline constexpr double kWalkRatio_m_min = 0.0058;  // metres per step a minute
inline constexpr double kMaxStepTime_s = 1.1;       // slower walks shorten the step instead
inline constexpr double kTurnInPlaceStepTime_s = 0.48;
inline constexpr double kMaxTurnRate_rad_s = 1.0;
// On the spot a turn is quicker by this factor, from this forward deflection on it is not.
inline constexpr double kQuickerInPlace = 1.65, kNotInPlace = 0.15;
// Walking backwards: the share of the forward speed, and the factor on the length that a forward
// step has at the same speed.
inline constexpr double kBackwardShare = 0.45;
inline constexpr double kBackwardStep = 0.8;
// Backward deflection counts only beyond this share of the sideways one, which is 10 degrees behind
// the side: a thumb that turns on the spot must not step back and forth.
inline constexpr double kBackwardSector = 0.176;
inline constexpr double kFullFatigueLeaves = 0.4;  // of maximum speed and of maximum stride

// What a character does at full deflection. gait_limits() fills it; a program may change it.
struct GaitLimits {
  double max_speed_m_s = kMaxSpeed_m_s;  // 0.001 .. 50
  // Mean of both feet, 0.001 .. 50.
  double max_step_m = std::sqrt(60.0 * kWalkRatio_m_min * kMaxSpeed_m_s);
  // By Side: of a foot's step over the mean of both, 0 .. 50.
  std::array<double, 2> step_share{1.0, 1.0};
  double max_step_time_s = kMaxStepTime_s;  // straight ahead; this and the next two 0.05 .. 50
  // At the greatest turn rate, less of it in proportion more: the foot of a slower step would land
  // beside the hips.
  double max_turning_step_time_s = kMaxStepTime_s;
  double turn_step_time_s = kTurnInPlaceStepTime_s;  // of a turn in place and of a closing step
  // While walking, 0 .. 50; equal for all, so walkers stay side by side.
  double max_turn_rate_rad_s = kMaxTurnRate_rad_s;
};
// `GaitLimits: max_speed_m_s is -1, outside [0.001, 50]`.
std::optional<Error> check(const GaitLimits& limits);
// The limits for a leg length (hip to ankle). Lengths scale with the leg, as in the paper. Step
// times scale with its fourth root and speeds with length over time. That is half-way between the
// paper's proportion and equal Froude numbers, at which the legs of a child would move too quickly
// to be tracked smoothly at 240 Hz.
GaitLimits gait_limits(double leg_length_m) noexcept;

// A walk's own gait, on legs of the character's length. The caller fills it; all are above 0.
struct OwnGait {
  double stick = 1.0;                      // the forward deflection that gives it, 0 .. 1
  std::array<double, 2> step_m{1.0, 1.0};  // by Side: from standing heel to landing heel
  double step_time_s = 0.5;                // half a cycle
};
// The limits of a walk with this gait: at `stick` the parameters are exactly those, at others speed
// goes with the stick and the step with its root, so the walk's own walk ratio stays constant. A
// slow walk is slow at every stick: its longest step lasts as many times longer than the adult's as
// its own step. How fast it turns, and its steps while it turns, are the adult's.
GaitLimits gait_limits(double leg_length_m, const OwnGait& own) noexcept;

// The share of maximum speed and maximum stride that fatigue (0 .. 1) leaves.
double vigour(double fatigue) noexcept;

// The parameters that a stick and a style ask for. Only stick.left is read. Forward deflection
// walks, backward deflection walks backwards, sideways deflection turns, alone on the spot.
// Deflections beyond -1 .. 1 count as these. A stick with a number that is not finite gives stride
// lengths and a turn rate that are none: the walk then goes on as it does, and counts them
// (WalkFrame::bad_inputs).
GaitParams gait_params(const Stick& stick, const StyleValues& style,
                       const GaitLimits& limits) noexcept;

// What a deflection means: how far ahead and how quickly round, as in a car; or the direction in
// which to go, seen along `camera_rad` (a heading, 0 along +z, to the left positive).
enum class StickMeans : std::uint8_t { steers, points };

// The stick that steers a walker with this heading to where `stick` points: as far as it is pushed
// and in that direction, at once within 60 degrees of the heading, beyond that with slower steps,
// and from 90 degrees on by a turn on the spot. Only stick.left is read and written; one that is
// not finite stays as it is.
Stick pointed_stick(const Stick& stick, double heading_rad, double camera_rad,
                    const GaitLimits& limits) noexcept;

// Gait parameters that are set in place of what the stick gives, one by one: by the window's
// sliders or by a `gait` command of a script.
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
// The value that it has in `params`.
double value_of(GaitKey key, const GaitParams& params) noexcept;

struct GaitRange {
  double min, max;
};
// The values that have an effect on a character with these limits: as far as its stick, or a style,
// goes.
GaitRange range_of(GaitKey key, const GaitLimits& limits) noexcept;

// Plain, trivially copyable. Arrays are indexed by GaitKey. The caller fills it.
struct GaitOverrides {
  std::array<double, kGaitKeys> value{};  // in GaitKeyInfo::unit, within range_of()
  std::array<bool, kGaitKeys> is_set{};   // whether `value` counts
};
// The parameters of stick and style with the overrides in their place. A value that is not a number
// counts as not set; others are bounded by range_of().
// - Speed replaces the forward deflection: strides as stick, style and fatigue give at that speed,
//   both step times stretched by the same factor until the speed is met, or until a foot would step
//   faster or slower than any stick and style let it (in the sharpest turn: than a stick). Speed 0
//   stands, whatever else is set.
// - The turn rate replaces the sideways deflection, and is bounded as that is. Without speed and
//   with a neutral stick it turns in place.
// - A stride length counts only when stick or speed ask for strides; standing and turning in place
//   do not. Without a speed the step keeps the stick's time.
// - Parameters that are not overridden pass through bit-identically.
GaitParams gait_params(const Stick& stick, const StyleValues& style, const GaitOverrides& overrides,
                       const GaitLimits& limits) noexcept;

}  // namespace gaitpad
