// A calibrated stick position.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

struct Stick {  // unit disc, +x right, +y forward
  vec2 left{0.0};
  vec2 right{0.0};
};

}  // namespace gaitpad
