// Recordings of `libinput record` (YAML, libinput-record(1)): evdev nodes and their events, as
// people attach them to reports of bugs. A subset of YAML, as that tool writes it, is read line by
// line; what is not evdev's (descriptors, udev's properties, libinput's own events) is skipped.
#pragma once
#include <string>
#include <string_view>

#include "gaitpad/result.h"
#include "gaitpad/trace.h"

namespace gaitpad {

bool is_libinput_record(std::string_view text) noexcept;

// Every node of the recording is a device of the trace. `name` stands for the path in errors.
Result<Trace> parse_libinput_record(std::string_view text, const std::string& name, Damage damage);

}  // namespace gaitpad
