#include "view/ui.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "view/panels.h"
#include "view/widgets.h"

namespace gaitpad {
namespace {

// Pixels at scale 1.
constexpr float kTopBar = 44.0f, kTimeline = 64.0f, kStatus = 24.0f;
constexpr float kLeftColumn = 268.0f, kRightColumn = 320.0f;
constexpr float kLeastScene = 260.0f;  // least width of the scene between two columns of panels
constexpr float kLeastSceneBesideOne = 180.0f;
constexpr float kLeastSceneHeight = 100.0f;  // a scene lower than this hides the status line

bool is_any_open(const UiState& state, bool left) noexcept {
  for (int i = 0; i < kPanels; ++i) {
    if (state.is_open[static_cast<std::size_t>(i)] && is_left(static_cast<Panel>(i)) == left) {
      return true;
    }
  }
  return false;
}

// Draws a line along the edge towards the scene.
void draw_edge(Ui& ui, const UiRect& rect) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 size = ImGui::GetIO().DisplaySize, min = rect.min(), max = rect.max();
  const ImU32 colour = packed(ui.theme.border);
  list.PushClipRect(min, max);
  if (rect.width < size.x && rect.x > 0.0f) {
    list.AddRectFilled(min, {min.x + 1.0f, max.y}, colour);
  } else if (rect.width < size.x) {
    list.AddRectFilled({max.x - 1.0f, min.y}, max, colour);
  } else if (rect.y > 0.0f) {
    list.AddRectFilled(min, {max.x, min.y + 1.0f}, colour);
  } else {
    list.AddRectFilled({min.x, max.y - 1.0f}, max, colour);
  }
  list.PopClipRect();
}

// Begins a fixed ImGui window in the rectangle; `padding` at scale 1.
void begin_area(Ui& ui, const char* id, const UiRect& rect, const Colour& back,
                const ImVec2& padding, ImGuiWindowFlags flags = 0) {
  flags |= ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
           ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus |
           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav;
  if (ui.in.is_modal) flags |= ImGuiWindowFlags_NoInputs;
  ImGui::SetNextWindowPos(rect.min());
  ImGui::SetNextWindowSize({rect.width, rect.height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_colour(back));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding,
                      ImVec2{std::round(ui.px(padding.x)), std::round(ui.px(padding.y))});
  ImGui::Begin(id, nullptr, flags);
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  keep_area(id, rect.min(), rect.max());
  draw_edge(ui, rect);
}

void end_area() { ImGui::End(); }

constexpr std::size_t kMaxMessages = 4;  // most messages that are shown at once
constexpr int kMaxMessageLines = 3;

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string session_text(const Ui& ui) {
  std::string text = fmt::format("motion {}", ui.in.cast.motion);
  const int count = ui.in.frame.walker_count;
  text += fmt::format("  \u00b7  {} character{}", count, count == 1 ? "" : "s");
  const bool steers = ui.in.frame.stick_means == StickMeans::steers;
  text += steers ? "  \u00b7  stick steers" : "  \u00b7  stick points";
  if (!ui.in.source.empty()) text += "  \u00b7  " + file_name(ui.in.source);
  if (!ui.in.recording.empty()) text += "  \u00b7  recording to " + file_name(ui.in.recording);
  return text;
}

// Moves chips up if they overlap earlier ones.
void spread(std::vector<ImRect>& chips) {
  for (std::size_t i = 0; i < chips.size(); ++i) {
    for (std::size_t tries = 0; tries < chips.size(); ++tries) {
      const auto hit = std::find_if(chips.begin(), chips.begin() + static_cast<std::ptrdiff_t>(i),
                                    [&](const ImRect& r) { return r.Overlaps(chips[i]); });
      if (hit == chips.begin() + static_cast<std::ptrdiff_t>(i)) break;
      chips[i].TranslateY(hit->Min.y - chips[i].Max.y - 2.0f);
    }
  }
}

bool is_inside(const UiRect& rect, const vec2& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && p.x >= rect.x && p.y >= rect.y &&
         p.x <= rect.x + rect.width && p.y <= rect.y + rect.height;
}

void draw_chip(Ui& ui, ImDrawList& list, const ImRect& chip, const UiLabel& label) {
  const float rounding = chip.GetHeight() / 2.0f;
  list.AddRectFilled(chip.Min, chip.Max, packed(with_alpha(ui.theme.panel, 0.88)), rounding);
  list.AddRect(chip.Min, chip.Max, packed(with_alpha(label.colour, 0.75)), rounding, 0, ui.px(1));
  list.AddCircleFilled({chip.Min.x + ui.px(11), chip.GetCenter().y}, ui.px(4), packed(label.colour),
                       16);
  put_text(list, ui.fonts.small, ui.theme.text,
           {chip.Min.x + ui.px(20), chip.GetCenter().y - ui.fonts.small->FontSize / 2.0f},
           label.text, chip.GetWidth() - ui.px(28));
}

void draw_message_card(Ui& ui, float width) {
  const auto& all = ui.in.messages;
  const std::size_t shown = std::min(all.size(), kMaxMessages);
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  const float close = std::round(ui.px(20)), room = width - close - ui.px(6);
  for (std::size_t i = all.size() - shown; i < all.size(); ++i) {
    for (const std::string& line : text_lines(ui.fonts.body, all[i], room, kMaxMessageLines)) {
      text_line(ui, ui.fonts.body, ui.theme.text, line, room);
    }
    if (i + 1 < all.size()) ImGui::Dummy({1.0f, ui.px(2)});
  }
  if (all.size() > shown) note(ui, fmt::format("and {} before", all.size() - shown), 1);
  if (!ui.in.finished_recording.empty() && button(ui, "replay recording", "Replay it"))
    ui.out.replays = true;
  const ImVec2 end = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos({begin.x + width - close, begin.y - ui.px(2)});
  ButtonLook look;
  look.icon = Icon::close;
  look.width = look.height = close;
  if (button(ui, "dismiss", "", look)) ui.out.dismisses_messages = true;
  ImGui::SetCursorScreenPos(end);
}

void draw_status(Ui& ui, const UiRect& rect) {
  if (rect.is_empty()) return;
  begin_area(ui, "status line", rect, ui.theme.bar, {14.0f, 5.0f},
             ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = rect.y + (rect.height - ui.fonts.small->FontSize) / 2.0f;
  const float room = rect.width - ui.px(28);
  const float right = std::min(text_width(ui.fonts.small, drawable(ui.in.renderer)), room * 0.4f);
  // Show the last change and its characters for a while.
  const bool is_news = !ui.in.change.empty();
  put_text(list, ui.fonts.small, is_news ? ui.theme.left : ui.theme.secondary,
           {rect.x + ui.px(14), y}, is_news ? ui.in.change : session_text(ui),
           room - right - ui.px(16));
  put_text(list, ui.fonts.small, ui.theme.tick, {rect.x + rect.width - ui.px(14) - right, y},
           ui.in.renderer, right + 1.0f);
  end_area();
}

void draw_messages(Ui& ui, const UiRect& scene) {
  if (ui.in.messages.empty() || scene.is_empty()) return;
  const float margin = ui.px(12), width = std::min(ui.px(440), scene.width - 2.0f * margin);
  if (width < ui.px(60)) return;
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize;
  if (ui.in.is_modal) flags |= ImGuiWindowFlags_NoInputs;
  ImGui::SetNextWindowPos({scene.x + margin, scene.y + margin});
  ImGui::SetNextWindowSizeConstraints({width, 0.0f}, {width, scene.height - 2.0f * margin});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_colour(with_alpha(ui.theme.card, 0.96)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2{ui.px(14), ui.px(10)});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), ui.px(3)});
  ImGui::Begin("messages", nullptr, flags);
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(at, {at.x + size.x, at.y + size.y});
  list.AddRectFilled({at.x + 1.0f, at.y + ui.px(6)}, {at.x + ui.px(4), at.y + size.y - ui.px(6)},
                     packed(ui.theme.warning), ui.px(2));
  list.PopClipRect();
  keep_area("messages", at, {at.x + size.x, at.y + size.y});
  draw_message_card(ui, width - ui.px(28));
  ImGui::End();
  ImGui::PopStyleVar(4);
  ImGui::PopStyleColor();
}

