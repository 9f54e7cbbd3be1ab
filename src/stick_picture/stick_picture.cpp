#include "stick_picture/stick_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/shown_number.h"
#include "draw/plot.h"

namespace gaitpad {
namespace {

// A plot of stick positions: x and y have the same scale.
struct Plane {
  Box box;
  vec2 middle{0.0};          // the position that is drawn in the middle of the box
  double half_height = 1.2;  // difference of position from the box's middle to its upper edge
};
vec2 pixel_in(const Plane& plane, const vec2& position) noexcept {
  // Largest coordinate in pixels, because cairo stores them with 24 bits.
  constexpr double kFar = 1e5;
  const double scale = plane.box.height / 2.0 / plane.half_height;
  const vec2 offset = (position - plane.middle) * scale;
  return {plane.box.x + plane.box.width / 2.0 + std::clamp(offset.x, -kFar, kFar),
          plane.box.y + plane.box.height / 2.0 - std::clamp(offset.y, -kFar, kFar)};
}

// Most segments of a track that are drawn; of a longer one only every n-th is.
constexpr std::size_t kMaxSegments = 20000;
constexpr double kLeastMove = 0.7;      // pixels; a shorter move is joined to the next one
constexpr int kCurvePoints = 180;       // number of points of a zone's edge
constexpr double kTurn = 2.0 * kPi;     // a whole turn in radians
constexpr double kFarDeflection = 3.0;  // a deflection outside of every plane

using PixelOf = std::function<std::optional<vec2>(const vec2& raw)>;

bool is_finite(const vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); }

void draw_plane(cairo_t* cr, const Plane& plane) {
  fill_box(cr, plane.box, rgb(colour::kCard));
  const auto at = [&plane](double x, double y) { return pixel_in(plane, {x, y}); };
  set_colour(cr, rgb(colour::kGrid));
  cairo_set_line_width(cr, 1.0);
  for (const double v : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const vec2 p = at(v, v);
    line(cr, {std::round(p.x) + 0.5, plane.box.y},
         {std::round(p.x) + 0.5, plane.box.y + plane.box.height});
    line(cr, {plane.box.x, std::round(p.y) + 0.5},
         {plane.box.x + plane.box.width, std::round(p.y) + 0.5});
  }
  cairo_stroke(cr);
  const vec2 middle = at(0.0, 0.0);
  set_colour(cr, rgb(0xaab2bd));
  cairo_arc(cr, middle.x, middle.y, plane.box.height * 0.5 / plane.half_height, 0.0, kTurn);
  cairo_stroke(cr);
}

void draw_plane_frame(cairo_t* cr, const Plane& plane) {
  stroke_box(cr, plane.box, rgb(colour::kBorder), 1.0);
  const TextStyle word{11.0, colour::kFaint, Align::centre};
  const auto at = [&plane](double x, double y) { return pixel_in(plane, {x, y}); };
  draw_text(cr, word, at(0.0, 1.07) + vec2(0.0, 2.0), "forward");
  draw_text(cr, word, at(0.0, -1.13) + vec2(0.0, 2.0), "back");
  draw_text(cr, word, at(-1.1, 0.0) + vec2(0.0, -4.0), "left");
  draw_text(cr, word, at(1.1, 0.0) + vec2(0.0, -4.0), "right");
  for (const double v : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const std::string number = v == 0.0 ? "0" : fmt::format("{:+g}", v);
    draw_text(cr, word, vec2(at(v, 0.0).x, plane.box.y + plane.box.height + 15.0), number);
    draw_text(cr, {11.0, colour::kFaint, Align::right}, {plane.box.x - 6.0, at(0.0, v).y + 4.0},
              number);
  }
}

struct Segment {
  vec2 from, to;
};
std::vector<Segment> segments_of(const StickPicture& stick, const PixelOf& pixel_of) {
  std::vector<Segment> segments;
  for (const StickTrack& track : stick.tracks) {
    std::optional<vec2> last;
    for (const StickSample& sample : track) {
      const std::optional<vec2> p = pixel_of(sample.raw);
      if (last && p && std::hypot(p->x - last->x, p->y - last->y) < kLeastMove) continue;
      if (last && p) segments.push_back({*last, *p});
      last = p;
    }
  }
  return segments;
}

// Half-transparent lines darken where the stick was often. If there are too many segments, every
// n-th is drawn; joined segments would show moves that the stick never made.
void draw_track(cairo_t* cr, const StickPicture& stick, const PixelOf& pixel_of) {
  const std::vector<Segment> segments = segments_of(stick, pixel_of);
  const std::size_t stride = segments.size() / kMaxSegments + 1;
  set_colour(cr, rgb(colour::kBlue, 0.35));
  cairo_set_line_width(cr, 1.0);
  for (std::size_t i = 0; i < segments.size(); i += stride) {
    line(cr, segments[i].from, segments[i].to);
    cairo_stroke(cr);
  }
}

vec2 direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

std::optional<vec2> outline_point(const Outline& outline, int i) {
  const double r = outline.radius[static_cast<std::size_t>(i % kOutlineDirections)];
  if (!(r > 0.0) || !std::isfinite(r) || !is_finite(outline.middle)) return std::nullopt;
  return outline.middle + r * direction(i * kTurn / kOutlineDirections);
}

// Has a gap at each direction that the stick did not reach.
void draw_outline(cairo_t* cr, const Outline& outline, const PixelOf& pixel_of) {
  set_colour(cr, rgb(colour::kVermilion));
  cairo_set_line_width(cr, 2.0);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  for (int i = 0; i < kOutlineDirections; ++i) {
    const auto a = outline_point(outline, i), b = outline_point(outline, i + 1);
    const auto from = a ? pixel_of(*a) : std::nullopt, to = b ? pixel_of(*b) : std::nullopt;
    if (from && to) line(cr, *from, *to);
  }
  cairo_stroke(cr);
}

// Adds a zone's edge to the path: a circle, or a square if the zones are axial.
void zone_path(cairo_t* cr, const Plane& plane, const StickCalibration& c, double deflection) {
  for (int i = 0; i < kCurvePoints; ++i) {
    vec2 p = direction(i * kTurn / kCurvePoints);
    if (c.shape == ZoneShape::axial) p = p / std::max(std::fabs(p.x), std::fabs(p.y));
    const vec2 pixel = pixel_in(plane, raw_of(c, p * deflection));
    cairo_line_to(cr, pixel.x, pixel.y);
  }
  cairo_close_path(cr);
}

// Length of the calibrated stick for a length of the deflection, without the sideways zone.
double response_of(const StickCalibration& c, double deflection) {
  StickCalibration round = c;
  round.frame = {};
  round.x = round.y = {};
  round.shape = ZoneShape::radial;
  return stick_position(round, {std::min(deflection, 1.0), 0.0}).x;
}

// Adds one half (forward or back) of the sideways zone, in which x is set to 0: where the
// response's x is smaller than `sideways`.
void sideways_path(cairo_t* cr, const Plane& plane, const StickCalibration& c, double forward) {
  std::vector<vec2> edge;  // the zone's right edge; its left edge is the mirror image
  for (int i = 0; i <= 300; ++i) {
    const double length = c.inner + (kFarDeflection - c.inner) * i * i / (300.0 * 300.0);
    const double response = response_of(c, length);
    const double x = response > c.sideways ? length * c.sideways / response : length;
    edge.emplace_back(x, forward * std::sqrt(std::max(length * length - x * x, 0.0)));
  }
  const auto add = [&](const vec2& p) {
    const vec2 pixel = pixel_in(plane, raw_of(c, p));
    cairo_line_to(cr, pixel.x, pixel.y);
  };
  for (const vec2& p : edge) add(p);
  for (auto p = edge.rbegin(); p != edge.rend(); ++p) add({-p->x, p->y});
  cairo_close_path(cr);
}

void draw_sideways_zone(cairo_t* cr, const Plane& plane, const StickCalibration& c) {
  if (c.shape != ZoneShape::both || !(c.sideways > 0.0)) return;
  for (const double forward : {1.0, -1.0}) {
    cairo_new_path(cr);
    sideways_path(cr, plane, c, forward);
    set_colour(cr, rgb(colour::kOrange, 0.22));
    cairo_fill(cr);
  }
}

void draw_outer_zone(cairo_t* cr, const Plane& plane, const StickCalibration& c) {
  set_dashes(cr, true);
  zone_path(cr, plane, c, c.outer);
  set_colour(cr, rgb(colour::kPurple));
  cairo_set_line_width(cr, 1.8);
  cairo_stroke(cr);
  set_dashes(cr, false);
}

void draw_inner_zone(cairo_t* cr, const Plane& plane, const StickCalibration& c) {
  cairo_new_path(cr);
  zone_path(cr, plane, c, c.inner);
  set_colour(cr, rgb(colour::kGreen, 0.25));
  cairo_fill_preserve(cr);
  set_colour(cr, rgb(colour::kGreen));
  cairo_set_line_width(cr, 1.5);
  cairo_stroke(cr);
}

void draw_rests(cairo_t* cr, const Plane& plane, const StickStatistics& s) {
  for (const vec2& rest : s.rests) {
    if (!is_finite(rest)) continue;
    draw_dot(cr, pixel_in(plane, rest), 1.8, rgb(colour::kInk));
  }
  if (!s.centre || !is_finite(*s.centre)) return;
  const vec2 p = pixel_in(plane, *s.centre);
  set_colour(cr, rgb(colour::kInk));
  cairo_set_line_width(cr, 1.2);
  line(cr, p - vec2(9.0, 0.0), p + vec2(9.0, 0.0));
  line(cr, p - vec2(0.0, 9.0), p + vec2(0.0, 9.0));
  cairo_stroke(cr);
}

void draw_raw_plane(cairo_t* cr, const Box& box, const StickPicture& stick) {
  const Plane plane{box};
  draw_plane(cr, plane);
  {
    const Clipped clipped(cr, plane.box);
    const PixelOf pixel_of = [&plane](const vec2& raw) {
      return is_finite(raw) ? std::optional<vec2>(pixel_in(plane, raw)) : std::nullopt;
    };
    if (stick.advice) {
      draw_sideways_zone(cr, plane, stick.advice->calibration);
      draw_inner_zone(cr, plane, stick.advice->calibration);
    }
    draw_track(cr, stick, pixel_of);
    if (stick.advice) draw_outer_zone(cr, plane, stick.advice->calibration);
    if (stick.statistics) {
      draw_outline(cr, stick.statistics->outline, pixel_of);
      draw_rests(cr, plane, *stick.statistics);
    }
  }
  draw_plane_frame(cr, plane);
}

void draw_calibrated_plane(cairo_t* cr, const Box& box, const StickPicture& stick) {
  const Plane plane{box};
  draw_plane(cr, plane);
  if (stick.advice) {
    const Clipped clipped(cr, plane.box);
    StickCalibration calibration = stick.advice->calibration;
    calibration.frame = {};  // the tracks are already in the stick's frame
    const PixelOf pixel_of = [&](const vec2& raw) {
      return is_finite(raw) ? std::optional<vec2>(pixel_in(plane, stick_position(calibration, raw)))
                            : std::nullopt;
    };
    draw_track(cr, stick, pixel_of);
    if (stick.statistics) draw_outline(cr, stick.statistics->outline, pixel_of);
    draw_dot(cr, pixel_in(plane, vec2(0.0)), 5.0, rgb(colour::kGreen));
  }
  draw_plane_frame(cr, plane);
}

constexpr double kLeastHalfHeight = 0.02;  // least half height of the magnified plane, raw
constexpr std::size_t kMaxDots = 20000;

// A plane around the stick's rest, magnified so that the inner zone fills most of the height.
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
  // NaN fails these comparisons.
  for (double* v : {&plane.middle.x, &plane.middle.y}) *v = std::fabs(*v) <= 1.0 ? *v : 0.0;
  plane.half_height =
      plane.half_height > kLeastHalfHeight ? std::min(plane.half_height, 2.0) : kLeastHalfHeight;
  return plane;
}

