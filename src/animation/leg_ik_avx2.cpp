// Compiled for processors with AVX2 alone (base/lanes.h asks for them).
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs<4>(const RobustOptions&, LegLanes<4>&) noexcept;
template void solve_legs<2, 4>(const RobustOptions&, LegLanes<2>&) noexcept;
template void share_legs<2, 4>(SharedLegs<2>&) noexcept;

}  // namespace gaitpad
