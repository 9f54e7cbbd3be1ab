#include "stick/stick_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "stick/statistics.h"

namespace gaitpad {

namespace {

constexpr PadAxis kStickAxes[2][2] = {{kLeftX, kLeftY}, {kRightX, kRightY}};
constexpr PadAxis kTriggerAxes[2] = {kLeftTrigger, kRightTrigger};

bool tells_of(const ReportLayout& report, PadAxis axis) noexcept {
  for (const AxisOp& op : report.axes)
    if (op.axis == axis) return true;
  return false;
}

bool has_axis(const PadLayout& layout, PadAxis axis) noexcept {
  for (const ReportLayout& report : layout.reports)
    if (tells_of(report, axis)) return true;
  return false;
}

template <typename Sample>
void append(std::vector<std::vector<Sample>>& tracks, bool is_new, const Sample& sample) {
  if (is_new || tracks.empty()) tracks.emplace_back();
  // Stamps of a damaged trace or of two reports in one poll: time never goes back in a track.
  std::vector<Sample>& track = tracks.back();
  track.push_back(sample);
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

bool PadTracker::take(const Report& report) {
  const ReportLayout* told = layout_of(*layout_, report);
  if (told == nullptr || !decode(*layout_, report, state_)) return false;
  // An axis that no report has told of yet would be taken for one at its middle.
  for (const AxisOp& op : told->axes) known_ |= 1u << op.axis;
  const auto is_known = [this](PadAxis axis) { return (known_ >> axis & 1u) != 0; };
  for (int side = 0; side < 2; ++side) {
    const PadAxis x = kStickAxes[side][0], y = kStickAxes[side][1];
    if ((tells_of(*told, x) || tells_of(*told, y)) && is_known(x) && is_known(y)) {
      append(tracks_.stick[side], is_cut_stick_[side],
             StickSample{report.time_ns, vec2(state_.axis[x], state_.axis[y])});
      is_cut_stick_[side] = false;
    }
    const PadAxis trigger = kTriggerAxes[side];
    if (tells_of(*told, trigger)) {
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

namespace {

constexpr double kSmallestSpike = 0.03;    // raw; less is noise
constexpr double kShortMovement_s = 0.04;  // a hand's there and back is longer
constexpr double kFarthest = 4.0;          // raw; nothing lies farther out, whoever made the track
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

struct Scale {
  double interval_s = 0.0;
  double smallest = kSmallestSpike;  // raw
};

// Noise of a stick held against its end is small and one-sided, so a step counts only if it is long
// for the whole track.
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

// Steps of the reports next to a place, nearest first; a pad that reports changes only was silent
// where it stood, which is steps of 0.
struct Steps {
  std::array<double, 8> length{};
  std::size_t count = 0;
  void add(double step) noexcept {
    if (count < length.size()) length[count++] = step;
  }
};

// Up to four each way, those into and out of i .. i + length - 1 left out.
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

// Whether it stands out from all of them. Hands move several reports long, so the neighbourhood of
// a real movement has long steps too; one or two may belong to another spike.
bool stands_out(double height, const std::array<Steps, 2>& around) noexcept {
  Steps all = around[0];
  for (std::size_t k = 0; k < around[1].count; ++k) all.add(around[1].length[k]);
  const auto end = all.length.begin() + static_cast<std::ptrdiff_t>(all.count);
  std::sort(all.length.begin(), end);
  const std::size_t third = all.count > 5 ? all.count - 3 : all.count / 2;
  return height > 3.0 * around[0].length[0] && height > 3.0 * around[1].length[0] &&
         height > 7.0 * all.length[all.count / 2] && height > 4.5 * all.length[third];
}

// A spike has sharp edges on both sides and comes back to about where it left.
bool is_spike(const StickTrack& track, std::size_t i, std::size_t length, const Scale& scale) {
  const vec2& before = track[i - 1].raw;
  const vec2& after = track[i + length].raw;
  double least = 2.0 * kFarthest;
  for (const std::size_t edge : {i, i + length - 1}) {  // a sound report may stand between two
    least = std::min(
        {least, glm::length(track[edge].raw - before), glm::length(track[edge].raw - after)});
  }
  if (least < scale.smallest || least < 2.0 * glm::length(after - before)) return false;
  const double lasted_s = seconds_between(track[i].time_ns, track[i + length].time_ns);
  if (lasted_s > std::clamp(3.7 * scale.interval_s, kShortMovement_s, 2.0 * kShortMovement_s))
    return false;
  return stands_out(least, steps_around(track, i, length, scale.interval_s));
}

// 0 where none begins at i.
std::size_t spike_length(const StickTrack& track, std::size_t i, const Scale& scale) {
  if (step_length(track, i) < scale.smallest) return 0;
  for (std::size_t length = 1; length <= 3 && i + length < track.size(); ++length) {
    if (is_spike(track, i, length, scale)) return length;
  }
  return 0;
}

std::int64_t take_spikes_out(StickTrack& track, const Scale& scale) {
  std::int64_t spikes = 0;
  for (std::size_t i = 1; i + 1 < track.size(); ++i) {
    const std::size_t length = spike_length(track, i, scale);
    if (length == 0) continue;
    for (std::size_t k = i; k < i + length; ++k) track[k].raw = track[i - 1].raw;
    ++spikes;
    i += length - 1;
  }
  return spikes;
}

// The first and the last report have one neighbour; a hand that has just begun to move loses one.
void take_ends_out(StickTrack& track, const Scale& scale) {
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
    // One that stands beside another is seen only once that is out of the way.
    for (int pass = 0; pass < 3; ++pass) {
      const std::int64_t spikes = take_spikes_out(track, scale);
      clean.jumps += spikes;
      if (spikes == 0) break;
    }
    take_ends_out(track, scale);
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
