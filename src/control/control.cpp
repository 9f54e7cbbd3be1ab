#include "control/control.h"

#include "base/math.h"

namespace gaitpad {

namespace {

struct BaseStep {
  double length_m, time_s;
};

double finite_or_zero(double x) noexcept {
  return std::isfinite(x) ? std::clamp(x, -1.0, 1.0) : 0.0;
}

// Longest step time. Straight walks may be slow; a turn in place and the closing step of a stop are
// brisk. The share of the turn makes it continuous over the whole stick, neutral (no walk)
// excepted.
double step_time_cap_s(double forward, double sideways, const GaitLimits& limits) noexcept {
  const double turn = std::fabs(sideways);
  if (forward == 0.0) return limits.turn_step_time_s;
  const double share = turn / (turn + forward);
  return mix(limits.max_step_time_s, limits.turn_step_time_s, smoothstep(0.0, 1.0, share));
}

// The walk before any stylization but fatigue. Speed goes with the forward deflection, step length
// with the root of speed: their quotient over cadence is constant.
BaseStep base_step(double forward, double sideways, double fatigue,
                   const GaitLimits& limits) noexcept {
  const double share = vigour(fatigue);
  const double speed_m_s = forward * limits.max_speed_m_s * share;
  const double cap_s = step_time_cap_s(forward, sideways, limits);
  const double length_m = limits.max_step_m * share * std::sqrt(forward);
  if (!(length_m < speed_m_s * cap_s)) return {speed_m_s * cap_s, cap_s};
  return {length_m, length_m / speed_m_s};
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
  limits.turn_step_time_s *= quicker;
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
  // 0 - x, not -x: neutral is +0, one bit pattern.
  params.turn_rate_rad_s = 0.0 - sideways * limits.max_turn_rate_rad_s;
  for (const Side side : {kLeftSide, kRightSide}) {
    const StrideFactors& factors = style.stride[side];
    params.stride[side].length_m = step.length_m * factors.length;
    params.stride[side].time_s = step.time_s / factors.speed;
    params.stride[side].flight_height = factors.flight_height;
  }
  params.hip_sway = style.hip_sway;
  params.hip_bounce = style.hip_bounce;
  params.weight = style.weight;
  params.body = style.body;
  return params;
}

}  // namespace gaitpad
