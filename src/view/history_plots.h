// The plots of a session's last seconds.
#pragma once
#include <cstddef>

#include "draw/plot.h"
#include "draw/theme.h"
#include "session/history.h"

namespace gaitpad {

// In all plots below x is the time in seconds before now.

// Hip, knee and ankle, as in WalkerSample::joint_rad.
inline constexpr std::size_t kShownJointCount = 3;

// The newest samples [begin, end): a walker's last two cycles, or two seconds if it has not walked
// that far.
struct GraphSpan {
  std::size_t begin = 0, end = 0;
  double tick_s = 1.0 / 240.0;
  PlotRange x;  // seconds before now, from a negative number to 0
  double x_of(std::size_t index) const noexcept {
    return -static_cast<double>(end - 1 - index) * tick_s;
  }
};
GraphSpan graph_span(const History& history, int walker, int rate_hz);

// A joint's angle in degrees, one curve for each walker; the curve of walker `chosen` (-1: none) is
// thicker.
Plot joint_plot(const History& history, const GraphSpan& span, Side leg, std::size_t joint,
                const Theme& theme, int chosen, double least_span_deg);
// Heights of both heels above the ground below them in cm, with marks at lift, peak and landing.
Plot heel_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
// The stage, and the times at which each heel and toe is planted.
SpanPlot stage_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);

// The inverse kinematics of a walker's legs.
Plot iteration_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
Plot error_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
// Duration of each tick in ms over the whole history.
Plot tick_time_plot(const History& history, int rate_hz, const Theme& theme);

}  // namespace gaitpad
