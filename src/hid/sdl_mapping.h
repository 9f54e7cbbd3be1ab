// Reads and writes lines of SDL's controller data base (gamecontrollerdb): which axis, button and
// hat number is which control. SDL counts what the kernel's evdev node shows, so a HID usage is
// first turned into the code that hid-input gives it (Linux drivers/hid/hid-input.c,
// hidinput_configure_usage).
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "gaitpad/decode.h"
#include "gaitpad/descriptor.h"
#include "gaitpad/pad_map.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The line's controls as usages of this descriptor. `driver` tells whether the descriptor is the
// device's own or stated from evdev codes (stated_by). A number that the device does not have is
// left out, as SDL does. Error if the line is damaged or longer than a trace can hold: `SDL
// mapping: unknown source "q3"`.
Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver);

// Whether the mapping has no control characters, so that a calibration can hold it.
bool is_one_line(std::string_view mapping);

// Which axis of the layout moves an axis of a stick, for sticks that are mounted turned.
struct StickAxis {
  PadAxis axis = kLeftX;
  bool reversed = false;  // against the direction of the layout
};
using StickAxes = std::array<StickAxis, 4>;  // by kLeftX .. kRightY
inline constexpr StickAxes kAxesAsLaidOut = {{{kLeftX}, {kLeftY}, {kRightX}, {kRightY}}};

// The layout as a line that sdl_controls() reads back, keys in alphabetical order. The GUID is the
// one that SDL 2.26 gives to the pad's event node. Controls that are no axis, key or hat of that
// node (numbers in an array, bits of a byte) are left out. Error if kernel_numbers_problem() has
// one, or if no control is left.
Result<std::string> sdl_mapping_text(const DeviceInfo& device, const PadLayout& layout,
                                     const StickAxes& sticks = kAxesAsLaidOut);

// Why the codes of the pad's event node do not follow from its descriptor: a kernel driver for this
// pad chose them. One sentence; empty: they follow.
std::string kernel_numbers_problem(const DeviceInfo& device, const ReportDescriptor& descriptor);

}  // namespace gaitpad
