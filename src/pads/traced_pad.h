// Measures a pad from recordings of it, instead of a guided one.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/trace.h"
#include "pads/guided_calibration.h"

namespace gaitpad {

// Measures the first pad with a stick of each recording; all must be the same kind of pad. Remarks:
// damaged lines, reports that do not decode, other pads in the recordings.
Result<GuidedPad> traced_pad(const std::vector<std::string>& paths, Damage damage,
                             const PadFiles& files, std::vector<std::string>& remarks);

// Learns the axes of the sticks from the last pushes of a recording, if the order in which they
// were made is known (each `forward`, `right`, `back`, `left`; at least two at right angles). A
// stick that was pushed less often keeps the axes of the layout, and a remark says so.
std::optional<Error> learn_frames(const std::vector<std::string>& order, GuidedPad& pad,
                                  std::vector<std::string>& remarks);

}  // namespace gaitpad
