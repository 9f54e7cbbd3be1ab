// A stick over its zones: where it is raw and calibrated, and where it has just been.
#pragma once
#include "view/ui_parts.h"

namespace gaitpad {

// A square with its upper left corner there.
void draw_stick_plane(Ui& ui, const ImVec2& min, float side_px, Side side,
                      const StickCalibration& calibration);

}  // namespace gaitpad
