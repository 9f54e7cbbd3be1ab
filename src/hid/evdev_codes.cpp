#include "hid/evdev_codes.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <iterator>

#include "hid/default_map.h"
#include "hid/evdev_tables.h"

namespace gaitpad {

namespace {

using evdev::axis, evdev::key;

constexpr std::uint16_t kOwnPage = 0xffe5, kOwnKeys = 0x1000, kOwnAxes = 0x3000;

// Codes of the buttons from 1 on; pads have 16 of them and go on at BTN_TRIGGER_HAPPY.
constexpr std::uint32_t kPadButtons = 16;
bool has_happy_buttons(std::uint32_t application) noexcept {
  return application == usage::kJoystick || application == usage::kGamePad;
}
std::uint16_t first_button(std::uint32_t application) noexcept {
  constexpr std::uint32_t kPointer = usage_of(evdev::kDesktop, 0x01),
                          kMouse = usage_of(evdev::kDesktop, 0x02);
  if (application == usage::kJoystick) return evdev::kBtnJoystick;
  if (application == usage::kGamePad) return evdev::kBtnGamepad;
  if (application == kMouse || application == kPointer) return evdev::kBtnMouse;
  return evdev::kBtnMisc;
}
std::optional<EvdevCode> button_code(std::uint32_t number, std::uint32_t application) noexcept {
  if (number == 0) return std::nullopt;
  const bool is_happy = has_happy_buttons(application) && number > kPadButtons;
  const std::uint32_t code = is_happy ? evdev::kBtnTriggerHappy + number - kPadButtons - 1
                                      : std::uint32_t{first_button(application)} + number - 1;
  if (code > evdev::kKeyMax) return std::nullopt;
  return key(static_cast<std::uint16_t>(code));
}
// 0: the code is none of that application's buttons.
std::uint16_t button_number(std::uint16_t code, std::uint32_t application) noexcept {
  const std::uint16_t first = first_button(application);
  if (code >= first && code < first + kPadButtons) {
    return static_cast<std::uint16_t>(code - first + 1);
  }
  if (!has_happy_buttons(application) || code < evdev::kBtnTriggerHappy) return 0;
  return static_cast<std::uint16_t>(code - evdev::kBtnTriggerHappy + kPadButtons + 1);
}

// Pages that hid-input leaves alone or makes something else of than keys and axes.
bool is_ignored(std::uint16_t page) noexcept {
  constexpr std::uint16_t kIgnored[] = {0x00,    // undefined
                                        0x07,    // keyboard
                                        0x08,    // LEDs
                                        0x0b,    // telephony
                                        0x0d,    // digitizers
                                        0x0f,    // force feedback
                                        0x84,    // power
                                        0x85,    // battery
                                        0x90,    // camera
                                        0x00ff,  // vendors
                                        0xff00, 0xff01, 0xff09, 0xff43, 0xff7f, 0xffbc};
  return std::find(std::begin(kIgnored), std::end(kIgnored), page) != std::end(kIgnored);
}

// What hid-input wants for a usage, before it looks whether the code is free.
struct Wish {
  EvdevCode code;
  bool is_shared = false;  // it takes the code in any case
};

std::optional<Wish> unknown_wish(const Field& f) noexcept {
  if (f.bit_size == 1) return Wish{key(evdev::kBtnMisc)};
  if (f.is_relative) return std::nullopt;
  return Wish{axis(0x28)};  // ABS_MISC
}

std::optional<Wish> wish_of(const Field& f, std::uint32_t u, std::uint32_t application) noexcept {
  const std::uint16_t page = page_of(u);
  if (is_ignored(page) || u == evdev::kBatteryStrength) return std::nullopt;
  if (page == usage::kButtonPage) {
    const auto code = button_code(id_of(u), application);
    return code ? std::optional<Wish>(Wish{*code}) : std::nullopt;
  }
  if (u == usage::kHatSwitch || evdev::row_of(evdev::kDpad, u)) return Wish{axis(evdev::kAbsHat0X)};
  if (const evdev::Row* row = evdev::row_of(evdev::kKeys, u)) return Wish{row->code, true};
  const evdev::Row* shared = evdev::row_of(evdev::kSharedAxes, u);
  const evdev::Row* row = shared ? shared : evdev::row_of(evdev::kAxes, u);
  if (row && f.is_relative) return std::nullopt;
  if (row) return Wish{row->code, shared != nullptr};
  if (page == evdev::kConsumer && id_of(u) != 0) return Wish{key(evdev::kKeyUnknown), true};
  if (page == evdev::kConsumer || page == evdev::kSimulation) return std::nullopt;
  return unknown_wish(f);
}

// The codes that an input node has, as hid-input hands them out.
class InputNode {
 public:
  bool take(const Wish& wish) {
    if (wish.code.type == EvdevType::key) return take(keys_, wish);
    return take(axes_, wish);
  }
  // The pair is taken whole; D-pad usages share it among themselves, hats do not.
  bool take_hat(bool is_dpad) {
    if (is_dpad && dpad_has_hat_) return true;
    if (!take(axes_, {axis(evdev::kAbsHat0X)})) return false;
    axes_.set(evdev::kAbsHat0X + 1);
    dpad_has_hat_ = is_dpad;
    return true;
  }

