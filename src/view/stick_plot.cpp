#include "view/stick_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace gaitpad {

namespace {

constexpr std::size_t kMaxSegments = 20000;  // of the track; more are thinned out
constexpr double kLeastMove = 0.7;           // pixels; what moved less is no segment of its own
constexpr int kCurvePoints = 180;            // of a zone's edge
constexpr double kTurn = 2.0 * std::numbers::pi;  // rad
constexpr double kFarDeflection = 3.0;            // beyond every plane

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

// Where the stick was often the thin lines add up. Segments are left out, not joined: a chord would
// show a way that the stick never took.
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

// Open where a direction was not seen.
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

// The path of a zone's edge: round, or with `axial` a square.
void zone_path(cairo_t* cr, const Plane& plane, const StickCalibration& c, double deflection) {
  for (int i = 0; i < kCurvePoints; ++i) {
    vec2 p = direction(i * kTurn / kCurvePoints);
    if (c.shape == ZoneShape::axial) p = p / std::max(std::fabs(p.x), std::fabs(p.y));
    const vec2 pixel = pixel_in(plane, raw_of(c, p * deflection));
    cairo_line_to(cr, pixel.x, pixel.y);
  }
  cairo_close_path(cr);
}

// Length of the calibrated stick before the sideways zone, by that of the deflection.
double response_of(const StickCalibration& c, double deflection) {
  StickCalibration round = c;
  round.frame = {};
  round.x = round.y = {};
  round.shape = ZoneShape::radial;
  return stick_position(round, {std::min(deflection, 1.0), 0.0}).x;
}

// Where the sideways zone makes the stick straight: its x is within `sideways` of the length that
// the response gives. One half, forward or back; the edge meets x = 0's side where that length is
// `sideways`.
void sideways_path(cairo_t* cr, const Plane& plane, const StickCalibration& c, double forward) {
  std::vector<vec2> edge;  // right of it
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
  constexpr double kDashes[] = {6.0, 4.0};
  cairo_set_dash(cr, kDashes, 2, 0.0);
  zone_path(cr, plane, c, c.outer);
  set_colour(cr, rgb(colour::kPurple));
  cairo_set_line_width(cr, 1.8);
  cairo_stroke(cr);
  cairo_set_dash(cr, nullptr, 0, 0.0);
}

}  // namespace

vec2 pixel_in(const Plane& plane, const vec2& position) noexcept {
  constexpr double kFar = 1e5;  // pixels: cairo counts them in 24 bits
  const double scale = plane.box.height / 2.0 / plane.half_height;
  const vec2 offset = (position - plane.middle) * scale;
  return {plane.box.x + plane.box.width / 2.0 + std::clamp(offset.x, -kFar, kFar),
          plane.box.y + plane.box.height / 2.0 - std::clamp(offset.y, -kFar, kFar)};
}

vec2 raw_of(const StickCalibration& c, const vec2& p) noexcept {
  const auto raw = [](const AxisCalibration& axis, double v) {
    return axis.centre + v * (v >= 0.0 ? axis.max - axis.centre : axis.centre - axis.min);
  };
  return {raw(c.x, p.x), raw(c.y, p.y)};
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
  set_colour(cr, rgb(colour::kInk));
  for (const vec2& rest : s.rests) {
    if (!is_finite(rest)) continue;
    const vec2 p = pixel_in(plane, rest);
    cairo_arc(cr, p.x, p.y, 1.8, 0.0, kTurn);
    cairo_fill(cr);
  }
  if (!s.centre || !is_finite(*s.centre)) return;
  const vec2 p = pixel_in(plane, *s.centre);
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
    calibration.frame = {};  // the tracks are in it already
    const PixelOf pixel_of = [&](const vec2& raw) {
      return is_finite(raw) ? std::optional<vec2>(pixel_in(plane, stick_position(calibration, raw)))
                            : std::nullopt;
    };
    draw_track(cr, stick, pixel_of);
    if (stick.statistics) draw_outline(cr, stick.statistics->outline, pixel_of);
    const vec2 neutral = pixel_in(plane, vec2(0.0));
    cairo_arc(cr, neutral.x, neutral.y, 5.0, 0.0, kTurn);
    set_colour(cr, rgb(colour::kGreen));
    cairo_fill(cr);
  }
  draw_plane_frame(cr, plane);
}

}  // namespace gaitpad
