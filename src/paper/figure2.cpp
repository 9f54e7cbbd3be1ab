// Figure 2: gradient-based extraction of a foot's flight from the motion data.
#include <fmt/format.h>

#include <algorithm>

#include "gaitpad/flight.h"
#include "gaitpad/motion.h"
#include "paper/figures.h"
#include "paper/flight_rules.h"
#include "paper/page.h"

namespace gaitpad {
namespace {

constexpr int kWidth = 1200, kHeight = 900;

// One foot's height over the clip (a loop's second round included, as far as the flights go).
struct FootHeight {
  std::vector<double> height_m, gradient_m_s;
  std::optional<Swing> literal, robust;
  double frame_s = 0.0, low_m = 0.0, high_m = 0.0;
  std::size_t first = 0, last = 0;  // frames shown
};

FootHeight foot_height(const PaperSource& source, Side side) {
  FootHeight f;
  const Motion& motion = source.frames;
  const std::array<int, 1> joints = {motion.legs[side].ankle};
  const auto tracks = joint_tracks_m(motion, joints);
  for (const vec3& p : tracks[0]) f.height_m.push_back(p.y);
  f.frame_s = motion.frame_time_s;
  f.literal = paper_flight(motion, side);
  f.robust = robust_flight(motion, side);
  const int frames = static_cast<int>(f.height_m.size());
  const int end = f.robust ? std::max(f.robust->land, frames - 1) : frames - 1;
  for (int i = frames; i <= std::min(end, 2 * frames - 2); ++i) {
    f.height_m.push_back(f.height_m[static_cast<std::size_t>(i - frames + 1)]);
  }
  const auto [low, high] = std::ranges::minmax(f.height_m);
  f.low_m = low + kFlightBand * (high - low);
  f.high_m = high - kFlightBand * (high - low);
  f.gradient_m_s.push_back(kNoNumber);
  for (std::size_t i = 1; i < f.height_m.size(); ++i) {
    f.gradient_m_s.push_back((f.height_m[i] - f.height_m[i - 1]) / f.frame_s);
  }
  f.last = f.height_m.size() - 1;
  if (!f.literal && !f.robust) return f;
  int from = 1 << 30, to = 0;
  for (const auto& swing : {f.literal, f.robust}) {
    if (!swing) continue;
    from = std::min(from, std::min(swing->heel_off, swing->lift));
    to = std::max(to, swing->land);
  }
  const int margin = std::max(4, (to - from) / 5);
  f.first = static_cast<std::size_t>(std::max(0, from - margin));
  f.last = std::min(f.last, static_cast<std::size_t>(to + margin));
  return f;
}

Line2 line_of(const std::vector<double>& values, const FootHeight& f, double scale) {
  Line2 points;
  for (std::size_t i = f.first; i <= f.last; ++i) {
    points.emplace_back(static_cast<double>(i), values[i] * scale);
  }
  return points;
}

void draw_targets(cairo_t* cr, const PlotFrame& plot, const FootHeight& f,
                  const std::array<int, 3>& frames, unsigned colour, double dy) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto frame = static_cast<std::size_t>(std::max(frames[i], 0));
    if (frame >= f.height_m.size()) continue;
    const vec2 at = pixel_in(plot, vec2(frames[i], 100.0 * f.height_m[frame]));
    draw_dot(cr, at, 6.0, colour);
    draw_text(cr, {14.0, colour, Align::centre, true}, at + vec2(0.0, dy),
              fmt::format("{}", i + 1));
  }
}

