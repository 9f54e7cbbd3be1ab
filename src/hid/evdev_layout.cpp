#include "hid/evdev_layout.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <iterator>
#include <limits>
#include <map>

#include "gaitpad/decode.h"
#include "hid/descriptor_items.h"

namespace gaitpad {

// ---- The tables: usages (HID Usage Tables) and codes (Linux's input-event-codes.h)

namespace evdev {
namespace {

constexpr EvdevCode key(std::uint16_t code) { return {EvdevType::key, code}; }
constexpr EvdevCode axis(std::uint16_t code) { return {EvdevType::absolute, code}; }

struct Row {
  std::uint32_t usage = 0;
  EvdevCode code;
};
template <class Table>
const Row* row_of(const Table& table, std::uint32_t usage) noexcept {
  const auto it = std::find_if(std::begin(table), std::end(table),
                               [usage](const Row& row) { return row.usage == usage; });
  return it == std::end(table) ? nullptr : &*it;
}

// Pages of the HID Usage Tables.
constexpr std::uint16_t kDesktop = 0x01, kSimulation = 0x02, kConsumer = 0x0c;
constexpr std::uint16_t kKeyUnknown = 240;
constexpr std::uint32_t kBatteryStrength = usage_of(0x06, 0x20);

// Axes whose code several fields may get (hid-input clears it before it assigns it).
constexpr Row kSharedAxes[] = {
    {usage::kX, axis(0x00)},
    {usage::kY, axis(0x01)},
    {usage::kZ, axis(0x02)},
    {usage::kRx, axis(0x03)},
    {usage::kRy, axis(0x04)},
    {usage::kRz, axis(0x05)},
    {usage_of(kConsumer, 0xe0), axis(0x20)},  // volume
};
constexpr std::uint32_t kWheel = usage_of(kDesktop, 0x38);
constexpr Row kAxes[] = {
    {usage_of(kDesktop, 0x36), axis(0x06)},  // slider: ABS_THROTTLE
    {usage_of(kDesktop, 0x37), axis(0x07)},  // dial: ABS_RUDDER
    {kWheel, axis(0x08)},
    {usage::kRudder, axis(0x07)},
    {usage::kThrottle, axis(0x06)},
    {usage::kAccelerator, axis(0x09)},  // ABS_GAS
    {usage::kBrake, axis(0x0a)},
    {usage_of(kSimulation, 0xc8), axis(0x08)},  // steering: ABS_WHEEL
};

// Keys other than the buttons: the system controls, and what pads and remotes have of the consumer
// page. Any other consumer usage becomes KEY_UNKNOWN.
constexpr Row kKeys[] = {
    {usage::kStart, key(0x13b)},
    {usage::kSelect, key(0x13a)},
    {usage_of(kDesktop, 0x81), key(116)},    // power down
    {usage_of(kDesktop, 0x82), key(142)},    // sleep
    {usage_of(kDesktop, 0x83), key(143)},    // wake up
    {usage_of(kDesktop, 0x84), key(0x1b6)},  // context menu
    {usage::kSystemMainMenu, key(139)},
    {usage_of(kDesktop, 0x86), key(148)},    // application menu
    {usage_of(kDesktop, 0x87), key(138)},    // help
    {usage_of(kDesktop, 0x88), key(174)},    // exit
    {usage_of(kDesktop, 0x89), key(0x161)},  // select
    {usage_of(kDesktop, 0x8a), key(106)},    // right, left, up, down
    {usage_of(kDesktop, 0x8b), key(105)},
    {usage_of(kDesktop, 0x8c), key(103)},
    {usage_of(kDesktop, 0x8d), key(108)},
    {usage_of(kDesktop, 0x8e), key(0x164)},   // cold restart
    {usage_of(kDesktop, 0x8f), key(0x198)},   // warm restart
    {usage_of(kDesktop, 0xb5), key(227)},     // display toggle
    {usage_of(kConsumer, 0x30), key(116)},    // power
    {usage_of(kConsumer, 0x32), key(142)},    // sleep
    {usage_of(kConsumer, 0x36), key(0x100)},  // function buttons: BTN_MISC
    {usage_of(kConsumer, 0x40), key(139)},    // menu, its pick, up, down, left, right, escape
    {usage_of(kConsumer, 0x41), key(0x161)},
    {usage_of(kConsumer, 0x42), key(103)},
    {usage_of(kConsumer, 0x43), key(108)},
    {usage_of(kConsumer, 0x44), key(105)},
    {usage_of(kConsumer, 0x45), key(106)},
    {usage_of(kConsumer, 0x46), key(1)},
    {usage_of(kConsumer, 0x65), key(212)},   // snapshot: KEY_CAMERA
    {usage_of(kConsumer, 0x82), key(0xf1)},  // mode step, recall last, enter channel
    {usage_of(kConsumer, 0x83), key(0x195)},
    {usage_of(kConsumer, 0x84), key(28)},
    {usage_of(kConsumer, 0xb0), key(207)},  // play, pause, record, fast forward, rewind
    {usage_of(kConsumer, 0xb1), key(119)},
    {usage::kConsumerRecord, key(167)},
    {usage_of(kConsumer, 0xb3), key(208)},
    {usage_of(kConsumer, 0xb4), key(168)},
    {usage_of(kConsumer, 0xb5), key(163)},  // next, previous, stop, eject
    {usage_of(kConsumer, 0xb6), key(165)},
    {usage_of(kConsumer, 0xb7), key(166)},
    {usage_of(kConsumer, 0xb8), key(161)},
    {usage_of(kConsumer, 0xb9), key(0x19a)},  // shuffle, repeat, slow
    {usage_of(kConsumer, 0xbc), key(0x1b7)},
    {usage_of(kConsumer, 0xbf), key(0x199)},
    {usage_of(kConsumer, 0xcd), key(164)},  // play/pause
    {usage_of(kConsumer, 0xe2), key(113)},  // mute, volume up, down
    {usage_of(kConsumer, 0xe9), key(115)},
    {usage_of(kConsumer, 0xea), key(114)},
    {usage_of(kConsumer, 0x1a2), key(0x244)},  // task select
    {usage_of(kConsumer, 0x1cb), key(0x247)},  // assistant
    {usage_of(kConsumer, 0x221), key(217)},    // search
    {usage::kConsumerHome, key(172)},
    {usage::kConsumerBack, key(158)},
    {usage_of(kConsumer, 0x225), key(159)},  // forward, stop, refresh
    {usage_of(kConsumer, 0x226), key(128)},
    {usage_of(kConsumer, 0x227), key(173)},
};

constexpr Row kDpad[] = {
    {usage::kDpadUp, key(kBtnDpadUp)},
    {usage::kDpadDown, key(kBtnDpadUp + 1)},
    {usage::kDpadLeft, key(kBtnDpadUp + 2)},
    {usage::kDpadRight, key(kBtnDpadUp + 3)},
};

// The usages by which the evdev driver states codes that are no buttons.
constexpr Row kStated[] = {
    {usage::kX, axis(0x00)},
    {usage::kY, axis(0x01)},
    {usage::kZ, axis(0x02)},
    {usage::kRx, axis(0x03)},
    {usage::kRy, axis(0x04)},
    {usage::kRz, axis(0x05)},
    {usage::kThrottle, axis(0x06)},
    {usage::kRudder, axis(0x07)},
    {kWheel, axis(0x08)},
    {usage::kAccelerator, axis(0x09)},
    {usage::kBrake, axis(0x0a)},
    {usage::kHatSwitch, axis(kAbsHat0X)},
    {usage::kStart, key(0x13b)},
    {usage::kSelect, key(0x13a)},
    {usage::kSystemMainMenu, key(139)},
    {usage::kConsumerRecord, key(167)},
    {usage::kConsumerHome, key(172)},
    {usage::kConsumerBack, key(158)},
    {usage::kDpadUp, key(kBtnDpadUp)},
    {usage::kDpadDown, key(kBtnDpadUp + 1)},
    {usage::kDpadLeft, key(kBtnDpadUp + 2)},
    {usage::kDpadRight, key(kBtnDpadUp + 3)},
};

}  // namespace
}  // namespace evdev

// ---- Codes of a descriptor's fields

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
// 0: the code is no button of that application.
std::uint16_t button_number(std::uint16_t code, std::uint32_t application) noexcept {
  const std::uint16_t first = first_button(application);
  if (code >= first && code < first + kPadButtons) {
    return static_cast<std::uint16_t>(code - first + 1);
  }
  if (!has_happy_buttons(application) || code < evdev::kBtnTriggerHappy) return 0;
  return static_cast<std::uint16_t>(code - evdev::kBtnTriggerHappy + kPadButtons + 1);
}

// Pages that hid-input ignores, or maps to something other than keys and axes.
bool is_ignored(std::uint16_t page) noexcept {
  constexpr std::uint16_t kIgnored[] = {0x00,    // undefined page
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

// The code that hid-input wants for a usage; it may be taken already.
struct WantedCode {
  EvdevCode code;
  bool is_shared = false;  // the usage gets the code even if another one has it
};

std::optional<WantedCode> code_of_unknown(const Field& f) noexcept {
  if (f.bit_size == 1) return WantedCode{key(evdev::kBtnMisc)};
  if (f.is_relative) return std::nullopt;
  return WantedCode{axis(0x28)};  // the code ABS_MISC
}

std::optional<WantedCode> wanted_code(const Field& f, std::uint32_t u,
                                      std::uint32_t application) noexcept {
  const std::uint16_t page = page_of(u);
  if (is_ignored(page) || u == evdev::kBatteryStrength) return std::nullopt;
  if (page == usage::kButtonPage) {
    const auto code = button_code(id_of(u), application);
    return code ? std::optional<WantedCode>(WantedCode{*code}) : std::nullopt;
  }
  if (u == usage::kHatSwitch || evdev::row_of(evdev::kDpad, u))
    return WantedCode{axis(evdev::kAbsHat0X)};
  if (const evdev::Row* row = evdev::row_of(evdev::kKeys, u)) return WantedCode{row->code, true};
  const evdev::Row* shared = evdev::row_of(evdev::kSharedAxes, u);
  const evdev::Row* row = shared ? shared : evdev::row_of(evdev::kAxes, u);
  if (row && f.is_relative) return std::nullopt;
  if (row) return WantedCode{row->code, shared != nullptr};
  if (page == evdev::kConsumer && id_of(u) != 0) return WantedCode{key(evdev::kKeyUnknown), true};
  if (page == evdev::kConsumer || page == evdev::kSimulation) return std::nullopt;
  return code_of_unknown(f);
}

// Assigns the codes of an input node as hid-input does.
class LaidOutNode {
 public:
  bool take(const WantedCode& wanted) {
    if (wanted.code.type == EvdevType::key) return take(keys_, wanted);
    return take(axes_, wanted);
  }
  // Assigns both codes of the pair. The D-pad usages share one pair, hats do not.
  bool take_hat(bool is_dpad) {
    if (is_dpad && dpad_has_hat_) return true;
    if (!take(axes_, {axis(evdev::kAbsHat0X)})) return false;
    axes_.set(evdev::kAbsHat0X + 1);
    dpad_has_hat_ = is_dpad;
    return true;
  }

 private:
  template <std::size_t N>
  static bool take(std::bitset<N>& taken, const WantedCode& wanted) {
    const bool was_taken = taken[wanted.code.code];
    taken.set(wanted.code.code);
    return !was_taken || wanted.is_shared;
  }
  std::bitset<evdev::kKeyMax + 1> keys_;
  std::bitset<evdev::kAbsMax + 1> axes_;
  bool dpad_has_hat_ = false;
};

std::uint32_t application_of(const ReportDescriptor& d, const Field& f) {
  return f.application < d.applications.size() ? d.applications[f.application] : 0;
}

// Indices of the fields of the pad's node in the kernel's order: report by report, in the order of
// their first occurrence. A report belongs to the application of its first field.
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

// An array gets a code for each usage that it can name.
void take_array(const ReportDescriptor& d, const Field& f, LaidOutNode& node) {
  for (std::uint32_t i = 0; i < f.range_count; ++i) {
    const UsageRange& range = d.ranges[f.first_range + i];
    for (std::uint32_t u = range.first; u <= range.last && u >= range.first; ++u) {
      if (const auto wanted = wanted_code(f, u, application_of(d, f))) node.take(*wanted);
    }
  }
}

using Codes = std::vector<std::optional<EvdevCode>>;

// The axis that follows this one on pads: Y after X, Rz after Z, Ry after Rx.
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

// Lets one field keep a shared code: the first; but of several X (DragonRise and Mega Drive pads
// state dead ones) the one beside Y, of several Z the one beside Rz, and so on. All fields of a
// D-pad keep theirs.
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
  LaidOutNode node;
  std::optional<std::uint32_t> last_array;
  for (const std::size_t i : node_fields(d)) {
    const Field& f = d.fields[i];
    if (f.is_array) {
      if (last_array != f.first_range) take_array(d, f, node);
      last_array = f.first_range;
      continue;
    }
    const auto wanted = wanted_code(f, f.usage, application_of(d, f));
    if (!wanted) continue;
    const bool is_hat = wanted->code == axis(evdev::kAbsHat0X);
    const bool is_mine = is_hat ? node.take_hat(f.usage != usage::kHatSwitch) : node.take(*wanted);
    if (is_mine) codes[i] = wanted->code;
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

// ---- The report and the descriptor of a node

namespace {

constexpr std::uint16_t kFirstMultiTouch = 0x2f;  // the code ABS_MT_SLOT
constexpr std::int64_t kHatReleased = 8;

// Writes report-descriptor items, each as short as its value allows.
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
  // Wide enough to be the same number signed and unsigned.
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

// The application that hid-input's button codes stand for; multi-axis for numbered buttons alone.
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

// The first hat is stated as a HID hat if both of its axes have three positions. Other hats are
// stated as two axes each, because HID does not number hats.
bool has_digital_hat(const std::vector<EvdevAxis>& axes) {
  const auto is_switch = [&axes](std::uint16_t code) {
    return std::any_of(axes.begin(), axes.end(), [code](const EvdevAxis& a) {
      return a.code == code && a.min == -1 && a.max == 1;
    });
  };
  return is_switch(evdev::kAbsHat0X) && is_switch(evdev::kAbsHat0X + 1);
}

// Position of each axis in the device's own descriptor.
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

  // Writes usages of one page; neighbours as a range.
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

// Position of a HID hat: 0 is up, then clockwise; y grows downwards.
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
