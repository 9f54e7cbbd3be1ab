// Converts the stick and the stylization state to gait parameters (Meredith & Maddock 2005, section
// 3.1). All functions are stateless, allocate nothing and may be called in every tick; the walk
// smooths what changes between ticks.
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

// Full speed of an adult with a leg of 0.84 m. The walk ratio, step length over cadence, is
// constant over speed (adults: 0.52 to 0.64 cm per step/min): length = sqrt(60 s * ratio * speed).
inline constexpr double kMaxSpeed_m_s = 1.5;
inline constexpr double kWalkRatio_m_min = 0.0058;  // metres per step a minute
// Longest step time; slower walks shorten the step instead.
inline constexpr double kMaxStepTime_s = 1.1;
inline constexpr double kTurnInPlaceStepTime_s = 0.48;
inline constexpr double kMaxTurnRate_rad_s = 1.0;
// A turn on the spot is faster by kQuickerInPlace; the factor falls to 1 at the forward deflection
// kNotInPlace.
inline constexpr double kQuickerInPlace = 1.65, kNotInPlace = 0.15;
// Walking backwards: speed as a share of the forward speed, and step length as a share of that of a
// forward step at the same speed.
inline constexpr double kBackwardShare = 0.45;
inline constexpr double kBackwardStep = 0.8;
// Backward deflection counts only beyond this share of the sideways deflection (10 degrees behind
// the side), so that a thumb that turns on the spot does not cause steps back and forth.
inline constexpr double kBackwardSector = 0.176;
// Share of maximum speed and stride that fatigue 1 leaves.
inline constexpr double kFullFatigueLeaves = 0.4;

// The gait of a character at full deflection. gait_limits() fills it; a program may change it.
struct GaitLimits {
  double max_speed_m_s = kMaxSpeed_m_s;  // greatest speed straight ahead, 0.001 .. 50
  // Greatest step length, the mean of both feet, 0.001 .. 50.
  double max_step_m = std::sqrt(60.0 * kWalkRatio_m_min * kMaxSpeed_m_s);
  // Each foot's step length over the mean of both, by Side, 0 .. 50.
  std::array<double, 2> step_share{1.0, 1.0};
  // Longest step time straight ahead; this time and the next two are 0.05 .. 50.
  double max_step_time_s = kMaxStepTime_s;
  // Longest step time at the greatest turn rate; at the share s of that rate it is divided by s. In
  // a turn the foot of a slower step would land beside the hips.
  double max_turning_step_time_s = kMaxStepTime_s;
  // Step time of a turn in place and of a closing step.
  double turn_step_time_s = kTurnInPlaceStepTime_s;
  // Greatest turn rate while walking, 0 .. 50; equal for all characters, so that they stay side by
  // side.
  double max_turn_rate_rad_s = kMaxTurnRate_rad_s;
};
// Errors read `GaitLimits: max_speed_m_s is -1, outside [0.001, 50]`.
std::optional<Error> check(const GaitLimits& limits);
// The limits for a leg length (hip to ankle). Lengths scale with the leg, as in the paper. Step
// times scale with its fourth root and speeds with length over time. That is half-way between the
// paper's proportion and equal Froude numbers, at which the legs of a child would move too quickly
// to be tracked smoothly at 240 Hz.
GaitLimits gait_limits(double leg_length_m) noexcept;

// The gait that a motion itself has, on legs of the character's length. The caller fills it; all
// numbers are above 0.
struct OwnGait {
  double stick = 1.0;                      // forward deflection that gives this gait, 0 .. 1
  std::array<double, 2> step_m{1.0, 1.0};  // from standing heel to landing heel, by Side
  double step_time_s = 0.5;                // half the duration of a cycle
};
// The limits of a walk with this gait. At the deflection own.stick the parameters are exactly that
// gait; elsewhere speed is proportional to the deflection and step length to its square root, so
// the walk ratio stays constant. A slow walk is slow at every deflection: its longest step time is
// the adult's times the ratio of its own step time to the adult's. Turn rate and step times in
// turns are the adult's.
GaitLimits gait_limits(double leg_length_m, const OwnGait& own) noexcept;

