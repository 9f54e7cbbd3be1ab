#include "stick/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stick/rests.h"
#include "stick/stick_track.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMostIntervals = std::size_t{1} << 20;  // as many say what all would
constexpr std::size_t kFewestIntervals = 20;
constexpr double kSilence_s = 0.1;
constexpr double kBurst_s = 0.0007;  // pads send 1000 reports a second at most, but for a few
constexpr double kUnknownInterval_s = 0.004;
constexpr double kFrozen_s = 0.06;

// Of reports that follow each other; those during movements, if there are enough of them: every pad
// reports each of those.
std::vector<double> intervals(std::span<const StickTrack> tracks) {
  std::vector<double> all, moving;
  for (const StickTrack& track : tracks) {
    std::size_t back = 0;  // 50 ms ago
    for (std::size_t i = 1; i < track.size() && all.size() < kMostIntervals; ++i) {
      const double interval_s = seconds_between(track[i - 1].time_ns, track[i].time_ns);
      while (seconds_between(track[back].time_ns, track[i - 1].time_ns) > 0.05) ++back;
      if (interval_s < 0.0 || interval_s > kSilence_s) continue;
      all.push_back(interval_s);
      if (glm::length(track[i - 1].raw - track[back].raw) > 0.05) moving.push_back(interval_s);
    }
  }
  return moving.size() >= 2 * kFewestIntervals ? moving : all;
}

struct Spacing {
  double mean_s = 0.0, deviation_s = 0.0;
};

Spacing spacing_within(std::span<const double> intervals, double least_s, double most_s) noexcept {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const double interval : intervals) {
    if (interval < least_s || interval > most_s) continue;
    sum += interval;
    squares += interval * interval;
    count += 1.0;
  }
  if (count == 0.0) return {};
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0))};
}

std::optional<Spacing> spacing(std::span<const StickTrack> tracks) {
  std::vector<double> found = intervals(tracks);
  if (found.size() < kFewestIntervals) return {};
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  const double median = *middle;
  const Spacing all = spacing_within(found, 0.0, kSilence_s);
  // Where most reports come in bursts, the time between bursts belongs to the pace.
  if (median < kBurst_s && all.mean_s > 2.0 * median) return all;
  const double mean_s = spacing_within(found, 0.5 * median, 1.5 * median).mean_s;
  if (!(mean_s > 0.0)) return {};
  return Spacing{mean_s, spacing_within(found, 0.0, 1.5 * mean_s).deviation_s};
}

// Reports lost, not late: five intervals together are longer by half a one as well.
std::int64_t gaps_of(const StickTrack& track, double interval_s) noexcept {
  std::int64_t gaps = 0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    if (seconds_between(track[i - 1].time_ns, track[i].time_ns) <= 1.5 * interval_s) continue;
    const std::size_t first = i >= 3 ? i - 3 : 0, last = std::min(i + 2, track.size() - 1);
    const double together_s = seconds_between(track[first].time_ns, track[last].time_ns);
    if (together_s > (static_cast<double>(last - first) + 0.5) * interval_s) ++gaps;
  }
  return gaps;
}

bool reports_at_rest(std::span<const StickTrack> tracks, double interval_s,
                     double repeats_expected) noexcept {
  double count = 0.0, repeats = 0.0, all_s = 0.0, silent_s = 0.0;
  for (const StickTrack& track : tracks) {
    for (std::size_t i = 1; i < track.size(); ++i) {
      const double pause_s = seconds_between(track[i - 1].time_ns, track[i].time_ns);
      count += 1.0;
      all_s += pause_s;
      if (pause_s > std::max(kSilence_s, 5.0 * interval_s)) silent_s += pause_s;
      if (pause_s <= 1.5 * interval_s && track[i].raw == track[i - 1].raw) repeats += 1.0;
    }
  }
  return silent_s <= 0.2 * all_s && repeats >= std::max(0.25 * repeats_expected * count, 1.0);
}

