// Plots on ImGui's draw lists: axes with round numbers, several curves, bands, marks. What is drawn
// never leaves its box; what is not a number is a gap.
#pragma once
#include <imgui.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "view/theme.h"

namespace gaitpad {

// The round step (1, 2 or 5 times a power of ten) that cuts `span` into at most `max_steps`; 0
// where there is none (not finite, not positive).
double nice_step(double span, int max_steps) noexcept;
// Multiples of the step within [min, max].
std::vector<double> nice_ticks(double min, double max, int max_steps);
// As many decimals as the step has: "-0.25", "20".
std::string tick_text(double value, double step);

struct PlotRange {
  double min = 0.0, max = 1.0;
};
// Around everything that is finite, out to round numbers, at least `least` wide.
PlotRange nice_range(double min, double max, double least) noexcept;

struct PlotPoint {
  double x = 0.0, y = 0.0;  // y not finite: a gap
};
// What of it a plot `columns` pixels wide can show: of each column the first, lowest, highest and
// last point. x must not fall. Few points come out as they are; a gap stays one point that is none.
void decimate(std::span<const PlotPoint> points, const PlotRange& x, int columns,
              std::vector<PlotPoint>& out);

// Leaves out points of a line from left to right, pixels, that lie within `tolerance` of the
// straight line between those that stay, measured upright: software rasterizers pay by the
// triangle.
void thin_out(std::vector<ImVec2>& line, float tolerance);

struct PlotSeries {
  std::string letter;  // beside its end: what tells it apart without its colour
  Colour colour;
  double width_px = 1.6;  // at scale 1; drawn in whole pixels
  std::vector<PlotPoint> points;
};
struct PlotBand {  // from x to x over the whole height
  double from = 0.0, to = 0.0;
  Colour colour;
};
struct PlotMark {
  enum class Shape { up, dot, down } shape = Shape::dot;
  PlotPoint place;
  Colour colour;
};
struct Plot {
  PlotRange x, y;
  std::vector<PlotBand> bands;
  std::vector<double> lines;  // upright, at these x
  std::vector<PlotSeries> series;
  std::vector<PlotMark> marks;
  bool has_x_ticks = true;
  std::string nothing = "nothing yet";  // where no curve has a point
};

struct PlotStyle {
  const Theme* theme = nullptr;
  const Fonts* fonts = nullptr;
  float scale = 1.0f;
};
// Box: the whole, tick labels included; pixels.
void draw_plot(ImDrawList& list, const ImVec2& min, const ImVec2& max, const Plot& plot,
               const PlotStyle& style);

// Rows of spans over a common x axis, for instance when which point of a foot is planted.
struct SpanRow {
  struct Part {
    double from = 0.0, to = 0.0;
    Colour colour;
    std::string letter;  // drawn where there is room for it
  };
  std::string label;
  std::vector<Part> parts;
};
struct SpanPlot {
  PlotRange x;
  std::vector<SpanRow> rows;
};
void draw_spans(ImDrawList& list, const ImVec2& min, const ImVec2& max, const SpanPlot& plot,
                const PlotStyle& style);

}  // namespace gaitpad
