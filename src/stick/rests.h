// Where in its tracks a stick stood still: let go, or held aside.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
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

// Which of the places where a stick stood still is the one to which it returns.

// `found` in the order of time. Home is the place that was seen most often, not for longest, the
// more so the nearer it is to the middle; none where the stick was only held at its rim.
Stills sorted_stills(std::span<const StickTrack> tracks, std::span<const Still> found);

// What happens within single rests: their noise, and their means in blocks of time.

// A position and how many reports it stands for. Time counts from the middle of its track.
struct RestPoint {
  double time_s = 0.0;
  vec2 place{0.0};
  double weight = 0.0;
};
// The still's samples in the order of time, long holds in parts of 20 ms, without what lies far
// from all others. Tracks are clean ones.
std::vector<RestPoint> rest_points(std::span<const StickTrack> tracks, const Still& still,
                                   double interval_s);

// Straight line through points, by least squares; of slope 0 where they have no breadth in time.
struct RestTrend {
  RestPoint mean;
  vec2 slope{0.0};      // per second
  double spread = 0.0;  // sum of weight times squared time from the mean
  vec2 at(double time_s) const noexcept { return mean.place + slope * (time_s - mean.time_s); }
};
RestTrend rest_trend(std::span<const RestPoint> points) noexcept;

// Squared deviations from the trends of pieces of a second, spikes left out: slow things do not
// count as noise. Steps count.
struct RestNoise {
  vec2 squares{0.0};
  double freedom = 0.0;
  vec2 variance() const noexcept { return freedom > 0.0 ? squares / freedom : vec2(0.0); }
};
void add_noise(RestNoise& noise, std::span<const RestPoint> points);

// Means of `count` equal parts of the points' time; parts without points are left out.
std::vector<RestPoint> rest_blocks(std::span<const RestPoint> points, int count);

// The places to which a stick came back, one a release, and what they have in common.

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

// Where a stick comes to rest, how exactly, and whether it stays there.

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
