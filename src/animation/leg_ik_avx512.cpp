// Compiled for processors with AVX-512 alone (base/lanes.h asks for them).
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs<8>(const RobustOptions&, LegLanes<8>&) noexcept;
template void solve_legs<2, 8>(const RobustOptions&, LegLanes<2>&) noexcept;
template void share_legs<2, 8>(SharedLegs<2>&) noexcept;

}  // namespace gaitpad
