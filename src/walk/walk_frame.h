// Reports a tick (WalkFrame) from the walk's state and pose.
#pragma once
#include <span>

#include "gaitpad/walk.h"
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// In the walk's own coordinates: the hips' place on the ground, without the tables' oscillation,
// and the heading.
Placement root_of(const Block<1>& block) noexcept;
template <int kWidth>
Placement root_of(const Block<kWidth>& block, int walk) noexcept {
  Block<1> one;
  copy_walk(block, walk, one, 0);
  return root_of(one);
}

// Phase of the data that the pose shows.
float phase_of(const Block<1>& block) noexcept;

// walk_frame() of a pose that is not in a Pose.
WalkFrame frame_of(const WalkModel& model, const WalkState& state, const vec3& root_m,
                   std::span<const quat> local) noexcept;

}  // namespace gaitpad
