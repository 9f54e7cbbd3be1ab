#include "gaitpad/decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "hid/sdl_lines.h"

namespace gaitpad {

namespace {

// ---- The default bindings: which control a field is, by its usage and its neighbours

enum class ControlKind : std::uint8_t { axis, button, hat, dpad };

// Binds one field of a descriptor to one control of the pad.
struct Binding {
  ControlKind kind = ControlKind::axis;
  int control = 0;        // a PadAxis or a PadButton; not used for a hat
  std::size_t field = 0;  // index in ReportDescriptor::fields
  // The other members are as in ControlSource.
  std::uint32_t mask = 0;
  bool reversed = false;
  AxisPart part = AxisPart::whole;
  StickSide side = StickSide::both;
  std::uint8_t directions = 0;
};

constexpr PadButton kNoButton = kButtonCount;

// Tables of the orders of buttons: the n-th entry is button n, counted from 1.
constexpr PadButton kDirectInput[] = {
    kButtonX,     kButtonA,    kButtonB,    kButtonY,     kButtonLeftShoulder, kButtonRightShoulder,
    kNoButton,    kNoButton,   kButtonBack, kButtonStart, kButtonLeftStick,    kButtonRightStick,
    kButtonGuide, kButtonMisc1};
constexpr PadButton kTopFirst[] = {kButtonY, kButtonB, kButtonA, kButtonX};
constexpr PadButton kAndroid[] = {
    kButtonA,       kButtonB,         kNoButton,           kButtonX,
    kButtonY,       kNoButton,        kButtonLeftShoulder, kButtonRightShoulder,
    kNoButton,      kNoButton,        kButtonBack,         kButtonStart,
    kButtonGuide,   kButtonLeftStick, kButtonRightStick,   kNoButton,
    kNoButton,      kNoButton,        kNoButton,           kNoButton,
    kButtonPaddle1,  // Linux's BTN_TRIGGER_HAPPY5 .. 8: upper and
    kButtonPaddle3,  // lower right, upper and lower left paddle
    kButtonPaddle2, kButtonPaddle4};
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

// The button with this number; kNoButton if the order has none.
PadButton button_of(ButtonOrder order, std::uint32_t number) noexcept {
  const auto pick = [number](const auto& table) {
    return number >= 1 && number <= std::size(table) ? table[number - 1] : kNoButton;
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
  return kNoButton;
}

// The fields of one report by usage. If a usage occurs several times, the first one counts.
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

  bool is_game_pad() const {
    const auto x = first_.find(usage::kX);
    if (x == first_.end()) return false;
    const std::uint32_t application = descriptor_.fields[x->second].application;
    return application < descriptor_.applications.size() &&
           descriptor_.applications[application] == usage::kGamePad;
  }

  // DragonRise and Mega Drive pads state X (or Z) several times; the one beside Y (or Rz) is real.
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

// Both pairs exist: one is the right stick, the other the triggers. Xbox pads have the stick on Rx,
// Ry, Sony pads on Z, Rz. The stick is as wide as the left one, its axes are neighbours, and it
// comes first.
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

// Many game pads call themselves joysticks. On a flight stick, a yoke or a wheel these axes are the
// twist, the throttle and the pedals, which are not as wide as the stick.
bool may_be_stick(const ReportFields& r, AxisPair pair) {
  return r.has(pair.x, pair.y) && (r.is_game_pad() || like_left_stick(r, pair));
}

std::optional<AxisPair> right_stick(const ReportFields& r) {
  constexpr AxisPair kSimulation{usage::kRudder, usage::kThrottle};
  const bool z = may_be_stick(r, kZPair), rotation = may_be_stick(r, kRotationPair);
  if (z && rotation) return right_stick_of_two(r);
  if (z) return kZPair;
  if (rotation) return kRotationPair;
  if (may_be_stick(r, kSimulation)) return kSimulation;
  return std::nullopt;
}

std::optional<AxisPair> triggers(const ReportFields& r) {
  if (r.has(usage::kBrake, usage::kAccelerator)) {
    return AxisPair{usage::kBrake, usage::kAccelerator};
  }
  if (!may_be_stick(r, kZPair) && !may_be_stick(r, kRotationPair)) return std::nullopt;
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
  }
  if (const auto pair = triggers(r)) {
    bind(kLeftTrigger, r.index(pair->x));
    bind(kRightTrigger, r.index(pair->y));
  }
}

// Buttons as triggers, if there are no trigger axes.
void bind_digital_triggers(const ReportFields& r, ButtonOrder order, std::vector<Binding>& out) {
  if (order == ButtonOrder::xinput || triggers(r)) return;
  const std::uint16_t left = order == ButtonOrder::android ? 9 : 7;
  for (std::uint16_t i = 0; i < 2; ++i) {
    const auto number = static_cast<std::uint16_t>(left + i);
    const std::uint32_t u = usage_of(usage::kButtonPage, number);
    if (r.has(u)) out.push_back({ControlKind::axis, kLeftTrigger + i, r.index(u), 0, false});
  }
}

// Keys of the consumer and system pages that some pads have instead of buttons.
struct KeyRules {
  bool home_is_start = false;  // the pad has a guide button and no start button (Asus)
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
      return kNoButton;
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
      return kNoButton;
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
    if (const int dpad = dpad_button(u); dpad != kNoButton) {
      out.push_back({ControlKind::dpad, dpad, i, 0, false});
      continue;
    }
    int button = key_button(u, rules);
    if (page_of(u) == usage::kButtonPage) {
      button = button_of(order, id_of(u));
      // The key is in another report; this button, which is never pressed, must not release it.
      if (button == kButtonGuide && rules.has_home && !rules.home_is_start) button = kNoButton;
      if (button == kButtonBack && rules.has_back) button = kNoButton;
    }
    if (button != kNoButton) out.push_back({ControlKind::button, button, i, 0, false});
  }
}

bool is_pad_application(std::uint32_t u) {
  return u == usage::kJoystick || u == usage::kGamePad || u == usage::kMultiAxis;
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
    const bool is_key = !other_pad && key_button(f.usage, no_rules) != kNoButton;
    if (f.application == *pad || is_key) fields.push_back(i);
  }
  return fields;
}