void draw_labels(Ui& ui, const UiRect& scene) {
  if (!ui.state.has_names || scene.is_empty()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  std::vector<ImRect> chips;
  std::vector<const UiLabel*> labels;
  for (const UiLabel& label : ui.in.labels) {
    if (!is_inside(scene, label.place_px)) continue;
    const float text =
        std::min(text_width(ui.fonts.small, drawable(label.text)) + 1.0f, ui.px(140));
    const ImVec2 place(static_cast<float>(label.place_px.x), static_cast<float>(label.place_px.y));
    // Keep labels completely inside the scene.
    const float width = std::min(text + ui.px(28), scene.width);
    const float height = std::min(std::round(ui.px(20)), scene.height);
    const float x =
        std::clamp(std::round(place.x - width / 2.0f), scene.x, scene.x + scene.width - width);
    const float y = std::max(std::round(place.y - height), scene.y);
    chips.emplace_back(ImVec2{x, y}, ImVec2{x + width, y + height});
    labels.push_back(&label);
  }
  spread(chips);
  list.PushClipRect(scene.min(), scene.max());
  for (std::size_t i = 0; i < chips.size(); ++i) draw_chip(ui, list, chips[i], *labels[i]);
  list.PopClipRect();
}

// Draws the first steps in the lower middle of the scene: "W A S D or plug a pad in; F1: keys".
void draw_hint(Ui& ui, const UiRect& scene) {
  if (ui.in.hint.empty() || scene.is_empty() || ui.in.is_modal) return;
  const float pad = ui.px(16), room = std::min(scene.width - 4.0f * pad, ui.px(560));
  if (room < ui.px(120)) return;
  std::vector<std::string> lines = text_lines(ui.fonts.heading, ui.in.hint, room, 2);
  const std::size_t large = lines.size();
  for (std::string& line : text_lines(ui.fonts.small, ui.in.pad_hint, room, 3))
    lines.push_back(std::move(line));
  float width = 0.0f, height = 0.0f;
  const auto font_of = [&](std::size_t i) { return i < large ? ui.fonts.heading : ui.fonts.small; };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    width = std::max(width, text_width(font_of(i), lines[i]));
    height += font_of(i)->FontSize + ui.px(4);
  }
  const ImVec2 min{std::round(scene.x + (scene.width - width) / 2.0f - pad),
                   std::round(scene.y + scene.height - height - 2.0f * pad - ui.px(18))};
  const ImVec2 max{min.x + width + 2.0f * pad, min.y + height + 1.5f * pad};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(min, max, packed(with_alpha(ui.theme.card, 0.93)), ui.px(8));
  list.AddRect(min, max, packed(with_alpha(ui.theme.left, 0.7)), ui.px(8), 0, ui.px(1));
  float y = min.y + pad * 0.85f;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const float x = (min.x + max.x - text_width(font_of(i), lines[i])) / 2.0f;
    put_text(list, font_of(i), i < large ? ui.theme.text : ui.theme.secondary, {x, y}, lines[i],
             width + 1.0f);
    y += font_of(i)->FontSize + ui.px(4);
  }
}

