#include "stick/stick_track.h"

#include <algorithm>
#include <utility>

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

}  // namespace gaitpad
