#include "stick/calibration_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "gaitpad/result.h"
#include "hid/evdev_layout.h"
#include "hid/evdev_recording.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxTextBytes = 1 << 20;
constexpr std::size_t kMaxMappings = 65536;

struct MappingLine {
  int line = 0;
  std::string text;
};

bool is_mapping(std::string_view line) {
  constexpr std::size_t kDigits = 32;
  return line.size() > kDigits && line[kDigits] == ',' &&
         line.find_first_not_of("0123456789abcdefABCDEF") == kDigits;
}

// The text's mapping lines and their numbers; other lines are skipped.
Result<std::vector<MappingLine>> mapping_lines_of(std::string_view text,
                                                  const std::string& source) {
  std::vector<MappingLine> mappings;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = trimmed(take_line(text));
    if (!is_mapping(line)) continue;
    if (mappings.size() >= kMaxMappings)
      return Error{fmt::format("{}:{}: more than {} mappings", source, number, kMaxMappings)};
    mappings.push_back({number, std::string(line)});
  }
  return mappings;
}

constexpr double kLeastImportedHalfRange = 0.1;  // least half range, raw, as in calibration files
constexpr double kLeastImportedInner = 0.05, kMostInner = 0.9;
constexpr double kLeastTriggerWay = 0.1;

// One axis of the pad as a recording states it, in counts: its range min..max, its dead zone
// low..high.
struct AxisRange {
  std::string axis;  // name of the axis in sentences
  double min = 0.0, low = 0.0, high = 0.0, max = 0.0;
  bool states_zone = false;  // false: low and high are the middle of the range
};

bool is_hat_field(const Field& f) {
  return f.usage == usage::kHatSwitch || (f.usage >= usage::kDpadUp && f.usage <= usage::kDpadLeft);
}

// The axes of the pad's event node by code; null for the axes of a hat.
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

// The pad's axes that use the whole range of the field.
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

// The calibration that the axes' ranges have built so far.
struct Sticks {
  Calibration calibration;
  std::array<double, 2> inner{};  // inner zones of the left and the right stick; 0: not axis
  bool has_stick_axis = false;
};

std::string apply_to_trigger(const AxisRange& range, const AxisOp& op, Sticks& sticks) {
  const double a = (raw_of(op, range.min) + 1.0) / 2.0, b = (raw_of(op, range.max) + 1.0) / 2.0;
  if (std::fabs(b - a) < kLeastTriggerWay) {
    return fmt::format("{}: the range {:g} to {:g} is too small a part of the pad's {} to {}",
                       range.axis, range.min, range.max, op.bits.min, op.bits.max);
  }
  Calibration& c = sticks.calibration;
  (op.axis == kLeftTrigger ? c.left_trigger : c.right_trigger) = {std::min(a, b), std::max(a, b)};
  return {};
}

std::string apply_to_stick(const AxisRange& range, const AxisOp& op, Sticks& sticks) {
  const bool is_left = op.axis == kLeftX || op.axis == kLeftY;
  const bool is_x = op.axis == kLeftX || op.axis == kRightX;
  const double ends[2] = {raw_of(op, range.min), raw_of(op, range.max)};
  const double zone[2] = {raw_of(op, range.low), raw_of(op, range.high)};
  AxisCalibration axis;
  axis.min = std::min(ends[0], ends[1]);
  axis.max = std::max(ends[0], ends[1]);
  axis.centre = (zone[0] + zone[1]) / 2.0;
  const double nearest = std::min(axis.max - axis.centre, axis.centre - axis.min);
  if (nearest < kLeastImportedHalfRange) {
    return fmt::format(
        "{}: the range {:g} to {:g} about {:g} is too small a part of the pad's {} to {}",
        range.axis, range.min, range.max, (range.low + range.high) / 2.0, op.bits.min, op.bits.max);
  }
  if (range.states_zone) {
    double& inner = sticks.inner[is_left ? 0 : 1];
    inner = std::max(inner,
                     std::max(std::fabs(zone[1] - zone[0]) / 2.0 / nearest, kLeastImportedInner));
    if (inner > kMostInner) {
      return fmt::format("{}: its dead zone from {:g} to {:g} leaves hardly any range", range.axis,
                         range.low, range.high);
    }
  }
  StickCalibration& stick = is_left ? sticks.calibration.left : sticks.calibration.right;
  (is_x ? stick.x : stick.y) = axis;
  sticks.has_stick_axis = true;
  return {};
}

// Returns the problem; empty if the range was applied or the pad does not use the axis.
std::string apply(const AxisRange& range, const PadLayout& layout, const Field& field,
                  Sticks& sticks) {
  for (const AxisOp& op : ops_of(layout, field)) {
    const auto low = static_cast<double>(op.bits.min), high = static_cast<double>(op.bits.max);
    if (range.high < low || range.low > high) {
      return fmt::format("{}: its centre {:g} is outside of the pad's {} to {}", range.axis,
                         (range.low + range.high) / 2.0, op.bits.min, op.bits.max);
    }
    const bool is_trigger = op.axis == kLeftTrigger || op.axis == kRightTrigger;
    std::string problem =
        is_trigger ? apply_to_trigger(range, op, sticks) : apply_to_stick(range, op, sticks);
    if (!problem.empty()) return problem;
  }
  return {};
}

