// Compiled for processors with AVX2 only (base/lanes.h asks for them).
#include "animation/walk_lanes.h"

namespace gaitpad {

#ifndef GAITPAD_NO_VECTORS
template void advance_lanes<4>(const WalkModel&, double, std::span<const Walking>) noexcept;
#endif

}  // namespace gaitpad
