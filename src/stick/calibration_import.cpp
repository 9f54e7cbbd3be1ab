#include "stick/calibration_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "hid/evdev_codes.h"
#include "stick/import_text.h"

namespace gaitpad {

namespace {

constexpr double kLeastHalfRange = 0.1;  // raw, as calibration files have it
constexpr double kLeastInner = 0.05, kMostInner = 0.9;
constexpr double kLeastTriggerWay = 0.1;
constexpr unsigned kCodesByKernel = 0x8000;

// One axis of the pad in counts, from any of the tools.
struct Claim {
  std::string axis;  // for sentences
  double min = 0.0, low = 0.0, high = 0.0, max = 0.0;
  bool is_zone_told = false;  // from low to high
  bool reversed = false;
};

bool is_hat_field(const Field& f) {
  return f.usage == usage::kHatSwitch || (f.usage >= usage::kDpadUp && f.usage <= usage::kDpadLeft);
}

// The axes of the pad's event node: code to field, none for those of a hat.
using NodeAxes = std::map<std::uint16_t, const Field*>;
NodeAxes node_axes(const ReportDescriptor& d, const DeviceInfo& device) {
  NodeAxes axes;
  const auto codes = evdev_codes(d, stated_by(device.driver));
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!codes[i] || codes[i]->type != EvdevType::absolute) continue;
    const Field& f = d.fields[i];
    if (!is_hat_field(f)) {
      axes[codes[i]->code] = &f;
      continue;
    }
    axes[codes[i]->code] = nullptr;
    axes[static_cast<std::uint16_t>(codes[i]->code + 1)] = nullptr;
  }
  return axes;
}

// Where a whole field is an axis of the pad.
std::vector<AxisOp> ops_of(const PadLayout& layout, const Field& f) {
  std::vector<AxisOp> ops;
  for (const ReportLayout& report : layout.reports) {
    if (!report.exact_sizes.empty() || report.report_id != f.report_id) continue;
    for (const AxisOp& op : report.axes) {
      const bool is_whole = op.bits.min == f.logical_min && op.bits.max == f.logical_max;
      if (op.bits.bit_offset != f.bit_offset || op.bits.bit_size != f.bit_size) continue;
      if (is_whole && op.side == 0 && op.bits.max > op.bits.min) ops.push_back(op);
    }
  }
  return ops;
}

double raw_of(const AxisOp& op, double count) {
  const auto low = static_cast<double>(op.bits.min), high = static_cast<double>(op.bits.max);
  const double raw = std::clamp((2.0 * count - low - high) / (high - low), -1.0, 1.0);
  return op.reversed ? 0.0 - raw : raw;
}

// What the claims have said of the sticks so far.
struct Sticks {
  Calibration calibration;
  std::array<double, 2> inner{};  // left, right; 0: not told
  bool is_any_told = false;
};

std::string apply_to_trigger(const Claim& claim, const AxisOp& op, Sticks& sticks) {
  const double a = (raw_of(op, claim.min) + 1.0) / 2.0, b = (raw_of(op, claim.max) + 1.0) / 2.0;
  if (std::fabs(b - a) < kLeastTriggerWay) {
    return fmt::format("{}: {:g} to {:g} is next to nothing of the pad's {} to {}", claim.axis,
                       claim.min, claim.max, op.bits.min, op.bits.max);
  }
  Calibration& c = sticks.calibration;
  (op.axis == kLeftTrigger ? c.left_trigger : c.right_trigger) = {std::min(a, b), std::max(a, b)};
  return {};
}

std::string apply_to_stick(const Claim& claim, const AxisOp& op, Sticks& sticks) {
  const bool is_left = op.axis == kLeftX || op.axis == kLeftY;
  const bool is_x = op.axis == kLeftX || op.axis == kRightX;
  const double ends[2] = {raw_of(op, claim.min), raw_of(op, claim.max)};
  const double zone[2] = {raw_of(op, claim.low), raw_of(op, claim.high)};
  AxisCalibration axis;
  axis.min = std::min(ends[0], ends[1]);
  axis.max = std::max(ends[0], ends[1]);
  axis.centre = (zone[0] + zone[1]) / 2.0;
  const double nearest = std::min(axis.max - axis.centre, axis.centre - axis.min);
  if (nearest < kLeastHalfRange) {
    return fmt::format("{}: {:g} to {:g} about {:g} is next to nothing of the pad's {} to {}",
                       claim.axis, claim.min, claim.max, (claim.low + claim.high) / 2.0,
                       op.bits.min, op.bits.max);
  }
  if (claim.is_zone_told) {
    double& inner = sticks.inner[is_left ? 0 : 1];
    inner = std::max(inner, std::max(std::fabs(zone[1] - zone[0]) / 2.0 / nearest, kLeastInner));
    if (inner > kMostInner) {
      return fmt::format("{}: hardly anything is left beside its zone from {:g} to {:g}",
                         claim.axis, claim.low, claim.high);
    }
  }
  StickCalibration& stick = is_left ? sticks.calibration.left : sticks.calibration.right;
  if (claim.reversed) {
    axis = {0.0 - axis.max, 0.0 - axis.centre, 0.0 - axis.min};
    (is_x ? stick.frame.right : stick.frame.forward) =
        is_x ? RawDirection::minus_x : RawDirection::minus_y;
  }
  (is_x ? stick.x : stick.y) = axis;
  sticks.is_any_told = true;
  return {};
}

