#include "drivers/virtual_pad.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gaitpad {
namespace {

constexpr int kFullStick = 32767, kFullTrigger = 1023;

// By PadButton, as far as Linux's gamepads name them.
constexpr std::array<std::uint16_t, kButtonDpadUp> kCodes = {
    BTN_A,     BTN_B,      BTN_X,      BTN_Y,  BTN_SELECT, BTN_MODE,
    BTN_START, BTN_THUMBL, BTN_THUMBR, BTN_TL, BTN_TR,
};

// 0: a direction of the hat.
std::uint16_t code_of(int button) {
  if (button < kButtonDpadUp) return kCodes[static_cast<std::size_t>(button)];
  if (button < kButtonMisc1) return 0;
  return static_cast<std::uint16_t>(BTN_TRIGGER_HAPPY1 + button - kButtonMisc1);
}

constexpr VirtualPadAxis kAxes[] = {{ABS_X, -kFullStick - 1, kFullStick},
                                    {ABS_Y, -kFullStick - 1, kFullStick},
                                    {ABS_Z, 0, kFullTrigger},
                                    {ABS_RX, -kFullStick - 1, kFullStick},
                                    {ABS_RY, -kFullStick - 1, kFullStick},
                                    {ABS_RZ, 0, kFullTrigger},
                                    {ABS_HAT0X, -1, 1},
                                    {ABS_HAT0Y, -1, 1}};

bool is_pressed(const VirtualPadState& state, PadButton button) {
  return ((state.buttons >> button) & 1u) != 0;
}

std::int32_t counts(double value, int full) {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0, 1.0) * full));
}

// In the order of kAxes.
std::array<std::int32_t, std::size(kAxes)> axis_values(const VirtualPadState& s) {
  const auto direction = [&s](PadButton towards, PadButton away) {
    return static_cast<int>(is_pressed(s, towards)) - static_cast<int>(is_pressed(s, away));
  };
  return {counts(s.stick.left.x, kFullStick),           counts(-s.stick.left.y, kFullStick),
          counts(s.trigger[0], kFullTrigger),           counts(s.stick.right.x, kFullStick),
          counts(-s.stick.right.y, kFullStick),         counts(s.trigger[1], kFullTrigger),
          direction(kButtonDpadRight, kButtonDpadLeft), direction(kButtonDpadDown, kButtonDpadUp)};
}

}  // namespace

std::vector<VirtualPadEvent> events_between(const VirtualPadState& from,
                                            const VirtualPadState& to) {
  std::vector<VirtualPadEvent> events;
  const auto before = axis_values(from), after = axis_values(to);
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (after[i] != before[i]) events.push_back({EV_ABS, kAxes[i].code, after[i]});
  }
  for (int b = 0; b < kButtonCount; ++b) {
    const auto button = static_cast<PadButton>(b);
    const std::uint16_t code = code_of(b);
    const bool is_down = is_pressed(to, button);
    if (code != 0 && is_down != is_pressed(from, button))
      events.push_back({EV_KEY, code, is_down ? 1 : 0});
  }
  return events;
}

bool is_virtual_pad(const DeviceInfo& info) noexcept {
  return info.vendor == kVirtualPadVendor && info.product == kVirtualPadProduct;
}

std::span<const VirtualPadAxis> virtual_pad_axes() noexcept { return kAxes; }

std::vector<std::uint16_t> virtual_pad_keys() {
  std::vector<std::uint16_t> keys;
  for (int b = 0; b < kButtonCount; ++b) {
    if (code_of(b) != 0) keys.push_back(code_of(b));
  }
  return keys;
}

bool VirtualPad::set(const VirtualPadState& state) {
  std::vector<VirtualPadEvent> events = events_between(state_, state);
  state_ = state;
  if (events.empty()) return true;
  events.push_back({EV_SYN, SYN_REPORT, 0});
  return write(events);
}

}  // namespace gaitpad
