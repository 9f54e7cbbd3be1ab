#include "base/lanes.h"

#include <algorithm>
#include <atomic>

namespace gaitpad {
namespace {

std::atomic<int> g_lanes = 0;  // lanes in use; 0: not determined yet

}  // namespace

int widest_lanes() noexcept {
#if defined(GAITPAD_WIDE_LANES) && !defined(GAITPAD_NO_VECTORS)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return 8;
  if (__builtin_cpu_supports("avx2")) return 4;
#endif
  return kLeastLanes;
}

int lanes_in_use() noexcept {
  const int lanes = g_lanes.load(std::memory_order_relaxed);
  if (lanes != 0) return lanes;
  use_lanes(8);
  return g_lanes.load(std::memory_order_relaxed);
}

void use_lanes(int lanes) noexcept {
  g_lanes.store(std::clamp(lanes, 1, widest_lanes()), std::memory_order_relaxed);
}

}  // namespace gaitpad
