// The contents of the panels, drawn below their headings over the width of the column.
#pragma once
#include "view/widgets.h"

namespace gaitpad {

void draw_pad_panel(Ui& ui);
void draw_control_panel(Ui& ui);
void draw_style_panel(Ui& ui);
void draw_graphs_panel(Ui& ui);
void draw_solver_panel(Ui& ui);
void draw_loop_panel(Ui& ui);

}  // namespace gaitpad
