// The callers' memory for the poses of a block's walks.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

struct Poses {
  quat* const* local;   // for each walk, its joints' rotations
  vec3* const* root_m;  // for each walk, its root's place
  int walks;            // lanes of the block from this number on are not written
};

}  // namespace gaitpad