double value_of(const StickSample& sample, int axis) noexcept {
  return axis == 0 ? sample.raw.x : sample.raw.y;
}

// Least first, equal ones once.
std::vector<double> distinct_values(std::span<const StickTrack> tracks, int axis) {
  constexpr std::size_t kMost = std::size_t{1} << 18;
  std::size_t all = 0;
  for (const StickTrack& track : tracks) all += track.size();
  const std::size_t stride = all / kMost + 1;
  std::vector<double> values;
  for (const StickTrack& track : tracks) {
    for (std::size_t i = 0; i < track.size(); i += stride) {
      values.push_back(value_of(track[i], axis));
    }
  }
  std::sort(values.begin(), values.end());
  constexpr double kRounding = 1e-6;  // axes are decoded to floats
  const auto end = std::unique(values.begin(), values.end(),
                               [](double a, double b) { return b - a <= kRounding; });
  values.erase(end, values.end());
  return values;
}

// Frozen from `first` to `last`, then on in the same direction by a jump.
bool jumps_on(const StickTrack& track, std::size_t first, std::size_t last) noexcept {
  if (first == 0 || last + 1 >= track.size()) return false;
  const vec2 before = track[first].raw - track[first - 1].raw;
  const vec2 after = track[last + 1].raw - track[last].raw;
  const double b = glm::length(before), a = glm::length(after);
  // A thumb that pauses comes to it slowly and starts slowly.
  return b > 0.01 && a > std::max(0.1, 3.0 * b) && glm::dot(before, after) > 0.7 * a * b;
}

// Counts turns either way; who turns back begins anew.
struct Turning {
  int turns = 0;
  double turned = 0.0, farthest = 0.0;  // of one turn, since it began
  void add(double angle) noexcept {
    turned += angle;
    if (std::fabs(turned) > std::fabs(farthest) && turned * farthest >= 0.0) farthest = turned;
    if (std::fabs(turned - farthest) <= 0.25) return;
    const double back = turned - farthest;
    end();
    turned = farthest = back;
  }
  void end() noexcept {
    // A turn that somebody ends a little early is meant as one.
    turns += static_cast<int>(std::min(std::fabs(farthest) + 0.05, 1e6));
    turned = farthest = 0.0;
  }
};

}  // namespace

double typical_interval_s(std::span<const StickTrack> tracks) {
  const std::optional<Spacing> found = spacing(tracks);
  return found ? found->mean_s : kUnknownInterval_s;
}

ReportTiming report_timing(std::span<const StickTrack> tracks, double repeats_expected) {
  ReportTiming timing;
  const std::optional<Spacing> found = spacing(tracks);
  if (!found) return timing;
  timing.rate_hz = 1.0 / found->mean_s;
  timing.jitter_ms = 1e3 * found->deviation_s;
  if (!reports_at_rest(tracks, found->mean_s, repeats_expected)) return timing;
  timing.gaps = 0;
  for (const StickTrack& track : tracks) *timing.gaps += gaps_of(track, found->mean_s);
  return timing;
}

double quantisation_step(std::span<const StickTrack> tracks, int axis, double declared) {
  const std::vector<double> values = distinct_values(tracks, axis);
  double least = 4.0;
  for (std::size_t i = 1; i < values.size(); ++i)
    least = std::min(least, values[i] - values[i - 1]);
  // Values without steps come as near to each other as one pleases, but seldom, and at no
  // multiples.
  int ones = 0, few = 0, whole = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double steps = (values[i] - values[i - 1]) / least;
    if (steps > 8.5) continue;
    ++few;
    ones += steps < 1.2;
    whole += std::fabs(steps - std::round(steps)) < 0.15;
  }
  const bool is_step = least < 0.5 && ones >= 3 && 5 * whole >= 4 * few;
  return is_step ? least : declared;
}

