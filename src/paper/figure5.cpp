// Figure 5: one motion, three characters, with weights (a) and with an injured left leg (b).
#include <fmt/format.h>

#include <algorithm>

#include "gaitpad/limbs.h"
#include "motion/leg_pose.h"
#include "paper/figures.h"
#include "paper/page.h"

namespace gaitpad {
namespace {

constexpr int kWidth = 1500, kHeight = 1070;
constexpr double kInner = kWidth - 2.0 * kPageMargin;
constexpr int kPoses = 7;  // number of poses that are drawn of a stride
constexpr double kPanelTop = 104.0, kPanelHeight = 280.0, kPlotTop = 456.0, kPlotHeight = 300.0,
                 kTableTop = 842.0, kTableHeight = 190.0;

struct Character3 {
  std::string name;
  unsigned colour;
  const Walk* walk;
};
struct Figure5 {
  std::string name;
  bool is_limp = false;
  IkMode mode = IkMode::robust;
  std::array<Character3, 3> characters;
  // The drawn stride; all three walks have it, because weights do not change the timing.
  Ticks stride;
};

Figure5 figure_of(Study& study, const FigureStyles& styles, IkMode mode, bool is_limp) {
  Figure5 f;
  f.is_limp = is_limp;
  f.mode = mode;
  f.name = std::string(is_limp ? "figure5b" : "figure5a") + (mode == IkMode::paper ? "_paper" : "");
  f.characters = {Character3{styles.red, paper_colour::kRed, &study.walk(styles.red, mode)},
                  Character3{styles.green, paper_colour::kGreen, &study.walk(styles.green, mode)},
                  Character3{styles.blue, paper_colour::kBlue, &study.walk(styles.blue, mode)}};
  f.stride = study.figure_stride(*f.characters[0].walk);
  return f;
}

double time_of(const Figure5& f, std::size_t tick) {
  return static_cast<double>(tick - f.stride.begin) / kPaperRate_hz;
}

// The data's stride at the phases of the red character: the paper's "original motion capture".
struct DataPose {
  std::vector<vec3> joints_m;
  std::array<vec3, 2> heel_m;
  std::array<LegAngles, 2> angles_rad;
};
DataPose data_pose(const GaitCycle& cycle, double phase, double strides) {
  const CycleSample at = sample_at(cycle, phase);
  Pose pose;
  sample_local(cycle, phase, pose);
  pose.root_m = at.pelvis_m + kForward * (strides * cycle.stride_m);
  JointFrames frames;
  forward_kinematics(cycle.skeleton, pose, frames);
  DataPose data;
  data.joints_m.assign(frames.position_m.begin(), frames.position_m.begin() + pose.joint_count);
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegSample& leg = at.leg[side];
    data.heel_m[side] = data.joints_m[static_cast<std::size_t>(cycle.leg[side].joints.ankle)] +
                        leg.foot * cycle.leg[side].heel_m;
    data.angles_rad[side] = leg.angles;
  }
  return data;
}
std::vector<DataPose> data_stride(const Study& study, const Figure5& f) {
  std::vector<DataPose> all;
  const GaitCycle& cycle = study.source().cycle;
  double strides = 0.0, before = f.characters[0].walk->samples[f.stride.begin].phase;
  for (std::size_t k = f.stride.begin; k <= f.stride.end; ++k) {
    const double phase = f.characters[0].walk->samples[k].phase;
    double step = phase - before;
    step -= std::floor(step + 0.5);
    strides += step;
    before = phase;
    all.push_back(data_pose(cycle, phase, strides));
  }
  return all;
}

struct Panel {
  std::string title, words;
  unsigned colour;
  std::vector<std::vector<vec3>> poses;
  std::array<std::vector<vec3>, 2> trail;  // paths of the left and the right heel
};

Panel panel_of(const Figure5& f, const Character3& c) {
  Panel panel{c.name, "", c.colour, {}, {}};
  for (int i = 0; i < kPoses; ++i) {
    const std::size_t k =
        f.stride.begin + f.stride.count() * static_cast<std::size_t>(i) / (kPoses - 1);
    const WalkSample& sample = c.walk->samples[k];
    panel.poses.push_back(figure_points(sample.joints_m, sample.frame.heel_m));
  }
  for (std::size_t k = f.stride.begin; k <= f.stride.end; ++k) {
    for (int side : {0, 1}) panel.trail[side].push_back(c.walk->samples[k].frame.heel_m[side]);
  }
  return panel;
}
Panel panel_of_data(const std::vector<DataPose>& data) {
  Panel panel{"original data", "", paper_colour::kData, {}, {}};
  for (int i = 0; i < kPoses; ++i) {
    const DataPose& d = data[(data.size() - 1) * static_cast<std::size_t>(i) / (kPoses - 1)];
    panel.poses.push_back(figure_points(d.joints_m, d.heel_m));
  }
  for (const DataPose& d : data) {
    for (int side : {0, 1}) panel.trail[side].push_back(d.heel_m[side]);
  }
  return panel;
}

struct Extent {  // bounds of the stick figures in a panel, metres
  double low_z = 1e9, high_z = -1e9, top = 0.0;
};
Extent extent_of(const Panel& panel) {
  Extent e;
  for (const auto& pose : panel.poses) {
    for (const vec3& p : pose) {
      e = {std::min(e.low_z, p.z), std::max(e.high_z, p.z), std::max(e.top, p.y)};
    }
  }
  return e;
}

// Largest scale at which every panel fits its box.
double common_scale(const std::vector<Panel>& panels, const Box& box) {
  double scale = 1e9;
  for (const Panel& panel : panels) {
    const Extent e = extent_of(panel);
    scale = std::min({scale, (box.width - 16.0) / std::max(e.high_z - e.low_z, 0.5),
                      (box.height - 24.0) / std::max(e.top, 0.5)});
  }
  return scale;
}

void draw_panel(cairo_t* cr, const GaitCycle& cycle, const Panel& panel, const Box& box,
                double px_per_m) {
  const Extent e = extent_of(panel);
  const SideView view{box, 0.5 * (e.low_z + e.high_z) - 0.5 * box.width / px_per_m,
                      box.y + box.height - 12.0, px_per_m};
  draw_floor(cr, view);
  const auto bones = stick_bones(cycle, panel.poses[0]);
  for (std::size_t i = 0; i < panel.poses.size(); ++i) {
    const bool is_end = i == 0 || i + 1 == panel.poses.size();
    draw_stick_figure(cr, view, bones, panel.poses[i],
                      {panel.colour, is_end ? 3.0 : 2.0, is_end ? 1.0 : 0.38});
  }
  draw_path(cr, view, panel.trail[kLeftSide], {colour::kInk, 1.8, 0.75, true});
  draw_path(cr, view, panel.trail[kRightSide], {colour::kInk, 1.8});
  draw_text(cr, {15.0, panel.colour, Align::left, true}, {box.x, box.y - 2.0}, panel.title,
            box.width);
}

std::vector<PlotPoint> joint_curve(const Figure5& f, const Character3& c, Side side,
                                   LegJoint joint) {
  std::vector<PlotPoint> points;
  for (std::size_t k = f.stride.begin; k <= f.stride.end; ++k) {
    points.emplace_back(time_of(f, k), joint_deg(*c.walk, k, side, joint));
  }
  return points;
}

void draw_joint(cairo_t* cr, const Figure5& f, const std::vector<DataPose>& data, LegJoint joint,
                const Box& box) {
  const Side side = f.is_limp ? kLeftSide : kRightSide;
  std::vector<PlotPoint> original;
  for (std::size_t i = 0; i < data.size(); ++i) {
    original.emplace_back(static_cast<double>(i) / kPaperRate_hz,
                          joint_deg(data[i].angles_rad[side], joint));
  }
  Plot plot;
  plot.x = {0.0, time_of(f, f.stride.end)};
  plot.series = {curve_of(std::move(original), {paper_colour::kData, 1.5, 1.0, true})};
  for (const Character3& c : f.characters) {
    plot.series.push_back(curve_of(joint_curve(f, c, side, joint), {c.colour, 2.2}));
  }
  fit_y(plot, 5.0);
  constexpr std::array<const char*, 3> kTitles = {"hip: flexion", "knee: flexion",
                                                  "ankle: dorsiflexion"};
  plot.title = fmt::format("{} {}", side == kLeftSide ? "Left" : "Right",
                           kTitles[static_cast<std::size_t>(joint)]);
  plot.x_label = "time from the right heel's strike, s";
  plot.y_label = "angle, deg";
  for (const Ticks& flight : flights(*f.characters[0].walk, side, 0.0)) {
    if (flight.begin < f.stride.begin || flight.end > f.stride.end + 1) continue;
    plot.bands.push_back(
        {time_of(f, flight.begin), time_of(f, flight.end), rgb(paper_colour::kBand), "in flight"});
  }
  draw_plot(cr, box, plot);
}

std::string number(double v, const char* format = "{:.1f}") {
  return fmt::format(fmt::runtime(format), v);
}

// The measured values beside those of two earlier prototypes of the paper's method.
Table table_of(const Figure5& f) {
  const Side side = f.is_limp ? kLeftSide : kRightSide;
  const std::string leg = kSideNames[side];
  Table table = {{1.6, 1.0, 1.0, 1.0},
                 {{"", f.characters[0].name, f.characters[1].name, f.characters[2].name}}};
  const std::array<const char*, 3> planar = {"43.9 / 36.0 / 44.4; green with limits 41.2",
                                             "51.6 / 60.6 / 49.0; green with limits 50.6",
                                             "25.5 / 46.3 / 30.4"};
  const std::array<const char*, 3> solid = {"green over red .994 to .997 pinned, .85 to .94 free",
                                            "knee + ankle .90 to .96 pinned, .92 to 1.07 free", ""};
  for (const LegJoint joint : {LegJoint::hip, LegJoint::knee, LegJoint::ankle}) {
    const auto j = static_cast<std::size_t>(joint);
    std::vector<std::string> row = {fmt::format("{} {} range, deg", leg, kLegJointNames[j])};
    for (const Character3& c : f.characters) {
      row.push_back(number(joint_range(*c.walk, f.stride, side, joint).size()));
    }
    if (!f.is_limp) row.insert(row.end(), {planar[j], solid[j]});
    table.rows.push_back(row);
  }
  std::vector<std::string> knee = {leg + " knee, least angle, deg"},
                           rms = {leg + " hip, RMS change against red, deg"};
  for (const Character3& c : f.characters) {
    knee.push_back(number(joint_range(*c.walk, f.stride, side, LegJoint::knee).min));
    rms.push_back(
        number(joint_rms(*f.characters[0].walk, *c.walk, f.stride, side, LegJoint::hip), "{:.2f}"));
  }
  if (!f.is_limp) {
    table.shares = {1.75, 0.7, 0.7, 0.8, 2.1, 2.1};
    table.rows[0].insert(table.rows[0].end(), {"planar prototype (red / green / blue)",
                                               "3-D prototype (three motions)"});
    knee.insert(knee.end(), {"6.5 / -9.1 / 7.7; green with limits 1.0", ""});
    rms.insert(rms.end(),
               {"0 / 5.4 / 0.53", "0 / 2.8 to 3.7 pinned, 3.8 to 5.8 free / 0.5 to 0.8"});
  }
  table.rows.push_back(knee);
  table.rows.push_back(rms);
  return table;
}

std::string figure_csv(const Figure5& f, const std::vector<DataPose>& data) {
  std::vector<CsvColumn> columns = {{"time_s", {}}};
  for (std::size_t k = f.stride.begin; k < f.stride.end; ++k)
    columns[0].values.push_back(time_of(f, k));
  const auto add = [&](const std::string& name, auto value_at) {
    CsvColumn& c = columns.emplace_back(CsvColumn{name, {}});
    for (std::size_t k = f.stride.begin; k < f.stride.end; ++k) c.values.push_back(value_at(k));
  };
  for (const Character3& c : f.characters) {
    for (const Side side : {kLeftSide, kRightSide}) {
      for (const LegJoint joint : {LegJoint::hip, LegJoint::knee, LegJoint::ankle}) {
        add(fmt::format("{}_{}_{}_deg", c.name, kSideNames[side],
                        kLegJointNames[static_cast<std::size_t>(joint)]),
            [&](std::size_t k) { return joint_deg(*c.walk, k, side, joint); });
      }
      for (int axis = 0; axis < 3; ++axis) {
        const auto name = [&](const char* point) {
          return fmt::format("{}_{}_{}_{}_m", c.name, kSideNames[side], point, "xyz"[axis]);
        };
        add(name("heel"),
            [&](std::size_t k) { return c.walk->samples[k].frame.heel_m[side][axis]; });
        add(name("toe"), [&](std::size_t k) { return c.walk->samples[k].frame.toe_m[side][axis]; });
      }
    }
  }
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const LegJoint joint : {LegJoint::hip, LegJoint::knee, LegJoint::ankle}) {
      add(fmt::format("data_{}_{}_deg", kSideNames[side],
                      kLegJointNames[static_cast<std::size_t>(joint)]),
          [&](std::size_t k) {
            return joint_deg(data[k - f.stride.begin].angles_rad[side], joint);
          });
    }
    add(fmt::format("{}_in_flight", kSideNames[side]), [&](std::size_t k) {
      const WalkFrame& frame = f.characters[0].walk->samples[k].frame;
      return frame.stage == Stage::flight && frame.swing == side ? 1.0 : 0.0;
    });
  }
  return csv_text(columns);
}

