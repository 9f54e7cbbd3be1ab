// Where in the window everything flat lies: bars above and below, a column of panels on either side
// of the scene, in a narrow window one column for all, in a very narrow one none.
#pragma once
#include <imgui.h>

#include "view/ui.h"

namespace gaitpad {

struct UiRect {  // pixels; empty: not shown
  float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
  bool is_empty() const noexcept { return !(width > 0.0f && height > 0.0f); }
  ImVec2 min() const noexcept { return {x, y}; }
  ImVec2 max() const noexcept { return {x + width, y + height}; }
};
struct UiLayout {
  UiRect top, left, right, timeline, status, scene;
};
UiLayout ui_layout(const UiState& state, bool has_timeline, int width_px, int height_px,
                   double scale) noexcept;
// Of the two columns, where both are shown.
bool is_left(Panel panel) noexcept;

}  // namespace gaitpad
