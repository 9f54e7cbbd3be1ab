#include "stick/rest_noise.h"

#include <algorithm>
#include <cmath>

#include "stick/clean_track.h"

namespace gaitpad {
namespace {

constexpr double kPart_s = 0.02, kPiece_s = 1.0;
constexpr double kFewestReports = 8.0;  // that tell of noise
constexpr double kSpike = 4.5;          // standard deviations

double time_s(const StickTrack& track, std::int64_t time_ns) noexcept {
  const double whole_s = seconds_between(track.front().time_ns, track.back().time_ns);
  return seconds_between(track.front().time_ns, time_ns) - 0.5 * whole_s;
}

RestNoise noise_about(const RestTrend& line, std::span<const RestPoint> points) noexcept {
  RestNoise noise;
  for (const RestPoint& point : points) {
    const vec2 off = point.place - line.at(point.time_s);
    noise.squares += point.weight * off * off;
    noise.freedom += point.weight;
  }
  noise.freedom = std::max(noise.freedom - 2.0, 0.0);
  return noise;
}

// Leaves out what lies far from the line through all; returns whether there was any.
bool take_spikes_out(std::vector<RestPoint>& points) {
  const RestTrend line = rest_trend(points);
  const RestNoise noise = noise_about(line, points);
  if (noise.freedom < kFewestReports) return false;
  const vec2 limit = kSpike * kSpike * noise.variance();
  return std::erase_if(points, [&](const RestPoint& point) {
           const vec2 off = point.place - line.at(point.time_s);
           return off.x * off.x > limit.x || off.y * off.y > limit.y;
         }) > 0;
}

RestNoise piece_noise(std::vector<RestPoint> points) {
  take_spikes_out(points);
  const RestNoise noise = noise_about(rest_trend(points), points);
  return noise.freedom < kFewestReports ? RestNoise{} : noise;
}

}  // namespace

std::vector<RestPoint> rest_points(std::span<const StickTrack> tracks, const Still& still,
                                   double interval_s) {
  const StickTrack& track = tracks[still.track];
  const double begin_s = time_s(track, still.begin_ns), end_s = time_s(track, still.end_ns);
  std::vector<RestPoint> points;
  for (std::size_t i = still.first; i <= still.last; ++i) {
    const double stood_s = hold_s(track, i, interval_s);
    const double weight = reports_stood(stood_s, interval_s);
    const double from_s = time_s(track, track[i].time_ns);
    const int parts = std::max(static_cast<int>(std::ceil(stood_s / kPart_s)), 1);
    for (int k = 0; k < parts; ++k) {
      const double at_s = from_s + stood_s * (k + 0.5) / parts;
      if (parts > 1 && (at_s < begin_s || at_s > end_s)) continue;
      points.push_back({at_s, track[i].raw, weight / parts});
    }
  }
  take_spikes_out(points);
  return points;
}

RestTrend rest_trend(std::span<const RestPoint> points) noexcept {
  RestTrend line;
  for (const RestPoint& point : points) {
    line.mean.weight += point.weight;
    line.mean.time_s += point.weight * point.time_s;
    line.mean.place += point.weight * point.place;
  }
  if (!(line.mean.weight > 0.0)) return line;
  line.mean.time_s /= line.mean.weight;
  line.mean.place /= line.mean.weight;
  vec2 product(0.0);
  for (const RestPoint& point : points) {
    const double t = point.time_s - line.mean.time_s;
    line.spread += point.weight * t * t;
    product += point.weight * t * (point.place - line.mean.place);
  }
  if (line.spread > 1e-9 * line.mean.weight) line.slope = product / line.spread;
  return line;
}

void add_noise(RestNoise& noise, std::span<const RestPoint> points) {
  if (points.empty()) return;
  const double begin_s = points.front().time_s;
  const double whole_s = points.back().time_s - begin_s;
  const double pieces = std::max(std::ceil(whole_s / kPiece_s), 1.0);
  const auto piece_of = [&](const RestPoint& point) {
    if (!(whole_s > 0.0)) return 0.0;
    return std::min(std::floor((point.time_s - begin_s) / whole_s * pieces), pieces - 1.0);
  };
  for (std::size_t first = 0, end; first < points.size(); first = end) {
    end = first + 1;
    while (end < points.size() && piece_of(points[end]) == piece_of(points[first])) ++end;
    const RestNoise found =
        piece_noise(std::vector<RestPoint>(points.begin() + static_cast<std::ptrdiff_t>(first),
                                           points.begin() + static_cast<std::ptrdiff_t>(end)));
    noise.squares += found.squares;
    noise.freedom += found.freedom;
  }
}

std::vector<RestPoint> rest_blocks(std::span<const RestPoint> points, int count) {
  std::vector<RestPoint> blocks(static_cast<std::size_t>(std::max(count, 1)));
  if (points.empty()) return {};
  const double begin_s = points.front().time_s;
  const double whole_s = std::max(points.back().time_s - begin_s, 1e-9);
  for (const RestPoint& point : points) {
    const double part = (point.time_s - begin_s) / whole_s * static_cast<double>(blocks.size());
    RestPoint& block = blocks[std::min(static_cast<std::size_t>(part), blocks.size() - 1)];
    block.weight += point.weight;
    block.time_s += point.weight * point.time_s;
    block.place += point.weight * point.place;
  }
  std::erase_if(blocks, [](const RestPoint& block) { return !(block.weight > 0.0); });
  for (RestPoint& block : blocks) {
    block.time_s /= block.weight;
    block.place /= block.weight;
  }
  return blocks;
}

}  // namespace gaitpad
