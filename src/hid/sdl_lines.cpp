#include "hid/sdl_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "base/text.h"
#include "gaitpad/descriptor.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/trace.h"
#include "hid/evdev_layout.h"
#include "hid/trace_lines.h"

namespace gaitpad {

namespace {

// ---- What SDL's numbers mean on one device

// Up, right, down, left: bit k of SDL's hat mask.
constexpr std::size_t kHatDirections = 4;
using SdlHat = std::array<std::optional<ControlSource>, kHatDirections>;

constexpr std::size_t kMaxSdlSources = 8;  // most sources of one control

struct SdlNumbers {
  std::vector<ControlSource> axes, buttons;  // the sources named a0, a1 ... and b0, b1 ...
  std::vector<SdlHat> hats;                  // the directions named h0.1, h0.2, h0.4, h0.8 ...
};
enum Direction : std::size_t { kUp, kRight, kDown, kLeft };

struct InputField {
  const Field* field = nullptr;
  EvdevCode code;
  ControlSource source;
};

bool is_hat(const Field& f) { return f.usage == usage::kHatSwitch; }
// Counts the occurrences of each usage in each report.
class Occurrences {
 public:
  ControlSource next(const Field& f) {
    ControlSource source;
    source.usage = f.usage;
    source.occurrence = ++count_[{f.report_id, f.usage}];
    return source;
  }

