#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "view/ui_bars.h"

namespace gaitpad {
namespace {

constexpr double kRowPixels = 24.0, kHeadingPixels = 32.0, kColumnPixels = 420.0;
constexpr double kKeysPixels = 124.0, kButtonPixels = 86.0;

// A heading and the rows below it, as one column holds them together.
struct Row {
  std::string_view heading;  // not empty: this and nothing else
  std::vector<std::string> keys;
  std::string_view button, text;
  std::vector<std::string_view> names;  // of the actions that it tells of
};

bool is_numbered_style(Action action) {
  return action >= Action::style_1 && action <= Action::style_9;
}

// The nine keys of the styles in one row: "1 .. 9".
void add_style(const ActionInfo& info, Row& row) {
  row.names.push_back(info.name);
  if (info.action != Action::style_9) return;
  row.keys[0] += fmt::format(" .. {}", key_name(info.key));
  row.keys[1] += fmt::format(" .. {}", key_name(info.key));
  row.text = "the style with that number";
}

std::vector<Row> rows() {
  std::vector<Row> all;
  all.push_back({"Walk and look", {}, {}, {}, {}});
  for (const HelpLine& line : walking_help()) {
    all.push_back({{}, {std::string(line.input)}, {}, line.text, {"walking"}});
  }
  std::string_view group;
  for (const ActionInfo& info : actions()) {
    if (info.group != group) all.push_back({info.group, {}, {}, {}, {}});
    group = info.group;
    if (is_numbered_style(info.action) && info.action != Action::style_1) {
      add_style(info, all.back());
      continue;
    }
    Row row{{}, {}, {}, info.text, {info.name}};
    for (const SDL_Keycode key : {info.key, info.second_key}) {
      if (key != SDLK_UNKNOWN) row.keys.emplace_back(key_name(key));
    }
    if (info.button >= 0) row.button = button_label(static_cast<PadButton>(info.button));
    all.push_back(std::move(row));
  }
  return all;
}

float height_of(const Ui& ui, const Row& row) {
  return std::round(ui.px(row.heading.empty() ? kRowPixels : kHeadingPixels));
}

// As a key looks; the x behind it.
float draw_key(Ui& ui, const ImVec2& at, std::string_view text, float max_width) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float width = std::min(text_width(ui.fonts.small, text) + ui.px(14), max_width);
  const float height = std::round(ui.px(19));
  list.AddRectFilled(at, {at.x + width, at.y + height}, packed(ui.theme.frame), ui.px(4));
  list.AddRect(at, {at.x + width, at.y + height}, packed(ui.theme.border), ui.px(4));
  put_text(list, ui.fonts.small, ui.theme.text,
           {at.x + ui.px(7), at.y + (height - ui.fonts.small->FontSize) / 2.0f}, text,
           width - ui.px(10));
  return at.x + width + ui.px(5);
}

void draw_row(Ui& ui, const ImVec2& at, const Row& row, float width) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (!row.heading.empty()) {
    put_text(list, ui.fonts.heading, ui.theme.left, {at.x, at.y + ui.px(10)}, row.heading, width);
    return;
  }
  float x = at.x;
  const float keys = ui.px(kKeysPixels);
  for (const std::string& key : row.keys) {
    x = draw_key(ui, {x, at.y + ui.px(2)}, key, at.x + keys - x - ui.px(6));
  }
  float right = at.x + width;
  if (!row.button.empty()) {
    right -= ui.px(kButtonPixels);
    draw_key(ui, {right, at.y + ui.px(2)}, row.button, ui.px(kButtonPixels));
  }
  put_text(list, ui.fonts.body, ui.theme.text, {at.x + keys, at.y + ui.px(4)}, row.text,
           right - at.x - keys - ui.px(6));
  for (const std::string_view name : row.names) {
    keep_item(fmt::format("help {}", name), at, {at.x + width, at.y + height_of(ui, row)});
  }
}

// Where the columns end, so that none is higher than need be and none begins below its heading.
std::vector<std::size_t> column_ends(const Ui& ui, const std::vector<Row>& all, int columns) {
  float total = 0.0f;
  for (const Row& row : all) total += height_of(ui, row);
  const float wanted = total / static_cast<float>(columns);
  std::vector<std::size_t> ends;
  float height = 0.0f;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool is_full = height >= wanted - ui.px(kRowPixels);
    if (is_full && !all[i].heading.empty() && static_cast<int>(ends.size()) + 1 < columns) {
      ends.push_back(i);
      height = 0.0f;
    }
    height += height_of(ui, all[i]);
  }
  ends.push_back(all.size());
  return ends;
}

void draw_rows(Ui& ui, float width) {
  const std::vector<Row> all = rows();
  const float gap = ui.px(28);
  const int columns =
      std::clamp(static_cast<int>((width + gap) / (ui.px(kColumnPixels) + gap)), 1, 3);
  const float column = std::min(
      (width - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns), ui.px(520));
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  std::size_t i = 0;
  float lowest = begin.y, x = begin.x;
  for (const std::size_t end : column_ends(ui, all, columns)) {
    float y = begin.y;
    for (; i < end; ++i) {
      draw_row(ui, {x, y}, all[i], column);
      y += height_of(ui, all[i]);
    }
    lowest = std::max(lowest, y);
    x += column + gap;
  }
  ImGui::SetCursorScreenPos(begin);
  ImGui::Dummy({width, lowest - begin.y});
}

}  // namespace

void draw_help(Ui& ui, const UiRect& room) {
  if (room.width < ui.px(80) || room.height < ui.px(60)) return;
  ImGui::SetNextWindowPos(room.min());
  ImGui::SetNextWindowSize({room.width, room.height});
  if (!ui.in.is_modal) ImGui::SetNextWindowFocus();
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_colour(ui.theme.card));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{ui.px(24), ui.px(18)});
  ImGui::Begin("help page", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  keep_item("help page", room.min(), room.max());
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.title, ui.theme.text, at, "Keys and pad buttons",
           width - ui.px(90));
  ButtonLook look;
  look.width = std::round(ui.px(76));
  ImGui::SetCursorScreenPos({at.x + width - look.width, at.y - ui.px(4)});
  if (button(ui, "close help", "Close", look)) ui.out.actions.push_back(Action::help);
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(24))});
  draw_rows(ui, width);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
}

}  // namespace gaitpad
