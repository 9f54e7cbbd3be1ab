// Figure 4: weights on a simple articulated structure.
#include <fmt/format.h>

#include <algorithm>

#include "paper/chain4.h"
#include "paper/figures.h"
#include "paper/page.h"

namespace gaitpad {
namespace {

constexpr int kWidth = 1300, kHeight = 980;
constexpr unsigned kLight = 0x8fb7e0, kDark = 0x173f73;
constexpr double kShownWeight = 0.2;
constexpr std::array<unsigned, kRootWeights.size()> kColours = {
    kLight, colour::kGreen, kDark, colour::kOrange, colour::kVermilion};

ChainSolve solve_with(double root_weight, IkMode mode) {
  return solve_chain(plane_chain({root_weight, 1.0, 1.0, 1.0}), figure_4_task(), mode);
}

void draw_chain(cairo_t* cr, const PlotFrame& plot, const IkAngles& angles, const Stroke& stroke,
                double dot) {
  Line2 joints;
  for (const vec2& p : plane_joints(plane_chain({1.0, 1.0, 1.0, 1.0}), angles)) {
    joints.push_back(p * 100.0);
  }
  draw_curve(cr, plot, joints, stroke);
  if (dot <= 0.0) return;
  for (const vec2& p : joints) draw_dot(cr, pixel_in(plot, p), dot, stroke.colour);
}

// The chain's first two iterations and its answer, even and with a stiff root.
void draw_chains(cairo_t* cr, const Box& box, IkMode mode) {
  PlotFrame plot;
  plot.box = box;
  plot.x = {-10.0, 100.0};
  const double half = 0.5 * (plot.x.max - plot.x.min) * box.height / box.width;
  plot.y = {27.0 - half, 27.0 + half};
  plot.title =
      mode == IkMode::paper ? "Eq. (5), the paper's step" : "Weighted pseudo-inverse (robust)";
  plot.x_label = "x, cm";
  plot.y_label = "y, cm";
  draw_frame(cr, plot);
  draw_chain(cr, plot, figure_4_task().start_rad, {colour::kFaint, 2.0, 0.8, true}, 0.0);
  for (const double weight : {1.0, kShownWeight}) {
    const ChainSolve solve = solve_with(weight, mode);
    const unsigned colour = weight == 1.0 ? kLight : kDark;
    for (std::size_t k = 1; k + 1 < solve.angles_rad.size(); ++k) {
      draw_chain(cr, plot, solve.angles_rad[k], {colour, 1.2, 0.3}, 0.0);
    }
    draw_chain(cr, plot, solve.answer(), {colour, 4.0}, 5.0);
  }
  const vec2 goal = pixel_in(plot, figure_4_task().goal_m * 100.0);
  set_colour(cr, rgb(paper_colour::kPlant));
  cairo_set_line_width(cr, 2.0);
  line(cr, goal - vec2(9.0, 0.0), goal + vec2(9.0, 0.0));
  line(cr, goal - vec2(0.0, 9.0), goal + vec2(0.0, 9.0));
  cairo_stroke(cr);
}

Line2 angle_curve(const ChainSolve& solve, int joint, std::size_t rows) {
  Line2 points;
  for (std::size_t k = 0; k < rows; ++k) {
    const IkAngles& q = solve.angles_rad[std::min(k, solve.angles_rad.size() - 1)];
    points.emplace_back(static_cast<double>(k), q[joint] / kDegree);
  }
  return points;
}

void draw_angles(cairo_t* cr, const Box& box, int joint) {
  constexpr std::size_t kShown = 61;
  std::vector<Line2> curves;
  for (const double w : kRootWeights) {
    curves.push_back(angle_curve(solve_with(w, IkMode::paper), joint, kShown));
  }
  PlotFrame plot;
  plot.box = box;
  plot.x = {0.0, static_cast<double>(kShown - 1)};
  plot.y = range_of(curves, 1.0);
  plot.title = joint == 0 ? "First angle, at the root: the weighted one, eq. (5)"
                          : "Second angle: it makes up for the root, eq. (5)";
  plot.x_label = "iteration";
  plot.y_label = "angle, deg";
  draw_frame(cr, plot);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const bool is_main = kRootWeights[i] == 1.0 || kRootWeights[i] == kShownWeight;
    draw_curve(cr, plot, curves[i], {kColours[i], is_main ? 3.0 : 1.6, 1.0, !is_main});
  }
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

Figure figure_4() {
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

}  // namespace gaitpad
