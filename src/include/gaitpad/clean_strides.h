// From a gait cycle to the family of clean strides that a walk reads. This is done when a motion is
// loaded, and takes some tenths of a second.
//
//   const auto model = gaitpad::walk_model(
//       gaitpad::with_clean_strides(gaitpad::procedural_gait()), gaitpad::Character{});
#pragma once
#include "gaitpad/stride_family.h"

namespace gaitpad {

StrideFamily stride_family(const GaitCycle& cycle);
// The cycle with its `strides`.
GaitCycle with_clean_strides(GaitCycle cycle);

}  // namespace gaitpad
