#include "paper/figures.h"

#include <fmt/format.h>

#include <algorithm>

#include "gaitpad/flight.h"
#include "gaitpad/motion.h"
#include "paper/chain4.h"
#include "paper/claims.h"
#include "paper/flight_rules.h"
#include "paper/page.h"
#include "session/walk_export.h"

namespace gaitpad {
namespace {

// One foot's height over the clip. If a flight crosses the end of a loop, the height goes on until
// the flight's landing in the second round.
struct FootHeight {
  std::vector<double> height_m, gradient_m_s;
  std::optional<Swing> literal, robust;
  double frame_s = 0.0, low_m = 0.0, high_m = 0.0;
  std::size_t first = 0, last = 0;  // first and last frame that are shown
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

std::vector<PlotPoint> line_of(const std::vector<double>& values, const FootHeight& f,
                               double scale) {
  std::vector<PlotPoint> points;
  for (std::size_t i = f.first; i <= f.last; ++i) {
    points.emplace_back(static_cast<double>(i), values[i] * scale);
  }
  return points;
}

void draw_targets(cairo_t* cr, const Box& box, const Plot& plot, const FootHeight& f,
                  const std::array<int, 3>& frames, unsigned colour, double dy) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto frame = static_cast<std::size_t>(std::max(frames[i], 0));
    if (frame >= f.height_m.size()) continue;
    const vec2 at = pixel_in(box, plot, vec2(frames[i], 100.0 * f.height_m[frame]));
    draw_dot(cr, at, 6.0, rgb(colour));
    draw_text(cr, {14.0, colour, Align::centre, true}, at + vec2(0.0, dy),
              fmt::format("{}", i + 1));
  }
}

void draw_heights(cairo_t* cr, const FootHeight& f, const Box& box, const Plot& plot) {
  const auto strip = [&](double from_cm, double to_cm, const char* word) {
    const vec2 a = pixel_in(box, plot, vec2(plot.x.min, to_cm)),
               b = pixel_in(box, plot, vec2(plot.x.max, from_cm));
    const Clipped clip(cr, box);
    fill_box(cr, {a.x, a.y, b.x - a.x, b.y - a.y}, rgb(0xfff3d6));
    draw_text(cr, {12.0, 0x8a6d1f, Align::right}, {b.x - 8.0, b.y - 7.0}, word);
  };
  strip(plot.y.min, 100.0 * f.low_m, "within 10 % of the lowest");
  strip(100.0 * f.high_m, plot.y.max, "within 10 % of the highest");
  draw_plot(cr, box, plot);
  if (f.literal) {
    draw_targets(cr, box, plot, f, {f.literal->lift, f.literal->peak, f.literal->land},
                 colour::kVermilion, -12.0);
  }
  if (f.robust) {
    draw_targets(cr, box, plot, f, {f.robust->heel_off, f.robust->peak, f.robust->land},
                 colour::kBlue, 24.0);
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

// Figure 3 and table I: the two-stage cycle.

constexpr double kPanelTop = 120.0, kPanelHeight = 450.0, kFloor = 530.0, kPxPerM = 220.0;
constexpr double kBehind_m = 0.60;  // distance from the pelvis to a panel's left edge

struct Beginning {  // the start of a stage
  std::size_t tick = 0;
  Stage stage = Stage::flight;
  Side swing = kRightSide;
  std::array<bool, 2> heel{}, toe{};  // the foot's points that are planted at the start
};

// Four stages in a row, beginning with the right foot's flight, and a fifth for the last arrows.
std::vector<Beginning> beginnings(const Walk& walk) {
  std::vector<Beginning> found;
  const auto from = static_cast<std::size_t>(kFigureStart_s * kPaperRate_hz);
  for (std::size_t k = from; k < walk.samples.size() && found.size() < 5; ++k) {
    const WalkFrame &before = walk.samples[k - 1].frame, &now = walk.samples[k].frame;
    if (before.stage == now.stage) continue;
    const bool is_first = now.stage == Stage::flight && now.swing == kRightSide;
    if (found.empty() && !is_first) continue;
    // One tick before a flight the foot still stands on its toes.
    Beginning b{now.stage == Stage::flight ? k - 1 : k, now.stage, now.swing, {}, {}};
    for (const Side side : {kLeftSide, kRightSide}) {
      b.heel[side] = before.heel_planted[side] || now.heel_planted[side];
      b.toe[side] = before.toe_planted[side] || now.toe_planted[side];
    }
    found.push_back(b);
  }
  return found;
}

struct Node {
  const char* name;
  vec3 place_m;
  bool is_planted;
};
std::vector<Node> nodes_of(const Walk& walk, const Beginning& b) {
  const WalkFrame& f = walk.samples[b.tick].frame;
  return {{"pelvis", f.pelvis_m, false},
          {"left_heel", f.heel_m[kLeftSide], b.heel[kLeftSide]},
          {"left_toe", f.toe_m[kLeftSide], b.toe[kLeftSide]},
          {"right_heel", f.heel_m[kRightSide], b.heel[kRightSide]},
          {"right_toe", f.toe_m[kRightSide], b.toe[kRightSide]}};
}

std::array<std::string, 3> words_of(const Beginning& b) {
  const std::string swing = b.swing == kRightSide ? "right" : "left",
                    stand = b.swing == kRightSide ? "left" : "right";
  if (b.stage == Stage::flight) {
    return {fmt::format("({}) flight of the {} heel", b.swing == kRightSide ? "a" : "a, mirrored",
                        swing),
            fmt::format("Planted: {} heel and toes, {} toes.", stand, swing),
            fmt::format("The {} heel is advanced; only the {} toes stay.", swing, stand)};
  }
  return {
      fmt::format("({}) roll of the {} foot", b.swing == kRightSide ? "b" : "b, mirrored", swing),
      fmt::format("Planted: {} toes, {} heel.", stand, swing),
      fmt::format("The {} toes fall to the floor; the {} toes stay.", swing, stand)};
}

void draw_beginning(cairo_t* cr, const Study& study, const Walk& walk, const Beginning& now,
                    const Beginning& next, const Box& box) {
  const WalkSample& sample = walk.samples[now.tick];
  SideView view{box, sample.frame.pelvis_m.z - kBehind_m, kFloor, kPxPerM};
  draw_floor(cr, view);
  const auto points = figure_points(sample.joints_m, sample.frame.heel_m);
  const auto bones = stick_bones(study.model().cycle, points);
  draw_stick_figure(cr, view, bones, points, {colour::kInk, 3.4});
  const std::vector<Node> from = nodes_of(walk, now), to = nodes_of(walk, next);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const vec2 at = pixel_in(view, from[i].place_m);
    const bool is_left = std::string_view(from[i].name).starts_with("left");
    draw_arrow(cr, at, pixel_in(view, to[i].place_m),
               {i == 0 ? colour::kFaint : colour::kBlue, 1.8, is_left ? 0.6 : 1.0});
    draw_dot(cr, at, 3.5, rgb(i == 0 ? colour::kFaint : colour::kBlue));
    if (from[i].is_planted) draw_plant(cr, vec2(at.x, view.floor_px));
  }
  const auto words = words_of(now);
  draw_text(cr, {15.0, colour::kInk, Align::left, true}, {box.x, box.y - 8.0}, words[0], box.width);
  draw_text(cr, {12.5, colour::kInk}, {box.x, kFloor + 42.0}, words[1], box.width);
  draw_text(cr, {12.5, colour::kInk}, {box.x, kFloor + 60.0}, words[2], box.width);
  draw_text(cr, {12.5, colour::kInk}, {box.x, kFloor + 78.0}, "The hips move forward.", box.width);
}

std::string figure_csv(const Walk& walk, const std::vector<Beginning>& all) {
  std::string text = "time_s,stage,swing,point,x_m,y_m,z_m,planted,next_x_m,next_y_m,next_z_m\n";
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const auto now = nodes_of(walk, all[i]), next = nodes_of(walk, all[i + 1]);
    for (std::size_t n = 0; n < now.size(); ++n) {
      const vec3 &a = now[n].place_m, &b = next[n].place_m;
      text += fmt::format("{:.9g},{},{},{},{:.9g},{:.9g},{:.9g},{:d},{:.9g},{:.9g},{:.9g}\n",
                          static_cast<double>(all[i].tick - all[0].tick) / kPaperRate_hz,
                          all[i].stage == Stage::flight ? "flight" : "roll",
                          all[i].swing == kLeftSide ? "left" : "right", now[n].name, a.x, a.y, a.z,
                          now[n].is_planted, b.x, b.y, b.z);
    }
  }
  return text;
}

// Figure 4: weights on a simple articulated structure.

constexpr unsigned kLight = 0x8fb7e0, kDark = 0x173f73;
constexpr double kShownWeight = 0.2;
constexpr std::array<unsigned, kRootWeights.size()> kColours = {
    kLight, colour::kGreen, kDark, colour::kOrange, colour::kVermilion};

ChainSolve solve_with(double root_weight, IkMode mode) {
  return solve_chain(plane_chain({root_weight, 1.0, 1.0, 1.0}), figure_4_task(), mode);
}

void draw_chain(cairo_t* cr, const Box& box, const Plot& plot, const IkAngles& angles,
                const Stroke& stroke, double dot) {
  std::vector<PlotPoint> joints;
  for (const vec2& p : plane_joints(plane_chain({1.0, 1.0, 1.0, 1.0}), angles)) {
    joints.push_back(p * 100.0);
  }
  draw_curve(cr, box, plot, curve_of(joints, stroke));
  if (dot <= 0.0) return;
  for (const vec2& p : joints) draw_dot(cr, pixel_in(box, plot, p), dot, rgb(stroke.colour));
}

// The iterations of the chain and its answer, with even weights and with a stiff root.
void draw_chains(cairo_t* cr, const Box& box, IkMode mode) {
  Plot plot;
  plot.x = {-10.0, 100.0};
  const double half = 0.5 * (plot.x.max - plot.x.min) * box.height / box.width;
  plot.y = {27.0 - half, 27.0 + half};
  plot.title =
      mode == IkMode::paper ? "Eq. (5), the paper's step" : "Weighted pseudo-inverse (robust)";
  plot.x_label = "x, cm";
  plot.y_label = "y, cm";
  draw_plot(cr, box, plot);
  draw_chain(cr, box, plot, figure_4_task().start_rad, {colour::kFaint, 2.0, 0.8, true}, 0.0);
  for (const double weight : {1.0, kShownWeight}) {
    const ChainSolve solve = solve_with(weight, mode);
    const unsigned colour = weight == 1.0 ? kLight : kDark;
    for (std::size_t k = 1; k + 1 < solve.angles_rad.size(); ++k) {
      draw_chain(cr, box, plot, solve.angles_rad[k], {colour, 1.2, 0.3}, 0.0);
    }
    draw_chain(cr, box, plot, solve.answer(), {colour, 4.0}, 5.0);
  }
  const vec2 goal = pixel_in(box, plot, figure_4_task().goal_m * 100.0);
  set_colour(cr, rgb(paper_colour::kPlant));
  cairo_set_line_width(cr, 2.0);
  line(cr, goal - vec2(9.0, 0.0), goal + vec2(9.0, 0.0));
  line(cr, goal - vec2(0.0, 9.0), goal + vec2(0.0, 9.0));
  cairo_stroke(cr);
}

std::vector<PlotPoint> angle_curve(const ChainSolve& solve, int joint, std::size_t rows) {
  std::vector<PlotPoint> points;
  for (std::size_t k = 0; k < rows; ++k) {
    const IkAngles& q = solve.angles_rad[std::min(k, solve.angles_rad.size() - 1)];
    points.emplace_back(static_cast<double>(k), q[joint] / kDegree);
  }
  return points;
}

void draw_angles(cairo_t* cr, const Box& box, int joint) {
  constexpr std::size_t kShown = 61;
  Plot plot;
  plot.x = {0.0, static_cast<double>(kShown - 1)};
  for (std::size_t i = 0; i < kRootWeights.size(); ++i) {
    const bool is_main = kRootWeights[i] == 1.0 || kRootWeights[i] == kShownWeight;
    plot.series.push_back(
        curve_of(angle_curve(solve_with(kRootWeights[i], IkMode::paper), joint, kShown),
                 {kColours[i], is_main ? 3.0 : 1.6, 1.0, !is_main}));
  }
  fit_y(plot, 1.0);
  plot.title = joint == 0 ? "First angle, at the root: the weighted one, eq. (5)"
                          : "Second angle: it makes up for the root, eq. (5)";
  plot.x_label = "iteration";
  plot.y_label = "angle, deg";
  draw_plot(cr, box, plot);
}

std::string figure_csv() {
  std::vector<CsvColumn> columns = {{"iteration", {}}};
  std::size_t rows = 0;
  for (const IkMode mode : {IkMode::paper, IkMode::robust}) {
    for (const double w : kRootWeights) {
      const ChainSolve solve = solve_with(w, mode);
      rows = std::max(rows, solve.angles_rad.size());
      const std::string stem =
          fmt::format("{}_root_weight_{:g}_", mode == IkMode::paper ? "paper" : "robust", w);
      for (int j = 0; j < kChainLinks; ++j) {
        CsvColumn& c =
            columns.emplace_back(CsvColumn{fmt::format("{}joint_{}_deg", stem, j + 1), {}});
        for (const IkAngles& q : solve.angles_rad) c.values.push_back(q[j] / kDegree);
      }
      columns.push_back({stem + "error_m", solve.error_m});
    }
  }
  for (std::size_t k = 0; k < rows; ++k) columns[0].values.push_back(static_cast<double>(k));
  return csv_text(columns);
}

}  // namespace

