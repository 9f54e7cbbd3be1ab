#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/panels.h"

namespace gaitpad {
namespace {

// A parameter, or the same one of both feet in one row.
struct ControlRow {
  std::string_view label, unit;
  GaitKey left;
  std::optional<GaitKey> right;
};
constexpr ControlRow kRows[] = {
    {"speed", "m/s", GaitKey::speed_m_s, std::nullopt},
    {"stride", "m", GaitKey::stride_left_m, GaitKey::stride_right_m},
    {"flight height", "x", GaitKey::flight_left, GaitKey::flight_right},
    {"turn rate", "rad/s", GaitKey::turn_rate_rad_s, std::nullopt},
    {"hip sway", "x", GaitKey::hip_sway, std::nullopt},
    {"hip bounce", "x", GaitKey::hip_bounce, std::nullopt},
};

// One walker, and what its stick and style alone would make of it.
struct Controlled {
  const WalkerFrame& walker;
  const GaitParams from_stick;
  const GaitLimits& limits;
  bool is_set(std::optional<GaitKey> key) const noexcept {
    return key && walker.overrides.is_set[static_cast<std::size_t>(*key)];
  }
};

void give_back(Ui& ui, const Controlled& c, std::optional<GaitKey> key) {
  if (!c.is_set(key)) return;
  const std::string name(info_of(*key).name);
  send(ui, "gait", name + " stick");
  forget_wish(ui, name);
}

std::string stick_text(const ControlRow& row, const Controlled& c) {
  std::string text = fmt::format("stick {}", tick_text(value_of(row.left, c.from_stick), 0.01));
  if (row.right) text += fmt::format(" | {}", tick_text(value_of(*row.right, c.from_stick), 0.01));
  return text;
}

// The name, and at the right what the stick says; where that is overridden a word and a way back.
void draw_row_head(Ui& ui, const ControlRow& row, const Controlled& c) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, y = at.y + ui.px(1);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImFont* font = ui.fonts.small;
  const std::string label = fmt::format("{} ({})", row.label, row.unit);
  put_text(list, font, ui.theme.text, {at.x, y}, label, width * 0.62f);
  if (!c.is_set(row.left) && !c.is_set(row.right)) {
    const std::string stick = stick_text(row, c);
    const float stick_width = text_width(font, stick);
    put_text(list, font, ui.theme.tick, {at.x + width - stick_width, y}, stick, stick_width + 1.0f);
  } else {
    const float x = at.x + text_width(font, label) + ui.px(8);
    ButtonLook back;
    back.width = std::round(ui.px(64));
    back.height = std::round(ui.px(17));
    back.is_enabled = ui.is_live();
    put_text(list, font, ui.theme.warning, {x, y}, "overridden",
             at.x + width - x - back.width - ui.px(4));
    ImGui::SetCursorScreenPos({at.x + width - back.width, at.y - ui.px(1)});
    if (button(ui, fmt::format("give back {}", info_of(row.left).name), "give back", back)) {
      give_back(ui, c, row.left);
      give_back(ui, c, row.right);
    }
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(17))});
}

void draw_slider(Ui& ui, GaitKey key, const Controlled& c, float width, std::string_view letter) {
  const std::string name(info_of(key).name);
  const GaitRange range = range_of(key, c.limits);
  SliderLook look;
  look.min = range.min;
  look.max = range.max;
  look.mark = value_of(key, c.from_stick);
  look.is_changed = c.is_set(key);
  look.is_enabled = ui.is_live();
  look.width = width;
  look.letter = letter;
  const double now = c.is_set(key) ? c.walker.overrides.value[static_cast<std::size_t>(key)]
                                   : value_of(key, c.walker.params);
  double value = wished(ui, name, now);
  if (slider(ui, "slider " + name, value, look)) {
    send(ui, "gait", name, value);
    wish(ui, name, value);
  }
}

void draw_row(Ui& ui, const ControlRow& row, const Controlled& c) {
  draw_row_head(ui, row, c);
  const float width = ImGui::GetContentRegionAvail().x, gap = std::round(ui.px(6));
  const float cell = row.right ? std::floor((width - gap) / 2.0f) : width;
  draw_slider(ui, row.left, c, cell, row.right ? "L" : "");
  if (row.right) {
    ImGui::SameLine(0.0f, gap);
    draw_slider(ui, *row.right, c, cell, "R");
  }
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
  const Controlled controlled{walker, gait_params(ui.in.frame.stick, walker.style, limits), limits};
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  for (const ControlRow& row : kRows) draw_row(ui, row, controlled);
  if (!ui.is_live()) {
    note(ui, "a playback is only looked at", 1);
  } else if (is_any_set(ui)) {
    ButtonLook look;
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
