// The joints of a cycle's poses as rows of numbers, for registers of any width: what sample_local()
// gives of these joints, bit for bit.
#pragma once
#include <span>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

// Which joints a table is to hold: all that move, but for those that `is_left_out`. What does not
// move is the identity.
PoseRows pose_rows(const GaitCycle& cycle, std::span<const bool> is_left_out);

}  // namespace gaitpad