void draw_heading(Ui& ui, std::size_t index) {
  const PanelInfo& panel = kPanelTable[index];
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, close = std::round(ui.px(20));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  put_text(list, ui.fonts.heading, ui.theme.text, at, panel.title, width - close);
  if (panel.subject != PanelSubject::session) {
    const float x = text_width(ui.fonts.heading, panel.title) + ui.px(10);
    const bool changes = panel.subject == PanelSubject::changed_walker;
    const bool is_for_all =
        ui.state.walker < 0 && ui.in.frame.walker_count > 1 && changes && ui.is_live();
    put_text(list, ui.fonts.small, is_for_all ? ui.theme.left : ui.theme.secondary,
             {at.x + x, at.y + ui.px(2)},
             is_for_all ? fmt::format("changes all {}", ui.in.frame.walker_count)
                        : walker_name(ui, ui.walker()),
             width - close - x - ui.px(4));
  }
  ImGui::SetCursorScreenPos({at.x + width - close, at.y - ui.px(2)});
  ButtonLook look;
  look.icon = Icon::close;
  look.width = look.height = close;
  if (button(ui, fmt::format("close {}", panel.name()), "", look)) {
    ui.out.actions.push_back(action_of(index));
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

constexpr float kChip = 22.0f, kChipGap = 4.0f, kCastPadding = 8.0f;
// Up to this number of characters the chips have room for the styles' names.
constexpr int kNamedCast = 4;

int chips_a_row(int characters) noexcept { return characters <= kNamedCast ? 2 : 7; }

// Draws a chip for each character and one for all. They select the characters that styles and
// sliders change, and stay visible above the panels.
void draw_cast(Ui& ui, const UiRect& rect) {
  const int count = ui.in.frame.walker_count;
  if (rect.is_empty()) return;
  begin_area(ui, "cast", rect, ui.theme.panel, {14.0f, kCastPadding},
             ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const float gap = std::round(ui.px(kChipGap)), width = ImGui::GetContentRegionAvail().x;
  ButtonLook look;
  look.height = std::round(ui.px(kChip));
  look.width = width;
  look.is_on = ui.state.walker < 0;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{gap, gap});
  const std::string all = count == 2 ? "Both characters" : fmt::format("All {} characters", count);
  if (button(ui, "walker all", all, look)) ui.state.walker = -1;
  const int in_row = chips_a_row(count);
  look.width =
      std::floor((width - gap * static_cast<float>(in_row - 1)) / static_cast<float>(in_row));
  for (int i = 0; i < count; ++i) {
    if (i % in_row != 0) ImGui::SameLine(0.0f, gap);
    look.is_on = ui.state.walker == i;
    look.dot = walker_colour(ui, i);
    const std::string name = count <= kNamedCast ? walker_name(ui, i) : fmt::format("{}", i + 1);
    if (button(ui, fmt::format("walker {}", i + 1), name, look)) ui.state.walker = i;
  }
  ImGui::PopStyleVar();
  end_area();
}

void draw_panel(Ui& ui, std::size_t index, bool has_just_opened) {
  const ImVec2 begin = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::PushID(static_cast<int>(index));
  draw_heading(ui, index);
  kPanelTable[index].draw(ui);
  ImGui::PopID();
  const float end = ImGui::GetCursorScreenPos().y;
  keep_area(fmt::format("area {}", kPanelNames[index]), begin, {begin.x + width, end});
  // Scroll to a panel that was just opened: to all of it, or at least to its beginning.
  if (!has_just_opened) return;
  const ImRect seen = ImGui::GetCurrentWindow()->InnerRect;
  const float hidden = std::min(end - seen.Max.y, begin.y - seen.Min.y - ui.px(8));
  if (hidden > 0.0f) ImGui::SetScrollY(ImGui::GetScrollY() + hidden);
}

void draw_column(Ui& ui, const UiLayout& layout, PanelColumn column) {
  const bool is_left_one = column == PanelColumn::left;
  UiRect rect = is_left_one ? layout.left : layout.right;
  if (rect.is_empty()) return;
  const bool has_both = !layout.left.is_empty() && !layout.right.is_empty();
  if (is_left_one || !has_both) {
    const float height =
        std::min(cast_height(ui.in.frame.walker_count, ui.scale), rect.height / 2.0f);
    draw_cast(ui, {rect.x, rect.y, rect.width, height});
    rect.y += height;
    rect.height -= height;
  }
  const char* id = is_left_one ? "left column" : "right column";
  begin_area(ui, id, rect, ui.theme.panel, {14.0f, 10.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2{ui.px(8), std::round(ui.px(5))});
  bool is_first = true;
  for (std::size_t index = 0; index < kPanels; ++index) {
    const bool is_mine = !has_both || kPanelTable[index].column == column;
    if (!ui.state.is_open[index] || !is_mine) continue;
    if (!is_first) draw_separator(ui);
    is_first = false;
    draw_panel(ui, index, !ui.state.memory.was_open[index]);
  }
  ImGui::PopStyleVar();
  end_area();
}

void draw_columns(Ui& ui, const UiLayout& layout) {
  if (!ui.state.memory.has_drawn) ui.state.memory.was_open = ui.state.is_open;
  ui.state.memory.has_drawn = true;
  draw_column(ui, layout, PanelColumn::left);
  draw_column(ui, layout, PanelColumn::right);
  ui.state.memory.was_open = ui.state.is_open;
}

constexpr std::size_t kBarButtons = 6;  // the buttons that open panels come after these

// A button of the bar with its action; without an action it opens the view menu.
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
  for (std::size_t i = 0; i < kPanels; ++i) {
    const PanelInfo& panel = kPanelTable[i];
    all.push_back({panel.id, panel.title, action_of(i), look_of(Icon::none, ui.state.is_open[i])});
  }
  return all;
}

void press(Ui& ui, const Entry& entry) {
  if (entry.action) {
    ui.out.actions.push_back(*entry.action);
  } else {
    open_menu("view menu");
  }
}

void draw_type_size(Ui& ui, float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ButtonLook look;
  look.width = std::round(ui.px(30));
  const double now = ui.state.type_size;
  look.is_enabled = now > kLeastTypeSize + 0.01;
  if (button(ui, "type smaller", "-", look)) ui.out.type_size = now - kTypeSizeStep;
  const std::string text = fmt::format("Type: {:.0f} %", now * 100.0);
  const float room = width - 2.0f * look.width, text_px = text_width(ui.fonts.body, text);
  put_text(*ImGui::GetWindowDrawList(), ui.fonts.body, ui.theme.text,
           {at.x + look.width + (room - text_px) / 2.0f, at.y + ui.px(5)}, text, room);
  ImGui::SetCursorScreenPos({at.x + width - look.width, at.y});
  look.is_enabled = now < kMostTypeSize - 0.01;
  if (button(ui, "type larger", "+", look)) ui.out.type_size = now + kTypeSizeStep;
}

void draw_view_menu(Ui& ui) {
  if (!ImGui::BeginPopup("view menu")) return;
  ButtonLook look;
  look.width = std::round(ui.px(150));
  for (const ScenePart& part : kSceneParts) {
    bool& value = ui.state.*part.is_shown;
    look.is_on = value;
    const std::string label = fmt::format("{}: {}", part.label, value ? "shown" : "hidden");
    if (!button(ui, part.name, label, look)) continue;
    const auto action = std::ranges::find(actions(), part.name, &ActionInfo::name);
    if (action != actions().end()) {
      ui.out.actions.push_back(action->action);
    } else {
      value = !value;
    }
  }
  look.is_on = false;
  const bool is_dark = ui.state.theme == ThemeName::dark;
  if (button(ui, "theme", is_dark ? "Theme: dark" : "Theme: light", look)) {
    ui.out.actions.push_back(Action::theme);
  }
  draw_type_size(ui, look.width);
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

// Draws the menu of the entries that do not fit into the bar.
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

// State of loop and window, at the right. The colour of each dot repeats its text.
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

// Draws the last facts, as many as fit between `left` and the right edge; returns the x of the
// first.
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

void draw_top_bar(Ui& ui, const UiRect& rect) {
  if (rect.is_empty()) return;
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
  const std::size_t most =
      fits ? all.size() : kBarButtons;  // either all or none of the panels' buttons are in the bar
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
    if (button(ui, "menu", i == kBarButtons ? "Panels" : "Menu")) open_menu("menu");
    x += menu;
  }
  draw_facts(ui, rect, rect.x + x + ui.px(10));
  draw_menu(ui, all, i);
  draw_view_menu(ui);
  end_area();
}

constexpr std::array<double, 5> kPaces = {0.1, 0.25, 0.5, 1.0, 2.0};
// Width at scale 1; a narrower window has two rows and a single button for the pace.
constexpr float kFullWidth = 980.0f;

constexpr float kTrackWithSeconds = 28.0f;

std::string clock_text(double seconds) {
  const auto ms = static_cast<std::int64_t>(std::max(seconds, 0.0) * 1000.0 + 0.5);
  return fmt::format("{:02d}:{:02d}.{:03d}", ms / 60000, ms / 1000 % 60, ms % 1000);
}

double seconds_of(const Ui& ui, std::int64_t tick) {
  return static_cast<double>(tick) / std::max(ui.in.cast.rate_hz, 1);
}

std::int64_t last_tick(const Timeline& timeline) {
  return std::max<std::int64_t>(timeline.ticks - 1, 0);
}

struct Track {
  UiRect rect;  // place of the time line in window pixels; the line is in the middle of it
  std::int64_t last = 0;
  float x_of(std::int64_t tick) const noexcept {
    const double share = last > 0 ? static_cast<double>(tick) / static_cast<double>(last) : 0.0;
    return rect.x + static_cast<float>(std::clamp(share, 0.0, 1.0)) * rect.width;
  }
  std::int64_t tick_at(float x) const noexcept {
    const double share = rect.width > 0.0f ? (x - rect.x) / rect.width : 0.0;
    return std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(last));
  }
};

void draw_seconds(Ui& ui, const Track& track) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double end_s = seconds_of(ui, track.last);
  const int steps = static_cast<int>(track.rect.width / ui.px(80));
  const double step = nice_step(end_s, std::max(steps, 1));
  for (const double s : nice_ticks(0.0, end_s, std::max(steps, 1))) {
    const float x = track.x_of(std::llround(s * ui.in.cast.rate_hz));
    const std::string text = tick_text(s, step) + " s";
    const float width = text_width(ui.fonts.tick, text);
    const float left = std::clamp(x - width / 2.0f, track.rect.x - ui.px(4),
                                  track.rect.x + track.rect.width - width + ui.px(4));
    put_text(list, ui.fonts.tick, ui.theme.tick, {left, track.rect.y - ui.px(7)}, text,
             width + 1.0f);
    list.AddLine({x, track.rect.y + ui.px(7)}, {x, track.rect.y + ui.px(12)},
                 packed(ui.theme.tick));
  }
}