// Gives about three lines between the middle and an edge.
double grid_step(double half_height) {
  for (const double step : {0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
    if (half_height / step < 4.0) return step;
  }
  return 0.5;
}

// Calls draw(value, index) for every grid line except those close to an edge.
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

// Draws each reported position as a dot; places that were reported often are darker.
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
  for (std::size_t i = 0; i < dots.size(); i += stride) {
    draw_dot(cr, dots[i], 2.0, rgb(colour::kBlue, 0.3));
  }
}

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

// Smallest radius from the stick's centre in each bin, as for the verdict. 0: not reached.
using Reaches = std::array<double, kCircularityBins>;

bool is_seen(const Reaches& reaches) {
  return std::any_of(reaches.begin(), reaches.end(), [](double r) { return r > 0.0; });
}

// Range of the plot's radii: around 1, the circle, and all that were reached.
PlotRange range_of(const Reaches& reaches) {
  PlotRange range{0.8, 1.2};
  for (const double r : reaches) {
    if (!(r > 0.0)) continue;
    range.min = std::min(range.min, std::floor(r * 10.0 - 0.5) / 10.0);
    range.max = std::max(range.max, std::ceil(r * 10.0 + 0.5) / 10.0);
  }
  return range;
}

void draw_reach_grid(cairo_t* cr, const Box& plot, const PlotRange& range) {
  fill_box(cr, plot, rgb(colour::kCard));
  for (const PlotTick& tick : plot_ticks(range, 5)) {
    const double y = plot.y + plot.height * (range.max - tick.value) / (range.max - range.min);
    set_colour(cr, rgb(colour::kGrid));
    cairo_set_line_width(cr, 1.0);
    line(cr, {plot.x, std::round(y) + 0.5}, {plot.x + plot.width, std::round(y) + 0.5});
    cairo_stroke(cr);
    draw_text(cr, {11.0, colour::kFaint, Align::right}, {plot.x - 6.0, y + 4.0}, tick.text);
  }
  constexpr const char* kDirections[] = {"right", "forward", "left", "back", "right"};
  for (int i = 0; i < 5; ++i) {
    const double x = plot.x + plot.width * i / 4.0;
    const Align align = i == 0 ? Align::left : i == 4 ? Align::right : Align::centre;
    set_colour(cr, rgb(colour::kGrid));
    line(cr, {std::round(x) + 0.5, plot.y}, {std::round(x) + 0.5, plot.y + plot.height});
    cairo_stroke(cr);
    draw_text(cr, {11.0, colour::kFaint, align}, {x, plot.y + plot.height + 15.0}, kDirections[i]);
  }
}

