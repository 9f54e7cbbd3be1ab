// Memory for the poses of a block's walks.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

struct Poses {
  quat* const* local = nullptr;  // of each walk: rotations by joint
  vec3* const* root_m = nullptr;
  int walks = 0;  // of the block; lanes after them are not written
};

}  // namespace gaitpad
