#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/panels.h"
#include "view/tooltips.h"

namespace gaitpad {
namespace {

// A row: one parameter, or the same parameter of both feet.
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

// A walker, and the parameters that its stick and style alone would give.
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
  forget_wish(ui, "gait " + name);
}

std::string stick_text(const ControlRow& row, const Controlled& c) {
  std::string text = fmt::format("stick {}", tick_text(value_of(row.left, c.from_stick), 0.01));
  if (row.right) text += fmt::format(" | {}", tick_text(value_of(*row.right, c.from_stick), 0.01));
  return text;
}

// The name, and at the right the stick's value, or a button that gives an overridden value back.
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
  double value = wished_value(ui, "gait " + name, now);
  if (slider(ui, "slider " + name, value, look)) {
    send(ui, "gait", name, value);
    remember_wish(ui, "gait " + name, value);
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

constexpr std::string_view kLeftOf = "left_", kRightOf = "right_";
constexpr std::string_view kOfBoth[] = {"legs.", "arms.", "hands."};
// Keys behind the button below: the upper body, and those that are rarely changed.
constexpr std::string_view kRare[] = {"arm.",  "hand.",   "spine.",
                                      "head.", "blend_s", "fatigue_model."};

// A row: one key, or the same key of both sides.
struct StyleRow {
  std::string label;
  const StyleKey* left = nullptr;   // or the key without a side
  const StyleKey* right = nullptr;  // null: a key without a side
};

template <std::size_t n>
bool begins_with_one(const std::string_view (&parts)[n], std::string_view name) {
  return std::any_of(parts, parts + n, [name](std::string_view p) { return name.starts_with(p); });
}

bool is_axis_weight(std::string_view key) {
  return key.find("weight.") != std::string_view::npos &&
         (key.ends_with("_x") || key.ends_with("_y") || key.ends_with("_z"));
}

// Rows of legs and arms need no prefix; others name their table.
std::string row_label(std::string_view name) {
  for (const std::string_view plain : {"leg.", "arm."}) {
    if (name.starts_with(plain)) return words_of_key(name.substr(plain.size()));
  }
  return words_of_key(name);
}

std::vector<StyleRow> rows_of(const UiMemory& memory) {
  std::vector<StyleRow> rows;
  const std::vector<StyleKey>& keys = style_keys();
  for (const StyleKey& key : keys) {
    const std::string_view name = key.name;
    if (begins_with_one(kOfBoth, name) || name.starts_with(kRightOf)) continue;
    if (!memory.has_axis_weights && is_axis_weight(name)) continue;
    const bool is_paired = name.starts_with(kLeftOf);
    const std::string_view part = is_paired ? name.substr(kLeftOf.size()) : name;
    if (!memory.has_body_keys && begins_with_one(kRare, part)) continue;
    const auto right = std::find_if(keys.begin(), keys.end(), [part](const StyleKey& k) {
      const std::string_view other = k.name;
      return other.starts_with(kRightOf) && other.substr(kRightOf.size()) == part;
    });
    const bool has_right = is_paired && right != keys.end();
    rows.push_back({row_label(part), &key, has_right ? &*right : nullptr});
  }
  return rows;
}

// The value of the style as loaded; none if it is not known.
std::optional<double> own_value(const Ui& ui, const WalkerFrame& walker, const StyleKey& key) {
  const auto& all = ui.in.cast.style_values;
  const auto index = static_cast<std::size_t>(walker.style_index);
  if (walker.style_index < 0 || index >= all.size()) return std::nullopt;
  return value_of(all[index], key.name);
}

void draw_value(Ui& ui, const WalkerFrame& walker, const StyleKey& key, float width,
                std::string_view letter) {
  const double now = value_of(walker.style, key.name).value_or(key.min);
  const std::optional<double> own = own_value(ui, walker, key);
  SliderLook look;
  look.min = key.min;
  look.max = key.max;
  look.mark = own;
  look.is_changed = own && *own != now;
  look.is_enabled = ui.is_live();
  look.width = width;
  look.letter = letter;
  double value = wished_value(ui, "set " + key.name, now);
  if (slider(ui, "style slider " + key.name, value, look)) {
    send(ui, "set", key.name, value);
    remember_wish(ui, "set " + key.name, value);
  }
}

bool is_changed(const Ui& ui, const WalkerFrame& walker, const StyleKey* key) {
  if (key == nullptr) return false;
  const auto own = own_value(ui, walker, *key);
  const auto now = value_of(walker.style, key->name);
  return own && now && *own != *now;
}

void give_own_back(Ui& ui, const WalkerFrame& walker, const StyleKey* key) {
  if (!is_changed(ui, walker, key)) return;
  send(ui, "set", key->name, *own_value(ui, walker, *key));
  forget_wish(ui, "set " + key->name);
}

void draw_row(Ui& ui, const WalkerFrame& walker, const StyleRow& row) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, gap = std::round(ui.px(6));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = at.y + ui.px(2);
  put_text(list, ui.fonts.small, ui.theme.text, {at.x, y}, row.label, width * 0.6f);
  if (is_changed(ui, walker, row.left) || is_changed(ui, walker, row.right)) {
    const float x = at.x + text_width(ui.fonts.small, row.label) + ui.px(8);
    put_text(list, ui.fonts.small, ui.theme.warning, {x, y}, "changed",
             at.x + width - x - ui.px(48));
    ButtonLook back;
    back.width = std::round(ui.px(44));
    back.height = std::round(ui.px(18));
    back.is_enabled = ui.is_live();
    ImGui::SetCursorScreenPos({at.x + width - back.width, at.y - ui.px(1)});
    if (button(ui, "own " + row.left->name, "back", back)) {
      give_own_back(ui, walker, row.left);
      give_own_back(ui, walker, row.right);
    }
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(18))});
  const float cell = row.right != nullptr ? std::floor((width - gap) / 2.0f) : width;
  draw_value(ui, walker, *row.left, cell, row.right != nullptr ? "L" : "");
  if (row.right != nullptr) {
    ImGui::SameLine(0.0f, gap);
    draw_value(ui, walker, *row.right, cell, "R");
  }
}

