// From a gait cycle to the family of clean strides that a walk reads. This is done when a motion is
// loaded, and takes some tenths of a second.
#pragma once
#include "gaitpad/stride_family.h"

namespace gaitpad {

StrideFamily stride_family(const GaitCycle& cycle);

}  // namespace gaitpad
