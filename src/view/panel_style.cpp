#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "view/panels.h"
#include "view/tooltips.h"
#include "view/widgets.h"

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
    {"turn", "rad/s", GaitKey::turn_rate_rad_s, std::nullopt},
    {"hip sway", "x", GaitKey::hip_sway, std::nullopt},
    {"hip bounce", "x", GaitKey::hip_bounce, std::nullopt},
};

// The value if all walkers have the same one; else none.
template <class Value>
std::optional<double> shared_value(std::span<const WalkerFrame> walkers, const Value& value) {
  const double first = value(walkers.front());
  const bool is_shared = std::ranges::all_of(walkers, [&](const WalkerFrame& walker) {
    const double other = value(walker);
    return std::abs(other - first) < 1e-9 || (std::isnan(other) && std::isnan(first));
  });
  return is_shared ? std::optional(first) : std::nullopt;
}

// The selected walkers, and the parameters that the stick and the first walker's style give without
// overrides.
struct Controlled {
  std::span<const WalkerFrame> walkers;
  const GaitParams from_stick;
  const GaitLimits& limits;
  bool is_set(std::optional<GaitKey> key) const noexcept {
    return key && std::ranges::any_of(walkers, [key](const WalkerFrame& walker) {
             return walker.overrides.is_set[static_cast<std::size_t>(*key)];
           });
  }
};

double asked_value(const WalkerFrame& walker, GaitKey key) {
  const auto k = static_cast<std::size_t>(key);
  return walker.overrides.is_set[k] ? walker.overrides.value[k] : value_of(key, walker.params);
}

// The walk's present value, as in `frames.csv`; none if it has none.
std::optional<double> done_value(const WalkerFrame& walker, GaitKey key) {
  switch (key) {
    case GaitKey::speed_m_s:
      return walker.walk.speed_m_s;
    case GaitKey::stride_left_m:
      return walker.walk.stride_m[kLeftSide];
    case GaitKey::stride_right_m:
      return walker.walk.stride_m[kRightSide];
    case GaitKey::turn_rate_rad_s:
      return walker.walk.turn_rate_rad_s;
    default:
      return std::nullopt;
  }
}

void give_back(Ui& ui, const Controlled& c, std::optional<GaitKey> key) {
  if (!c.is_set(key)) return;
  const std::string name(info_of(*key).name);
  send(ui, "gait", name + " stick");
  forget_pending(ui, "gait " + name);
}

// "now 0.37", for both feet "now 0.64 | 0.31", for walkers that differ "now 0.31 to 0.64". Empty
// if the walk has no value of the parameter.
std::string done_text(const ControlRow& row, const Controlled& c) {
  if (!done_value(c.walkers.front(), row.left)) return {};
  std::vector<std::string> texts;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool is_shared = true;
  for (const std::optional<GaitKey> key : {std::optional(row.left), row.right}) {
    if (!key) continue;
    const auto done = [key](const WalkerFrame& walker) { return *done_value(walker, *key); };
    is_shared = is_shared && shared_value(c.walkers, done);
    texts.push_back(tick_text(done(c.walkers.front()), 0.01));
    for (const WalkerFrame& walker : c.walkers) {
      low = std::min(low, done(walker));
      high = std::max(high, done(walker));
    }
  }
  if (is_shared) return fmt::format("now {}", fmt::join(texts, " | "));
  const std::string from = tick_text(low, 0.01), to = tick_text(high, 0.01);
  return from == to ? "now " + from : fmt::format("now {} to {}", from, to);
}

std::string stick_text(const ControlRow& row, const Controlled& c) {
  std::string text = fmt::format("stick {}", tick_text(value_of(row.left, c.from_stick), 0.01));
  if (row.right) text += fmt::format(" | {}", tick_text(value_of(*row.right, c.from_stick), 0.01));
  return text;
}

