// The joints of a cycle's poses as rows of numbers for vector registers of any width. Results are
// bit-identical to sample_local().
#pragma once
#include <span>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// Rows of all joints that move, except those with `is_left_out`. Joints that stay at the identity
// are listed in `still`.
PoseRows pose_rows(const GaitCycle& cycle, std::span<const bool> is_left_out);

}  // namespace gaitpad
