#include "stick/stick_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/numeric.h"

namespace gaitpad {

namespace {

constexpr PadAxis kStickAxes[2][2] = {{kLeftX, kLeftY}, {kRightX, kRightY}};
constexpr PadAxis kTriggerAxes[2] = {kLeftTrigger, kRightTrigger};

bool carries(const ReportLayout& report, PadAxis axis) noexcept {
  for (const AxisOp& op : report.axes)
    if (op.axis == axis) return true;
  return false;
}

bool has_axis(const PadLayout& layout, PadAxis axis) noexcept {
  for (const ReportLayout& report : layout.reports)
    if (carries(report, axis)) return true;
  return false;
}

template <typename Sample>
void append(std::vector<std::vector<Sample>>& tracks, bool is_new, const Sample& sample) {
  if (is_new || tracks.empty()) tracks.emplace_back();
  std::vector<Sample>& track = tracks.back();
  track.push_back(sample);
  // A damaged trace, or two reports in one poll, may have stamps that go back.
  if (track.size() > 1) {
    track.back().time_ns = std::max(sample.time_ns, track[track.size() - 2].time_ns);
  }
}

}  // namespace

bool has_stick(const PadLayout& layout, int side) noexcept {
  return has_axis(layout, kStickAxes[side][0]) && has_axis(layout, kStickAxes[side][1]);
}

bool has_trigger(const PadLayout& layout, int side) noexcept {
  return has_axis(layout, kTriggerAxes[side]);
}

double declared_step(const PadLayout& layout, PadAxis axis) noexcept {
  for (const ReportLayout& report : layout.reports) {
    for (const AxisOp& op : report.axes) {
      if (op.axis != axis || op.bits.max <= op.bits.min) continue;
      const double counts = static_cast<double>(op.bits.max) - static_cast<double>(op.bits.min);
      return (axis < kLeftTrigger && op.side == 0 ? 2.0 : 1.0) / counts;
    }
  }
  return 0.0;
}

bool PadTracker::add_report(const Report& report) {
  const ReportLayout* read = layout_of(*layout_, report);
  if (read == nullptr || !decode(*layout_, report, state_)) return false;
  // An axis that was never reported would seem to stand in its middle, so samples begin when both
  // axes of a stick are known.
  for (const AxisOp& op : read->axes) known_ |= 1u << op.axis;
  const auto is_known = [this](PadAxis axis) { return (known_ >> axis & 1u) != 0; };
  for (int side = 0; side < 2; ++side) {
    const PadAxis x = kStickAxes[side][0], y = kStickAxes[side][1];
    if ((carries(*read, x) || carries(*read, y)) && is_known(x) && is_known(y)) {
      append(tracks_.stick[side], is_cut_stick_[side],
             StickSample{report.time_ns, vec2(state_.axis[x], state_.axis[y])});
      is_cut_stick_[side] = false;
    }
    const PadAxis trigger = kTriggerAxes[side];
    if (carries(*read, trigger)) {
      append(tracks_.trigger[side], is_cut_trigger_[side],
             TriggerSample{report.time_ns, state_.axis[trigger]});
      is_cut_trigger_[side] = false;
    }
  }
  return true;
}

void PadTracker::cut() noexcept {
  is_cut_stick_ = {true, true};
  is_cut_trigger_ = {true, true};
  known_ = 0;
  state_ = PadState{};
}

PadTracks PadTracker::take_tracks() noexcept {
  is_cut_stick_ = {true, true};
  is_cut_trigger_ = {true, true};
  return std::exchange(tracks_, {});
}

std::vector<StickTrack> in_frame(const StickFrame& frame, std::vector<StickTrack> tracks) {
  for (StickTrack& track : tracks)
    for (StickSample& sample : track) sample.raw = in_frame(frame, sample.raw);
  return tracks;
}

vec2 median_of(std::span<const vec2> places) {
  std::vector<double> x, y;
  for (const vec2& place : places) {
    x.push_back(place.x);
    y.push_back(place.y);
  }
  return {median(std::move(x)), median(std::move(y))};
}

Extent extent_of(std::span<const StickTrack> tracks) noexcept {
  Extent extent;
  for (const StickTrack& track : tracks) {
    for (const StickSample& sample : track) {
      extent.least = glm::min(extent.least, sample.raw);
      extent.most = glm::max(extent.most, sample.raw);
    }
  }
  return extent;
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

namespace {

constexpr double kSmallestSpike = 0.03;    // least height of a spike, raw; less is noise
constexpr double kShortMovement_s = 0.04;  // no hand moves there and back in a shorter time
// Longest drop-out: a hand cannot move away and back in it, each within one report.
constexpr double kLongestDropOut_s = 0.12;
constexpr double kShortestDropOut_s = 0.0035;
// Longest interval at which drop-outs are searched: a spring's return takes two reports or more.
constexpr double kSlowestForDropOuts_s = 0.025;
constexpr double kFarthest = 4.0;  // greatest raw position; those beyond are damaged
// Latest time, so that sums of times fit in 64 bits.
constexpr std::int64_t kLatest_ns = 4'000'000'000'000'000'000;

bool is_place(const vec2& p) noexcept {
  return std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest;  // false also for not-a-number
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

// Length of the step from sample i - 1 to i.
double step_length(const StickTrack& track, std::size_t i) noexcept {
  return glm::length(track[i].raw - track[i - 1].raw);
}

struct Scale {
  double interval_s = 0.0;
  double smallest = kSmallestSpike;  // least height of a spike, raw
};

// A stick held against its end has small, one-sided noise, so a spike must be long compared with
// the steps of the whole track: 5 times their lower quartile.
double smallest_spike(const StickTrack& track) {
  constexpr std::size_t kMost = std::size_t{1} << 18;
  const std::size_t stride = track.size() / kMost + 1;
  std::vector<double> steps;
  for (std::size_t i = 1; i < track.size(); i += stride) steps.push_back(step_length(track, i));
  if (steps.empty()) return kSmallestSpike;
  const auto quarter = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
  std::nth_element(steps.begin(), quarter, steps.end());
  return std::max(kSmallestSpike, 5.0 * *quarter);
}

// Lengths of the steps next to a sample, nearest first. The silence of a pad that reports changes
// only counts as steps of 0.
struct Steps {
  std::array<double, 8> length{};
  std::size_t count = 0;
  void add(double step) noexcept {
    if (count < length.size()) length[count++] = step;
  }
};

// Up to four steps before and four behind, without those into and out of i .. i + length - 1.
std::array<Steps, 2> steps_around(const StickTrack& track, std::size_t i, std::size_t length,
                                  double interval_s) noexcept {
  constexpr std::size_t kEach = 4;
  std::array<Steps, 2> steps;
  const auto add_silence = [&](Steps& to, std::size_t at) {
    double silent = reports_stood(hold_s(track, at, interval_s), interval_s) - 1.5;
    for (; silent > 0.0 && to.count < kEach; silent -= 1.0) to.add(0.0);
  };
  for (std::size_t at = i - 1; steps[0].count < kEach; --at) {
    add_silence(steps[0], at);
    if (at == 0) break;
    steps[0].add(step_length(track, at));
  }
  for (std::size_t at = i + length; steps[1].count < kEach; ++at) {
    add_silence(steps[1], at);
    if (at + 1 >= track.size()) break;
    steps[1].add(step_length(track, at + 1));
  }
  return steps;
}

// Whether a step is far longer than all around it. A hand moves for several reports, so a real
// movement has long steps beside it; one or two of the neighbours may belong to another spike.
bool stands_out(double height, const std::array<Steps, 2>& around) noexcept {
  Steps all = around[0];
  for (std::size_t k = 0; k < around[1].count; ++k) all.add(around[1].length[k]);
  const auto end = all.length.begin() + static_cast<std::ptrdiff_t>(all.count);
  std::sort(all.length.begin(), end);
  const std::size_t third = all.count > 5 ? all.count - 3 : all.count / 2;
  return height > 3.0 * around[0].length[0] && height > 3.0 * around[1].length[0] &&
         height > 7.0 * all.length[all.count / 2] && height > 4.5 * all.length[third];
}

// Whether `place` lies in the same direction as `before` but nearer to the middle: the stick is
// turned through a sector of the gate that reaches less far, which is no fault of its reports.
bool is_weak_sector(const vec2& before, const vec2& place) noexcept {
  constexpr double kOut = 0.5, kSameDirection = 0.95;  // a raw distance; the cosine of an angle
  const double far = glm::length(before), near = glm::length(place);
  return far > kOut && near < far && glm::dot(before, place) > kSameDirection * far * near;
}

// A spike has sharp edges on both sides and returns to about where it began.
bool is_spike(const StickTrack& track, std::size_t i, std::size_t length, const Scale& scale) {
  const vec2& before = track[i - 1].raw;
  const vec2& after = track[i + length].raw;
  double least = 2.0 * kFarthest;
  for (const std::size_t edge :
       {i, i + length - 1}) {  // both ends, because a sound report may be between two spikes
    least = std::min(
        {least, glm::length(track[edge].raw - before), glm::length(track[edge].raw - after)});
  }
  if (least < scale.smallest || least < 2.0 * glm::length(after - before)) return false;
  if (is_weak_sector(before, track[i].raw)) return false;
  const double lasted_s = seconds_between(track[i].time_ns, track[i + length].time_ns);
  if (lasted_s > std::clamp(3.7 * scale.interval_s, kShortMovement_s, 2.0 * kShortMovement_s))
    return false;
  return stands_out(least, steps_around(track, i, length, scale.interval_s));
}

// The length of a spike in reports; 0 if none begins at i.
std::size_t spike_length(const StickTrack& track, std::size_t i, const Scale& scale) {
  if (step_length(track, i) < scale.smallest) return 0;
  for (std::size_t length = 1; length <= 3 && i + length < track.size(); ++length) {
    if (is_spike(track, i, length, scale)) return length;
  }
  return 0;
}

// Returns whether there were spikes.
bool remove_spikes(StickTrack& track, const Scale& scale, CleanTracks& counts) {
  bool is_any = false;
  for (std::size_t i = 1; i + 1 < track.size(); ++i) {
    const std::size_t length = spike_length(track, i, scale);
    if (length == 0) continue;
    for (std::size_t k = i; k < i + length; ++k) track[k].raw = track[i - 1].raw;
    is_any = true;
    ++counts.jump_count;
    counts.long_jump_count += length > 1;
    i += length - 1;
  }
  return is_any;
}

// The number of reports from i on that show a drop-out of this axis; 0: none begins there. The axis
// jumps to another value, stays there and jumps back, each within one report. A hand needs several.
std::size_t drop_out_length(const StickTrack& track, std::size_t i, int axis,
                            double interval_s) noexcept {
  // Least height and height of the plateau's noise, raw; a share of the height.
  constexpr double kSmallest = 0.2, kPlateau = 0.04, kOfHeight = 0.2;
  const auto at = [&](std::size_t k) { return track[std::min(k, track.size() - 1)].raw[axis]; };
  const double before = at(i - 1), height = std::fabs(at(i) - before);
  const double steady = kOfHeight * height;
  if (is_weak_sector(track[i - 1].raw, track[i].raw)) return 0;
  if (height < kSmallest || std::fabs(before - at(i - std::min<std::size_t>(i, 3))) > steady)
    return 0;
  std::size_t end = i + 1;
  while (end < track.size() && std::fabs(at(end) - at(i)) < kPlateau &&
         seconds_between(track[i].time_ns, track[end].time_ns) < kLongestDropOut_s) {
    ++end;
  }
  if (end >= track.size() || interval_s > kSlowestForDropOuts_s ||
      seconds_between(track[i].time_ns, track[end].time_ns) > kLongestDropOut_s) {
    return 0;
  }
  const bool is_back = std::fabs(at(end) - at(i)) > (1.0 - 2.0 * kOfHeight) * height &&
                       std::fabs(at(end) - before) < 2.0 * steady &&
                       std::fabs(at(end + 2) - at(end)) < steady;
  return is_back ? end - i : 0;
}

// Single reports, which a filter takes out, are left to remove_spikes().
void remove_drop_outs(StickTrack& track, double interval_s, CleanTracks& counts) {
  for (int axis = 0; axis < 2; ++axis) {
    for (std::size_t i = 1; i + 1 < track.size(); ++i) {
      const std::size_t length = drop_out_length(track, i, axis, interval_s);
      if (length == 0) continue;
      const double lasted_s = seconds_between(track[i].time_ns, track[i + length].time_ns);
      if (lasted_s < std::max(1.5 * interval_s, kShortestDropOut_s)) continue;
      for (std::size_t k = i; k < i + length; ++k) track[k].raw[axis] = track[i - 1].raw[axis];
      ++counts.drop_out_count;
      counts.drop_out_s += lasted_s;
      i += length - 1;
    }
  }
}

// Removes a first or last report that stands out. It has only one neighbour, so a movement that has
// just begun may lose a report.
void remove_odd_ends(StickTrack& track, const Scale& scale) {
  if (track.size() < 6) return;
  const std::size_t last = track.size() - 1;
  const auto is_out = [&](std::size_t step, const std::array<Steps, 2>& around) {
    const double height = step_length(track, step);
    return height >= scale.smallest && stands_out(height, around);
  };
  if (is_out(last, steps_around(track, last, 1, scale.interval_s)))
    track[last].raw = track[last - 1].raw;
  if (is_out(1, {Steps{}, steps_around(track, 1, 0, scale.interval_s)[1]}))
    track[0].raw = track[1].raw;
}

}  // namespace

CleanTracks clean_tracks(std::span<const StickTrack> tracks) {
  CleanTracks clean;
  clean.tracks.reserve(tracks.size());
  for (const StickTrack& track : tracks) clean.tracks.push_back(sound_track(track));
  const double interval_s = typical_interval_s(clean.tracks);
  for (StickTrack& track : clean.tracks) {
    const Scale scale{interval_s, smallest_spike(track)};
    remove_drop_outs(track, interval_s, clean);
    // A spike beside another one is found only after that one was removed.
    for (int pass = 0; pass < 3 && remove_spikes(track, scale, clean); ++pass) {
    }
    remove_odd_ends(track, scale);
  }
  return clean;
}

namespace {

// Number of intervals that is enough for a median.
constexpr std::size_t kMostIntervals = std::size_t{1} << 20;
constexpr std::size_t kFewestIntervals = 20;
constexpr double kSilence_s = 0.1, kSlowest_s = 0.5;  // longer: silence; on a slow pad
constexpr double kBurst_s = 0.0007;  // nearly all pads send at most 1000 reports a second
// Time between reports that is assumed if there are too few.
constexpr double kUnknownInterval_s = 0.004;
constexpr double kFrozen_s = 0.07;

// Seconds between successive reports; those during movements if there are enough, because every pad
// reports while it moves.
std::vector<double> intervals(std::span<const StickTrack> tracks) {
  std::vector<double> all, moving, slow;
  for (const StickTrack& track : tracks) {
    std::size_t back = 0;  // index of the sample 50 ms ago
    for (std::size_t i = 1; i < track.size() && all.size() < kMostIntervals; ++i) {
      const double interval_s = seconds_between(track[i - 1].time_ns, track[i].time_ns);
      while (seconds_between(track[back].time_ns, track[i - 1].time_ns) > 0.05) ++back;
      if (interval_s > kSilence_s && interval_s < kSlowest_s &&
          glm::length(track[i].raw - track[i - 1].raw) > 0.05) {
        slow.push_back(interval_s);
      }
      if (interval_s < 0.0 || interval_s > kSilence_s) continue;
      all.push_back(interval_s);
      if (glm::length(track[i - 1].raw - track[back].raw) > 0.05) moving.push_back(interval_s);
    }
  }
  if (slow.size() > all.size()) return slow;
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
  const std::vector<double> found = intervals(tracks);
  if (found.size() < kFewestIntervals) return {};
  const double usual = median(found);
  const Spacing all = spacing_within(found, 0.0, kSilence_s);
  // If most reports come in bursts, the pauses between bursts belong to the rate.
  if (usual < kBurst_s && all.mean_s > 2.0 * usual) return all;
  const double mean_s = spacing_within(found, 0.5 * usual, 1.5 * usual).mean_s;
  if (!(mean_s > 0.0)) return {};
  return Spacing{mean_s, spacing_within(found, 0.0, 1.5 * mean_s).deviation_s};
}

// Counts lost reports, not late ones: five intervals together must also be too long by half an
// interval.
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

// Ascending, without repeats.
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
  constexpr double kRounding = 1e-6;  // rounding error, because axes are decoded to floats
  const auto end = std::unique(values.begin(), values.end(),
                               [](double a, double b) { return b - a <= kRounding; });
  values.erase(end, values.end());
  return values;
}

// The stick's position `seconds` after sample i; negative: before it.
vec2 place_at(const StickTrack& track, std::size_t i, double seconds) noexcept {
  while (seconds < 0.0 && i > 0 &&
         seconds_between(track[i - 1].time_ns, track[i].time_ns) <= -seconds) {
    seconds += seconds_between(track[i - 1].time_ns, track[i].time_ns);
    --i;
  }
  while (seconds > 0.0 && i + 1 < track.size() &&
         seconds_between(track[i].time_ns, track[i + 1].time_ns) <= seconds) {
    seconds -= seconds_between(track[i].time_ns, track[i + 1].time_ns);
    ++i;
  }
  return track[i].raw;
}

// Whether the values of these axes (one or both), the same from `first` to `last`, were frozen:
// afterwards they jump by far more than they move in the next reports, and something moved
// meanwhile. `quiet`: the chance that noise repeats the value so often.
bool is_frozen(const StickTrack& track, std::size_t first, std::size_t last, const vec2& axes,
               double quiet) {
  // kRun_s is in seconds; the others are raw distances.
  constexpr double kMoved = 0.1, kRun_s = 0.03, kRunning = 0.02, kOut = 0.4;
  // kInside: farther out the end of the range may hide the noise.
  constexpr double kUnlikely = 1e-6, kInside = 0.7;
  // Greatest raw speed of a stick that snaps back, and its tolerance.
  constexpr double kSpring_per_s = 60.0, kSlack = 0.2;
  if (last + 1 >= track.size()) return false;
  const vec2 place = track[last].raw, next = track[last + 1].raw;
  const double jump = glm::length((next - place) * axes);
  const vec2 other = vec2(1.0) - axes;
  double least = 4.0, most = -4.0;
  for (std::size_t k = first; k <= last; ++k) {
    least = std::min(least, glm::dot(track[k].raw, other));
    most = std::max(most, glm::dot(track[k].raw, other));
  }
  const bool is_beside = most - least > kMoved;
  if (is_beside && quiet < kUnlikely && std::fabs(glm::dot(place, axes)) < kInside) return true;
  double usual = 0.0;
  for (std::size_t k = last + 2; k < std::min(last + 6, track.size()); ++k)
    usual = std::max(usual, glm::length((track[k].raw - track[k - 1].raw) * axes));
  if (jump < kMoved || jump < 2.0 * usual + 0.5 * kMoved) return false;
  const bool is_out = glm::length(next) > kOut;
  if (axes != vec2(1.0)) {
    // Along a straight side of the gate one axis stands still, until the stick is let go.
    const double pause_s = seconds_between(track[last].time_ns, track[last + 1].time_ns);
    return is_beside && (is_out || jump > kSpring_per_s * pause_s + kSlack);
  }
  // The stick was turned, or its noise was gone. A thumb that pauses slows down first, and has
  // noise.
  const bool has_room = std::min(std::fabs(place.x), std::fabs(place.y)) < kInside;
  if (is_out && has_room && quiet < kUnlikely) return true;
  return is_out && glm::length(track[first].raw - place_at(track, first, -kRun_s)) > kRunning &&
         glm::length(place_at(track, last + 1, kRun_s) - next) > kRunning;
}

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
  timing.gap_count = 0;
  for (const StickTrack& track : tracks) *timing.gap_count += gaps_of(track, found->mean_s);
  return timing;
}

double quantisation_step(std::span<const StickTrack> tracks, int axis, double declared) {
  const std::vector<double> values = distinct_values(tracks, axis);
  double least = 4.0;
  for (std::size_t i = 1; i < values.size(); ++i)
    least = std::min(least, values[i] - values[i - 1]);
  // Values without steps may also lie close to each other, but seldom, and not at multiples.
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

std::int64_t stuck_values(std::span<const StickTrack> tracks, double interval_s,
                          const vec2& repeats) {
  const double least_s = std::max(kFrozen_s, 5.0 * interval_s);
  std::int64_t stuck = 0;
  for (const StickTrack& track : tracks) {
    for (const vec2& axes : {vec2(1.0), vec2(1.0, 0.0), vec2(0.0, 1.0)}) {
      for (std::size_t first = 0, last; first < track.size(); first = last + 1) {
        last = first;
        while (last + 1 < track.size() &&
               (track[last + 1].raw - track[first].raw) * axes == vec2(0.0))
          ++last;
        if (last + 1 >= track.size()) break;
        const double frozen_s = seconds_between(track[first].time_ns, track[last + 1].time_ns);
        const double quiet =
            std::pow(std::max(glm::dot(repeats, axes), 0.1), static_cast<double>(last - first));
        if (frozen_s >= least_s && is_frozen(track, first, last, axes, quiet)) ++stuck;
      }
    }
  }
  return stuck;
}

}  // namespace gaitpad
