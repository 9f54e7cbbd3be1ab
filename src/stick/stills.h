// Where in its tracks a stick stood still: let go, or held aside.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stick/stick_track.h"

namespace gaitpad {

// A while in which the stick stood still, `first` to `last` inclusive in its track.
struct Still {
  std::size_t track = 0, first = 0, last = 0;
  std::int64_t begin_ns = 0, end_ns = 0;  // `first` came before, `last` may hold longer
  double duration_s = 0.0;  // with the time that the last position held, silence for 2 s at most
  vec2 mean{0.0};           // raw, of all reports that a pad would have sent that streams
};
// Found by velocity against the noise at hand, so a noisy or slowly drifting stick still counts.
// Settling after a release is left out.
struct Stills {
  std::vector<Still> rests;   // let go: near the place to which it returns
  std::vector<Still> pushes;  // held at half of the reach or more
};
// Spikes do not count. In the order of time, a track after the other; the first day of all counts.
// Where the stick only moved or was only held aside there are no rests. `declared_step`: of x
// and y, for tracks that show too few values to measure it; 0 for not known.
Stills stills(std::span<const StickTrack> tracks, const vec2& declared_step = vec2(0.0));

}  // namespace gaitpad
