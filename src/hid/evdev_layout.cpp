#include "hid/evdev_layout.h"

#include <algorithm>
#include <limits>
#include <map>

#include "hid/descriptor_items.h"

namespace gaitpad {

namespace {

constexpr std::uint16_t kFirstMultiTouch = 0x2f;  // ABS_MT_SLOT
constexpr std::int64_t kHatReleased = 8;
constexpr std::uint8_t kApplicationCollection = 0x01;

// Report-descriptor items, each as short as its value allows.
class ItemWriter {
 public:
  void page(std::uint32_t usage) {
    add(ItemType::global, tag::kUsagePage, page_of(usage), page_of(usage) > 0xff ? 2 : 1);
  }
  void usage(std::uint32_t usage) {
    page(usage);
    local(tag::kUsage, usage);
  }
  void local(std::uint8_t tag, std::uint32_t usage) {
    add(ItemType::local, tag, id_of(usage), id_of(usage) > 0xff ? 2 : 1);
  }
  // Wide enough to be the same number in a signed reading, so that no reader errs.
  void global(std::uint8_t tag, std::int64_t value) {
    const auto fits = [value](int bits) {
      return value >= -(std::int64_t{1} << (bits - 1)) && value < (std::int64_t{1} << (bits - 1));
    };
    add(ItemType::global, tag, value, fits(8) ? 1 : fits(16) ? 2 : 4);
  }
  void main(std::uint8_t tag, std::uint32_t flags) { add(ItemType::main, tag, flags, 1); }
  void end_collection() { add(ItemType::main, tag::kEndCollection, 0, 0); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  void add(ItemType type, std::uint8_t tag, std::int64_t value, int size) {
    const int size_code = size == 4 ? 3 : size;
    const int prefix = (tag << 4) | (static_cast<int>(type) << 2) | size_code;
    bytes_.push_back(static_cast<std::uint8_t>(prefix));
    for (int i = 0; i < size; ++i) {
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
  }
  std::vector<std::uint8_t> bytes_;
};

// Game pad and joystick as hid-input's button codes tell them; else what has numbered buttons only.
std::uint32_t application_of(const std::vector<std::uint16_t>& keys) {
  const auto has_any = [&keys](std::uint16_t first, std::uint16_t end) {
    return std::any_of(keys.begin(), keys.end(),
                       [=](std::uint16_t k) { return k >= first && k < end; });
  };
  if (has_any(evdev::kBtnGamepad, evdev::kBtnGamepad + 1)) return usage::kGamePad;
  if (has_any(evdev::kBtnJoystick, evdev::kBtnGamepad)) return usage::kJoystick;
  if (has_any(evdev::kBtnGamepad, evdev::kBtnDigi)) return usage::kGamePad;
  return has_any(evdev::kBtnMisc, evdev::kBtnMouse) ? usage::kMultiAxis : usage::kGamePad;
}

bool is_hat_code(std::uint16_t code) {
  return code >= evdev::kAbsHat0X && code <= evdev::kAbsHat3Y;
}

// The first hat is a HID hat where both of its axes know three positions. Another one is stated as
// two axes, since HID cannot say which hat it is.
bool has_digital_hat(const std::vector<EvdevAxis>& axes) {
  const auto is_switch = [&axes](std::uint16_t code) {
    return std::any_of(axes.begin(), axes.end(), [code](const EvdevAxis& a) {
      return a.code == code && a.min == -1 && a.max == 1;
    });
  };
  return is_switch(evdev::kAbsHat0X) && is_switch(evdev::kAbsHat0X + 1);
}

// Position of each axis in a descriptor of the device's own.
std::map<std::uint16_t, std::size_t> axis_ranks(std::span<const std::uint8_t> own_descriptor) {
  std::map<std::uint16_t, std::size_t> ranks;
  const auto parsed = parse_descriptor(own_descriptor);
  if (!parsed) return ranks;
  const auto codes = evdev_codes(*parsed);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (codes[i] && codes[i]->type == EvdevType::absolute) ranks.emplace(codes[i]->code, i);
  }
  return ranks;
}

std::vector<EvdevAxis> axes_in_order(const EvdevAbilities& abilities,
                                     std::span<const std::uint8_t> own_descriptor) {
  std::vector<EvdevAxis> axes;
  for (const EvdevAxis& a : abilities.axes) {
    if (a.code < kFirstMultiTouch) axes.push_back(a);
  }
  if (own_descriptor.empty()) return axes;
  const auto ranks = axis_ranks(own_descriptor);
  const auto rank = [&ranks](const EvdevAxis& a) {
    const auto it = ranks.find(a.code);
    return it == ranks.end() ? std::numeric_limits<std::size_t>::max() : it->second;
  };
  std::stable_sort(axes.begin(), axes.end(),
                   [&](const EvdevAxis& a, const EvdevAxis& b) { return rank(a) < rank(b); });
  return axes;
}

std::uint8_t bits_for(std::int32_t min, std::int32_t max) {
  if (min < 0) {
    if (min >= -128 && max <= 127) return 8;
    return min >= -32768 && max <= 32767 ? 16 : 32;
  }
  return max <= 255 ? 8 : max <= 65535 ? 16 : 32;
}

class LayoutBuilder {
 public:
  explicit LayoutBuilder(std::uint32_t application) : application_(application) {
    items_.usage(application);
    items_.main(tag::kCollection, kApplicationCollection);
  }

