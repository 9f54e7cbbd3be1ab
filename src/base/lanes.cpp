#include "base/lanes.h"

namespace gaitpad {

int widest_lanes() noexcept {
#ifdef GAITPAD_WIDE_LANES
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return 8;
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return 2;
}

}  // namespace gaitpad
