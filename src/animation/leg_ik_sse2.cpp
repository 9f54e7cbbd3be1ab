// Compiled for every processor.
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs<kLeastLanes, false>(const std::array<LegToSolve*, kLeastLanes>&) noexcept;
template void close_legs<kLeastLanes>(std::array<LegToClose, 2>&) noexcept;
template void solve_legs<kLeastLanes, true>(const std::array<LegToSolve*, kLeastLanes>&) noexcept;

}  // namespace gaitpad
