// The plots that the panels show of the last seconds of a session.
#pragma once
#include <cstddef>

#include "draw/plot.h"
#include "draw/theme.h"
#include "session/history.h"

namespace gaitpad {

// In all plots below x is the time in seconds before now.

inline constexpr std::size_t kShownJointCount = 3;  // hip, knee, ankle: WalkerSample::joint_rad

// The samples [begin, end) up to now that are as long as a walker's last two cycles, or two seconds
// if it has not walked so far.
struct GraphSpan {
  std::size_t begin = 0, end = 0;
  double tick_s = 1.0 / 240.0;
  PlotRange x;  // seconds, max 0
  double x_of(std::size_t index) const noexcept {
    return -static_cast<double>(end - 1 - index) * tick_s;
  }
};
GraphSpan graph_span(const History& history, int walker, int rate_hz);

// A joint's angle in degrees, one curve for each walker; that of the `chosen` one (-1: none) is
// thicker.
Plot joint_plot(const History& history, const GraphSpan& span, Side leg, std::size_t joint,
                const Theme& theme, int chosen, double least_span_deg);
// The height of both heels above the ground below them in cm, with marks at the lift, the peak and
// the landing.
Plot heel_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
// The stage, and when each heel and toe is planted.
SpanPlot stage_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);

// The inverse kinematics of a walker's legs.
Plot iteration_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
Plot error_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
// The time that each tick took, ms, over the whole history.
Plot tick_time_plot(const History& history, int rate_hz, const Theme& theme);

}  // namespace gaitpad
