// Lines of SDL's controller data base (gamecontrollerdb): which axis, button and hat number is
// which control. SDL counts what the kernel's evdev node shows, so a HID usage is first turned into
// the code that hid-input gives it (Linux drivers/hid/hid-input.c, hidinput_configure_usage).
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

// The controls as usages of this descriptor. `driver` is the device's: whether its own descriptor
// or one stated from evdev codes (hid/evdev_codes.h). Error for a damaged line, or one longer than
// a trace can hold: `SDL mapping: unknown source "q3"`; a number that the device does not have is
// left out, as SDL does.
Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver);

// Without control characters: what a calibration keeps of a mapping.
bool is_one_line(std::string_view mapping);

// The layout's axis that moves a stick's axis, for sticks that lie otherwise than the layout has
// it.
struct StickAxis {
  PadAxis axis = kLeftX;
  bool reversed = false;  // against the layout's direction
};
using StickAxes = std::array<StickAxis, 4>;  // of kLeftX .. kRightY
inline constexpr StickAxes kAxesAsLaidOut = {{{kLeftX}, {kLeftY}, {kRightX}, {kRightY}}};

// The layout as such a line, keys in the order of the alphabet, that sdl_controls reads back. Its
// GUID is the one that SDL 2.26 gives to the pad's event node; controls that are no axis, key or
// hat of that node (numbers in an array, bits of a byte) are left out. Error where
// kernel_numbers_problem has one and where nothing is left.
Result<std::string> sdl_mapping_text(const DeviceInfo& device, const PadLayout& layout,
                                     const StickAxes& sticks = kAxesAsLaidOut);

// Why the codes of the pad's event node cannot be told from its descriptor: a kernel driver of its
// own gave them out. One sentence; empty: they can.
std::string kernel_numbers_problem(const DeviceInfo& device, const ReportDescriptor& descriptor);

}  // namespace gaitpad