// The share of maximum speed and maximum stride that fatigue (0 .. 1) leaves.
double vigour(double fatigue) noexcept;

// The parameters that a stick and a style ask for. Only stick.left is read. Forward deflection
// walks, backward deflection walks backwards, sideways deflection turns; without any other
// deflection it turns on the spot. Deflections beyond -1 .. 1 count as -1 and 1. A stick with a
// number that is not finite gives stride lengths and a turn rate that are not finite either: the
// walk then goes on as it does, and counts them (WalkFrame::bad_inputs).
GaitParams gait_params(const Stick& stick, const StyleValues& style,
                       const GaitLimits& limits) noexcept;

// The meaning of a deflection. steers: forward speed and turn rate, as in a car. points: the
// direction to walk in, seen along `camera_rad` (a heading, 0 along +z, positive to the left).
enum class StickMeans : std::uint8_t { steers, points };

// The stick that turns a walker with this heading into the direction in which `stick` points. The
// forward deflection is the push times cos^2 of the angle still to turn (0 beyond 90 degrees: a
// turn on the spot), the turn rate 3/s times that angle. Only stick.left is read and written; a
// stick that is not finite stays as it is.
Stick pointed_stick(const Stick& stick, double heading_rad, double camera_rad,
                    const GaitLimits& limits) noexcept;

// Gait parameters that are set in place of what the stick gives, one by one: by the window's
// sliders or by a `gait` command of a script.
enum class GaitKey : std::uint8_t {
  speed_m_s,  // (left + right step) / cycle time; negative backwards
  stride_left_m,
  stride_right_m,
  flight_left,  // factor on the height of the left foot's flight
  flight_right,
  turn_rate_rad_s,
  hip_sway,
  hip_bounce,
};
inline constexpr int kGaitKeys = 8;

struct GaitKeyInfo {
  std::string_view name;  // the name in a command
  std::string_view unit;  // "m", "m/s", "rad/s"; "x" for a factor
  double min, max;        // bounds of a command; range_of() gives narrower ones
};
const GaitKeyInfo& info_of(GaitKey key) noexcept;
std::optional<GaitKey> gait_key(std::string_view name) noexcept;
// The parameter's value in `params`.
double value_of(GaitKey key, const GaitParams& params) noexcept;

struct GaitRange {
  double min, max;
};
// The range of values that have an effect on a character with these limits: what its stick or a
// style can ask for.
GaitRange range_of(GaitKey key, const GaitLimits& limits) noexcept;

// Values that replace parameters. Plain, trivially copyable. Arrays are indexed by GaitKey. The
// caller fills it.
struct GaitOverrides {
  std::array<double, kGaitKeys> value{};  // in the unit of GaitKeyInfo, within range_of()
  std::array<bool, kGaitKeys> is_set{};   // whether `value` replaces the parameter
};
// The parameters of stick and style, of which the overrides replace some. A value that is not a
// number counts as not set; others are bounded by range_of().
// - Speed replaces the forward deflection: strides as stick, style and fatigue give at that speed,
//   both step times stretched by the same factor until the speed is met, or until a foot would step
//   faster or slower than any stick and style let it (in the sharpest turn: than a stick). Speed 0
//   stands, whatever else is set.
// - The turn rate replaces the sideways deflection, and has the same bounds. Without speed and
//   with a neutral stick it turns in place.
// - A stride length counts only when stick or speed ask for strides; standing and turning in place
//   do not. Without a speed the step keeps the stick's time.
// - Parameters that are not overridden pass through bit-identically.
GaitParams gait_params(const Stick& stick, const StyleValues& style, const GaitOverrides& overrides,
                       const GaitLimits& limits) noexcept;

}  // namespace gaitpad
