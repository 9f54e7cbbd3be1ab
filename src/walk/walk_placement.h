// Reports a tick in the world (WalkState::placed).
#pragma once
#include "gaitpad/walk.h"

namespace gaitpad {

// Moves the results of a tick with the world.
void place_in_world(const Placement& by, WalkFrame& frame, vec3& root_m, quat& root) noexcept;

}  // namespace gaitpad
