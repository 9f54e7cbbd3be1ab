#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "view/ui_bars.h"

namespace gaitpad {
namespace {

constexpr std::size_t kBarButtons = 6;  // before those of the panels

// What a button of the bar does: an action, or a switch of the state that has none, or a menu.
struct Entry {
  std::string_view id, label;
  std::optional<Action> action;
  ButtonLook look;
};

ButtonLook look_of(Icon icon, bool is_on, bool is_enabled = true) {
  ButtonLook look;
  look.icon = icon;
  look.is_on = is_on;
  look.is_enabled = is_enabled;
  return look;
}

double pace_of(const Ui& ui) { return ui.in.timeline ? ui.in.timeline->pace : ui.in.pace; }

std::vector<Entry> entries(const Ui& ui) {
  const bool is_standing = pace_of(ui) <= 0.0;
  const bool is_recording = !ui.in.recording.empty();
  ButtonLook play = look_of(is_standing ? Icon::play : Icon::pause, false);
  play.is_primary = is_standing;
  std::vector<Entry> all = {
      {"play", is_standing ? "Play" : "Pause", Action::pause, play},
      {"record", is_recording ? "Stop" : "Record", Action::record,
       look_of(is_recording ? Icon::stop : Icon::record, is_recording, ui.is_live())},
      {"open", "Open", Action::open_file, {}},
      {"calibrate", "Calibrate", Action::calibrate, {}},
      {"help", "Help", Action::help, look_of(Icon::none, ui.state.is_help_open)},
      {"view", "View", std::nullopt, {}},
  };
  constexpr std::string_view kLabels[kPanels] = {"Pad",    "Control", "Style",
                                                 "Graphs", "Solver",  "Loop"};
  constexpr std::string_view kIds[kPanels] = {"panel pad",    "panel control", "panel style",
                                              "panel graphs", "panel solver",  "panel loop"};
  for (std::size_t i = 0; i < kPanels; ++i) {
    const auto action = static_cast<Action>(static_cast<std::size_t>(Action::panel_pad) + i);
    all.push_back({kIds[i], kLabels[i], action, look_of(Icon::none, ui.state.is_open[i])});
  }
  return all;
}

void press(Ui& ui, const Entry& entry) {
  if (entry.action) {
    ui.out.actions.push_back(*entry.action);
  } else {
    ImGui::OpenPopup("view menu");
  }
}

struct Switch {
  std::string_view id, label;
  bool UiState::*value;
  std::optional<Action> action;
};
constexpr Switch kSwitches[] = {
    {"trails", "Trails", &UiState::has_trails, Action::trails},
    {"source", "Source figure", &UiState::has_source, Action::source},
    {"grid", "Grid", &UiState::has_grid, std::nullopt},
    {"shadows", "Shadows", &UiState::has_shadows, std::nullopt},
    {"names", "Names", &UiState::has_names, std::nullopt},
};

void draw_view_menu(Ui& ui) {
  if (!ImGui::BeginPopup("view menu")) return;
  ButtonLook look;
  look.width = std::round(ui.px(150));
  for (const Switch& entry : kSwitches) {
    bool& value = ui.state.*entry.value;
    look.is_on = value;
    if (!button(ui, entry.id, fmt::format("{}: {}", entry.label, value ? "shown" : "hidden"),
                look)) {
      continue;
    }
    if (entry.action) {
      ui.out.actions.push_back(*entry.action);
    } else {
      value = !value;
    }
  }
  look.is_on = false;
  const bool is_dark = ui.state.theme == ThemeName::dark;
  if (button(ui, "theme", is_dark ? "Theme: dark" : "Theme: light", look)) {
    ui.out.actions.push_back(Action::theme);
  }
  look.is_enabled = ui.is_live();
  if (button(ui, "next terrain", "Ground: " + ui.in.cast.terrain->name, look)) {
    ui.out.actions.push_back(Action::next_terrain);
  }
  look.is_enabled = true;
  if (button(ui, "reset camera", "Reset camera", look)) {
    ui.out.actions.push_back(Action::reset_camera);
  }
  ImGui::EndPopup();
}

// What the bar is too narrow for.
void draw_menu(Ui& ui, const std::vector<Entry>& all, std::size_t first) {
  bool wants_view = false;
  if (ImGui::BeginPopup("menu")) {
    for (std::size_t i = first; i < all.size(); ++i) {
      ButtonLook look = all[i].look;
      look.width = std::round(ui.px(130));
      if (!button(ui, all[i].id, all[i].label, look)) continue;
      if (all[i].action) {
        press(ui, all[i]);
      } else {
        wants_view = true;
        ImGui::CloseCurrentPopup();
      }
    }
    ImGui::EndPopup();
  }
  if (wants_view) ImGui::OpenPopup("view menu");
}

struct Fact {
  std::string text;
  Colour colour;
  bool has_dot = false;
};

// At the right: what the loop and the window do. The dot repeats what the words say.
std::vector<Fact> facts(const Ui& ui) {
  std::vector<Fact> all;
  if (!ui.in.recording.empty()) all.push_back({"recording", ui.theme.bad, true});
  if (ui.is_live()) {
    const auto overruns = ui.in.status != nullptr ? ui.in.status->overruns : 0;
    all.push_back({fmt::format("{} Hz", ui.in.cast.rate_hz),
                   overruns == 0 ? ui.theme.good : ui.theme.warning, true});
    if (ui.in.status != nullptr) {
      all.push_back({fmt::format("{} overrun{}", overruns, overruns == 1 ? "" : "s"),
                     overruns == 0 ? ui.theme.secondary : ui.theme.warning});
    }
  } else {
    all.push_back({fmt::format("playback, {} Hz", ui.in.cast.rate_hz), ui.theme.left, true});
  }
  if (ui.in.frames_per_second > 0.0) {
    all.push_back({fmt::format("{:.0f} fps", ui.in.frames_per_second), ui.theme.secondary});
  }
  return all;
}

float fact_width(const Ui& ui, const Fact& fact) {
  return text_width(ui.fonts.small, fact.text) + ui.px(fact.has_dot ? 28 : 16);
}

// From the right edge on, as many as there is room for behind `left`; the x where they begin.
float draw_facts(Ui& ui, const UiRect& rect, float left) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::vector<Fact> all = facts(ui);
  float x = rect.width - ui.px(6);
  std::size_t first = all.size();
  while (first > 0 && x - fact_width(ui, all[first - 1]) > left) {
    x -= fact_width(ui, all[--first]);
  }
  float at = x;
  const float middle = rect.y + rect.height / 2.0f;
  for (std::size_t i = first; i < all.size(); ++i) {
    const float front = all[i].has_dot ? ui.px(12) : 0.0f;
    if (all[i].has_dot) {
      list.AddCircleFilled({at + ui.px(4), middle}, ui.px(4), packed(all[i].colour), 16);
    }
    put_text(list, ui.fonts.small, all[i].has_dot ? ui.theme.text : all[i].colour,
             {at + front, middle - ui.fonts.small->FontSize / 2.0f}, all[i].text,
             fact_width(ui, all[i]));
    at += fact_width(ui, all[i]);
  }
  return x;
}

}  // namespace

