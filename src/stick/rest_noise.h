// What happens within single rests: their noise, and their means in blocks of time.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "stick/stick_track.h"
#include "stick/stills.h"

namespace gaitpad {

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

}  // namespace gaitpad