std::int64_t stuck_values(std::span<const StickTrack> tracks, double interval_s) {
  std::int64_t stuck = 0;
  for (const StickTrack& track : tracks) {
    for (std::size_t first = 0, last; first < track.size(); first = last + 1) {
      last = first;
      while (last + 1 < track.size() && track[last + 1].raw == track[first].raw) ++last;
      const double frozen_s =
          seconds_between(track[first].time_ns, track[last].time_ns) + interval_s;
      if (last > first && frozen_s >= kFrozen_s && jumps_on(track, first, last)) ++stuck;
    }
  }
  return stuck;
}

int whole_turns(std::span<const StickTrack> tracks, const vec2& middle, double radius) {
  constexpr int kStray = 3;  // reports that may be spikes
  Turning turning;
  for (const StickTrack& track : tracks) {
    vec2 before(0.0);  // 0: inside
    int strays = 0;
    for (const StickSample& sample : track) {
      const vec2 p = sample.raw - middle;
      const bool is_out = glm::length(p) > radius;
      const double angle =
          atan2(before.x * p.y - before.y * p.x, glm::dot(before, p)) / (2.0 * kPi);
      const bool is_stray = before != vec2(0.0) && (!is_out || std::fabs(angle) > 0.2);
      if (is_stray && ++strays <= kStray) continue;
      strays = 0;
      if (is_out && before != vec2(0.0)) turning.add(angle);
      if (!is_out) turning.end();
      before = is_out ? p : vec2(0.0);
    }
    turning.end();
  }
  return turning.turns;
}

namespace {

// Of one more report being the same as the one before, by noise and steps alone.
double repeats_expected(const StickStatistics& s) noexcept {
  if (!s.sigma) return 0.0;
  const auto chance = [](double sigma, double step) {
    return sigma > 0.0 ? std::min(step / (2.0 * std::sqrt(kPi) * sigma), 1.0) : 1.0;
  };
  return chance(s.sigma->x, s.step_x) * chance(s.sigma->y, s.step_y);
}

void tell_rest(StickStatistics& to, RestStatistics&& rest) {
  to.rest_samples = rest.samples;
  to.rest_s = rest.seconds;
  to.rests = std::move(rest.rests);
  to.centre = rest.centre;
  to.sigma = rest.sigma;
  to.is_sigma_hidden = rest.is_sigma_hidden;
  to.hysteresis = rest.hysteresis;
  to.drift_per_s = rest.drift_per_s;
  to.drift = rest.drift;
  to.wander = rest.wander;
}

struct Extent {
  vec2 least{4.0}, most{-4.0};
};
Extent extent_of(std::span<const StickTrack> tracks) {
  Extent extent;
  for (const StickTrack& track : tracks) {
    for (const StickSample& sample : track) {
      extent.least = glm::min(extent.least, sample.raw);
      extent.most = glm::max(extent.most, sample.raw);
    }
  }
  return extent;
}

void tell_rim(StickStatistics& to, std::span<const StickTrack> tracks, const Extent& extent) {
  const vec2 middle = to.centre.value_or(vec2(0.0));
  const vec2 sigma = to.sigma.value_or(vec2(0.0));
  to.outline = outline_of(tracks, middle, std::max(sigma.x, sigma.y));
  const Reach reach = reach_of(to.outline);
  // A corner that was put together from its two edges goes no farther than the stick was seen.
  if (reach.min_x) to.min_x = std::max(*reach.min_x, extent.least.x);
  if (reach.max_x) to.max_x = std::min(*reach.max_x, extent.most.x);
  if (reach.min_y) to.min_y = std::max(*reach.min_y, extent.least.y);
  if (reach.max_y) to.max_y = std::min(*reach.max_y, extent.most.y);
  to.circularity_error = circularity_error(to.outline);
  to.rim_samples = to.outline.samples;
}

int turns_of(const StickStatistics& s, std::span<const StickTrack> tracks, const Extent& extent) {
  const auto& [least, most] = extent;
  const vec2 middle = s.centre.value_or(0.5 * (least + most));
  const vec2 reach = glm::min(most - middle, middle - least);
  const double radius = 0.5 * std::min(reach.x, reach.y);
  return radius > 0.1 ? whole_turns(tracks, middle, radius) : 0;
}

}  // namespace

