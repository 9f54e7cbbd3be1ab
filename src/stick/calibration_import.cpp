// Two steps: reads the text into the other tool's own numbers, then applies these to the pad.
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
#include "hid/trace_lines.h"

namespace gaitpad {

namespace {

// ---- What the text says, in its tool's own numbers

// jscal's broken line: full at `min` and `max`, 0 from `low` to `high`.
struct JscalAxis {
  bool is_corrected = false;  // type 1; else the other members mean nothing
  bool reversed = false;      // the axis falls while the counts grow
  double min = 0.0, low = 0.0, high = 0.0, max = 0.0;
};
struct JscalText {
  int line = 0;  // of the correction; 0: none
  std::vector<JscalAxis> axes;
  std::vector<std::uint16_t> codes;  // of `jscal -u`: the code of each axis; empty: none
};

// One axis, as far as the text states it.
struct AbsInfo {
  std::optional<std::int32_t> min, max, flat;
  int line = 0;
};
using AbsInfos = std::map<std::uint16_t, AbsInfo>;  // by ABS code

struct MappingLine {
  int line = 0;
  std::string text;
};

struct ImportText {
  JscalText jscal;
  AbsInfos axes;
  std::vector<MappingLine> mappings;
  std::optional<std::uint32_t> ids;  // vendor << 16 | product of evemu's `I:` line
  std::uint16_t version = 0;
};

constexpr std::size_t kMaxTextBytes = 1 << 20;
constexpr std::size_t kMaxMappings = 65536;
constexpr int kMaxAxes = 64;  // ABS_CNT
constexpr std::uint32_t kLastCode = 0x3f;

// What is wrong with a line, without its place; empty: nothing.
using Problem = std::string;

// `6,1,0,127,...`: numbers with commas between, to the end.
Problem read_list(std::string_view text, std::vector<std::int32_t>& list) {
  constexpr std::size_t kMaxNumbers = 2048;
  while (!text.empty()) {
    const std::string_view part = take_part(text, ',');
    const auto value = parse_number<std::int32_t>(part);
    if (!value) return fmt::format("jscal: {} is no number", in_quotes(part));
    if (list.size() >= kMaxNumbers) return fmt::format("jscal: more than {} numbers", kMaxNumbers);
    list.push_back(*value);
  }
  if (list.empty()) return "jscal: no numbers";
  if (list[0] < 1 || list[0] > kMaxAxes) {
    return fmt::format("jscal: {} axes, 1 to {} there may be", list[0], kMaxAxes);
  }
  return {};
}

// joydev's broken line (Linux drivers/input/joydev.c): 0 from c[0] to c[1], outside of it slopes of
// c[2] and c[3] / 16384, clipped at +-32767.
Problem read_broken_line(std::size_t index, const std::int32_t* c, JscalAxis& axis) {
  constexpr double kFull = 32767.0 * 16384.0;
  if (c[0] > c[1]) {
    return fmt::format("jscal: axis {}: its centre begins at {} and ends at {}", index, c[0], c[1]);
  }
  if (c[2] == 0 || c[3] == 0 || (c[2] < 0) != (c[3] < 0)) {
    return fmt::format("jscal: axis {}: slopes {} and {} do not go one way", index, c[2], c[3]);
  }
  axis.is_corrected = true;
  axis.reversed = c[2] < 0;
  axis.low = c[0];
  axis.high = c[1];
  axis.min = axis.low - kFull / std::abs(static_cast<double>(c[2]));
  axis.max = axis.high + kFull / std::abs(static_cast<double>(c[3]));
  return {};
}

// For each axis: type, precision, and the coefficients of the type (0: none, 1: four).
Problem read_correction(std::string_view text, JscalText& jscal) {
  constexpr std::size_t kHead = 2, kCoefficients = 4;
  std::vector<std::int32_t> list;
  if (Problem problem = read_list(text, list); !problem.empty()) return problem;
  std::size_t at = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(list[0]); ++i) {
    JscalAxis axis;
    const std::int32_t type = at < list.size() ? list[at] : 0;
    if (type != 0 && type != 1) return fmt::format("jscal: axis {}: unknown type {}", i, type);
    const std::size_t size = kHead + (type == 1 ? kCoefficients : 0);
    if (at + size > list.size()) return fmt::format("jscal: axis {}: numbers are missing", i);
    if (type == 1) {
      Problem problem = read_broken_line(i, list.data() + at + kHead, axis);
      if (!problem.empty()) return problem;
    }
    at += size;
    jscal.axes.push_back(axis);
  }
  return at == list.size() ? Problem() : "jscal: more numbers than its axes have";
}

// The codes of the axes, then the buttons.
Problem read_axis_map(std::string_view text, JscalText& jscal) {
  std::vector<std::int32_t> list;
  if (Problem problem = read_list(text, list); !problem.empty()) return problem;
  if (list.size() <= static_cast<std::size_t>(list[0])) return "jscal: codes of axes are missing";
  for (int i = 1; i <= list[0]; ++i) {
    const std::int32_t code = list[static_cast<std::size_t>(i)];
    if (code < 0 || code > static_cast<std::int32_t>(kLastCode)) {
      return fmt::format("jscal: {} is no code of an axis", code);
    }
    jscal.codes.push_back(static_cast<std::uint16_t>(code));
  }
  return {};
}

class Reader {
 public:
  Problem read(std::string_view line, int number) {
    line_ = number;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return {};
    if (is_jscal(line)) return read_jscal(line);
    if (line.starts_with("A:")) return read_evemu(line.substr(2));
    if (line.starts_with("I:")) return read_ids(line.substr(2));
    if (line.starts_with("EVDEV_ABS_")) return read_hwdb(line.substr(10));
    if (line.starts_with("Event ")) return begin_evtest(line);
    if (is_mapping(line)) return add_mapping(line);
    return evtest_ ? read_evtest(line) : Problem();
  }
  ImportText take() { return std::move(text_); }

