#include "stick/rests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/numeric.h"

namespace gaitpad {

namespace {

// ---- Single rests: points, trends, noise

// A position and the number of reports that it stands for. Time counts from the middle of its
// track.
struct RestPoint {
  double time_s = 0.0;
  vec2 place{0.0};
  double weight = 0.0;
};

// Sums up for a weighted mean; divide() completes it.
void add(RestPoint& sum, const RestPoint& point) noexcept {
  sum.weight += point.weight;
  sum.time_s += point.weight * point.time_s;
  sum.place += point.weight * point.place;
}
void divide(RestPoint& sum) noexcept {
  sum.time_s /= sum.weight;
  sum.place /= sum.weight;
}

// Straight line through points by least squares; slope 0 if they have no extent in time.
struct RestTrend {
  RestPoint mean;
  vec2 slope{0.0};      // slope per second
  double spread = 0.0;  // sum of weight times squared time from the mean
  vec2 at(double time_s) const noexcept { return mean.place + slope * (time_s - mean.time_s); }
};

// Squared deviations from trends over pieces of a second, without spikes: slow movement does not
// count as noise, rounding does.
struct RestNoise {
  vec2 squares{0.0};
  double freedom = 0.0;  // degrees of freedom of each axis
  vec2 variance() const noexcept { return freedom > 0.0 ? squares / freedom : vec2(0.0); }
};

constexpr double kPart_s = 0.02, kPiece_s = 1.0;
constexpr double kFewestReports = 8.0;  // fewest reports for an estimate of noise
constexpr double kSpike = 4.5;          // distance of a spike, in standard deviations

double time_s(const StickTrack& track, std::int64_t time_ns) noexcept {
  const double whole_s = seconds_between(track.front().time_ns, track.back().time_ns);
  return seconds_between(track.front().time_ns, time_ns) - 0.5 * whole_s;
}

RestTrend rest_trend(std::span<const RestPoint> points) noexcept {
  RestTrend line;
  for (const RestPoint& point : points) add(line.mean, point);
  if (!(line.mean.weight > 0.0)) return line;
  divide(line.mean);
  vec2 product(0.0);
  for (const RestPoint& point : points) {
    const double t = point.time_s - line.mean.time_s;
    line.spread += point.weight * t * t;
    product += point.weight * t * (point.place - line.mean.place);
  }
  if (line.spread > 1e-9 * line.mean.weight) line.slope = product / line.spread;
  return line;
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

// Leaves out points far from the line through all of them.
void remove_spikes(std::vector<RestPoint>& points) {
  const RestTrend line = rest_trend(points);
  const RestNoise noise = noise_about(line, points);
  if (noise.freedom < kFewestReports) return;
  const vec2 limit = kSpike * kSpike * noise.variance();
  std::erase_if(points, [&](const RestPoint& point) {
    const vec2 off = point.place - line.at(point.time_s);
    return off.x * off.x > limit.x || off.y * off.y > limit.y;
  });
}

RestNoise piece_noise(std::vector<RestPoint> points) {
  remove_spikes(points);
  const RestNoise noise = noise_about(rest_trend(points), points);
  return noise.freedom < kFewestReports ? RestNoise{} : noise;
}

// The still's samples in the order of time, long holds in parts of 20 ms.
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
  return points;
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

// Means over `count` equal parts of the time; parts without points are left out.
std::vector<RestPoint> rest_blocks(std::span<const RestPoint> points, int count) {
  std::vector<RestPoint> blocks(static_cast<std::size_t>(std::max(count, 1)));
  if (points.empty()) return {};
  const double begin_s = points.front().time_s;
  const double whole_s = std::max(points.back().time_s - begin_s, 1e-9);
  for (const RestPoint& point : points) {
    const double part = (point.time_s - begin_s) / whole_s * static_cast<double>(blocks.size());
    add(blocks[std::min(static_cast<std::size_t>(part), blocks.size() - 1)], point);
  }
  std::erase_if(blocks, [](const RestPoint& block) { return !(block.weight > 0.0); });
  for (RestPoint& block : blocks) divide(block);
  return blocks;
}

// ---- Releases

// A rest between two movements. Rests that noise or a touch cut in two belong to one release.
struct Release {
  std::vector<Still> stills;  // still times at one place, in the order of time
  std::size_t track = 0;
  RestPoint rest;  // mean of all reports; its weight is their number
  vec2 from{0.0};  // unit vector to the side from which the stick returned; 0: not seen
};

constexpr double kSamePlace = 0.02;  // raw; stills this near to each other are one rest
constexpr double kOdd = 0.005;       // raw; a rest that is off by less is not left out
// With more releases no odd one is searched, because the time grows with the cube.
constexpr std::size_t kMostTried = 64;

// One release from the longest of the stills and those at its place.
Release release_of(std::span<const StickTrack> tracks, std::span<const Still> stills,
                   double interval_s) {
  const Still& longest =
      *std::max_element(stills.begin(), stills.end(),
                        [](const Still& a, const Still& b) { return a.duration_s < b.duration_s; });
  Release release{.stills = {}, .track = longest.track, .rest = {}};
  for (const Still& still : stills) {
    if (glm::length(still.mean - longest.mean) > kSamePlace) continue;
    release.stills.push_back(still);
    for (const RestPoint& point : rest_points(tracks, still, interval_s)) add(release.rest, point);
  }
  divide(release.rest);
  return release;
}

std::vector<Release> releases_of(std::span<const StickTrack> tracks, std::span<const Still> rests,
                                 double interval_s) {
  std::vector<Release> releases;
  for (std::size_t first = 0, end; first < rests.size(); first = end) {
    end = first + 1;
    while (end < rests.size() && rests[end].track == rests[first].track &&
           rests[end].from == vec2(0.0)) {
      ++end;
    }
    releases.push_back(release_of(tracks, rests.subspan(first, end - first), interval_s));
    releases.back().from = rests[first].from;
  }
  return releases;
}

// ---- Explaining where it rests

// Rests explained by the side of the release and by drift:
// place = centre + returns * from + drift * time. Each track has its own centre.
struct ReturnModel {
  // For each release: it is used; odd ones and those without `from` are not.
  std::vector<bool> counts;
  int used = 0;
  vec2 centre{0.0};        // mean over the releases that are used
  vec2 drift{0.0};         // drift per second; 0 unless it was asked for
  double residual = 0.0;   // sum of squared differences of both axes
  double spread_s2 = 0.0;  // spread of the times that `from` does not explain
};
enum class Explain { centre, returns, returns_and_drift };

// One release and the possible causes of its place, relative to the means of its track.
struct Row {
  std::array<double, 3> cause{};  // variables of the fit: from.x, from.y, time
  vec2 place{0.0};
};

struct Solution {
  std::array<vec2, 3> effect{};
  double residual = 0.0;
  double spread_s2 = 0.0;
};

// Least squares of both axes on the causes first .. last - 1. A small ridge term keeps it solvable
// if the causes hardly differ.
Solution solve(std::span<const Row> rows, std::size_t first, std::size_t last) {
  std::array<std::array<double, 3>, 3> a{};
  std::array<vec2, 3> b{};
  for (const Row& row : rows) {
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t k = first; k < last; ++k) a[i][k] += row.cause[i] * row.cause[k];
      b[i] += row.cause[i] * row.place;
    }
  }
  for (std::size_t i = first; i < last; ++i) {
    a[i][i] += 1e-3 * (i < 2 ? static_cast<double>(rows.size()) : 1e-6);
  }
  for (std::size_t i = first; i < last; ++i) {  // positive definite: no pivots needed
    for (std::size_t k = i + 1; k < last; ++k) {
      const double f = a[k][i] / a[i][i];
      for (std::size_t j = i; j < last; ++j) a[k][j] -= f * a[i][j];
      b[k] -= f * b[i];
    }
  }
  Solution solution;
  solution.spread_s2 = last == 3 ? a[2][2] : 0.0;
  for (std::size_t i = last; i > first; --i) {
    vec2 rest = b[i - 1];
    for (std::size_t k = i; k < last; ++k) rest -= a[i - 1][k] * solution.effect[k];
    solution.effect[i - 1] = rest / a[i - 1][i - 1];
  }
  for (const Row& row : rows) {
    vec2 off = row.place;
    for (std::size_t i = first; i < last; ++i) off -= row.cause[i] * solution.effect[i];
    solution.residual += glm::dot(off, off);
  }
  return solution;
}

Row row_of(const Release& release) noexcept {
  return {{release.from.x, release.from.y, release.rest.time_s}, release.rest.place};
}

// Rows relative to the mean of their track; releases of one track are neighbours.
std::vector<Row> centred_rows(std::span<const Release> releases, const std::vector<bool>& counts) {
  std::vector<Row> rows;
  for (std::size_t first = 0, end; first < releases.size(); first = end) {
    Row mean;
    double count = 0.0;
    const std::size_t begin = rows.size();
    for (end = first; end < releases.size() && releases[end].track == releases[first].track;
         ++end) {
      if (!counts[end]) continue;
      rows.push_back(row_of(releases[end]));
      for (std::size_t i = 0; i < 3; ++i) mean.cause[i] += rows.back().cause[i];
      mean.place += rows.back().place;
      count += 1.0;
    }
    for (std::size_t k = begin; k < rows.size(); ++k) {
      for (std::size_t i = 0; i < 3; ++i) rows[k].cause[i] -= mean.cause[i] / count;
      rows[k].place -= mean.place / count;
    }
  }
  return rows;
}

Solution solve(std::span<const Release> releases, const std::vector<bool>& counts,
               Explain explain) {
  const std::vector<Row> rows = centred_rows(releases, counts);
  const std::size_t first = explain == Explain::centre ? 2 : 0;
  return solve(rows, first, explain == Explain::returns_and_drift ? 3 : 2);
}

int count_of(const std::vector<bool>& counts) {
  return static_cast<int>(std::count(counts.begin(), counts.end(), true));
}

// Leaves out the release without which the others agree best, if they then agree far better.
bool leave_odd_out(std::span<const Release> releases, Explain explain, double noise,
                   std::vector<bool>& counts) {
  const double before = solve(releases, counts, explain).residual;
  const double freedom = 2.0 * (count_of(counts) - 5);
  if (freedom < 4.0) return false;
  double best = before;
  std::size_t odd = 0;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (!counts[i]) continue;
    counts[i] = false;
    const double without = solve(releases, counts, explain).residual;
    counts[i] = true;
    if (without < best) {
      best = without;
      odd = i;
    }
  }
  const double noise_of_all = std::max(best / freedom, noise * noise);
  if (before - best < std::max(50.0 * noise_of_all, kOdd * kOdd)) return false;
  counts[odd] = false;
  return true;
}

