// How far planted points slide.
#pragma once
#include "paper/walk_run.h"

namespace gaitpad {

// The greatest distance, mm, of a heel or toe from where it stood when its plant began, of all
// plants that begin at or after `from`.
double planted_slide_mm(const Walk& walk, std::size_t from = 0);

}  // namespace gaitpad
