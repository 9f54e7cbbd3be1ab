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
    return 16;
  if (__builtin_cpu_supports("avx2")) return 8;
#endif
  return kLeastLanes;
}

int lanes_in_use() noexcept {
  const int lanes = g_lanes.load(std::memory_order_relaxed);
  if (lanes != 0) return lanes;
  use_lanes(16);
  return g_lanes.load(std::memory_order_relaxed);
}

void use_lanes(int lanes) noexcept {
  const int most = std::min(lanes, widest_lanes());
  g_lanes.store(*std::find_if(kLaneCounts.begin(), kLaneCounts.end() - 1,
                              [most](int count) { return count <= most; }),
                std::memory_order_relaxed);
}

}  // namespace gaitpad
