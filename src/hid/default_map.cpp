#include "hid/default_map.h"

#include <algorithm>
#include <map>

namespace gaitpad {

namespace {

constexpr int kNone = kButtonCount;

bool is_pad_application(std::uint32_t u) {
  return u == usage::kJoystick || u == usage::kGamePad || u == usage::kMultiAxis;
}

// The fields of one report by usage. Of a usage that occurs several times the first counts.
class ReportFields {
 public:
  ReportFields(const ReportDescriptor& descriptor, const std::vector<std::size_t>& fields,
               std::uint8_t report_id)
      : descriptor_(descriptor) {
    for (const std::size_t i : fields) {
      const Field& f = descriptor.fields[i];
      if (f.report_id != report_id || f.is_array || f.is_relative) continue;
      all_.push_back(i);
      first_.emplace(f.usage, i);
    }
  }
  const std::vector<std::size_t>& all() const { return all_; }
  bool has(std::uint32_t u) const { return first_.count(u) != 0; }
  bool has(std::uint32_t a, std::uint32_t b) const { return has(a) && has(b); }
  std::size_t index(std::uint32_t u) const { return first_.at(u); }
  const Field& field(std::uint32_t u) const { return descriptor_.fields[index(u)]; }

  // DragonRise and Mega Drive pads state X (or Z) several times and mean the one beside Y (or Rz).
  std::size_t index_beside(std::uint32_t u, std::uint32_t next) const {
    const Field& y = field(next);
    for (const std::size_t i : all_) {
      const Field& f = descriptor_.fields[i];
      if (f.usage == u && f.bit_offset + f.bit_size == y.bit_offset) return i;
    }
    return index(u);
  }