Figure figure_2(const PaperSource& source) {
  constexpr int kWidth = 1200, kHeight = 900;
  const FootHeight f = foot_height(source, kRightSide);
  Page page =
      blank_page(kWidth, kHeight, "Figure 2: the flight of the right foot, from the motion data",
                 "Motion " + source.frames.name +
                     ". 1: gradient from - to + near the lowest height, 2: from + to - near the "
                     "highest, 3: from "
                     "- to + near the lowest.");
  cairo_t* cr = page.cr.get();
  Plot height;
  height.x = {static_cast<double>(f.first), static_cast<double>(f.last)};
  height.series = {curve_of(line_of(f.height_m, f, 100.0), {colour::kInk, 2.2})};
  height.title = "Height of the ankle";
  height.y_label = "height, cm";
  fit_y(height, 1.0);
  draw_legend(
      cr, {90.0, 80.0, kWidth - 130.0, 20.0},
      {{LegendEntry::Mark::dot, colour::kVermilion,
        f.literal ? "the paper's rule to the letter (the first low there is)"
                  : "the paper's rule to the letter finds no flight in this clip"},
       {LegendEntry::Mark::dot, colour::kBlue,
        f.robust ? "robust rule: heel-off (last low before the lift), peak, landing by speed"
                 : "the robust rule finds no whole swing in this clip"}});
  draw_heights(cr, f, {90.0, 130.0, kWidth - 130.0, 410.0}, height);
  Plot gradient;
  gradient.x = height.x;
  gradient.series = {curve_of(line_of(f.gradient_m_s, f, 1.0), {colour::kInk, 1.8})};
  gradient.title = "Its gradient";
  gradient.x_label = fmt::format("frame ({:.5g} Hz)", 1.0 / f.frame_s);
  gradient.y_label = "m/s";
  fit_y(gradient, 0.1);
  gradient.series.insert(
      gradient.series.begin(),
      curve_of({{gradient.x.min, 0.0}, {gradient.x.max, 0.0}}, {colour::kFaint, 1.0}));
  draw_plot(cr, {90.0, 610.0, kWidth - 130.0, 220.0}, gradient);
  return {"figure2", std::move(page.surface), figure_csv(f)};
}