// Draws the name, at the right the walk's value or else the stick's, and a button that releases an
// overridden value.
void draw_row_head(Ui& ui, const ControlRow& row, const Controlled& c) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, y = at.y + ui.px(1);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImFont* font = ui.fonts.small;
  const std::string label = fmt::format("{} ({})", row.label, row.unit);
  put_text(list, font, ui.theme.text, {at.x, y}, label, width * 0.62f);
  float end = at.x + width;
  const bool is_set = c.is_set(row.left) || c.is_set(row.right);
  if (is_set) {
    ButtonLook back;
    back.width = std::round(ui.px(44));
    back.height = std::round(ui.px(17));
    back.is_enabled = ui.is_live();
    ImGui::SetCursorScreenPos({end - back.width, at.y - ui.px(1)});
    if (button(ui, fmt::format("give back {}", info_of(row.left).name), "back", back)) {
      give_back(ui, c, row.left);
      give_back(ui, c, row.right);
    }
    end -= back.width + ui.px(6);
  }
  const std::string done = done_text(row, c);
  const std::string text = !done.empty() ? done : is_set ? "overridden" : stick_text(row, c);
  const Colour& colour = !done.empty() ? ui.theme.text : is_set ? ui.theme.warning : ui.theme.tick;
  const float x = std::max(end - text_width(font, text), at.x + text_width(font, label) + ui.px(6));
  put_text(list, font, colour, {x, y}, text, end - x + 1.0f);
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
  const auto now = pending_value(
      ui, "gait " + name,
      shared_value(c.walkers, [key](const WalkerFrame& w) { return asked_value(w, key); }));
  look.is_mixed = !now;
  double value = now.value_or(look.min);
  if (slider(ui, "slider " + name, value, look)) {
    send(ui, "gait", name, value);
    remember_pending(ui, "gait " + name, value);
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
  return std::ranges::any_of(ui.selected(), [](const WalkerFrame& walker) {
    return std::ranges::any_of(walker.overrides.is_set, std::identity());
  });
}

constexpr std::string_view kLeftOf = "left_", kRightOf = "right_";
constexpr std::string_view kOfBoth[] = {"legs.", "arms.", "hands."};

// A row: one key, or the same key of both sides.
struct StyleRow {
  std::string label;
  const StyleKey* left = nullptr;   // the left side's key, or a key without sides
  const StyleKey* right = nullptr;  // the right side's key; null: a key without sides
};

template <std::size_t n>
bool begins_with_one(const std::string_view (&parts)[n], std::string_view name) {
  return std::any_of(parts, parts + n, [name](std::string_view p) { return name.starts_with(p); });
}

bool is_axis_weight(std::string_view key) {
  return key.find("weight.") != std::string_view::npos &&
         (key.ends_with("_x") || key.ends_with("_y") || key.ends_with("_z"));
}

// Rows of legs and arms need no prefix; others begin with their limb, without its side.
std::string row_label(const StyleKey& key) {
  std::string_view limb = key.limb;
  if (limb.starts_with(kLeftOf)) limb.remove_prefix(kLeftOf.size());
  if (limb.empty() || limb == "leg" || limb == "arm") return key.words;
  return fmt::format("{} {}", limb, key.words);
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
    if (!memory.has_body_keys && key.is_rare) continue;
    const auto right = std::find_if(keys.begin(), keys.end(), [part](const StyleKey& k) {
      const std::string_view other = k.name;
      return other.starts_with(kRightOf) && other.substr(kRightOf.size()) == part;
    });
    const bool has_right = is_paired && right != keys.end();
    rows.push_back({row_label(key), &key, has_right ? &*right : nullptr});
  }
  return rows;
}

// The value of the key in the style as loaded; none if it is unknown.
std::optional<double> own_value(const Ui& ui, const WalkerFrame& walker, const StyleKey& key) {
  const auto& all = ui.in.cast.style_values;
  const auto index = static_cast<std::size_t>(walker.style_index);
  if (walker.style_index < 0 || index >= all.size()) return std::nullopt;
  return value_of(all[index], key.name);
}

bool is_changed(const Ui& ui, const WalkerFrame& walker, const StyleKey& key) {
  const auto own = own_value(ui, walker, key);
  const auto now = value_of(walker.style, key.name);
  return own && now && *own != *now;
}

bool is_changed(const Ui& ui, const StyleKey* key) {
  return key != nullptr && std::ranges::any_of(ui.selected(), [&](const WalkerFrame& walker) {
           return is_changed(ui, walker, *key);
         });
}

void draw_value(Ui& ui, const StyleKey& key, float width, std::string_view letter) {
  const auto walkers = ui.selected();
  SliderLook look;
  look.min = key.min;
  look.max = key.max;
  look.mark = own_value(ui, walkers.front(), key);
  look.is_changed = is_changed(ui, &key);
  look.is_enabled = ui.is_live();
  look.width = width;
  look.letter = letter;
  const auto now =
      pending_value(ui, "set " + key.name, shared_value(walkers, [&key](const WalkerFrame& walker) {
                      return value_of(walker.style, key.name).value_or(key.min);
                    }));
  look.is_mixed = !now;
  double value = now.value_or(look.min);
  if (slider(ui, "style slider " + key.name, value, look)) {
    send(ui, "set", key.name, value);
    remember_pending(ui, "set " + key.name, value);
  }
}

// The number that names a selected walker in commands.
int number_of(const Ui& ui, const WalkerFrame& walker) {
  return static_cast<int>(&walker - ui.in.frame.walkers.data()) + 1;
}

