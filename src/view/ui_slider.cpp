#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "view/ui_parts.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kWishTicks = 60;  // a command takes effect within a few
constexpr double kKnobPixels = 5.0;      // half of it, and the slider's margin

double value_under_mouse(Ui& ui, float left, float right, const SliderLook& look) {
  const float margin = ui.px(kKnobPixels);
  const float share = (ImGui::GetIO().MousePos.x - left - margin) / (right - left - 2.0f * margin);
  const double value =
      look.min + std::clamp(static_cast<double>(share), 0.0, 1.0) * (look.max - look.min);
  const double unit = std::pow(10.0, look.decimals);
  return std::clamp(std::round(value * unit) / unit, look.min, look.max);
}

// In the middle, beside the knob where that would cover it.
void draw_number(Ui& ui, const ImVec2& min, const ImVec2& max, float knob, double value,
                 const SliderLook& look) {
  std::string text = tick_text(value, std::pow(10.0, -look.decimals));
  if (!look.letter.empty()) text = fmt::format("{} {}", look.letter, text);
  const ImFont* font = ui.fonts.small;
  const float width = text_width(font, text), room = ui.px(7);
  const float middle = (min.x + max.x) / 2.0f;
  float x = middle - width / 2.0f;
  if (knob < middle) {
    x = std::max(x, knob + room);
  } else {
    x = std::min(x, knob - room - width);
  }
  put_text(*ImGui::GetWindowDrawList(), font, ui.theme.text,
           {x, (min.y + max.y - font->FontSize) / 2.0f}, text, max.x - x);
}

void draw_notch(Ui& ui, float x, const ImVec2& min, const ImVec2& max) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = ui.px(3), h = ui.px(4.2);
  const ImU32 colour = packed(ui.theme.text);
  list.AddTriangleFilled({x - r, min.y}, {x, min.y + h}, {x + r, min.y}, colour);
  list.AddTriangleFilled({x - r, max.y}, {x + r, max.y}, {x, max.y - h}, colour);
}

void draw_slider(Ui& ui, const ImVec2& min, const ImVec2& max, double value,
                 const SliderLook& look) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const double span = look.max - look.min;
  const float margin = ui.px(kKnobPixels);
  const auto place = [&](double at) {
    const double share = span > 0.0 ? std::clamp((at - look.min) / span, 0.0, 1.0) : 0.0;
    return min.x + margin + static_cast<float>(share) * (max.x - min.x - 2.0f * margin);
  };
  const double strength = look.is_enabled ? 1.0 : 0.55;
  list.AddRectFilled(min, max, packed(ui.theme.frame), ui.px(4));
  const float grab = place(value);
  list.AddRectFilled(min, {grab, max.y}, packed(with_alpha(ui.theme.accent, 0.45 * strength)),
                     ui.px(4));
  if (look.mark && std::isfinite(*look.mark) && *look.mark != value) {
    draw_notch(ui, place(*look.mark), min, max);
  }
  const bool is_hot = ImGui::IsItemHovered() || ImGui::IsItemActive();
  Colour knob = is_hot && look.is_enabled ? ui.theme.text : ui.theme.left;
  list.AddRectFilled({grab - ui.px(3.5), min.y + ui.px(2)}, {grab + ui.px(3.5), max.y - ui.px(2)},
                     packed(with_alpha(knob, strength)), ui.px(3));
  if (look.is_changed) {
    list.AddRect(min, max, packed(ui.theme.warning), ui.px(4), 0, ui.px(1.4));
  }
  draw_number(ui, min, max, grab, value, look);
}

}  // namespace

bool slider(Ui& ui, std::string_view id, double& value, const SliderLook& look) {
  const float width = look.width > 0.0f ? look.width : ImGui::GetContentRegionAvail().x;
  if (!std::isfinite(value)) value = look.min;
  ImGui::PushID(id.data(), id.data() + id.size());
  ImGui::BeginDisabled(!look.is_enabled);
  ImGui::InvisibleButton("s", {std::max(width, ui.px(20)), std::round(ui.px(19))});
  const bool is_held = ImGui::IsItemActive();
  const bool is_taken = ImGui::IsItemActivated();
  ImGui::EndDisabled();
  ImGui::PopID();
  if (look.is_enabled) keep_item(id);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  double& held = ui.state.memory.held;  // what the person has asked for in this drag
  if (is_taken) held = value;
  bool is_moved = false;
  if (is_held && look.max > look.min) {
    const double wanted = value_under_mouse(ui, min.x, max.x, look);
    is_moved = wanted != held;
    held = value = wanted;
  }
  draw_slider(ui, min, max, value, look);
  return is_moved;
}

double wished(Ui& ui, const std::string& name, double value) {
  auto& wishes = ui.state.memory.wishes;
  const std::int64_t now = ui.in.frame.tick;
  std::erase_if(wishes, [&](const UiMemory::Wish& w) {
    return now < w.tick || now > w.tick + kWishTicks ||
           (w.name == name && w.walker == ui.state.walker && w.value == value && now > w.tick);
  });
  for (const UiMemory::Wish& w : wishes) {
    if (w.name == name && w.walker == ui.state.walker) return w.value;
  }
  return value;
}

void wish(Ui& ui, const std::string& name, double value) {
  auto& wishes = ui.state.memory.wishes;
  std::erase_if(wishes, [&](const UiMemory::Wish& w) {
    return w.name == name && w.walker == ui.state.walker;
  });
  wishes.push_back({name, ui.state.walker, value, ui.in.frame.tick});
}

void forget_wish(Ui& ui, const std::string& name) {
  std::erase_if(ui.state.memory.wishes,
                [&](const UiMemory::Wish& w) { return name.empty() || w.name == name; });
}

}  // namespace gaitpad
