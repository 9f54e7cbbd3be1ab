#include "stick/stills.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "base/numeric.h"
#include "stick/outline.h"

namespace gaitpad {

namespace {

// ---- Finding the stills

constexpr double kCell_s = 0.02;
// Most cells, for all tracks together: 24 hours.
constexpr std::size_t kMostCells = 86400 * 50;
// A place is still if the means of the 0.1 s before it and behind it are equal.
constexpr std::size_t kHalfWindow = 5, kWindow = 2 * kHalfWindow;  // lengths in cells
constexpr std::size_t kShortestStill = 5;                          // length in cells
constexpr std::size_t kSettling = 3;  // cells of a half window that may belong to a movement
// Largest raw difference of the halves of a window at rest: 0.06 a second.
constexpr double kSlow = 0.006;
constexpr double kNoiseLimit = 4.5;  // limit of the noise in standard deviations

// 20 ms of a track. Weights count reports, see reports_stood().
struct Cell {
  std::int64_t begin_ns = 0;
  std::size_t sample = 0;  // the sample that holds at the beginning of the cell
  double weight = 0.0;
  vec2 sum{0.0};
  double change = 0.0;  // sum of the squared steps between its reports
  vec2 mean() const noexcept { return sum / weight; }
  // Variance of one report, of both axes.
  double variance() const noexcept { return 0.5 * change / weight; }
};

void add(Cell& to, const Cell& cell) noexcept {
  to.weight += cell.weight;
  to.sum += cell.sum;
  to.change += cell.change;
}

std::vector<Cell> cells_of(const StickTrack& track, double interval_s, std::size_t most) {
  std::vector<Cell> cells;
  double left_s = 0.0;  // time that is left in the last cell
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double stood_s = hold_s(track, i, interval_s);
    const double weight = reports_stood(stood_s, interval_s);
    double done_s = 0.0;
    do {
      if (left_s <= 1e-9) {
        if (cells.size() == most) return cells;
        cells.push_back(
            {.begin_ns = track[i].time_ns + static_cast<std::int64_t>(done_s * 1e9), .sample = i});
        left_s = kCell_s;
      }
      const double part_s = std::min(stood_s - done_s, left_s);
      const double part = stood_s > 0.0 ? weight * part_s / stood_s : weight;
      cells.back().weight += part;
      cells.back().sum += part * track[i].raw;
      if (done_s == 0.0 && i > 0) {
        const vec2 step = track[i].raw - track[i - 1].raw;
        cells.back().change += glm::dot(step, step);
      }
      done_s += part_s;
      left_s -= part_s;
    } while (done_s < stood_s - 1e-9);
  }
  return cells;
}

// Few reports measure their variance badly; this factor allows for that. Four and fewer get none,
// because a movement would pass for noise.
double variance_factor(double reports) noexcept {
  return reports > 4.0 ? 1.0 + std::min(6.0 / reports, 1.0) : 1.0;
}

// Whether the window of cells from `first` on shows a single place, apart from noise. The noise is
// measured between successive reports, between which even a movement is small.
bool is_still(std::span<const Cell> cells, std::size_t first, double slow) noexcept {
  Cell before, after;
  for (std::size_t k = 0; k < kHalfWindow; ++k) {
    add(before, cells[first + k]);
    add(after, cells[first + kHalfWindow + k]);
  }
  const double weight = before.weight + after.weight;
  // A movement that begins or ends here is in one half only.
  const double variance = std::min(before.variance(), after.variance());
  const double limit =
      kNoiseLimit * kNoiseLimit * variance * variance_factor(std::min(before.weight, after.weight));
  const vec2 moved = after.mean() - before.mean();
  if (glm::dot(moved, moved) >
      std::max(slow * slow, limit * (1.0 / before.weight + 1.0 / after.weight))) {
    return false;
  }
  // A fast turn returns to where it was: no cell may be far from the middle either.
  const vec2 middle = (before.sum + after.sum) / weight;
  for (std::size_t k = first; k < first + kWindow; ++k) {
    const vec2 off = cells[k].mean() - middle;
    const double noise = 2.0 * limit / std::max(cells[k].weight, 1.0);
    if (glm::dot(off, off) > std::max(4.0 * slow * slow, noise)) return false;
  }
  return true;
}

struct Run {
  std::size_t begin = 0, end = 0;  // cells [begin, end)
};

// Whether the cells behind the run stay at its place: a touch, or the step of a stick that wanders,
// does not cut a rest in two.
bool stays(std::span<const Cell> cells, const Run& run, std::size_t end) noexcept {
  constexpr double kNudge = 0.03;  // raw distance of a nudge
  Cell place;
  for (std::size_t k = run.end; k > run.begin && k + kHalfWindow > run.end; --k)
    add(place, cells[k - 1]);
  for (std::size_t k = run.end; k < end; ++k)
    if (glm::length(cells[k].mean() - place.mean()) > kNudge) return false;
  return true;
}

// Runs of cells whose windows are still. A run is extended into its outermost windows, except for
// the cells beside the movement: it begins within the noise and, on a slow pad, between two
// reports.
std::vector<Run> still_runs(std::span<const Cell> cells, double slow, double interval_s) {
  std::vector<Run> runs;
  if (cells.size() < kWindow) return runs;
  const auto late = static_cast<std::size_t>(std::ceil(2.0 * interval_s / kCell_s));
  const std::size_t room = kHalfWindow - std::min(kHalfWindow, kSettling - 1 + late);
  std::size_t begin = 0;
  for (std::size_t c = 0; c <= cells.size(); ++c) {
    const std::size_t window = std::clamp(c, kHalfWindow, cells.size() - kHalfWindow) - kHalfWindow;
    if (c < cells.size() && is_still(cells, window, slow)) continue;
    if (c > begin && c - begin + 2 * room >= kShortestStill) {
      const std::size_t end = std::min(c + room, cells.size());
      const bool is_same =
          !runs.empty() && begin <= runs.back().end + kWindow && stays(cells, runs.back(), end);
      if (is_same) {
        runs.back().end = end;
      } else {
        // The movement between two places belongs to neither.
        const std::size_t least = runs.empty() ? 0 : (runs.back().end + begin) / 2;
        if (!runs.empty()) runs.back().end = std::min(runs.back().end, least);
        runs.push_back({std::max(begin - std::min(begin, room), least), end});
      }
    }
    begin = c + 1;
  }
  return runs;
}

Still still_of(const StickTrack& track, std::size_t index, std::span<const Cell> cells,
               const Run& run) {
  Cell sum;
  for (std::size_t k = run.begin; k < run.end; ++k) add(sum, cells[k]);
  const Cell& final = cells[run.end - 1];
  Still still{.track = index,
              .first = cells[run.begin].sample,
              .last = final.sample,
              .begin_cell = run.begin,
              .end_cell = run.end,
              .begin_ns = cells[run.begin].begin_ns,
              .end_ns = final.begin_ns + static_cast<std::int64_t>(kCell_s * 1e9),
              .duration_s = kCell_s * static_cast<double>(run.end - run.begin),
              .mean = sum.mean()};
  while (still.last + 1 < track.size() && track[still.last + 1].time_ns < still.end_ns) {
    ++still.last;
  }
  return still;
}

// The cells of each track.
std::vector<std::vector<Cell>> cells_of(std::span<const StickTrack> tracks, double interval_s) {
  std::vector<std::vector<Cell>> cells;
  std::size_t left = kMostCells;
  for (const StickTrack& track : tracks) {
    cells.push_back(cells_of(track, interval_s, left));
    left -= cells.back().size();
  }
  return cells;
}

// ---- Which of them are rests

constexpr double kFarthestFromMiddle = 0.5;  // farthest rest, raw; farther out a stick is held

// Least distance from a rest that counts as a movement between two rests, raw.
constexpr double kReleaseMovement = 0.2;
constexpr std::size_t kShortestMovement = 3;  // length in cells

bool is_near_middle(const vec2& p) noexcept {
  return std::max(std::fabs(p.x), std::fabs(p.y)) < kFarthestFromMiddle;
}

// `turned`: the extent of a stick that was turned round; a rest lies within 0.6 of it.
bool may_be_rest(const Still& still, const std::optional<Extent>& turned) noexcept {
  if (!is_near_middle(still.mean)) return false;
  return !turned || glm::length((still.mean - turned->middle()) / turned->half()) < 0.6;
}

// The extent of the stick's track; none unless the stick went all the way round.
std::optional<Extent> turned_extent(std::span<const StickTrack> tracks) {
  const Extent extent = extent_of(tracks);
  const double least_half = std::min(extent.half().x, extent.half().y);
  if (least_half <= 0.2 || whole_turns(tracks, extent.middle(), 0.6 * least_half) == 0) return {};
  return extent;
}

// Puts the rests first and returns their end: the stills at the place that was seen most often (not
// for longest) and near the middle; none if the stick was only held at its rim. Squares of a grid
// that lie within 0.19 are one place, so that the rests of a stick that drifts or returns badly
// stay together.
std::vector<Still>::iterator sort_out_rests(std::vector<Still>& found,
                                            std::span<const StickTrack> tracks) {
  constexpr double kSquare = 0.0625, kSame = 3;  // side of a square, raw; distance in squares
  // Raw distance from the middle at which a place counts exp(-1) as much; worn sticks rest up to
  // that far off.
  constexpr double kNearMiddle = 0.25;
  struct Place {
    double seen_s = 0.0, count = 0.0;
    vec2 sum{0.0};
    std::size_t group = 0;
  };
  const auto square_of = [](const Still& still) { return glm::floor(still.mean / kSquare); };
  const auto is_before = [](const vec2& a, const vec2& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  };
  std::map<vec2, Place, decltype(is_before)> places(is_before);
  const std::optional<Extent> turned = turned_extent(tracks);
  for (const Still& still : found) {
    if (!may_be_rest(still, turned)) continue;
    Place& place = places[square_of(still)];
    place.seen_s += std::min(still.duration_s, 0.5);
    place.count += 1.0;
    place.sum += still.mean;
  }
  std::size_t groups = 0;
  for (auto& [square, place] : places) place.group = groups++;
  for (const auto& [a, one] : places) {
    for (const auto& [b, other] : places) {
      const vec2 apart = glm::abs(a - b);
      if (std::max(apart.x, apart.y) > kSame || one.group == other.group) continue;
      const std::size_t gone = other.group;
      for (auto& [square, place] : places)
        if (place.group == gone) place.group = one.group;
    }
  }
  std::vector<Place> together(groups);
  for (const auto& [square, place] : places) {
    together[place.group].seen_s += place.seen_s;
    together[place.group].count += place.count;
    together[place.group].sum += place.sum;
  }
  std::size_t rest = 0;
  double best = 0.0;
  for (std::size_t k = 0; k < groups; ++k) {
    if (together[k].count == 0.0) continue;
    const vec2 off = together[k].sum / together[k].count / kNearMiddle;
    const double score = together[k].seen_s * std::exp(-glm::dot(off, off));
    if (score > best) best = score, rest = k;
  }
  return std::stable_partition(found.begin(), found.end(), [&](const Still& still) {
    return may_be_rest(still, turned) && places[square_of(still)].group == rest;
  });
}

// The side (unit) from which the stick came to this place, between these cells; 0 if it hardly
// moved, or only for a moment. A spring brings it back in a straight line but may overshoot: the
// side is that on which it was last half way out.
vec2 side_of_return(std::span<const Cell> way, const vec2& place) noexcept {
  double farthest = 0.0;
  std::size_t away = 0;
  for (const Cell& cell : way) {
    const double distance = glm::length(cell.mean() - place);
    if (distance < kReleaseMovement) continue;
    farthest = std::max(farthest, distance);
    ++away;
  }
  if (away < kShortestMovement) return vec2(0.0);
  for (std::size_t k = way.size(); k > 0; --k) {
    const vec2 off = way[k - 1].mean() - place;
    if (glm::length(off) >= 0.5 * farthest) return glm::normalize(off);
  }
  return vec2(0.0);
}

// ---- Hands-off time

// Shares of the reach. A spring brings the stick from kFar to kBack within kSpringCells; a hand
// that leads it back is slower.
constexpr double kPushed = 0.5, kFar = 0.7, kBack = 0.45;
constexpr std::size_t kSpringCells = 7, kSettlingCells = 15, kLeastSettlingCells = 8;
constexpr std::size_t kBlockCells = 5;
constexpr double kOutwards = 0.012;       // raw distance in 60 ms with which a push may begin
constexpr std::size_t kLongestPush = 25;  // length in cells

// The mean place of the stick while it was slow and not held at its rim: for a stick that never
// stands still, the middle of its wanderings. None if it was always moved.
std::optional<vec2> usual_place(std::span<const Cell> cells) {
  constexpr double kFast = 0.05;  // raw distance between neighbouring cells
  std::vector<vec2> places;
  for (std::size_t k = 1; k < cells.size(); ++k) {
    const vec2 at = cells[k].mean();
    if (!is_near_middle(at) || glm::length(at - cells[k - 1].mean()) > kFast) continue;
    places.push_back(at);
  }
  return places.size() < 5 * kBlockCells ? std::nullopt : std::optional(median_of(places));
}

// The hands-off times of one track. `rest`: place where the stick rests; `reach`: from there;
// `late`: cells per report, on slow pads.
void add_hands_off(std::size_t track, std::span<const Cell> cells, const vec2& rest, double reach,
                   std::size_t late, std::vector<HandsOff>& found) {
  const auto away = [&](std::size_t k) { return glm::length(cells[k].mean() - rest) / reach; };
  for (std::size_t begin = 0, end; begin < cells.size(); begin = end) {
    end = begin + 1;
    if (away(begin) > kPushed) continue;
    while (end < cells.size() && away(end) <= kPushed) ++end;
    const bool is_released = begin > 0;
    if (is_released) {
      const std::size_t spring = kSpringCells + late, nearer = begin + spring / 2;
      if (nearer >= end || begin < spring || away(nearer) > kBack) continue;
      if (away(nearer - spring) < kFar && away(nearer - spring + 1) < kFar) continue;
    }
    std::size_t first = begin + (is_released ? kSettlingCells : 0), last = end;
    if (end < cells.size()) {
      // The push that ends this time began before it was seen.
      last -= std::min(last - begin, kBlockCells + late);
      for (std::size_t k = 0; k < kLongestPush && last > first + 3; ++k, --last) {
        if ((away(last - 1) - away(last - 4)) * reach < kOutwards) break;
      }
    }
    // A short time counts from earlier on, although the stick may not quite have settled.
    if (is_released && last < first + kBlockCells)
      first = std::max(begin + kLeastSettlingCells, last - std::min(last, kBlockCells));
    if (last < first + kBlockCells) continue;
    HandsOff& time = found.emplace_back();
    time.track = track;
    time.is_released = is_released;
    for (std::size_t k = first; k + kBlockCells <= last; k += kBlockCells) {
      Cell block;
      for (std::size_t n = k; n < k + kBlockCells; ++n) add(block, cells[n]);
      time.places.push_back(block.mean());
      time.variances.push_back(block.variance() / std::max(block.weight, 1.0));
    }
  }
}

// The usual length of a push; a square gate's corners are far beyond it.
double usual_reach(std::span<const std::vector<Cell>> cells, const vec2& rest) {
  std::vector<double> away;
  double farthest = 0.5;
  for (const std::vector<Cell>& track : cells) {
    for (const Cell& cell : track) {
      away.push_back(glm::length(cell.mean() - rest));
      farthest = std::max(farthest, away.back());
    }
  }
  std::erase_if(away, [&](double distance) { return distance <= kPushed * farthest; });
  return away.empty() ? farthest : median(std::move(away));
}

}  // namespace