// `noise`: standard deviation of one rest's mean, one axis; an odd release is farther off than this
// noise explains.
ReturnModel return_model(std::span<const Release> releases, Explain explain, double noise) {
  ReturnModel model;
  model.counts.resize(releases.size());
  for (std::size_t i = 0; i < releases.size(); ++i) model.counts[i] = releases[i].from != vec2(0.0);
  const int all = count_of(model.counts);
  if (releases.size() <= kMostTried) {
    for (int odd = 0; odd < all / 4; ++odd) {
      if (!leave_odd_out(releases, explain, noise, model.counts)) break;
    }
  }
  const Solution solution = solve(releases, model.counts, explain);
  model.used = count_of(model.counts);
  model.residual = solution.residual;
  model.drift = solution.effect[2];
  model.spread_s2 = solution.spread_s2;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (!model.counts[i]) continue;
    const Row row = row_of(releases[i]);
    model.centre += row.place;
    for (std::size_t k = 0; k < 3; ++k) model.centre -= row.cause[k] * solution.effect[k];
  }
  if (model.used > 0) model.centre /= static_cast<double>(model.used);
  return model;
}

// ---- Distances between places

// Middle of the smallest circle round all places; 0 for none.
vec2 middle_of(std::span<const vec2> places) noexcept {
  if (places.empty()) return vec2(0.0);
  vec2 middle(0.0);
  for (const vec2& place : places) middle += place / static_cast<double>(places.size());
  // Badoiu and Clarkson: ever smaller steps towards the farthest place. The error is 1 / steps of
  // the radius.
  const int steps =
      static_cast<int>(std::clamp(1e7 / static_cast<double>(places.size()), 50.0, 1e3));
  for (int k = 1; k <= steps; ++k) {
    const vec2* farthest = &places.front();
    for (const vec2& place : places) {
      if (glm::length(place - middle) > glm::length(*farthest - middle)) farthest = &place;
    }
    middle += (*farthest - middle) / static_cast<double>(k + 1);
  }
  return middle;
}

