// The walk of a build, alone and in crowds: one source (tick.h) for 1, 4, 8 and 16 walks side by
// side, whose bits are the same. Each width is compiled for the instructions that hold it.
#pragma once
#include "walk/pose_places.h"
#include "walk/state.h"
#include "walk/tables.h"

namespace gaitpad::anew {

// Moves all walks of a block on by one tick.
void advance(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<4>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<8>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<16>& block, const Poses& poses) noexcept;

// The same with the paper's own solver (IkMode::paper).
void advance_by_paper(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;

// Sets up a walk that stands there, and faces that way.
void stand(const Tables& tables, const Origin& place, Block<1>& block) noexcept;

// Copies a walk from a lane of one block to a lane of another.
template <int kFrom, int kTo>
void copy_walk(const Block<kFrom>& from, int from_lane, Block<kTo>& to, int to_lane) noexcept {
  for (int n = 0; n < kStateNumbers<float>; ++n)
    reinterpret_cast<float*>(&to)[n * kTo + to_lane] =
        reinterpret_cast<const float*>(&from)[n * kFrom + from_lane];
  to.origin[to_lane] = from.origin[from_lane];
}

}  // namespace gaitpad::anew
