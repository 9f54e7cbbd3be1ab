#include "stick/stills.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "stick/outline.h"

namespace gaitpad {

namespace {

// ---- Finding the stills

constexpr double kCell_s = 0.02;
constexpr std::size_t kMostCells = 86400 * 50;  // a day, all tracks together
// A place is still if the means of the 0.1 s before it and behind it are equal.
constexpr std::size_t kHalfWindow = 5, kWindow = 2 * kHalfWindow;  // cells
constexpr std::size_t kShortestStill = 5;                          // cells
// The second half of a window shows a push before it begins; this much of it is still rest.
constexpr std::size_t kWindowsLead = kHalfWindow - 1;
// This much of the first half counts; the remainder, and the margin, is settling.
constexpr std::size_t kWindowsLag = 2;
constexpr double kSlow = 0.006;      // raw, between the halves of a window: 0.06 a second
constexpr double kNoiseLimit = 4.5;  // standard deviations
constexpr double kUnseen = 0.0012;   // raw, between cells: slow drift is no movement
constexpr double kNudge = 0.03;      // raw; places this close are one rest

// 20 ms of a track. Weights count reports, see reports_stood().
struct Cell {
  std::int64_t begin_ns = 0;
  std::size_t sample = 0;  // the one in force at the beginning
  double weight = 0.0;
  vec2 sum{0.0};
  double change = 0.0;  // sum of the squared steps between its reports
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
  double left_s = 0.0;  // room in the last cell
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

// What does not count as movement on this stick.
struct Limits {
  double slow = kSlow;     // raw, between the halves of a window; more than one flipping code
  double code = kUnseen;   // raw, from cell to cell
  std::size_t margin = 1;  // cells cut off each end, because a movement begins within the noise
};

// Few reports measure their variance badly; this factor on the variance allows for that. Four and
// fewer get none, because a movement would pass for noise.
double doubt(double reports) noexcept {
  return reports > 4.0 ? 1.0 + std::min(6.0 / reports, 1.0) : 1.0;
}

// Whether the window of cells from `first` on shows a single place, apart from noise. The noise is
// measured between successive reports, where a movement's own steps are too small to matter.
bool is_still(std::span<const Cell> cells, std::size_t first, const Limits& limits) noexcept {
  Cell before, after;
  for (std::size_t k = 0; k < kHalfWindow; ++k) {
    add(before, cells[first + k]);
    add(after, cells[first + kHalfWindow + k]);
  }
  const double weight = before.weight + after.weight;
  // A movement that begins or ends here is in one half only.
  const double variance = std::min(before.variance(), after.variance());
  const double limit =
      kNoiseLimit * kNoiseLimit * variance * doubt(std::min(before.weight, after.weight));
  const vec2 moved = after.mean() - before.mean();
  if (glm::dot(moved, moved) >
      std::max(limits.slow * limits.slow, limit * (1.0 / before.weight + 1.0 / after.weight))) {
    return false;
  }
  // A fast turn returns to where it was: no cell may be far from the middle either.
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

// Two runs at one place are one rest: a rare extreme of the noise, or the small steps of a stick
// that wanders, must not cut it in two.
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

// Variance of one report, both axes: the median over parts of the run, so that a spike, or a
// movement at an end, does not count.
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

// Walks from the inside of a run outwards and returns the last cell that is like the five before
// it, because the windows do not show exactly where a movement begins. `step` is 1 or -1.
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

// Runs of cells with still windows; runs at one place are joined.
std::vector<Run> still_windows(std::span<const Cell> cells, const Limits& limits) {
  std::vector<Run> runs;
  if (cells.size() < kWindow) return runs;
  const std::size_t last = cells.size() - kWindow;  // the beginning of the last window
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

// Cuts the run to where the stick began to move, less a margin.
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
    // The way between two places belongs to neither.
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

// By track.
std::vector<std::vector<Cell>> cells_of(std::span<const StickTrack> tracks, double interval_s) {
  std::vector<std::vector<Cell>> cells;
  std::size_t left = kMostCells;
  for (const StickTrack& track : tracks) {
    cells.push_back(cells_of(track, interval_s, left));
    left -= cells.back().size();
  }
  return cells;
}

std::vector<Still> all_stills(std::span<const StickTrack> tracks,
                              std::span<const std::vector<Cell>> cells, const Limits& limits) {
  std::vector<Still> found;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (const Run& run : still_runs(cells[t], limits)) {
      found.push_back(still_of(tracks[t], t, cells[t], run));
    }
  }
  return found;
}

// ---- Which of them are rests

constexpr double kFarthestHome = 0.5;  // raw; farther out a stick is held, not at rest

struct Box {
  vec2 middle{0.0}, half{0.0};
};

std::optional<Box> box_of(std::span<const StickTrack> tracks) noexcept {
  vec2 least(1e9), most(-1e9);
  for (const StickTrack& track : tracks) {
    for (const StickSample& sample : track) {
      least = glm::min(least, sample.raw);
      most = glm::max(most, sample.raw);
    }
  }
  if (least.x > most.x) return {};
  return Box{0.5 * (least + most), 0.5 * (most - least)};
}

// Groups stills by place on a grid over +-kFarthestHome. Cells within 0.19 are one place, so that
// the rests of a stick that drifts or returns badly stay together. The home is the place that was
// seen most often (not for longest) and near the middle; there is none if the stick was only held
// at its rim.
class Places {
 public:
  void add(const Still& still) {
    const std::size_t bin = bin_of(still.mean);
    seen_[bin] += std::min(still.duration_s, 0.5);
    sum_[bin] += still.mean;
    count_[bin] += 1.0;
  }
  void find_home() {
    double best = 0.0;
    for (int bin = 0; bin < kBins * kBins; ++bin) {
      if (count_[bin] == 0.0 || place_[bin] != 0) continue;
      const double score = score_place(bin);
      if (score > best) {
        best = score;
        home_ = places_;
      }
    }
  }
  bool is_home(const Still& still) const {
    return is_inside(still.mean) && home_ != 0 && place_[bin_of(still.mean)] == home_;
  }
  static bool is_inside(const vec2& p) {
    return std::max(std::fabs(p.x), std::fabs(p.y)) < kFarthestHome;
  }

 private:
  static constexpr int kBins = 16, kReach = 3;
  static std::size_t bin_of(const vec2& p) {
    const auto index = [](double x) {
      return std::clamp(static_cast<int>((x / kFarthestHome + 1.0) * 0.5 * kBins), 0, kBins - 1);
    };
    return static_cast<std::size_t>(index(p.y) * kBins + index(p.x));
  }
  // Numbers the place that the bin belongs to and returns how good a home it is.
  double score_place(int first) {
    ++places_;
    std::vector<int> open{first};
    place_[first] = places_;
    double seen = 0.0, count = 0.0;
    vec2 sum(0.0);
    while (!open.empty()) {
      const int bin = open.back();
      open.pop_back();
      seen += seen_[bin];
      sum += sum_[bin];
      count += count_[bin];
      for (int y = bin / kBins - kReach; y <= bin / kBins + kReach; ++y) {
        for (int x = bin % kBins - kReach; x <= bin % kBins + kReach; ++x) {
          if (x < 0 || y < 0 || x >= kBins || y >= kBins) continue;
          const int next = y * kBins + x;
          if (count_[next] == 0.0 || place_[next] != 0) continue;
          place_[next] = places_;
          open.push_back(next);
        }
      }
    }
    const vec2 middle = sum / count / 0.25;  // worn sticks rest up to that far from the middle
    return seen * std::exp(-glm::dot(middle, middle));
  }

  std::array<double, kBins * kBins> seen_{}, count_{};
  std::array<vec2, kBins * kBins> sum_{};
  std::array<int, kBins * kBins> place_{};
  int places_ = 0, home_ = 0;
};

// `turned`: where the stick went if it was turned round; a rest lies well inside of it.
bool may_be_home(const Still& still, const std::optional<Box>& turned) noexcept {
  if (!Places::is_inside(still.mean)) return false;
  if (!turned) return true;
  const vec2 off = (still.mean - turned->middle) / turned->half;
  return glm::length(off) < 0.6;
}

// Where the stick went; none unless it went all the way round.
std::optional<Box> turned_box(std::span<const StickTrack> tracks) {
  const std::optional<Box> box = box_of(tracks);
  if (!box) return {};
  const double least_half = std::min(box->half.x, box->half.y);
  if (least_half <= 0.2 || whole_turns(tracks, box->middle, 0.6 * least_half) == 0) return {};
  return box;
}

double farthest_from(const vec2& home, std::span<const StickTrack> tracks) noexcept {
  double farthest = 0.5;
  for (const StickTrack& track : tracks) {
    for (const StickSample& sample : track) {
      farthest = std::max(farthest, glm::length(sample.raw - home));
    }
  }
  return farthest;
}

// ---- Hands-off time

// Shares of the reach. A spring brings the stick from the farther place to the nearer one within
// kSpringCells; a hand that leads it back is slower.
constexpr double kPushed = 0.5, kFar = 0.7, kBack = 0.45;
constexpr std::size_t kSpringCells = 7, kSettlingCells = 15;
constexpr std::size_t kBlockCells = 5, kFewestBlocks = 2;
constexpr double kOutwards = 0.012;       // raw in 60 ms: a push may have begun
constexpr std::size_t kLongestPush = 25;  // cells

// Where the stick was while it was slow and not held at its rim: of a stick that never stands
// still, the middle of its wanderings. None if it was always moved.
std::optional<vec2> usual_place(std::span<const Cell> cells) {
  constexpr double kFast = 0.05;  // raw from cell to cell
  std::vector<vec2> places;
  for (std::size_t k = 1; k < cells.size(); ++k) {
    const vec2 at = cells[k].mean();
    if (!Places::is_inside(at) || glm::length(at - cells[k - 1].mean()) > kFast) continue;
    places.push_back(at);
  }
  return places.size() < 5 * kBlockCells ? std::nullopt : std::optional(median_of(places));
}

// The hands-off times of one track. `home`: where the stick rests; `reach`: from there.
void add_hands_off(std::size_t track, std::span<const Cell> cells, const vec2& home, double reach,
                   std::size_t late, std::vector<HandsOff>& found) {
  const auto away = [&](std::size_t k) { return glm::length(cells[k].mean() - home) / reach; };
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
    if (last < first + kFewestBlocks * kBlockCells) continue;
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

// Tells rests from pushes.
Stills sorted_stills(std::span<const StickTrack> tracks, std::span<const Still> found) {
  const std::optional<Box> turned = turned_box(tracks);
  Places places;
  for (const Still& still : found) {
    if (may_be_home(still, turned)) places.add(still);
  }
  places.find_home();
  Stills sorted;
  vec2 home(0.0);
  double weight = 0.0;
  for (const Still& still : found) {
    if (!places.is_home(still) || !may_be_home(still, turned)) continue;
    sorted.rests.push_back(still);
    home += still.duration_s * still.mean;
    weight += still.duration_s;
  }
  if (weight > 0.0) home /= weight;
  const double reach = farthest_from(home, tracks);
  for (const Still& still : found) {
    if (glm::length(still.mean - home) >= 0.5 * reach && !places.is_home(still)) {
      sorted.pushes.push_back(still);
    }
  }
  return sorted;
}

}  // namespace

Stills stills(std::span<const StickTrack> raw_tracks, const vec2& declared_step) {
  const std::vector<StickTrack> tracks = clean_tracks(raw_tracks).tracks;
  const double interval_s = typical_interval_s(tracks);
  const std::vector<std::vector<Cell>> cells = cells_of(tracks, interval_s);
  const Limits limits = limits_of(tracks, declared_step, interval_s);
  Stills found = sorted_stills(tracks, all_stills(tracks, cells, limits));
  const auto late = static_cast<std::size_t>(std::clamp(interval_s / kCell_s, 0.0, 10.0));
  std::vector<vec2> places;
  for (const Still& rest : found.rests) places.push_back(rest.mean);
  for (std::size_t t = 0; t < tracks.size() && found.rests.empty(); ++t) {
    if (const auto place = usual_place(cells[t])) places.push_back(*place);
  }
  if (places.empty()) return found;
  const vec2 home = median_of(places);
  double reach = farthest_from(home, tracks);
  std::vector<double> pushed;  // a square gate's corners are far beyond what it usually reaches
  for (const std::vector<Cell>& track : cells) {
    for (const Cell& cell : track) {
      const double away = glm::length(cell.mean() - home);
      if (away > kPushed * reach) pushed.push_back(away);
    }
  }
  if (!pushed.empty()) reach = median_of(std::move(pushed));
  for (std::size_t t = 0; t < tracks.size(); ++t)
    add_hands_off(t, cells[t], home, reach, late, found.hands_off);
  return found;
}

}  // namespace gaitpad