// Greatest distance between two places, to 0.1 %.
double greatest_distance(std::span<const vec2> places) noexcept {
  double greatest = 0.0;
  for (int k = 0; k < 64 && !places.empty(); ++k) {
    const SinCos s = sin_cos(k * kPi / 64.0);
    double least = 1e9, most = -1e9;
    for (const vec2& place : places) {
      const double along = place.x * s.cos + place.y * s.sin;
      least = std::min(least, along);
      most = std::max(most, along);
    }
    greatest = std::max(greatest, most - least);
  }
  return greatest;
}

// ---- Evidence

constexpr double kBlock_s = 0.1;
constexpr double kFewestRestReports = 5.0;
constexpr double kSettling_s = 1.0;  // after a release; some sticks creep to their rest
constexpr double kShortestForDrift_s = 0.5;
constexpr double kSlowestDrift_per_s = 0.0005;

// Everything known about the rests; drift, centre and noise are derived from it.
struct Evidence {
  std::vector<Release> releases;
  RestNoise noise;
  double mean_noise = 0.0;   // standard deviation of a release's mean, one axis
  double block_noise = 0.0;  // measured noise of a block's mean
  double white_noise = 0.0;  // noise of a block's mean if all noise were white
  double seconds = 0.0, longest_s = 0.0;
  double weight = 0.0;                         // number of reports
  std::vector<std::vector<RestPoint>> blocks;  // blocks of each still time, each of weight 1
  std::vector<RestPoint> settled;              // blocks of the longest still, without settling
  double step = 0.0;
  // Noise of a mean by rounding, step / sqrt(12); 0 if other noise averages rounding out.
  double step_noise = 0.0;
};

