#include "stick/releases.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "stick/clean_track.h"

namespace gaitpad {
namespace {

constexpr double kSamePlace = 0.02;
constexpr double kOdd = 0.005;          // raw; what is less far off does no harm
constexpr std::size_t kMostTried = 64;  // releases, one by one left out

// The way from one rest to the next: how far it led, from where it came back. Both 0 where the
// stick hardly moved, or only for a report or two.
struct Excursion {
  double farthest = 0.0;
  vec2 from{0.0};
};

Excursion excursion(const StickTrack& track, std::size_t first, const Still& to,
                    double interval_s) noexcept {
  constexpr double kFewestReports = 4.0;
  Excursion way;
  double away = 0.0;  // reports
  for (std::size_t i = first; i < to.first; ++i) {
    const double distance = glm::length(track[i].raw - to.mean);
    if (distance < kReleaseMovement) continue;
    away += reports_stood(hold_s(track, i, interval_s), interval_s);
    way.farthest = std::max(way.farthest, distance);
  }
  if (away < kFewestReports) return {};
  // The spring brings it back in a straight line, but may swing over: the side is where it was last
  // half way out.
  for (std::size_t i = to.first; i > first; --i) {
    const vec2 off = track[i - 1].raw - to.mean;
    if (glm::length(off) < 0.5 * way.farthest) continue;
    way.from = glm::normalize(off);
    break;
  }
  return way;
}

// The longest of the stills and those at its place.
Release release_of(std::span<const StickTrack> tracks, std::span<const Still> stills,
                   double interval_s) {
  const Still& longest =
      *std::max_element(stills.begin(), stills.end(),
                        [](const Still& a, const Still& b) { return a.duration_s < b.duration_s; });
  Release release{.stills = {}, .track = longest.track, .rest = {}};
  for (const Still& still : stills) {
    if (glm::length(still.mean - longest.mean) > kSamePlace) continue;
    release.stills.push_back(still);
    for (const RestPoint& point : rest_points(tracks, still, interval_s)) {
      release.rest.weight += point.weight;
      release.rest.time_s += point.weight * point.time_s;
      release.rest.place += point.weight * point.place;
    }
  }
  release.rest.time_s /= release.rest.weight;
  release.rest.place /= release.rest.weight;
  return release;
}

// ---- explaining the places ----

// One release with what may explain its place, without the means of its track.
struct Row {
  std::array<double, 3> cause{};  // from.x, from.y, time
  vec2 place{0.0};
};

struct Solution {
  std::array<vec2, 3> effect{};
  double residual = 0.0;
  double spread_s2 = 0.0;
};

// Least squares of both axes on the causes that are asked for; a trace of ridge where they hardly
// differ.
Solution solved(std::span<const Row> rows, std::size_t first, std::size_t last) {
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

// Releases of a track stand beside each other.
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

Solution solved(std::span<const Release> releases, const std::vector<bool>& counts,
                Explain explain) {
  const std::vector<Row> rows = centred_rows(releases, counts);
  const std::size_t first = explain == Explain::home ? 2 : 0;
  return solved(rows, first, explain == Explain::returns_and_drift ? 3 : 2);
}

int count_of(const std::vector<bool>& counts) {
  return static_cast<int>(std::count(counts.begin(), counts.end(), true));
}

// Leaves out the release without which the others agree best, if that is a great deal better.
bool leave_odd_out(std::span<const Release> releases, Explain explain, double noise,
                   std::vector<bool>& counts) {
  const double before = solved(releases, counts, explain).residual;
  const double freedom = 2.0 * (count_of(counts) - 5);
  if (freedom < 4.0) return false;
  double best = before;
  std::size_t odd = 0;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (!counts[i]) continue;
    counts[i] = false;
    const double without = solved(releases, counts, explain).residual;
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

}  // namespace

std::vector<Release> releases_of(std::span<const StickTrack> tracks, std::span<const Still> rests,
                                 double interval_s) {
  const auto way_to = [&](std::size_t k) {
    const bool is_first = k == 0 || rests[k - 1].track != rests[k].track;
    return excursion(tracks[rests[k].track], is_first ? 0 : rests[k - 1].last + 1, rests[k],
                     interval_s);
  };
  std::vector<Release> releases;
  for (std::size_t first = 0, end; first < rests.size(); first = end) {
    end = first + 1;
    while (end < rests.size() && rests[end].track == rests[first].track &&
           way_to(end).from == vec2(0.0)) {
      ++end;
    }
    releases.push_back(release_of(tracks, rests.subspan(first, end - first), interval_s));
    releases.back().from = way_to(first).from;
  }
  return releases;
}

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
  const Solution solution = solved(releases, model.counts, explain);
  model.used = count_of(model.counts);
  model.residual = solution.residual;
  model.drift = solution.effect[2];
  model.spread_s2 = solution.spread_s2;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (!model.counts[i]) continue;
    const Row row = row_of(releases[i]);
    model.home += row.place;
    for (std::size_t k = 0; k < 3; ++k) model.home -= row.cause[k] * solution.effect[k];
  }
  if (model.used > 0) model.home /= static_cast<double>(model.used);
  return model;
}

vec2 middle_of(std::span<const vec2> places) noexcept {
  if (places.empty()) return vec2(0.0);
  vec2 middle(0.0);
  for (const vec2& place : places) middle += place / static_cast<double>(places.size());
  // Badoiu and Clarkson: a step towards the farthest, ever smaller; 1 / steps of the radius is
  // left.
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

}  // namespace gaitpad
