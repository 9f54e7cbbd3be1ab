#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "hid/sdl_mapping.h"
#include "hid/sdl_numbers.h"
#include "hid/trace.h"

namespace gaitpad {

namespace {

constexpr unsigned kCodesByKernel = 0x8000;
constexpr std::array<std::string_view, kAxisCount> kSdlAxes = {
    "leftx", "lefty", "rightx", "righty", "lefttrigger", "righttrigger"};

bool is_upward(PadAxis axis) { return axis == kLeftY || axis == kRightY; }

// Where a field stands among SDL's numbers.
class FieldNumbers {
 public:
  FieldNumbers(const ReportDescriptor& d, StatedBy who)
      : descriptor_(d), numbers_(sdl_numbers(d, who)) {}

  // `a2`, `b3`, `h0.4`, with `+` or `-` for a part of an axis; empty: it has none.
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
  // Of a whole hat: `h0.` and the directions.
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
  // The field that was bound, and the source by which a line's number is bound to it.
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

// Control and source; of a stick's side the sign stands before the control.
struct Pair {
  std::string control, sign, source;
  bool operator<(const Pair& b) const {
    return std::tie(control, sign, source) < std::tie(b.control, b.sign, b.source);
  }
};
using Pairs = std::set<Pair>;

void add(Pairs& pairs, std::string_view control, std::string_view sign, std::string source) {
  const auto is_same = [control](const Pair& p) { return p.control == control; };
  const auto known = std::count_if(pairs.begin(), pairs.end(), is_same);
  if (source.empty() || known >= static_cast<std::ptrdiff_t>(kMaxSdlSources)) return;
  pairs.insert({std::string(control), std::string(sign), std::move(source)});
}

// The axes of a pad that this one of the layout's moves, and which way.
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

// SDL's y grows towards the thumb's owner, ours away from it.
std::string_view sign_of(PadAxis axis, bool is_positive) {
  return is_positive != is_upward(axis) ? "+" : "-";
}

void add_axes(const ReportLayout& report, const FieldNumbers& numbers, const StickAxes& sticks,
              Pairs& pairs) {
  for (const AxisOp& op : report.axes) {
    for (const Moved& m : moved_by(op.axis, sticks)) {
      bool falls = op.reversed;  // the control's value, in SDL's directions, where the field grows
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
    if (!report.exact_sizes.empty()) continue;  // not of the descriptor that the kernel reads
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
    constexpr std::size_t kNameBytes = 11;  // and a zero
    const std::size_t size = std::min(device.name.size(), kNameBytes);
    std::copy_n(device.name.begin(), size, guid.begin() + 4);
  }
  std::string text;
  for (const std::uint8_t byte : guid) text += fmt::format("{:02x}", byte);
  return text;
}

// One part of a line: no comma, no control character, and short enough for a trace.
std::string name_text(const std::string& name, std::size_t max_bytes) {
  std::string text;
  for (const char c : name) {
    text += c == ',' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  if (text.empty()) text = "Pad";
  if (text.size() <= max_bytes) return text;
  std::size_t end = max_bytes;  // not within a character
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end);
}

}  // namespace

std::string kernel_numbers_problem(const DeviceInfo& device, const ReportDescriptor& descriptor) {
  if (stated_by(device.driver) == StatedBy::evdev_driver) return {};
  constexpr std::uint32_t kVendorPads[] = {usage_of(0xff5d, 0x01), usage_of(0xff47, 0xd0)};
  const auto is_vendor_pad = [&descriptor](std::uint32_t u) {
    const auto& all = descriptor.applications;
    return std::find(all.begin(), all.end(), u) != all.end();
  };
  if ((device.version & kCodesByKernel) == 0 &&
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
  for (const Pair& p : pairs) controls += p.sign + p.control + ":" + p.source + ",";
  controls += "platform:Linux,";
  const std::string guid = guid_text(device, device.version);
  const std::size_t others = guid.size() + controls.size() + 2;
  constexpr std::size_t kLeastName = 16;
  const std::size_t left = others < kMaxTraceTextBytes ? kMaxTraceTextBytes - others : 0;
  return guid + "," + name_text(device.name, std::max(left, kLeastName)) + "," + controls;
}

}  // namespace gaitpad