// Draws marks below the line, with a tooltip under the mouse.
void draw_marks(Ui& ui, const Track& track, float y) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float r = ui.px(4.5);
  const PlaybackMark* pointed = nullptr;
  float last_x = -1e9f;
  for (const PlaybackMark& mark : ui.in.timeline->marks) {
    const float x = track.x_of(mark.tick);
    if (std::abs(mouse.x - x) <= r * 1.5f && std::abs(mouse.y - (y + r * 1.6f)) <= r * 2.0f) {
      pointed = &mark;
    }
    if (x - last_x < 1.0f) continue;  // overlapping marks are drawn once
    last_x = x;
    list.AddTriangleFilled({x - r, y + 2.6f * r}, {x + r, y + 2.6f * r}, {x, y + r},
                           packed(ui.theme.warning));
  }
  if (pointed == nullptr || ui.in.is_modal) return;
  ImGui::BeginTooltip();
  const std::string text =
      fmt::format("{}  {}", clock_text(seconds_of(ui, pointed->tick)), pointed->text);
  text_line(ui, ui.fonts.small, ui.theme.text, text,
            std::min(ui.px(360), text_width(ui.fonts.small, drawable(text)) + 1.0f));
  ImGui::EndTooltip();
}

void draw_track(Ui& ui, const UiRect& rect) {
  const Timeline& timeline = *ui.in.timeline;
  const Track track{rect, last_tick(timeline)};
  const float reach = ui.px(8);
  ImGui::SetCursorScreenPos({rect.x - reach, rect.y});
  ImGui::InvisibleButton("timeline", {rect.width + 2.0f * reach, rect.height});
  keep_item("timeline");
  std::int64_t shown = timeline.tick;
  if (ImGui::IsItemActive() && track.last > 0) {
    shown = track.tick_at(ImGui::GetIO().MousePos.x);
    if (shown != timeline.tick) ui.out.seek_tick = shown;
  }
  if (is_focused(ui, "timeline") && ui.in.navigation.sideways != 0)
    ui.out.seek_tick = timeline.tick + ui.in.navigation.sideways * ui.in.cast.rate_hz;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = std::round(rect.y + rect.height / 2.0f), half = ui.px(3);
  if (rect.height >= ui.px(kTrackWithSeconds)) draw_seconds(ui, track);
  list.AddRectFilled({rect.x, y - half}, {rect.x + rect.width, y + half}, packed(ui.theme.frame),
                     half);
  const float x = track.x_of(shown);
  list.AddRectFilled({rect.x, y - half}, {x, y + half}, packed(ui.theme.accent), half);
  draw_marks(ui, track, y);
  list.AddCircleFilled({x, y}, ui.px(7), packed(ui.theme.left), 20);
  list.AddCircleFilled({x, y}, ui.px(5), packed(rgb(0xffffff)), 20);
}

