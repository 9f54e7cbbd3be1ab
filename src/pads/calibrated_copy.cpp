#include "pads/calibrated_copy.h"

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

// The operation that makes a whole control of this field alone; null: the field is no control, or
// only a part of one.
const AxisOp* whole_control(const EvdevField& field, const PadLayout& pad) {
  for (const ReportLayout& report : pad.reports) {
    for (const AxisOp& op : report.axes) {
      const bool is_it = op.bits.bit_offset == field.bit_offset && op.side == 0 &&
                         op.bits.min == field.min && op.bits.max == field.max;
      if (is_it && ((report.summed >> op.axis) & 1u) == 0) return &op;
    }
  }
  return nullptr;
}

bool is_trigger(int control) { return control == kLeftTrigger || control == kRightTrigger; }

double position_of(int control, const VirtualPadState& state) {
  switch (control) {
    case kLeftX:
      return state.stick.left.x;
    case kLeftY:
      return state.stick.left.y;
    case kRightX:
      return state.stick.right.x;
    case kRightY:
      return state.stick.right.y;
    default:
      return state.trigger[control == kLeftTrigger ? 0 : 1];
  }
}

std::int32_t counts(double share, const VirtualPadAxis& axis) {
  return static_cast<std::int32_t>(
      std::lround(axis.min + share * (static_cast<double>(axis.max) - axis.min)));
}

}  // namespace

CalibratedCopy::CalibratedCopy(const EvdevLayout& node, const PadLayout& pad) {
  for (const EvdevField& field : node.fields) {
    if (field.code.type == EvdevType::key) {
      keys_.push_back(field.code.code);
    } else if (field.is_hat) {
      const std::uint16_t x = field.code.code;
      axes_.push_back({{x, -1, 1}});
      axes_.push_back({{static_cast<std::uint16_t>(x + 1), -1, 1}});
    } else if (const AxisOp* op = whole_control(field, pad); op != nullptr) {
      VirtualPadAxis shown = {field.code.code, -kFullStick, kFullStick};
      if (is_trigger(op->axis)) shown = {field.code.code, field.min, field.max};
      axes_.push_back({shown, op->axis, op->reversed});
    } else {
      axes_.push_back({{field.code.code, field.min, field.max}});
    }
  }
}

std::vector<VirtualPadAxis> CalibratedCopy::axes() const {
  std::vector<VirtualPadAxis> shown;
  for (const Axis& axis : axes_) shown.push_back(axis.shown);
  return shown;
}

std::vector<std::uint16_t> CalibratedCopy::keys() const { return keys_; }

std::vector<VirtualPadEvent> CalibratedCopy::events(const EvdevState& raw,
                                                    const VirtualPadState& calibrated) {
  EvdevState next = raw;
  for (const Axis& axis : axes_) {
    if (axis.control < 0) continue;
    const double position = position_of(axis.control, calibrated);
    std::int32_t& value = next.axis[axis.shown.code];
    if (is_trigger(axis.control)) {
      value = counts(axis.reversed ? 1.0 - position : position, axis.shown);
    } else {
      value = static_cast<std::int32_t>(
          std::lround((axis.reversed ? -position : position) * kFullStick));
    }
  }
  return change_to(next);
}

std::vector<VirtualPadEvent> CalibratedCopy::rest() {
  EvdevState raw = sent_;
  raw.keys.reset();
  for (const Axis& axis : axes_) {
    const bool is_hat = axis.shown.code >= evdev::kAbsHat0X && axis.shown.code <= evdev::kAbsHat3Y;
    if (is_hat) raw.axis[axis.shown.code] = 0;
  }
  return events(raw, {});
}

std::vector<VirtualPadEvent> CalibratedCopy::change_to(const EvdevState& next) {
  std::vector<VirtualPadEvent> events;
  for (const Axis& axis : axes_) {
    const std::uint16_t code = axis.shown.code;
    if (next.axis[code] != sent_.axis[code])
      events.push_back({static_cast<std::uint16_t>(EvdevType::absolute), code, next.axis[code]});
  }
  for (const std::uint16_t code : keys_) {
    if (next.keys[code] != sent_.keys[code])
      events.push_back({static_cast<std::uint16_t>(EvdevType::key), code, next.keys[code] ? 1 : 0});
  }
  sent_ = next;
  return events;
}

}  // namespace gaitpad
