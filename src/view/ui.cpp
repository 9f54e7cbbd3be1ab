#include "view/ui.h"

#include <algorithm>

#include "view/ui_bars.h"

namespace gaitpad {
namespace {

void keep_sound(const UiInput& input, UiState& state) {
  if (input.frame.walker_count > 0 && state.walker >= input.frame.walker_count) state.walker = -1;
  if (state.walker < -1) state.walker = -1;
}

}  // namespace

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
  draw_messages(ui, layout.scene);
  if (state.is_help_open) {
    draw_help(ui, {0.0f, layout.top.height, size.x, size.y - layout.top.height});
  }
  return out;
}

}  // namespace gaitpad
