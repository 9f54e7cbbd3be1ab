#include "draw/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitpad {
namespace {

constexpr int kMostTicks = 64;
// Share of a step; a range's end this near to a tick counts as the tick.
constexpr double kRounding = 1e-9;

// Indices of the points of one pixel column that are kept.
struct Column {
  std::size_t first = 0, low = 0, high = 0, last = 0;
};

void add_column(std::span<const PlotPoint> points, const Column& c, std::vector<PlotPoint>& out) {
  std::size_t order[] = {c.first, std::min(c.low, c.high), std::max(c.low, c.high), c.last};
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == 0 || order[i] != order[i - 1]) out.push_back(points[order[i]]);
  }
}

bool is_drawable(const PlotPoint& p) noexcept { return std::isfinite(p.x) && std::isfinite(p.y); }

void add_gap(std::vector<PlotPoint>& out) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!out.empty() && is_drawable(out.back())) out.emplace_back(kNone, kNone);
}

// Greatest numbers of steps between the ticks of a plot on cairo.
constexpr int kMostXSteps = 8, kMostYSteps = 7;
// Powers of ten within the range of logarithms, and 2 and 5 times those unless they are too many.
std::vector<PlotTick> log_ticks(const PlotRange& range, int max_steps) {
  std::vector<PlotTick> ticks;
  if (!(range.max - range.min <= kMostTicks)) return ticks;
  for (const auto& factors : {std::vector{1.0, 2.0, 5.0}, std::vector{1.0}}) {
    ticks.clear();
    for (double power = std::floor(range.min); power <= range.max; power += 1.0) {
      for (const double factor : factors) {
        const double at = power + std::log10(factor);
        if (at < range.min - kRounding || at > range.max + kRounding) continue;
        const double value = factor * std::pow(10.0, power);
        ticks.push_back({at, tick_text(value, std::min(1.0, value))});
      }
    }
    if (ticks.size() <= static_cast<std::size_t>(max_steps) + 1) break;
  }
  return ticks;
}

constexpr unsigned kFrameColour = 0xaab2bd;

void draw_bands(cairo_t* cr, const Box& box, const Plot& plot) {
  for (const PlotBand& band : plot.bands) {
    const double from = pixel_in(box, plot, vec2(band.from, 0.0)).x;
    const double to = pixel_in(box, plot, vec2(band.to, 0.0)).x;
    {
      const Clipped clip(cr, box);
      fill_box(cr, {from, box.y, to - from, box.height}, band.colour);
    }
    draw_text(cr, {11.5, colour::kFaint, Align::centre}, {0.5 * (from + to), box.y + 15.0},
              band.text, to - from);
  }
}

void draw_grid(cairo_t* cr, const Box& b, const Plot& plot) {
  set_dashes(cr, false);
  cairo_set_line_width(cr, 1.0);
  for (const PlotTick& tick : plot_ticks(plot.x, kMostXSteps)) {
    const double x = std::round(pixel_in(b, plot, vec2(tick.value, plot.y.min)).x) + 0.5;
    set_colour(cr, rgb(colour::kGrid));
    line(cr, {x, b.y}, {x, b.y + b.height});
    cairo_stroke(cr);
    draw_text(cr, {12.0, colour::kFaint, Align::centre}, {x, b.y + b.height + 16.0}, tick.text);
  }
  for (const PlotTick& tick : plot_ticks(plot.y, kMostYSteps)) {
    const double y = std::round(pixel_in(b, plot, vec2(plot.x.min, tick.value)).y) + 0.5;
    set_colour(cr, rgb(colour::kGrid));
    line(cr, {b.x, y}, {b.x + b.width, y});
    cairo_stroke(cr);
    draw_text(cr, {12.0, colour::kFaint, Align::right}, {b.x - 7.0, y + 4.0}, tick.text);
  }
}

