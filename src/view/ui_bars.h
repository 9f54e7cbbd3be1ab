// The bars and layers of the flat picture, each into the rectangle that the layout gives it.
#pragma once
#include "view/ui_layout.h"
#include "view/ui_parts.h"

namespace gaitpad {

// A window that stays where it is; `padding` at scale 1.
void begin_area(Ui& ui, const char* id, const UiRect& rect, const Colour& back,
                const ImVec2& padding, ImGuiWindowFlags flags = 0);
void end_area();

void draw_top_bar(Ui& ui, const UiRect& rect);
void draw_timeline(Ui& ui, const UiRect& rect);
void draw_status(Ui& ui, const UiRect& rect);
void draw_messages(Ui& ui, const UiRect& scene);
void draw_labels(Ui& ui, const UiRect& scene);
void draw_help(Ui& ui, const UiRect& room);  // over everything in there
void draw_columns(Ui& ui, const UiLayout& layout);

}  // namespace gaitpad
