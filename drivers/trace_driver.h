// Makes the driver that plays a recording (hid/trace.h).
#pragma once
#include "hid/driver.h"

namespace gaitpad {

// `path` is a `.hid` file; the error is the reader's sentence.
Result<std::unique_ptr<Driver>> make_trace_driver(const std::string& path);

}  // namespace gaitpad
