// A stick's raw positions over time: collected from reports, with wrong ones removed, and measures
// of the reports themselves (rate, steps, gaps). All analysis of sticks reads these tracks.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gaitpad/calibration.h"
#include "gaitpad/decode.h"

namespace gaitpad {

// Raw position: fractions of half the logical range from its middle, -1..1, +x right, +y forward as
// the pad's layout has it.
struct StickSample {
  std::int64_t time_ns = 0;
  vec2 raw{0.0};
};
// Reports from plugging in to unplugging, in the order of time. Most pads report changes only, so a
// position holds until the next sample.
using StickTrack = std::vector<StickSample>;

struct TriggerSample {
  std::int64_t time_ns = 0;
  double raw = 0.0;  // position, 0..1
};
using TriggerTrack = std::vector<TriggerSample>;

// One pad's tracks, from one recording or several. Unplugging ends a track.
struct PadTracks {
  std::array<std::vector<StickTrack>, 2> stick;      // tracks of the left and the right stick
  std::array<std::vector<TriggerTrack>, 2> trigger;  // tracks of the left and the right trigger
};

// ---- Collecting tracks

// Whether the layout has the control; side 0 is left, 1 is right.
bool has_stick(const PadLayout& layout, int side) noexcept;
bool has_trigger(const PadLayout& layout, int side) noexcept;
// One count of the axis' field in raw units; 0 if the layout has no such axis.
double declared_step(const PadLayout& layout, PadAxis axis) noexcept;

// Collects tracks from reports. A report that does not decode, or does not carry an axis, adds
// nothing to it.
class PadTracker {
 public:
  explicit PadTracker(const PadLayout& layout) : layout_(&layout) {}
  bool add_report(const Report& report);  // False: the report does not decode.
  void cut() noexcept;                    // the pad was unplugged, or another recording begins
  const PadTracks& tracks() const noexcept { return tracks_; }
  PadTracks take_tracks() noexcept;  // moves the tracks out; the next report begins new ones
  const PadState& state() const noexcept { return state_; }

 private:
  const PadLayout* layout_;
  PadState state_;
  std::uint32_t known_ = 0;  // axes (bits) that were reported since the last cut
  std::array<bool, 2> is_cut_stick_{true, true}, is_cut_trigger_{true, true};
  PadTracks tracks_;
};

// Turns every sample into the frame.
std::vector<StickTrack> in_frame(const StickFrame& frame, std::vector<StickTrack> tracks);

// The median (base/numeric.h) of each axis.
vec2 median_of(std::span<const vec2> places);

// ---- Where the stick went

struct Extent {
  vec2 least{4.0}, most{-4.0};  // least and greatest position of each axis
  vec2 middle() const noexcept { return 0.5 * (least + most); }
  vec2 half() const noexcept { return 0.5 * (most - least); }
};
Extent extent_of(std::span<const StickTrack> tracks) noexcept;

// ---- How long a position stood

// Seconds from one time to a later one; any two 64-bit times are allowed.
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept;

// A pad that is silent for longer than this may be gone: no position counts for longer.
inline constexpr double kMaxHold_s = 2.0;
// The time for which sample i stood: until the next sample; the last one for one interval.
double hold_s(const StickTrack& track, std::size_t i, double interval_s) noexcept;
// The number of reports that a hold stands for: 1 if the next report followed within 1.5 intervals,
// else as many as were left out (nothing changed) or lost. Means at rest use this as their weight,
// so that a pad that reports changes only gives the same means as one that streams, and jitter of
// the stamps has no weight.
double reports_stood(double hold_s, double interval_s) noexcept;

// ---- Cleaning

struct CleanTracks {
  // Tracks with as many samples as before. A sample that does not count (no number, out of range, a
  // spike) repeats the position before it; times never go back.
  std::vector<StickTrack> tracks;
  std::int64_t jump_count = 0;  // spikes: to another place and back within three reports
  std::int64_t long_jump_count =
      0;  // number of jumps that the median of three reports lets through
  // An axis jumped to another value, stayed there for two reports to 0.12 s, and jumped back.
  std::int64_t drop_out_count = 0;
  double drop_out_s = 0.0;  // duration of all drop-outs together
};
CleanTracks clean_tracks(std::span<const StickTrack> tracks);

// ---- The reports themselves

// Seconds between successive reports. For a pad that reports changes only: while the stick moves.
// Robust against lost reports and bursts; 4 ms if there are too few reports.
double typical_interval_s(std::span<const StickTrack> tracks);

struct ReportTiming {
  std::optional<double> rate_hz, jitter_ms;  // none: there are too few reports
  // None: there are too few reports, or the pad is silent at rest.
  std::optional<std::int64_t> gap_count;
};
// `repeats_expected`: the chance that a report at rest repeats the one before it, given noise and
// step. A pad that repeats less often reports changes only, so its gaps cannot be counted.
ReportTiming report_timing(std::span<const StickTrack> tracks, double repeats_expected);

// The smallest distance between neighbouring values that occurs often enough to be a step, else
// `declared`. Axis 0 is x, 1 is y.
double quantisation_step(std::span<const StickTrack> tracks, int axis, double declared);

// The number of times that an axis, or both, froze for 70 ms or more while the other one, or a
// turn, moved on. `repeats`: for each axis, the chance that noise repeats a value at rest.
std::int64_t stuck_values(std::span<const StickTrack> tracks, double interval_s,
                          const vec2& repeats);

}  // namespace gaitpad
