#include "stick/clean_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace gaitpad {
namespace {

constexpr double kSmallestSpike = 0.03;  // raw; less is noise
constexpr double kLongestSpike_s =
    0.04;                          // of two or three reports; a hand's there and back is longer
constexpr double kFarthest = 4.0;  // raw; nothing lies farther out, whoever made the track
constexpr std::int64_t kLatest_ns = 4'000'000'000'000'000'000;  // sums of times fit

bool is_place(const vec2& p) noexcept {
  return std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest;  // false for not-a-number
}

StickTrack sound_track(const StickTrack& track) {
  StickTrack sound = track;
  const auto first = std::find_if(track.begin(), track.end(),
                                  [](const StickSample& sample) { return is_place(sample.raw); });
  if (first == track.end()) return {};
  vec2 place = first->raw;
  std::int64_t time_ns = -kLatest_ns;
  for (StickSample& sample : sound) {
    place = sample.raw = is_place(sample.raw) ? sample.raw : place;
    time_ns = sample.time_ns = std::clamp(sample.time_ns, time_ns, kLatest_ns);
  }
  return sound;
}

double step_length(const StickTrack& track, std::size_t i) noexcept {  // from i - 1 to i
  return glm::length(track[i].raw - track[i - 1].raw);
}

// Median length of the steps around, those into and out of i .. i + length - 1 left out. Hands move
// several reports long, so the neighbourhood of a real movement has long steps too.
double steps_around(const StickTrack& track, std::size_t i, std::size_t length) {
  std::array<double, 8> steps{};
  std::size_t count = 0;
  for (std::size_t k = 1; k <= 4 && i >= k + 1; ++k) steps[count++] = step_length(track, i - k);
  for (std::size_t k = 1; k <= 4 && i + length + k < track.size(); ++k) {
    steps[count++] = step_length(track, i + length + k);
  }
  if (count == 0) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + count / 2, steps.begin() + count);
  return steps[count / 2];
}

// A spike has sharp edges on both sides and comes back to about where it left.
bool is_spike(const StickTrack& track, std::size_t i, std::size_t length) {
  const vec2& before = track[i - 1].raw;
  const vec2& after = track[i + length].raw;
  double least = 2.0 * kFarthest;
  for (std::size_t k = i; k < i + length; ++k) {
    least =
        std::min({least, glm::length(track[k].raw - before), glm::length(track[k].raw - after)});
  }
  if (least < kSmallestSpike || least < 2.0 * glm::length(after - before)) return false;
  if (length > 1 &&
      seconds_between(track[i].time_ns, track[i + length].time_ns) > kLongestSpike_s) {
    return false;
  }
  if (i >= 2 && least < 3.0 * step_length(track, i - 1)) return false;
  if (i + length + 1 < track.size() && least < 3.0 * step_length(track, i + length + 1))
    return false;
  return least > 6.0 * steps_around(track, i, length);
}

// 0 where none begins at i.
std::size_t spike_length(const StickTrack& track, std::size_t i) {
  if (step_length(track, i) < kSmallestSpike) return 0;
  for (std::size_t length = 1; length <= 3 && i + length < track.size(); ++length) {
    if (is_spike(track, i, length)) return length;
  }
  return 0;
}

std::int64_t take_spikes_out(StickTrack& track) {
  std::int64_t spikes = 0;
  for (std::size_t i = 1; i + 1 < track.size(); ++i) {
    const std::size_t length = spike_length(track, i);
    if (length == 0) continue;
    for (std::size_t k = i; k < i + length; ++k) track[k].raw = track[i - 1].raw;
    ++spikes;
    i += length - 1;
  }
  return spikes;
}

}  // namespace

CleanTracks clean_tracks(std::span<const StickTrack> tracks) {
  CleanTracks clean;
  clean.tracks.reserve(tracks.size());
  for (const StickTrack& track : tracks) {
    clean.tracks.push_back(sound_track(track));
    // One that stands beside another is seen only once that is out of the way.
    for (int pass = 0; pass < 3; ++pass) {
      const std::int64_t spikes = take_spikes_out(clean.tracks.back());
      clean.jumps += spikes;
      if (spikes == 0) break;
    }
  }
  return clean;
}

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  if (to_ns < from_ns) return -seconds_between(to_ns, from_ns);
  return 1e-9 * static_cast<double>(static_cast<std::uint64_t>(to_ns) -
                                    static_cast<std::uint64_t>(from_ns));
}

double hold_s(const StickTrack& track, std::size_t i, double interval_s) noexcept {
  if (i + 1 >= track.size()) return interval_s;
  return std::min(seconds_between(track[i].time_ns, track[i + 1].time_ns), kMaxHold_s);
}

double reports_stood(double hold_s, double interval_s) noexcept {
  return hold_s <= 1.5 * interval_s ? 1.0 : hold_s / interval_s;
}

}  // namespace gaitpad
