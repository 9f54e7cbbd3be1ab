#include "walk/tick.h"
#include "walk/walk.h"

#ifndef GAITPAD_NO_VECTORS
namespace gaitpad {

void advance(const Tables& tables, Block<8>& block, const Poses& poses) noexcept {
  advance_block<8>(tables, block, poses);
}
void advance_by_avx2(const Tables& tables, Block<1>& block, const Poses& poses) noexcept {
  advance_block<1>(tables, block, poses);
}

}  // namespace gaitpad
#endif
