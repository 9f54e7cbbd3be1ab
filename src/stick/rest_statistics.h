// Where a stick comes to rest, how exactly, and whether it stays there.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stick/stick_track.h"
#include "stick/stills.h"

namespace gaitpad {

// The members are those of StickStatistics.
struct RestStatistics {
  std::int64_t samples = 0;
  double seconds = 0.0;
  std::vector<vec2> rests;
  std::optional<vec2> centre, sigma;
  bool is_sigma_hidden = false;
  std::optional<double> hysteresis, drift_per_s;
  vec2 drift{0.0};
  double wander = 0.0;
};
// `tracks`: clean ones, `rests`: found in them. `step`: of x and y, 0 for not known.
RestStatistics rest_statistics(std::span<const StickTrack> tracks, std::span<const Still> rests,
                               const vec2& step, double interval_s);

}  // namespace gaitpad