Page page_of(const Study& study, const Figure5& f) {
  const std::string mode = f.mode == IkMode::paper
                               ? "paper mode: eq. (5) to the letter, raw weights, no joint limits"
                               : "robust mode";
  return blank_page(
      kWidth, kHeight,
      f.is_limp ? "Figure 5b: an injured left leg, and where it is injured"
                : "Figure 5a: one motion, three characters by their weights",
      fmt::format(
          "Motion {}, {}, stick {} forward. {}", study.source().frames.name, mode, kPaperStick,
          f.is_limp ? "Left stride: height x 0.5, length x 0.5, speed x 1.3. Weights on the "
                      "left leg: green hip 0.2, blue knee 0.8."
                    : "Weights: red all 1, green hips 0.2, blue knees 0.8."));
}

void draw_panels(cairo_t* cr, const GaitCycle& cycle, const Figure5& f,
                 const std::vector<DataPose>& data) {
  std::vector<Panel> panels;
  for (const Character3& c : f.characters) panels.push_back(panel_of(f, c));
  panels.push_back(panel_of_data(data));
  const double width = kInner / static_cast<double>(panels.size());
  Box box{kPageMargin, kPanelTop, width - 16.0, kPanelHeight};
  const double scale = common_scale(panels, box);
  for (const Panel& panel : panels) {
    draw_panel(cr, cycle, panel, box, scale);
    box.x += width;
  }
}

