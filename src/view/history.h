// The last seconds of a session, tick by tick, for graphs and trails.
#pragma once
#include <cstddef>
#include <vector>

#include "gaitpad/session_frame.h"
#include "view/plot.h"

namespace gaitpad {

// A ring; 0 is the oldest. A sample that does not follow the newest one begins it anew.
class History {
 public:
  explicit History(std::size_t capacity = 2400) : samples_(capacity > 0 ? capacity : 1) {}
  void add(const TickSample& sample);
  void clear() noexcept { size_ = 0; }
  std::size_t size() const noexcept { return size_; }
  const TickSample& operator[](std::size_t i) const noexcept {
    return samples_[(begin_ + i) % samples_.size()];
  }
  // The newest `cycles` complete cycles of a walker without a rest in them (from its right foot's
  // landings), as indices [begin, end); both are size() where it has not walked so many.
  struct Span {
    std::size_t begin = 0, end = 0;
  };
  Span newest_cycles(int walker, int cycles) const noexcept;
  std::size_t cycle_begin(int walker, int cycles) const noexcept {
    return newest_cycles(walker, cycles).begin;
  }

 private:
  std::vector<TickSample> samples_;
  std::size_t begin_ = 0, size_ = 0;
};

// What the graphs show, out of the last seconds of a session; x is seconds before now.

inline constexpr std::size_t kShownJointCount = 3;  // hip, knee, ankle: WalkerSample::joint_rad

// The samples [begin, end) of a history: as long as a walker's last two cycles, up to now; two
// seconds where it has not walked so far.
struct GraphSpan {
  std::size_t begin = 0, end = 0;
  double tick_s = 1.0 / 240.0;
  PlotRange x;  // seconds, max 0
  double x_of(std::size_t index) const noexcept {
    return -static_cast<double>(end - 1 - index) * tick_s;
  }
};
GraphSpan graph_span(const History& history, int walker, int rate_hz);

// A joint's angle, degrees: a curve for each walker, the `chosen` one (-1: none) stronger.
Plot joint_plot(const History& history, const GraphSpan& span, Side leg, std::size_t joint,
                const Theme& theme, int chosen, double least_span_deg);
// Both heels' heights, cm, and where their flights begin, are highest and end.
Plot heel_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
// The stage, and below it when each point of the feet is planted.
SpanPlot stage_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);

// IK of both legs of a walker.
Plot iteration_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
Plot error_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme);
// What a tick takes, ms, over all that the history holds; lines where it was longer than a tick.
Plot tick_time_plot(const History& history, int rate_hz, const Theme& theme);

}  // namespace gaitpad