void icon_button(Ui& ui, std::string_view id, Icon icon, const ImVec2& at,
                 const ButtonLook& look = {}) {
  ButtonLook full = look;
  full.icon = icon;
  full.width = std::round(ui.px(30));
  ImGui::SetCursorScreenPos(at);
  if (!button(ui, id, "", full)) return;
  if (id == "to begin") ui.out.seek_tick = 0;
  if (id == "timeline play") ui.out.actions.push_back(Action::pause);
  if (id == "timeline step") ui.out.actions.push_back(Action::step);
  if (id == "loop") ui.out.is_looping = !ui.in.timeline->is_looping;
}

// Draws the buttons and the time; returns the x at their end.
float draw_transport(Ui& ui, float x, float y, bool is_full) {
  const Timeline& timeline = *ui.in.timeline;
  ButtonLook primary;
  primary.is_primary = true;
  icon_button(ui, "to begin", Icon::to_begin, {x, y});
  icon_button(ui, "timeline play", timeline.pace > 0.0 ? Icon::pause : Icon::play,
              {x + ui.px(36), y}, primary);
  icon_button(ui, "timeline step", Icon::step, {x + ui.px(72), y});
  const float text_x = x + ui.px(114);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  put_text(list, ui.fonts.heading, ui.theme.text, {text_x, y - ui.px(4)},
           clock_text(seconds_of(ui, timeline.tick)), ui.px(96));
  const std::string place = fmt::format("tick {} / {}{}", timeline.tick, last_tick(timeline),
                                        timeline.is_computing ? " ..." : "");
  // The time line says so if the recording changes styles that the user chose.
  const bool changes_styles = std::ranges::any_of(
      timeline.marks, [](const PlaybackMark& mark) { return mark.text.starts_with("style "); });
  put_text(list, ui.fonts.small, ui.theme.secondary, {text_x, y + ui.px(14)}, place, ui.px(128));
  if (changes_styles && is_full)
    put_text(list, ui.fonts.tick, ui.theme.warning, {text_x, y + ui.px(29)}, "changes styles",
             ui.px(128));
  return text_x + ui.px(136);
}

