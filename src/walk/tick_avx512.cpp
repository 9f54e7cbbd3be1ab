#include "walk/tick.h"
#include "walk/walk.h"

#ifndef GAITPAD_NO_VECTORS
namespace gaitpad {

void advance(const Tables& tables, Block<16>& block, const Poses& poses) noexcept {
  advance_block<16>(tables, block, poses);
}

}  // namespace gaitpad
#endif
