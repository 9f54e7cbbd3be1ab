// What a stick's reports say whatever the stick does: how often they come and in what steps.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "stick/stick_track.h"

namespace gaitpad {

// Seconds between reports that follow each other. On pads that report changes only these are the
// ones while the stick moves. Robust against lost reports and bursts; 4 ms where there are too few.
double typical_interval_s(std::span<const StickTrack> tracks);

struct ReportTiming {
  std::optional<double> rate_hz, jitter_ms;  // none: too few reports
  std::optional<std::int64_t> gaps;          // none: as well where silence tells nothing
};
// `repeats_expected`: the chance that a report at rest is the same as the one before, as far as
// noise and steps tell. A pad that repeats itself less often, or never, reports changes only as far
// as one can see, and nobody knows its gaps.
ReportTiming report_timing(std::span<const StickTrack> tracks, double repeats_expected);

// The smallest distance between neighbouring values that is seen often enough to be a step, else
// `declared`. Axis 0 is x, 1 is y.
double quantisation_step(std::span<const StickTrack> tracks, int axis, double declared);

// How often the value froze for 60 ms or more while the stick moved on, and then jumped after it.
std::int64_t stuck_values(std::span<const StickTrack> tracks, double interval_s);

// Whole turns round the middle, farther out than `radius`, each way counted.
int whole_turns(std::span<const StickTrack> tracks, const vec2& middle, double radius);

}  // namespace gaitpad
