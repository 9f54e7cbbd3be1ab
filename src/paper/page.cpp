#include "paper/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace gaitpad {
namespace {

void set_stroke(cairo_t* cr, const Stroke& stroke) {
  set_colour(cr, rgb(stroke.colour, stroke.alpha));
  cairo_set_line_width(cr, stroke.width);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  set_dashes(cr, stroke.is_dashed);
}

}  // namespace

Page blank_page(int width_px, int height_px, const std::string& title, const std::string& caption) {
  Page page;
  page.surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px));
  page.cr.reset(cairo_create(page.surface.get()));
  cairo_t* cr = page.cr.get();
  fill_box(cr, {0.0, 0.0, double(width_px), double(height_px)}, rgb(colour::kCard));
  const double width = width_px - 2.0 * kPageMargin;
  draw_text(cr, {20.0, colour::kInk, Align::left, true}, {kPageMargin, 36.0}, title, width);
  draw_text(cr, {13.0, colour::kFaint}, {kPageMargin, 58.0}, caption, width);
  return page;
}

PlotSeries curve_of(std::vector<PlotPoint> points, const Stroke& stroke) {
  PlotSeries series;
  series.colour = rgb(stroke.colour, stroke.alpha);
  series.width_px = stroke.width;
  series.points = std::move(points);
  series.is_dashed = stroke.is_dashed;
  return series;
}

vec2 pixel_in(const SideView& view, const vec3& place_m) noexcept {
  return {view.box.x + (place_m.z - view.left_z_m) * view.px_per_m,
          view.floor_px - place_m.y * view.px_per_m};
}

void draw_floor(cairo_t* cr, const SideView& view) {
  set_stroke(cr, {0xaab2bd, 1.0});
  const double y = std::round(view.floor_px) + 0.5;
  line(cr, {view.box.x, y}, {view.box.x + view.box.width, y});
  cairo_stroke(cr);
}

void draw_path(cairo_t* cr, const SideView& view, const std::vector<vec3>& path_m,
               const Stroke& stroke) {
  set_stroke(cr, stroke);
  for (const vec3& p : path_m) {
    const vec2 at = pixel_in(view, p);
    cairo_line_to(cr, at.x, at.y);
  }
  cairo_stroke(cr);
}

void draw_arrow(cairo_t* cr, const vec2& from, const vec2& to, const Stroke& stroke) {
  // Longest and shortest arrow head in pixels, and half its angle in radians.
  constexpr double kLongestHead = 9.0, kShortest = 4.0, kHalf = 0.4;
  const vec2 way = to - from;
  const double length = glm::length(way), head = std::min(kLongestHead, 0.5 * length);
  if (length < kShortest) return;
  set_stroke(cr, stroke);
  const vec2 tip = to, neck = to - way * (head / length);
  line(cr, from, neck);
  cairo_stroke(cr);
  const double angle = atan2(way.y, way.x);
  cairo_move_to(cr, tip.x, tip.y);
  for (const double side : {-kHalf, kHalf}) {
    const SinCos s = sin_cos(angle + side);
    cairo_line_to(cr, tip.x - head * 1.2 * s.cos, tip.y - head * 1.2 * s.sin);
  }
  cairo_close_path(cr);
  cairo_fill(cr);
}

void draw_plant(cairo_t* cr, const vec2& at) {
  constexpr double kHalf = 8.0, kHigh = 13.0;
  set_colour(cr, rgb(paper_colour::kPlant));
  cairo_move_to(cr, at.x, at.y + 2.0);
  cairo_line_to(cr, at.x - kHalf, at.y + 2.0 + kHigh);
  cairo_line_to(cr, at.x + kHalf, at.y + 2.0 + kHigh);
  cairo_close_path(cr);
  cairo_fill(cr);
}

std::vector<vec3> figure_points(const std::vector<vec3>& joints_m,
                                const std::array<vec3, 2>& heel_m) {
  std::vector<vec3> points = joints_m;
  points.insert(points.end(), heel_m.begin(), heel_m.end());
  return points;
}