std::string pace_text(double pace) { return fmt::format("{:g}x", pace); }

// The pace that follows in the list, for the single button of a narrow window.
double pace_after(double pace) {
  const auto next = std::upper_bound(kPaces.begin(), kPaces.end(), pace + 1e-9);
  return next == kPaces.end() ? kPaces.front() : *next;
}

void draw_paces(Ui& ui, float x, float y) {
  for (const double pace : kPaces) {
    ButtonLook look;
    look.width = std::round(ui.px(44));
    look.is_on = ui.in.timeline->pace == pace;
    ImGui::SetCursorScreenPos({x, y});
    if (button(ui, fmt::format("pace {:g}", pace), pace_text(pace), look)) ui.out.pace = pace;
    x += look.width + std::round(ui.px(4));
  }
}

void draw_timeline(Ui& ui, const UiRect& rect) {
  if (rect.is_empty()) return;
  begin_area(ui, "timeline bar", rect, ui.theme.bar, {14.0f, 6.0f},
             ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const bool is_full = rect.width >= ui.px(kFullWidth);
  const float y = rect.y + std::round(ui.px(is_full ? 19 : 7));
  const float left = draw_transport(ui, rect.x + ui.px(14), y, is_full);
  const float loop = std::round(ui.px(30));
  ButtonLook looping;
  looping.is_on = ui.in.timeline->is_looping;
  float right = rect.x + rect.width - ui.px(14);
  if (ui.in.can_leave) {
    ButtonLook leave;
    leave.is_primary = true;
    right -= button_width(ui, "Leave", leave);
    ImGui::SetCursorScreenPos({right, y});
    if (button(ui, "leave playback", "Leave", leave)) ui.out.actions.push_back(Action::back);
    right -= std::round(ui.px(10));
  }
  if (is_full) {
    const float paces = ui.px(48) * static_cast<float>(kPaces.size());
    draw_paces(ui, right - paces, y);
    icon_button(ui, "loop", Icon::loop, {right - paces - loop - ui.px(8), y}, looping);
    const float end = right - paces - loop - ui.px(34);
    draw_track(ui, {left + ui.px(10), rect.y + ui.px(16), end - left - ui.px(10), ui.px(32)});
  } else {
    icon_button(ui, "loop", Icon::loop, {right - loop, y}, looping);
    ImGui::SetCursorScreenPos({right - loop - ui.px(60), y});
    ButtonLook look;
    look.width = std::round(ui.px(52));
    if (button(ui, "pace", pace_text(ui.in.timeline->pace), look)) {
      ui.out.pace = pace_after(ui.in.timeline->pace);
    }
    draw_track(ui, {rect.x + ui.px(22), rect.y + ui.px(38), rect.width - ui.px(44), ui.px(22)});
  }
  end_area();
}

constexpr double kRowPixels = 24.0, kHeadingPixels = 32.0, kColumnPixels = 420.0;
constexpr double kKeysPixels = 124.0, kButtonPixels = 86.0;

// A row of the help page: a heading, or keys, pad button and text.
struct KeyRow {
  std::string_view heading;  // heading of a group; if it is not empty, the row has nothing else
  std::vector<std::string> keys;
  std::string_view button, text;
  std::vector<std::string_view> names;  // names of the row's actions
};

bool is_numbered_style(Action action) {
  return action >= Action::style_1 && action <= Action::style_9;
}

// Joins the nine keys of the styles in one row: "1 .. 9".
void add_style(const ActionInfo& info, KeyRow& row) {
  row.names.push_back(info.name);
  if (info.action != Action::style_9) return;
  row.keys[0] += fmt::format(" .. {}", key_name(info.key));
  row.keys[1] += fmt::format(" .. {}", key_name(info.key));
  row.text = "the style with that number";
}

std::vector<KeyRow> rows() {
  std::vector<KeyRow> all;
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
    KeyRow row{{}, {}, {}, info.text, {info.name}};
    for (const SDL_Keycode key : {info.key, info.second_key}) {
      if (key != SDLK_UNKNOWN) row.keys.emplace_back(key_name(key));
    }
    for (const Chord& chord : chords()) {
      if (chord.action == info.action && !chord.has_shift) row.keys.emplace_back(chord.name);
    }
    if (info.button >= 0) row.button = button_label(static_cast<PadButton>(info.button));
    all.push_back(std::move(row));
  }
  return all;
}

