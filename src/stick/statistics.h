// What a stick's reports say whatever the stick does: how often they come and in what steps.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stick/outline.h"
#include "stick/rests.h"
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

// What a stick's raw reports say about it: where it rests and how quietly, how far it reaches, how
// regularly it reports. No marks are needed: rest, turning and pushes are found in the tracks.
// Set-up code. What is robust against what stands at the parts: stills, rest_statistics,
// report_statistics, clean_track.

// Positions, lengths: raw, as in StickSample. What too little data cannot tell is none.
struct StickStatistics {
  std::int64_t samples = 0;  // all reports

  // At rest.
  std::int64_t rest_samples = 0;
  double rest_s = 0.0;
  std::vector<vec2> rests;       // means of the single rests that count, one a release and track
  std::optional<vec2> centre;    // robust over the rests, the middle of their spread
  std::optional<vec2> sigma;     // noise within the rests, without trend and spikes
  bool is_sigma_hidden = false;  // it is less than a step in x or y: `sigma` is what the steps show
  std::optional<double> hysteresis;   // greatest distance of rests; none: not let go between any
  std::optional<double> drift_per_s;  // trend at rest; exactly 0 where none is significant
  vec2 drift{0.0};                    // its direction, per second
  double wander = 0.0;  // slow excursions at rest beyond noise, one standard deviation

  // At the rim, see outline.h.
  Outline outline;  // about `centre` (about 0 where that is none)
  std::optional<double> min_x, max_x, min_y, max_y;
  std::optional<double> circularity_error;  // percent
  std::int64_t rim_samples = 0;
  int turns = 0;  // whole ones, either way

  // Of the values and the reports.
  double step_x = 0.0, step_y = 0.0;  // quantisation as measured, else as declared; 0: not known
  std::optional<double> rate_hz;      // of reports that follow each other, gaps left out
  std::optional<double> jitter_ms;    // standard deviation of the intervals, gaps left out
  // Places where reports were lost; none on a pad that is silent while nothing changes.
  std::optional<std::int64_t> gaps;
  std::int64_t jumps = 0;  // spikes: to another place and back within three reports
  // The stick moved on, its value did not, and then jumped. Seen where values are repeated.
  std::int64_t stuck = 0;
};
// `declared_step` (x, y): of the layout, 0 for not known.
StickStatistics stick_statistics(std::span<const StickTrack> tracks, const vec2& declared_step);

struct TriggerStatistics {
  std::int64_t samples = 0;
  std::optional<double> released, pressed;  // raw; pressed: none where it was never pressed
};
TriggerStatistics trigger_statistics(std::span<const TriggerTrack> tracks);

}  // namespace gaitpad
