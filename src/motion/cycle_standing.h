// The standing pose of a captured skeleton, built from how it walks, and its legs' angles from
// there.
#pragma once
#include "motion/cycle_captured.h"

namespace gaitpad {

// Fills skeleton, pelvis_standing, leg models and standing_local of `out`. Joints between pelvis
// and hip, hip and knee, knee and ankle, ankle and toe are held at their mean rotation from here
// on. `floor_m` is the floor's height in `captured`. Error, without file name, where there is no
// leg.
Result<double> build_standing(const CapturedCycle& captured, GaitCycle& out);

// Fills samples and local: the legs put the model's ankles and feet where the captured ones are.
void build_samples(const CapturedCycle& captured, double floor_m, GaitCycle& out);

}  // namespace gaitpad
