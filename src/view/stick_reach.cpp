// The plot of the circularity, and what explains all plots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "view/stick_plot.h"

namespace gaitpad {

namespace {

bool is_seen(const Reaches& reaches) {
  return std::any_of(reaches.begin(), reaches.end(), [](double r) { return r > 0.0; });
}

// What the plot shows of the radius: round the circle's 1, and all that was reached.
struct Range {
  double low = 0.8, high = 1.2;
};
Range range_of(const Reaches& reaches) {
  Range range;
  for (const double r : reaches) {
    if (!(r > 0.0)) continue;
    range.low = std::min(range.low, std::floor(r * 10.0 - 0.5) / 10.0);
    range.high = std::max(range.high, std::ceil(r * 10.0 + 0.5) / 10.0);
  }
  return range;
}

void draw_reach_grid(cairo_t* cr, const Box& plot, const Range& range) {
  fill_box(cr, plot, rgb(colour::kCard));
  const double step = range.high - range.low > 0.55 ? 0.2 : 0.1;
  const auto first = static_cast<int>(std::ceil(range.low / step - 1e-9));
  for (int i = first; i * step <= range.high + 1e-9; ++i) {
    const double y = plot.y + plot.height * (range.high - i * step) / (range.high - range.low);
    set_colour(cr, rgb(colour::kGrid));
    cairo_set_line_width(cr, 1.0);
    line(cr, {plot.x, std::round(y) + 0.5}, {plot.x + plot.width, std::round(y) + 0.5});
    cairo_stroke(cr);
    draw_text(cr, {11.0, colour::kFaint, Align::right}, {plot.x - 6.0, y + 4.0},
              fmt::format("{:.1f}", i * step));
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

// From the circle's 1 up where the stick goes beyond it, down where it falls short. Half of the
// first bar stands at either end: it is centred on the right.
void draw_bars(cairo_t* cr, const Box& plot, const Range& range, const Reaches& reaches) {
  const double height = plot.height / (range.high - range.low),
               base = plot.y + height * (range.high - 1.0);
  const double width = plot.width / kCircularityBins;
  cairo_save(cr);
  cairo_rectangle(cr, plot.x, plot.y, plot.width, plot.height);
  cairo_clip(cr);
  for (int i = 0; i <= kCircularityBins; ++i) {
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
  cairo_restore(cr);
  set_colour(cr, rgb(colour::kInk));
  cairo_set_line_width(cr, 1.5);
  line(cr, {plot.x, base}, {plot.x + plot.width, base});
  cairo_stroke(cr);
}

double swatch_width(const LegendEntry& entry) {
  using Mark = LegendEntry::Mark;
  return entry.mark == Mark::line || entry.mark == Mark::dashed ? 20.0 : 14.0;
}

void draw_mark(cairo_t* cr, const LegendEntry& entry, const vec2& at) {
  using Mark = LegendEntry::Mark;
  constexpr double kDashes[] = {6.0, 4.0};
  const double width = swatch_width(entry);
  set_colour(cr, rgb(entry.colour));
  cairo_set_line_width(cr, 2.0);
  switch (entry.mark) {
    case Mark::dashed:
      cairo_set_dash(cr, kDashes, 2, 0.0);
      [[fallthrough]];
    case Mark::line:
      line(cr, {at.x, at.y}, {at.x + width, at.y});
      cairo_stroke(cr);
      cairo_set_dash(cr, nullptr, 0, 0.0);
      return;
    case Mark::area:
      fill_box(cr, {at.x, at.y - 5.0, width, 10.0}, rgb(entry.colour, 0.35));
      stroke_box(cr, {at.x, at.y - 5.0, width, 10.0}, rgb(entry.colour), 1.0);
      return;
    case Mark::bar:
      fill_box(cr, {at.x, at.y - 5.0, width, 10.0}, rgb(entry.colour));
      return;
    case Mark::dot:
      cairo_arc(cr, at.x + width / 2, at.y, 4.0, 0.0, 2.0 * std::numbers::pi);
      cairo_fill(cr);
      return;
    case Mark::cross:
      cairo_set_line_width(cr, 1.2);
      line(cr, {at.x + 1.0, at.y}, {at.x + width - 1.0, at.y});
      line(cr, {at.x + width / 2, at.y - 6.0}, {at.x + width / 2, at.y + 6.0});
      cairo_stroke(cr);
      return;
  }
}

}  // namespace

Reaches reaches_of(const Outline& outline) noexcept {
  Reaches reaches{};
  for (int i = 0; i < kOutlineDirections; ++i) {
    const double r = outline.radius[static_cast<std::size_t>(i)];
    if (!(r > 0.0) || !std::isfinite(r)) continue;
    const double angle = i * 2.0 * std::numbers::pi / kOutlineDirections;
    const vec2 p = outline.middle + r * vec2(std::cos(angle), std::sin(angle));
    const double turn = std::atan2(p.y, p.x) / (2.0 * std::numbers::pi);
    if (!std::isfinite(turn)) continue;
    const int bin = static_cast<int>(std::lround((turn + 1.0) * kCircularityBins));
    double& reach = reaches[static_cast<std::size_t>(bin % kCircularityBins)];
    reach = std::max(reach, std::hypot(p.x, p.y));
  }
  return reaches;
}

void draw_reach(cairo_t* cr, const Box& plot, const StickPicture& stick) {
  const Reaches reaches = stick.statistics ? reaches_of(stick.statistics->outline) : Reaches{};
  const Range range = range_of(reaches);
  draw_reach_grid(cr, plot, range);
  if (is_seen(reaches)) {
    draw_bars(cr, plot, range, reaches);
  } else {
    draw_text(cr, {14.0, colour::kFaint, Align::centre},
              {plot.x + plot.width / 2, plot.y + plot.height * 0.5 - 10.0}, "not turned");
  }
  stroke_box(cr, plot, rgb(colour::kBorder), 1.0);
}

std::vector<LegendEntry> raw_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  std::vector<LegendEntry> entries = {{Mark::line, colour::kBlue, "track"}};
  if (stick.statistics && is_seen(reaches_of(stick.statistics->outline))) {
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
  if (stick.statistics && is_seen(reaches_of(stick.statistics->outline))) {
    entries.push_back({Mark::line, colour::kVermilion, "outline"});
  }
  entries.push_back({Mark::dot, colour::kGreen, "neutral"});
  return entries;
}

std::vector<LegendEntry> reach_legend(const StickPicture& stick) {
  using Mark = LegendEntry::Mark;
  if (!stick.statistics || !is_seen(reaches_of(stick.statistics->outline))) return {};
  std::vector<LegendEntry> entries = {{Mark::line, colour::kInk, "circle"},
                                      {Mark::bar, colour::kSkyBlue, "beyond it"},
                                      {Mark::bar, colour::kOrange, "short of it"}};
  const Reaches reaches = reaches_of(stick.statistics->outline);
  if (std::find(reaches.begin(), reaches.end(), 0.0) != reaches.end()) {
    entries.push_back({Mark::bar, colour::kBorder, "not seen"});
  }
  return entries;
}

void draw_legend(cairo_t* cr, const Box& box, const std::vector<LegendEntry>& entries) {
  constexpr double kRow = 20.0, kGap = 6.0, kBetween = 16.0;
  const TextStyle style{12.0, colour::kInk};
  vec2 at(box.x, box.y + kRow / 2);
  for (const LegendEntry& entry : entries) {
    const double width = swatch_width(entry) + kGap + text_width(cr, style, entry.text);
    if (at.x > box.x && at.x + width > box.x + box.width) at = {box.x, at.y + kRow};
    draw_mark(cr, entry, at);
    draw_text(cr, style, at + vec2(swatch_width(entry) + kGap, 4.0), entry.text);
    at.x += width + kBetween;
  }
}

}  // namespace gaitpad