Figure figure_3(Study& study) {
  constexpr int kWidth = 1500, kHeight = 720;
  const Walk& walk = study.walk(styles_of_5a().red, IkMode::robust);
  const std::vector<Beginning> all = beginnings(walk);
  Page page = blank_page(kWidth, kHeight, "Figure 3 and table I: the two-stage walking cycle",
                         "Each picture is the starting configuration of a stage. Arrows: where the "
                         "point will be when the next stage begins. Triangles: planted points. The "
                         "left leg is paler.");
  const double width = (kWidth - 2.0 * kPageMargin) / 4.0;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Box box{kPageMargin + width * static_cast<double>(i), kPanelTop, width - 14.0,
                  kPanelHeight};
    draw_beginning(page.cr.get(), study, walk, all[i], all[i + 1], box);
  }
  draw_legend(page.cr.get(), {kPageMargin, kHeight - 60.0, kWidth - 2.0 * kPageMargin, 24.0},
              {{LegendEntry::Mark::line, colour::kBlue, "heel and toe"},
               {LegendEntry::Mark::line, colour::kFaint, "pelvis"},
               {LegendEntry::Mark::area, paper_colour::kPlant, "planted"}});
  return {"figure3", std::move(page.surface), figure_csv(walk, all)};
}

Figure figure_4() {
  constexpr int kWidth = 1300, kHeight = 980;
  Page page =
      blank_page(kWidth, kHeight, "Figure 4: a weight on the root of a chain of four links",
                 "Same start and same goal (cross); thin lines: the iterations. With a "
                 "smaller weight the root moves less, and the other joints make up for it.");
  cairo_t* cr = page.cr.get();
  draw_legend(cr, {84.0, 76.0, kWidth - 120.0, 20.0},
              {{LegendEntry::Mark::dashed, colour::kFaint, "start"},
               {LegendEntry::Mark::line, kLight, "even weights"},
               {LegendEntry::Mark::line, kDark, "root weight 0.2"},
               {LegendEntry::Mark::cross, paper_colour::kPlant, "goal"}});
  constexpr double kHalf = (kWidth - 84.0 - 40.0 - 90.0) / 2.0;
  draw_chains(cr, {84.0, 132.0, kHalf, 350.0}, IkMode::paper);
  draw_chains(cr, {84.0 + kHalf + 90.0, 132.0, kHalf, 350.0}, IkMode::robust);
  draw_angles(cr, {84.0, 576.0, kHalf, 310.0}, 0);
  draw_angles(cr, {84.0 + kHalf + 90.0, 576.0, kHalf, 310.0}, 1);
  std::vector<LegendEntry> legend;
  for (std::size_t i = 0; i < kRootWeights.size(); ++i) {
    const bool is_main = kRootWeights[i] == 1.0 || kRootWeights[i] == kShownWeight;
    legend.push_back({is_main ? LegendEntry::Mark::line : LegendEntry::Mark::dashed, kColours[i],
                      fmt::format("root weight {:g}", kRootWeights[i])});
  }
  draw_legend(cr, {84.0, kHeight - 44.0, kWidth - 120.0, 20.0}, legend);
  return {"figure4", std::move(page.surface), figure_csv()};
}

