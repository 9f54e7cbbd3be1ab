// A stick's tracks without what would mislead: positions that are no numbers, time that goes back,
// spikes. And how long a position stood for, which all means at rest are weighted by.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "stick/stick_track.h"

namespace gaitpad {

struct CleanTracks {
  // The same samples at the same places; one that does not count repeats the one before it.
  std::vector<StickTrack> tracks;
  std::int64_t jumps = 0;  // spikes: another place and back within three reports
};
CleanTracks clean_tracks(std::span<const StickTrack> tracks);

// From one time to a later one; for any two 64-bit times.
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept;

// A silent pad may as well be gone: longer than this nothing is believed to have stood.
inline constexpr double kMaxHold_s = 2.0;
// How long sample i is known to have stood: until the next one, the last one for one interval.
double hold_s(const StickTrack& track, std::size_t i, double interval_s) noexcept;
// How many reports that is: one where the next followed soon, else as many as were left out because
// nothing changed, or lost. So a pad that reports changes only has the same means as one that
// streams, and jitter of the time stamps is no weight.
double reports_stood(double hold_s, double interval_s) noexcept;

}  // namespace gaitpad