// Takes the middle of each axis' range as its centre, because the kernel states no other.
Result<Sticks> apply_ranges(const EvdevRecording& node, const std::string& source,
                            const NodeAxes& axes, const PadLayout& layout) {
  Sticks sticks;
  for (const RecordedAxis& axis : node.axes()) {
    const auto found = axes.find(axis.code);
    if (found == axes.end() || found->second == nullptr) continue;
    const Field& field = *found->second;
    const double min = axis.min, max = axis.max, flat = std::max(axis.flat, 0);
    const double middle = (min + max) / 2.0;
    const AxisRange range{
        fmt::format("axis {:02x}", axis.code), min, middle - flat, middle + flat, max, flat > 0.0};
    const auto where = [&source, &axis](const std::string& cause) {
      return Error{fmt::format("{}:{}: {}", source, axis.line, cause)};
    };
    if (!(min < max))
      return where(fmt::format("{}: the range {} to {} is empty", range.axis, min, max));
    // A wider range comes from a pad with another scale.
    const auto width = static_cast<double>(field.logical_max - field.logical_min);
    if (max - min > width * 1.01 + 1.0) {
      return where(fmt::format("{}: the range {} to {} is wider than the pad's {} to {}",
                               range.axis, min, max, field.logical_min, field.logical_max));
    }
    const std::string problem = apply(range, layout, field, sticks);
    if (!problem.empty()) return where(problem);
  }
  if (!sticks.has_stick_axis) return Error{source + ": it states no axis of this pad's sticks"};
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

// A 16-bit word of a GUID, least significant byte first; the text is known to be hexadecimal.
unsigned guid_word(const std::string& line, std::size_t byte) {
  const auto value = [&](std::size_t at) {
    return static_cast<unsigned>(std::stoul(line.substr(2 * at, 2), nullptr, 16));
  };
  return value(byte) | value(byte + 1) << 8;
}

// The reason why a mapping line is not for this pad; empty: it is.
std::string mapping_problem(const std::string& line, const DeviceInfo& device) {
  if (!is_one_line(line)) return "SDL mapping: it holds a control character";
  const unsigned vendor = guid_word(line, 4), product = guid_word(line, 8);
  // A GUID without these zeros holds a name instead of ids, which cannot be compared.
  if (guid_word(line, 6) != 0 || guid_word(line, 10) != 0) return {};
  if (vendor != 0 && (vendor != device.vendor || product != device.product)) {
    return fmt::format("SDL mapping: it is for {}, the pad is {}", ids_text(vendor, product),
                       ids_text(device.vendor, device.product));
  }
  const auto platform = line.find(",platform:");
  if (platform != std::string::npos && line.compare(platform, 15, ",platform:Linux") != 0) {
    return "SDL mapping: it is for another platform, where controls have other numbers";
  }
  const bool is_node = stated_by(device.driver) == StatedBy::evdev_driver;
  const unsigned mark = is_node ? device.version & kKernelCodesBit : 0;
  if (vendor != 0 && (guid_word(line, 12) & kKernelCodesBit) != mark) {
    return mark == 0 ? "SDL mapping: it counts what the kernel's driver for that pad numbers; give "
                       "its event node (/dev/input/event...)"
                     : "SDL mapping: it counts the pad without the kernel's driver for it";
  }
  return {};
}

// The first node with the pad's ids, or without ids, whose ranges the sticks can have: a pad's
// motion sensors are a node with the same ids.
Result<CalibrationFile> apply_recording(const std::vector<EvdevRecording>& nodes,
                                        const std::string& source, const DeviceInfo& device,
                                        const PadLayout& layout) {
  const NodeAxes axes = node_axes(layout.descriptor, device);
  std::optional<Error> first_problem;
  for (const EvdevRecording& node : nodes) {
    const bool has_ids = node.info.vendor != 0 || node.info.product != 0;
    if (has_ids && (node.info.vendor != device.vendor || node.info.product != device.product))
      continue;
    const auto sticks = apply_ranges(node, source, axes, layout);
    if (sticks) return file_of(*sticks);
    if (!first_problem) first_problem = sticks.error();
  }
  if (first_problem) return *first_problem;
  return Error{fmt::format("{}: it was recorded from {}, the pad is {}", source,
                           ids_text(nodes[0].info.vendor, nodes[0].info.product),
                           ids_text(device.vendor, device.product))};
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
  if (text.size() > kMaxTextBytes) {
    return Error{
        fmt::format("{}: {} bytes, at most {} are read", source, text.size(), kMaxTextBytes)};
  }
  if (device.driver == "sdl") return Error{kernel_numbers_problem(device, layout.descriptor)};
  if (!is_evdev_recording(text)) {
    const auto mappings = mapping_lines_of(text, source);
    if (!mappings) return mappings.error();
    if (!mappings->empty()) return apply_mapping(*mappings, source, device, layout);
    return Error{source + ": no SDL mapping, and not a recording of evemu, libinput or umockdev"};
  }
  const std::string problem = kernel_numbers_problem(device, layout.descriptor);
  if (!problem.empty()) return Error{problem};
  const auto recordings = evdev_recordings(text, source, Damage::refuse);
  if (!recordings) return recordings.error();
  return apply_recording(recordings->nodes, source, device, layout);
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
