#include "stick/rests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "stick/statistics.h"
#include "stick/stick_track.h"

namespace gaitpad {

namespace {

constexpr double kFarthestHome = 0.5;  // raw; a stick that rests farther out looks held

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

// Places are told apart on a grid over +-kFarthestHome; neighbours within 0.19 are one place, so
// that the rests of a stick that drifts, or returns badly, hang together.
class Places {
 public:
  void add(const Still& still) {
    const std::size_t bin = bin_of(still.mean);
    seen_[bin] += std::min(still.duration_s, 0.5);
    sum_[bin] += still.mean;
    count_[bin] += 1.0;
  }
  // Numbers the places and finds the best: often visited, near the middle.
  void choose() {
    double best = 0.0;
    for (int bin = 0; bin < kBins * kBins; ++bin) {
      if (count_[bin] == 0.0 || place_[bin] != 0) continue;
      const double score = flood(bin);
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
  // Gives the place of a bin its number and returns how good a home it is.
  double flood(int first) {
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
    const vec2 middle = sum / count / 0.25;  // worn sticks rest up to that far off
    return seen * std::exp(-glm::dot(middle, middle));
  }

  std::array<double, kBins * kBins> seen_{}, count_{};
  std::array<vec2, kBins * kBins> sum_{};
  std::array<int, kBins * kBins> place_{};
  int places_ = 0, home_ = 0;
};

// Of a stick that was turned round, which lies well inside of where it went.
bool may_be_home(const Still& still, const std::optional<Box>& turned) noexcept {
  if (!Places::is_inside(still.mean)) return false;
  if (!turned) return true;
  const vec2 off = (still.mean - turned->middle) / turned->half;
  return glm::length(off) < 0.6;
}

// Where the stick went, if it went all the way round.
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

}  // namespace

Stills sorted_stills(std::span<const StickTrack> tracks, std::span<const Still> found) {
  const std::optional<Box> turned = turned_box(tracks);
  Places places;
  for (const Still& still : found) {
    if (may_be_home(still, turned)) places.add(still);
  }
  places.choose();
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

namespace {

constexpr double kPart_s = 0.02, kPiece_s = 1.0;
constexpr double kFewestReports = 8.0;  // that tell of noise
constexpr double kSpike = 4.5;          // standard deviations

double time_s(const StickTrack& track, std::int64_t time_ns) noexcept {
  const double whole_s = seconds_between(track.front().time_ns, track.back().time_ns);
  return seconds_between(track.front().time_ns, time_ns) - 0.5 * whole_s;
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

// Leaves out what lies far from the line through all; returns whether there was any.
bool take_spikes_out(std::vector<RestPoint>& points) {
  const RestTrend line = rest_trend(points);
  const RestNoise noise = noise_about(line, points);
  if (noise.freedom < kFewestReports) return false;
  const vec2 limit = kSpike * kSpike * noise.variance();
  return std::erase_if(points, [&](const RestPoint& point) {
           const vec2 off = point.place - line.at(point.time_s);
           return off.x * off.x > limit.x || off.y * off.y > limit.y;
         }) > 0;
}

RestNoise piece_noise(std::vector<RestPoint> points) {
  take_spikes_out(points);
  const RestNoise noise = noise_about(rest_trend(points), points);
  return noise.freedom < kFewestReports ? RestNoise{} : noise;
}

}  // namespace

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
  take_spikes_out(points);
  return points;
}

RestTrend rest_trend(std::span<const RestPoint> points) noexcept {
  RestTrend line;
  for (const RestPoint& point : points) {
    line.mean.weight += point.weight;
    line.mean.time_s += point.weight * point.time_s;
    line.mean.place += point.weight * point.place;
  }
  if (!(line.mean.weight > 0.0)) return line;
  line.mean.time_s /= line.mean.weight;
  line.mean.place /= line.mean.weight;
  vec2 product(0.0);
  for (const RestPoint& point : points) {
    const double t = point.time_s - line.mean.time_s;
    line.spread += point.weight * t * t;
    product += point.weight * t * (point.place - line.mean.place);
  }
  if (line.spread > 1e-9 * line.mean.weight) line.slope = product / line.spread;
  return line;
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

std::vector<RestPoint> rest_blocks(std::span<const RestPoint> points, int count) {
  std::vector<RestPoint> blocks(static_cast<std::size_t>(std::max(count, 1)));
  if (points.empty()) return {};
  const double begin_s = points.front().time_s;
  const double whole_s = std::max(points.back().time_s - begin_s, 1e-9);
  for (const RestPoint& point : points) {
    const double part = (point.time_s - begin_s) / whole_s * static_cast<double>(blocks.size());
    RestPoint& block = blocks[std::min(static_cast<std::size_t>(part), blocks.size() - 1)];
    block.weight += point.weight;
    block.time_s += point.weight * point.time_s;
    block.place += point.weight * point.place;
  }
  std::erase_if(blocks, [](const RestPoint& block) { return !(block.weight > 0.0); });
  for (RestPoint& block : blocks) {
    block.time_s /= block.weight;
    block.place /= block.weight;
  }
  return blocks;
}

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

namespace {

constexpr double kBlock_s = 0.1;
constexpr double kFewestRestReports = 5.0;
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
  if (evidence.weight < kFewestRestReports) return told;
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