void add_still(Evidence& evidence, std::span<const StickTrack> tracks, const Release& release,
               const Still& still, double interval_s) {
  const std::vector<RestPoint> points = rest_points(tracks, still, interval_s);
  add_noise(evidence.noise, points);
  const int count = std::max(static_cast<int>(std::lround(still.duration_s / kBlock_s)), 1);
  evidence.blocks.push_back(rest_blocks(points, count));
  for (RestPoint& block : evidence.blocks.back()) {
    evidence.weight += block.weight;
    block.weight = 1.0;
  }
  evidence.seconds += still.duration_s;
  if (still.duration_s > evidence.longest_s && !evidence.blocks.back().empty()) {
    evidence.longest_s = still.duration_s;
    evidence.settled = evidence.blocks.back();
    const double from_s = evidence.settled.front().time_s + kSettling_s;
    if (release.from != vec2(0.0)) {
      std::erase_if(evidence.settled,
                    [&](const RestPoint& block) { return block.time_s < from_s; });
    }
  }
}

Evidence evidence_of(std::span<const StickTrack> tracks, std::span<const Still> rests,
                     const vec2& step, double interval_s) {
  Evidence evidence;
  evidence.step = std::max(step.x, step.y);
  evidence.releases = releases_of(tracks, rests, interval_s);
  for (const Release& release : evidence.releases) {
    for (const Still& still : release.stills)
      add_still(evidence, tracks, release, still, interval_s);
  }
  double blocks = 0.0, squares = 0.0, freedom = 0.0;
  for (const std::vector<RestPoint>& still : evidence.blocks) {
    blocks += static_cast<double>(still.size());
    if (still.size() < 4) continue;
    const RestTrend line = rest_trend(still);
    for (const RestPoint& block : still) {
      const vec2 off = block.place - line.at(block.time_s);
      squares += 0.5 * glm::dot(off, off);
    }
    freedom += static_cast<double>(still.size()) - 2.0;
  }
  if (blocks == 0.0) return evidence;
  const vec2 variance = evidence.noise.variance();
  evidence.white_noise =
      std::sqrt(0.5 * (variance.x + variance.y) * blocks / std::max(evidence.weight, 1.0));
  if (std::max(variance.x, variance.y) < 0.5 * evidence.step * evidence.step) {
    evidence.step_noise = evidence.step / std::sqrt(12.0);
  }
  const double measured = freedom >= 6.0 ? std::sqrt(squares / freedom) : 0.0;
  // If the reported value never changes, the place is known to within a step only.
  evidence.block_noise = std::max({evidence.white_noise, measured, 0.02 * evidence.step, 1e-7});
  const double blocks_each = blocks / static_cast<double>(evidence.releases.size());
  evidence.mean_noise = evidence.block_noise / std::sqrt(blocks_each);
  return evidence;
}

