#include "view/ui.h"

#include <algorithm>

#include "view/ui_bars.h"

namespace gaitpad {
namespace {

// The next one after whom panels tell of; behind the last one all.
void choose_next(UiState& state, int walker_count) {
  state.walker = state.walker + 1 < walker_count ? state.walker + 1 : -1;
}

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

bool obey(Action action, int walker_count, UiState& state) noexcept {
  if (action >= Action::panel_pad && action <= Action::panel_loop) {
    const auto panel =
        static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::panel_pad);
    state.is_open[panel] = !state.is_open[panel];
    return true;
  }
  switch (action) {
    case Action::next_walker:
      choose_next(state, walker_count);
      return true;
    case Action::theme:
      state.theme = state.theme == ThemeName::dark ? ThemeName::light : ThemeName::dark;
      return true;
    case Action::trails:
      state.has_trails = !state.has_trails;
      return true;
    case Action::source:
      state.has_source = !state.has_source;
      return true;
    case Action::help:
      state.is_help_open = !state.is_help_open;
      return true;
    case Action::back:
      if (!state.is_help_open) return false;
      state.is_help_open = false;
      return true;
    default:
      return false;
  }
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