// Bars begin at the circle's 1 and point up if the stick reaches farther, down if less far. The
// first bar is centred on the direction "right", so half of it is at each end.
void draw_bars(cairo_t* cr, const Box& plot, const PlotRange& range, const Reaches& reaches) {
  const double height = plot.height / (range.max - range.min),
               base = plot.y + height * (range.max - 1.0);
  const double width = plot.width / kCircularityBins;
  for (int i = 0; i <= kCircularityBins; ++i) {
    const Clipped clipped(cr, plot);
    const double r = reaches[static_cast<std::size_t>(i % kCircularityBins)];
    if (!(r > 0.0)) {
      fill_box(cr, {plot.x + (i - 0.5) * width, plot.y, width, plot.height}, rgb(colour::kGrid));
      continue;
    }
    const double top = base - height * (r - 1.0);
    const Box bar{plot.x + (i - 0.5) * width + 1.0, std::min(top, base), width - 2.0,
                  std::max(std::fabs(base - top), 1.0)};
    fill_box(cr, bar, rgb(r >= 1.0 ? colour::kSkyBlue : colour::kOrange));
  }
  set_colour(cr, rgb(colour::kInk));
  cairo_set_line_width(cr, 1.5);
  line(cr, {plot.x, base}, {plot.x + plot.width, base});
  cairo_stroke(cr);
}

