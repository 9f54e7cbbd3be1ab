// All of one pad: its sticks and triggers measured, and the calibration that follows.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "stick/recommendation.h"
#include "stick/statistics.h"

namespace gaitpad {

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
