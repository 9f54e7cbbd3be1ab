// What a program asks of a walk beside its stick (gaitpad/walk.h), as a tick takes it.
#pragma once
#include "walk/block.h"
#include "walk/tables.h"

namespace gaitpad {

// Where a push is not taken yet: its step catches it as soon as it can still be changed, and from
// then on the hips take it over some ticks. It is gone where a walk stands or comes to rest.
void take_push(const Tables& tables, Block<1>& block) noexcept;

}  // namespace gaitpad
