// The places to which a stick came back, one a release, and what they have in common.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "stick/rest_noise.h"
#include "stick/stick_track.h"
#include "stick/stills.h"

namespace gaitpad {

inline constexpr double kReleaseMovement = 0.2;  // raw; less between two rests is no release

// A rest between two movements; what noise or a touch cut in two belongs to one release.
struct Release {
  std::vector<Still> stills;  // at one place, in the order of time
  std::size_t track = 0;
  RestPoint rest;  // mean of all; weight: reports
  vec2 from{0.0};  // unit, the side from which it came; 0: not seen
};
std::vector<Release> releases_of(std::span<const StickTrack> tracks, std::span<const Still> rests,
                                 double interval_s);

// Rests explained by where the stick was let go and by drift:
// place = home + returns * from + drift * time. The home is one of its track.
struct ReturnModel {
  std::vector<bool> counts;  // of each release; odd ones and those without `from` do not
  int used = 0;
  vec2 home{0.0};          // weighted alike over the releases used
  vec2 drift{0.0};         // per second, 0 if it was not asked for
  double residual = 0.0;   // sum of squares, both axes
  double spread_s2 = 0.0;  // of the times, that part which `from` does not explain
};
enum class Explain { home, returns, returns_and_drift };
// `noise`: standard deviation of one rest's mean, one axis; odd ones are farther off than that.
ReturnModel return_model(std::span<const Release> releases, Explain explain, double noise);

// Middle of the smallest circle round all places that count; 0 for none.
vec2 middle_of(std::span<const vec2> places) noexcept;
// Greatest distance between two, to 0.1 %.
double greatest_distance(std::span<const vec2> places) noexcept;

}  // namespace gaitpad
