#include "view/ui_parts.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

std::vector<UiItem> items;  // of the frame drawn last; one window draws, from one thread

}  // namespace

int Ui::walker() const noexcept {
  if (in.frame.walker_count <= 0) return -1;
  return state.walker >= 0 && state.walker < in.frame.walker_count ? state.walker : 0;
}

void clear_items() { items.clear(); }

namespace {

void keep(std::string_view name, const ImVec2& min, const ImVec2& max, const ImRect& clip) {
  ImRect rect(min, max);
  rect.ClipWithFull(clip);
  if (rect.GetWidth() < 1.0f || rect.GetHeight() < 1.0f) return;
  items.push_back({std::string(name), rect.Min, rect.Max});
}

}  // namespace

void keep_area(std::string_view name, const ImVec2& min, const ImVec2& max) {
  ImRect clip = ImGui::GetCurrentWindow()->Rect();
  clip.ClipWithFull(ImRect({0.0f, 0.0f}, ImGui::GetIO().DisplaySize));
  keep(name, min, max, clip);
}

void keep_item(std::string_view name, const ImVec2& min, const ImVec2& max) {
  keep(name, min, max, ImGui::GetCurrentWindow()->ClipRect);
}

void keep_item(std::string_view name) {
  keep_item(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

const std::vector<UiItem>& ui_items() noexcept { return items; }

void draw_icon(ImDrawList& list, Icon icon, const ImVec2& m, float r, ImU32 colour) {
  switch (icon) {
    case Icon::none:
      return;
    case Icon::play:
      list.AddTriangleFilled({m.x - 0.7f * r, m.y - r}, {m.x + r, m.y}, {m.x - 0.7f * r, m.y + r},
                             colour);
      return;
    case Icon::pause:
      list.AddRectFilled({m.x - 0.8f * r, m.y - r}, {m.x - 0.2f * r, m.y + r}, colour);
      list.AddRectFilled({m.x + 0.2f * r, m.y - r}, {m.x + 0.8f * r, m.y + r}, colour);
      return;
    case Icon::record:
      list.AddCircleFilled(m, r, colour, 16);
      return;
    case Icon::stop:
      list.AddRectFilled({m.x - 0.8f * r, m.y - 0.8f * r}, {m.x + 0.8f * r, m.y + 0.8f * r},
                         colour);
      return;
    case Icon::close:
      list.AddLine({m.x - r, m.y - r}, {m.x + r, m.y + r}, colour, 0.32f * r + 0.5f);
      list.AddLine({m.x - r, m.y + r}, {m.x + r, m.y - r}, colour, 0.32f * r + 0.5f);
      return;
    case Icon::to_begin:
      list.AddRectFilled({m.x - r, m.y - r}, {m.x - 0.6f * r, m.y + r}, colour);
      list.AddTriangleFilled({m.x + r, m.y - r}, {m.x - 0.5f * r, m.y}, {m.x + r, m.y + r}, colour);
      return;
    case Icon::step:
      list.AddTriangleFilled({m.x - r, m.y - r}, {m.x + 0.5f * r, m.y}, {m.x - r, m.y + r}, colour);
      list.AddRectFilled({m.x + 0.6f * r, m.y - r}, {m.x + r, m.y + r}, colour);
      return;
    case Icon::loop:
      list.PathArcTo(m, 0.85f * r, 0.6f, 5.6f, 16);
      list.PathStroke(colour, 0, 0.3f * r);
      list.AddTriangleFilled({m.x + 0.3f * r, m.y - 0.5f * r}, {m.x + 1.2f * r, m.y - 0.7f * r},
                             {m.x + 0.8f * r, m.y + 0.2f * r}, colour);
      return;
  }
}

float button_width(const Ui& ui, std::string_view label, const ButtonLook& look) {
  if (look.width > 0.0f) return look.width;
  float width = text_width(ui.fonts.body, label) + ui.px(20);
  if (look.icon != Icon::none) width += label.empty() ? ui.px(8) : ui.px(16);
  if (look.dot) width += ui.px(14);
  return std::ceil(width);
}

namespace {

void draw_button_back(Ui& ui, const ImVec2& min, const ImVec2& max, const ButtonLook& look) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ui.px(5);
  const bool is_chosen = look.is_on && !look.is_primary;
  Colour back = look.is_primary || look.is_on ? ui.theme.accent : ui.theme.frame;
  back.alpha = (is_chosen ? 0.45 : 1.0) * (look.is_enabled ? 1.0 : 0.5);
  list.AddRectFilled(min, max, packed(back), rounding);
  if (look.is_enabled && ImGui::IsItemHovered()) {
    const double strength = ImGui::IsItemActive() ? 0.18 : 0.08;
    list.AddRectFilled(min, max, packed(with_alpha(ui.theme.text, strength)), rounding);
  }
  if (is_chosen) {
    list.AddRect(min, max, packed(with_alpha(ui.theme.left, 0.8)), rounding, 0, ui.px(1));
  }
}

// Icon or dot, then the label, in the middle of the button.
void draw_button_face(Ui& ui, const ImVec2& min, const ImVec2& max, std::string_view label,
                      const ButtonLook& look) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImFont* font = ui.fonts.body;
  const Colour text =
      with_alpha(look.is_primary ? rgb(0xffffff) : ui.theme.text, look.is_enabled ? 1.0 : 0.45);
  const float front = (look.icon != Icon::none && !label.empty() ? ui.px(16) : 0.0f) +
                      (look.dot ? ui.px(14) : 0.0f);
  const float room = max.x - min.x - ui.px(8) - front;
  const float content = std::min(text_width(font, label), room);
  float x = (min.x + max.x - content - front) / 2.0f;
  const float middle = (min.y + max.y) / 2.0f;
  if (look.icon != Icon::none) {
    const float r = ui.px(4.5);
    draw_icon(list, look.icon, {label.empty() ? (min.x + max.x) / 2.0f : x + r, middle}, r,
              packed(look.icon == Icon::record ? ui.theme.bad : text));
  }
  if (look.dot) list.AddCircleFilled({x + ui.px(4), middle}, ui.px(4), packed(*look.dot), 16);
  put_text(list, font, text, {x + front, middle - font->FontSize / 2.0f}, label, content + 1.0f);
}

}  // namespace