  void add_axis(const EvdevAxis& a) {
    EvdevField field = field_at(a.code, EvdevType::absolute);
    if (a.min < a.max) {
      field.min = a.min;
      field.max = a.max;
    }
    field.bit_size = bits_for(field.min, field.max);
    items_.usage(is_hat_code(a.code) ? own_usage_of_code(field.code)
                                     : usage_of_code(field.code, application_));
    items_.global(tag::kLogicalMinimum, field.min);
    items_.global(tag::kLogicalMaximum, field.max);
    add_input(field.bit_size, 1, main_flag::kVariable);
    layout_.fields.push_back(field);
  }

  void add_hat() {
    EvdevField field = field_at(evdev::kAbsHat0X, EvdevType::absolute);
    field.is_hat = true;
    field.bit_size = 4;
    items_.usage(usage_of_code(field.code, application_));
    items_.global(tag::kLogicalMinimum, 0);
    items_.global(tag::kLogicalMaximum, 7);
    items_.global(tag::kPhysicalMinimum, 0);
    items_.global(tag::kPhysicalMaximum, 315);
    add_input(field.bit_size, 1, main_flag::kVariable | main_flag::kNullState);
    items_.global(tag::kPhysicalMaximum, 0);
    layout_.fields.push_back(field);
    fill_byte();
  }

  void add_keys(const std::vector<std::uint16_t>& keys) {
    items_.global(tag::kLogicalMinimum, 0);
    items_.global(tag::kLogicalMaximum, 1);
    std::vector<std::uint32_t> usages;
    for (const std::uint16_t code : keys) {
      const std::uint32_t u = usage_of_code({EvdevType::key, code}, application_);
      if (!usages.empty() && page_of(u) != page_of(usages.back())) {
        add_key_usages(usages);
        usages.clear();
      }
      EvdevField field = field_at(code, EvdevType::key);
      field.bit_offset = static_cast<std::uint16_t>(bits_ + usages.size());
      field.bit_size = 1;
      field.max = 1;
      layout_.fields.push_back(field);
      usages.push_back(u);
    }
    if (!usages.empty()) add_key_usages(usages);
    fill_byte();
  }

  EvdevLayout take() {
    items_.end_collection();
    layout_.descriptor = items_.take();
    layout_.report_bytes = static_cast<std::uint16_t>(bits_ / 8);
    return std::move(layout_);
  }

