#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/graph_data.h"
#include "view/panels.h"

namespace gaitpad {
namespace {

constexpr std::array<std::string_view, kShownJointCount> kJointNames = {
    "Hip flexion", "Knee flexion", "Ankle dorsiflexion"};
constexpr std::array<double, kShownJointCount> kLeastSpan_deg = {20.0, 30.0, 10.0};

// A plot's title, and at the right what its curves are now.
void draw_title(Ui& ui, std::string_view title, std::string_view unit, const Plot& plot,
                int decimals) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string text = fmt::format("{} ({})", title, unit);
  put_text(list, ui.fonts.small, ui.theme.text, at, text, width);
  float x = at.x + width;
  const float left = at.x + text_width(ui.fonts.small, text) + ui.px(8);
  for (std::size_t i = plot.series.size(); i-- > 0;) {
    const PlotSeries& series = plot.series[i];
    if (series.points.empty() || !std::isfinite(series.points.back().y)) continue;
    const std::string value =
        fmt::format("{} {:.{}f}", series.letter, series.points.back().y, decimals);
    x -= text_width(ui.fonts.tick, value);
    if (x < left) return;
    put_text(list, ui.fonts.tick, series.colour, {x, at.y + ui.px(1)}, value, width);
    x -= ui.px(8);
  }
}

void draw_graph(Ui& ui, std::string_view title, std::string_view unit, const Plot& plot,
                int decimals, double height_px) {
  draw_title(ui, title, unit, plot, decimals);
  ImGui::Dummy({1.0f, ui.fonts.small->FontSize});
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 max{at.x + ImGui::GetContentRegionAvail().x, at.y + std::round(ui.px(height_px))};
  if (ImGui::IsRectVisible(at, max)) {
    draw_plot(*ImGui::GetWindowDrawList(), at, max, plot, ui.plot_style());
  }
  ImGui::Dummy({max.x - at.x, max.y - at.y});
}

void draw_leg_choice(Ui& ui) {
  const float gap = std::round(ui.px(6)), width = ImGui::GetContentRegionAvail().x;
  const float cell = std::round(ui.px(58));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.small, ui.theme.secondary, {at.x, at.y + ui.px(4)},
           "last two cycles (s)", width - 2.0f * cell - 2.0f * gap);
  for (const Side side : {kLeftSide, kRightSide}) {
    ButtonLook look;
    look.width = cell;
    look.height = std::round(ui.px(22));
    look.is_on = ui.state.graph_leg == side;
    ImGui::SetCursorScreenPos({at.x + width - cell * (2.0f - static_cast<float>(side)) -
                                   gap * (1.0f - static_cast<float>(side)),
                               at.y});
    if (button(ui, side == kLeftSide ? "leg left" : "leg right",
               side == kLeftSide ? "left" : "right", look)) {
      ui.state.graph_leg = side;
    }
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(26))});
}

// What the letters of the curves mean.
void draw_names(Ui& ui) {
  const int count = ui.in.frame.walker_count;
  if (count <= 1) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const int columns = std::max(1, std::min(count, static_cast<int>(width / ui.px(70))));
  const float cell = width / static_cast<float>(columns), row = ui.px(15);
  for (int i = 0; i < count; ++i) {
    const ImVec2 place{at.x + cell * static_cast<float>(i % columns),
                       at.y + row * static_cast<float>(i / columns)};
    const float middle = place.y + ui.fonts.tick->FontSize / 2.0f + ui.px(1);
    list.AddLine({place.x, middle}, {place.x + ui.px(9), middle}, packed(walker_colour(ui, i)),
                 ui.px(2.5));
    put_text(list, ui.fonts.tick, ui.theme.secondary, {place.x + ui.px(13), place.y},
             walker_name(ui, i), cell - ui.px(16));
  }
  const int rows = (count + columns - 1) / columns;
  ImGui::Dummy({width, row * static_cast<float>(rows)});
}

void draw_mark_words(Ui& ui) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = ui.px(3.2), y = at.y + ui.fonts.tick->FontSize / 2.0f + ui.px(1);
  const ImU32 colour = packed(ui.theme.text);
  float x = at.x + ui.px(30);
  const auto word = [&](std::string_view text) {
    put_text(list, ui.fonts.tick, ui.theme.secondary, {x + ui.px(8), at.y}, text,
             at.x + width - x - ui.px(8));
    x += text_width(ui.fonts.tick, text) + ui.px(24);
  };
  list.AddTriangleFilled({x - r, y + r}, {x + r, y + r}, {x, y - r}, colour);
  word("lift");
  list.AddCircleFilled({x, y}, r, colour, 12);
  word("peak");
  list.AddTriangleFilled({x - r, y - r}, {x, y + r}, {x + r, y - r}, colour);
  word("landing");
  ImGui::Dummy({width, ui.fonts.tick->FontSize + ui.px(2)});
}

void draw_feet(Ui& ui, const GraphSpan& span, int walker) {
  draw_graph(ui, "Heel height", "cm", heel_plot(ui.in.history, span, walker, ui.theme), 1, 84.0);
  draw_mark_words(ui);
  text_line(ui, ui.fonts.small, ui.theme.text, "Stage and planted points");
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 max{at.x + ImGui::GetContentRegionAvail().x, at.y + std::round(ui.px(100))};
  if (ImGui::IsRectVisible(at, max)) {
    draw_spans(*ImGui::GetWindowDrawList(), at, max,
               stage_plot(ui.in.history, span, walker, ui.theme), ui.plot_style());
  }
  ImGui::Dummy({max.x - at.x, max.y - at.y});
  note(ui, "F flight, R roll, each of the left or right foot", 1);
}

}  // namespace

void draw_graphs_panel(Ui& ui) {
  const int walker = ui.walker();
  if (walker < 0) return note(ui, "nobody walks yet");
  const GraphSpan span = graph_span(ui.in.history, walker, ui.in.cast.rate_hz);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  draw_leg_choice(ui);
  draw_names(ui);
  for (std::size_t joint = 0; joint < kShownJointCount; ++joint) {
    Plot plot = joint_plot(ui.in.history, span, ui.state.graph_leg, joint, ui.theme,
                           ui.state.walker, kLeastSpan_deg[joint]);
    plot.has_x_ticks = joint + 1 == kShownJointCount;
    draw_graph(ui, kJointNames[joint], "\u00b0", plot, 0, plot.has_x_ticks ? 92.0 : 78.0);
  }
  draw_feet(ui, span, walker);
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
