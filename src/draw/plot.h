// A plot as data, drawn here with cairo and in the window with Dear ImGui (view/plot.h): axes with
// round numbers, curves, bands, marks, rows of spans, a legend. A value that is not finite is a
// gap.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "draw/picture.h"

namespace gaitpad {

struct PlotRange {
  double min = 0.0, max = 1.0;
  bool is_log10 = false;  // values are decimal logarithms; ticks show the numbers
};

// The round step (1, 2 or 5 times a power of ten) that divides `span` into at most `max_steps`
// parts; 0 if the span is not positive and finite.
double nice_step(double span, int max_steps) noexcept;
// Multiples of nice_step() within [min, max].
std::vector<double> nice_ticks(double min, double max, int max_steps);
// The value with as many decimals as the step: "-0.25", "20".
std::string tick_text(double value, double step);
struct PlotTick {
  double value = 0.0;
  std::string text;
};
// The ticks of a range. For logarithms: the powers of ten, and 2 and 5 times those if they fit.
std::vector<PlotTick> plot_ticks(const PlotRange& range, int max_steps);
// The range, widened to round numbers and to at least `least`.
PlotRange nice_range(double min, double max, double least) noexcept;

using PlotPoint = vec2;  // x and y in the plot's units

struct PlotSeries {
  std::string letter;  // drawn at the curve's end, to tell curves apart without colour
  Colour colour;
  double width_px = 1.6;  // width of the line at scale 1; the window rounds it to whole pixels
  std::vector<PlotPoint> points;
  bool is_dashed = false;
};
struct PlotBand {  // a coloured band between two values of x, over the whole height
  double from = 0.0, to = 0.0;
  Colour colour;
  std::string text;  // words at the band's top
};
struct PlotMark {
  enum class Shape { up, dot, down } shape = Shape::dot;
  PlotPoint place;
  Colour colour;
};
struct Plot {
  PlotRange x, y;
  std::vector<PlotBand> bands;
  std::vector<PlotSeries> series;
  std::vector<PlotMark> marks;
  std::string title, x_label, y_label;
  bool has_x_ticks = true;
  std::string nothing = "nothing yet";  // shown if no curve has a point
};
// Sets the y range to round numbers around all curves, at least `least` wide.
void fit_y(Plot& plot, double least);

// Reduces points to those that are visible in a plot of `columns` pixels: the first, lowest,
// highest and last point of each column. x must not decrease. A short list stays as it is; a gap
// becomes one NaN point.
void decimate(std::span<const PlotPoint> points, const PlotRange& x, int columns,
              std::vector<PlotPoint>& out);

// Rows of spans over a common x axis, for example the times at which a foot's points are planted.
struct SpanRow {
  struct Part {
    double from = 0.0, to = 0.0;
    Colour colour;
    std::string letter;  // written into the span if it fits
  };
  std::string label;
  std::vector<Part> parts;
};
struct SpanPlot {
  PlotRange x;
  std::vector<SpanRow> rows;
};

// The following functions draw with cairo. `box` is the part that holds the curves; numbers and
// labels are outside it.
vec2 pixel_in(const Box& box, const Plot& plot, const vec2& value) noexcept;
void draw_curve(cairo_t* cr, const Box& box, const Plot& plot, const PlotSeries& series);
// Bands, grid, numbers, labels and curves.
void draw_plot(cairo_t* cr, const Box& box, const Plot& plot);

struct LegendEntry {
  enum class Mark { line, dashed, area, bar, dot, cross };
  Mark mark = Mark::line;
  unsigned colour = colour::kInk;
  std::string text;
};
// Draws entries in rows from the box's upper left corner; an entry that does not fit starts a new
// row.
void draw_legend(cairo_t* cr, const Box& box, const std::vector<LegendEntry>& entries);

}  // namespace gaitpad
