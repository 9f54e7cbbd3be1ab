#include "stick/pad_analysis.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaitpad {
namespace {

bool is_turned(const StickStatistics& s) noexcept {
  return s.min_x && s.max_x && s.min_y && s.max_y;
}

StickAnalysis stick_analysis(std::vector<StickTrack> tracks, const vec2& step,
                             const StickFrame& frame) {
  StickAnalysis analysis;
  analysis.tracks = in_frame(frame, std::move(tracks));
  analysis.statistics = stick_statistics(analysis.tracks, step);
  analysis.advice = stick_advice(analysis.statistics, frame);
  return analysis;
}

vec2 step_in_frame(const PadLayout& layout, int side, const StickFrame& frame) {
  const PadAxis x = side == 0 ? kLeftX : kRightX, y = side == 0 ? kLeftY : kRightY;
  return glm::abs(in_frame(frame, vec2(declared_step(layout, x), declared_step(layout, y))));
}

// The zones of an untried stick are wide; a range from an earlier day still fits around the new
// centre, as long as it surrounds it.
void take_centre(const StickCalibration& advice, StickCalibration& calibration) {
  const auto take = [](double centre, AxisCalibration& axis) {
    constexpr double kLeastHalfRange = 0.25;
    if (centre - axis.min < kLeastHalfRange || axis.max - centre < kLeastHalfRange) axis = {};
    axis.centre = centre;
  };
  const bool is_same_frame = advice.frame == calibration.frame;
  if (!is_same_frame) calibration = StickCalibration{};
  calibration.frame = advice.frame;
  take(advice.x.centre, calibration.x);
  take(advice.y.centre, calibration.y);
  calibration.inner = advice.inner;
  calibration.sideways = advice.sideways;
  calibration.outer = std::max(calibration.outer, calibration.inner + 0.05);
}

// A file is for people, too: 0.00001 is a third of a step of 16 bits.
double readable(double value) noexcept { return std::round(value * 1e5) / 1e5 + 0.0; }

void make_readable(StickCalibration& c) noexcept {
  for (AxisCalibration* axis : {&c.x, &c.y})
    for (double* number : {&axis->min, &axis->centre, &axis->max}) *number = readable(*number);
  for (double* number : {&c.inner, &c.outer, &c.sideways}) *number = readable(*number);
}

TriggerCalibration readable(const TriggerCalibration& trigger) noexcept {
  return {readable(trigger.released), readable(trigger.pressed)};
}

std::optional<double> readable(const std::optional<double>& value) noexcept {
  return value ? std::optional(readable(*value)) : std::nullopt;
}

StickMeasured measured(const StickStatistics& s) {
  const auto worse = [](const vec2& v) { return std::max(v.x, v.y); };
  StickMeasured measured;
  if (s.sigma) measured.sigma = readable(worse(*s.sigma));
  measured.hysteresis = readable(s.hysteresis);
  measured.drift_per_s = readable(s.drift_per_s);
  measured.circularity_error = readable(s.circularity_error);
  return measured;
}

}  // namespace

PadAnalysis analysis_of(const PadLayout& layout, const PadTracks& tracks,
                        const std::array<StickFrame, 2>& frames) {
  PadAnalysis analysis;
  for (int side = 0; side < 2; ++side) {
    const auto i = static_cast<std::size_t>(side);
    if (has_stick(layout, side)) {
      analysis.stick[i] =
          stick_analysis(tracks.stick[i], step_in_frame(layout, side, frames[i]), frames[i]);
    }
    if (has_trigger(layout, side)) analysis.trigger[i] = trigger_statistics(tracks.trigger[i]);
  }
  return analysis;
}

bool is_useful(const PadAnalysis& analysis) noexcept {
  const auto is_known = [](const auto& stick) { return stick && stick->statistics.centre; };
  return is_known(analysis.stick[0]) || is_known(analysis.stick[1]);
}

void take_advice(const PadAnalysis& analysis, CalibrationFile& file) {
  StickCalibration* const sticks[] = {&file.calibration.left, &file.calibration.right};
  TriggerCalibration* const triggers[] = {&file.calibration.left_trigger,
                                          &file.calibration.right_trigger};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (stick && stick->statistics.centre) {
      if (is_turned(stick->statistics)) {
        *sticks[i] = stick->advice.calibration;
      } else {
        take_centre(stick->advice.calibration, *sticks[i]);
      }
      make_readable(*sticks[i]);
      file.measured[i] = measured(stick->statistics);
    }
    if (analysis.trigger[i] && analysis.trigger[i]->pressed)
      *triggers[i] = readable(trigger_advice(*analysis.trigger[i]));
  }
}

}  // namespace gaitpad