std::vector<StickBone> stick_bones(const GaitCycle& cycle, const std::vector<vec3>& points_m) {
  // Limits of a drawn bone, in leg lengths. Fingers and loose ends of meshes are not drawn.
  constexpr double kShortest = 0.015, kLongest = 0.9, kLongestEnd = 0.5;
  using Part = StickBone::Part;
  const auto& joints = cycle.skeleton.joints;
  const double leg_m = cycle.leg[kLeftSide].length_m();
  std::vector<StickBone> bones;
  std::vector<Part> part(joints.size(), Part::rest);
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const auto parent = static_cast<std::size_t>(joints[j].parent);
    part[j] = part[parent];
    if (static_cast<int>(j) == cycle.leg[kLeftSide].joints.hip) part[j] = Part::left_leg;
    if (static_cast<int>(j) == cycle.leg[kRightSide].joints.hip) part[j] = Part::right_leg;
    const double length_m = glm::distance(points_m[parent], points_m[j]);
    const double longest = joints[j].is_end_site ? kLongestEnd : kLongest;
    if (length_m < kShortest * leg_m || length_m > longest * leg_m) continue;
    bones.push_back({joints[j].parent, static_cast<int>(j), part[j]});
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    const int heel = static_cast<int>(joints.size()) + side;
    const Part leg = side == kLeftSide ? Part::left_leg : Part::right_leg;
    bones.push_back({cycle.leg[side].joints.ankle, heel, leg});
    bones.push_back({heel, cycle.leg[side].joints.toe, leg});
  }
  return bones;
}

void draw_stick_figure(cairo_t* cr, const SideView& view, const std::vector<StickBone>& bones,
                       const std::vector<vec3>& points_m, const Stroke& stroke) {
  using Part = StickBone::Part;
  constexpr double kPale = 0.5;
  for (const Part part : {Part::left_leg, Part::rest, Part::right_leg}) {
    Stroke now = stroke;
    if (part == Part::left_leg) now.alpha *= kPale;
    if (part == Part::rest) now.alpha *= 0.8, now.width *= 0.8;
    set_stroke(cr, now);
    for (const StickBone& bone : bones) {
      if (bone.part != part) continue;
      line(cr, pixel_in(view, points_m[static_cast<std::size_t>(bone.parent)]),
           pixel_in(view, points_m[static_cast<std::size_t>(bone.joint)]));
    }
    cairo_stroke(cr);
  }
}

void draw_table(cairo_t* cr, const Box& box, const Table& table) {
  if (table.rows.empty()) return;
  const double row = box.height / static_cast<double>(table.rows.size());
  double sum = 0.0;
  for (const double share : table.shares) sum += share;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const double y = box.y + row * static_cast<double>(r);
    const TextStyle style{13.0, r == 0 ? colour::kFaint : colour::kInk, Align::left, false};
    double x = box.x;
    for (std::size_t c = 0; c < std::min(table.rows[r].size(), table.shares.size()); ++c) {
      const double width = box.width * table.shares[c] / sum;
      draw_text(cr, style, {x, y + 0.7 * row}, table.rows[r][c], width - 8.0);
      x += width;
    }
    set_stroke(cr, {colour::kGrid, 1.0});
    line(cr, {box.x, std::round(y + row) + 0.5}, {box.x + box.width, std::round(y + row) + 0.5});
    cairo_stroke(cr);
  }
}

std::string csv_text(const std::vector<CsvColumn>& columns) {
  fmt::memory_buffer out;
  std::size_t rows = 0;
  for (const CsvColumn& c : columns) {
    fmt::format_to(std::back_inserter(out), "{}{}", &c == columns.data() ? "" : ",", c.name);
    rows = std::max(rows, c.values.size());
  }
  out.push_back('\n');
  for (std::size_t r = 0; r < rows; ++r) {
    for (const CsvColumn& c : columns) {
      if (&c != columns.data()) out.push_back(',');
      if (r < c.values.size() && std::isfinite(c.values[r])) {
        fmt::format_to(std::back_inserter(out), "{:.9g}", c.values[r]);
      }
    }
    out.push_back('\n');
  }
  return fmt::to_string(out);
}

}  // namespace gaitpad
