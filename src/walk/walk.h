// The walk of a build, alone and in crowds: one source (tick.h) for 1, 4, 8 and 16 walks side by
// side, whose bits are the same. Each width is compiled for the instructions that hold it.
#pragma once
#include "walk/block.h"
#include "walk/pose_places.h"
#include "walk/tables.h"

namespace gaitpad {

// Moves all walks of a block on by one tick.
void advance(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<4>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<8>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<16>& block, const Poses& poses) noexcept;

// The same with the paper's own solver (IkMode::paper).
void advance_by_paper(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;

// Sets up a walk that stands there, and faces that way; on uneven ground where its soles have room.
void stand(const Tables& tables, const Origin& place, Block<1>& block) noexcept;

// Moves a walk with all that it stands on: a teleport, a platform, a world that is shifted. In its
// own coordinates nothing changes; a ground that is asked for by place in the world is not moved.
template <int kWidth>
void move_walk(const Placement& by, int walk, Block<kWidth>& block) noexcept {
  block.placed[walk] = moved(by, block.placed[walk]);
  block.is_placed = true;
}

}  // namespace gaitpad
