// Ticks of walks, alone and in crowds: one source (tick.h) for 1, 4, 8 and 16 walks side by side,
// with the same bits. Each width is compiled for the instructions that have such registers.
#pragma once
#include "gaitpad/walk.h"
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// Moves all walks of a block on by one tick.
void advance(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<4>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<8>& block, const Poses& poses) noexcept;
void advance(const Tables& tables, Block<16>& block, const Poses& poses) noexcept;

// The same of one walk, by wider registers' instructions. advance() chooses by lanes_in_use().
void advance_by_avx2(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;
void advance_by_avx512(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;

// The same with the paper's own solver (IkMode::paper), and with either.
void advance_by_paper(const Tables& tables, Block<1>& block, const Poses& poses) noexcept;
inline void advance(const Tables& tables, IkMode mode, Block<1>& block,
                    const Poses& poses) noexcept {
  mode == IkMode::paper ? advance_by_paper(tables, block, poses) : advance(tables, block, poses);
}

// Takes a part of a push (push_walk() of gaitpad/walk.h). The landing of the first step that can
// still be changed moves, so that its foot catches the push; from then on the hips take it over
// some ticks. A walk that stands or comes to rest drops it.
void take_push(const Tables& tables, Block<1>& block) noexcept;

// Sets up a standing walk with its hips at `place`. On uneven ground each foot goes to the nearest
// place that has room for its sole.
void stand(const Tables& tables, const Origin& place, Block<1>& block) noexcept;

}  // namespace gaitpad
