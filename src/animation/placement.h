// Reports a tick in the world (WalkState::placed), and its root motion.
#pragma once
#include "gaitpad/walk.h"

namespace gaitpad {

// Converts the results of a tick from the walk's own coordinates to the world.
void place_in_world(const Placement& placed, WalkFrame& frame, vec3& root_m, quat& root) noexcept;

struct RootBefore {
  vec3 hips_m{0.0};
  double heading_rad = 0.0;
};
inline RootBefore root_of(const WalkState& state) noexcept {
  return {state.path.hips_m, state.path.heading_rad};
}
// Reports the root's motion since `before`, in the walk's own coordinates.
void report_root(const RootBefore& before, WalkState& state) noexcept;

}  // namespace gaitpad