namespace {

// The order that a pad without a file most likely has: by its axes and the numbers of its buttons.
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

// ---- From fields to operations on the state

constexpr std::uint32_t bit(int button) { return std::uint32_t{1} << button; }
constexpr std::uint32_t kDpad =
    bit(kButtonDpadUp) | bit(kButtonDpadDown) | bit(kButtonDpadLeft) | bit(kButtonDpadRight);

constexpr std::uint32_t kMaxControlBits = 32;  // a wider field is no control

FieldBits bits_of(const Field& f) {
  FieldBits bits;
  bits.bit_offset = f.bit_offset;
  bits.bit_size = static_cast<std::uint8_t>(std::min<std::uint32_t>(f.bit_size, 64));
  bits.is_signed = f.logical_min < 0;
  bits.min = f.logical_min;
  bits.max = f.logical_max;
  return bits;
}

// A hat counts 8 steps, 4 steps, or degrees in any resolution; values outside mean "released".
HatOp hat_op(const Field& f) {
  HatOp op;
  op.bits = bits_of(f);
  op.last = f.logical_max;
  const std::int64_t count = f.logical_max - f.logical_min + 1;
  const bool ends_at_315 = f.physical_max - f.physical_min == 315 || count == 316;
  if (count == 4) {
    op.numerator = 2;
  } else if (count >= 8 && count <= 16) {
    op.last = f.logical_min + 7;  // some include the value of "released" in the range
  } else if (ends_at_315 && count > 1) {
    op.numerator = 7;
    op.denominator = count - 1;
  } else if (count > 16) {
    op.numerator = 8;
    op.denominator = count;
  } else {
    op.last = f.logical_min - 1;
  }
  return op;
}

// With an odd number of counts the middle one belongs to both halves and is 0 in both.
FieldBits part_of(const Field& f, AxisPart part) {
  FieldBits bits = bits_of(f);
  const std::int64_t span = std::max<std::int64_t>(f.logical_max - f.logical_min, 0);
  if (part == AxisPart::high) bits.min += (span + 1) / 2;
  if (part == AxisPart::low) bits.max = bits.min + span / 2;
  return bits;
}

bool is_trigger(PadAxis axis) { return axis == kLeftTrigger || axis == kRightTrigger; }
int side_of(PadAxis axis, StickSide side) {
  if (side == StickSide::both || is_trigger(axis)) return 0;
  return (side == StickSide::negative) == is_upward(axis) ? 1 : -1;
}

AxisOp axis_op(const Field& f, PadAxis axis, const Binding& b) {
  AxisOp op;
  op.bits = part_of(f, b.part);
  op.axis = axis;
  op.side = static_cast<std::int8_t>(side_of(axis, b.side));
  op.reversed = b.reversed != (b.part == AxisPart::low);
  if (op.side == 0 && is_upward(axis)) op.reversed = !op.reversed;
  return op;
}

ButtonOp button_op(const Field& f, const Binding& b) {
  const bool reversed = b.reversed != (b.part == AxisPart::low);
  return {part_of(f, b.part), b.mask, bit(b.control), reversed && b.mask == 0};
}

// One direction of a hat, used as a button or as one side of a stick.
HatOp direction_op(const Field& f, const Binding& b) {
  HatOp op = hat_op(f);
  op.directions = b.directions;
  if (b.kind == ControlKind::axis) {
    op.axis = static_cast<PadAxis>(b.control);
    op.value = side_of(op.axis, b.side) < 0 ? -1.0f : 1.0f;
  } else {
    op.button = bit(b.control);
  }
  return op;
}

// ---- Bindings that a pad file or SDL names

// Whether the field belongs to the second pad of an adapter for two: the same collection again.
bool is_of_twin(const ReportDescriptor& d, const Field& f) {
  const std::optional<std::size_t> pad = pad_application(d);
  if (!pad || f.application == *pad || f.application >= d.applications.size()) return false;
  return d.applications[f.application] == d.applications[*pad];
}

const Field* nth_field(const ReportDescriptor& d, std::uint8_t report_id, const ControlSource& s,
                       std::size_t& index) {
  std::uint32_t seen = 0;
  for (std::size_t i = 0; i < d.fields.size(); ++i) {
    const Field& f = d.fields[i];
    if (f.kind != FieldKind::input || f.is_array || f.report_id != report_id) continue;
    if (f.usage != s.usage || is_of_twin(d, f) || ++seen != s.occurrence) continue;
    index = i;
    return &f;
  }
  return nullptr;
}

// Facts about the controls beside the descriptor: from a pad file, or from SDL.
struct KnownControls {
  std::optional<ButtonOrder> order;
  // Controls of a pad file; those that it does not name keep their default.
  const ControlMap* controls = nullptr;
  // Controls of SDL's mapping for the pad, which then has no others.
  const ControlMap* all_controls = nullptr;
};

bool is_for(const Binding& b, ControlKind kind, int control) {
  if (b.kind == kind && b.control == control) return true;
  return kind == ControlKind::button && b.kind == ControlKind::dpad && b.control == control;
}

void bind_control(const ReportDescriptor& d, ControlKind kind, int control,
                  const ControlSources& sources, std::vector<Binding>& bindings) {
  for (const ControlSource& s : sources) {
    for (const ReportLength& report : d.reports) {
      std::size_t index = 0;
      if (report.kind != FieldKind::input || !nth_field(d, report.report_id, s, index)) continue;
      bindings.push_back({kind, control, index, s.mask, s.reversed, s.part, s.side, s.directions});
    }
  }
}

// Replaces the default sources of a control.
void override_control(const ReportDescriptor& d, ControlKind kind, int control,
                      const ControlSources& sources, std::vector<Binding>& bindings) {
  std::erase_if(bindings, [&](const Binding& b) { return is_for(b, kind, control); });
  bind_control(d, kind, control, sources, bindings);
}

// A field that a pad file binds is bound to nothing else.
void drop_defaults_on(const ReportDescriptor& d, const ControlMap& controls,
                      std::vector<Binding>& bindings) {
  const auto drop = [&](const std::optional<ControlSources>& sources) {
    if (!sources) return;
    for (const ControlSource& s : *sources) {
      std::erase_if(bindings, [&](const Binding& b) { return d.fields[b.field].usage == s.usage; });
    }
  };
  for (const auto& sources : controls.axes) drop(sources);
  for (const auto& sources : controls.buttons) drop(sources);
}

// SDL's data base has some pads' axes as a D-pad, without any left stick: the default stick is
// bound, so that such a pad can also control the walk.
std::vector<Binding> sdl_bindings(const ReportDescriptor& d, const ControlMap& controls) {
  std::vector<Binding> bindings;
  for (int i = 0; i < kAxisCount; ++i) {
    if (controls.axes[i]) bind_control(d, ControlKind::axis, i, *controls.axes[i], bindings);
  }
  const auto is_left_stick = [](const Binding& b) {
    return b.kind == ControlKind::axis && (b.control == kLeftX || b.control == kLeftY);
  };
  if (std::none_of(bindings.begin(), bindings.end(), is_left_stick)) {
    for (const Binding& b : default_bindings(d, std::nullopt)) {
      if (is_left_stick(b)) bindings.push_back(b);
    }
  }
  for (int i = 0; i < kButtonCount; ++i) {
    if (controls.buttons[i])
      bind_control(d, ControlKind::button, i, *controls.buttons[i], bindings);
  }
  return bindings;
}

std::vector<Binding> bindings_of(const ReportDescriptor& d, const KnownControls& known) {
  if (known.all_controls) return sdl_bindings(d, *known.all_controls);
  std::vector<Binding> bindings = default_bindings(d, known.order);
  if (!known.controls) return bindings;
  const ControlMap& controls = *known.controls;
  drop_defaults_on(d, controls, bindings);
  for (int i = 0; i < kAxisCount; ++i) {
    if (!controls.axes[i]) continue;
    override_control(d, ControlKind::axis, i, *controls.axes[i], bindings);
  }
  for (int i = 0; i < kButtonCount; ++i) {
    if (!controls.buttons[i]) continue;
    override_control(d, ControlKind::button, i, *controls.buttons[i], bindings);
  }
  return bindings;
}

// ---- The layout

void add_binding(const Field& f, const Binding& b, ReportLayout& layout) {
  if (b.kind != ControlKind::hat && b.directions != 0) {
    layout.hats.push_back(direction_op(f, b));
    layout.covered |= layout.hats.back().button;
    return;
  }
  switch (b.kind) {
    case ControlKind::axis:
      layout.axes.push_back(axis_op(f, static_cast<PadAxis>(b.control), b));
      return;
    case ControlKind::hat:
      layout.hats.push_back(hat_op(f));
      layout.covered |= kDpad;
      return;
    case ControlKind::button:
    case ControlKind::dpad:
      layout.buttons.push_back(button_op(f, b));
      layout.covered |= bit(b.control);
      return;
  }
}

// Several fields of one axis are added: two halves of a stick, or alternative sources.
void find_sums(ReportLayout& layout) {
  std::uint32_t seen = 0;
  for (const AxisOp& op : layout.axes) {
    layout.summed |= seen & bit(op.axis);
    seen |= bit(op.axis);
  }
  for (const HatOp& op : layout.hats) {
    if (op.value != 0.0f) layout.summed |= bit(op.axis);
  }
}

// Some pads send the numbers of the pressed buttons instead of one bit each.
void add_button_numbers(const ReportDescriptor& d, const Field& f, ButtonOrder order,
                        ReportLayout& layout) {
  constexpr std::int64_t kMaxNames = 256;
  if (page_of(f.usage) != usage::kButtonPage || f.bit_size > kMaxControlBits) return;
  ArrayOp op;
  op.bits = bits_of(f);
  const std::int64_t last = std::min(f.logical_max, f.logical_min + kMaxNames - 1);
  for (std::int64_t value = f.logical_min; value <= last; ++value) {
    const std::uint32_t u = array_usage(d, f, value);
    const bool is_button = page_of(u) == usage::kButtonPage;
    const PadButton button = is_button ? button_of(order, id_of(u)) : kButtonCount;
    op.button.push_back(button == kButtonCount ? 0 : bit(button));
    layout.covered |= op.button.back();
  }
  layout.arrays.push_back(std::move(op));
}

// One layout for each input report, as long as the descriptor says.
std::vector<ReportLayout> report_layouts(const ReportDescriptor& d, const KnownControls& known) {
  std::vector<ReportLayout> layouts;
  for (const ReportLength& r : d.reports) {
    if (r.kind != FieldKind::input || (d.numbered && r.report_id == 0)) continue;
    ReportLayout layout;
    layout.report_id = r.report_id;
    layout.numbered = d.numbered;
    const std::size_t size = (r.bits + 7) / 8 + (d.numbered ? 1 : 0);
    layout.min_size = static_cast<std::uint16_t>(size);
    layouts.push_back(std::move(layout));
  }
  const auto layout_of = [&](std::uint8_t id) {
    return std::find_if(layouts.begin(), layouts.end(),
                        [id](const ReportLayout& l) { return l.report_id == id; });
  };
  for (const Binding& b : bindings_of(d, known)) {
    const Field& f = d.fields[b.field];
    const auto it = layout_of(f.report_id);
    if (it != layouts.end() && f.bit_size <= kMaxControlBits) add_binding(f, b, *it);
  }
  for (ReportLayout& layout : layouts) find_sums(layout);
  const std::vector<std::size_t> fields = pad_fields(d);
  const ButtonOrder order = known.order.value_or(likely_button_order(d, fields));
  for (const std::size_t i : fields) {
    const Field& f = d.fields[i];
    const auto it = layout_of(f.report_id);
    if (!f.is_array || it == layouts.end() || it->arrays.size() >= 32) continue;
    add_button_numbers(d, f, order, *it);
  }
  return layouts;
}

bool reads(const ReportLayout& layout, const Field& f) {
  const auto same = [&f](const auto& op) {
    return op.bits.bit_offset == f.bit_offset && op.bits.bit_size == f.bit_size;
  };
  return std::any_of(layout.axes.begin(), layout.axes.end(), same) ||
         std::any_of(layout.buttons.begin(), layout.buttons.end(), same);
}

std::vector<UnnamedButton> unnamed_buttons(const PadLayout& layout) {
  std::vector<UnnamedButton> unnamed;
  const ReportDescriptor& d = layout.descriptor;
  // If a pad file replaces a report, the pad's own description of it is wrong.
  const auto is_replaced = [&layout](std::uint8_t id) {
    return std::any_of(layout.reports.begin(), layout.reports.end(), [id](const ReportLayout& r) {
      return r.report_id == id && !r.exact_sizes.empty();
    });
  };
  for (const std::size_t i : pad_fields(d)) {
    const Field& f = d.fields[i];
    if (page_of(f.usage) != usage::kButtonPage || f.is_array || is_replaced(f.report_id)) continue;
    const bool bound = std::any_of(
        layout.reports.begin(), layout.reports.end(),
        [&](const ReportLayout& r) { return r.report_id == f.report_id && reads(r, f); });
    if (!bound) unnamed.push_back({f.report_id, bits_of(f), id_of(f.usage)});
  }
  return unnamed;
}

// evdev and SDL pass on changes only, so silence means nothing there.
bool driver_hands_on_all(const std::string& driver) {
  return driver.empty() || driver == "hidraw" || driver == "usb";
}

bool names_controls(const PadOverride& o) {
  const auto is_set = [](const auto& sources) { return sources.has_value(); };
  const ControlMap& c = o.controls;
  return o.order || !o.replacement.descriptor.empty() ||
         std::any_of(c.axes.begin(), c.axes.end(), is_set) ||
         std::any_of(c.buttons.begin(), c.buttons.end(), is_set);
}

// The controls by SDL's data base. None if a pad file names controls, or if the line is damaged.
std::optional<ControlMap> sdl_map(const DeviceInfo& device, const ReportDescriptor& d,
                                  const PadOverride* o) {
  if (device.mapping.empty() || (o && names_controls(*o))) return std::nullopt;
  auto controls = sdl_controls(device.mapping, d, device.driver);
  if (!controls) return std::nullopt;
  return std::move(*controls);
}

}  // namespace

