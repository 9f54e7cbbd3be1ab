// The guided calibration at the terminal: shows the steps on standard error and takes keys from
// standard input.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "pads/guided_calibration.h"
#include "tools/gaitpad/live_run.h"

namespace gaitpad {

inline constexpr const char* kSideNames[] = {"left", "right"};

// The guided steps on the first wished pad that comes. None where the user gave up (q, Ctrl-C,
// SIGTERM, end of input): nothing is to be written then. A recording's end skips
// what is left. Error: the wish is wrong, or the pad has no stick.
Result<std::optional<GuidedPad>> guided_pad(const PadFiles& files, const PadWish& wish,
                                            RunEnd& end);

// That the driver shows other values than the pad's own, where it may.
std::vector<std::string> driver_remarks(const DeviceInfo& info);

// Asks and waits: true at Enter; false at q, Ctrl-C, SIGTERM, end of input. Keys that were pressed
// before the question do not count.
bool confirmed(const std::string& question, RunEnd& end);

}  // namespace gaitpad
