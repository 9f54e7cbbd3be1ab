// Pages of figures: plots with axes and units, stick figures seen from the side.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/gait_cycle.h"
#include "view/drawing.h"
#include "view/plot.h"
#include "view/stick_plot.h"

namespace gaitpad {

// Red, green and blue as the paper has them, dark enough for paper; and what is no character.
namespace paper_colour {
inline constexpr unsigned kRed = 0xc62828, kGreen = 0x2e8b3d, kBlue = 0x1f5fbf, kData = 0x6b7480,
                          kPlant = 0xc62828, kBand = 0xeef1f5;
}

struct Page {
  Surface surface;
  Cairo cr;
};
// White, with a title and a line below it.
Page blank_page(int width_px, int height_px, const std::string& title, const std::string& caption);
inline constexpr double kPageMargin = 28.0, kPageTop = 74.0;

struct PlotFrame {
  Box box;  // of the curves; labels stand outside
  PlotRange x, y;
  std::string title, x_label, y_label;
};
vec2 pixel_in(const PlotFrame& plot, const vec2& value) noexcept;
void draw_frame(cairo_t* cr, const PlotFrame& plot);  // grid, ticks, labels

struct Stroke {
  unsigned colour = colour::kInk;
  double width = 1.8, alpha = 1.0;
  bool is_dashed = false;
};
using Line2 = std::vector<vec2>;
void draw_curve(cairo_t* cr, const PlotFrame& plot, const Line2& points, const Stroke& stroke);
// Over the plot's whole height; a word at its top.
void draw_band(cairo_t* cr, const PlotFrame& plot, const PlotRange& x, const std::string& word);
void draw_dot(cairo_t* cr, const vec2& at, double radius, unsigned colour);
// Around all points, out to round numbers.
PlotRange range_of(const std::vector<Line2>& curves, double least);

// The sagittal plane: z of the walk to the right, y up.
struct SideView {
  Box box;
  double left_z_m = 0.0;  // at the box's left edge
  double floor_px = 0.0;  // y of height 0
  double px_per_m = 100.0;
};
vec2 pixel_in(const SideView& view, const vec3& place_m) noexcept;
void draw_floor(cairo_t* cr, const SideView& view);
void draw_path(cairo_t* cr, const SideView& view, const std::vector<vec3>& path_m,
               const Stroke& stroke);
void draw_arrow(cairo_t* cr, const vec2& from, const vec2& to, const Stroke& stroke);
void draw_plant(cairo_t* cr, const vec2& at);  // a triangle below it

// A figure's points: its joints, then both heels, left first.
std::vector<vec3> figure_points(const std::vector<vec3>& joints_m,
                                const std::array<vec3, 2>& heel_m);
// Bones of a stick figure: a point and its parent; soles go from the ankle over the heel to the
// toe.
struct StickBone {
  int parent = 0, joint = 0;
  enum class Part { left_leg, right_leg, rest } part = Part::rest;
};
std::vector<StickBone> stick_bones(const GaitCycle& cycle, const std::vector<vec3>& points_m);
// The left leg paler.
void draw_stick_figure(cairo_t* cr, const SideView& view, const std::vector<StickBone>& bones,
                       const std::vector<vec3>& points_m, const Stroke& stroke);

// The first row being headings; columns as wide as their shares.
struct Table {
  std::vector<double> shares;
  std::vector<std::vector<std::string>> rows;
};
void draw_table(cairo_t* cr, const Box& box, const Table& table);

// A CSV: `time_s` and the like, then a column a curve.
struct CsvColumn {
  std::string name;
  std::vector<double> values;
};
std::string csv_text(const std::vector<CsvColumn>& columns);

}  // namespace gaitpad
