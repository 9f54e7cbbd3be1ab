#include "stick/rest_statistics.h"

#include <algorithm>
#include <cmath>

#include "stick/clean_track.h"
#include "stick/releases.h"
#include "stick/rest_noise.h"

namespace gaitpad {
namespace {

constexpr double kBlock_s = 0.1;
constexpr double kFewestReports = 5.0;
constexpr double kSettling_s = 1.0;  // some sticks creep home
constexpr double kShortestForDrift_s = 0.5;
constexpr double kSlowestDrift_per_s = 0.0005;

// All that the rests show, before anything is concluded.
struct Evidence {
  std::vector<Release> releases;
  RestNoise noise;
  double mean_noise = 0.0;   // standard deviation of a release's mean, one axis
  double block_noise = 0.0;  // of a block's mean
  double white_noise = 0.0;  // the same, if all noise were white
  double seconds = 0.0, longest_s = 0.0;
  double weight = 0.0;                         // reports
  std::vector<std::vector<RestPoint>> blocks;  // by still, of weight 1
  std::vector<RestPoint> settled;              // blocks of the longest, some time after a release
  double step = 0.0;
  double step_noise = 0.0;  // of a mean by rounding, where no noise takes it away
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
  // A code that does not flip says only that the place is within a step.
  evidence.block_noise = std::max({evidence.white_noise, measured, 0.02 * evidence.step, 1e-7});
  const double blocks_each = blocks / static_cast<double>(evidence.releases.size());
  evidence.mean_noise = evidence.block_noise / std::sqrt(blocks_each);
  return evidence;
}

// ---- drift ----

// How much likelier the rests are with a trend than without, as a logarithm. Sixteen are one in ten
// million, and few patterns of chance or of the hand's habits look so much like a line. Where noise
// explains all that the trend leaves, the noise is the measure, else what it leaves.
constexpr double kSure = 16.0, kSureOfOne = 12.0;
double log_odds(double without, double with, double freedom, double noise) noexcept {
  const double variance = noise * noise;
  const double by_what_is_left =
      0.5 * freedom * std::log((without + freedom * variance) / (with + freedom * variance));
  if (with > variance * (freedom + 3.0 * std::sqrt(2.0 * freedom))) return by_what_is_left;
  return std::max(by_what_is_left, 0.5 * (without - with) / variance);
}

bool is_worth_telling(const Evidence& evidence, const vec2& drift, double seconds, double steps) {
  const double speed = glm::length(drift);
  const double noise = std::sqrt(0.5 * (evidence.noise.variance().x + evidence.noise.variance().y) /
                                 std::max(evidence.weight, 1.0));
  return speed >= kSlowestDrift_per_s &&
         speed * seconds >= std::max(steps * evidence.step, 2.0 * noise);
}

struct Within {
  vec2 drift{0.0};
  double error = 0.0;  // one standard deviation, one axis; infinite where rests are too short
};

// The trend that single rests show; where they stand to each other does not matter.
Within within_rests(const Evidence& evidence) {
  Within within;
  double spread = 0.0;
  for (const std::vector<RestPoint>& still : evidence.blocks) {
    const RestTrend line = rest_trend(still);
    within.drift += line.spread * line.slope;
    spread += line.spread;
  }
  if (spread > 0.0) within.drift /= spread;
  const double noise = std::hypot(evidence.block_noise, evidence.step_noise);
  within.error = noise / std::sqrt(std::max(spread, 1e-12));
  return within;
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

// Rests after rests that lie farther and farther to one side, more than the directions from which
// the stick was let go explain.
vec2 drift_across_rests(const Evidence& evidence) {
  const auto& releases = evidence.releases;
  const ReturnModel with = return_model(releases, Explain::returns_and_drift, evidence.mean_noise);
  const ReturnModel without = return_model(releases, Explain::returns, evidence.mean_noise);
  const double freedom = 2.0 * (with.used - tracks_of(releases) - 3);
  if (freedom < 2.0) return vec2(0.0);
  const double odds = log_odds(without.residual, with.residual, freedom, evidence.mean_noise);
  const double error = evidence.mean_noise / std::sqrt(std::max(with.spread_s2, 1e-12));
  if (odds < kSure || glm::length(with.drift) < 6.0 * error) return vec2(0.0);
  // A stick that drifts does so while one looks, too.
  const Within within = within_rests(evidence);
  const double apart = glm::length(with.drift - within.drift);
  if (apart > 6.0 * within.error && apart > 0.7 * glm::length(with.drift)) return vec2(0.0);
  if (!is_worth_telling(evidence, with.drift, time_range_s(releases), 1.0)) return vec2(0.0);
  return with.drift;
}

// Few rests: the longest of them must show a line over eight parts, in its second half as in the
// whole, since settling ends.
vec2 drift_within_rest(const Evidence& evidence) {
  const std::span<const RestPoint> blocks = evidence.settled;
  const std::vector<RestPoint> parts = rest_blocks(blocks, 8);
  if (parts.size() < 5) return vec2(0.0);
  const RestTrend line = rest_trend(blocks);
  const RestTrend late = rest_trend(blocks.subspan(blocks.size() / 2));
  const double noise = std::hypot(evidence.block_noise, evidence.step_noise);
  const double speed = glm::length(line.slope);
  if (speed * std::sqrt(line.spread) < 5.0 * noise) return vec2(0.0);
  if (glm::dot(late.slope, line.slope) < 0.6 * speed * speed) return vec2(0.0);
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
  return is_worth_telling(evidence, line.slope, seconds, 2.0) ? line.slope : vec2(0.0);
}

vec2 drift_of(const Evidence& evidence) {
  int seen = 0;
  for (const Release& release : evidence.releases) seen += release.from != vec2(0.0);
  const bool has_many = seen - tracks_of(evidence.releases) >= 4;
  return has_many ? drift_across_rests(evidence) : drift_within_rest(evidence);
}

// ---- centre ----

struct Home {
  vec2 centre{0.0};
  std::vector<bool> counts;
};

// The middle one of each axis.
vec2 median_of(std::span<const Release> releases) {
  std::vector<double> x, y;
  for (const Release& release : releases) {
    x.push_back(release.rest.place.x);
    y.push_back(release.rest.place.y);
  }
  const auto middle = static_cast<std::ptrdiff_t>(x.size() / 2);
  std::nth_element(x.begin(), x.begin() + middle, x.end());
  std::nth_element(y.begin(), y.begin() + middle, y.end());
  return {x[x.size() / 2], y[y.size() / 2]};
}

// A thumb that lay on the stick: a minority, several times as far off as the others are apart.
std::vector<bool> common_ones(std::span<const Release> releases, double noise) {
  std::vector<bool> counts(releases.size(), true);
  if (releases.size() < 4) return counts;
  const vec2 middle = median_of(releases);
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
  vec2 sum(0.0);
  double weight = 0.0;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (!counts[i]) continue;
    sum += releases[i].rest.weight * releases[i].rest.place;
    weight += releases[i].rest.weight;
  }
  return weight > 0.0 ? sum / weight : vec2(0.0);
}

// Whether noise alone explains how the rests differ.
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

// Without hysteresis all samples together are best. With it the rests lie round the true place,
// but not evenly: where they follow the direction of the release, that is taken out, else the
// middle of all counts.
Home home_of(std::span<const Release> releases, const Evidence& evidence) {
  Home home;
  home.counts = common_ones(releases, evidence.mean_noise);
  if (is_one_place(releases, home.counts, evidence)) {
    home.centre = mean_of(releases, home.counts);
    return home;
  }
  const ReturnModel with = return_model(releases, Explain::returns, evidence.mean_noise);
  const ReturnModel without = return_model(releases, Explain::home, evidence.mean_noise);
  const double freedom = 2.0 * (with.used - tracks_of(releases) - 2);
  const bool follows = freedom >= 4.0 && log_odds(without.residual, with.residual, freedom,
                                                  evidence.mean_noise) > 8.0;
  if (!follows) {
    const std::vector<vec2> places = places_of(releases, home.counts);
    home.centre = middle_of(places);
    return home;
  }
  home.centre = with.home;
  // The model knows better which ones are odd; those whose direction was not seen count if they
  // are not farther out than the others.
  double radius = 0.0;
  for (std::size_t i = 0; i < releases.size(); ++i) {
    if (with.counts[i]) {
      radius = std::max(radius, glm::length(releases[i].rest.place - home.centre));
    }
  }
  for (std::size_t i = 0; i < releases.size(); ++i) {
    const bool is_within = glm::length(releases[i].rest.place - home.centre) <=
                           1.2 * radius + 4.0 * evidence.mean_noise;
    home.counts[i] = with.counts[i] || (releases[i].from == vec2(0.0) && is_within);
  }
  return home;
}

// Between two rests: the way was seen, or the first one's track ends away from it. A stick that
// rests while the pad is unplugged, or from one recording to the next, tells of no return.
bool was_let_go(std::span<const StickTrack> tracks, std::span<const Release> releases) noexcept {
  for (std::size_t i = 1; i < releases.size(); ++i) {
    const Release& before = releases[i - 1];
    if (releases[i].from != vec2(0.0)) return true;
    const vec2 off = tracks[before.track].back().raw - before.rest.place;
    if (before.track != releases[i].track && glm::length(off) >= kReleaseMovement) return true;
  }
  return false;
}

double hysteresis_of(std::span<const vec2> places, double noise) noexcept {
  const double count = static_cast<double>(places.size());
  const double greatest = greatest_distance(places);
  // The square of what noise alone sets so many places apart, and seldom more.
  const double by_noise = 6.0 * noise * noise * (std::log(0.5 * count * (count - 1.0)) + 1.5);
  return std::sqrt(std::max(greatest * greatest - by_noise, 0.0));
}

// ---- noise ----

void tell_sigma(RestStatistics& to, const Evidence& evidence, const vec2& step) {
  if (evidence.noise.freedom < 10.0) return;
  const vec2 shown = evidence.noise.variance();
  // Rounding to steps adds what is evenly spread over one.
  const vec2 own = glm::sqrt(glm::max(shown - step * step / 12.0, vec2(0.0)));
  const bool is_x_hidden = own.x < step.x, is_y_hidden = own.y < step.y;
  to.is_sigma_hidden = is_x_hidden || is_y_hidden;
  to.sigma =
      vec2(is_x_hidden ? std::sqrt(shown.x) : own.x, is_y_hidden ? std::sqrt(shown.y) : own.y);
}

double wander_of(const Evidence& evidence, const vec2& drift) {
  double squares = 0.0, freedom = 0.0;
  for (const std::vector<RestPoint>& still : evidence.blocks) {
    const RestPoint mean = rest_trend(still).mean;
    for (const RestPoint& block : still) {
      const vec2 off = block.place - mean.place - drift * (block.time_s - mean.time_s);
      squares += 0.5 * glm::dot(off, off);
    }
    freedom += static_cast<double>(still.size()) - 1.0;
  }
  if (freedom < 6.0) return 0.0;
  const double white =
      std::max(evidence.white_noise * evidence.white_noise, evidence.step * evidence.step / 12.0);
  const double beyond = squares / freedom - white;
  const bool is_sure = beyond > white * 6.0 * std::sqrt(1.0 / freedom);
  const double least = std::max(0.002, 0.5 * evidence.step);
  return is_sure && beyond > least * least ? std::sqrt(beyond) : 0.0;
}

}  // namespace

RestStatistics rest_statistics(std::span<const StickTrack> tracks, std::span<const Still> rests,
                               const vec2& step, double interval_s) {
  RestStatistics told;
  if (rests.empty()) return told;
  const Evidence evidence = evidence_of(tracks, rests, step, interval_s);
  for (const Release& release : evidence.releases) {
    for (const Still& still : release.stills) {
      told.samples += static_cast<std::int64_t>(still.last - still.first + 1);
    }
  }
  told.seconds = evidence.seconds;
  if (evidence.weight < kFewestReports) return told;
  told.drift = drift_of(evidence);
  if (told.seconds >= kShortestForDrift_s) told.drift_per_s = glm::length(told.drift);
  std::vector<Release> steady = evidence.releases;
  for (Release& release : steady) release.rest.place -= told.drift * release.rest.time_s;
  const Home home = home_of(steady, evidence);
  told.centre = home.centre;
  told.rests = places_of(steady, home.counts);
  if (told.rests.size() >= 2 && was_let_go(tracks, evidence.releases)) {
    told.hysteresis = hysteresis_of(told.rests, evidence.mean_noise);
  }
  tell_sigma(told, evidence, step);
  told.wander = wander_of(evidence, told.drift);
  return told;
}

}  // namespace gaitpad
