#include "stick/stills.h"

#include <algorithm>
#include <cmath>

#include "stick/clean_track.h"
#include "stick/home_place.h"
#include "stick/report_statistics.h"

namespace gaitpad {
namespace {

constexpr double kCell_s = 0.02;
constexpr std::size_t kMostCells = 86400 * 50;  // a day, of all tracks together
// A place is still if the means of the 0.1 s before and behind it are the same.
constexpr std::size_t kHalfWindow = 5, kWindow = 2 * kHalfWindow;  // cells
constexpr std::size_t kShortestStill = 5;                          // cells
// The window's last half sees a push before it comes; so much of it is still rest.
constexpr std::size_t kWindowsLead = kHalfWindow - 1;
// Of the first half so much counts; the rest, with the margin, is settling.
constexpr std::size_t kWindowsLag = 2;
constexpr std::size_t kMargin = 2;   // cells
constexpr double kSlow = 0.006;      // raw, from one half of a window to the other: 0.06 a second
constexpr double kNoiseLimit = 4.5;  // standard deviations
constexpr double kUnseen = 0.0012;   // raw, from cell to cell: drift
constexpr double kNudge = 0.03;      // raw

// 20 ms of a track. Weights are reports, see reports_stood().
struct Cell {
  std::int64_t begin_ns = 0;
  std::size_t sample = 0;  // the one in force when it begins
  double weight = 0.0;
  vec2 sum{0.0};
  double change = 0.0;  // squares of the steps between its reports, summed
  vec2 mean() const noexcept { return sum / weight; }
  double variance() const noexcept { return 0.5 * change / weight; }  // of one report, both axes
};

void add(Cell& to, const Cell& cell) noexcept {
  to.weight += cell.weight;
  to.sum += cell.sum;
  to.change += cell.change;
}

std::vector<Cell> cells_of(const StickTrack& track, double interval_s, std::size_t most) {
  std::vector<Cell> cells;
  double left_s = 0.0;  // of the last cell
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

// What is no movement on this stick.
struct Limits {
  double slow = kSlow;     // raw, between the halves of a window; a code that flips is no movement
  double code = kUnseen;   // raw, from cell to cell
  std::size_t margin = 1;  // cells at a rest's ends, since a movement begins in the noise
};

// Few reports tell their noise badly: the factor on its square that is allowed for. Still fewer
// would let a movement pass for noise.
double doubt(double reports) noexcept {
  return reports > 4.0 ? 1.0 + std::min(6.0 / reports, 1.0) : 1.0;
}

// Whether the window of cells that begins at `first` shows one place but for noise. The noise is
// that of neighbouring reports: a movement's own steps are too small to hide it.
bool is_still(std::span<const Cell> cells, std::size_t first, const Limits& limits) noexcept {
  Cell before, after;
  for (std::size_t k = 0; k < kHalfWindow; ++k) {
    add(before, cells[first + k]);
    add(after, cells[first + kHalfWindow + k]);
  }
  const double weight = before.weight + after.weight;
  // A movement that begins or ends here is in one half.
  const double variance = std::min(before.variance(), after.variance());
  const double limit =
      kNoiseLimit * kNoiseLimit * variance * doubt(std::min(before.weight, after.weight));
  const vec2 moved = after.mean() - before.mean();
  if (glm::dot(moved, moved) >
      std::max(limits.slow * limits.slow, limit * (1.0 / before.weight + 1.0 / after.weight))) {
    return false;
  }
  // Turning fast comes back to where it was.
  const vec2 middle = (before.sum + after.sum) / weight;
  for (std::size_t k = first; k < first + kWindow; ++k) {
    const vec2 off = cells[k].mean() - middle;
    const double noise = 2.0 * limit / std::max(cells[k].weight, 1.0);
    if (glm::dot(off, off) > std::max(4.0 * limits.slow * limits.slow, noise)) return false;
  }
  return true;
}

struct Run {
  std::size_t begin = 0, end = 0;  // cells
};

// A rare extreme of the noise cuts no rest in two, nor do the small steps of a stick that wanders.
bool is_same_place(std::span<const Cell> cells, const Run& a, const Run& b) noexcept {
  if (b.begin > a.end + kWindow) return false;
  Cell one, other;
  for (std::size_t k = a.end; k > a.begin && k + kWindow > a.end; --k) add(one, cells[k - 1]);
  for (std::size_t k = b.begin; k < b.end && k < b.begin + kWindow; ++k) add(other, cells[k]);
  const vec2 place = one.mean();
  if (glm::length(other.mean() - place) > kNudge) return false;
  const double variance = std::max(one.variance(), other.variance());
  for (std::size_t k = a.end; k < b.begin; ++k) {
    const vec2 off = cells[k].mean() - place;
    const double noise = 36.0 * variance / std::max(cells[k].weight, 1.0);
    if (glm::dot(off, off) > std::max(kNudge * kNudge, noise)) return false;
  }
  return true;
}

// Of one report, both axes: the middle one of the run's parts, so that a spike, or a movement at an
// end, does not count.
double usual_variance(std::span<const Cell> cells, const Run& run) {
  std::vector<double> variances;
  Cell part;
  for (std::size_t first = run.begin; first < run.end; first += kHalfWindow) {
    part = {};
    const std::size_t end = std::min(first + kHalfWindow, run.end);
    for (std::size_t k = first; k < end; ++k) add(part, cells[k]);
    variances.push_back(part.variance());
  }
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>((variances.size() - 1) / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return *middle;
}

// Goes from a run's inside outwards, to where a cell is not like the five before it: the windows
// do not see where exactly a movement begins. `step` is 1 or -1; returns the last good cell.
std::size_t edge_of(std::span<const Cell> cells, const Run& run, int step, double variance,
                    const Limits& limits) {
  const std::size_t length = run.end - run.begin;
  const std::size_t inside = std::min<std::size_t>((length + 1) / 2, 2 * kWindow);
  const std::size_t outermost = step > 0 ? run.end - 1 : run.begin;
  std::size_t at = step > 0 ? run.end - inside : run.begin + inside - 1;
  while (at != outermost) {
    const std::size_t next = step > 0 ? at + 1 : at - 1;
    Cell inner;
    for (std::size_t k = 0; k < kHalfWindow; ++k) {
      const std::size_t cell = step > 0 ? at - std::min(at - run.begin, k) : at + k;
      if (cell >= run.end) break;
      add(inner, cells[cell]);
    }
    const vec2 off = cells[next].mean() - inner.mean();
    const double noise =
        std::sqrt(variance * (1.0 / std::max(cells[next].weight, 1.0) + 1.0 / inner.weight));
    if (glm::length(off) > kNoiseLimit * noise + limits.code) break;
    at = next;
  }
  return at;
}

// Cells whose windows are still, those at one place together.
std::vector<Run> still_windows(std::span<const Cell> cells, const Limits& limits) {
  std::vector<Run> runs;
  if (cells.size() < kWindow) return runs;
  const std::size_t last = cells.size() - kWindow;  // where the last window begins
  Run run;
  const auto end_run = [&] {
    if (run.begin == run.end) return;
    if (!runs.empty() && is_same_place(cells, runs.back(), run)) {
      runs.back().end = run.end;
    } else {
      runs.push_back(run);
    }
  };
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::size_t window = std::clamp(c, kHalfWindow, last + kHalfWindow) - kHalfWindow;
    const bool is_in = is_still(cells, window, limits);
    if (is_in && run.end == c) {
      ++run.end;
    } else if (is_in) {
      end_run();
      run = {c, c + 1};
    }
  }
  end_run();
  return runs;
}

// To where the stick began to move, and a little back.
Run trimmed(std::span<const Cell> cells, const Run& run, const Limits& limits) {
  const double reports = 0.5 * cells[run.begin].weight * static_cast<double>(run.end - run.begin);
  const double variance = doubt(reports) * usual_variance(cells, run);
  Run edges{edge_of(cells, run, -1, variance, limits),
            edge_of(cells, run, 1, variance, limits) + 1};
  const std::size_t margin = std::min(limits.margin, (edges.end - edges.begin) / 4);
  if (edges.begin > 0) edges.begin += margin;
  if (edges.end < cells.size()) edges.end -= margin;
  return edges;
}

std::vector<Run> still_runs(std::span<const Cell> cells, const Limits& limits) {
  const std::vector<Run> windows = still_windows(cells, limits);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    // What lies between two places belongs to neither.
    const std::size_t least = i == 0 ? 0 : (windows[i - 1].end + windows[i].begin + 1) / 2;
    const std::size_t most =
        i + 1 == windows.size() ? cells.size() : (windows[i].end + windows[i + 1].begin) / 2;
    Run run = windows[i];
    run.begin = std::max(run.begin - std::min(run.begin, kWindowsLag), least);
    run.end = std::min(run.end + kWindowsLead, most);
    run = trimmed(cells, run, limits);
    if (run.end - run.begin >= kShortestStill) runs.push_back(run);
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
              .begin_ns = cells[run.begin].begin_ns,
              .end_ns = final.begin_ns + static_cast<std::int64_t>(kCell_s * 1e9),
              .duration_s = kCell_s * static_cast<double>(run.end - run.begin),
              .mean = sum.mean()};
  while (still.last + 1 < track.size() && track[still.last + 1].time_ns < still.end_ns) {
    ++still.last;
  }
  return still;
}

Limits limits_of(std::span<const StickTrack> tracks, const vec2& declared_step, double interval_s) {
  const double step = std::max(quantisation_step(tracks, 0, declared_step.x),
                               quantisation_step(tracks, 1, declared_step.y));
  const double code = std::min(step, 0.05);
  const double margin = std::ceil(3.0 * interval_s / kCell_s);
  return {.slow = std::max(kSlow, 1.5 * code),
          .code = std::max(kUnseen, 1.2 * code),
          .margin = static_cast<std::size_t>(std::clamp(margin, 1.0, 5.0))};
}

std::vector<Still> all_stills(std::span<const StickTrack> tracks, const vec2& declared_step) {
  const double interval_s = typical_interval_s(tracks);
  const Limits limits = limits_of(tracks, declared_step, interval_s);
  std::vector<Still> found;
  std::size_t left = kMostCells;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const std::vector<Cell> cells = cells_of(tracks[t], interval_s, left);
    left -= cells.size();
    for (const Run& run : still_runs(cells, limits)) {
      found.push_back(still_of(tracks[t], t, cells, run));
    }
  }
  return found;
}

}  // namespace

Stills stills(std::span<const StickTrack> raw_tracks, const vec2& declared_step) {
  const std::vector<StickTrack> tracks = clean_tracks(raw_tracks).tracks;
  return sorted_stills(tracks, all_stills(tracks, declared_step));
}

}  // namespace gaitpad