 private:
  EvdevField field_at(std::uint16_t code, EvdevType type) const {
    EvdevField field;
    field.code = {type, code};
    field.bit_offset = bits_;
    return field;
  }

  void add_input(std::uint8_t size, std::size_t count, std::uint32_t flags) {
    items_.global(tag::kReportSize, size);
    items_.global(tag::kReportCount, static_cast<std::int64_t>(count));
    items_.main(tag::kInput, flags);
    bits_ = static_cast<std::uint16_t>(bits_ + size * count);
  }

  // Usages of one page; neighbours as a range.
  void add_key_usages(const std::vector<std::uint32_t>& usages) {
    items_.page(usages.front());
    for (std::size_t first = 0; first < usages.size();) {
      std::size_t end = first + 1;
      while (end < usages.size() && usages[end] == usages[end - 1] + 1) ++end;
      if (end == first + 1) {
        items_.local(tag::kUsage, usages[first]);
      } else {
        items_.local(tag::kUsageMinimum, usages[first]);
        items_.local(tag::kUsageMaximum, usages[end - 1]);
      }
      first = end;
    }
    add_input(1, usages.size(), main_flag::kVariable);
  }

  void fill_byte() {
    if (bits_ % 8 == 0) return;
    add_input(static_cast<std::uint8_t>(8 - bits_ % 8), 1,
              main_flag::kConstant | main_flag::kVariable);
  }

  const std::uint32_t application_;
  ItemWriter items_;
  EvdevLayout layout_;
  std::uint16_t bits_ = 0;
};

// Clockwise from up; y grows downwards.
std::int64_t hat_position(std::int32_t x, std::int32_t y) noexcept {
  constexpr std::int64_t kPositions[3][3] = {{7, 0, 1}, {6, kHatReleased, 2}, {5, 4, 3}};
  return kPositions[std::clamp(y, -1, 1) + 1][std::clamp(x, -1, 1) + 1];
}

std::int64_t value_of(const EvdevField& f, const EvdevState& state) noexcept {
  if (f.code.type == EvdevType::key) return state.keys[f.code.code] ? 1 : 0;
  const std::int32_t value = state.axis[f.code.code];
  return f.is_hat ? hat_position(value, state.axis[f.code.code + 1])
                  : std::clamp(value, f.min, f.max);
}

}  // namespace

EvdevLayout evdev_layout(const EvdevAbilities& abilities,
                         std::span<const std::uint8_t> own_descriptor) {
  std::vector<std::uint16_t> keys;
  for (const std::uint16_t code : abilities.keys) {
    if (code <= evdev::kKeyMax) keys.push_back(code);
  }
  LayoutBuilder builder(application_of(keys));
  const std::vector<EvdevAxis> axes = axes_in_order(abilities, own_descriptor);
  const bool has_hat = has_digital_hat(axes);
  for (const EvdevAxis& a : axes) {
    const bool is_in_hat =
        has_hat && (a.code == evdev::kAbsHat0X || a.code == evdev::kAbsHat0X + 1);
    if (!is_in_hat) builder.add_axis(a);
  }
  if (has_hat) builder.add_hat();
  builder.add_keys(keys);
  return builder.take();
}

void put_state(const EvdevLayout& layout, const EvdevState& state, Report& report) noexcept {
  report.size = layout.report_bytes;
  std::fill_n(report.bytes.begin(), report.size, std::uint8_t{0});
  for (const EvdevField& f : layout.fields) {
    const auto value = static_cast<std::uint64_t>(value_of(f, state));
    for (std::uint32_t i = 0; i < f.bit_size; ++i) {
      const std::uint32_t bit = f.bit_offset + i;
      report.bytes[bit / 8] |= static_cast<std::uint8_t>(((value >> i) & 1u) << (bit % 8));
    }
  }
}

}  // namespace gaitpad
