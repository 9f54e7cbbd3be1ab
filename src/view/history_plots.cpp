#include "view/history_plots.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace gaitpad {
namespace {

constexpr double kUsualSpan_s = 2.0;
constexpr std::array<std::string_view, 2> kLegLetters = {"L", "R"};

const WalkerSample& sample(const History& history, std::size_t i, int walker) {
  return history[i].walkers[static_cast<std::size_t>(walker)];
}

const Colour& leg_colour(const Theme& theme, Side side) {
  return side == kLeftSide ? theme.left : theme.right;
}

bool has_walker(const History& history, int walker) {
  return history.size() > 0 && walker >= 0 && walker < history[0].walker_count;
}

using ValueAt = std::function<double(std::size_t index)>;

void add_series(const GraphSpan& span, std::string_view letter, const Colour& colour,
                const ValueAt& value, Plot& plot) {
  PlotSeries series;
  series.letter = letter;
  series.colour = colour;
  series.points.reserve(span.end - span.begin);
  for (std::size_t i = span.begin; i < span.end; ++i) {
    series.points.emplace_back(span.x_of(i), value(i));
  }
  plot.series.push_back(std::move(series));
}

// One curve for each leg.
Plot leg_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme,
              const std::function<double(const WalkerSample&, Side)>& value, double least) {
  Plot plot;
  plot.x = span.x;
  if (!has_walker(history, walker)) return plot;
  for (const Side side : {kLeftSide, kRightSide}) {
    add_series(
        span, kLegLetters[side], leg_colour(theme, side),
        [&](std::size_t i) { return value(sample(history, i, walker), side); }, plot);
  }
  fit_y(plot, least);
  return plot;
}

bool is_flying(const WalkerSample& s, Side side) noexcept {
  return s.stage == Stage::flight && s.swing == side;
}

// Adds marks at lift, peak and landing of each flight of the foot in the span.
void add_marks(const History& history, const GraphSpan& span, int walker, Side side,
               const Theme& theme, Plot& plot) {
  const Colour colour = leg_colour(theme, side);
  const auto at = [&](std::size_t i) {
    return PlotPoint{span.x_of(i), sample(history, i, walker).heel_above_m[side] * 100.0};
  };
  std::size_t peak = span.end;  // index of the present flight's highest sample; end: not yet seen
  for (std::size_t i = span.begin; i < span.end; ++i) {
    const bool is_up = is_flying(sample(history, i, walker), side);
    const bool was_up = i > span.begin && is_flying(sample(history, i - 1, walker), side);
    if (is_up && !was_up) {
      peak = i;
      if (i > span.begin) plot.marks.push_back({PlotMark::Shape::up, at(i), colour});
    }
    if (is_up && at(i).y > at(peak).y) peak = i;
    if (!is_up && was_up) {
      if (peak != span.begin) plot.marks.push_back({PlotMark::Shape::dot, at(peak), colour});
      plot.marks.push_back({PlotMark::Shape::down, at(i), colour});
    }
  }
}

// Joins runs of equal keys to the parts of a row; key 0 is a gap.
template <class Key, class Part>
SpanRow row_of(std::string_view label, const GraphSpan& span, const Key& key, const Part& part) {
  SpanRow row;
  row.label = label;
  std::size_t begin = span.begin;
  for (std::size_t i = span.begin + 1; i <= span.end; ++i) {
    if (i < span.end && key(i) == key(begin)) continue;
    if (key(begin) != 0) {
      SpanRow::Part made = part(key(begin));
      made.from = span.x_of(begin) - span.tick_s;
      made.to = span.x_of(i - 1);
      row.parts.push_back(std::move(made));
    }
    begin = i;
  }
  return row;
}

int stage_key(const WalkerSample& s) {
  if (s.stage == Stage::idle) return 1;
  return (s.stage == Stage::flight ? 2 : 4) + static_cast<int>(s.swing);
}

SpanRow::Part stage_part(int key, const Theme& theme) {
  SpanRow::Part part;
  const Side side = key % 2 == 0 ? kLeftSide : kRightSide;
  part.colour = key == 1 ? faint(theme.secondary, 0.25)
                         : faint(leg_colour(theme, side), key < 4 ? 0.55 : 0.25);
  part.letter =
      key == 1 ? "idle" : std::string(key < 4 ? "F " : "R ") + std::string(kLegLetters[side]);
  return part;
}

}  // namespace

