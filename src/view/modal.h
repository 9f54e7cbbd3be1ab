// A box in the middle of the window, over everything else, which is veiled.
#pragma once
#include "view/ui_parts.h"

namespace gaitpad {

// Its size at scale 1, at most that of the window. To be followed by end_modal(), whatever is
// drawn. `id` also names it in ui_items(): "area ID". The box's size in pixels.
ImVec2 begin_modal(Ui& ui, const char* id, double width, double height, const ImVec2& window_px);
void end_modal();

}  // namespace gaitpad
