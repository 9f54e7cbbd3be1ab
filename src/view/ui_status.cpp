#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "view/ui_bars.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxMessages = 4;  // shown at once
constexpr int kMaxMessageLines = 3;

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string session_text(const Ui& ui) {
  std::string text = fmt::format("motion {}", ui.in.cast.motion);
  const int count = ui.in.frame.walker_count;
  text += fmt::format("  \u00b7  {} character{}", count, count == 1 ? "" : "s");
  if (!ui.in.source.empty()) text += "  \u00b7  " + file_name(ui.in.source);
  if (!ui.in.recording.empty()) text += "  \u00b7  recording to " + file_name(ui.in.recording);
  return text;
}

// Chips that would cover each other move up, the ones farther right above those before.
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
  const ImVec2 end = ImGui::GetCursorScreenPos();
  ImGui::SetCursorScreenPos({begin.x + width - close, begin.y - ui.px(2)});
  ButtonLook look;
  look.icon = Icon::close;
  look.width = look.height = close;
  if (button(ui, "dismiss", "", look)) ui.out.dismisses_messages = true;
  ImGui::SetCursorScreenPos(end);
}

}  // namespace

void begin_area(Ui& ui, const char* id, const UiRect& rect, const Colour& back,
                const ImVec2& padding, ImGuiWindowFlags flags) {
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
  keep_item(id, rect.min(), rect.max());
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(rect.min(), rect.max());
  list.AddRect({rect.x - 1.0f, rect.y - 1.0f},
               {rect.x + rect.width + (rect.x > 0.0f ? 1.0f : 0.0f), rect.y + rect.height},
               packed(ui.theme.border));
  list.PopClipRect();
}

void end_area() { ImGui::End(); }

void draw_status(Ui& ui, const UiRect& rect) {
  if (rect.is_empty()) return;
  begin_area(ui, "status line", rect, ui.theme.bar, {14.0f, 5.0f},
             ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = rect.y + (rect.height - ui.fonts.small->FontSize) / 2.0f;
  const float room = rect.width - ui.px(28);
  const float right = std::min(text_width(ui.fonts.small, drawable(ui.in.renderer)), room * 0.4f);
  put_text(list, ui.fonts.small, ui.theme.secondary, {rect.x + ui.px(14), y}, session_text(ui),
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
  keep_item("messages", at, {at.x + size.x, at.y + size.y});
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
    const float half = (text + ui.px(28)) / 2.0f, height = std::round(ui.px(20));
    chips.emplace_back(ImVec2{std::round(place.x - half), std::round(place.y - height)},
                       ImVec2{std::round(place.x + half), std::round(place.y)});
    labels.push_back(&label);
  }
  spread(chips);
  list.PushClipRect(scene.min(), scene.max());
  for (std::size_t i = 0; i < chips.size(); ++i) draw_chip(ui, list, chips[i], *labels[i]);
  list.PopClipRect();
}

}  // namespace gaitpad
