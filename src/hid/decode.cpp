#include "hid/decode.h"

#include <algorithm>

namespace gaitpad {

namespace {

constexpr std::uint32_t bit(int button) { return std::uint32_t{1} << button; }
constexpr std::uint32_t kDpad =
    bit(kButtonDpadUp) | bit(kButtonDpadDown) | bit(kButtonDpadLeft) | bit(kButtonDpadRight);

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
  // In this form the middle of an odd number of counts is exactly 0, and never -0.
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

// The hat that four buttons make; opposite ones cancel out.
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
