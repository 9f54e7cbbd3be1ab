#include "gaitpad/calibration.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/ranges.h"

namespace gaitpad {

namespace {

constexpr PadAxis kStickAxes[] = {kLeftX, kLeftY, kRightX, kRightY};

double centred(const AxisCalibration& axis, double raw) noexcept {
  if (!std::isfinite(raw)) return 0.0;
  const double offset = std::clamp(raw, -1.0, 1.0) - axis.centre;
  return offset >= 0.0 ? offset / (axis.max - axis.centre) : offset / (axis.centre - axis.min);
}

// Deflection >= 0 to response: 0 up to `inner`, 1 from `outer` on, between them
// t + curve (t^3 - t), where t grows evenly from 0 to 1.
double response(double deflection, double inner, double outer, double curve) noexcept {
  if (deflection <= inner) return 0.0;
  if (deflection >= outer) return 1.0;
  const double t = std::min((deflection - inner) / (outer - inner), 1.0);
  // The same in a form that rounding cannot take above 1.
  return t * (1.0 - curve * (1.0 - t * t));
}

vec2 radial(const StickCalibration& c, const vec2& p) noexcept {
  const double length = std::sqrt(p.x * p.x + p.y * p.y);
  const double r = response(length, c.inner, c.outer, c.curve);
  return r > 0.0 ? vec2(p.x / length * r, p.y / length * r) : vec2(0.0);
}

vec2 axial(const StickCalibration& c, const vec2& p) noexcept {
  const vec2 q(std::copysign(response(std::fabs(p.x), c.inner, c.outer, c.curve), p.x),
               std::copysign(response(std::fabs(p.y), c.inner, c.outer, c.curve), p.y));
  // A square gate has corners beyond the unit disc.
  const double length = std::sqrt(q.x * q.x + q.y * q.y);
  return length > 1.0 ? vec2(q.x / length, q.y / length) : q;
}

double outside_zone(double x, double zone) noexcept {
  const double beyond = std::fabs(x) - zone;
  return beyond > 0.0 ? std::copysign(std::min(beyond / (1.0 - zone), 1.0), x) : 0.0;
}

}  // namespace

vec2 in_frame(const StickFrame& frame, const vec2& raw) noexcept {
  const auto along = [&raw](RawDirection direction) {
    switch (direction) {
      case RawDirection::plus_x:
        return raw.x;
      case RawDirection::minus_x:
        return -raw.x;
      case RawDirection::plus_y:
        return raw.y;
      case RawDirection::minus_y:
        return -raw.y;
    }
    return 0.0;
  };
  return {along(frame.right), along(frame.forward)};
}

vec2 stick_position(const StickCalibration& c, const vec2& raw) noexcept {
  const vec2 turned = in_frame(c.frame, raw);
  const vec2 p(centred(c.x, turned.x), centred(c.y, turned.y));
  // Adding zero turns -0 into 0, so that neutral has one bit pattern.
  if (c.shape == ZoneShape::axial) return axial(c, p) + vec2(0.0);
  const vec2 q = radial(c, p);
  if (c.shape == ZoneShape::radial) return q + vec2(0.0);
  return vec2(outside_zone(q.x, c.sideways), q.y) + vec2(0.0);
}

Stick stick_position(const Calibration& calibration, const PadState& pad) noexcept {
  return {stick_position(calibration.left, vec2(pad.axis[kLeftX], pad.axis[kLeftY])),
          stick_position(calibration.right, vec2(pad.axis[kRightX], pad.axis[kRightY]))};
}

void JumpFilter::take(const PadState& state) noexcept {
  last_[0] = last_[1];
  last_[1] = last_[2];
  for (std::size_t i = 0; i < 4; ++i) last_[2][i] = state.axis[kStickAxes[i]];
  if (!is_begun_) settle();
  is_begun_ = true;
}

PadState JumpFilter::filtered(const Calibration& calibration,
                              const PadState& state) const noexcept {
  PadState filtered = state;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(i < 2 ? calibration.left : calibration.right).filters_jumps) continue;
    const double a = last_[0][i], b = last_[1][i], c = last_[2][i];
    filtered.axis[kStickAxes[i]] = std::max(std::min(a, b), std::min(std::max(a, b), c));
  }
  return filtered;
}

