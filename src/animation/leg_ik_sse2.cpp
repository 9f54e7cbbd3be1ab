// Compiled for every processor.
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template void solve_legs<2, false>(const std::array<LegToSolve*, 2>&) noexcept;
template void close_legs<2>(std::array<LegToClose, 2>&) noexcept;
template void solve_legs<2, true>(const std::array<LegToSolve*, 2>&) noexcept;

}  // namespace gaitpad
