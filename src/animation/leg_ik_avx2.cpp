// Compiled for processors with AVX2 only (base/lanes.h asks for them).
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

#ifndef GAITPAD_NO_VECTORS
template void solve_legs<4, false>(const std::array<LegToSolve*, 4>&) noexcept;
template void solve_legs<2, false, 4>(const std::array<LegToSolve*, 2>&) noexcept;
template void close_legs<4>(std::array<LegToClose, 2>&) noexcept;
template void solve_legs<2, true, 4>(const std::array<LegToSolve*, 2>&) noexcept;
#endif

}  // namespace gaitpad