// Sets the key of each selected walker to the value of its own style.
void give_own_back(Ui& ui, const StyleKey* key) {
  if (key == nullptr) return;
  for (const WalkerFrame& walker : ui.selected()) {
    if (!is_changed(ui, walker, *key)) continue;
    ui.out.commands.push_back(fmt::format("set {} {} {}", number_of(ui, walker), key->name,
                                          *own_value(ui, walker, *key)));
  }
  forget_pending(ui, "set " + key->name);
}

void draw_row(Ui& ui, const StyleRow& row) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, gap = std::round(ui.px(6));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = at.y + ui.px(2);
  put_text(list, ui.fonts.small, ui.theme.text, {at.x, y}, row.label, width * 0.6f);
  if (is_changed(ui, row.left) || is_changed(ui, row.right)) {
    const float x = at.x + text_width(ui.fonts.small, row.label) + ui.px(8);
    put_text(list, ui.fonts.small, ui.theme.warning, {x, y}, "changed",
             at.x + width - x - ui.px(48));
    ButtonLook back;
    back.width = std::round(ui.px(44));
    back.height = std::round(ui.px(18));
    back.is_enabled = ui.is_live();
    ImGui::SetCursorScreenPos({at.x + width - back.width, at.y - ui.px(1)});
    if (button(ui, "own " + row.left->name, "back", back)) {
      give_own_back(ui, row.left);
      give_own_back(ui, row.right);
    }
  }
  ImGui::SetCursorScreenPos({at.x, at.y + std::round(ui.px(18))});
  const float cell = row.right != nullptr ? std::floor((width - gap) / 2.0f) : width;
  draw_value(ui, *row.left, cell, row.right != nullptr ? "L" : "");
  if (row.right != nullptr) {
    ImGui::SameLine(0.0f, gap);
    draw_value(ui, *row.right, cell, "R");
  }
}

constexpr double kStyleListPixels = 236.0;
constexpr int kSummaryLines = 4;

// The numbers of the selected walkers with this style: "1 3".
std::string who_walks_so(const Ui& ui, const std::string& style) {
  std::string numbers;
  for (const WalkerFrame& walker : ui.selected()) {
    if (style_name(ui, walker.style_index) != style) continue;
    numbers += fmt::format("{}{}", numbers.empty() ? "" : " ", number_of(ui, walker));
  }
  return numbers;
}

