// A gamepad of two 16-bit axes, for the claims that begin at the joystick.
#pragma once
#include "gaitpad/simulation.h"

namespace gaitpad {

// With the calibration of an unknown stick (inner zone 0.2, outer 0.95).
PadConfig paper_pad();
// Raw -1..1, +x right, +y forward.
Report paper_report(const vec2& raw);
Report paper_unplug();
// That pad, one character a style, on this motion.
SimulationConfig paper_session(const GaitCycle& cycle, const std::vector<Style>& styles, IkMode ik);

}  // namespace gaitpad
