#include "view/modal.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

constexpr double kVeil = 0.55;
constexpr double kRoom = 24.0;       // to the window's edges, at scale 1
constexpr double kMessages = 104.0;  // left free above, where there is room for both

}  // namespace

ImVec2 begin_modal(Ui& ui, const char* id, double width, double height, const ImVec2& window_px) {
  const float room = ui.px(kRoom);
  const ImVec2 size(std::min(ui.px(width), std::max(window_px.x - room, room)),
                    std::min(ui.px(height), std::max(window_px.y - room, room)));
  const float middle = (window_px.y - size.y) / 2, lowest = window_px.y - size.y - room / 2;
  const float top = std::max(middle, std::min(ui.px(kMessages), lowest));
  const ImVec2 at(std::round((window_px.x - size.x) / 2), std::round(top));
  const ImVec2 end(at.x + size.x, at.y + size.y);
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(20), ui.px(16)));
  ImGui::Begin(id, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
  if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
  // A veil in a window of its own would take the focus from a text that is being typed.
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  const Colour veil = with_alpha(ui.theme.window, kVeil);
  list.AddRectFilled(ImVec2(0, 0), window_px, packed(veil));
  list.AddRectFilled(at, end, packed(ui.theme.panel), ui.px(8));
  list.AddRect(at, end, packed(ui.theme.border), ui.px(8), 0, ui.px(1));
  list.PopClipRect();
  keep_item(fmt::format("area {}", id), at, end);
  return size;
}

void end_modal() {
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace gaitpad