 private:
  static bool is_jscal(std::string_view line) {
    Words words(line);
    const std::string_view program = words.next();
    return program == "jscal" || program.ends_with("/jscal");
  }
  static bool is_mapping(std::string_view line) {
    constexpr std::size_t kDigits = 32;
    return line.size() > kDigits && line[kDigits] == ',' &&
           line.find_first_not_of("0123456789abcdefABCDEF") == kDigits;
  }

  // `jscal -s 2,1,0,... /dev/input/js0`; only the two options that set something are read.
  Problem read_jscal(std::string_view line) {
    Words words(line);
    words.next();
    while (!words.at_end()) {
      const std::string_view word = words.next();
      const bool is_map = word == "-u" || word == "--set-mappings";
      if (!is_map && word != "-s" && word != "--set-correction") continue;
      if (is_map ? !text_.jscal.codes.empty() : text_.jscal.line != 0) {
        return "jscal: told a second time";
      }
      const std::string_view list = words.next();
      if (is_map) return read_axis_map(list, text_.jscal);
      text_.jscal.line = line_;
      return read_correction(list, text_.jscal);
    }
    return {};
  }

  Problem begin_axis(std::uint32_t code, AbsInfo*& axis) {
    const auto [it, is_new] = text_.axes.try_emplace(static_cast<std::uint16_t>(code));
    if (!is_new) return fmt::format("axis {:02x}: told a second time", code);
    it->second.line = line_;
    axis = &it->second;
    return {};
  }

  // `A: 00 0 255 0 15 0`: code, minimum, maximum, fuzz, flat; since version 1.1 also resolution.
  Problem read_evemu(std::string_view rest) {
    Words words(rest);
    const std::string_view word = words.next();
    const auto code = hexadecimal(word, kLastCode);
    if (!code) return fmt::format("{} is no code of an axis", in_quotes(word));
    std::optional<std::int32_t> numbers[4];
    for (auto& n : numbers) {
      const std::string_view text = words.next();
      n = parse_number<std::int32_t>(text);
      if (!n) return fmt::format("axis {:02x}: {} is no number", *code, in_quotes(text));
    }
    AbsInfo* axis = nullptr;
    if (Problem problem = begin_axis(*code, axis); !problem.empty()) return problem;
    axis->min = numbers[0];
    axis->max = numbers[1];
    axis->flat = numbers[3];
    return {};
  }

  // `I: 0003 054c 0ce6 8111`: bus, vendor, product, version. Other tools have other `I:` lines.
  Problem read_ids(std::string_view rest) {
    Words words(rest);
    words.next();
    const auto vendor = hexadecimal(words.next(), 0xffff),
               product = hexadecimal(words.next(), 0xffff),
               version = hexadecimal(words.next(), 0xffff);
    if (!vendor || !product || !version) return {};
    text_.ids = *vendor << 16 | *product;
    text_.version = static_cast<std::uint16_t>(*version);
    return {};
  }

  // `00=0:255:0:0:15`: minimum, maximum, resolution, fuzz, flat; each may be empty.
  Problem read_hwdb(std::string_view rest) {
    const std::string_view word = take_part(rest, '=');
    const auto code = hexadecimal(word, kLastCode);
    if (!code) return fmt::format("EVDEV_ABS_{}: no code of an axis", in_quotes(word));
    std::optional<std::int32_t> numbers[5];
    for (auto& n : numbers) {
      const std::string_view part = trimmed(take_part(rest, ':'));
      n = parse_number<std::int32_t>(part);
      if (!n && !part.empty()) {
        return fmt::format("EVDEV_ABS_{:02x}: {} is no number", *code, in_quotes(part));
      }
    }
    if (!rest.empty()) return fmt::format("EVDEV_ABS_{:02x}: more than five numbers", *code);
    AbsInfo* axis = nullptr;
    if (Problem problem = begin_axis(*code, axis); !problem.empty()) return problem;
    axis->min = numbers[0];
    axis->max = numbers[1];
    axis->flat = numbers[4];
    return {};
  }