void draw_labels(cairo_t* cr, const Box& b, const Plot& plot) {
  draw_text(cr, {14.0, colour::kInk, Align::left, true}, {b.x, b.y - 9.0}, plot.title, b.width);
  draw_text(cr, {12.5, colour::kInk, Align::centre}, {b.x + 0.5 * b.width, b.y + b.height + 35.0},
            plot.x_label);
  cairo_save(cr);
  cairo_translate(cr, b.x - 44.0, b.y + 0.5 * b.height);
  cairo_rotate(cr, -0.5 * kPi);
  draw_text(cr, {12.5, colour::kInk, Align::centre}, {0.0, 0.0}, plot.y_label);
  cairo_restore(cr);
}

double swatch_width(const LegendEntry& entry) {
  using Mark = LegendEntry::Mark;
  return entry.mark == Mark::line || entry.mark == Mark::dashed ? 20.0 : 14.0;
}

void draw_swatch(cairo_t* cr, const LegendEntry& entry, const vec2& at) {
  using Mark = LegendEntry::Mark;
  const double width = swatch_width(entry);
  set_colour(cr, rgb(entry.colour));
  cairo_set_line_width(cr, 2.0);
  switch (entry.mark) {
    case Mark::dashed:
      set_dashes(cr, true);
      [[fallthrough]];
    case Mark::line:
      line(cr, {at.x, at.y}, {at.x + width, at.y});
      cairo_stroke(cr);
      set_dashes(cr, false);
      return;
    case Mark::area:
      fill_box(cr, {at.x, at.y - 5.0, width, 10.0}, rgb(entry.colour, 0.35));
      stroke_box(cr, {at.x, at.y - 5.0, width, 10.0}, rgb(entry.colour), 1.0);
      return;
    case Mark::bar:
      fill_box(cr, {at.x, at.y - 5.0, width, 10.0}, rgb(entry.colour));
      return;
    case Mark::dot:
      draw_dot(cr, {at.x + width / 2, at.y}, 4.0, rgb(entry.colour));
      return;
    case Mark::cross:
      cairo_set_line_width(cr, 1.2);
      line(cr, {at.x + 1.0, at.y}, {at.x + width - 1.0, at.y});
      line(cr, {at.x + width / 2, at.y - 6.0}, {at.x + width / 2, at.y + 6.0});
      cairo_stroke(cr);
      return;
  }
}

}  // namespace

double nice_step(double span, int max_steps) noexcept {
  if (!std::isfinite(span) || span <= 0.0 || max_steps < 1) return 0.0;
  const double wanted = span / max_steps;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  if (!(power > 0.0)) return 0.0;
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if (span / (factor * power) <= max_steps + kRounding) return factor * power;
  }
  return 20.0 * power;
}

std::vector<double> nice_ticks(double min, double max, int max_steps) {
  std::vector<double> ticks;
  const double step = nice_step(max - min, std::min(max_steps, kMostTicks));
  if (step == 0.0) return ticks;
  const double first = std::ceil(min / step - kRounding);
  for (int i = 0; i <= kMostTicks; ++i) {
    const double tick = (first + i) * step;
    if (!(tick <= max + kRounding * step)) break;
    ticks.push_back(tick == 0.0 ? 0.0 : tick);  // avoids -0
  }
  return ticks;
}