StickStatistics stick_statistics(std::span<const StickTrack> tracks, const vec2& declared_step) {
  StickStatistics told;
  for (const StickTrack& track : tracks) told.samples += static_cast<std::int64_t>(track.size());
  const CleanTracks clean = clean_tracks(tracks);
  told.jumps = clean.jumps;
  told.step_x = quantisation_step(clean.tracks, 0, declared_step.x);
  told.step_y = quantisation_step(clean.tracks, 1, declared_step.y);
  const double interval_s = typical_interval_s(clean.tracks);
  const std::vector<Still> rests = stills(clean.tracks, declared_step).rests;
  tell_rest(told, rest_statistics(clean.tracks, rests, {told.step_x, told.step_y}, interval_s));
  const Extent extent = extent_of(clean.tracks);
  tell_rim(told, clean.tracks, extent);
  told.turns = turns_of(told, clean.tracks, extent);
  // As they came: where a spike is taken out a value repeats.
  const ReportTiming timing = report_timing(tracks, repeats_expected(told));
  told.rate_hz = timing.rate_hz;
  told.jitter_ms = timing.jitter_ms;
  told.gaps = timing.gaps;
  told.stuck = stuck_values(clean.tracks, interval_s);
  return told;
}

namespace {

struct Held {
  double raw = 0.0, seconds = 0.0;
};

// Each value with the time that it stood, least first.
std::vector<Held> values_of(std::span<const TriggerTrack> tracks) {
  std::vector<Held> values;
  for (const TriggerTrack& track : tracks) {
    for (std::size_t i = 0; i < track.size(); ++i) {
      if (!(std::fabs(track[i].raw) <= 4.0)) continue;
      const double seconds =
          i + 1 < track.size() ? seconds_between(track[i].time_ns, track[i + 1].time_ns) : 0.0;
      // Each report counts a little, whatever its stamp says.
      values.push_back({track[i].raw, std::clamp(seconds, 1e-3, kMaxHold_s)});
    }
  }
  std::sort(values.begin(), values.end(),
            [](const Held& a, const Held& b) { return a.raw < b.raw; });
  return values;
}

// Median by time of the values from `least` to `most`; none where there is no such value.
std::optional<double> median_within(std::span<const Held> values, double least, double most) {
  double all = 0.0, seen = 0.0;
  for (const Held& value : values) {
    if (value.raw >= least && value.raw <= most) all += value.seconds;
  }
  for (const Held& value : values) {
    if (value.raw < least || value.raw > most) continue;
    seen += value.seconds;
    if (seen >= 0.5 * all) return value.raw;
  }
  return {};
}

}  // namespace

TriggerStatistics trigger_statistics(std::span<const TriggerTrack> tracks) {
  constexpr double kNear = 0.15;  // of an end
  TriggerStatistics told;
  for (const TriggerTrack& track : tracks) told.samples += static_cast<std::int64_t>(track.size());
  const std::vector<Held> values = values_of(tracks);
  if (values.empty()) return told;
  // A report or two at either end may be spikes.
  const std::size_t odd = std::min<std::size_t>(values.size() / 100, 3);
  const double low = values[odd].raw, high = values[values.size() - 1 - odd].raw;
  if (low < 0.5) told.released = median_within(values, low - 1.0, low + kNear);
  if (high > 0.5 && high - low > 0.25) {
    told.pressed = median_within(values, high - kNear / 3.0, high + 1.0);
  }
  return told;
}

}  // namespace gaitpad
