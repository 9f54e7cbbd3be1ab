// From measurements to advice: a calibration with its zones, and a verdict in plain words.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/calibration.h"
#include "stick/statistics.h"

namespace gaitpad {

enum class Verdict : std::uint8_t { good, worn, replace, unknown };
const char* name_of(Verdict verdict) noexcept;

struct StickAdvice {
  StickCalibration calibration;  // unknown parts are as for an unknown stick
  double inner_zone = 0.0;       // raw: max(0.05, 3 sigma + hysteresis)
  double outer_zone = 0.0;       // raw
  Verdict verdict = Verdict::unknown;
  std::string reason;  // one sentence with its numbers
  // Parts of `calibration` that were seen and are not doubted: what a file may take over.
  bool has_centre = false, has_range = false;
};
// `statistics` are in `frame`.
StickAdvice stick_advice(const StickStatistics& statistics, const StickFrame& frame);
TriggerCalibration trigger_advice(const TriggerStatistics& statistics) noexcept;

// The whole pad: statistics of its sticks and triggers, and the calibration that follows.

struct StickAnalysis {
  std::vector<StickTrack> tracks;  // in the frame of the advice
  StickStatistics statistics;
  StickAdvice advice;
};
struct PadAnalysis {  // left, right; none if the pad has no such control
  std::array<std::optional<StickAnalysis>, 2> stick;
  std::array<std::optional<TriggerStatistics>, 2> trigger;
};
PadAnalysis analysis_of(const PadLayout& layout, const PadTracks& tracks,
                        const std::array<StickFrame, 2>& frames);

// Whether it can calibrate anything: the advice for a stick has a centre.
bool is_useful(const PadAnalysis& analysis) noexcept;
// Writes the advice into `file`. The calibration that `file` holds stays where nothing was
// measured: a stick without a sure centre, the range of a stick that was not turned along its rim,
// a trigger that was never pressed.
void take_advice(const PadAnalysis& analysis, CalibrationFile& file);

}  // namespace gaitpad