 private:
  template <std::size_t N>
  static bool take(std::bitset<N>& taken, const Wish& wish) {
    const bool was_taken = taken[wish.code.code];
    taken.set(wish.code.code);
    return !was_taken || wish.is_shared;
  }
  std::bitset<evdev::kKeyMax + 1> keys_;
  std::bitset<evdev::kAbsMax + 1> axes_;
  bool dpad_has_hat_ = false;
};

std::uint32_t application_of(const ReportDescriptor& d, const Field& f) {
  return f.application < d.applications.size() ? d.applications[f.application] : 0;
}

// Indices of the fields that go to the pad's node, in the kernel's order: report by report, as the
// reports first occur. A report belongs to the application of its first field.
std::vector<std::size_t> node_fields(const ReportDescriptor& d) {
  const std::optional<std::size_t> pad = pad_application(d);
  if (!pad) return {};
  std::array<std::vector<std::size_t>, 256> by_report;
  for (std::size_t i = 0; i < d.fields.size(); ++i) {
    if (d.fields[i].kind == FieldKind::input) by_report[d.fields[i].report_id].push_back(i);
  }
  const std::vector<std::size_t> of_pad = pad_fields(d);
  std::vector<std::size_t> in_order, keys;
  for (const ReportLength& report : d.reports) {
    const std::vector<std::size_t>& fields = by_report[report.report_id];
    if (report.kind != FieldKind::input || fields.empty()) continue;
    const bool in_node = application_of(d, d.fields[fields.front()]) == d.applications[*pad];
    for (const std::size_t i : fields) {
      if (in_node) {
        in_order.push_back(i);
      } else if (std::binary_search(of_pad.begin(), of_pad.end(), i)) {
        keys.push_back(i);
      }
    }
  }
  in_order.insert(in_order.end(), keys.begin(), keys.end());
  return in_order;
}

// An array takes a code for every usage that it can name.
void take_array(const ReportDescriptor& d, const Field& f, InputNode& node) {
  for (std::uint32_t i = 0; i < f.range_count; ++i) {
    const UsageRange& range = d.ranges[f.first_range + i];
    for (std::uint32_t u = range.first; u <= range.last && u >= range.first; ++u) {
      if (const auto wish = wish_of(f, u, application_of(d, f))) node.take(*wish);
    }
  }
}

using Codes = std::vector<std::optional<EvdevCode>>;

// The axis that stands right behind this one on pads: Y behind X, Rz behind Z, Ry behind Rx.
std::optional<std::uint16_t> partner_axis(std::uint16_t code) noexcept {
  constexpr std::array<std::uint16_t, 4> kPartners = {0x01, 0, 0x05, 0x04};
  if (code != 0x00 && code != 0x02 && code != 0x03) return std::nullopt;
  return kPartners[code];
}

bool stands_before(const ReportDescriptor& d, const Codes& codes, std::size_t index,
                   std::uint16_t partner) {
  if (index + 1 >= codes.size() || codes[index + 1] != axis(partner)) return false;
  const Field &f = d.fields[index], &next = d.fields[index + 1];
  return next.report_id == f.report_id && f.bit_offset + f.bit_size == next.bit_offset;
}

// Of the fields that share a code one keeps it: the first one, but of several X (DragonRise and
// Mega Drive pads state dead ones) the one beside Y, and so on. A D-pad's fields all keep theirs.
void keep_one_of_each(const ReportDescriptor& d, Codes& codes) {
  std::array<std::optional<std::size_t>, evdev::kAbsMax + 1> axis_owner;
  std::array<std::optional<std::size_t>, evdev::kKeyMax + 1> key_owner;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!codes[i] || codes[i] == axis(evdev::kAbsHat0X)) continue;
    const bool is_axis = codes[i]->type == EvdevType::absolute;
    std::optional<std::size_t>& owner =
        is_axis ? axis_owner[codes[i]->code] : key_owner[codes[i]->code];
    if (!owner) {
      owner = i;
      continue;
    }
    const auto partner = is_axis ? partner_axis(codes[i]->code) : std::nullopt;
    const bool is_better = partner && !stands_before(d, codes, *owner, *partner) &&
                           stands_before(d, codes, i, *partner);
    codes[is_better ? *owner : i].reset();
    if (is_better) owner = i;
  }
}

