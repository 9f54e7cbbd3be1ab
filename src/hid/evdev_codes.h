// The evdev code that Linux's hid-input gives to a HID usage, and back. Plain tables: no header of
// the kernel is needed, so that a recording means the same on every machine.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "hid/descriptor.h"

namespace gaitpad {

enum class EvdevType : std::uint8_t { key = 0x01, absolute = 0x03 };
struct EvdevCode {
  EvdevType type = EvdevType::key;
  std::uint16_t code = 0;
  bool operator==(const EvdevCode&) const = default;
};

// Names as in Linux's input-event-codes.h.
namespace evdev {
inline constexpr std::uint16_t kAbsHat0X = 0x10, kAbsHat3Y = 0x17, kAbsMax = 0x3f;
inline constexpr std::uint16_t kBtnMisc = 0x100, kBtnMouse = 0x110, kBtnJoystick = 0x120,
                               kBtnGamepad = 0x130, kBtnDigi = 0x140, kBtnDpadUp = 0x220,
                               kBtnTriggerHappy = 0x2c0, kKeyMax = 0x2ff;
}  // namespace evdev

// Whose descriptor it is: a device's own, whose codes the kernel chose, or one that the evdev
// driver stated from the codes, or the sdl driver in the same way (DeviceInfo::driver says which).
enum class StatedBy { device, evdev_driver };
constexpr StatedBy stated_by(std::string_view driver) noexcept {
  return driver == "evdev" || driver == "sdl" ? StatedBy::evdev_driver : StatedBy::device;
}

// For every field (index as in descriptor.fields) the code that the pad's input node has for it,
// nothing where it has none. A hat and each of the four D-pad usages get the x code of their pair
// (ABS_HAT0X); any other code stands for one field only: where several share it (several X) for the
// one that a pad means, and a field whose code is taken gets none, as in kernels from 4.18 on. Keys
// of other applications that belong to a pad (Home, Record) count as the pad's; SDL numbers them
// behind all buttons.
std::vector<std::optional<EvdevCode>> evdev_codes(const ReportDescriptor& descriptor,
                                                  StatedBy stated_by = StatedBy::device);

// The usage by which the evdev driver states a code in a descriptor for that application (joystick,
// game pad, else multi-axis), chosen so that the controls are named right without further data and
// that evdev_codes(stated, StatedBy::evdev_driver) gives the code back. ABS_HAT0X is a whole hat.
// Never 0.
std::uint32_t usage_of_code(EvdevCode code, std::uint32_t application) noexcept;
// What HID has no usage for stands on a page of our own, ffe5: 1000 + code a key, 3000 + code an
// axis (hexadecimal).
std::uint32_t own_usage_of_code(EvdevCode code) noexcept;

}  // namespace gaitpad
