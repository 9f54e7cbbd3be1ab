#include "tools/gaitpad/window/drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "draw/plot.h"
#include "paper/page.h"

namespace gaitpad {

std::optional<Error> draw_curves(const JointCurves& curves, const std::string& title,
                                 const std::string& path) {
  constexpr int kWidth = 1000, kHeight = 640, kColumns = 900;
  constexpr std::array kColours = {colour::kVermilion, colour::kGreen, colour::kBlue};
  constexpr std::array kNames = {"x", "y", "z"};
  const double tick_s = 1.0 / curves.rate_hz;
  const double end_s = std::max(tick_s, tick_s * static_cast<double>(curves.distance.size() - 1));
  const auto unit = curves.is_angle ? "degrees" : "m";
  std::vector<LegendEntry> legend = {{LegendEntry::Mark::line, colour::kInk, "this run"},
                                     {LegendEntry::Mark::dashed, colour::kInk, "expected"}};
  const auto series_of = [&](const std::vector<double>& values, const PlotRange& x) {
    std::vector<PlotPoint> points;
    for (std::size_t tick = 0; tick < values.size(); ++tick)
      points.emplace_back(tick_s * static_cast<double>(tick), values[tick]);
    PlotSeries series;
    decimate(points, x, kColumns, series.points);
    return series;
  };
  Plot both, apart;
  both.x = apart.x = {0.0, end_s, false};
  both.has_x_ticks = false;
  both.y_label = unit;
  both.title = curves.is_angle ? "rotation vector in the parent's frame" : "place";
  apart.x_label = "s";
  apart.y_label = unit;
  apart.title = "distance between the two";
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    for (const bool is_before : {false, true}) {
      PlotSeries series = series_of(is_before ? curves.before[k] : curves.after[k], both.x);
      series.colour = rgb(kColours[k]);
      series.is_dashed = is_before;
      both.series.push_back(std::move(series));
    }
    legend.push_back({LegendEntry::Mark::area, kColours[k], kNames[k]});
  }
  apart.series.push_back(series_of(curves.distance, apart.x));
  apart.series.back().colour = rgb(colour::kInk);
  const double first_s = tick_s * static_cast<double>(curves.first_tick);
  for (Plot* plot : {&both, &apart}) {
    plot->bands.push_back({first_s, end_s, rgb(colour::kOrange, 0.12), ""});
    fit_y(*plot, curves.is_angle ? 0.1 : 0.001);
  }
  apart.y.min = 0.0;
  const Page page = blank_page(kWidth, kHeight, curves.joint,
                               fmt::format("{}: the first different tick is {} ({:.3f} s)", title,
                                           curves.first_tick, first_s));
  cairo_t* cr = page.cr.get();
  const double left = kPageMargin + 62.0, width = kWidth - 2.0 * kPageMargin - 82.0;
  draw_legend(cr, {kPageMargin, kPageTop, kWidth - 2.0 * kPageMargin, 40.0}, legend);
  draw_plot(cr, {left, kPageTop + 52.0, width, 270.0}, both);
  draw_plot(cr, {left, kPageTop + 372.0, width, 130.0}, apart);
  return write_png(path, page.surface.get());
}

// Draws curves over two logarithmic axes.
std::optional<Error> draw_crowd(const std::vector<CrowdCurve>& curves, const std::string& processor,
                                const std::string& path) {
  constexpr int kWidth = 900, kHeight = 620;
  Plot plot;
  plot.x_label = "characters in the crowd";
  plot.y_label = "ns a character and tick";
  plot.x.is_log10 = plot.y.is_log10 = true;
  std::vector<LegendEntry> legend;
  double least = 1e12, most = 0.0, largest = 1.0;
  for (const CrowdCurve& curve : curves) {
    PlotSeries& series = plot.series.emplace_back();
    series.colour = rgb(curve.colour);
    series.is_dashed = curve.is_dashed;
    for (const auto& [characters, ns] : curve.points) {
      least = std::min(least, ns);
      most = std::max(most, ns);
      largest = std::max(largest, characters);
      series.points.emplace_back(std::log10(characters), std::log10(ns));
    }
    legend.push_back({curve.is_dashed ? LegendEntry::Mark::dashed : LegendEntry::Mark::line,
                      curve.colour, curve.name});
  }
  plot.x.max = std::max(1.0, std::log10(largest));
  plot.y.min = std::log10(least / 1.5);
  plot.y.max = std::log10(most * 1.5);

  const Page page = blank_page(kWidth, kHeight, "A crowd's time, a character and tick",
                               processor + ", one core where nothing else is said, medians");
  cairo_t* cr = page.cr.get();
  const Box box = {kPageMargin + 62.0, kPageTop + 54.0, kWidth - 2.0 * kPageMargin - 82.0,
                   kHeight - kPageTop - 124.0};
  draw_plot(cr, box, plot);
  for (const PlotSeries& series : plot.series) {
    if (series.is_dashed) continue;
    for (const PlotPoint& p : series.points)
      draw_dot(cr, pixel_in(box, plot, p), 3.0, series.colour);
  }
  draw_legend(cr, {kPageMargin, kPageTop, kWidth - 2.0 * kPageMargin, 40.0}, legend);
  return write_png(path, page.surface.get());
}

}  // namespace gaitpad

// The program loads this symbol by its name.
extern "C" const gaitpad::WindowModule gaitpad_window_module;
const gaitpad::WindowModule gaitpad_window_module = {
    .version = GAITPAD_VERSION,
    .run_window = &gaitpad::run_window,
    .write_stick_picture = &gaitpad::write_stick_picture,
    .write_comparison = &gaitpad::write_comparison,
    .draw_curves = &gaitpad::draw_curves,
    .draw_crowd = &gaitpad::draw_crowd,
    .run_figures = &gaitpad::run_figures,
};