std::string tick_text(double value, double step) {
  if (!std::isfinite(value)) return "-";
  const double magnitude = step > 0.0 ? std::floor(std::log10(step) + kRounding) : 0.0;
  const int decimals = static_cast<int>(std::clamp(-magnitude, 0.0, 6.0));
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::vector<PlotTick> plot_ticks(const PlotRange& range, int max_steps) {
  if (range.is_log10) return log_ticks(range, max_steps);
  const double step = nice_step(range.max - range.min, max_steps);
  std::vector<PlotTick> ticks;
  for (const double value : nice_ticks(range.min, range.max, max_steps)) {
    ticks.push_back({value, tick_text(value, step)});
  }
  return ticks;
}

PlotRange nice_range(double min, double max, double least) noexcept {
  if (!std::isfinite(min) || !std::isfinite(max) || min > max) return {0.0, std::max(least, 1e-9)};
  if (max - min < least) {
    const double middle = (min + max) / 2.0;
    min = middle - least / 2.0;
    max = middle + least / 2.0;
  }
  const double step = nice_step(max - min, 4);
  if (step == 0.0) return {min - 0.5, max + 0.5};
  return {std::floor(min / step + kRounding) * step, std::ceil(max / step - kRounding) * step};
}

void decimate(std::span<const PlotPoint> points, const PlotRange& x, int columns,
              std::vector<PlotPoint>& out) {
  out.clear();
  const double width = x.max - x.min;
  if (columns < 1 || !(width > 0.0)) return;
  const bool is_few = points.size() <= static_cast<std::size_t>(columns) * 2;
  Column column;
  int at = -1;  // number of the column that is being filled; -1: none yet
  const auto finish = [&] {
    if (at >= 0) add_column(points, column, out);
    at = -1;
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlotPoint& p = points[i];
    if (!is_drawable(p)) {
      finish();
      add_gap(out);
      continue;
    }
    const double place = std::clamp((p.x - x.min) / width * columns, 0.0, columns - 1.0);
    if (is_few || static_cast<int>(place) != at) {
      finish();
      at = static_cast<int>(place);
      column = {i, i, i, i};
      continue;
    }
    if (p.y < points[column.low].y) column.low = i;
    if (p.y > points[column.high].y) column.high = i;
    column.last = i;
  }
  finish();
}

void fit_y(Plot& plot, double least) {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& p : series.points) {
      if (!std::isfinite(p.y)) continue;
      min = std::min(min, p.y);
      max = std::max(max, p.y);
    }
  }
  plot.y = nice_range(min, max, least);
}

vec2 pixel_in(const Box& b, const Plot& plot, const vec2& value) noexcept {
  return {b.x + b.width * (value.x - plot.x.min) / (plot.x.max - plot.x.min),
          b.y + b.height * (plot.y.max - value.y) / (plot.y.max - plot.y.min)};
}

void draw_curve(cairo_t* cr, const Box& box, const Plot& plot, const PlotSeries& series) {
  const Clipped clip(cr, box);
  set_colour(cr, series.colour);
  cairo_set_line_width(cr, series.width_px);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  set_dashes(cr, series.is_dashed);
  bool is_down = false;
  for (const PlotPoint& p : series.points) {
    if (!is_drawable(p)) {
      is_down = false;
      continue;
    }
    const vec2 at = pixel_in(box, plot, p);
    is_down ? cairo_line_to(cr, at.x, at.y) : cairo_move_to(cr, at.x, at.y);
    is_down = true;
  }
  cairo_stroke(cr);
}

void draw_plot(cairo_t* cr, const Box& box, const Plot& plot) {
  draw_bands(cr, box, plot);
  draw_grid(cr, box, plot);
  stroke_box(cr, box, rgb(kFrameColour), 1.0);
  draw_labels(cr, box, plot);
  for (const PlotSeries& series : plot.series) draw_curve(cr, box, plot, series);
}

void draw_legend(cairo_t* cr, const Box& box, const std::vector<LegendEntry>& entries) {
  constexpr double kRow = 20.0, kGap = 6.0, kBetween = 16.0;
  const TextStyle style{12.0, colour::kInk};
  vec2 at(box.x, box.y + kRow / 2);
  for (const LegendEntry& entry : entries) {
    const double width = swatch_width(entry) + kGap + text_width(cr, style, entry.text);
    if (at.x > box.x && at.x + width > box.x + box.width) at = {box.x, at.y + kRow};
    draw_swatch(cr, entry, at);
    draw_text(cr, style, at + vec2(swatch_width(entry) + kGap, 4.0), entry.text);
    at.x += width + kBetween;
  }
}

}  // namespace gaitpad