Result<PadLayout> pad_layout(const DeviceInfo& device, const PadOverrides& overrides) {
  auto parsed = parse_descriptor(device.descriptor);
  if (!parsed) return Error{device.name + ": report descriptor: " + parsed.error().message};
  PadLayout layout;
  layout.descriptor = std::move(*parsed);
  const PadOverride* o = find_override(overrides, device);
  layout.is_pad = pad_application(layout.descriptor).has_value();
  if (o) {
    layout.is_pad = o->is_pad.value_or(layout.is_pad);
    layout.streams = o->streams && driver_hands_on_all(device.driver);
    layout.override_origin = o->origin;
  }
  if (o && !o->replacement.descriptor.empty()) {
    auto replaced = parse_descriptor(o->replacement.descriptor);
    if (!replaced) return Error{o->origin + ": descriptor: " + replaced.error().message};
    layout.reports = report_layouts(*replaced, {o->order, &o->replacement.controls});
    for (ReportLayout& r : layout.reports) r.exact_sizes = o->replacement.lengths;
  }
  KnownControls known = o ? KnownControls{o->order, &o->controls} : KnownControls{};
  const auto sdl = sdl_map(device, layout.descriptor, o);
  if (sdl) known.all_controls = &*sdl;
  std::vector<ReportLayout> own = report_layouts(layout.descriptor, known);
  std::move(own.begin(), own.end(), std::back_inserter(layout.reports));
  layout.unnamed = unnamed_buttons(layout);
  return layout;
}