// ---- Drift

// Logarithm of the likelihood of the rests with a trend over that without one. kSure = 16 is one in
// ten million: neither chance nor habits of the hand often look that much like a line. If noise
// explains the residual with the trend, the noise is the measure, else the residual.
constexpr double kSure = 16.0, kSureOfOne = 12.0;
double log_odds(double without, double with, double freedom, double noise) noexcept {
  const double variance = noise * noise;
  const double by_residual =
      0.5 * freedom * std::log((without + freedom * variance) / (with + freedom * variance));
  if (with > variance * (freedom + 3.0 * std::sqrt(2.0 * freedom))) return by_residual;
  return std::max(by_residual, 0.5 * (without - with) / variance);
}

bool is_worth_reporting(const Evidence& evidence, const vec2& drift, double seconds, double steps) {
  const double speed = glm::length(drift);
  const double noise = std::sqrt(0.5 * (evidence.noise.variance().x + evidence.noise.variance().y) /
                                 std::max(evidence.weight, 1.0));
  return speed >= kSlowestDrift_per_s &&
         speed * seconds >= std::max(steps * evidence.step, 2.0 * noise);
}

double time_range_s(std::span<const Release> releases) noexcept {
  double longest = 0.0;
  for (std::size_t first = 0, end; first < releases.size(); first = end) {
    for (end = first; end < releases.size() && releases[end].track == releases[first].track;
         ++end) {
      longest = std::max(longest, releases[end].rest.time_s - releases[first].rest.time_s);
    }
  }
  return longest;
}

int tracks_of(std::span<const Release> releases) noexcept {
  int tracks = 0;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    tracks += i == 0 || releases[i].track != releases[i - 1].track;
  }
  return tracks;
}

// Drift between rests: they move to one side over time by more than the directions of the releases
// explain.
vec2 drift_across_rests(const Evidence& evidence) {
  const auto& releases = evidence.releases;
  const ReturnModel with = return_model(releases, Explain::returns_and_drift, evidence.mean_noise);
  const ReturnModel without = return_model(releases, Explain::returns, evidence.mean_noise);
  const double freedom = 2.0 * (with.used - tracks_of(releases) - 3);
  if (freedom < 2.0) return vec2(0.0);
  const double odds = log_odds(without.residual, with.residual, freedom, evidence.mean_noise);
  const double error = evidence.mean_noise / std::sqrt(std::max(with.spread_s2, 1e-12));
  if (odds < kSure || glm::length(with.drift) < 6.0 * error) return vec2(0.0);
  const bool is_worth = is_worth_reporting(evidence, with.drift, time_range_s(releases), 1.0);
  return is_worth ? with.drift : vec2(0.0);
}