constexpr double kStyleListPixels = 236.0;
constexpr int kSummaryLines = 4;

// The list of styles: number, name and what each does. A click lets the selected characters walk
// so.
void draw_choice(Ui& ui, const WalkerFrame& walker) {
  const std::vector<int> choices = style_choices(ui.in.cast);
  const std::string now = style_name(ui, walker.style_index);
  const float number = ui.px(18), line = ui.fonts.tick->FontSize + ui.px(1);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, imgui_colour(ui.theme.plot));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{0.0f, 0.0f});
  ImGui::BeginChild("styles", {0.0f, std::round(ui.px(kStyleListPixels))});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const std::string name = style_name(ui, choices[i]), id = fmt::format("style {}", i + 1);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float x = at.x + ui.px(4) + number, room = width - number - ui.px(10);
    std::vector<std::string> lines;
    if (const auto s = static_cast<std::size_t>(choices[i]); s < ui.in.style_summaries.size())
      lines = text_lines(ui.fonts.tick, ui.in.style_summaries[s], room, kSummaryLines);
    const float row = std::round(ui.px(19) + line * static_cast<float>(lines.size()) + ui.px(4));
    ImGui::PushID(static_cast<int>(i));
    ImGui::BeginDisabled(!ui.is_live());
    const bool is_pressed = ImGui::InvisibleButton("style", {width, row});
    ImGui::EndDisabled();
    ImGui::PopID();
    if (ui.is_live()) keep_item(id);
    explain(ui, id);
    const bool is_on = name == now;
    if (is_on || (ImGui::IsItemHovered() && ui.is_live())) {
      list.AddRectFilled(at, {at.x + width, at.y + row - 1.0f},
                         packed(with_alpha(ui.theme.accent, is_on ? 0.45 : 0.2)), ui.px(4));
    }
    if (i < 9)
      put_text(list, ui.fonts.tick, ui.theme.tick, {at.x + ui.px(6), at.y + ui.px(4)},
               fmt::format("{}", i + 1), number);
    put_text(list, ui.fonts.small, ui.theme.text, {x, at.y + ui.px(2)}, name, room);
    for (std::size_t l = 0; l < lines.size(); ++l)
      put_text(list, ui.fonts.tick, ui.theme.secondary,
               {x, at.y + ui.px(18) + line * static_cast<float>(l)}, lines[l], room);
    if (is_pressed) {
      send(ui, "style", name);
      forget_wish(ui, "");
    }
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  ImGui::Dummy({1.0f, ui.px(2)});
}

