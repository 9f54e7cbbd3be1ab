// The guided calibration at the terminal: shows the steps on standard error and takes keys from
// standard input.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "hid/decode.h"
#include "session/pad_choice.h"
#include "stick/stick_track.h"
#include "tools/gaitpad/live_run.h"

namespace gaitpad {

inline constexpr const char* kSideNames[] = {"left", "right"};

struct GuidedPad {
  DeviceInfo info;
  PadLayout layout;
  bool has_factory_sticks = false;
  PadTracks tracks;                 // raw, as the layout has them
  std::array<StickFrame, 2> frame;  // left, right
};
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