void draw_heights(cairo_t* cr, const FootHeight& f, const PlotFrame& plot) {
  const PlotFrame& p = plot;
  const auto strip = [&](double from_cm, double to_cm, const char* word) {
    const vec2 a = pixel_in(p, vec2(p.x.min, to_cm)), b = pixel_in(p, vec2(p.x.max, from_cm));
    const Clipped clip(cr, p.box);
    fill_box(cr, {a.x, a.y, b.x - a.x, b.y - a.y}, rgb(0xfff3d6));
    draw_text(cr, {12.0, 0x8a6d1f, Align::right}, {b.x - 8.0, b.y - 7.0}, word);
  };
  strip(p.y.min, 100.0 * f.low_m, "within 10 % of the lowest");
  strip(100.0 * f.high_m, p.y.max, "within 10 % of the highest");
  draw_frame(cr, p);
  draw_curve(cr, p, line_of(f.height_m, f, 100.0), {colour::kInk, 2.2});
  if (f.literal) {
    draw_targets(cr, p, f, {f.literal->lift, f.literal->peak, f.literal->land}, colour::kVermilion,
                 -12.0);
  }
  if (f.robust) {
    draw_targets(cr, p, f, {f.robust->heel_off, f.robust->peak, f.robust->land}, colour::kBlue,
                 24.0);
  }
}

std::string figure_csv(const FootHeight& f) {
  const std::size_t n = f.height_m.size();
  std::vector<double> time(n), low(n, f.low_m), high(n, f.high_m), literal(n, 0.0), robust(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) time[i] = static_cast<double>(i) * f.frame_s;
  const auto mark = [n](std::vector<double>& to, const std::array<int, 3>& frames) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(std::max(frames[i], 0));
      if (at < n) to[at] = static_cast<double>(i + 1);
    }
  };
  if (f.literal) mark(literal, {f.literal->lift, f.literal->peak, f.literal->land});
  if (f.robust) mark(robust, {f.robust->heel_off, f.robust->peak, f.robust->land});
  return csv_text({{"time_s", time},
                   {"right_ankle_height_m", f.height_m},
                   {"right_ankle_gradient_m_s", f.gradient_m_s},
                   {"low_threshold_m", low},
                   {"high_threshold_m", high},
                   {"paper_target", literal},
                   {"robust_target", robust}});
}

}  // namespace

Figure figure_2(const PaperSource& source) {
  const FootHeight f = foot_height(source, kRightSide);
  Page page =
      blank_page(kWidth, kHeight, "Figure 2: the flight of the right foot, from the motion data",
                 "Motion " + source.frames.name +
                     ". 1: gradient from - to + near the lowest height, 2: from + to - near the "
                     "highest, 3: from "
                     "- to + near the lowest.");
  cairo_t* cr = page.cr.get();
  PlotFrame height;
  height.box = {90.0, 130.0, kWidth - 130.0, 410.0};
  height.x = {static_cast<double>(f.first), static_cast<double>(f.last)};
  height.y = range_of({line_of(f.height_m, f, 100.0)}, 1.0);
  height.title = "Height of the ankle";
  height.y_label = "height, cm";
  draw_legend(
      cr, {90.0, 80.0, kWidth - 130.0, 20.0},
      {{LegendEntry::Mark::dot, colour::kVermilion,
        f.literal ? "the paper's rule to the letter (the first low there is)"
                  : "the paper's rule to the letter finds no flight in this clip"},
       {LegendEntry::Mark::dot, colour::kBlue,
        f.robust ? "robust rule: heel-off (last low before the lift), peak, landing by speed"
                 : "the robust rule finds no whole swing in this clip"}});
  draw_heights(cr, f, height);
  PlotFrame gradient = height;
  gradient.box = {90.0, 610.0, kWidth - 130.0, 220.0};
  gradient.title = "Its gradient";
  gradient.x_label = fmt::format("frame ({:.5g} Hz)", 1.0 / f.frame_s);
  gradient.y_label = "m/s";
  const Line2 slope = line_of(f.gradient_m_s, f, 1.0);
  gradient.y = range_of({slope}, 0.1);
  draw_frame(cr, gradient);
  draw_curve(cr, gradient, {{gradient.x.min, 0.0}, {gradient.x.max, 0.0}}, {colour::kFaint, 1.0});
  draw_curve(cr, gradient, slope, {colour::kInk, 1.8});
  return {"figure2", std::move(page.surface), figure_csv(f)};
}

}  // namespace gaitpad
