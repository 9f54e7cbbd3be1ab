// The evdev code that Linux's hid-input gives to a HID usage, and back. Plain tables: no header of
// the kernel is needed, so that a recording means the same on every machine.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hid/descriptor.h"

namespace gaitpad {

enum class EvdevType : std::uint8_t { key = 0x01, absolute = 0x03 };
struct EvdevCode {
  EvdevType type = EvdevType::key;
  std::uint16_t code = 0;
  bool operator==(const EvdevCode&) const = default;
};

// For every input field of the pad's application (index as in descriptor.fields) the code it gets,
// nothing where hid-input gives none. A code that is taken already goes to the next free one, as
// in the kernel. Hats get ABS_HAT0X .. (the x code of the pair).
std::vector<std::optional<EvdevCode>> evdev_codes(const ReportDescriptor& descriptor);

// The usage by which the evdev driver states a code in its descriptor, chosen so that
// evdev_codes() of that descriptor gives the code back. 0 where there is none.
std::uint32_t usage_of_code(EvdevCode code) noexcept;

}  // namespace gaitpad
