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

// The controls as usages of this descriptor. `driver` is the device's: whether its own descriptor
// or one stated from evdev codes (hid/evdev_codes.h). Error for a damaged line, or one longer than
// a trace can hold: `SDL mapping: unknown source "q3"`; a number that the device does not have is
// left out, as SDL does.
Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver);

}  // namespace gaitpad
