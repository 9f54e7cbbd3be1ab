#include "view/pad_dialog.h"

#include <imgui.h>

namespace gaitpad {

void draw_step(Ui& ui, std::string_view title, std::string_view who, std::string_view request) {
  text_line(ui, ui.fonts.title, ui.theme.text, title);
  if (!who.empty()) text_line(ui, ui.fonts.small, ui.theme.secondary, who);
  ImGui::Dummy(ImVec2(0.0f, ui.px(6)));
  ImGui::PushFont(ui.fonts.body);
  ImGui::PushTextWrapPos(0.0f);
  ImGui::TextUnformatted(request.data(), request.data() + request.size());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::Dummy(ImVec2(0.0f, ui.px(8)));
}

void go_to_buttons(float height_px) {
  ImGui::SetCursorPosY(height_px - ImGui::GetFrameHeight() - ImGui::GetStyle().WindowPadding.y);
}

bool key_button(Ui& ui, std::string_view id, std::string_view label, SDL_Keycode key,
                const ButtonLook& look) {
  return button(ui, id, label, look) || is_typed(ui, key);
}

}  // namespace gaitpad