// Draws the list of styles: number, name, effect and, if several characters are selected, the
// numbers of those with the style. A click gives the style to all of them.
void draw_choice(Ui& ui) {
  const std::vector<int> choices = style_choices(ui.in.cast);
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
    bool is_pressed = ImGui::InvisibleButton("style", {width, row});
    ImGui::EndDisabled();
    ImGui::PopID();
    if (ui.is_live()) keep_item(id);
    if (ui.is_live() && is_focused(ui, id)) is_pressed |= ui.in.navigation.press;
    explain(ui, id);
    const std::string who = who_walks_so(ui, name);
    const bool is_on = !who.empty();
    if (is_on || (ImGui::IsItemHovered() && ui.is_live())) {
      list.AddRectFilled(at, {at.x + width, at.y + row - 1.0f},
                         packed(with_alpha(ui.theme.accent, is_on ? kChosenShare : 0.2)), ui.px(4));
    }
    if (i < 9)
      put_text(list, ui.fonts.tick, ui.theme.secondary, {at.x + ui.px(6), at.y + ui.px(4)},
               fmt::format("{}", i + 1), number);
    const float who_width =
        ui.selected().size() > 1 && is_on ? text_width(ui.fonts.small, who) + ui.px(6) : 0.0f;
    put_text(list, ui.fonts.small, ui.theme.text, {x, at.y + ui.px(2)}, name, room - who_width);
    if (who_width > 0.0f)
      put_text(list, ui.fonts.small, ui.theme.text,
               {x + room - who_width + ui.px(6), at.y + ui.px(2)}, who, who_width);
    for (std::size_t l = 0; l < lines.size(); ++l)
      put_text(list, ui.fonts.tick, ui.theme.secondary,
               {x, at.y + ui.px(18) + line * static_cast<float>(l)}, lines[l], room);
    if (is_pressed) {
      send(ui, "style", name);
      forget_pending(ui, "");
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

// Draws a field for the file's name, and the button that saves.
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
  if (is_focused(ui, "style name") && ui.in.navigation.press) ImGui::SetKeyboardFocusHere(-1);
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

constexpr double kMostExaggerated = 3.0;

// Visits each key in which a style differs from an even walk once.
template <class Visit>
void each_deviation(const Ui& ui, const WalkerFrame& walker, Visit visit) {
  static const StyleValues kEven;
  for (const StyleKey& key : style_keys()) {
    if (begins_with_one(kOfBoth, key.name)) continue;
    const auto own = own_value(ui, walker, key), even = value_of(kEven, key.name);
    if (own && even && *own != *even) visit(key, *own, *even);
  }
}

// Exaggeration of the key that deviates most: (present - even) / (style - even). None if the style
// is even.
std::optional<double> exaggeration(const Ui& ui, const WalkerFrame& walker) {
  std::optional<double> times;
  double most = 0.0;
  each_deviation(ui, walker, [&](const StyleKey& key, double own, double even) {
    const double share = std::fabs(own - even) / (key.max - key.min);
    if (share <= most) return;
    most = share;
    times = (value_of(walker.style, key.name).value_or(own) - even) / (own - even);
  });
  return times;
}

void draw_exaggerate(Ui& ui) {
  const auto walkers = ui.selected();
  const auto deviates = [&](const WalkerFrame& w) { return exaggeration(ui, w).has_value(); };
  const auto one = std::ranges::find_if(walkers, deviates);
  text_line(ui, ui.fonts.small, ui.theme.text, "exaggerate differences from even (x)");
  SliderLook look;
  look.min = 1.0;
  look.max = kMostExaggerated;
  look.decimals = 1;
  look.is_enabled = ui.is_live() && one != walkers.end();
  const double now = one == walkers.end() ? 1.0 : exaggeration(ui, *one).value_or(1.0);
  double times = pending_value(ui, "exaggerate", std::clamp(now, look.min, look.max)).value_or(1.0);
  if (!slider(ui, "exaggerate", times, look)) return;
  remember_pending(ui, "exaggerate", times);
  for (const WalkerFrame& walker : walkers) {
    each_deviation(ui, walker, [&](const StyleKey& key, double own, double even) {
      const double value = std::clamp(even + times * (own - even), key.min, key.max);
      ui.out.commands.push_back(
          fmt::format("set {} {} {}", number_of(ui, walker), key.name, value));
    });
  }
}

// Draws a chip for each character; two marked characters are overlaid in one place.
void draw_overlay(Ui& ui) {
  const int count = ui.in.frame.walker_count;
  if (count < 2) return;
  std::vector<int>& overlaid = ui.state.overlaid;
  const float gap = std::round(ui.px(4)), chips = static_cast<float>(count);
  const float label = text_width(ui.fonts.small, "overlay") + ui.px(8);
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  ButtonLook look;
  look.height = std::round(ui.px(22));
  look.width = std::floor((ImGui::GetContentRegionAvail().x - label - gap * (chips - 1)) / chips);
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.small, ui.theme.text,
           {begin.x, begin.y + (look.height - ui.fonts.small->FontSize) / 2.0f}, "overlay", label);
  ImGui::SetCursorScreenPos({begin.x + label, begin.y});
  for (int i = 0; i < count; ++i) {
    if (i > 0) ImGui::SameLine(0.0f, gap);
    const auto mark = std::ranges::find(overlaid, i);
    look.is_on = mark != overlaid.end();
    look.dot = walker_colour(ui, i);
    if (!button(ui, fmt::format("overlay {}", i + 1), fmt::format("{}", i + 1), look)) continue;
    if (look.is_on) {
      overlaid.erase(mark);
    } else {
      if (overlaid.size() == 2) overlaid.pop_back();
      overlaid.push_back(i);
    }
  }
}

void draw_buttons(Ui& ui) {
  const float width = ImGui::GetContentRegionAvail().x, gap = std::round(ui.px(6));
  const float cell = std::floor((width - gap) / 2.0f);
  const std::vector<StyleKey>& keys = style_keys();
  ButtonLook look;
  look.width = cell;
  look.height = std::round(ui.px(22));
  look.is_enabled = ui.is_live() && std::ranges::any_of(keys, [&](const StyleKey& key) {
                      return is_changed(ui, &key);
                    });
  if (button(ui, "own all", "all back", look)) {
    for (const WalkerFrame& walker : ui.selected())
      ui.out.commands.push_back(
          fmt::format("style {} {}", number_of(ui, walker), style_name(ui, walker.style_index)));
    forget_pending(ui, "");
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
  const auto walkers = ui.selected();
  const GaitLimits& limits = ui.in.cast.members[static_cast<std::size_t>(index)].limits;
  const Controlled controlled{
      walkers, gait_params(ui.in.frame.stick, walkers.front().style, limits), limits};
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
      forget_pending(ui, "");
    }
  }
  ImGui::PopStyleVar();
}

void draw_style_panel(Ui& ui) {
  if (ui.walker() < 0) return note(ui, "no character yet");
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  draw_choice(ui);
  draw_save(ui);
  draw_exaggerate(ui);
  draw_overlay(ui);
  for (const StyleRow& row : rows_of(ui.state.memory)) draw_row(ui, row);
  draw_buttons(ui);
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
