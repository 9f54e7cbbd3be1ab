// From what was measured to what to do: zones, a calibration and a verdict in plain words.
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
  StickCalibration calibration;  // what is not known is as for an unknown stick
  double inner_zone = 0.0;       // raw: max(0.05, 3 sigma + hysteresis)
  double outer_zone = 0.0;       // raw
  Verdict verdict = Verdict::unknown;
  std::string reason;  // one sentence with its numbers
};
// `statistics` are in `frame`.
StickAdvice stick_advice(const StickStatistics& statistics, const StickFrame& frame);
TriggerCalibration trigger_advice(const TriggerStatistics& statistics) noexcept;

// All of one pad: its sticks and triggers measured, and the calibration that follows.

struct StickAnalysis {
  std::vector<StickTrack> tracks;  // in the frame of the advice
  StickStatistics statistics;
  StickAdvice advice;
};
struct PadAnalysis {  // left, right; none where the pad has no such control
  std::array<std::optional<StickAnalysis>, 2> stick;
  std::array<std::optional<TriggerStatistics>, 2> trigger;
};
PadAnalysis analysis_of(const PadLayout& layout, const PadTracks& tracks,
                        const std::array<StickFrame, 2>& frames);

// Whether anything can be calibrated by it: a stick's centre is known.
bool is_useful(const PadAnalysis& analysis) noexcept;
// `file` comes with the calibration so far, which stays where nothing was measured: a stick without
// a known centre, the range of one that was never turned, a trigger that was never pressed.
void take_advice(const PadAnalysis& analysis, CalibrationFile& file);

}  // namespace gaitpad
