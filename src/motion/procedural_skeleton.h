// The embedded adult: bones in Drillis and Contini's fractions of the stature, arms hanging.
#pragma once
#include "motion/gait_cycle.h"

namespace gaitpad {

// Skeleton and leg models; every joint's standing rotation is identity.
GaitCycle procedural_body();

}  // namespace gaitpad
