// The plots of a stick's row in its picture.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "view/drawing.h"
#include "view/stick_picture.h"

namespace gaitpad {

// A part of the plane of positions, in pixels; x and y to the same scale.
struct Plane {
  Box box;
  vec2 middle{0.0};          // of what it shows
  double half_height = 1.2;  // of it
};
vec2 pixel_in(const Plane& plane, const vec2& position) noexcept;
// Raw position of a centred, ranged deflection: the zones are circles of these.
vec2 raw_of(const StickCalibration& calibration, const vec2& deflection) noexcept;

// Tracks, outline, zones as the pad reports them; the same after calibration.
void draw_raw_plane(cairo_t* cr, const Box& box, const StickPicture& stick);
void draw_calibrated_plane(cairo_t* cr, const Box& box, const StickPicture& stick);
// The inner zone and what lies in it, magnified: where the stick rests.
void draw_rest(cairo_t* cr, const Box& box, const StickPicture& stick);
// Their parts.
void draw_inner_zone(cairo_t* cr, const Plane& plane, const StickCalibration& calibration);
void draw_rests(cairo_t* cr, const Plane& plane, const StickStatistics& statistics);

// Radius from the raw middle, by direction: those of the circularity error. 0: not seen.
using Reaches = std::array<double, kCircularityBins>;
Reaches reaches_of(const Outline& outline) noexcept;
void draw_reach(cairo_t* cr, const Box& plot, const StickPicture& stick);

struct LegendEntry {
  enum class Mark { line, dashed, area, bar, dot, cross };
  Mark mark = Mark::line;
  unsigned colour = colour::kInk;
  std::string text;
};
// What of it is to be seen in the plot.
std::vector<LegendEntry> raw_legend(const StickPicture& stick);
std::vector<LegendEntry> calibrated_legend(const StickPicture& stick);
std::vector<LegendEntry> rest_legend(const StickPicture& stick);
std::vector<LegendEntry> reach_legend(const StickPicture& stick);
// In rows from the box's upper left corner on; what does not fit into its width begins a row.
void draw_legend(cairo_t* cr, const Box& box, const std::vector<LegendEntry>& entries);

}  // namespace gaitpad
