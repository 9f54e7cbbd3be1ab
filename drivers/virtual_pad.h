// A pad that the kernel shows to every program, made by uinput: what gaitpad makes of a real or
// recorded pad. It states the layout of Linux's gamepads (Documentation/input/gamepad.rst in the
// kernel) with the codes of the Xbox pads' driver, which games and SDL know without a mapping.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/stick.h"

namespace gaitpad {

struct VirtualPadState {
  Stick stick{};                    // calibrated
  std::array<double, 2> trigger{};  // left, right; 0 released .. 1 pressed
  std::uint32_t buttons = 0;        // as PadState::buttons
};

// An event of Linux's evdev.
struct VirtualPadEvent {
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
  bool operator==(const VirtualPadEvent&) const = default;
};
// What turns one state into the other, without the SYN_REPORT at the end. A stick's full deflection
// is 32767, y grows backwards; a pressed trigger is 1023; the D-pad is a hat.
std::vector<VirtualPadEvent> events_between(const VirtualPadState& from, const VirtualPadState& to);

// Whether such a pad is seen: gaitpad must not read its own output.
bool is_virtual_pad(const DeviceInfo& info) noexcept;

// Its ids. No USB device has them: it is none.
inline constexpr int kVirtualPadVendor = 0x6761, kVirtualPadProduct = 0x7470;
// What it can report.
struct VirtualPadAxis {
  std::uint16_t code;
  int min, max;
};
std::span<const VirtualPadAxis> virtual_pad_axes() noexcept;
std::vector<std::uint16_t> virtual_pad_keys();

// Made in the kernel; destroying it unplugs it.
class VirtualPad {
 public:
  // Error: there is no /dev/uinput or no permission, or gaitpad was built without libevdev.
  static Result<std::unique_ptr<VirtualPad>> create();
  virtual ~VirtualPad() = default;

  virtual std::string node() const = 0;  // /dev/input/event7
  // Sends what has changed. False: the kernel has refused it.
  bool set(const VirtualPadState& state);

 private:
  virtual bool write(std::span<const VirtualPadEvent> events) = 0;
  VirtualPadState state_;
};

}  // namespace gaitpad
