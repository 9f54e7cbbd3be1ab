// The statistics of a stick's raw reports: where it rests and how quietly, how far it reaches, how
// regularly it reports. Rests, turns and pushes are found in the tracks; no marks are needed.
// Set-up code; it allocates.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "stick/new_values.h"
#include "stick/outline.h"
#include "stick/rests.h"
#include "stick/stick_track.h"

namespace gaitpad {

// Positions and lengths are raw, as in StickSample. A value is left out if there are too few data
// for it.
struct StickStatistics : RestStatistics {
  std::int64_t samples = 0;  // number of all reports

  // At the rim, see outline.h.
  Outline outline;  // outline about `centre`, or about 0 without it
  std::optional<double> min_x, max_x, min_y, max_y;
  std::optional<double> circularity_error;  // circularity error in percent
  std::optional<int> unpressed;             // direction from unpressed_direction()
  std::int64_t rim_samples = 0;
  int turns = 0;  // number of whole turns, either way

  // The values and the reports, see stick_track.h.
  // Steps of the position: measured, else as declared; 0: not known.
  double step_x = 0.0, step_y = 0.0;
  std::optional<double> rate_hz;       // report rate without gaps
  std::optional<MovementRate> moving;  // rates while the stick moved
  std::optional<double> jitter_ms;     // standard deviation of the intervals, without gaps
  // Number of gaps, where reports were lost; none: the pad is silent at rest.
  std::optional<std::int64_t> gap_count;
  std::int64_t jump_count = 0;       // spikes: to another place and back within three reports
  std::int64_t long_jump_count = 0;  // number of them that last for more than one report
  std::int64_t drop_out_count = 0;   // times that an axis lost contact for longer than a spike
  double drop_out_s = 0.0;
  std::int64_t stuck_count = 0;  // number of times that the value froze while the stick moved
};
// `declared_step` (x, y): of the layout, 0 if not known.
StickStatistics stick_statistics(std::span<const StickTrack> tracks, const vec2& declared_step);

struct TriggerStatistics {
  std::int64_t samples = 0;
  // Levels of a trigger, raw 0..1; pressed: none if it was never pressed.
  std::optional<double> released, pressed;
};
TriggerStatistics trigger_statistics(std::span<const TriggerTrack> tracks);

}  // namespace gaitpad
