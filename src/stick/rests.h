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
  std::vector<vec2> rests;     // mean position of each release, without the odd ones
  std::optional<vec2> centre;  // mean rest; with drift, at the middle of each track
  std::optional<vec2> sigma;   // noise within the rests, without trend and spikes
  // A step of x or y is larger than the noise: there `sigma` includes rounding.
  bool is_sigma_hidden = false;
  // Greatest distance between rests, beyond noise; none: not let go between two rests.
  std::optional<double> hysteresis;
  std::optional<double> drift_per_s;  // speed at rest; exactly 0 unless it is significant
  vec2 drift{0.0};                    // the drift as a vector, per second
  // Random movement of a stick that is not held, beyond noise: standard deviation of each axis'
  // change within one second.
  double wander = 0.0;
  std::vector<HandsOff> hands_off;  // the times in which the stick was not held
  int displaced = 0;                // number of releases after which it rested far from its centre
  double displaced_by = 0.0;        // the largest of these distances
  std::vector<vec2> pushes;         // positions where the stick was held far out
};
// `tracks`: from clean_tracks(). `step`: of x and y, 0 if not known. `interval_s`:
// typical_interval_s() of the tracks.
RestStatistics rest_statistics(std::span<const StickTrack> tracks, const vec2& step,
                               double interval_s);
double seconds_of(std::span<const HandsOff> times) noexcept;

}  // namespace gaitpad