// Empty: it is done, or the pad has no use for that axis.
std::string apply(const Claim& claim, const PadLayout& layout, const Field& field, Sticks& sticks) {
  for (const AxisOp& op : ops_of(layout, field)) {
    const auto low = static_cast<double>(op.bits.min), high = static_cast<double>(op.bits.max);
    if (claim.high < low || claim.low > high) {
      return fmt::format("{}: its centre {:g} is outside of the pad's {} to {}", claim.axis,
                         (claim.low + claim.high) / 2.0, op.bits.min, op.bits.max);
    }
    const bool is_trigger = op.axis == kLeftTrigger || op.axis == kRightTrigger;
    std::string problem =
        is_trigger ? apply_to_trigger(claim, op, sticks) : apply_to_stick(claim, op, sticks);
    if (!problem.empty()) return problem;
  }
  return {};
}

Result<Sticks> apply_jscal(const JscalText& jscal, const std::string& source, const NodeAxes& axes,
                           const PadLayout& layout) {
  const auto where = [&](const std::string& cause) {
    return Error{fmt::format("{}:{}: {}", source, jscal.line, cause)};
  };
  if (jscal.axes.size() != axes.size()) {
    return where(fmt::format("jscal: {} axes, the pad has {}", jscal.axes.size(), axes.size()));
  }
  std::vector<std::uint16_t> codes = jscal.codes;
  if (codes.empty()) {
    for (const auto& axis : axes) codes.push_back(axis.first);
  }
  if (codes.size() != axes.size()) {
    return where(fmt::format("jscal: codes of {} axes, there are {}", codes.size(), axes.size()));
  }
  Sticks sticks;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const JscalAxis& told = jscal.axes[i];
    const auto found = axes.find(codes[i]);
    if (!told.is_corrected || found == axes.end() || found->second == nullptr) continue;
    const Claim claim{fmt::format("jscal: axis {}", i),
                      told.min,
                      told.low,
                      told.high,
                      told.max,
                      true,
                      told.reversed};
    const std::string problem = apply(claim, layout, *found->second, sticks);
    if (!problem.empty()) return where(problem);
  }
  if (!sticks.is_any_told) return where("jscal: no axis of a stick is corrected");
  // It is full where jscal is.
  sticks.calibration.left.outer = sticks.calibration.right.outer = 1.0;
  return sticks;
}

// The middle of the range counts as the centre: the kernel knows of no other.
Result<Sticks> apply_ranges(const AbsInfos& infos, const std::string& source, const NodeAxes& axes,
                            const PadLayout& layout) {
  Sticks sticks;
  for (const auto& [code, info] : infos) {
    const auto found = axes.find(code);
    if (found == axes.end() || found->second == nullptr) continue;
    const Field& field = *found->second;
    const double min = info.min ? *info.min : static_cast<double>(field.logical_min);
    const double max = info.max ? *info.max : static_cast<double>(field.logical_max);
    const double flat = std::max(info.flat.value_or(0), 0), middle = (min + max) / 2.0;
    const Claim claim{fmt::format("axis {:02x}", code),
                      min,
                      middle - flat,
                      middle + flat,
                      max,
                      flat > 0.0,
                      false};
    const auto where = [&source, line = info.line](const std::string& cause) {
      return Error{fmt::format("{}:{}: {}", source, line, cause)};
    };
    if (!(min < max)) return where(fmt::format("{}: {} to {} is no range", claim.axis, min, max));
    // Counts of another scale say nothing about this pad's.
    const auto width = static_cast<double>(field.logical_max - field.logical_min);
    if (max - min > width * 1.01 + 1.0) {
      return where(fmt::format("{}: {} to {} is more than the pad's {} to {}", claim.axis, min, max,
                               field.logical_min, field.logical_max));
    }
    const std::string problem = apply(claim, layout, field, sticks);
    if (!problem.empty()) return where(problem);
  }
  if (!sticks.is_any_told) return Error{source + ": no axis of a stick of this pad"};
  return sticks;
}

CalibrationFile file_of(const Sticks& sticks) {
  CalibrationFile file;
  file.calibration = sticks.calibration;
  if (sticks.inner[0] > 0.0) file.calibration.left.inner = sticks.inner[0];
  if (sticks.inner[1] > 0.0) file.calibration.right.inner = sticks.inner[1];
  return file;
}

std::string ids_text(unsigned vendor, unsigned product) {
  return fmt::format("{:04x}:{:04x}", vendor, product);
}

// A word of a GUID, least significant byte first; the text is known to be hexadecimal.
unsigned guid_word(const std::string& line, std::size_t byte) {
  const auto value = [&](std::size_t at) {
    return static_cast<unsigned>(std::stoul(line.substr(2 * at, 2), nullptr, 16));
  };
  return value(byte) | value(byte + 1) << 8;
}