void draw_top_bar(Ui& ui, const UiRect& rect) {
  begin_area(ui, "top bar", rect, ui.theme.bar, {14.0f, 9.0f},
             ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const float gap = std::round(ui.px(6)), y = std::round(ui.px(9));
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.title, ui.theme.text,
           {rect.x + ui.px(14), rect.y + (rect.height - ui.fonts.title->FontSize) / 2.0f},
           "gaitpad", rect.width);
  float x = std::round(ui.px(14) + text_width(ui.fonts.title, "gaitpad") + ui.px(18));
  const std::vector<Entry> all = entries(ui);
  float wanted = x + ui.px(10);
  for (const Entry& entry : all) wanted += button_width(ui, entry.label, entry.look) + gap;
  const bool fits = wanted <= rect.width;
  const float menu = fits ? 0.0f : button_width(ui, "Panels", {}) + gap;
  const float end = rect.width - ui.px(8) - menu;
  const std::size_t most = fits ? all.size() : kBarButtons;  // panels: all in the bar or none
  std::size_t i = 0;
  for (; i < most; ++i) {
    if (i == kBarButtons) x += ui.px(10);
    const float width = button_width(ui, all[i].label, all[i].look);
    if (x + width > end) break;
    ImGui::SetCursorPos({x, y});
    if (button(ui, all[i].id, all[i].label, all[i].look)) press(ui, all[i]);
    x += width + gap;
  }
  if (i < all.size() && x + menu <= rect.width) {
    ImGui::SetCursorPos({x, y});
    if (button(ui, "menu", i == kBarButtons ? "Panels" : "Menu")) ImGui::OpenPopup("menu");
    x += menu;
  }
  draw_facts(ui, rect, rect.x + x + ui.px(10));
  draw_menu(ui, all, i);
  draw_view_menu(ui);
  end_area();
}

}  // namespace gaitpad
