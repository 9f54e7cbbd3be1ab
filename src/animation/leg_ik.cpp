#include "animation/leg_ik.h"

#include "animation/leg_ik_lanes.h"

namespace gaitpad {

template LegSolution<Lanes<2>> solve_legs(const LegGoals<Lanes<2>>&, const RobustOptions&,
                                          std::array<Lanes<2>, kLegDofs>&) noexcept;

}  // namespace gaitpad