// Points at the direction with the smallest reach from the stick's centre, and names it.
void draw_worst(cairo_t* cr, const Box& plot, const Outline& outline) {
  const std::optional<int> worst = worst_direction(outline);
  if (!worst) return;
  const double share = static_cast<double>(*worst) / kOutlineDirections;
  const double x = plot.x + plot.width * share, y = plot.y + plot.height;
  set_colour(cr, rgb(colour::kVermilion));
  cairo_move_to(cr, x, y - 9.0);
  cairo_line_to(cr, x - 5.0, y);
  cairo_line_to(cr, x + 5.0, y);
  cairo_close_path(cr);
  cairo_fill(cr);
  const double reach = outline.radius[static_cast<std::size_t>(*worst)];
  const std::string text = fmt::format("worst: {:.2f} to the {}", reach, direction_text(*worst));
  const TextStyle style{11.5, colour::kVermilion, Align::left, true};
  const double most = plot.x + plot.width - text_width(cr, style, text) - 8.0;
  draw_text(cr, style,
            {std::clamp(x - 40.0, plot.x + 8.0, std::max(most, plot.x + 8.0)), plot.y + 15.0}, text,
            plot.width - 16.0);
}

void draw_reach(cairo_t* cr, const Box& plot, const StickPicture& stick) {
  const Reaches reaches = stick.statistics ? least_reaches(stick.statistics->outline) : Reaches{};
  const PlotRange range = range_of(reaches);
  draw_reach_grid(cr, plot, range);
  if (is_seen(reaches)) {
    draw_bars(cr, plot, range, reaches);
    draw_worst(cr, plot, stick.statistics->outline);
  } else {
    draw_text(cr, {14.0, colour::kFaint, Align::centre},
              {plot.x + plot.width / 2, plot.y + plot.height * 0.5 - 10.0}, "not turned");
  }
  stroke_box(cr, plot, rgb(colour::kBorder), 1.0);
}

std::vector<LegendEntry> raw_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  std::vector<LegendEntry> entries;
  if (!stick.tracks.empty()) entries.push_back({Mark::line, colour::kBlue, "track"});
  if (stick.statistics && is_seen(least_reaches(stick.statistics->outline))) {
    entries.push_back({Mark::line, colour::kVermilion, "outline"});
  }
  if (stick.statistics && stick.statistics->centre) {
    entries.push_back({Mark::cross, colour::kInk, "centre, rests"});
  }
  if (!stick.advice) return entries;
  const StickCalibration& c = stick.advice->calibration;
  entries.push_back({Mark::area, colour::kGreen, "inner zone"});
  entries.push_back({Mark::dashed, colour::kPurple, "outer zone"});
  if (c.shape == ZoneShape::both && c.sideways > 0.0) {
    entries.push_back({Mark::area, colour::kOrange, "sideways zone"});
  }
  return entries;
}

