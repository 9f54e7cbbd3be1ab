// Reports a tick (WalkFrame) from the walk's state and pose. Blocks report only on request.
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

// Fills a frame, except WalkFrame::bad_inputs. `before`: root before the tick.
void report(const WalkModel& model, const Tables& tables, const Block<1>& block,
            const Placement& before, const Placement& root, const vec3& root_m,
            std::span<const quat> local, WalkFrame& frame) noexcept;

}  // namespace gaitpad
