#include "gaitpad/control.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaitpad/math.h"

namespace gaitpad {
namespace {

struct BaseStep {
  double length_m, time_s;
};

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

bool is_finite(const Stick& stick) noexcept {
  return std::isfinite(stick.left.x) && std::isfinite(stick.left.y);
}

double finite_or_zero(double x) noexcept {
  return std::isfinite(x) ? std::clamp(x, -1.0, 1.0) : 0.0;
}

// Turning in place is quicker than while walking.
double greatest_turn_rad_s(double forward, const GaitLimits& limits) noexcept {
  return limits.max_turn_rate_rad_s *
         mix(kQuickerInPlace, 1.0, smoothstep(0.0, kNotInPlace, forward));
}

// Longest step time of a turn at this share of the greatest rate.
double turning_step_time_s(double share, const GaitLimits& limits) noexcept {
  // At a smaller share of the greatest turn rate any step is short enough.
  constexpr double kStraight = 1e-3;
  return limits.max_turning_step_time_s / std::max(share, kStraight);
}

// Longest step time. Steps of a straight walk may be slow; those of a turn in place and the last
// step before a stop are brisk. It is interpolated by the share of the turn, so it is continuous
// over the whole stick except at neutral, which does not walk.
double step_time_cap_s(double forward, double sideways, const GaitLimits& limits) noexcept {
  const double turn = std::fabs(sideways);
  if (forward == 0.0) return limits.turn_step_time_s;
  const double share = turn / (turn + forward);
  return std::min(mix(limits.max_step_time_s, limits.turn_step_time_s, smoothstep(0.0, 1.0, share)),
                  turning_step_time_s(turn, limits));
}

// The step before stylization, fatigue excepted. Speed is proportional to the forward deflection
// and step length to the root of the speed, so step length over cadence is constant.
BaseStep base_step(double forward, double sideways, double fatigue,
                   const GaitLimits& limits) noexcept {
  const double share = vigour(fatigue);
  const double speed_m_s = forward * limits.max_speed_m_s * share;
  const double cap_s = step_time_cap_s(forward, sideways, limits);
  const double length_m = limits.max_step_m * share * std::sqrt(forward);
  if (!(length_m < speed_m_s * cap_s)) return {speed_m_s * cap_s, cap_s};
  return {length_m, length_m / speed_m_s};
}

// Bounds of overrides, as factors on the stick's greatest values: the longest stride that the legs
// reach at every speed and in every turn, the shortest and the longest step time.
constexpr double kLongestStride = 1.3;
constexpr double kQuickest = 0.5, kSlowest = 2.0;

constexpr std::array<GaitKey, 2> kStrides = {GaitKey::stride_left_m, GaitKey::stride_right_m};
constexpr std::array<GaitKey, 2> kFlights = {GaitKey::flight_left, GaitKey::flight_right};

// The bounded override of this key; nothing if it is not set or not finite.
std::optional<double> given(const GaitOverrides& overrides, GaitKey key,
                            const GaitLimits& limits) noexcept {
  const auto k = static_cast<std::size_t>(key);
  if (!overrides.is_set[k] || !std::isfinite(overrides.value[k])) return std::nullopt;
  const GaitRange range = range_of(key, limits);
  return std::clamp(overrides.value[k], range.min, range.max);
}

// The forward deflection whose speed at this sideways deflection is closest to `speed_m_s`.
double deflection_of(double speed_m_s, double sideways, double fatigue,
                     const GaitLimits& limits) noexcept {
  const double share = speed_m_s / (limits.max_speed_m_s * vigour(fatigue));
  if (!(share < 0.0)) return std::min(1.0, share);
  return std::max(-1.0, share / kBackwardShare - kBackwardSector * std::fabs(sideways));
}

// Longest step time that a given speed may stretch a step to.
double slowest_step_s(double turn_rate_rad_s, const GaitLimits& limits) noexcept {
  const double share = std::min(std::fabs(turn_rate_rad_s) / limits.max_turn_rate_rad_s, 1.0);
  return std::min(kSlowest * limits.max_step_time_s, turning_step_time_s(share, limits));
}

// Scales both step times so that the walk has this speed, within the bounds of a step.
void meet_speed(double speed_m_s, const GaitLimits& limits, GaitParams& params) noexcept {
  std::array<StrideParams, 2>& stride = params.stride;
  const double cycle_s = (stride[0].length_m + stride[1].length_m) / speed_m_s;
  const double stretch = cycle_s / (stride[0].time_s + stride[1].time_s);
  const double quickest_s = kQuickest * limits.max_step_m / limits.max_speed_m_s;
  const double slowest_s = slowest_step_s(params.turn_rate_rad_s, limits);
  for (StrideParams& step : stride)
    step.time_s = std::clamp(step.time_s * stretch, quickest_s, slowest_s);
}

}  // namespace

double vigour(double fatigue) noexcept {
  return 1.0 - (1.0 - kFullFatigueLeaves) * std::clamp(fatigue, 0.0, 1.0);
}

GaitLimits gait_limits(double leg_length_m) noexcept {
  const double ratio = leg_length_m / kReferenceLeg_m;
  const double quicker = std::sqrt(std::sqrt(ratio));
  GaitLimits limits;
  limits.max_speed_m_s *= ratio / quicker;
  limits.max_step_m *= ratio;
  limits.max_step_time_s *= quicker;
  limits.max_turning_step_time_s *= quicker;
  limits.turn_step_time_s *= quicker;
  return limits;
}

GaitLimits gait_limits(double leg_length_m, const OwnGait& own) noexcept {
  GaitLimits limits = gait_limits(leg_length_m);
  const double step_m = 0.5 * (own.step_m[0] + own.step_m[1]), root = std::sqrt(own.stick);
  // An adult's step time at that stick.
  const double adult_s = limits.max_step_m / (limits.max_speed_m_s * root);
  limits.max_speed_m_s = step_m / own.step_time_s / own.stick;
  limits.max_step_m = step_m / root;
  limits.max_step_time_s *= own.step_time_s / adult_s;
  for (const Side side : {kLeftSide, kRightSide})
    limits.step_share[side] = own.step_m[side] / step_m;
  return limits;
}

GaitParams gait_params(const Stick& stick, const StyleValues& style,
                       const GaitLimits& limits) noexcept {
  const double sideways = finite_or_zero(stick.left.x);
  const double ahead = finite_or_zero(stick.left.y);
  const double back = std::max(0.0 - ahead - kBackwardSector * std::fabs(sideways), 0.0);
  const double along = ahead > 0.0 ? ahead : kBackwardShare * back;
  GaitLimits in_direction = limits;
  if (back > 0.0) in_direction.max_step_m *= kBackwardStep;
  const BaseStep step = base_step(along, sideways, style.fatigue, in_direction);

  GaitParams params;
  params.walking = along > 0.0 || sideways != 0.0;
  params.backward = back > 0.0;
  // 0 - x instead of -x: neutral must be +0, because a hash differs between +0 and -0.
  params.turn_rate_rad_s = 0.0 - sideways * greatest_turn_rad_s(std::max(ahead, back), limits);
  for (const Side side : {kLeftSide, kRightSide}) {
    const StrideFactors& factors = style.stride[side];
    params.stride[side].length_m = step.length_m * limits.step_share[side] * factors.length;
    params.stride[side].time_s = step.time_s / factors.speed;
    params.stride[side].flight_height = factors.flight_height;
  }
  params.hip_sway = style.hip_sway;
  params.hip_bounce = style.hip_bounce;
  params.weight = style.weight;
  params.body = style.body;
  if (!is_finite(stick)) {
    params.turn_rate_rad_s = kNoNumber;
    for (StrideParams& stride : params.stride) stride.length_m = kNoNumber;
  }
  return params;
}

Stick pointed_stick(const Stick& stick, double heading_rad, double camera_rad,
                    const GaitLimits& limits) noexcept {
  constexpr double kTurns_per_s = 3.0;  // turn rate per radian of remaining angle
  Stick steers = stick;
  if (!is_finite(stick)) return steers;
  const double right = finite_or_zero(stick.left.x), ahead = finite_or_zero(stick.left.y);
  const double pushed = std::min(std::sqrt(right * right + ahead * ahead), 1.0);
  steers.left = vec2(0.0);
  if (pushed == 0.0) return steers;
  const double aim = camera_rad + gaitpad::atan2(0.0 - right, ahead) - heading_rad;
  const double off = aim - 2.0 * kPi * std::floor(aim / (2.0 * kPi) + 0.5);
  const double along = std::max(0.0, sin_cos(off).cos);
  steers.left.y = pushed * along * along;
  steers.left.x =
      std::clamp(0.0 - kTurns_per_s * off / greatest_turn_rad_s(steers.left.y, limits), -1.0, 1.0);
  return steers;
}

GaitRange range_of(GaitKey key, const GaitLimits& limits) noexcept {
  const GaitKeyInfo& info = info_of(key);
  switch (key) {
    case GaitKey::speed_m_s:
      return {std::max(info.min, -kBackwardShare * limits.max_speed_m_s),
              std::min(info.max, limits.max_speed_m_s)};
    case GaitKey::stride_left_m:
    case GaitKey::stride_right_m:
      return {info.min, std::min(info.max, kLongestStride * limits.max_step_m)};
    case GaitKey::turn_rate_rad_s:
      return {std::max(info.min, -kQuickerInPlace * limits.max_turn_rate_rad_s),
              std::min(info.max, kQuickerInPlace * limits.max_turn_rate_rad_s)};
    default:
      return {info.min, info.max};
  }
}

GaitParams gait_params(const Stick& stick, const StyleValues& style, const GaitOverrides& overrides,
                       const GaitLimits& limits) noexcept {
  const auto& is_set = overrides.is_set;
  if (std::find(is_set.begin(), is_set.end(), true) == is_set.end())
    return gait_params(stick, style, limits);
  const auto speed_m_s = given(overrides, GaitKey::speed_m_s, limits);
  const auto turn_rate_rad_s = given(overrides, GaitKey::turn_rate_rad_s, limits);
  Stick in_force = stick;  // the stick that would have the effect of the overrides
  if (turn_rate_rad_s) {
    const double forward = speed_m_s ? deflection_of(*speed_m_s, 0.0, style.fatigue, limits)
                                     : finite_or_zero(stick.left.y);
    in_force.left.x = 0.0 - *turn_rate_rad_s / greatest_turn_rad_s(std::fabs(forward), limits);
  }
  if (speed_m_s)
    in_force.left.y = deflection_of(*speed_m_s, in_force.left.x, style.fatigue, limits);
  if (speed_m_s && *speed_m_s == 0.0) in_force = Stick{};

  GaitParams params = gait_params(in_force, style, limits);
  if (turn_rate_rad_s && params.walking) {
    const double greatest = greatest_turn_rad_s(std::fabs(in_force.left.y), limits);
    params.turn_rate_rad_s = std::clamp(*turn_rate_rad_s, -greatest, greatest) + 0.0;
  }
  const bool asks_for_strides =
      params.backward || (std::isfinite(in_force.left.y) && in_force.left.y > 0.0);
  for (const Side side : {kLeftSide, kRightSide}) {
    StrideParams& step = params.stride[side];
    if (asks_for_strides)
      step.length_m = given(overrides, kStrides[side], limits).value_or(step.length_m);
    step.flight_height = given(overrides, kFlights[side], limits).value_or(step.flight_height);
  }
  if (speed_m_s && asks_for_strides) meet_speed(std::fabs(*speed_m_s), limits, params);
  params.hip_sway = given(overrides, GaitKey::hip_sway, limits).value_or(params.hip_sway);
  params.hip_bounce = given(overrides, GaitKey::hip_bounce, limits).value_or(params.hip_bounce);
  return params;
}

}  // namespace gaitpad
