#include "drivers/virtual_pad.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gaitpad {
namespace {

// Not a USB vendor's id: it marks our own virtual pad.
constexpr int kOwnVendor = 0x6761, kOwnProduct = 0x7470;

// Linux's codes of the buttons, as far as its gamepads have them; in the order of PadButton.
constexpr std::array<std::uint16_t, kButtonDpadUp> kCodes = {
    BTN_A,     BTN_B,      BTN_X,      BTN_Y,  BTN_SELECT, BTN_MODE,
    BTN_START, BTN_THUMBL, BTN_THUMBR, BTN_TL, BTN_TR,
};

// The code of a button. 0: it is a direction of the hat, or the kind of pad does not have it.
std::uint16_t code_of(int button, XboxKind kind) {
  if (button < kButtonDpadUp) return kCodes[static_cast<std::size_t>(button)];
  if (button < kButtonMisc1 || kind == XboxKind::xbox_360) return 0;
  return static_cast<std::uint16_t>(BTN_TRIGGER_HAPPY1 + button - kButtonMisc1);
}

int full_trigger(XboxKind kind) { return kind == XboxKind::xbox_360 ? 255 : 1023; }

constexpr std::array<std::uint16_t, 8> kAxes = {ABS_X,  ABS_Y,  ABS_Z,     ABS_RX,
                                                ABS_RY, ABS_RZ, ABS_HAT0X, ABS_HAT0Y};

bool is_pressed(const VirtualPadState& state, PadButton button) {
  return ((state.buttons >> button) & 1u) != 0;
}

std::int32_t counts(double value, int full) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0, 1.0) * full));
}

// The axes' values in the order of kAxes.
std::array<std::int32_t, std::size(kAxes)> axis_values(const VirtualPadState& s, XboxKind kind) {
  const auto direction = [&s](PadButton towards, PadButton away) {
    return static_cast<int>(is_pressed(s, towards)) - static_cast<int>(is_pressed(s, away));
  };
  return {counts(s.stick.left.x, kFullStick),           counts(-s.stick.left.y, kFullStick),
          counts(s.trigger[0], full_trigger(kind)),     counts(s.stick.right.x, kFullStick),
          counts(-s.stick.right.y, kFullStick),         counts(s.trigger[1], full_trigger(kind)),
          direction(kButtonDpadRight, kButtonDpadLeft), direction(kButtonDpadDown, kButtonDpadUp)};
}

}  // namespace

bool is_virtual_pad(const DeviceInfo& info) noexcept {
  return info.physical_path.starts_with(kVirtualPort) ||
         (info.vendor == kOwnVendor && info.product == kOwnProduct);
}

VirtualPadShape shape_of(XboxKind kind) {
  VirtualPadShape shape = {
      .name = "gaitpad calibrated pad", .vendor = kOwnVendor, .product = kOwnProduct, .version = 1};
  if (kind == XboxKind::xbox_360)
    shape = {.name = "Microsoft X-Box 360 pad",
             .bus = BusType::usb,
             .vendor = 0x045e,
             .product = 0x028e,
             .version = 0x0114};
  const int trigger = full_trigger(kind);
  for (const std::uint16_t code : kAxes) {
    if (code == ABS_HAT0X || code == ABS_HAT0Y) {
      shape.axes.push_back({code, -1, 1});
    } else if (code == ABS_Z || code == ABS_RZ) {
      shape.axes.push_back({code, 0, trigger});
    } else {
      shape.axes.push_back({code, -kFullStick - 1, kFullStick});
    }
  }
  for (int b = 0; b < kButtonCount; ++b) {
    if (code_of(b, kind) != 0) shape.keys.push_back(code_of(b, kind));
  }
  return shape;
}

std::vector<VirtualPadEvent> events_between(const VirtualPadState& from, const VirtualPadState& to,
                                            XboxKind kind) {
  std::vector<VirtualPadEvent> events;
  const auto before = axis_values(from, kind), after = axis_values(to, kind);
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i] != before[i]) events.push_back({EV_ABS, kAxes[i], after[i]});
  }
  for (int b = 0; b < kButtonCount; ++b) {
    const auto button = static_cast<PadButton>(b);
    const std::uint16_t code = code_of(b, kind);
    const bool is_down = is_pressed(to, button);
    if (code != 0 && is_down != is_pressed(from, button))
      events.push_back({EV_KEY, code, is_down ? 1 : 0});
  }
  return events;
}

Result<XboxPad> XboxPad::create() {
  auto pad = VirtualPad::create(shape_of(XboxKind::calibrated));
  if (!pad) return pad.error();
  return XboxPad(std::move(*pad));
}

bool XboxPad::set(const VirtualPadState& state) noexcept {
  const std::vector<VirtualPadEvent> events = events_between(state_, state);
  state_ = state;
  return pad_->write(events);
}

}  // namespace gaitpad
