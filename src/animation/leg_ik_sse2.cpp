// Compiled for every processor.
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs<2>(const RobustOptions&, LegLanes<2>&) noexcept;
template void share_legs<2>(SharedLegs<2>&) noexcept;

}  // namespace gaitpad
