// Compiled for every processor.
#include "animation/walk_lanes.h"

namespace gaitpad {

template void advance_lanes<2>(const WalkModel&, double, std::span<const Walking>) noexcept;

}  // namespace gaitpad
