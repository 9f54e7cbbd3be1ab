#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "view/panels.h"
#include "view/ui_bars.h"

namespace gaitpad {
namespace {

struct PanelPart {
  Panel panel;
  std::string_view title;
  Action action;  // that opens and closes it
  void (*draw)(Ui& ui);
};
constexpr PanelPart kParts[] = {
    {Panel::pad, "Pad", Action::panel_pad, &draw_pad_panel},
    {Panel::control, "Control", Action::panel_control, &draw_control_panel},
    {Panel::style, "Style", Action::panel_style, &draw_style_panel},
    {Panel::graphs, "Graphs", Action::panel_graphs, &draw_graphs_panel},
    {Panel::solver, "Solver", Action::panel_solver, &draw_solver_panel},
    {Panel::loop, "Loop", Action::panel_loop, &draw_loop_panel},
};

bool has_walker(Panel panel) { return panel != Panel::pad && panel != Panel::loop; }

void draw_heading(Ui& ui, const PanelPart& part) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, close = std::round(ui.px(20));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  put_text(list, ui.fonts.heading, ui.theme.text, at, part.title, width - close);
  if (has_walker(part.panel)) {
    const float x = text_width(ui.fonts.heading, part.title) + ui.px(10);
    const bool is_for_all = ui.state.walker < 0 && part.panel != Panel::graphs;
    const std::string who = walker_name(ui, ui.walker());
    put_text(list, ui.fonts.small, ui.theme.secondary, {at.x + x, at.y + ui.px(2)},
             is_for_all ? "all, numbers of " + who : who, width - close - x - ui.px(4));
  }
  ImGui::SetCursorScreenPos({at.x + width - close, at.y - ui.px(2)});
  ButtonLook look;
  look.icon = Icon::close;
  look.width = look.height = close;
  if (button(ui, fmt::format("close {}", kPanelNames[static_cast<std::size_t>(part.panel)]), "",
             look)) {
    ui.out.actions.push_back(part.action);
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(23))});
}

void draw_separator(Ui& ui) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float pad = ImGui::GetStyle().WindowPadding.x;
  ImGui::GetWindowDrawList()->AddLine(
      {at.x - pad, at.y + ui.px(1)},
      {at.x + ImGui::GetContentRegionAvail().x + pad, at.y + ui.px(1)}, packed(ui.theme.border));
  ImGui::Dummy({1.0f, ui.px(4)});
}

// Whom panels tell of: a button for each, and one for all.
void draw_cast(Ui& ui) {
  const int count = ui.in.frame.walker_count;
  if (count <= 1) return;
  const float gap = std::round(ui.px(6)), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.heading, ui.theme.text, {at.x, at.y + ui.px(1)},
           "Characters", width - ui.px(48));
  ButtonLook all;
  all.is_on = ui.state.walker < 0;
  all.height = std::round(ui.px(22));
  all.width = std::round(ui.px(44));
  ImGui::SetCursorScreenPos({at.x + width - all.width, at.y - ui.px(2)});
  if (button(ui, "walker all", "all", all)) ui.state.walker = -1;
  const float cell = std::floor((width - gap) / 2.0f);
  for (int i = 0; i < count; ++i) {
    if (i % 2 == 1) ImGui::SameLine(0.0f, gap);
    ButtonLook look;
    look.is_on = ui.state.walker == i;
    look.dot = walker_colour(ui, i);
    look.width = cell;
    look.height = std::round(ui.px(22));
    if (button(ui, fmt::format("walker {}", i + 1), walker_name(ui, i), look)) {
      ui.state.walker = i;
    }
  }
  draw_separator(ui);
}

void draw_panel(Ui& ui, const PanelPart& part, bool has_just_opened) {
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const auto index = static_cast<std::size_t>(part.panel);
  ImGui::PushID(static_cast<int>(index));
  draw_heading(ui, part);
  part.draw(ui);
  ImGui::PopID();
  const float end = ImGui::GetCursorScreenPos().y;
  keep_item(fmt::format("area {}", kPanelNames[index]), begin, {begin.x + width, end});
  // What was opened is to be seen: its whole, at least its beginning.
  if (!has_just_opened) return;
  const ImRect seen = ImGui::GetCurrentWindow()->InnerRect;
  const float hidden = std::min(end - seen.Max.y, begin.y - seen.Min.y - ui.px(8));
  if (hidden > 0.0f) ImGui::SetScrollY(ImGui::GetScrollY() + hidden);
}

enum class Column { left, right };

void draw_column(Ui& ui, const UiLayout& layout, Column column) {
  const bool is_left_one = column == Column::left;
  const UiRect& rect = is_left_one ? layout.left : layout.right;
  if (rect.is_empty()) return;
  const bool has_both = !layout.left.is_empty() && !layout.right.is_empty();
  const char* id = is_left_one ? "left column" : "right column";
  begin_area(ui, id, rect, ui.theme.panel, {14.0f, 10.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), std::round(ui.px(5))});
  if (is_left_one || !has_both) draw_cast(ui);
  bool is_first = true;
  for (const PanelPart& part : kParts) {
    const auto index = static_cast<std::size_t>(part.panel);
    const bool is_mine = !has_both || is_left(part.panel) == is_left_one;
    if (!ui.state.is_open[index] || !is_mine) continue;
    if (!is_first) draw_separator(ui);
    is_first = false;
    draw_panel(ui, part, !ui.state.memory.was_open[index]);
  }
  ImGui::PopStyleVar();
  end_area();
}

}  // namespace

void draw_columns(Ui& ui, const UiLayout& layout) {
  if (!ui.state.memory.has_drawn) ui.state.memory.was_open = ui.state.is_open;
  ui.state.memory.has_drawn = true;
  draw_column(ui, layout, Column::left);
  draw_column(ui, layout, Column::right);
  ui.state.memory.was_open = ui.state.is_open;
}

}  // namespace gaitpad
