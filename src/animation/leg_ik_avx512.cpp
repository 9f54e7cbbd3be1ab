// Compiled for processors with AVX-512 alone (base/lanes.h asks for them).
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs(const RobustOptions&, LegLanes<8>&) noexcept;

}  // namespace gaitpad
