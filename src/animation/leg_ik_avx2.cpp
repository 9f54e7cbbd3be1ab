// Compiled for processors with AVX2 alone (widest_lanes() in base/lanes.h).
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs(const RobustOptions&, LegLanes<4>&) noexcept;

}  // namespace gaitpad
