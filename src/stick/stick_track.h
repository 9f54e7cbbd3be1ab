// What the analysis of a stick looks at: its raw positions in time.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "hid/decode.h"
#include "stick/calibration.h"

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

}  // namespace gaitpad
