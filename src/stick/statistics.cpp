#include "stick/statistics.h"

#include <algorithm>
#include <cmath>

#include "stick/clean_track.h"
#include "stick/report_statistics.h"
#include "stick/rest_statistics.h"

namespace gaitpad {
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