std::vector<LegendEntry> legend_of(const Figure5& f) {
  using Mark = LegendEntry::Mark;
  std::vector<LegendEntry> legend;
  for (const Character3& c : f.characters) legend.push_back({Mark::line, c.colour, c.name});
  legend.push_back({Mark::dashed, paper_colour::kData, "original data"});
  legend.push_back({Mark::line, colour::kInk, "trail of the right heel"});
  legend.push_back({Mark::dashed, colour::kInk, "trail of the left heel (left leg paler)"});
  return legend;
}

Figure drawn(const Study& study, const Figure5& f) {
  Page page = page_of(study, f);
  cairo_t* cr = page.cr.get();
  const std::vector<DataPose> data = data_stride(study, f);
  draw_panels(cr, study.source().cycle, f, data);
  draw_legend(cr, {kPageMargin, kPanelTop + kPanelHeight + 14.0, kInner, 24.0}, legend_of(f));
  const double plot = kInner / 3.0;
  for (const LegJoint joint : {LegJoint::hip, LegJoint::knee, LegJoint::ankle}) {
    draw_joint(cr, f, data, joint,
               {kPageMargin + 52.0 + plot * static_cast<double>(joint), kPlotTop, plot - 66.0,
                kPlotHeight});
  }
  draw_table(cr, {kPageMargin, kTableTop, kInner, kTableHeight}, table_of(f));
  return {f.name, std::move(page.surface), figure_csv(f, data)};
}

}  // namespace

Figure figure_5a(Study& study, IkMode mode) {
  return drawn(study, figure_of(study, styles_of_5a(), mode, false));
}

Figure figure_5b(Study& study, IkMode mode) {
  return drawn(study, figure_of(study, styles_of_5b(), mode, true));
}

}  // namespace gaitpad
