// A walk on another skeleton with two legs: retargeting by the leg-length ratio.
#pragma once
#include "motion/gait_cycle.h"

namespace gaitpad {

// `source` as the skeleton of `character` walks it. How that one stands is measured on its own walk
// where it has one, else on the frame of its file in which it stands straightest. Leg angles and
// foot rotations are taken over, lengths grow by the ratio of the legs; spine, neck, head and arms
// follow their counterparts whatever they are called (cycle_upper_body.h). Error: `NAME: cause`.
Result<GaitCycle> cycle_on_skeleton(const GaitCycle& source, const Motion& character);

// Thigh + shank, the mean of both legs.
double mean_leg_m(const GaitCycle& cycle) noexcept;

}  // namespace gaitpad
