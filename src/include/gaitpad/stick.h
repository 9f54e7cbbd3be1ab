// The position of a pad's two sticks, calibrated. A game fills it from any source.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

// Each stick is in the unit disc: x to the right, y forward (away from the player), 0 at rest. The
// walk reads `left` alone.
struct Stick {
  vec2 left{0.0};
  vec2 right{0.0};
};

}  // namespace gaitpad
