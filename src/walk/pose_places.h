// Where the poses of a block's walks go.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

struct Poses {
  quat* const* local;  // of each walk, by joint
  vec3* const* root_m;
  int walks;  // of the block; the lanes after them are not written
};

}  // namespace gaitpad
