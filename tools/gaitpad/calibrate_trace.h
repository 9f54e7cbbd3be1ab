// A pad to calibrate out of recordings instead of a guided session.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/pad_setup.h"
#include "gaitpad/result.h"
#include "tools/gaitpad/calibrate_live.h"

namespace gaitpad {

// The first pad with a stick of each recording; all must be the same kind of pad. Remarks: damaged
// lines, reports that do not decode, other pads in the recordings.
Result<GuidedPad> traced_pad(const std::vector<std::string>& paths, Damage damage,
                             const PadFiles& files, std::vector<std::string>& remarks);
// From the last pushes of a recording, when the order in which they were made is known (`forward`,
// `right`, `back`, `left`; each of the four once at least two at right angles). A stick that was
// pushed less often keeps the layout's axes, and a remark says so.
std::optional<Error> learn_frames(const std::vector<std::string>& order, GuidedPad& pad,
                                  std::vector<std::string>& remarks);

}  // namespace gaitpad