  // `Event code 0 (ABS_X)`; `Event type` and other codes end the lines of an axis.
  Problem begin_evtest(std::string_view line) {
    evtest_ = nullptr;
    Words words(line);
    words.next();
    if (words.next() != "code") return {};
    const auto code = decimal(words.next(), kLastCode);
    if (!code || !words.next().starts_with("(ABS_")) return {};
    return begin_axis(static_cast<std::uint32_t>(*code), evtest_);
  }
  // `Min  0`
  Problem read_evtest(std::string_view line) {
    Words words(line);
    const std::string_view key = words.next(), text = words.next();
    std::optional<std::int32_t>* value = key == "Min"    ? &evtest_->min
                                         : key == "Max"  ? &evtest_->max
                                         : key == "Flat" ? &evtest_->flat
                                                         : nullptr;
    if (value == nullptr) return {};
    *value = parse_number<std::int32_t>(text);
    return *value ? Problem() : fmt::format("{}: {} is no number", key, in_quotes(text));
  }

  Problem add_mapping(std::string_view line) {
    if (text_.mappings.size() >= kMaxMappings) {
      return fmt::format("more than {} mappings", kMaxMappings);
    }
    text_.mappings.push_back({line_, std::string(line)});
    return {};
  }

  ImportText text_;
  AbsInfo* evtest_ = nullptr;  // the axis that evtest's next lines describe
  int line_ = 0;
};

// Error if a known line is damaged, if something is stated twice, if the text is of several tools
// or of none, and for more than 1 MiB.
Result<ImportText> import_text(std::string_view text, const std::string& source) {
  if (text.size() > kMaxTextBytes) {
    return Error{
        fmt::format("{}: {} bytes, at most {} are read", source, text.size(), kMaxTextBytes)};
  }
  Reader reader;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = take_part(text, '\n');
    const Problem problem = reader.read(line, number);
    if (!problem.empty()) return Error{fmt::format("{}:{}: {}", source, number, problem)};
  }
  ImportText told = reader.take();
  const int kinds = (told.jscal.line != 0) + !told.axes.empty() + !told.mappings.empty();
  if (kinds == 0) {
    return Error{source +
                 ": no line of jscal, no axis of evemu, evtest or a hwdb file, no SDL mapping"};
  }
  if (kinds > 1) return Error{source + ": of several tools; give one at a time"};
  return told;
}

// ---- What it means for the pad

constexpr double kLeastImportedHalfRange = 0.1;  // raw, as calibration files have it
constexpr double kLeastImportedInner = 0.05, kMostInner = 0.9;
constexpr double kLeastTriggerWay = 0.1;
constexpr unsigned kCodesByKernel = 0x8000;

// What a tool claims of one axis of the pad, in counts.
struct Claim {
  std::string axis;  // for sentences
  double min = 0.0, low = 0.0, high = 0.0, max = 0.0;
  bool is_zone_told = false;  // from low to high
  bool reversed = false;
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

// The axes of the pad that the whole field is bound to.
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

// The calibration that the claims have built so far.
struct Sticks {
  Calibration calibration;
  std::array<double, 2> inner{};  // left, right; 0: not stated
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
  if (nearest < kLeastImportedHalfRange) {
    return fmt::format("{}: {:g} to {:g} about {:g} is next to nothing of the pad's {} to {}",
                       claim.axis, claim.min, claim.max, (claim.low + claim.high) / 2.0,
                       op.bits.min, op.bits.max);
  }
  if (claim.is_zone_told) {
    double& inner = sticks.inner[is_left ? 0 : 1];
    inner = std::max(inner,
                     std::max(std::fabs(zone[1] - zone[0]) / 2.0 / nearest, kLeastImportedInner));
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

// Returns the problem; empty if the claim was applied or the pad does not use the axis.
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
  // jscal's ends are full deflection.
  sticks.calibration.left.outer = sticks.calibration.right.outer = 1.0;
  return sticks;
}

// The middle of the range is taken as the centre: the kernel knows no other.
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
    // A wider range comes from a pad with another scale.
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

// A 16-bit word of a GUID, least significant byte first; the text is known to be hexadecimal.
unsigned guid_word(const std::string& line, std::size_t byte) {
  const auto value = [&](std::size_t at) {
    return static_cast<unsigned>(std::stoul(line.substr(2 * at, 2), nullptr, 16));
  };
  return value(byte) | value(byte + 1) << 8;
}

// Why a mapping line is not for this pad; empty: it is.
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