std::vector<LegendEntry> calibrated_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  if (!stick.advice) return {};
  std::vector<LegendEntry> entries = {{Mark::line, colour::kBlue, "track"}};
  if (stick.statistics && is_seen(least_reaches(stick.statistics->outline))) {
    entries.push_back({Mark::line, colour::kVermilion, "outline"});
  }
  entries.push_back({Mark::dot, colour::kGreen, "neutral"});
  return entries;
}

std::vector<LegendEntry> reach_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  if (!stick.statistics || !is_seen(least_reaches(stick.statistics->outline))) return {};
  std::vector<LegendEntry> entries = {{Mark::line, colour::kInk, "circle"},
                                      {Mark::bar, colour::kSkyBlue, "beyond it"},
                                      {Mark::bar, colour::kOrange, "short of it"}};
  const Reaches reaches = least_reaches(stick.statistics->outline);
  if (std::find(reaches.begin(), reaches.end(), 0.0) != reaches.end()) {
    entries.push_back({Mark::bar, colour::kBorder, "not seen"});
  }
  return entries;
}

// --- hands-off time: position over time, one time after the other

// Raw radius of the inner zone along the axis with the smallest range.
double inner_zone_of(const StickPicture& stick) {
  if (!stick.advice) return 0.05;
  const StickCalibration& c = stick.advice->calibration;
  return c.inner * std::min({c.x.centre - c.x.min, c.x.max - c.x.centre, c.y.centre - c.y.min,
                             c.y.max - c.y.centre});
}

// Summary of the stick's rest.
std::string strip_caption(const StickStatistics& s) {
  std::string text =
      fmt::format("Hands off for {:.1f} s: distance from the centre, raw", seconds_of(s.hands_off));
  if (s.displaced > 0)
    text += fmt::format("; {} displaced rest{}, by up to {:.2f}", s.displaced,
                        s.displaced == 1 ? "" : "s", s.displaced_by);
  if (s.wander > 0.0) text += fmt::format("; wanders by {:.3f} a second", s.wander);
  if (s.drift_per_s.value_or(0.0) > 0.0)
    text += fmt::format("; drifts by {:.4f} a second", *s.drift_per_s);
  return text;
}

void draw_strip(cairo_t* cr, const Box& box, const StickPicture& stick) {
  Plot plot;
  plot.nothing = "it was never seen let go";
  PlotSeries inside{"", rgb(colour::kBlue), 1.6, {}}, zone{"", rgb(colour::kGreen), 1.4, {}, true};
  if (stick.statistics && stick.statistics->centre) {
    const double radius = inner_zone_of(stick);
    double time_s = 0.0, highest = 1.5 * radius;
    for (const HandsOff& hands_off : stick.statistics->hands_off) {
      const double begin_s = time_s;
      for (const vec2& place : hands_off.places) {
        const double away = glm::length(place - *stick.statistics->centre);
        inside.points.emplace_back(time_s += 0.1, away);
        highest = std::max(highest, 1.4 * away);  // leaves space for a word above the curve
        if (away > radius)
          plot.marks.push_back({PlotMark::Shape::dot, {time_s, away}, rgb(colour::kVermilion)});
      }
      inside.points.emplace_back(time_s, std::nan(""));
      if (hands_off.is_displaced)
        plot.bands.push_back({begin_s, time_s, rgb(colour::kOrange, 0.3), "displaced"});
    }
    if (time_s > 0.0) zone.points = {{0.0, radius}, {time_s, radius}};
    plot.x = {0.0, std::max(time_s, 1.0)};
    plot.y = {0.0, std::min(highest, 2.0)};
  }
  plot.series = {std::move(zone), std::move(inside)};
  draw_plot(cr, box, plot);
  const Clipped clipped(cr, box);
  for (const PlotMark& mark : plot.marks)
    draw_dot(cr, pixel_in(box, plot, mark.place), 2.2, mark.colour);
}

std::vector<LegendEntry> strip_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  if (!stick.statistics || stick.statistics->hands_off.empty()) return {};
  return {{Mark::line, colour::kBlue, "mean of 0.1 s, seconds from left to right"},
          {Mark::dashed, colour::kGreen, "inner zone"},
          {Mark::dot, colour::kVermilion, "beyond it: it would walk"},
          {Mark::area, colour::kOrange, "displaced rest"}};
}