double trigger_position(const TriggerCalibration& c, double raw) noexcept {
  if (!(raw > c.released)) return 0.0;
  return std::min((raw - c.released) / (c.pressed - c.released), 1.0);
}

namespace {

// Checks that `high` exceeds `low` by `least` to `most`.
std::optional<Error> span_problem(const std::string& what, double low, double high, double least,
                                  double most) {
  return range_problem(what, high - low, least, most);
}

std::optional<Error> axis_problem(const std::string& what, const AxisCalibration& axis) {
  if (auto problem = range_problem(what + ".min", axis.min, -1.0, 1.0)) return problem;
  if (auto problem = range_problem(what + ".centre", axis.centre, -1.0, 1.0)) return problem;
  if (auto problem = range_problem(what + ".max", axis.max, -1.0, 1.0)) return problem;
  if (auto problem =
          span_problem(what + ".centre - min", axis.min, axis.centre, kLeastHalfRange, 2.0))
    return problem;
  return span_problem(what + ".max - centre", axis.centre, axis.max, kLeastHalfRange, 2.0);
}

std::optional<Error> stick_problem(const std::string& what, const StickCalibration& c) {
  if (auto problem = choice_problem(what + "frame.right", c.frame.right, RawDirection::minus_y))
    return problem;
  if (auto problem = choice_problem(what + "frame.forward", c.frame.forward, RawDirection::minus_y))
    return problem;
  if (is_along_x(c.frame.right) == is_along_x(c.frame.forward))
    return Error{what + "frame: right and forward lie along one axis"};
  if (auto problem = choice_problem(what + "shape", c.shape, ZoneShape::both)) return problem;
  if (auto problem = axis_problem(what + "x", c.x)) return problem;
  if (auto problem = axis_problem(what + "y", c.y)) return problem;
  if (auto problem = range_problem(what + "inner", c.inner, 0.0, 0.9)) return problem;
  if (auto problem = range_problem(what + "outer", c.outer, 0.1, 1.0)) return problem;
  if (auto problem = span_problem(what + "outer - inner", c.inner, c.outer, kLeastZoneSpan, 1.0))
    return problem;
  if (auto problem = range_problem(what + "sideways", c.sideways, 0.0, 0.5)) return problem;
  return range_problem(what + "curve", c.curve, 0.0, 1.0);
}

std::optional<Error> trigger_problem(const std::string& what, const TriggerCalibration& c) {
  if (auto problem = range_problem(what + ".released", c.released, 0.0, 1.0)) return problem;
  if (auto problem = range_problem(what + ".pressed", c.pressed, 0.0, 1.0)) return problem;
  return span_problem(what + ".pressed - released", c.released, c.pressed, kLeastTriggerTravel,
                      1.0);
}

}  // namespace

std::optional<Error> check(const Calibration& c) {
  if (auto problem = stick_problem("Calibration: left.", c.left)) return problem;
  if (auto problem = stick_problem("Calibration: right.", c.right)) return problem;
  if (auto problem = trigger_problem("Calibration: left_trigger", c.left_trigger)) return problem;
  return trigger_problem("Calibration: right_trigger", c.right_trigger);
}

std::optional<Error> check(const CalibrationFile& file) {
  if (auto problem = check(file.calibration)) return problem;
  if (!file.gyro_bias_rad_s) return std::nullopt;
  for (std::size_t axis = 0; axis < file.gyro_bias_rad_s->size(); ++axis) {
    if (auto problem =
            range_problem("CalibrationFile: gyro_bias_rad_s[" + std::to_string(axis) + "]",
                          (*file.gyro_bias_rad_s)[axis], -kMostGyroBias_rad_s, kMostGyroBias_rad_s))
      return problem;
  }
  return std::nullopt;
}

Calibration canonical(const Calibration& calibration) noexcept {
  Calibration c = calibration;
  for (StickCalibration* stick : {&c.left, &c.right}) {
    for (AxisCalibration* axis : {&stick->x, &stick->y}) {
      for (double* number : {&axis->min, &axis->centre, &axis->max}) *number += 0.0;
    }
    for (double* number : {&stick->inner, &stick->outer, &stick->sideways, &stick->curve})
      *number += 0.0;
  }
  for (TriggerCalibration* trigger : {&c.left_trigger, &c.right_trigger}) {
    trigger->released += 0.0;
    trigger->pressed += 0.0;
  }
  return c;
}

}  // namespace gaitpad
