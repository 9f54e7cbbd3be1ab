#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/panels.h"

namespace gaitpad {
namespace {

struct KeyLook {
  std::string_view label, unit;
};
constexpr std::array<KeyLook, kGaitKeys> kLooks = {{
    {"speed", "m/s"},
    {"left stride", "m"},
    {"right stride", "m"},
    {"left flight height", "x"},
    {"right flight height", "x"},
    {"turn rate", "rad/s"},
    {"hip sway", "x"},
    {"hip bounce", "x"},
}};

void draw_row_head(Ui& ui, GaitKey key, bool is_set, double from_stick) {
  const auto index = static_cast<std::size_t>(key);
  const KeyLook& look = kLooks[index];
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::string label = fmt::format("{} ({})", look.label, look.unit);
  const std::string stick = fmt::format("stick {}", tick_text(from_stick, 0.01));
  const ImFont* font = ui.fonts.small;
  const float y = at.y + ui.px(2);
  put_text(list, font, ui.theme.text, {at.x, y}, label, width * 0.62f);
  const float x = at.x + text_width(font, label) + ui.px(8);
  if (!is_set) {
    const float stick_width = text_width(font, stick);
    put_text(list, font, ui.theme.tick, {at.x + width - stick_width, y}, stick, stick_width + 1.0f);
  } else {
    put_text(list, font, ui.theme.warning, {x, y}, "overridden", at.x + width - x - ui.px(72));
    ButtonLook back;
    back.width = std::round(ui.px(68));
    back.height = std::round(ui.px(18));
    back.is_enabled = ui.is_live();
    ImGui::SetCursorScreenPos({at.x + width - back.width, at.y - ui.px(1)});
    const std::string name(info_of(key).name);
    if (button(ui, "give back " + name, "give back", back)) {
      send(ui, "gait", name + " stick");
      forget_wish(ui, name);
    }
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(18))});
}

void draw_row(Ui& ui, GaitKey key, const WalkerFrame& walker, const GaitParams& from_stick,
              const GaitLimits& limits) {
  const auto index = static_cast<std::size_t>(key);
  const std::string name(info_of(key).name);
  const bool is_set = walker.overrides.is_set[index];
  const double stick = value_of(key, from_stick);
  draw_row_head(ui, key, is_set, stick);
  const GaitRange range = range_of(key, limits);
  SliderLook look;
  look.min = range.min;
  look.max = range.max;
  look.mark = stick;
  look.is_changed = is_set;
  look.is_enabled = ui.is_live();
  double value =
      wished(ui, name, is_set ? walker.overrides.value[index] : value_of(key, walker.params));
  if (slider(ui, "slider " + name, value, look)) {
    send(ui, "gait", name, value);
    wish(ui, name, value);
  }
  ImGui::Dummy({1.0f, 1.0f});
}

bool is_any_set(const Ui& ui) {
  for (int w = 0; w < ui.in.frame.walker_count; ++w) {
    if (ui.state.walker >= 0 && w != ui.state.walker) continue;
    const auto& set = ui.in.frame.walkers[static_cast<std::size_t>(w)].overrides.is_set;
    if (std::any_of(set.begin(), set.end(), [](bool s) { return s; })) return true;
  }
  return false;
}

}  // namespace

void draw_control_panel(Ui& ui) {
  const int index = ui.walker();
  if (index < 0 || index >= static_cast<int>(ui.in.cast.members.size())) {
    return note(ui, "nobody walks yet");
  }
  const WalkerFrame& walker = ui.in.frame.walkers[static_cast<std::size_t>(index)];
  const GaitLimits& limits = ui.in.cast.members[static_cast<std::size_t>(index)].limits;
  const GaitParams from_stick = gait_params(ui.in.frame.stick, walker.style, limits);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(2)});
  for (int k = 0; k < kGaitKeys; ++k) {
    draw_row(ui, static_cast<GaitKey>(k), walker, from_stick, limits);
  }
  if (!ui.is_live()) {
    note(ui, "a playback is only looked at");
  } else {
    ButtonLook look;
    look.is_enabled = is_any_set(ui);
    look.width = ImGui::GetContentRegionAvail().x;
    look.height = std::round(ui.px(22));
    if (button(ui, "give back all", "give all back to the stick", look)) {
      send(ui, "gait", "stick");
      forget_wish(ui, "");
    }
  }
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