// Pixels. Each stick has a card: title, plots with their legends, numbers, verdict.
constexpr double kPageWidth = 1500.0, kMargin = 40.0, kHeadingHeight = 76.0, kBetweenCards = 24.0;
constexpr double kPadding = 24.0, kTitleHeight = 44.0, kCaptionHeight = 22.0, kPlot = 396.0,
                 kGutter = 38.0, kTicksHeight = 26.0, kLegendHeight = 48.0, kLegendRow = 20.0,
                 kNumberRow = 46.0, kVerdictHeight = 60.0, kStrip = 96.0;
constexpr double kCardWidth = kPageWidth - 2.0 * kMargin;
constexpr double kInnerWidth = kCardWidth - 2.0 * kPadding;
constexpr int kNumberColumns = 6, kNumberRows = 2;
constexpr double kStripHeight = kCaptionHeight + kStrip + kTicksHeight + kLegendHeight;
constexpr double kCardHeight = 2.0 * kPadding + kTitleHeight + kCaptionHeight + kPlot +
                               kTicksHeight + kLegendHeight + kStripHeight +
                               kNumberRows * kNumberRow + kVerdictHeight;
constexpr std::size_t kMaxSticks = 8;

constexpr const char* kUnknown = "not known";

struct Number {
  std::string label, value;
};

std::string text_or(const std::optional<double>& v, const char* none, const char* unit = "") {
  return v && std::isfinite(*v) ? fmt::format("{:.3f}{}", *v, unit) : std::string(none);
}
std::string pair_text(const std::optional<vec2>& v, const char* none) {
  if (!v || !std::isfinite(v->x) || !std::isfinite(v->y)) return none;
  return fmt::format("{}, {}", signed_number(v->x, 3), signed_number(v->y, 3));
}
std::string range_text(const std::optional<double>& min, const std::optional<double>& max) {
  if (!min && !max) return "not turned";
  const auto end = [](const std::optional<double>& v) {
    return v ? signed_number(*v, 3) : "not seen";
  };
  return fmt::format("{} to {}", end(min), end(max));
}

std::string noise_text(const StickStatistics& s) {
  if (!s.sigma) return "not known";
  const double widest = std::max(s.sigma->x, s.sigma->y);
  if (s.is_sigma_hidden) return fmt::format("below a step ({:.4f})", std::max(s.step_x, s.step_y));
  return std::isfinite(widest) ? fmt::format("{:.4f}, {:.4f}", s.sigma->x, s.sigma->y) : kUnknown;
}

std::string drift_text(const StickStatistics& s) {
  if (!s.drift_per_s) return "not known";
  return *s.drift_per_s == 0.0 ? "none" : fmt::format("{:.4f} a second", *s.drift_per_s);
}

std::string rate_text(const StickStatistics& s) {
  if (!s.rate_hz) return "not known";
  if (!s.jitter_ms) return fmt::format("{:.0f} Hz", *s.rate_hz);
  return fmt::format("{:.0f} Hz, jitter {:.2f} ms", *s.rate_hz, *s.jitter_ms);
}

std::string error_text(const StickStatistics& s) {
  if (!s.circularity_error || !std::isfinite(*s.circularity_error)) return "not turned all round";
  return fmt::format("{:.1f} %", *s.circularity_error);
}

std::vector<Number> numbers_of(const StickStatistics& s, const StickAdvice* advice) {
  const auto zone = [advice](double StickAdvice::*member) {
    return advice ? fmt::format("{:.3f}", advice->*member) : std::string(kUnknown);
  };
  return {
      {"centre x, y", pair_text(s.centre, "no rest seen")},
      {"noise at rest x, y (sigma)", noise_text(s)},
      {"hysteresis", text_or(s.hysteresis, "too few releases")},
      {"drift at rest", drift_text(s)},
      {"range x", range_text(s.min_x, s.max_x)},
      {"range y", range_text(s.min_y, s.max_y)},
      {"circularity error", error_text(s)},
      {"report rate", rate_text(s)},
      {"samples (at rest, at the rim)",
       fmt::format("{} ({}, {})", s.samples, s.rest_samples, s.rim_samples)},
      {"inner zone", zone(&StickAdvice::inner_zone)},
      {"outer zone", zone(&StickAdvice::outer_zone)},
      {"gaps, jumps, stuck",
       fmt::format("{}, {}, {}", s.gap_count ? std::to_string(*s.gap_count) : "?", s.jump_count,
                   s.stuck_count)},
  };
}