GraphSpan graph_span(const History& history, int walker, int rate_hz) {
  GraphSpan span;
  span.tick_s = 1.0 / std::max(rate_hz, 1);
  span.end = history.size();
  auto ticks = static_cast<std::size_t>(kUsualSpan_s / span.tick_s);
  const History::Span cycles = history.newest_cycles(walker, 2);
  if (cycles.begin < cycles.end) ticks = cycles.end - cycles.begin;
  span.begin = span.end > ticks ? span.end - ticks : 0;
  span.x = {-static_cast<double>(ticks) * span.tick_s, 0.0};
  return span;
}

Plot joint_plot(const History& history, const GraphSpan& span, Side leg, std::size_t joint,
                const Theme& theme, int chosen, double least_span_deg) {
  Plot plot;
  plot.x = span.x;
  if (history.size() == 0) return plot;
  const int count = history[0].walker_count;
  for (int w = 0; w < count; ++w) {
    Colour colour = series_colour(theme, static_cast<std::size_t>(w));
    if (chosen >= 0 && w != chosen) colour.alpha = 0.45;
    add_series(
        span, std::to_string(w + 1), colour,
        [&](std::size_t i) {
          return static_cast<double>(sample(history, i, w).joint_rad[leg][joint]) / kDegree;
        },
        plot);
    if (w == chosen) plot.series.back().width_px = 2.4;
  }
  fit_y(plot, least_span_deg);
  return plot;
}

Plot heel_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme) {
  Plot plot = leg_plot(
      history, span, walker, theme,
      [](const WalkerSample& s, Side side) { return s.heel_above_m[side] * 100.0; }, 4.0);
  plot.y.min -= 0.06 * (plot.y.max - plot.y.min);  // leaves room for curves along the floor
  if (!has_walker(history, walker)) return plot;
  for (const Side side : {kLeftSide, kRightSide}) {
    add_marks(history, span, walker, side, theme, plot);
  }
  return plot;
}

SpanPlot stage_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme) {
  SpanPlot plot;
  plot.x = span.x;
  if (!has_walker(history, walker) || span.end <= span.begin) return plot;
  plot.rows.push_back(row_of(
      "stage", span, [&](std::size_t i) { return stage_key(sample(history, i, walker)); },
      [&](int key) { return stage_part(key, theme); }));
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const bool is_heel : {true, false}) {
      const std::string label = std::string(kLegLetters[side]) + (is_heel ? " heel" : " toe");
      plot.rows.push_back(row_of(
          label, span,
          [&](std::size_t i) {
            const WalkerSample& s = sample(history, i, walker);
            return is_heel ? s.heel_planted[side] ? 1 : 0 : s.toe_planted[side] ? 1 : 0;
          },
          [&](int) {
            SpanRow::Part part;
            part.colour = leg_colour(theme, side);
            return part;
          }));
    }
  }
  return plot;
}

Plot iteration_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme) {
  Plot plot = leg_plot(
      history, span, walker, theme,
      [](const WalkerSample& s, Side side) { return static_cast<double>(s.ik_iterations[side]); },
      4.0);
  plot.y.min = 0.0;
  return plot;
}

Plot error_plot(const History& history, const GraphSpan& span, int walker, const Theme& theme) {
  Plot plot = leg_plot(
      history, span, walker, theme,
      [](const WalkerSample& s, Side side) {
        return static_cast<double>(s.ik_error_m[side]) * 1000.0;
      },
      0.01);
  plot.y.min = 0.0;
  return plot;
}

Plot tick_time_plot(const History& history, int rate_hz, const Theme& theme) {
  GraphSpan span;
  span.tick_s = 1.0 / std::max(rate_hz, 1);
  span.end = history.size();
  span.begin = 0;
  Plot plot;
  plot.x = {-static_cast<double>(std::max<std::size_t>(span.end, 2) - 1) * span.tick_s, 0.0};
  if (span.end == 0) return plot;
  add_series(
      span, "", theme.left,
      [&](std::size_t i) { return static_cast<double>(history[i].step_us) / 1000.0; }, plot);
  plot.series.back().width_px = 1.0;
  fit_y(plot, 0.1);
  plot.y.min = 0.0;
  return plot;
}

}  // namespace gaitpad
