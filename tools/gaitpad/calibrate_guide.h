// The guided calibration at the terminal: shows the steps on standard error and reads keys from
// standard input.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/limbs.h"
#include "gaitpad/result.h"
#include "pads/guided_calibration.h"
#include "terminal/run_end.h"

namespace gaitpad {

inline constexpr const char* kCalibrateCommand = "calibrate";

// Runs the guided steps on the first matching pad. Returns nothing if the user gave up (q, Ctrl-C,
// SIGTERM, end of input); then no file must be written. The end of a recording skips the remaining
// steps. Error: `selector` is invalid, or the pad has no stick.
Result<std::optional<GuidedPad>> guided_pad(const PadFiles& files, const PadSelector& selector,
                                            RunEnd& end);

// A remark if the driver may show other values than the pad sends; else empty.
std::vector<std::string> driver_remarks(const DeviceInfo& info);

// Asks the question and waits. True at Enter; false at q, Ctrl-C, SIGTERM and the end of input.
// Keys pressed before the question are ignored.
bool confirmed(const std::string& question, RunEnd& end);

}  // namespace gaitpad
