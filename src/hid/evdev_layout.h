// The evdev code that Linux's hid-input gives to a HID usage, and back. Plain tables: no header of
// the kernel is needed, so that a recording means the same on every machine.
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

// How an evdev input node is stated as a HID device: its axes, hats and keys as one unnumbered
// report, so that the one decoder reads it. Plain data in, plain data out; the node itself is the
// evdev driver's (drivers/evdev_driver.cpp).

struct EvdevAxis {
  std::uint16_t code = 0;
  std::int32_t min = 0,
               max = 0;  // as the kernel states them; a minimum that is no smaller: unknown
};
// What a node can tell, by code upwards.
struct EvdevAbilities {
  std::vector<EvdevAxis> axes;
  std::vector<std::uint16_t> keys;
};

struct EvdevState {
  std::array<std::int32_t, evdev::kAbsMax + 1> axis{};
  std::bitset<evdev::kKeyMax + 1> keys;  // pressed
};

// Where a code stands in the report.
struct EvdevField {
  EvdevCode code;
  bool is_hat = false;  // a whole one: this code and the next
  std::uint16_t bit_offset = 0;
  std::uint8_t bit_size = 0;
  std::int32_t min = 0, max = 0;
};
struct EvdevLayout {
  std::vector<std::uint8_t> descriptor;
  std::vector<EvdevField> fields;
  std::uint16_t report_bytes = 0;  // far below kMaxReportBytes, whatever a node claims
};

// Axes of multi-touch are left out. `own_descriptor` is that of the HID device behind the node,
// empty where there is none or where its kernel driver gave out codes of its own: the axes then
// stand in its order, because whether Z, Rz or Rx, Ry are the right stick shows in nothing else.
EvdevLayout evdev_layout(const EvdevAbilities& abilities,
                         std::span<const std::uint8_t> own_descriptor);

// Bytes of the report for that state. Values beyond an axis' range count as its end.
void put_state(const EvdevLayout& layout, const EvdevState& state, Report& report) noexcept;

}  // namespace gaitpad
