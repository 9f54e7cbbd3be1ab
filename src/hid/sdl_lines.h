// Reads and writes lines of SDL's controller data base (gamecontrollerdb): which axis, button and
// hat number is which control. SDL counts what the kernel's evdev node shows, so a HID usage is
// first turned into the code that hid-input gives it (Linux drivers/hid/hid-input.c,
// hidinput_configure_usage).
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/decode.h"
#include "gaitpad/descriptor.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The line's controls as usages of this descriptor. `driver` tells whether the descriptor is the
// device's own or stated from evdev codes (stated_by). A number that the device does not have is
// left out, as SDL does. Error if the line is damaged or longer than a trace can hold: `SDL
// mapping: unknown source "q3"`.
Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver);

// The lines of a gamecontrollerdb.txt that are for Linux, without comments, in their order. Lines
// that no recording can hold are left out.
std::vector<std::string> mapping_lines(std::string_view text);
// The one of those lines that is for this device; empty: none. As in SDL the line of another
// version counts if there is none of this one. But a line with the kernel's mark counts codes that
// the kernel's driver for the pad chose, one without it the pad's own controls: these are not
// mixed. A line with a checksum is for pads of one name. A line for printed names counts only if
// there is none by position.
std::string fitting_mapping(std::span<const std::string> lines, const DeviceInfo& device);
// The user's lines after an import: `lines`, and those of `own` with another GUID.
std::vector<std::string> merged_mappings(const std::vector<std::string>& lines,
                                         const std::vector<std::string>& own);

// Whether the mapping has no control characters, so that a calibration can hold it.
bool is_one_line(std::string_view mapping);

// The axis of the layout that moves an axis of a stick, for sticks that are mounted turned.
struct StickAxis {
  PadAxis axis = kLeftX;
  bool reversed = false;  // the axis grows against the direction of the layout
};
using StickAxes = std::array<StickAxis, 4>;  // axes of both sticks, indexed by kLeftX .. kRightY
inline constexpr StickAxes kAxesAsLaidOut = {{{kLeftX}, {kLeftY}, {kRightX}, {kRightY}}};

// The layout as a line that sdl_controls() reads back, keys in alphabetical order. The GUID is the
// one that SDL 2.26 gives to the pad's event node. Controls that are no axis, key or hat of that
// node (numbers in an array, bits of a byte) are left out. Error if kernel_numbers_problem() has
// one, or if no control is left.
Result<std::string> sdl_mapping_text(const DeviceInfo& device, const PadLayout& layout,
                                     const StickAxes& sticks = kAxesAsLaidOut);

// Why the codes of the pad's event node do not follow from its descriptor: a kernel driver for this
// pad chose them, or SDL hides them. One sentence; empty: they follow.
std::string kernel_numbers_problem(const DeviceInfo& device, const ReportDescriptor& descriptor);

}  // namespace gaitpad
