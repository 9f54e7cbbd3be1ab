// The position of a pad's two sticks, calibrated. A game fills it from any source.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

// The caller fills it. Each stick is in the unit disc: x to the right, y forward (away from the
// player), both -1 .. 1 and 0 at rest. The walk reads `left` alone; gait_params() says what becomes
// of numbers that are none (gaitpad/control.h).
struct Stick {
  vec2 left{0.0};
  vec2 right{0.0};
};

}  // namespace gaitpad
