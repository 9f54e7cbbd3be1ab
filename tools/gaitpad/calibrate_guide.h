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

// Runs the guided steps on the first wished pad that comes. Nothing if the user gave up (q, Ctrl-C,
// SIGTERM, end of input): then no file must be written. At the end of a recording the steps that
// are left are skipped. Error: the wish is wrong, or the pad has no stick.
Result<std::optional<GuidedPad>> guided_pad(const PadFiles& files, const PadWish& wish,
                                            RunEnd& end);

// One remark if the driver may show other values than the pad's own; else empty.
std::vector<std::string> driver_remarks(const DeviceInfo& info);

// Asks and waits. True at Enter; false at q, Ctrl-C, SIGTERM and the end of input. Keys that were
// pressed before the question do not count.
bool confirmed(const std::string& question, RunEnd& end);

}  // namespace gaitpad
