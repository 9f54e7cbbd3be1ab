// Figure 3 and table I: the two-stage cycle.
#include <fmt/format.h>

#include "paper/figures.h"
#include "paper/page.h"

namespace gaitpad {
namespace {

constexpr int kWidth = 1500, kHeight = 720;
constexpr double kPanelTop = 120.0, kPanelHeight = 450.0, kFloor = 530.0, kPxPerM = 220.0;
constexpr double kBehind_m = 0.60;  // of the pelvis, to a panel's left edge

struct Beginning {  // of a stage
  std::size_t tick = 0;
  Stage stage = Stage::flight;
  Side swing = kRightSide;
  std::array<bool, 2> heel{}, toe{};  // planted in its starting configuration
};

// Four in a row, beginning with the right foot's flight; and a fifth one for the last arrows.
std::vector<Beginning> beginnings(const Walk& walk) {
  std::vector<Beginning> found;
  const auto from = static_cast<std::size_t>(kFigureStart_s * kPaperRate_hz);
  for (std::size_t k = from; k < walk.samples.size() && found.size() < 5; ++k) {
    const WalkFrame &before = walk.samples[k - 1].frame, &now = walk.samples[k].frame;
    if (before.stage == now.stage) continue;
    const bool is_first = now.stage == Stage::flight && now.swing == kRightSide;
    if (found.empty() && !is_first) continue;
    // At a flight's beginning the foot still stands on its toes: a tick earlier.
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
    draw_dot(cr, at, 3.5, i == 0 ? colour::kFaint : colour::kBlue);
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

}  // namespace

Figure figure_3(Study& study) {
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

}  // namespace gaitpad