float height_of(const Ui& ui, const KeyRow& row) {
  return std::round(ui.px(row.heading.empty() ? kRowPixels : kHeadingPixels));
}

// Draws a key; returns the x at its end.
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

void draw_row(Ui& ui, const ImVec2& at, const KeyRow& row, float width) {
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

// Indices that break the rows into columns of similar height; a column starts with a heading.
std::vector<std::size_t> column_ends(const Ui& ui, const std::vector<KeyRow>& all, int columns) {
  float total = 0.0f;
  for (const KeyRow& row : all) total += height_of(ui, row);
  const float wanted = total / static_cast<float>(columns);
  std::vector<std::size_t> ends;
  float height = 0.0f;
  for (std::size_t i = 0; i < all.size(); ++i) {
    // True if more than half of the group that begins here exceeds the wanted height.
    float group = height_of(ui, all[i]);
    for (std::size_t k = i + 1; k < all.size() && all[k].heading.empty(); ++k)
      group += height_of(ui, all[k]);
    const bool is_full = height + group / 2.0f > wanted;
    if (is_full && i > 0 && !all[i].heading.empty() &&
        static_cast<int>(ends.size()) + 1 < columns) {
      ends.push_back(i);
      height = 0.0f;
    }
    height += height_of(ui, all[i]);
  }
  ends.push_back(all.size());
  return ends;
}

void draw_rows(Ui& ui, float width) {
  const std::vector<KeyRow> all = rows();
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
  keep_area("help page", room.min(), room.max());
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

void keep_sound(const UiInput& input, UiState& state) {
  if (input.frame.walker_count > 0 && state.walker >= input.frame.walker_count) state.walker = -1;
  if (state.walker < -1) state.walker = -1;
}

}  // namespace

bool is_left(Panel panel) noexcept {
  return kPanelTable[static_cast<std::size_t>(panel)].column == PanelColumn::left;
}

UiLayout ui_layout(const UiState& state, bool has_timeline, int width_px, int height_px,
                   double scale) noexcept {
  const auto px = [scale](float at_scale_1) {
    return std::round(at_scale_1 * static_cast<float>(scale));
  };
  const float width = static_cast<float>(std::max(width_px, 0));
  const float height = static_cast<float>(std::max(height_px, 0));
  UiLayout l;
  if (state.is_clean) {
    l.scene = {0.0f, 0.0f, width, height};
    return l;
  }
  l.top = {0.0f, 0.0f, width, std::min(px(kTopBar), height)};
  float bottom = height;
  if (has_timeline && bottom - px(kTimeline) > l.top.height) {
    l.timeline = {0.0f, bottom - px(kTimeline), width, px(kTimeline)};
    bottom = l.timeline.y;
  }
  if (bottom - px(kStatus) - l.top.height >= px(kLeastSceneHeight)) {
    l.status = {0.0f, bottom - px(kStatus), width, px(kStatus)};
    bottom = l.status.y;
  }
  const float top = l.top.height, middle = std::max(bottom - top, 0.0f);
  bool has_left = is_any_open(state, true), has_right = is_any_open(state, false);
  float left = px(kLeftColumn), right = px(kRightColumn);
  if (has_left && has_right && width < left + right + px(kLeastScene)) has_right = false;
  if (has_right && width < right + px(kLeastScene)) {
    has_left = true;
    has_right = false;
  }
  if (width < left + px(kLeastSceneBesideOne)) has_left = has_right = false;
  if (has_left) l.left = {0.0f, top, left, middle};
  if (has_right) l.right = {width - right, top, right, middle};
  l.scene = {l.left.width, top, width - l.left.width - l.right.width, middle};
  return l;
}

float cast_height(int characters, float scale) noexcept {
  if (characters <= 1) return 0.0f;
  const int in_row = chips_a_row(characters), rows = 1 + (characters + in_row - 1) / in_row;
  return std::round((static_cast<float>(rows) * (kChip + kChipGap) + 2.0f * kCastPadding) * scale);
}

Viewport scene_viewport(const UiState& state, bool has_timeline, int width_px, int height_px,
                        double scale) noexcept {
  const UiRect scene = ui_layout(state, has_timeline, width_px, height_px, scale).scene;
  return {static_cast<int>(scene.x), static_cast<int>(scene.y), static_cast<int>(scene.width),
          static_cast<int>(scene.height)};
}

std::vector<int> style_choices(const Cast& cast) {
  std::vector<int> choices;
  for (std::size_t i = 0; i < cast.styles.size(); ++i) {
    const auto first = std::find(cast.styles.begin(), cast.styles.end(), cast.styles[i]);
    if (first == cast.styles.begin() + static_cast<std::ptrdiff_t>(i)) {
      choices.push_back(static_cast<int>(i));
    }
  }
  return choices;
}

UiOutput draw_ui(const UiInput& input, const Theme& theme, const Fonts& fonts, double scale,
                 UiState& state) {
  UiOutput out;
  clear_items();
  keep_sound(input, state);
  Ui ui{input, theme, fonts, static_cast<float>(scale), state, out};
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const int width = static_cast<int>(size.x), height = static_cast<int>(size.y);
  const UiLayout layout = ui_layout(state, input.timeline != nullptr, width, height, scale);
  draw_labels(ui, layout.scene);
  draw_columns(ui, layout);
  draw_top_bar(ui, layout.top);
  draw_timeline(ui, layout.timeline);
  draw_status(ui, layout.status);
  if (!state.is_clean) {
    draw_messages(ui, layout.scene);
    draw_hint(ui, layout.scene);
  }
  if (state.is_help_open) {
    draw_help(ui, {0.0f, layout.top.height, size.x, size.y - layout.top.height});
  }
  return out;
}

}  // namespace gaitpad