Codes kernel_codes(const ReportDescriptor& d) {
  Codes codes(d.fields.size());
  InputNode node;
  std::optional<std::uint32_t> last_array;
  for (const std::size_t i : node_fields(d)) {
    const Field& f = d.fields[i];
    if (f.is_array) {
      if (last_array != f.first_range) take_array(d, f, node);
      last_array = f.first_range;
      continue;
    }
    const auto wish = wish_of(f, f.usage, application_of(d, f));
    if (!wish) continue;
    const bool is_hat = wish->code == axis(evdev::kAbsHat0X);
    const bool is_mine = is_hat ? node.take_hat(f.usage != usage::kHatSwitch) : node.take(*wish);
    if (is_mine) codes[i] = wish->code;
  }
  keep_one_of_each(d, codes);
  return codes;
}

std::optional<EvdevCode> stated_code(std::uint32_t u, std::uint32_t application) noexcept {
  const std::uint16_t id = id_of(u);
  if (page_of(u) == usage::kButtonPage) return button_code(id, application);
  if (const evdev::Row* row = evdev::row_of(evdev::kStated, u)) return row->code;
  if (page_of(u) != kOwnPage) return std::nullopt;
  if (id >= kOwnAxes && id <= kOwnAxes + evdev::kAbsMax) {
    return axis(static_cast<std::uint16_t>(id - kOwnAxes));
  }
  if (id >= kOwnKeys && id <= kOwnKeys + evdev::kKeyMax) {
    return key(static_cast<std::uint16_t>(id - kOwnKeys));
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::optional<EvdevCode>> evdev_codes(const ReportDescriptor& d, StatedBy stated_by) {
  if (stated_by == StatedBy::device) return kernel_codes(d);
  Codes codes(d.fields.size());
  for (std::size_t i = 0; i < d.fields.size(); ++i) {
    const Field& f = d.fields[i];
    if (f.kind != FieldKind::input || f.is_array) continue;
    codes[i] = stated_code(f.usage, application_of(d, f));
  }
  return codes;
}

std::uint32_t usage_of_code(EvdevCode code, std::uint32_t application) noexcept {
  if (code.type == EvdevType::key) {
    const std::uint16_t number = button_number(code.code, application);
    if (number != 0) return usage_of(usage::kButtonPage, number);
  }
  for (const evdev::Row& row : evdev::kStated) {
    if (row.code == code) return row.usage;
  }
  return own_usage_of_code(code);
}

std::uint32_t own_usage_of_code(EvdevCode code) noexcept {
  const std::uint16_t first = code.type == EvdevType::key ? kOwnKeys : kOwnAxes;
  return usage_of(kOwnPage, static_cast<std::uint16_t>(first + code.code));
}

}  // namespace gaitpad
