#include "stick/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gaitpad {

namespace {

// For each axis, the chance that a report at rest repeats the one before it, by noise and steps
// alone: step / (2 sqrt(pi) sigma), at most 1; 1 if the noise is not known.
vec2 repeats_expected(const StickStatistics& s) noexcept {
  if (!s.sigma) return vec2(1.0);
  const auto chance = [](double sigma, double step) {
    return sigma > 1e-6 ? std::min(step / (2.0 * std::sqrt(kPi) * sigma), 1.0) : 1.0;
  };
  return {chance(s.sigma->x, s.step_x), chance(s.sigma->y, s.step_y)};
}

void add_rim(StickStatistics& to, std::span<const StickTrack> tracks, const Extent& extent) {
  const vec2 middle = to.centre.value_or(vec2(0.0));
  const vec2 sigma = to.sigma.value_or(vec2(0.0));
  to.outline = outline_of(tracks, middle, std::max(sigma.x, sigma.y));
  const Reach reach = reach_of(to.outline);
  // The outline extrapolates corners from their two sides; the reach ends at the farthest sample.
  if (reach.min_x) to.min_x = std::max(*reach.min_x, extent.least.x);
  if (reach.max_x) to.max_x = std::min(*reach.max_x, extent.most.x);
  if (reach.min_y) to.min_y = std::max(*reach.min_y, extent.least.y);
  if (reach.max_y) to.max_y = std::min(*reach.max_y, extent.most.y);
  to.circularity_error = circularity_error(to.outline);
  // A stick that wanders may have moved between its turn and its pushes: they cannot be compared.
  constexpr double kWanders = 0.02;
  if (to.wander < kWanders) to.unpressed = unpressed_direction(to.outline, to.pushes);
  to.rim_samples = to.outline.samples;
}

int turns_of(const StickStatistics& s, std::span<const StickTrack> tracks, const Extent& extent) {
  const auto& [least, most] = extent;
  const vec2 middle = s.centre.value_or(extent.middle());
  const vec2 reach = glm::min(most - middle, middle - least);
  const double radius = 0.5 * std::min(reach.x, reach.y);
  return radius > 0.1 ? whole_turns(tracks, middle, radius) : 0;
}

}  // namespace

StickStatistics stick_statistics(std::span<const StickTrack> tracks, const vec2& declared_step) {
  StickStatistics result;
  for (const StickTrack& track : tracks) result.samples += static_cast<std::int64_t>(track.size());
  const CleanTracks clean = clean_tracks(tracks);
  result.jump_count = clean.jump_count;
  result.long_jump_count = clean.long_jump_count;
  result.drop_out_count = clean.drop_out_count;
  result.drop_out_s = clean.drop_out_s;
  result.step_x = quantisation_step(clean.tracks, 0, declared_step.x);
  result.step_y = quantisation_step(clean.tracks, 1, declared_step.y);
  const double interval_s = typical_interval_s(clean.tracks);
  static_cast<RestStatistics&>(result) =
      rest_statistics(clean.tracks, {result.step_x, result.step_y}, interval_s);
  const Extent extent = extent_of(clean.tracks);
  add_rim(result, clean.tracks, extent);
  result.turns = turns_of(result, clean.tracks, extent);
  const vec2 repeats = repeats_expected(result);
  // Measured on the tracks as they came: a removed spike would be a repeated value.
  const ReportTiming timing = report_timing(tracks, result.sigma ? repeats.x * repeats.y : 0.0);
  result.rate_hz = timing.rate_hz;
  result.jitter_ms = timing.jitter_ms;
  NewValueCount new_values;
  for (const StickTrack& track : tracks)
    for (const StickSample& sample : track) new_values.take(sample.time_ns, sample.raw, vec2(0.0));
  result.moving = new_values.rate();
  result.gap_count = timing.gap_count;
  result.stuck_count =
      stuck_values(clean.tracks, interval_s, result.is_sigma_hidden ? vec2(1.0) : repeats);
  return result;
}

namespace {

struct Held {
  double raw = 0.0, seconds = 0.0;
};

// Each value with the time for which it stood, ascending.
std::vector<Held> values_of(std::span<const TriggerTrack> tracks) {
  std::vector<Held> values;
  for (const TriggerTrack& track : tracks) {
    for (std::size_t i = 0; i < track.size(); ++i) {
      if (!(std::fabs(track[i].raw) <= 4.0)) continue;
      const double seconds =
          i + 1 < track.size() ? seconds_between(track[i].time_ns, track[i + 1].time_ns) : 0.0;
      // Each report counts for at least a millisecond, whatever its stamp says.
      values.push_back({track[i].raw, std::clamp(seconds, 1e-3, kMaxHold_s)});
    }
  }
  std::sort(values.begin(), values.end(),
            [](const Held& a, const Held& b) { return a.raw < b.raw; });
  return values;
}

// Median by time of the values from `least` to `most`; none if there is no such value.
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
  constexpr double kNear = 0.15;  // distance from an end, raw, that counts as near
  TriggerStatistics result;
  for (const TriggerTrack& track : tracks)
    result.samples += static_cast<std::int64_t>(track.size());
  const std::vector<Held> values = values_of(tracks);
  if (values.empty()) return result;
  // Up to three reports at either end may be spikes.
  const std::size_t odd = std::min<std::size_t>(values.size() / 100, 3);
  const double low = values[odd].raw, high = values[values.size() - 1 - odd].raw;
  if (low < 0.5) result.released = median_within(values, low - 1.0, low + kNear);
  if (high > 0.5 && high - low > 0.25) {
    result.pressed = median_within(values, high - kNear / 3.0, high + 1.0);
  }
  return result;
}

}  // namespace gaitpad
