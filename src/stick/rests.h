// Measures where a stick comes to rest when it is let go: how exactly, with how much noise, and
// whether it stays there.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stick/stick_track.h"
#include "stick/stills.h"

namespace gaitpad {

// Positions and lengths are raw. A value is none if there are too few data for it.
struct RestStatistics {
  std::int64_t rest_samples = 0;
  double rest_s = 0.0;
  std::vector<vec2> rests;           // mean rest of each release (and track), without the odd ones
  std::optional<vec2> centre;        // where the stick rests, in the middle of its tracks' time
  std::optional<vec2> sigma;         // noise within the rests, without trend and spikes
  bool is_sigma_hidden = false;      // it is below a step in x or y: `sigma` is what the steps show
  std::optional<double> hysteresis;  // greatest distance between rests; none: never let go between
  std::optional<double> drift_per_s;  // speed at rest; exactly 0 unless it is significant
  vec2 drift{0.0};                    // the drift as a vector, per second
  // Movement without a touch within a second, beyond noise: standard deviation of each axis, over
  // all the time in which the stick was not held.
  double wander = 0.0;
  std::vector<HandsOff> hands_off;  // the times in which the stick was not held
  int displaced = 0;                // releases after which it rested far from where it mostly rests
  double displaced_by = 0.0;        // the largest displacement of these times
  std::vector<vec2> pushes;         // positions where the stick was held far out
};
// `tracks`: clean ones (clean_tracks). `step`: of x and y, 0 if not known. `interval_s`:
// typical_interval_s of the tracks.
RestStatistics rest_statistics(std::span<const StickTrack> tracks, const vec2& step,
                               double interval_s);
double seconds_of(std::span<const HandsOff> times) noexcept;

}  // namespace gaitpad