struct VerdictLook {
  const char* word;
  unsigned colour;
};
VerdictLook look_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return {"good", colour::kGreen};
    case Verdict::worn:
      return {"worn", colour::kOrange};
    case Verdict::replace:
      return {"replace", colour::kVermilion};
    case Verdict::unknown:
      break;
  }
  return {"unknown", colour::kFaint};
}

void draw_numbers(cairo_t* cr, const Box& box, const std::vector<Number>& numbers) {
  const double width = box.width / kNumberColumns;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const vec2 at(box.x + width * static_cast<double>(i % kNumberColumns),
                  box.y + kNumberRow * static_cast<double>(i / kNumberColumns));
    draw_text(cr, {11.5, colour::kFaint}, at + vec2(0.0, 14.0), numbers[i].label, width - 12.0);
    draw_text(cr, {15.0, colour::kInk}, at + vec2(0.0, 33.0), numbers[i].value, width - 12.0);
  }
}

void draw_verdict(cairo_t* cr, const Box& box, const StickAdvice& advice) {
  constexpr double kWordWidth = 136.0, kLine = 19.0;
  const VerdictLook look = look_of(advice.verdict);
  draw_dot(cr, {box.x + 8.0, box.y + 20.0}, 8.0, rgb(look.colour));
  draw_text(cr, {17.0, colour::kInk, Align::left, true}, {box.x + 26.0, box.y + 26.0}, look.word,
            kWordWidth - 26.0);
  const TextStyle style{14.0, colour::kInk};
  double y = box.y + 25.0;
  for (const std::string& l : wrapped(cr, style, advice.reason, box.width - kWordWidth, 3)) {
    draw_text(cr, style, {box.x + kWordWidth, y}, l);
    y += kLine;
  }
}

struct Panel {
  const char* caption;
  void (*draw)(cairo_t*, const Box&, const StickPicture&);
  std::vector<LegendEntry> (*legend)(const StickPicture&);
};

// Draws one plot of a card with its caption above and its legend below the tick labels.
void draw_panel(cairo_t* cr, const Box& plot, const Panel& what, const StickPicture& stick) {
  draw_text(cr, {13.0, colour::kInk, Align::left, true}, {plot.x, plot.y - 9.0}, what.caption,
            plot.width);
  what.draw(cr, plot, stick);
  draw_legend(cr, {plot.x, plot.y + plot.height + kTicksHeight, plot.width, kLegendHeight},
              what.legend(stick));
}

// Draws two square planes, then a column of two plots.
void draw_panels(cairo_t* cr, const Box& box, const StickPicture& stick) {
  const double stride = (box.width - kGutter - kPlot) / 2.0, top = box.y + kCaptionHeight;
  const auto left = [&](int column) { return std::round(box.x + kGutter + column * stride); };
  draw_panel(cr, {left(0), top, kPlot, kPlot},
             {"Raw: as the pad reports it", &draw_raw_plane, &raw_legend}, stick);
  draw_panel(cr, {left(1), top, kPlot, kPlot},
             {"Calibrated: what the character gets", &draw_calibrated_plane, &calibrated_legend},
             stick);
  const double below = kTicksHeight + kLegendRow + kCaptionHeight + 10.0;
  const double half = std::floor((kPlot - below) / 2.0);
  draw_panel(cr, {left(2), top, kPlot, half}, {"At rest, magnified, raw", &draw_rest, &rest_legend},
             stick);
  draw_panel(cr, {left(2), top + kPlot - half, kPlot, half},
             {"Reach from centre, raw", &draw_reach, &reach_legend}, stick);
  if (!stick.statistics || !stick.statistics->circularity_error) return;
  draw_text(cr, {13.0, colour::kInk, Align::right}, {left(2) + kPlot, top + kPlot - half - 9.0},
            "circularity error: " + error_text(*stick.statistics));
}

void draw_card(cairo_t* cr, const Box& card, const StickPicture& stick) {
  Box box{card.x + kPadding, card.y + kPadding, kInnerWidth, kTitleHeight};
  draw_text(cr, {19.0, colour::kInk, Align::left, true}, {box.x, box.y + 18.0}, stick.title,
            box.width);
  box.y += kTitleHeight;
  draw_panels(cr, box, stick);
  box.y += kCaptionHeight + kPlot + kTicksHeight + kLegendHeight;
  const std::string strip = stick.statistics ? strip_caption(*stick.statistics) : "Hands off";
  draw_panel(cr, {box.x + kGutter, box.y + kCaptionHeight, box.width - kGutter, kStrip},
             {strip.c_str(), &draw_strip, &strip_legend}, stick);
  box.y += kStripHeight;
  set_colour(cr, rgb(colour::kBorder));
  cairo_set_line_width(cr, 1.0);
  line(cr, {box.x, std::round(box.y) + 0.5}, {box.x + box.width, std::round(box.y) + 0.5});
  cairo_stroke(cr);
  box.y += 8.0;
  if (stick.statistics) draw_numbers(cr, box, numbers_of(*stick.statistics, stick.advice));
  box.y += kNumberRows * kNumberRow;
  if (stick.advice) draw_verdict(cr, box, *stick.advice);
}

}  // namespace