 private:
  std::map<std::pair<std::uint8_t, std::uint32_t>, std::uint32_t> count_;
};

SdlHat all_directions(const ControlSource& hat) {
  SdlHat sources;
  for (std::size_t i = 0; i < kHatDirections; ++i) {
    sources[i] = hat;
    sources[i]->directions = static_cast<std::uint8_t>(1u << i);
  }
  return sources;
}

std::vector<InputField> coded_fields(const ReportDescriptor& d, StatedBy who) {
  std::vector<InputField> coded;
  Occurrences occurrences;
  const auto codes = evdev_codes(d, who);
  for (std::size_t i = 0; i < d.fields.size(); ++i) {
    const Field& f = d.fields[i];
    if (f.kind != FieldKind::input || f.is_array) continue;
    const ControlSource source = occurrences.next(f);
    if (i < codes.size() && codes[i]) coded.push_back({&f, *codes[i], source});
  }
  std::stable_sort(coded.begin(), coded.end(), [](const InputField& a, const InputField& b) {
    return a.code.code < b.code.code;
  });
  return coded;
}

// Adds one field to a hat: a whole hat, a D-pad's direction, or one axis that counts -1, 0, 1.
void add_to_hat(const InputField& part, SdlHat& hat) {
  const auto half = [&part](AxisPart side) {
    ControlSource source = part.source;
    source.part = side;
    return source;
  };
  constexpr Direction kOfUsage[] = {kUp, kDown, kRight, kLeft};  // usages 0x90 .. 0x93
  if (is_hat(*part.field)) {
    hat = all_directions(part.source);
  } else if (is_dpad(*part.field)) {
    hat[kOfUsage[part.field->usage - usage::kDpadUp]] = part.source;
  } else if (part.code.code % 2 == 0) {
    hat[kLeft] = half(AxisPart::low);
    hat[kRight] = half(AxisPart::high);
  } else {
    hat[kUp] = half(AxisPart::low);
    hat[kDown] = half(AxisPart::high);
  }
}

bool makes_a_hat(const InputField& f) {
  if (f.code.code < evdev::kAbsHat0X || f.code.code > evdev::kAbsHat3Y) return false;
  const Field& field = *f.field;
  return is_hat(field) || is_dpad(field) || (field.logical_min == -1 && field.logical_max == 1);
}

// SDL's order of an evdev node's controls (SDL 2.26, ConfigJoystick): keys from BTN_JOYSTICK on,
// then those below; axes by code without the hats; hats by code.
SdlNumbers sdl_numbers(const ReportDescriptor& d, StatedBy who) {
  SdlNumbers numbered;
  std::vector<ControlSource> low_keys;
  std::map<int, SdlHat> hats;
  for (const InputField& f : coded_fields(d, who)) {
    if (f.code.type == EvdevType::key) {
      if (f.code.code >= evdev::kKeyMax) continue;  // SDL stops before this code
      (f.code.code >= evdev::kBtnJoystick ? numbered.buttons : low_keys).push_back(f.source);
    } else if (makes_a_hat(f)) {
      add_to_hat(f, hats[(f.code.code - evdev::kAbsHat0X) / 2]);
    } else if (f.code.code < evdev::kAbsMax) {
      numbered.axes.push_back(f.source);
    }
  }
  numbered.buttons.insert(numbered.buttons.end(), low_keys.begin(), low_keys.end());
  for (const auto& [number, hat] : hats) numbered.hats.push_back(hat);
  return numbered;
}

// ---- Reading a line

constexpr std::int64_t kMaxNumber = 1000;

enum class SourceKind { axis, button, hat };
// `a2`, `+a2`, `-a2`, `a2~`, `b3`, `h0.8`
struct NumberedSource {
  SourceKind kind = SourceKind::axis;
  std::size_t number = 0;
  std::uint8_t directions = 0;
  AxisPart part = AxisPart::whole;
  bool reversed = false;
};

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<NumberedSource> numbered_source(std::string_view text) {
  NumberedSource source;
  if (take(text, '+')) {
    source.part = AxisPart::high;
  } else if (take(text, '-')) {
    source.part = AxisPart::low;
  }
  if (text.ends_with('~')) {
    source.reversed = true;
    text.remove_suffix(1);
  }
  if (take(text, 'b')) {
    source.kind = SourceKind::button;
  } else if (take(text, 'h')) {
    source.kind = SourceKind::hat;
    const std::size_t point = text.find('.');
    if (point == std::string_view::npos) return std::nullopt;
    const auto directions = decimal(text.substr(point + 1), 15);
    if (!directions || *directions == 0) return std::nullopt;
    source.directions = static_cast<std::uint8_t>(*directions);
    text = text.substr(0, point);
  } else if (!take(text, 'a')) {
    return std::nullopt;
  }
  const auto number = decimal(text, kMaxNumber);
  if (!number) return std::nullopt;
  source.number = static_cast<std::size_t>(*number);
  return source;
}

// Several sources if one number stands for several fields (a D-pad of four buttons).
ControlSources sources_of(const SdlNumbers& numbered, const NumberedSource& wanted) {
  ControlSources sources;
  if (wanted.kind == SourceKind::hat) {
    if (wanted.number >= numbered.hats.size()) return sources;
    for (std::size_t i = 0; i < kHatDirections; ++i) {
      const auto& direction = numbered.hats[wanted.number][i];
      if (((wanted.directions >> i) & 1u) != 0 && direction) sources.push_back(*direction);
    }
    return sources;
  }
  const bool is_axis = wanted.kind == SourceKind::axis;
  const auto& list = is_axis ? numbered.axes : numbered.buttons;
  if (wanted.number >= list.size()) return sources;
  sources.push_back(list[wanted.number]);
  if (is_axis) {
    sources.back().part = wanted.part;
    sources.back().reversed = wanted.reversed;
  }
  return sources;
}

constexpr std::array<std::string_view, kAxisCount> kSdlAxes = {
    "leftx", "lefty", "rightx", "righty", "lefttrigger", "righttrigger"};

// The control that a key names; null for other keys (`platform`, `hint`, `crc` ...).
std::optional<ControlSources>* control_of(std::string_view key, ControlMap& map) {
  for (std::size_t i = 0; i < kSdlAxes.size(); ++i) {
    if (key == kSdlAxes[i]) return &map.axes[i];
  }
  for (std::size_t i = 0; i < kButtonNames.size(); ++i) {
    if (key == kButtonNames[i]) return &map.buttons[i];
  }
  return nullptr;
}

std::optional<Error> add_pair(std::string_view pair, const SdlNumbers& numbered, ControlMap& map) {
  const std::size_t colon = pair.find(':');
  if (colon == std::string_view::npos) {
    return Error{fmt::format("SDL mapping: {} is no pair control:source", in_quotes(pair))};
  }
  std::string_view key = pair.substr(0, colon), text = pair.substr(colon + 1);
  StickSide side = StickSide::both;
  if (take(key, '+')) {
    side = StickSide::positive;
  } else if (take(key, '-')) {
    side = StickSide::negative;
  }
  std::optional<ControlSources>* control = control_of(key, map);
  if (!control || text.empty()) return std::nullopt;
  const auto wanted = numbered_source(text);
  if (!wanted) return Error{"SDL mapping: unknown source " + in_quotes(text)};
  for (ControlSource source : sources_of(numbered, *wanted)) {
    source.side = side;
    if (!*control) control->emplace();
    if ((*control)->size() >= kMaxSdlSources) {
      return Error{
          fmt::format("SDL mapping: more than {} sources for {}", kMaxSdlSources, in_quotes(key))};
    }
    (*control)->push_back(source);
  }
  return std::nullopt;
}

bool is_guid(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdefABCDEF";
  return text.size() == 32 && text.find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

bool is_one_line(std::string_view mapping) {
  return std::none_of(mapping.begin(), mapping.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver) {
  if (mapping.size() > kMaxTraceTextBytes) {
    return Error{fmt::format("SDL mapping: {} bytes, at most {} are read", mapping.size(),
                             kMaxTraceTextBytes)};
  }
  std::string_view rest = mapping;
  const std::string_view guid = take_part(rest, ',');
  if (!is_guid(guid)) {
    return Error{
        fmt::format("SDL mapping: {} is no GUID of 32 hexadecimal digits", in_quotes(guid))};
  }
  take_part(rest, ',');  // skips the name
  const SdlNumbers numbered = sdl_numbers(descriptor, stated_by(driver));
  ControlMap map;
  while (!rest.empty()) {
    const std::string_view pair = take_part(rest, ',');
    if (pair.empty()) continue;
    if (auto error = add_pair(pair, numbered, map)) return *error;
  }
  return map;
}

// ---- Choosing a line

namespace {

constexpr std::size_t kGuidDigits = 32, kMaxLines = 20'000;

// The 16-bit words of a GUID (SDL 2.26, SDL_CreateJoystickGUID): bus, checksum of the name, vendor,
// 0, product, 0, version, the driver's mark (`h` for SDL's own HID drivers, which number
// otherwise).
enum GuidWord : std::size_t { kBus, kNameSum, kVendor, kProduct = 4, kVersion = 6, kDriverMark };
using Guid = std::array<unsigned, 8>;

std::optional<Guid> guid_of(std::string_view line) {
  const std::string_view digits = line.substr(0, kGuidDigits);
  if (!is_guid(digits)) return std::nullopt;
  Guid guid{};
  for (std::size_t i = 0; i < guid.size(); ++i) {
    const auto low = hexadecimal(digits.substr(4 * i, 2), 0xff),
               high = hexadecimal(digits.substr(4 * i + 2, 2), 0xff);
    guid[i] = static_cast<unsigned>(low.value_or(0) | high.value_or(0) << 8);
  }
  return guid;
}

// The text after `key:` in the line; empty: the line lacks the key.
std::string_view pair_of(std::string_view line, std::string_view key) {
  while (!line.empty()) {
    std::string_view pair = take_part(line, ',');
    if (pair.starts_with(key) && pair.substr(key.size()).starts_with(':'))
      return trimmed(pair.substr(key.size() + 1));
  }
  return {};
}

// SDL_crc16: CRC-16 with the reflected polynomial a001, from 0.
unsigned name_sum(std::string_view name) {
  unsigned sum = 0;
  for (const char c : name) {
    sum ^= static_cast<unsigned char>(c);
    for (int i = 0; i < 8; ++i) sum = (sum & 1u) != 0 ? sum >> 1 ^ 0xa001u : sum >> 1;
  }
  return sum;
}

bool is_for_name(std::string_view line, const Guid& guid, std::string_view name) {
  const auto stated = hexadecimal(pair_of(line, "crc"), 0xffff);
  const unsigned wanted = stated ? static_cast<unsigned>(*stated) : guid[kNameSum];
  return wanted == 0 || wanted == name_sum(name);
}

// Our buttons are named by position, so a line for buttons by their printed names counts only if
// there is no other.
constexpr std::string_view kLabelHint = "SDL_GAMECONTROLLER_USE_BUTTON_LABELS";
bool is_for_labels(std::string_view line) { return pair_of(line, "hint").starts_with(kLabelHint); }

// `hint:NAME:=1` counts where SDL's hint is on by default, `hint:!NAME:=1` where it is off.
bool is_hint_met(std::string_view line) {
  std::string_view hint = pair_of(line, "hint");
  const bool is_negated = take(hint, '!');
  if (hint.empty() || hint.starts_with(kLabelHint)) return true;
  return hint.ends_with(":=1") != is_negated;
}

}  // namespace

std::vector<std::string> mapping_lines(std::string_view text) {
  std::vector<std::string> lines;
  text = without_byte_order_mark(text);
  while (!text.empty() && lines.size() < kMaxLines) {
    const std::string_view line = trimmed(take_line(text));
    const std::string_view platform = pair_of(line, "platform");
    if (!is_guid(line.substr(0, line.find(','))) || line.size() > kMaxTraceTextBytes) continue;
    if (!is_one_line(line) || (!platform.empty() && platform != "Linux")) continue;
    lines.emplace_back(line);
  }
  return lines;
}

std::string fitting_mapping(std::span<const std::string> lines, const DeviceInfo& device) {
  if (device.vendor == 0) return {};
  const bool is_node = stated_by(device.driver) == StatedBy::evdev_driver;
  const unsigned version = is_node ? device.version : device.version & ~kKernelCodesBit;
  const std::string* best = nullptr;
  // 1 for the same ids, 1 more for buttons by position, 2 more for the same version.
  int best_fit = 0;
  for (const std::string& line : lines) {
    const auto guid = guid_of(line);
    if (!guid || (*guid)[kBus] != static_cast<unsigned>(device.bus) ||
        (*guid)[kVendor] != device.vendor || (*guid)[kProduct] != device.product)
      continue;
    const unsigned of_line = (*guid)[kVersion];
    if ((*guid)[kDriverMark] != 0 || ((of_line ^ version) & kKernelCodesBit) != 0) continue;
    if (!is_for_name(line, *guid, device.name) || !is_hint_met(line)) continue;
    const int fit = 1 + (is_for_labels(line) ? 0 : 1) + (of_line == version ? 2 : 0);
    if (fit <= best_fit) continue;
    best = &line;
    best_fit = fit;
  }
  return best == nullptr ? std::string() : *best;
}

std::vector<std::string> merged_mappings(const std::vector<std::string>& lines,
                                         const std::vector<std::string>& own) {
  std::set<std::string_view> guids;
  for (const std::string& line : lines) guids.insert(std::string_view(line).substr(0, kGuidDigits));
  std::vector<std::string> merged = lines;
  for (const std::string& line : own) {
    if (guids.count(std::string_view(line).substr(0, kGuidDigits)) == 0) merged.push_back(line);
  }
  return merged;
}

// ---- Writing a line

namespace {

// Finds the number that SDL gives to a field.
class FieldNumbers {
 public:
  FieldNumbers(const ReportDescriptor& d, StatedBy who)
      : descriptor_(d), numbers_(sdl_numbers(d, who)) {}

  // `a2`, `b3`, `h0.4`, with `+` or `-` for a half of an axis; empty: the field has no number.
  std::string source(std::uint8_t report_id, const FieldBits& bits, bool low_is_full) const {
    ControlSource source;
    const Field* field = source_of(report_id, bits, source);
    if (!field) return {};
    if (bits.min > field->logical_min) source.part = AxisPart::high;
    if (bits.max < field->logical_max) source.part = AxisPart::low;
    if (std::string hat = hat_text(source); !hat.empty()) return hat;
    if (const auto n = index_in(numbers_.buttons, source)) return fmt::format("b{}", *n);
    const bool is_low = source.part == AxisPart::low;
    const std::string_view part = is_low ? "-" : source.part == AxisPart::high ? "+" : "";
    source.part = AxisPart::whole;
    const auto n = index_in(numbers_.axes, source);
    return n ? fmt::format("{}a{}{}", part, *n, low_is_full != is_low ? "~" : "") : std::string();
  }
  // The source of a whole hat: `h0.` and the mask of directions.
  std::string hat_source(std::uint8_t report_id, const FieldBits& bits,
                         std::uint8_t directions) const {
    ControlSource source;
    if (!source_of(report_id, bits, source)) return {};
    source.directions = 1;
    for (std::size_t n = 0; n < numbers_.hats.size(); ++n) {
      if (numbers_.hats[n][0] == source) return fmt::format("h{}.{}", n, directions);
    }
    return {};
  }

 private:
  // The descriptor's field at these bits; null: not found. Sets the usage of `s`, and its
  // occurrence among the fields of the report that have that usage.
  const Field* source_of(std::uint8_t report_id, const FieldBits& bits, ControlSource& s) const {
    for (const Field& f : descriptor_.fields) {
      if (f.kind != FieldKind::input || f.is_array || f.report_id != report_id) continue;
      if (f.bit_offset != bits.bit_offset || f.bit_size != bits.bit_size) continue;
      s.usage = f.usage;
      s.occurrence = 0;
      for (const Field* other = descriptor_.fields.data(); other <= &f; ++other) {
        s.occurrence += other->kind == FieldKind::input && !other->is_array &&
                        other->report_id == report_id && other->usage == f.usage;
      }
      return &f;
    }
    return nullptr;
  }
  std::string hat_text(const ControlSource& source) const {
    for (std::size_t n = 0; n < numbers_.hats.size(); ++n) {
      for (std::size_t i = 0; i < kHatDirections; ++i) {
        if (numbers_.hats[n][i] == source) return fmt::format("h{}.{}", n, 1u << i);
      }
    }
    return {};
  }
  static std::optional<std::size_t> index_in(const std::vector<ControlSource>& list,
                                             const ControlSource& source) {
    const auto it = std::find(list.begin(), list.end(), source);
    if (it == list.end()) return std::nullopt;
    return static_cast<std::size_t>(it - list.begin());
  }
  const ReportDescriptor& descriptor_;
  SdlNumbers numbers_;
};

// Control and source; the sign names one side of a stick's axis and is written before the control.
struct SdlPair {
  std::string control, sign, source;
  bool operator<(const SdlPair& b) const {
    return std::tie(control, sign, source) < std::tie(b.control, b.sign, b.source);
  }
};
using Pairs = std::set<SdlPair>;

void add(Pairs& pairs, std::string_view control, std::string_view sign, std::string source) {
  const auto is_same = [control](const SdlPair& p) { return p.control == control; };
  const auto known = std::count_if(pairs.begin(), pairs.end(), is_same);
  if (source.empty() || known >= static_cast<std::ptrdiff_t>(kMaxSdlSources)) return;
  pairs.insert({std::string(control), std::string(sign), std::move(source)});
}

// The axes of the pad that an axis of the layout moves, and which way.
struct Moved {
  PadAxis axis;
  bool reversed;
};
std::vector<Moved> moved_by(PadAxis axis, const StickAxes& sticks) {
  if (axis == kLeftTrigger || axis == kRightTrigger) return {{axis, false}};
  std::vector<Moved> moved;
  for (std::size_t i = 0; i < sticks.size(); ++i) {
    if (sticks[i].axis == axis) moved.push_back({static_cast<PadAxis>(i), sticks[i].reversed});
  }
  return moved;
}

// SDL's y grows towards the player, ours away from the player.
std::string_view sign_of(PadAxis axis, bool is_positive) {
  return is_positive != is_upward(axis) ? "+" : "-";
}

void add_axes(const ReportLayout& report, const FieldNumbers& numbers, const StickAxes& sticks,
              Pairs& pairs) {
  for (const AxisOp& op : report.axes) {
    for (const Moved& m : moved_by(op.axis, sticks)) {
      bool falls = op.reversed;  // the control falls, in SDL's directions, while the field grows
      std::string_view sign;
      if (op.side != 0) {
        sign = sign_of(m.axis, (op.side > 0) != m.reversed);
      } else {
        falls = falls != (m.reversed != is_upward(m.axis));
      }
      add(pairs, kSdlAxes[m.axis], sign, numbers.source(report.report_id, op.bits, falls));
    }
  }
}

void add_hat(const HatOp& op, std::uint8_t report_id, const FieldNumbers& numbers,
             const StickAxes& sticks, Pairs& pairs) {
  if (op.directions == 0) {
    constexpr PadButton kDpad[] = {kButtonDpadUp, kButtonDpadRight, kButtonDpadDown,
                                   kButtonDpadLeft};
    for (std::size_t i = 0; i < kHatDirections; ++i) {
      const auto direction = static_cast<std::uint8_t>(1u << i);
      add(pairs, kButtonNames[kDpad[i]], "", numbers.hat_source(report_id, op.bits, direction));
    }
    return;
  }
  const std::string source = numbers.hat_source(report_id, op.bits, op.directions);
  if (op.value != 0.0f) {
    for (const Moved& m : moved_by(op.axis, sticks)) {
      add(pairs, kSdlAxes[m.axis], sign_of(m.axis, (op.value > 0.0f) != m.reversed), source);
    }
  }
  for (int b = 0; b < kButtonCount; ++b) {
    if (((op.button >> b) & 1u) != 0) add(pairs, kButtonNames[b], "", source);
  }
}

Pairs pairs_of(const PadLayout& layout, StatedBy who, const StickAxes& sticks) {
  Pairs pairs;
  const FieldNumbers numbers(layout.descriptor, who);
  for (const ReportLayout& report : layout.reports) {
    if (!report.exact_sizes.empty())
      continue;  // a replaced descriptor; the kernel reads the device's own
    add_axes(report, numbers, sticks, pairs);
    for (const HatOp& op : report.hats) add_hat(op, report.report_id, numbers, sticks, pairs);
    for (const ButtonOp& op : report.buttons) {
      if (op.mask != 0) continue;
      for (int b = 0; b < kButtonCount; ++b) {
        if (((op.button >> b) & 1u) == 0) continue;
        add(pairs, kButtonNames[b], "", numbers.source(report.report_id, op.bits, op.reversed));
      }
    }
  }
  return pairs;
}

// SDL 2.26, SDL_CreateJoystickGUID: little-endian words, no checksum of the name; a pad without ids
// has its name there.
std::string guid_text(const DeviceInfo& device, unsigned version) {
  std::array<std::uint8_t, 16> guid{};
  const auto put = [&guid](std::size_t at, unsigned word) {
    guid[at] = static_cast<std::uint8_t>(word);
    guid[at + 1] = static_cast<std::uint8_t>(word >> 8);
  };
  put(0, static_cast<unsigned>(device.bus));
  if (device.vendor != 0) {
    put(4, device.vendor);
    put(8, device.product);
    put(12, version);
  } else {
    constexpr std::size_t kNameBytes = 11;  // bytes of a name in a GUID, which a zero follows
    const std::size_t size = std::min(device.name.size(), kNameBytes);
    std::copy_n(device.name.begin(), size, guid.begin() + 4);
  }
  std::string text;
  for (const std::uint8_t byte : guid) text += fmt::format("{:02x}", byte);
  return text;
}

// The name as a part of a line: no comma, no control character, short enough for a trace.
std::string name_text(const std::string& name, std::size_t max_bytes) {
  std::string text;
  for (const char c : name) {
    text += c == ',' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  if (text.empty()) text = "Pad";
  if (text.size() <= max_bytes) return text;
  std::size_t end = max_bytes;  // cuts at the boundary of a UTF-8 character
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end);
}

}  // namespace

std::string kernel_numbers_problem(const DeviceInfo& device, const ReportDescriptor& descriptor) {
  if (device.driver == "sdl") {
    return device.name +
           ": SDL names its controls and does not tell their numbers; give its event node "
           "(/dev/input/event...)";
  }
  if (stated_by(device.driver) == StatedBy::evdev_driver) return {};
  constexpr std::uint32_t kVendorPads[] = {usage_of(0xff5d, 0x01), usage_of(0xff47, 0xd0)};
  const auto is_vendor_pad = [&descriptor](std::uint32_t u) {
    const auto& all = descriptor.applications;
    return std::find(all.begin(), all.end(), u) != all.end();
  };
  if ((device.version & kKernelCodesBit) == 0 &&
      std::none_of(std::begin(kVendorPads), std::end(kVendorPads), is_vendor_pad)) {
    return {};
  }
  return fmt::format(
      "{}: a kernel driver of its own numbers its controls; give its event node "
      "(/dev/input/event...)",
      device.name);
}

Result<std::string> sdl_mapping_text(const DeviceInfo& device, const PadLayout& layout,
                                     const StickAxes& sticks) {
  std::string problem = kernel_numbers_problem(device, layout.descriptor);
  if (!problem.empty()) return Error{std::move(problem)};
  const Pairs pairs = pairs_of(layout, stated_by(device.driver), sticks);
  if (pairs.empty()) return Error{device.name + ": no control that SDL could number"};
  std::string controls;
  for (const SdlPair& p : pairs) controls += p.sign + p.control + ":" + p.source + ",";
  controls += "platform:Linux,";
  const std::string guid = guid_text(device, device.version);
  const std::size_t others = guid.size() + controls.size() + 2;
  constexpr std::size_t kLeastName = 16;
  const std::size_t left = others < kMaxTraceTextBytes ? kMaxTraceTextBytes - others : 0;
  return guid + "," + name_text(device.name, std::max(left, kLeastName)) + "," + controls;
}

}  // namespace gaitpad
