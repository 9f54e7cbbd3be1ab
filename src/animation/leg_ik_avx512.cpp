// Compiled for processors with AVX-512 only (base/lanes.h asks for them).
#include "animation/leg_ik_lanes.h"

namespace gaitpad {

#ifndef GAITPAD_NO_VECTORS
template void solve_legs<8, false>(const std::array<LegToSolve*, 8>&) noexcept;
template void solve_legs<2, false, 8>(const std::array<LegToSolve*, 2>&) noexcept;
template void close_legs<8>(std::array<LegToClose, 2>&) noexcept;
template void solve_legs<2, true, 8>(const std::array<LegToSolve*, 2>&) noexcept;
#endif

}  // namespace gaitpad
