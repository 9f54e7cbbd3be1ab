// The part of a tick that takes a push (push_walk() of gaitpad/walk.h).
#pragma once
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// Takes a part of a push. The landing of the first step that can still be changed moves, so that
// its foot catches the push; from then on the hips take it over some ticks. A walk that stands or
// comes to rest drops it.
void take_push(const Tables& tables, Block<1>& block) noexcept;

}  // namespace gaitpad