vec2 raw_of(const StickCalibration& c, const vec2& p) noexcept {
  const auto raw = [](const AxisCalibration& axis, double v) {
    return axis.centre + v * (v >= 0.0 ? axis.max - axis.centre : axis.centre - axis.min);
  };
  return {raw(c.x, p.x), raw(c.y, p.y)};
}

namespace {

// Draws a page: a heading, and below it one card for each stick.
template <typename Stick>
Surface page_of(const std::string& heading, std::span<const Stick> sticks, double card_height,
                void (*draw)(cairo_t*, const Box&, const Stick&)) {
  sticks = sticks.first(std::min(sticks.size(), kMaxSticks));
  const double height = kHeadingHeight +
                        static_cast<double>(sticks.size()) * (card_height + kBetweenCards) +
                        kMargin - kBetweenCards;
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kPageWidth),
                                             static_cast<int>(std::ceil(height))));
  const Cairo cr(cairo_create(surface.get()));
  fill_box(cr.get(), {0.0, 0.0, kPageWidth, height}, rgb(colour::kPaper));
  draw_text(cr.get(), {24.0, colour::kInk, Align::left, true}, {kMargin, 50.0}, heading,
            kCardWidth);
  Box card{kMargin, kHeadingHeight, kCardWidth, card_height};
  for (const Stick& stick : sticks) {
    fill_box(cr.get(), card, rgb(colour::kCard));
    stroke_box(cr.get(), card, rgb(colour::kBorder), 1.0);
    draw(cr.get(), card, stick);
    card.y += card_height + kBetweenCards;
  }
  return surface;
}

constexpr double kComparisonHeight =
    2.0 * kPadding + kTitleHeight + kCaptionHeight + kPlot + kTicksHeight + kLegendRow;

// Draws the zones of both calibrations side by side, and their numbers; differing ones are bold.
void draw_comparison(cairo_t* cr, const Box& card, const ComparedStick& stick) {
  const Box box{card.x + kPadding, card.y + kPadding, kInnerWidth, kTitleHeight};
  draw_text(cr, {19.0, colour::kInk, Align::left, true}, {box.x, box.y + 18.0}, stick.title,
            box.width);
  const double stride = (box.width - kGutter - kPlot) / 2.0;
  const double top = box.y + kTitleHeight + kCaptionHeight;
  const double numbers = box.x + kGutter + 2.0 * stride, half = kPlot / 2.0;
  const TextStyle name{13.0, colour::kInk, Align::left, true};
  for (int i = 0; i < 2; ++i) {
    StickAdvice advice;
    advice.calibration = *stick.calibrations[i];
    const StickPicture zones{"", {}, nullptr, &advice};
    const double x = std::round(box.x + kGutter + i * stride);
    draw_panel(cr, {x, top, kPlot, kPlot}, {stick.names[i].c_str(), &draw_raw_plane, &raw_legend},
               zones);
    draw_text(cr, name, {numbers + half + i * half / 2.0, top - 9.0}, stick.names[i],
              half / 2.0 - 6.0);
  }
  double y = top + 12.0;
  for (const ComparedNumber& number : stick.numbers) {
    const bool is_other = number.values[0] != number.values[1];
    draw_text(cr, {13.0, colour::kFaint}, {numbers, y}, number.label, half - 6.0);
    for (int i = 0; i < 2; ++i) {
      draw_text(cr, {13.0, colour::kInk, Align::left, is_other},
                {numbers + half + i * half / 2.0, y}, number.values[i], half / 2.0 - 6.0);
    }
    y += 24.0;
  }
}

}  // namespace

Surface stick_picture(const std::string& heading, std::span<const StickPicture> sticks) {
  return page_of(heading, sticks, kCardHeight, &draw_card);
}

std::optional<Error> write_comparison(const std::string& path, const std::string& heading,
                                      std::span<const ComparedStick> sticks) {
  return write_png(path, page_of(heading, sticks, kComparisonHeight, &draw_comparison).get());
}

std::optional<Error> write_stick_picture(const std::string& path, const std::string& heading,
                                         std::span<const StickPicture> sticks) {
  return write_png(path, stick_picture(heading, sticks).get());
}

}  // namespace gaitpad
