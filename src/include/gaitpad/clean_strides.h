// Computes the family of clean strides that a walk reads from a gait cycle. This runs when a motion
// is loaded, and takes some tenths of a second.
//
//   auto cycle = gaitpad::with_clean_strides(gaitpad::procedural_gait());
//   if (!cycle) return std::puts(cycle.error().message.c_str());
//   const auto model = gaitpad::walk_model(*cycle, gaitpad::Character{});
//
// Equal cycles give the same bits, with every compiler and at every level. Both functions only
// compute, on two threads where there are cores: nothing is read, written or kept. `gaitpad`
// itself keeps families in the user's cache.
#pragma once
#include "gaitpad/result.h"
#include "gaitpad/stride_family.h"

namespace gaitpad {

// Error `NAME: cause` for a cycle that is no walk: a number that is not finite, a leg without
// length, a stride longer than four legs, events out of order.
Result<StrideFamily> stride_family(const GaitCycle& cycle);
// Returns the cycle with its `strides`; errors as above.
Result<GaitCycle> with_clean_strides(GaitCycle cycle);

}  // namespace gaitpad