// ---- Decoding: no heap, no locks

namespace {

std::int64_t value_of(const FieldBits& f, std::span<const std::uint8_t> data) noexcept {
  const std::uint64_t raw = bits_at(data, f.bit_offset, f.bit_size);
  if (!f.is_signed || f.bit_size == 0 || f.bit_size >= 64) return static_cast<std::int64_t>(raw);
  const std::uint64_t sign = std::uint64_t{1} << (f.bit_size - 1);
  return static_cast<std::int64_t>((raw ^ sign) - sign);
}

float position(const AxisOp& op, std::span<const std::uint8_t> data) noexcept {
  const std::int64_t value = std::clamp(value_of(op.bits, data), op.bits.min, op.bits.max);
  const auto low = static_cast<double>(op.bits.min), high = static_cast<double>(op.bits.max);
  if (high <= low) return 0.0f;
  double share = (static_cast<double>(value) - low) / (high - low);
  if (op.reversed) share = 1.0 - share;
  if (op.axis == kLeftTrigger || op.axis == kRightTrigger) return static_cast<float>(share);
  if (op.side != 0) return static_cast<float>(op.side < 0 ? 0.0 - share : share);
  // In this form the middle of an odd number of counts is exactly 0 and never -0.
  const double whole = (2.0 * static_cast<double>(value) - low - high) / (high - low);
  return static_cast<float>(op.reversed ? 0.0 - whole : whole);
}

bool is_pressed(const ButtonOp& op, std::int64_t value) noexcept {
  if (op.mask != 0) return (static_cast<std::uint64_t>(value) & op.mask) != 0;
  if (op.bits.bit_size == 1) return value != 0;
  const std::int64_t half = (op.bits.max - op.bits.min + 1) / 2;
  if (op.reversed) return value < op.bits.max && value <= op.bits.max - half;
  return value > op.bits.min && value >= op.bits.min + half;
}

Hat direction(const HatOp& op, std::int64_t value) noexcept {
  if (value < op.bits.min || value > op.last) return Hat::released;
  const std::int64_t steps =
      ((value - op.bits.min) * op.numerator * 2 + op.denominator) / (2 * op.denominator);
  return static_cast<Hat>(steps % 8);
}

std::uint32_t dpad_of(Hat hat) noexcept {
  constexpr std::uint32_t kUp = bit(kButtonDpadUp), kDown = bit(kButtonDpadDown),
                          kLeft = bit(kButtonDpadLeft), kRight = bit(kButtonDpadRight);
  constexpr std::array<std::uint32_t, 9> kButtons = {
      kUp, kUp | kRight, kRight, kDown | kRight, kDown, kDown | kLeft, kLeft, kUp | kLeft, 0};
  return kButtons[static_cast<std::size_t>(hat)];
}

// The hat position of the four D-pad buttons; opposite buttons cancel out.
Hat hat_of(std::uint32_t buttons) noexcept {
  const auto down = [buttons](int b) { return (buttons & bit(b)) != 0 ? 1 : 0; };
  const int x = down(kButtonDpadRight) - down(kButtonDpadLeft);
  const int y = down(kButtonDpadUp) - down(kButtonDpadDown);
  constexpr Hat kHats[3][3] = {{Hat::down_left, Hat::down, Hat::down_right},
                               {Hat::left, Hat::released, Hat::right},
                               {Hat::up_left, Hat::up, Hat::up_right}};
  return kHats[y + 1][x + 1];
}

bool fits(const ReportLayout& layout, const Report& report) noexcept {
  if (layout.numbered && (report.size == 0 || report.bytes[0] != layout.report_id)) return false;
  if (layout.exact_sizes.empty()) return report.size >= layout.min_size;
  return std::find(layout.exact_sizes.begin(), layout.exact_sizes.end(), report.size) !=
         layout.exact_sizes.end();
}

// 1 up, 2 right, 4 down, 8 left.
std::uint8_t directions_of(Hat hat) noexcept {
  constexpr std::array<std::uint8_t, 9> kDirections = {1, 3, 2, 6, 4, 12, 8, 9, 0};
  return kDirections[static_cast<std::size_t>(hat)];
}

std::uint32_t apply_hat(const HatOp& op, std::span<const std::uint8_t> data,
                        PadState& state) noexcept {
  const Hat hat = direction(op, value_of(op.bits, data));
  if (op.directions == 0) return dpad_of(hat);
  if ((directions_of(hat) & op.directions) == 0) return 0;
  if (op.value != 0.0f) {
    state.axis[op.axis] = std::clamp(state.axis[op.axis] + op.value, -1.0f, 1.0f);
  }
  return op.button;
}

void apply(const ReportLayout& layout, std::span<const std::uint8_t> data,
           PadState& state) noexcept {
  for (int i = 0; i < kAxisCount; ++i) {
    if (((layout.summed >> i) & 1u) != 0) state.axis[i] = 0.0f;
  }
  for (const AxisOp& op : layout.axes) {
    const float value = position(op, data);
    const bool summed = ((layout.summed >> op.axis) & 1u) != 0;
    state.axis[op.axis] = summed ? std::clamp(state.axis[op.axis] + value, -1.0f, 1.0f) : value;
  }
  std::uint32_t pressed = 0;
  for (const ButtonOp& op : layout.buttons) {
    if (is_pressed(op, value_of(op.bits, data))) pressed |= op.button;
  }
  for (const HatOp& op : layout.hats) pressed |= apply_hat(op, data, state);
  for (const ArrayOp& op : layout.arrays) {
    const std::int64_t index = value_of(op.bits, data) - op.bits.min;
    if (index >= 0 && index < static_cast<std::int64_t>(op.button.size())) {
      pressed |= op.button[static_cast<std::size_t>(index)];
    }
  }
  state.buttons = (state.buttons & ~layout.covered) | pressed;
  if ((layout.covered & kDpad) != 0) state.hat = hat_of(state.buttons);
}

}  // namespace

bool tells_stick(const ReportLayout& layout) noexcept {
  const auto is_left = [](PadAxis axis) { return axis == kLeftX || axis == kLeftY; };
  return std::any_of(layout.axes.begin(), layout.axes.end(),
                     [&](const AxisOp& op) { return is_left(op.axis); }) ||
         std::any_of(layout.hats.begin(), layout.hats.end(),
                     [&](const HatOp& op) { return op.value != 0.0f && is_left(op.axis); });
}

const ReportLayout* layout_of(const PadLayout& layout, const Report& report) noexcept {
  if (report.kind != ReportKind::input || report.size > report.bytes.size()) return nullptr;
  for (const ReportLayout& r : layout.reports)
    if (fits(r, report)) return &r;
  return nullptr;
}

bool decode(const PadLayout& layout, const Report& report, PadState& state) noexcept {
  const ReportLayout* r = layout_of(layout, report);
  if (r == nullptr) return false;
  const std::size_t skip = r->numbered ? 1 : 0;
  apply(*r, {report.bytes.data() + skip, report.size - skip}, state);
  return true;
}

}  // namespace gaitpad