// Accepts only characters that a style's name may hold.
int accept(ImGuiInputTextCallbackData* data) {
  const ImWchar c = data->EventChar;
  const bool is_fit = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '_' || c == '-' || c == ' ';
  return is_fit ? 0 : 1;
}

// A field for the file's name, and the button that saves.
void draw_save(Ui& ui) {
  auto& name = ui.state.memory.style_name;
  const float save = std::round(ui.px(60)), gap = std::round(ui.px(6));
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::PushFont(ui.fonts.small);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2{ui.px(8), ui.px(5)});
  ImGui::SetNextItemWidth(width - save - gap);
  const bool is_entered = ImGui::InputTextWithHint(
      "##style name", "name of a new style", name.data(), name.size(),
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCharFilter, &accept);
  keep_item("style name");
  ImGui::PopStyleVar();
  ImGui::PopFont();
  ImGui::SameLine(0.0f, gap);
  ButtonLook look;
  look.width = save;
  look.height = std::round(ui.px(24));
  look.is_enabled = name[0] != '\0';
  const bool is_pressed = button(ui, "save style", "Save", look);
  if ((is_pressed || is_entered) && name[0] != '\0') ui.out.save_style = std::string(name.data());
}

void draw_buttons(Ui& ui, const WalkerFrame& walker) {
  const float width = ImGui::GetContentRegionAvail().x, gap = std::round(ui.px(6));
  const float cell = std::floor((width - gap) / 2.0f);
  const std::vector<StyleKey>& keys = style_keys();
  ButtonLook look;
  look.width = cell;
  look.height = std::round(ui.px(22));
  look.is_enabled = ui.is_live() && std::any_of(keys.begin(), keys.end(), [&](const StyleKey& k) {
                      return is_changed(ui, walker, &k);
                    });
  if (button(ui, "own all", "all back", look)) {
    send(ui, "style", style_name(ui, walker.style_index));
    forget_wish(ui, "");
  }
  ImGui::SameLine(0.0f, gap);
  look.is_enabled = true;
  look.is_on = ui.state.memory.has_axis_weights;
  if (button(ui, "axis weights", "each axis", look)) {
    ui.state.memory.has_axis_weights = !ui.state.memory.has_axis_weights;
  }
  look.width = width;
  look.is_on = ui.state.memory.has_body_keys;
  if (button(ui, "upper body", "upper body, tiring, blending", look)) {
    ui.state.memory.has_body_keys = !ui.state.memory.has_body_keys;
  }
}

}  // namespace

void draw_control_panel(Ui& ui) {
  const int index = ui.walker();
  if (index < 0 || index >= static_cast<int>(ui.in.cast.members.size())) {
    return note(ui, "no character yet");
  }
  const WalkerFrame& walker = ui.in.frame.walkers[static_cast<std::size_t>(index)];
  const GaitLimits& limits = ui.in.cast.members[static_cast<std::size_t>(index)].limits;
  const Controlled controlled{walker, gait_params(ui.in.frame.stick, walker.style, limits), limits};
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  for (const ControlRow& row : kRows) draw_row(ui, row, controlled);
  if (!ui.is_live()) {
    note(ui, "Playback is read-only; Esc returns to live.", 2);
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

void draw_style_panel(Ui& ui) {
  const int index = ui.walker();
  if (index < 0) return note(ui, "no character yet");
  const WalkerFrame& walker = ui.in.frame.walkers[static_cast<std::size_t>(index)];
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  draw_choice(ui, walker);
  draw_save(ui);
  for (const StyleRow& row : rows_of(ui.state.memory)) draw_row(ui, walker, row);
  draw_buttons(ui, walker);
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