Stills stills(std::span<const StickTrack> tracks, const vec2& step, double interval_s) {
  const std::vector<std::vector<Cell>> cells = cells_of(tracks, interval_s);
  const double slow = std::max(kSlow, 1.5 * std::min(std::max(step.x, step.y), 0.05));
  std::vector<Still> all;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (const Run& run : still_runs(cells[t], slow, interval_s))
      all.push_back(still_of(tracks[t], t, cells[t], run));
  }
  Stills found;
  const auto others = sort_out_rests(all, tracks);
  found.rests.assign(all.begin(), others);
  std::vector<vec2> places;
  for (std::size_t k = 0; k < found.rests.size(); ++k) {
    Still& rest = found.rests[k];
    const bool is_first = k == 0 || found.rests[k - 1].track != rest.track;
    const std::size_t since = is_first ? 0 : found.rests[k - 1].end_cell;
    rest.from = side_of_return(std::span(cells[rest.track]).subspan(since, rest.begin_cell - since),
                               rest.mean);
    places.push_back(rest.mean);
  }
  for (std::size_t t = 0; t < tracks.size() && found.rests.empty(); ++t) {
    if (const auto place = usual_place(cells[t])) places.push_back(*place);
  }
  if (places.empty()) return found;
  const vec2 centre = median_of(places);
  const double reach = usual_reach(cells, centre);
  const auto late = static_cast<std::size_t>(std::clamp(interval_s / kCell_s, 0.0, 10.0));
  for (std::size_t t = 0; t < tracks.size(); ++t)
    add_hands_off(t, cells[t], centre, reach, late, found.hands_off);
  std::copy_if(others, all.end(), std::back_inserter(found.pushes), [&](const Still& still) {
    return glm::length(still.mean - centre) >= kPushed * reach;
  });
  return found;
}

Stills stills(std::span<const StickTrack> raw_tracks) {
  const std::vector<StickTrack> tracks = clean_tracks(raw_tracks).tracks;
  const vec2 step{quantisation_step(tracks, 0, 0.0), quantisation_step(tracks, 1, 0.0)};
  return stills(tracks, step, typical_interval_s(tracks));
}

}  // namespace gaitpad
