// Pages of figures: stick figures seen from the side, arrows, tables, CSV. (Plots: draw/plot.h.)
#pragma once
#include <string>
#include <vector>

#include "draw/plot.h"
#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// The paper's red, green and blue, dark enough for white paper, and colours of the other parts.
namespace paper_colour {
inline constexpr unsigned kRed = 0xc62828, kGreen = 0x2e8b3d, kBlue = 0x1f5fbf, kData = 0x6b7480,
                          kPlant = 0xc62828, kBand = 0xeef1f5;
}

struct Page {
  Surface surface;
  Cairo cr;
};
// A white page with a title and a caption below it.
Page blank_page(int width_px, int height_px, const std::string& title, const std::string& caption);
inline constexpr double kPageMargin = 28.0, kPageTop = 74.0;

struct Stroke {
  unsigned colour = colour::kInk;
  double width = 1.8, alpha = 1.0;
  bool is_dashed = false;
};
// The points as a curve of a plot, drawn with this stroke.
PlotSeries curve_of(std::vector<PlotPoint> points, const Stroke& stroke);

// The sagittal plane: z to the right, y up.
struct SideView {
  Box box;
  double left_z_m = 0.0;  // z of the box's left edge
  double floor_px = 0.0;  // y at which height 0 is drawn
  double px_per_m = 100.0;
};
vec2 pixel_in(const SideView& view, const vec3& place_m) noexcept;
void draw_floor(cairo_t* cr, const SideView& view);
void draw_path(cairo_t* cr, const SideView& view, const std::vector<vec3>& path_m,
               const Stroke& stroke);
void draw_arrow(cairo_t* cr, const vec2& from, const vec2& to, const Stroke& stroke);
void draw_plant(cairo_t* cr, const vec2& at);  // Draws a triangle below a planted point.

// The points of a stick figure: its joints, then both heels, left first.
std::vector<vec3> figure_points(const std::vector<vec3>& joints_m,
                                const std::array<vec3, 2>& heel_m);
// A line of a stick figure, from a point's parent to the point. A sole has two lines: ankle to heel
// and heel to toe.
struct StickBone {
  int parent = 0, joint = 0;
  enum class Part { left_leg, right_leg, rest } part = Part::rest;
};
std::vector<StickBone> stick_bones(const GaitCycle& cycle, const std::vector<vec3>& points_m);
// Draws a stick figure, its left leg paler.
void draw_stick_figure(cairo_t* cr, const SideView& view, const std::vector<StickBone>& bones,
                       const std::vector<vec3>& points_m, const Stroke& stroke);

// A table of texts. The first row has the headings; `shares` are the relative widths of the
// columns.
struct Table {
  std::vector<double> shares;
  std::vector<std::vector<std::string>> rows;
};
void draw_table(cairo_t* cr, const Box& box, const Table& table);

// One column of a CSV file; a value that is not finite gives an empty cell.
struct CsvColumn {
  std::string name;
  std::vector<double> values;
};
std::string csv_text(const std::vector<CsvColumn>& columns);

}  // namespace gaitpad
