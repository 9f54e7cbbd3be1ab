#include "view/stick_picture.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/files.h"
#include "view/drawing.h"
#include "view/stick_plot.h"

namespace gaitpad {

namespace {

// Pixels. A row is a card: title, plots with their legends, numbers, verdict.
constexpr double kPageWidth = 1500.0, kMargin = 40.0, kHeadingHeight = 76.0, kBetweenCards = 24.0;
constexpr double kPadding = 24.0, kTitleHeight = 44.0, kCaptionHeight = 22.0, kPlot = 396.0,
                 kGutter = 38.0, kTicksHeight = 26.0, kLegendHeight = 48.0, kLegendRow = 20.0,
                 kNumberRow = 46.0, kVerdictHeight = 60.0;
constexpr double kCardWidth = kPageWidth - 2.0 * kMargin;
constexpr double kInnerWidth = kCardWidth - 2.0 * kPadding;
constexpr int kNumberColumns = 6, kNumberRows = 2;
constexpr double kCardHeight = 2.0 * kPadding + kTitleHeight + kCaptionHeight + kPlot +
                               kTicksHeight + kLegendHeight + kNumberRows * kNumberRow +
                               kVerdictHeight;
constexpr std::size_t kMaxSticks = 8;

constexpr const char* kUnknown = "not known";

struct Number {
  std::string label, value;
};

std::string signed_text(double v) { return fmt::format("{:+.3f}", v); }
// With what is said where it is none.
std::string text_or(const std::optional<double>& v, const char* none, const char* unit = "") {
  return v && std::isfinite(*v) ? fmt::format("{:.3f}{}", *v, unit) : std::string(none);
}
std::string pair_text(const std::optional<vec2>& v, const char* none) {
  if (!v || !std::isfinite(v->x) || !std::isfinite(v->y)) return none;
  return fmt::format("{}, {}", signed_text(v->x), signed_text(v->y));
}
std::string range_text(const std::optional<double>& min, const std::optional<double>& max) {
  if (!min && !max) return "not turned";
  const auto end = [](const std::optional<double>& v) { return v ? signed_text(*v) : "not seen"; };
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
       fmt::format("{}, {}, {}", s.gaps ? std::to_string(*s.gaps) : "?", s.jumps, s.stuck)},
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
  set_colour(cr, rgb(look.colour));
  cairo_arc(cr, box.x + 8.0, box.y + 20.0, 8.0, 0.0, 6.283185307179586);
  cairo_fill(cr);
  draw_text(cr, {17.0, colour::kInk, Align::left, true}, {box.x + 26.0, box.y + 26.0}, look.word,
            kWordWidth - 26.0);
  const TextStyle style{14.0, colour::kInk};
  double y = box.y + 25.0;
  for (const std::string& l : wrapped(cr, style, advice.reason, box.width - kWordWidth, 3)) {
    draw_text(cr, style, {box.x + kWordWidth, y}, l);
    y += kLine;
  }
}

struct Plot {
  const char* caption;
  void (*draw)(cairo_t*, const Box&, const StickPicture&);
  std::vector<LegendEntry> (*legend)(const StickPicture&);
};

// Caption above, legend below the place for tick labels.
void draw_plot(cairo_t* cr, const Box& plot, const Plot& what, const StickPicture& stick) {
  draw_text(cr, {13.0, colour::kInk, Align::left, true}, {plot.x, plot.y - 9.0}, what.caption,
            plot.width);
  what.draw(cr, plot, stick);
  draw_legend(cr, {plot.x, plot.y + plot.height + kTicksHeight, plot.width, kLegendHeight},
              what.legend(stick));
}

// Two square planes, and a column of two plots.
void draw_plots(cairo_t* cr, const Box& box, const StickPicture& stick) {
  const double stride = (box.width - kGutter - kPlot) / 2.0, top = box.y + kCaptionHeight;
  const auto left = [&](int column) { return std::round(box.x + kGutter + column * stride); };
  draw_plot(cr, {left(0), top, kPlot, kPlot},
            {"Raw: as the pad reports it", &draw_raw_plane, &raw_legend}, stick);
  draw_plot(cr, {left(1), top, kPlot, kPlot},
            {"Calibrated: what the character gets", &draw_calibrated_plane, &calibrated_legend},
            stick);
  const double below = kTicksHeight + kLegendRow + kCaptionHeight + 10.0;
  const double half = std::floor((kPlot - below) / 2.0);
  draw_plot(cr, {left(2), top, kPlot, half}, {"At rest, magnified, raw", &draw_rest, &rest_legend},
            stick);
  draw_plot(cr, {left(2), top + kPlot - half, kPlot, half},
            {"Reach by direction, raw", &draw_reach, &reach_legend}, stick);
  if (!stick.statistics || !stick.statistics->circularity_error) return;
  draw_text(cr, {13.0, colour::kInk, Align::right}, {left(2) + kPlot, top + kPlot - half - 9.0},
            "circularity error: " + error_text(*stick.statistics));
}

void draw_card(cairo_t* cr, const Box& card, const StickPicture& stick) {
  fill_box(cr, card, rgb(colour::kCard));
  stroke_box(cr, card, rgb(colour::kBorder), 1.0);
  Box box{card.x + kPadding, card.y + kPadding, kInnerWidth, kTitleHeight};
  draw_text(cr, {19.0, colour::kInk, Align::left, true}, {box.x, box.y + 18.0}, stick.title,
            box.width);
  box.y += kTitleHeight;
  draw_plots(cr, box, stick);
  box.y += kCaptionHeight + kPlot + kTicksHeight + kLegendHeight;
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

Surface stick_picture(const std::string& heading, std::span<const StickPicture> sticks) {
  sticks = sticks.first(std::min(sticks.size(), kMaxSticks));
  const double height = kHeadingHeight +
                        static_cast<double>(sticks.size()) * (kCardHeight + kBetweenCards) +
                        kMargin - kBetweenCards;
  Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(kPageWidth),
                                             static_cast<int>(std::ceil(height))));
  const Cairo cr(cairo_create(surface.get()));
  fill_box(cr.get(), {0.0, 0.0, kPageWidth, height}, rgb(colour::kPaper));
  draw_text(cr.get(), {24.0, colour::kInk, Align::left, true}, {kMargin, 50.0}, heading,
            kCardWidth);
  Box card{kMargin, kHeadingHeight, kCardWidth, kCardHeight};
  for (const StickPicture& stick : sticks) {
    draw_card(cr.get(), card, stick);
    card.y += kCardHeight + kBetweenCards;
  }
  return surface;
}

std::optional<Error> write_stick_picture(const std::string& path, const std::string& heading,
                                         std::span<const StickPicture> sticks) {
  const Surface surface = stick_picture(heading, sticks);
  const bool is_drawn = cairo_surface_status(surface.get()) == CAIRO_STATUS_SUCCESS;
  const std::string png = is_drawn ? png_of(surface.get()) : std::string();
  if (png.empty()) return Error{path + ": cannot be drawn: cairo has no memory"};
  return write_file(path, png);
}

}  // namespace gaitpad
