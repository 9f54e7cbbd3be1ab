// What the analysis of a stick looks at: its raw positions in time.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gaitpad/calibration.h"
#include "gaitpad/decode.h"

namespace gaitpad {

// Raw position, fractions of half the logical range from its middle: -1..1, +x right, +y forward as
// the pad's layout has it.
struct StickSample {
  std::int64_t time_ns = 0;
  vec2 raw{0.0};
};
// Reports of one uninterrupted stay of the pad, in the order of time. Most pads report changes
// only, so a position holds until the next sample.
using StickTrack = std::vector<StickSample>;

struct TriggerSample {
  std::int64_t time_ns = 0;
  double raw = 0.0;  // 0..1
};
using TriggerTrack = std::vector<TriggerSample>;

// Everything about one pad, of one recording or several: a track ends where the pad was unplugged.
struct PadTracks {
  std::array<std::vector<StickTrack>, 2> stick;      // left, right
  std::array<std::vector<TriggerTrack>, 2> trigger;  // left, right
};

// What a pad's layout says of an axis: false where it has none.
bool has_stick(const PadLayout& layout, int side) noexcept;  // 0 left, 1 right
bool has_trigger(const PadLayout& layout, int side) noexcept;
// Of one count of the axis' field, raw; 0 where it has none.
double declared_step(const PadLayout& layout, PadAxis axis) noexcept;

// Makes tracks out of reports. Reports that do not decode, or do not tell of the axis, add nothing.
class PadTracker {
 public:
  explicit PadTracker(const PadLayout& layout) : layout_(&layout) {}
  bool take(const Report& report);  // false: does not decode
  void cut() noexcept;              // the pad went, or another recording begins
  const PadTracks& tracks() const noexcept { return tracks_; }
  PadTracks take_tracks() noexcept;  // and forgets them: the next report begins new ones
  const PadState& state() const noexcept { return state_; }

 private:
  const PadLayout* layout_;
  PadState state_;
  std::uint32_t known_ = 0;  // axes (bits) that reports have told of since the last cut
  std::array<bool, 2> is_cut_stick_{true, true}, is_cut_trigger_{true, true};
  PadTracks tracks_;
};

// Every sample as it is in the frame.
std::vector<StickTrack> in_frame(const StickFrame& frame, std::vector<StickTrack> tracks);

// A stick's tracks without what would mislead: positions that are no numbers, time that goes back,
// spikes. And how long a position stood for, which all means at rest are weighted by.

struct CleanTracks {
  // The same samples at the same places; one that does not count repeats the one before it.
  std::vector<StickTrack> tracks;
  std::int64_t jumps = 0;  // spikes: another place and back within three reports
};
CleanTracks clean_tracks(std::span<const StickTrack> tracks);

// From one time to a later one; for any two 64-bit times.
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept;

// A silent pad may as well be gone: longer than this nothing is believed to have stood.
inline constexpr double kMaxHold_s = 2.0;
// How long sample i is known to have stood: until the next one, the last one for one interval.
double hold_s(const StickTrack& track, std::size_t i, double interval_s) noexcept;
// How many reports that is: one where the next followed soon, else as many as were left out because
// nothing changed, or lost. So a pad that reports changes only has the same means as one that
// streams, and jitter of the time stamps is no weight.
double reports_stood(double hold_s, double interval_s) noexcept;

}  // namespace gaitpad