// Why a line is none of the pad's; empty: it is one.
std::string mapping_problem(const std::string& line, const DeviceInfo& device) {
  if (!is_one_line(line)) return "SDL mapping: it holds a control character";
  const unsigned vendor = guid_word(line, 4), product = guid_word(line, 8);
  if (guid_word(line, 6) != 0 || guid_word(line, 10) != 0) return {};  // a name, no ids
  if (vendor != 0 && (vendor != device.vendor || product != device.product)) {
    return fmt::format("SDL mapping: it is for {}, the pad is {}", ids_text(vendor, product),
                       ids_text(device.vendor, device.product));
  }
  const auto platform = line.find(",platform:");
  if (platform != std::string::npos && line.compare(platform, 15, ",platform:Linux") != 0) {
    return "SDL mapping: it is for another platform, which counts otherwise";
  }
  const bool is_node = stated_by(device.driver) == StatedBy::evdev_driver;
  const unsigned mark = is_node ? device.version & kCodesByKernel : 0;
  if (vendor != 0 && (guid_word(line, 12) & kCodesByKernel) != mark) {
    return mark == 0 ? "SDL mapping: it counts what the kernel's driver for that pad numbers; give "
                       "its event node (/dev/input/event...)"
                     : "SDL mapping: it counts the pad without the kernel's driver for it";
  }
  return {};
}

Result<CalibrationFile> apply_mapping(const std::vector<MappingLine>& lines,
                                      const std::string& source, const DeviceInfo& device,
                                      const PadLayout& layout) {
  std::string problem;
  const MappingLine* chosen = nullptr;
  int problem_line = 0;
  for (const MappingLine& l : lines) {
    std::string cause = mapping_problem(l.text, device);
    if (cause.empty()) {
      const bool is_bus = guid_word(l.text, 0) == static_cast<unsigned>(device.bus);
      if (chosen == nullptr || is_bus) chosen = &l;
      if (is_bus) break;
    } else if (problem.empty()) {
      problem = std::move(cause);
      problem_line = l.line;
    }
  }
  if (chosen == nullptr && lines.size() > 1) {
    return Error{fmt::format("{}: none of its {} SDL mappings is for {}", source, lines.size(),
                             ids_text(device.vendor, device.product))};
  }
  if (chosen == nullptr) return Error{fmt::format("{}:{}: {}", source, problem_line, problem)};
  const auto where = [&](const std::string& cause) {
    return Error{fmt::format("{}:{}: {}", source, chosen->line, cause)};
  };
  const auto controls = sdl_controls(chosen->text, layout.descriptor, device.driver);
  if (!controls) return where(controls.error().message);
  const auto is_named = [](const auto& sources) { return sources && !sources->empty(); };
  if (std::none_of(controls->axes.begin(), controls->axes.end(), is_named) &&
      std::none_of(controls->buttons.begin(), controls->buttons.end(), is_named)) {
    return where("SDL mapping: it names no control that the pad has");
  }
  CalibrationFile file;
  file.mapping = chosen->text;
  return file;
}

}  // namespace

Result<CalibrationFile> calibration_import(std::string_view text, const std::string& source,
                                           const DeviceInfo& device, const PadLayout& layout) {
  const auto told = import_text(text, source);
  if (!told) return told.error();
  if (!told->mappings.empty()) return apply_mapping(told->mappings, source, device, layout);
  const std::string problem = kernel_numbers_problem(device, layout.descriptor);
  if (!problem.empty()) return Error{problem};
  const unsigned vendor = told->ids ? *told->ids >> 16 : device.vendor,
                 product = told->ids ? *told->ids & 0xffff : device.product;
  if (vendor != device.vendor || product != device.product) {
    return Error{fmt::format("{}: it is of {}, the pad is {}", source, ids_text(vendor, product),
                             ids_text(device.vendor, device.product))};
  }
  const NodeAxes axes = node_axes(layout.descriptor, device);
  const auto sticks = told->jscal.line != 0 ? apply_jscal(told->jscal, source, axes, layout)
                                            : apply_ranges(told->axes, source, axes, layout);
  if (!sticks) return sticks.error();
  return file_of(*sticks);
}

StickAxes stick_axes(const Calibration& calibration) noexcept {
  StickAxes axes = kAxesAsLaidOut;
  const StickFrame frames[2] = {calibration.left.frame, calibration.right.frame};
  for (std::size_t side = 0; side < 2; ++side) {
    const PadAxis x = side == 0 ? kLeftX : kRightX, y = side == 0 ? kLeftY : kRightY;
    const auto axis_of = [x, y](RawDirection d) {
      return StickAxis{is_along_x(d) ? x : y, is_negative(d)};
    };
    axes[2 * side] = axis_of(frames[side].right);
    axes[2 * side + 1] = axis_of(frames[side].forward);
  }
  return axes;
}

}  // namespace gaitpad
