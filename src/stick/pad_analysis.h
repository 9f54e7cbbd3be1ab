// Turns measurements into advice: a calibration with its zones, and a verdict in plain words.
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
  StickCalibration calibration;  // parts that are not known have the values for an unknown stick
  double inner_zone = 0.0;       // raw radius: max(0.05, 3 sigma + hysteresis)
  double outer_zone = 0.0;       // raw radius
  Verdict verdict = Verdict::unknown;
  std::string reason;  // the reason of the verdict: one sentence with numbers
  // Whether these parts of `calibration` were seen and are certain.
  bool has_centre = false, has_range = false;
};
// The positions of `statistics` are given in `frame`.
StickAdvice stick_advice(const StickStatistics& statistics, const StickFrame& frame);
TriggerCalibration trigger_advice(const TriggerStatistics& statistics) noexcept;

// The whole pad: statistics of its sticks and triggers, and the calibration that follows.

struct StickAnalysis {
  std::vector<StickTrack> tracks;  // tracks in the frame of the advice
  StickStatistics statistics;
  StickAdvice advice;
};
// Results for the left and the right control; none if the pad has no such control.
struct PadAnalysis {
  std::array<std::optional<StickAnalysis>, 2> stick;
  std::array<std::optional<TriggerStatistics>, 2> trigger;
};
PadAnalysis analysis_of(const PadLayout& layout, const PadTracks& tracks,
                        const std::array<StickFrame, 2>& frames);

// Whether a centre is known, so that the stick can be compared with an earlier calibration.
bool has_a_centre(const PadAnalysis& analysis) noexcept;
// Whether the verdict on the stick (0 left, 1 right) is not `unknown`: a file takes it over.
bool is_known(const PadAnalysis& analysis, std::size_t side) noexcept;
// Whether the analysis can calibrate anything: a stick is known.
bool is_useful(const PadAnalysis& analysis) noexcept;
// The reason why the analysis is not useful: a sentence without a full stop.
std::string why_useless(const PadAnalysis& analysis);
// Writes the advice for sticks whose verdict is not `unknown` into `file`, and triggers that were
// pressed. The rest of the calibration that `file` holds stays: an unknown stick, the range of a
// stick that was not turned along its rim, a trigger that was never pressed.
void take_advice(const PadAnalysis& analysis, CalibrationFile& file);
// The calibration `then` with everything that was seen today, even of unknown sticks: for a
// comparison.
CalibrationFile seen_today(const PadAnalysis& analysis, const CalibrationFile& then);

}  // namespace gaitpad
