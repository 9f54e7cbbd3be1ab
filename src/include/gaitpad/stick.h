// The position of a pad's two sticks, calibrated. A game fills it from any source.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

// Both sticks; the caller fills them. Each is in the unit disc: x to the right, y forward (away
// from the player), both -1 .. 1 and 0 at rest. The walk reads `left` only; gait_params() says what
// it does with numbers that are not finite (gaitpad/control.h).
struct Stick {
  vec2 left{0.0};
  vec2 right{0.0};
};

}  // namespace gaitpad
