// Recordings of `libinput record` (YAML, libinput-record(1)): evdev nodes and their events, as
// people attach them to reports of bugs. A subset of YAML, as that tool writes it, is read line by
// line; what is not evdev's (descriptors, udev's properties, libinput's own events) is skipped.
#pragma once
#include <memory>
#include <string_view>

#include "hid/evdev_recording.h"

namespace gaitpad {

bool is_libinput_record(std::string_view text) noexcept;

std::unique_ptr<EvdevReader> make_libinput_reader();

}  // namespace gaitpad