 private:
  const ReportDescriptor& descriptor_;
  std::vector<std::size_t> all_;
  std::map<std::uint32_t, std::size_t> first_;
};

struct AxisPair {
  std::uint32_t x = 0, y = 0;
};
constexpr AxisPair kZPair{usage::kZ, usage::kRz};
constexpr AxisPair kRotationPair{usage::kRx, usage::kRy};

bool same_range(const Field& a, const Field& b) {
  return a.bit_size == b.bit_size && a.logical_min == b.logical_min &&
         a.logical_max == b.logical_max;
}
bool like_left_stick(const ReportFields& r, AxisPair pair) {
  return r.has(usage::kX) && same_range(r.field(pair.x), r.field(usage::kX)) &&
         same_range(r.field(pair.y), r.field(usage::kX));
}
bool side_by_side(const ReportFields& r, AxisPair pair) {
  const Field& a = r.field(pair.x);
  return a.bit_offset + a.bit_size == r.field(pair.y).bit_offset;
}

// Both pairs exist: one is the right stick, the other the triggers. Xbox has the stick on Rx, Ry,
// Sony on Z, Rz. The stick is as wide as the left one, its two axes are neighbours, and it comes
// first.
AxisPair right_stick_of_two(const ReportFields& r) {
  const bool z_alike = like_left_stick(r, kZPair),
             rotation_alike = like_left_stick(r, kRotationPair);
  if (z_alike != rotation_alike) return z_alike ? kZPair : kRotationPair;
  const bool z_near = side_by_side(r, kZPair), rotation_near = side_by_side(r, kRotationPair);
  if (z_near != rotation_near) return z_near ? kZPair : kRotationPair;
  if (!z_near) return kRotationPair;
  return r.field(kZPair.x).bit_offset < r.field(kRotationPair.x).bit_offset ? kZPair
                                                                            : kRotationPair;
}

std::optional<AxisPair> right_stick(const ReportFields& r) {
  const bool z = r.has(kZPair.x, kZPair.y), rotation = r.has(kRotationPair.x, kRotationPair.y);
  if (z && rotation) return right_stick_of_two(r);
  if (z) return kZPair;
  if (rotation) return kRotationPair;
  if (r.has(usage::kRudder, usage::kThrottle)) return AxisPair{usage::kRudder, usage::kThrottle};
  return std::nullopt;
}

std::optional<AxisPair> triggers(const ReportFields& r) {
  if (r.has(usage::kBrake, usage::kAccelerator)) {
    return AxisPair{usage::kBrake, usage::kAccelerator};
  }
  if (!r.has(kZPair.x, kZPair.y) || !r.has(kRotationPair.x, kRotationPair.y)) return std::nullopt;
  return right_stick_of_two(r).x == kZPair.x ? kRotationPair : kZPair;
}

void bind_axes(const ReportFields& r, std::vector<Binding>& out) {
  const auto bind = [&](PadAxis axis, std::size_t field) {
    out.push_back({ControlKind::axis, axis, field, 0, false});
  };
  if (r.has(usage::kX, usage::kY)) {
    bind(kLeftX, r.index_beside(usage::kX, usage::kY));
    bind(kLeftY, r.index(usage::kY));
  }
  if (const auto stick = right_stick(r)) {
    bind(kRightX, r.index_beside(stick->x, stick->y));
    bind(kRightY, r.index(stick->y));
  } else if (r.has(usage::kRz)) {
    bind(kRightX, r.index(usage::kRz));  // a flight stick's twist
  }
  if (const auto pair = triggers(r)) {
    bind(kLeftTrigger, r.index(pair->x));
    bind(kRightTrigger, r.index(pair->y));
  }
}

// Two-way switches where there are no trigger axes.
void bind_digital_triggers(const ReportFields& r, ButtonOrder order, std::vector<Binding>& out) {
  if (order == ButtonOrder::xinput || triggers(r)) return;
  const std::uint16_t left = order == ButtonOrder::android ? 9 : 7;
  for (std::uint16_t i = 0; i < 2; ++i) {
    const auto number = static_cast<std::uint16_t>(left + i);
    const std::uint32_t u = usage_of(usage::kButtonPage, number);
    if (r.has(u)) out.push_back({ControlKind::axis, kLeftTrigger + i, r.index(u), 0, false});
  }
}

// Keys of the consumer and system pages that pads have in place of buttons.
struct KeyRules {
  bool home_is_start = false;  // a pad with guide button and no start button (Asus)
  bool has_home = false, has_back = false;
};
KeyRules key_rules(const ReportDescriptor& d, const std::vector<std::size_t>& fields) {
  KeyRules rules;
  bool has_start = false, has_guide = false;
  for (const std::size_t i : fields) {
    const std::uint32_t u = d.fields[i].usage;
    rules.has_home = rules.has_home || u == usage::kConsumerHome;
    rules.has_back = rules.has_back || u == usage::kConsumerBack;
    has_start = has_start || u == usage_of(usage::kButtonPage, 12);
    has_guide = has_guide || u == usage_of(usage::kButtonPage, 13);
  }
  rules.home_is_start = has_guide && !has_start;
  return rules;
}

int key_button(std::uint32_t u, const KeyRules& rules) {
  switch (u) {
    case usage::kConsumerBack:
    case usage::kSelect:
      return kButtonBack;
    case usage::kConsumerHome:
      return rules.home_is_start ? kButtonStart : kButtonGuide;
    case usage::kConsumerRecord:
      return kButtonMisc1;
    case usage::kSystemMainMenu:
      return kButtonGuide;
    case usage::kStart:
      return kButtonStart;
    default:
      return kNone;
  }
}

int dpad_button(std::uint32_t u) {
  switch (u) {
    case usage::kDpadUp:
      return kButtonDpadUp;
    case usage::kDpadDown:
      return kButtonDpadDown;
    case usage::kDpadLeft:
      return kButtonDpadLeft;
    case usage::kDpadRight:
      return kButtonDpadRight;
    default:
      return kNone;
  }
}

void bind_buttons(const ReportDescriptor& d, const ReportFields& r, ButtonOrder order,
                  const KeyRules& rules, std::vector<Binding>& out) {
  for (const std::size_t i : r.all()) {
    const std::uint32_t u = d.fields[i].usage;
    if (r.index(u) != i) continue;
    if (u == usage::kHatSwitch) {
      out.push_back({ControlKind::hat, 0, i, 0, false});
      continue;
    }
    if (const int dpad = dpad_button(u); dpad != kNone) {
      out.push_back({ControlKind::dpad, dpad, i, 0, false});
      continue;
    }
    int button = key_button(u, rules);
    if (page_of(u) == usage::kButtonPage) {
      button = button_of(order, id_of(u));
      // The key sits in another report than the never pressed button, which must not release it.
      if (button == kButtonGuide && rules.has_home && !rules.home_is_start) button = kNone;
      if (button == kButtonBack && rules.has_back) button = kNone;
    }
    if (button != kNone) out.push_back({ControlKind::button, button, i, 0, false});
  }
}

}  // namespace

std::vector<std::size_t> pad_fields(const ReportDescriptor& d) {
  const std::optional<std::size_t> pad = pad_application(d);
  std::vector<std::size_t> fields;
  if (!pad) return fields;
  for (std::size_t i = 0; i < d.fields.size(); ++i) {
    const Field& f = d.fields[i];
    if (f.kind != FieldKind::input) continue;
    const bool other_pad =
        f.application == kNoApplication || is_pad_application(d.applications[f.application]);
    const KeyRules no_rules;
    const bool is_key = !other_pad && key_button(f.usage, no_rules) != kNone;
    if (f.application == *pad || is_key) fields.push_back(i);
  }
  return fields;
}

ButtonOrder likely_button_order(const ReportDescriptor& d, const std::vector<std::size_t>& fields) {
  std::vector<bool> has(256);
  std::uint32_t highest = 0;
  for (const std::size_t i : fields) {
    const std::uint32_t u = d.fields[i].usage;
    if (page_of(u) != usage::kButtonPage || id_of(u) >= has.size()) continue;
    has[id_of(u)] = true;
    highest = std::max<std::uint32_t>(highest, id_of(u));
  }
  const auto is_x = [&](std::size_t i) { return d.fields[i].usage == usage::kX; };
  const auto x = std::find_if(fields.begin(), fields.end(), is_x);
  if (x == fields.end()) return ButtonOrder::direct_input;
  const ReportFields r(d, fields, d.fields[*x].report_id);
  const auto stick = right_stick(r);
  const bool is_game_pad = d.applications[d.fields[*x].application] == usage::kGamePad;
  if (r.has(usage::kBrake, usage::kAccelerator)) return ButtonOrder::android;
  if (has[4] && has[5] && !has[3]) return ButtonOrder::android;
  if (stick && stick->x == usage::kRx && highest <= 11) return ButtonOrder::xinput;
  if (!is_game_pad && !stick && highest <= 8) return ButtonOrder::xinput;
  if (is_game_pad && highest == 15 && !triggers(r)) return ButtonOrder::android;
  return ButtonOrder::direct_input;
}

namespace {

// The n-th word names button n, counted from 1.
constexpr PadButton kEmpty = kButtonCount;
constexpr PadButton kDirectInput[] = {
    kButtonX,     kButtonA,    kButtonB,    kButtonY,     kButtonLeftShoulder, kButtonRightShoulder,
    kEmpty,       kEmpty,      kButtonBack, kButtonStart, kButtonLeftStick,    kButtonRightStick,
    kButtonGuide, kButtonMisc1};
constexpr PadButton kTopFirst[] = {kButtonY, kButtonB, kButtonA, kButtonX};
constexpr PadButton kAndroid[] = {kButtonA,
                                  kButtonB,
                                  kEmpty,
                                  kButtonX,
                                  kButtonY,
                                  kEmpty,
                                  kButtonLeftShoulder,
                                  kButtonRightShoulder,
                                  kEmpty,
                                  kEmpty,
                                  kButtonBack,
                                  kButtonStart,
                                  kButtonGuide,
                                  kButtonLeftStick,
                                  kButtonRightStick};
constexpr PadButton kXinput[] = {kButtonA,
                                 kButtonB,
                                 kButtonX,
                                 kButtonY,
                                 kButtonLeftShoulder,
                                 kButtonRightShoulder,
                                 kButtonBack,
                                 kButtonStart,
                                 kButtonLeftStick,
                                 kButtonRightStick,
                                 kButtonGuide};

}  // namespace

PadButton button_of(ButtonOrder order, std::uint32_t number) noexcept {
  const auto pick = [number](const auto& table) {
    return number >= 1 && number <= std::size(table) ? table[number - 1] : kEmpty;
  };
  switch (order) {
    case ButtonOrder::direct_input:
      return pick(kDirectInput);
    case ButtonOrder::top_first:
      return number <= std::size(kTopFirst) ? pick(kTopFirst) : pick(kDirectInput);
    case ButtonOrder::android:
      return pick(kAndroid);
    case ButtonOrder::xinput:
      return pick(kXinput);
  }
  return kEmpty;
}

std::vector<Binding> default_bindings(const ReportDescriptor& d, std::optional<ButtonOrder> asked) {
  std::vector<Binding> out;
  const std::vector<std::size_t> fields = pad_fields(d);
  const ButtonOrder order = asked.value_or(likely_button_order(d, fields));
  const KeyRules rules = key_rules(d, fields);
  for (const ReportLength& report : d.reports) {
    if (report.kind != FieldKind::input) continue;
    const ReportFields r(d, fields, report.report_id);
    bind_axes(r, out);
    bind_digital_triggers(r, order, out);
    bind_buttons(d, r, order, rules, out);
  }
  return out;
}

}  // namespace gaitpad
