// A cycle with its clean strides, as a session loads it; read from the tests' own cache if it was
// solved before.
#pragma once
#include "files/stride_cache.h"
#include "tests/value_of.h"

namespace gaitpad {

inline GaitCycle clean_cycle(const GaitCycle& cycle) {
  return value_of(cached_clean_strides(cycle, stride_cache_folder()));
}

}  // namespace gaitpad
