// Finds the places at which a stick stood still in its tracks, and tells which of them are its
// rest.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "stick/stick_track.h"

namespace gaitpad {

// A time in which the stick stood still: samples `first` to `last` (inclusive) of one track.
struct Still {
  std::size_t track = 0, first = 0, last = 0;
  std::size_t begin_cell = 0, end_cell = 0;  // cells of 20 ms, from the beginning of the track
  // Times of the cells; `first` may be earlier, `last` may hold for longer.
  std::int64_t begin_ns = 0, end_ns = 0;
  // Includes the hold of the last position; silence counts for 2 s at most.
  double duration_s = 0.0;
  vec2 mean{0.0};  // raw mean, weighted as if the pad streamed
  // Unit vector: the side from which the stick came back since the rest before, or since the track
  // began; 0: the stick was hardly moved.
  vec2 from{0.0};
};
// A time in which the stick was not held: from when it has settled after a release, or from the
// beginning of a track, to the next push. It may move by itself, so it need not be still.
struct HandsOff {
  std::size_t track = 0;
  bool is_released = false;   // a spring brought it back; false: from the beginning of the track
  bool is_displaced = false;  // set by rest_statistics(): it rested far from where it mostly rests
  // Means over 0.1 s, without gaps, and the variances of these means (both axes) by noise alone.
  std::vector<vec2> places;
  std::vector<double> variances;
};
struct Stills {
  std::vector<Still> rests;   // let go: near the place to which the stick returns
  std::vector<Still> pushes;  // times in which it was held at half of the reach or farther
  std::vector<HandsOff> hands_off;
};
// Finds the stills in the order of time, track by track; only the first 24 hours of all tracks
// together are read. The limit on speed follows the noise that is present, so even a noisy or
// slowly drifting stick has stills. The settling after a release is left out. There are no rests if
// the stick only moved or was only held aside. `tracks`: from clean_tracks(). `step`: of x and y, 0
// if not known. `interval_s`: typical_interval_s() of the tracks.
Stills stills(std::span<const StickTrack> tracks, const vec2& step, double interval_s);
// Finds still times in tracks as they were recorded.
Stills stills(std::span<const StickTrack> raw_tracks);

}  // namespace gaitpad
