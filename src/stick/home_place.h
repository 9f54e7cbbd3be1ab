// Which of the places where a stick stood still is the one to which it returns.
#pragma once
#include <span>
#include <vector>

#include "stick/stick_track.h"
#include "stick/stills.h"

namespace gaitpad {

// `found` in the order of time. Home is the place that was seen most often, not for longest, the
// more so the nearer it is to the middle; none where the stick was only held at its rim.
Stills sorted_stills(std::span<const StickTrack> tracks, std::span<const Still> found);

}  // namespace gaitpad
