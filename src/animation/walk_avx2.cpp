// Compiled for processors with AVX2 only (base/lanes.h asks for them).
#include "animation/walk_lanes.h"

namespace gaitpad {

template void advance_lanes<4>(const WalkModel&, double, std::span<const Walking>) noexcept;

}  // namespace gaitpad
