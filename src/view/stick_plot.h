// The three plots of a stick's row in its picture.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "view/drawing.h"
#include "view/stick_picture.h"

namespace gaitpad {

inline constexpr double kPlaneHalfWidth = 1.2;  // what a plane shows of x and y, about 0

// Pixel of a raw or calibrated position in a square plane.
vec2 pixel_in(const Box& plane, const vec2& position) noexcept;
// Raw position of a centred, ranged deflection: the zones are circles of these.
vec2 raw_of(const StickCalibration& calibration, const vec2& deflection) noexcept;

// Tracks, outline, zones as the pad reports them; the same after calibration.
void draw_raw_plane(cairo_t* cr, const Box& plane, const StickPicture& stick);
void draw_calibrated_plane(cairo_t* cr, const Box& plane, const StickPicture& stick);

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
std::vector<LegendEntry> reach_legend(const StickPicture& stick);
// In rows from the box's upper left corner on; what does not fit into its width begins a row.
void draw_legend(cairo_t* cr, const Box& box, const std::vector<LegendEntry>& entries);

}  // namespace gaitpad
