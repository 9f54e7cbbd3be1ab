// Compiled for every processor.
#include "animation/walk_lanes.h"

namespace gaitpad {

#ifndef GAITPAD_NO_VECTORS
template void advance_lanes<2>(const WalkModel&, double, std::span<const Walking>) noexcept;
#endif

}  // namespace gaitpad