// Drift within the longest rest, used if there are few releases: a line over eight parts.
vec2 drift_within_rest(const Evidence& evidence) {
  const std::span<const RestPoint> blocks = evidence.settled;
  const std::vector<RestPoint> parts = rest_blocks(blocks, 8);
  if (parts.size() < 5) return vec2(0.0);
  const RestTrend line = rest_trend(blocks);
  const double noise = std::hypot(evidence.block_noise, evidence.step_noise);
  if (glm::length(line.slope) * std::sqrt(line.spread) < 5.0 * noise) return vec2(0.0);
  double without = 0.0, with = 0.0;
  for (const RestPoint& part : parts) {
    const vec2 off = part.place - line.mean.place, left = part.place - line.at(part.time_s);
    without += part.weight * glm::dot(off, off);
    with += part.weight * glm::dot(left, left);
  }
  const double blocks_each = static_cast<double>(blocks.size()) / static_cast<double>(parts.size());
  const double part_noise =
      std::hypot(evidence.block_noise, evidence.step_noise * std::sqrt(blocks_each));
  const double freedom = 2.0 * (static_cast<double>(parts.size()) - 2.0);
  if (log_odds(without, with, freedom, part_noise) < kSureOfOne) return vec2(0.0);
  const double seconds = blocks.back().time_s - blocks.front().time_s;
  return is_worth_reporting(evidence, line.slope, seconds, 2.0) ? line.slope : vec2(0.0);
}

vec2 drift_of(const Evidence& evidence) {
  int seen = 0;
  for (const Release& release : evidence.releases) seen += release.from != vec2(0.0);
  const bool has_many = seen - tracks_of(evidence.releases) >= 4;
  return has_many ? drift_across_rests(evidence) : drift_within_rest(evidence);
}

// ---- Centre

struct RestCentre {
  vec2 place{0.0};
  std::vector<bool> counts;  // for each release
};

// Marks the releases that count: those at most 2.5 times as far from the median as three quarters
// of all are. Farther off a thumb may have lain on the stick.
std::vector<bool> usual_releases(std::span<const Release> releases, double noise) {
  std::vector<bool> counts(releases.size(), true);
  if (releases.size() < 4) return counts;
  std::vector<vec2> places;
  for (const Release& release : releases) places.push_back(release.rest.place);
  const vec2 middle = median_of(places);
  std::vector<double> away;
  for (const Release& release : releases) away.push_back(glm::length(release.rest.place - middle));
  std::vector<double> sorted = away;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[(sorted.size() * 3 - 1) / 4];
  const double limit = std::max({2.5 * usual, 6.0 * noise, 0.01});
  for (std::size_t i = 0; i < away.size(); ++i) counts[i] = away[i] <= limit;
  return counts;
}

vec2 mean_of(std::span<const Release> releases, const std::vector<bool>& counts) {
  RestPoint mean;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (counts[i]) add(mean, releases[i].rest);
  }
  return mean.weight > 0.0 ? mean.place / mean.weight : vec2(0.0);
}

// Whether noise alone explains the differences between the rests.
bool is_one_place(std::span<const Release> releases, const std::vector<bool>& counts,
                  const Evidence& evidence) {
  const vec2 mean = mean_of(releases, counts);
  double squares = 0.0, freedom = -2.0;
  const double blocks_each = std::pow(evidence.block_noise / evidence.mean_noise, 2.0);
  const double weight_each = evidence.weight / static_cast<double>(releases.size());
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (!counts[i]) continue;
    const vec2 off = releases[i].rest.place - mean;
    const double blocks = blocks_each * releases[i].rest.weight / weight_each;
    squares += glm::dot(off, off) * blocks / (evidence.block_noise * evidence.block_noise);
    freedom += 2.0;
  }
  return squares <= freedom + 4.0 * std::sqrt(2.0 * std::max(freedom, 1.0));
}

std::vector<vec2> places_of(std::span<const Release> releases, const std::vector<bool>& counts) {
  std::vector<vec2> places;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (counts[i]) places.push_back(releases[i].rest.place);
  }
  return places;
}

