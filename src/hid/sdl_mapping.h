// Lines of SDL's controller data base (gamecontrollerdb): which axis, button and hat number is
// which control. SDL counts what the kernel's evdev node shows, so a HID usage is first turned into
// the code that hid-input gives it (Linux drivers/hid/hid-input.c, hidinput_configure_usage).
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "hid/descriptor.h"
#include "hid/pad_map.h"

namespace gaitpad {

// The controls as usages of this descriptor. `driver` is the device's: an sdl device states its
// axes, buttons and hats in SDL's own order, all others are counted by evdev codes. Error for a
// damaged line: `SDL mapping: unknown source "q3"`; a number that the device does not have is left
// out, as SDL does.
Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver);

}  // namespace gaitpad
