// HID usages and Linux's evdev codes: which code hid-input gives to a usage, and how an evdev input
// node is stated as a HID device. Plain tables without kernel headers, so that a recording means
// the same on every machine.
#pragma once
#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gaitpad/descriptor.h"
#include "gaitpad/report.h"

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

// Who made the descriptor: the device itself, and the kernel chose the codes; or the evdev driver
// (or the sdl driver), whose usages say the codes. DeviceInfo::driver tells which.
enum class StatedBy { device, evdev_driver };
constexpr StatedBy stated_by(std::string_view driver) noexcept {
  return driver == "evdev" || driver == "sdl" ? StatedBy::evdev_driver : StatedBy::device;
}

// Bit of an input node's version: the kernel's driver for that pad (sony, playstation, nintendo)
// chose the codes itself.
inline constexpr unsigned kKernelCodesBit = 0x8000;

// For each field (index as in descriptor.fields) its code on the pad's input node, or none. A hat
// and each of the four D-pad usages get the x code of their pair (ABS_HAT0X). Any other code
// belongs to one field: of several X to the one that the pad uses. A field whose code is taken gets
// none, as in kernels from 4.18 on. Keys of other applications that belong to a pad (Home, Record)
// are included; SDL numbers them after all buttons.
std::vector<std::optional<EvdevCode>> evdev_codes(const ReportDescriptor& descriptor,
                                                  StatedBy stated_by = StatedBy::device);

// The usage by which the evdev driver states a code in a descriptor of that application (joystick,
// game pad, else multi-axis). It gives the control its right name without further data, and
// evdev_codes(descriptor, StatedBy::evdev_driver) gives the code back. ABS_HAT0X is a whole hat.
// Never 0.
std::uint32_t usage_of_code(EvdevCode code, std::uint32_t application) noexcept;
// Codes without a HID usage have one on our own page ffe5: 1000 + code for a key, 3000 + code for
// an axis (hexadecimal).
std::uint32_t own_usage_of_code(EvdevCode code) noexcept;

// ---- An evdev input node as a HID device
//
// Its axes, hats and keys become one unnumbered report, so that the one decoder reads it. Plain
// data in and out; the evdev driver (drivers/evdev_driver.cpp) has the node itself.

struct EvdevAxis {
  std::uint16_t code = 0;
  std::int32_t min = 0,
               max = 0;  // range as the kernel states it; unknown unless min < max
};
// The codes that a node can report, ascending.
struct EvdevAbilities {
  std::vector<EvdevAxis> axes;
  std::vector<std::uint16_t> keys;
};

struct EvdevState {
  std::array<std::int32_t, evdev::kAbsMax + 1> axis{};
  std::bitset<evdev::kKeyMax + 1> keys;  // pressed keys
};

// The place of a code's value in the report.
struct EvdevField {
  EvdevCode code;
  bool is_hat = false;  // the code is a whole hat: this code and the next one
  std::uint16_t bit_offset = 0;
  std::uint8_t bit_size = 0;
  std::int32_t min = 0, max = 0;
};
struct EvdevLayout {
  std::vector<std::uint8_t> descriptor;
  std::vector<EvdevField> fields;
  std::uint16_t report_bytes = 0;  // far below kMaxReportBytes, whatever a node claims
};

// Multi-touch axes are left out. `own_descriptor`: of the HID device behind the node, empty if
// there is none or if its kernel driver chose codes of its own. The axes follow its order, because
// nothing else shows whether Z, Rz or Rx, Ry are the right stick.
EvdevLayout evdev_layout(const EvdevAbilities& abilities,
                         std::span<const std::uint8_t> own_descriptor);

// Writes the bytes of the report for that state. Values beyond an axis' range count as its end.
void put_state(const EvdevLayout& layout, const EvdevState& state, Report& report) noexcept;

}  // namespace gaitpad