// Without hysteresis the mean of all samples is best. With hysteresis the rests lie round the true
// place, but not evenly: if they follow the direction of the release, that effect is removed, else
// the middle of all rests counts.
RestCentre rest_centre_of(std::span<const Release> releases, const Evidence& evidence) {
  RestCentre centre;
  centre.counts = usual_releases(releases, evidence.mean_noise);
  if (is_one_place(releases, centre.counts, evidence)) {
    centre.place = mean_of(releases, centre.counts);
    return centre;
  }
  const ReturnModel with = return_model(releases, Explain::returns, evidence.mean_noise);
  const ReturnModel without = return_model(releases, Explain::centre, evidence.mean_noise);
  const double freedom = 2.0 * (with.used - tracks_of(releases) - 2);
  const bool follows = freedom >= 4.0 && log_odds(without.residual, with.residual, freedom,
                                                  evidence.mean_noise) > 8.0;
  if (!follows) {
    const std::vector<vec2> places = places_of(releases, centre.counts);
    centre.place = middle_of(places);
    return centre;
  }
  centre.place = with.centre;
  // The model has found the odd releases; one of unknown direction counts if it lies no farther out
  // than the others.
  double radius = 0.0;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (with.counts[i]) {
      radius = std::max(radius, glm::length(releases[i].rest.place - centre.place));
    }
  }
  for (std::size_t i = 0; i < releases.size(); ++i) {
    const bool is_within = glm::length(releases[i].rest.place - centre.place) <=
                           1.2 * radius + 4.0 * evidence.mean_noise;
    centre.counts[i] = with.counts[i] || (releases[i].from == vec2(0.0) && is_within);
  }
  return centre;
}

// Whether the stick was moved and let go between two rests: its movement was seen, or the first
// rest's track ends away from it. A stick that rests while the pad is unplugged, or from one
// recording to the next, shows no return.
bool was_let_go(std::span<const StickTrack> tracks, std::span<const Release> releases) noexcept {
  constexpr double kSeenMovement = 0.2;  // raw movement between two rests that counts as seen
  for (std::size_t i = 1; i < releases.size(); ++i) {
    const Release& before = releases[i - 1];
    if (releases[i].from != vec2(0.0)) return true;
    const vec2 off = tracks[before.track].back().raw - before.rest.place;
    if (before.track != releases[i].track && glm::length(off) >= kSeenMovement) return true;
  }
  return false;
}

double hysteresis_of(std::span<const vec2> places, double noise) noexcept {
  const double count = static_cast<double>(places.size());
  const double greatest = greatest_distance(places);
  // The square of the distance that noise alone seldom exceeds between this number of places.
  const double by_noise = 6.0 * noise * noise * (std::log(0.5 * count * (count - 1.0)) + 1.5);
  return std::sqrt(std::max(greatest * greatest - by_noise, 0.0));
}

// ---- Noise

void set_sigma(RestStatistics& to, const Evidence& evidence, const vec2& step) {
  if (evidence.noise.freedom < 10.0) return;
  const vec2 shown = evidence.noise.variance();
  // Rounding adds the variance step^2 / 12.
  const vec2 own = glm::sqrt(glm::max(shown - step * step / 12.0, vec2(0.0)));
  const bool is_x_hidden = own.x < step.x, is_y_hidden = own.y < step.y;
  to.is_sigma_hidden = is_x_hidden || is_y_hidden;
  to.sigma =
      vec2(is_x_hidden ? std::sqrt(shown.x) : own.x, is_y_hidden ? std::sqrt(shown.y) : own.y);
}

// ---- Moving by itself

// sqrt((d^2 - n^2) / (2 * 0.167 s)); d: change over 0.2 s of both axes together; n: the part of it
// that noise and steps explain. Both are medians over the hands-off times, because a thumb may lie
// on the stick in some of them.
double wander_of(std::span<const HandsOff> times, const vec2& drift, const vec2& step) {
  constexpr std::size_t kLag = 2;  // compared blocks are 0.2 s apart
  // A random walk's means over 0.1 s, 0.2 s apart, differ as its values this far apart do.
  constexpr double kLagOfMeans_s = kLag * 0.1 - 0.1 / 3.0;
  constexpr double kFewest = 8.0;  // fewest changes, counted for each axis
  std::vector<double> squares, noises;
  double changes = 0.0;
  for (const HandsOff& time : times) {
    double square = 0.0, noise = 0.0, count = 0.0;
    for (std::size_t k = kLag; k < time.places.size(); ++k) {
      const vec2 moved = time.places[k] - time.places[k - kLag] - drift * (0.1 * kLag);
      square += glm::dot(moved, moved);
      noise += time.variances[k] + time.variances[k - kLag];
      count += 1.0;
    }
    changes += 2.0 * count;
    // A time counts once in the medians for each four changes.
    for (double vote = 0.0; count > 0.0 && vote < count; vote += 4.0) {
      squares.push_back(square / count);
      noises.push_back(noise / count);
    }
  }
  if (changes < kFewest) return 0.0;
  const double square = median(std::move(squares));
  const double noise = median(std::move(noises)) + 0.5 * glm::dot(step, step);
  if (square < noise * (1.0 + 6.0 / std::sqrt(changes))) return 0.0;
  const double wander = std::sqrt((square - noise) / (2.0 * kLagOfMeans_s));
  return wander > 0.004 ? wander : 0.0;
}

