#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "view/stick_plot.h"

namespace gaitpad {

namespace {

constexpr double kLeastHalfHeight = 0.02;  // raw
constexpr std::size_t kMaxDots = 20000;

// The inner zone fills most of the height.
Plane plane_about_rest(const Box& box, const StickPicture& stick) {
  Plane plane{box};
  plane.half_height = 0.1;
  if (stick.statistics && stick.statistics->centre) plane.middle = *stick.statistics->centre;
  if (stick.advice) {
    const StickCalibration& c = stick.advice->calibration;
    plane.middle = {c.x.centre, c.y.centre};
    const double reach = std::max(c.y.max - c.y.centre, c.y.centre - c.y.min);
    plane.half_height = 1.3 * c.inner * reach;
  }
  // In an order that not-a-number does not pass.
  for (double* v : {&plane.middle.x, &plane.middle.y}) *v = std::fabs(*v) <= 1.0 ? *v : 0.0;
  plane.half_height =
      plane.half_height > kLeastHalfHeight ? std::min(plane.half_height, 2.0) : kLeastHalfHeight;
  return plane;
}

// About three lines between middle and edge.
double grid_step(double half_height) {
  for (const double step : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
    if (half_height / step < 4.0) return step;
  }
  return 0.5;
}

// Calls draw(value, index) for every grid line that is not at the very edge.
template <class Draw>
void for_lines(double step, double middle, double half, Draw draw) {
  const int first = static_cast<int>(std::ceil((middle - half) / step + 0.2));
  for (int i = first; i * step <= middle + half - 0.2 * step; ++i) draw(i * step, i);
}

void draw_grid(cairo_t* cr, const Plane& plane) {
  constexpr double kLabelWidth = 50.0;
  const Box& box = plane.box;
  const double step = grid_step(plane.half_height), pixels = box.height / 2.0 / plane.half_height;
  const double half_width = plane.half_height * box.width / box.height;
  const int every = static_cast<int>(std::ceil(kLabelWidth / (step * pixels)));
  const auto number = [](double v) { return v == 0.0 ? "0" : fmt::format("{:+.4g}", v); };
  set_colour(cr, rgb(colour::kGrid));
  cairo_set_line_width(cr, 1.0);
  for_lines(step, plane.middle.x, half_width, [&](double v, int) {
    const double x = std::round(pixel_in(plane, {v, 0.0}).x) + 0.5;
    line(cr, {x, box.y}, {x, box.y + box.height});
  });
  for_lines(step, plane.middle.y, plane.half_height, [&](double v, int) {
    const double y = std::round(pixel_in(plane, {0.0, v}).y) + 0.5;
    line(cr, {box.x, y}, {box.x + box.width, y});
  });
  cairo_stroke(cr);
  for_lines(step, plane.middle.x, half_width, [&](double v, int i) {
    if (i % every != 0) return;
    draw_text(cr, {11.0, colour::kFaint, Align::centre},
              {pixel_in(plane, {v, 0.0}).x, box.y + box.height + 15.0}, number(v));
  });
  for_lines(step, plane.middle.y, plane.half_height, [&](double v, int) {
    draw_text(cr, {11.0, colour::kFaint, Align::right},
              {box.x - 6.0, pixel_in(plane, {0.0, v}).y + 4.0}, number(v));
  });
}

// Positions that were reported, darker where they were often.
void draw_positions(cairo_t* cr, const Plane& plane, const StickPicture& stick) {
  std::vector<vec2> dots;
  for (const StickTrack& track : stick.tracks) {
    for (const StickSample& sample : track) {
      const vec2 p = pixel_in(plane, sample.raw);
      const vec2 d = p - vec2(plane.box.x, plane.box.y);
      if (d.x >= 0.0 && d.x <= plane.box.width && d.y >= 0.0 && d.y <= plane.box.height) {
        dots.push_back(p);
      }
    }
  }
  const std::size_t stride = dots.size() / kMaxDots + 1;
  set_colour(cr, rgb(colour::kBlue, 0.3));
  for (std::size_t i = 0; i < dots.size(); i += stride) {
    cairo_arc(cr, dots[i].x, dots[i].y, 2.0, 0.0, 2.0 * std::numbers::pi);
    cairo_fill(cr);
  }
}

}  // namespace

void draw_rest(cairo_t* cr, const Box& box, const StickPicture& stick) {
  const Plane plane = plane_about_rest(box, stick);
  fill_box(cr, box, rgb(colour::kCard));
  draw_grid(cr, plane);
  {
    const Clipped clipped(cr, box);
    if (stick.advice) draw_inner_zone(cr, plane, stick.advice->calibration);
    draw_positions(cr, plane, stick);
    if (stick.statistics) draw_rests(cr, plane, *stick.statistics);
  }
  if (stick.statistics && !stick.statistics->centre) {
    draw_text(cr, {14.0, colour::kFaint, Align::centre}, {box.x + box.width / 2.0, box.y + 22.0},
              "no rest seen");
  }
  stroke_box(cr, box, rgb(colour::kBorder), 1.0);
}

std::vector<LegendEntry> rest_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  std::vector<LegendEntry> entries = {{Mark::dot, colour::kBlue, "positions"}};
  if (stick.statistics && stick.statistics->centre) {
    entries.push_back({Mark::cross, colour::kInk, "centre, rests"});
  }
  if (stick.advice) entries.push_back({Mark::area, colour::kGreen, "inner zone"});
  return entries;
}

}  // namespace gaitpad