bool button(Ui& ui, std::string_view id, std::string_view label, const ButtonLook& look) {
  const float height = look.height > 0.0f ? look.height : std::round(ui.px(26));
  ImGui::PushID(id.data(), id.data() + id.size());
  ImGui::BeginDisabled(!look.is_enabled);
  const bool is_pressed = ImGui::InvisibleButton("b", {button_width(ui, label, look), height});
  ImGui::EndDisabled();
  ImGui::PopID();
  if (look.is_enabled) keep_item(id);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  draw_button_back(ui, min, max, look);
  draw_button_face(ui, min, max, label, look);
  return is_pressed;
}

void send(Ui& ui, std::string_view verb, std::string_view rest) {
  if (ui.state.walker >= 0) {
    ui.out.commands.push_back(fmt::format("{} {} {}", verb, ui.state.walker + 1, rest));
  } else {
    ui.out.commands.push_back(fmt::format("{} {}", verb, rest));
  }
}

void send(Ui& ui, std::string_view verb, std::string_view key, double value) {
  send(ui, verb, fmt::format("{} {}", key, value));
}

Colour walker_colour(const Ui& ui, int walker) {
  return series_colour(ui.theme, static_cast<std::size_t>(std::max(walker, 0)));
}

std::string style_name(const Ui& ui, int style_index) {
  const auto& styles = ui.in.cast.styles;
  if (style_index < 0 || style_index >= static_cast<int>(styles.size())) return "?";
  return styles[static_cast<std::size_t>(style_index)];
}

std::string walker_name(const Ui& ui, int walker) {
  if (walker < 0 || walker >= ui.in.frame.walker_count) return "nobody";
  const WalkerFrame& frame = ui.in.frame.walkers[static_cast<std::size_t>(walker)];
  return fmt::format("{} {}", walker + 1, style_name(ui, frame.style_index));
}

}  // namespace gaitpad