// Marks releases after which the stick stood still far from its centre: at least 0.07 (raw; good
// sticks rest nearer) and 1.5 times the median distance.
void add_displaced(RestStatistics& to) {
  constexpr double kFarOff = 0.07, kOfUsual = 1.5, kQuiet = 0.02;
  std::vector<double> away;
  std::vector<HandsOff*> quiet;
  for (HandsOff& time : to.hands_off) {
    if (!time.is_released) continue;
    vec2 least(4.0), most(-4.0), mean(0.0);
    double noise = 0.0;
    for (std::size_t k = 0; k < time.places.size(); ++k) {
      least = glm::min(least, time.places[k]);
      most = glm::max(most, time.places[k]);
      mean += time.places[k] / static_cast<double>(time.places.size());
      noise = std::max(noise, time.variances[k]);
    }
    // The stick moved during this time.
    if (glm::length(most - least) > kQuiet + 5.0 * std::sqrt(noise)) continue;
    away.push_back(glm::length(mean - *to.centre));
    quiet.push_back(&time);
  }
  if (away.size() < 3) return;
  const double usual = median(away);
  for (std::size_t k = 0; k < away.size(); ++k) {
    if (away[k] < std::max(kFarOff, kOfUsual * usual)) continue;
    quiet[k]->is_displaced = true;
    ++to.displaced;
    to.displaced_by = std::max(to.displaced_by, away[k]);
  }
}

}  // namespace

double seconds_of(std::span<const HandsOff> times) noexcept {
  double blocks = 0.0;
  for (const HandsOff& time : times) blocks += static_cast<double>(time.places.size());
  return 0.1 * blocks;
}

RestStatistics rest_statistics(std::span<const StickTrack> tracks, const vec2& step,
                               double interval_s) {
  Stills found = stills(tracks, step, interval_s);
  const std::span<const Still> rests = found.rests;
  RestStatistics result;
  result.hands_off = std::move(found.hands_off);
  for (const Still& push : found.pushes) result.pushes.push_back(push.mean);
  if (rests.empty()) {
    // The stick never stood still: the centre is the median of its places while it moved by itself.
    std::vector<vec2> places;
    for (const HandsOff& time : result.hands_off)
      places.insert(places.end(), time.places.begin(), time.places.end());
    result.wander = wander_of(result.hands_off, vec2(0.0), step);
    if (result.wander > 0.0) result.centre = median_of(places);
    return result;
  }
  const Evidence evidence = evidence_of(tracks, rests, step, interval_s);
  for (const Release& release : evidence.releases) {
    for (const Still& still : release.stills) {
      result.rest_samples += static_cast<std::int64_t>(still.last - still.first + 1);
    }
  }
  result.rest_s = evidence.seconds;
  if (evidence.weight < kFewestRestReports) return result;
  result.drift = drift_of(evidence);
  if (result.rest_s >= kShortestForDrift_s) result.drift_per_s = glm::length(result.drift);
  std::vector<Release> steady = evidence.releases;
  for (Release& release : steady) release.rest.place -= result.drift * release.rest.time_s;
  const RestCentre centre = rest_centre_of(steady, evidence);
  result.centre = centre.place;
  result.rests = places_of(steady, centre.counts);
  if (result.rests.size() >= 2 && was_let_go(tracks, evidence.releases)) {
    result.hysteresis = hysteresis_of(result.rests, evidence.mean_noise);
  }
  set_sigma(result, evidence, step);
  result.wander = wander_of(result.hands_off, result.drift, step);
  add_displaced(result);
  return result;
}

}  // namespace gaitpad