std::vector<Figure> all_figures(Study& study) {
  std::vector<Figure> figures;
  figures.push_back(figure_2(study.source()));
  figures.push_back(figure_3(study));
  figures.push_back(figure_4());
  for (const IkMode mode : {IkMode::robust, IkMode::paper}) {
    figures.push_back(figure_5a(study, mode));
    figures.push_back(figure_5b(study, mode));
  }
  return figures;
}

std::optional<Error> write_figures(const std::string& folder, const std::vector<Figure>& figures,
                                   const std::string& claims_json) {
  auto files = OutputFiles::open(folder);
  if (!files) return files.error();
  const auto add = [&files](const std::string& name,
                            const std::string& bytes) -> std::optional<Error> {
    auto stream = files->add(name);
    if (!stream) return stream.error();
    **stream << bytes;
    return std::nullopt;
  };
  for (const Figure& figure : figures) {
    const std::string png = png_of(figure.picture.get());
    if (png.empty()) return Error{figure.name + ".png: cannot be drawn: cairo has no memory"};
    if (auto problem = add(figure.name + ".png", png)) return problem;
    if (auto problem = add(figure.name + ".csv", figure.csv)) return problem;
  }
  if (auto problem = add("claims.json", claims_json)) return problem;
  return files->publish();
}

}  // namespace gaitpad
