#include "walk/tick.h"
#include "walk/walk.h"

namespace gaitpad::anew {

void advance(const Tables& tables, Block<1>& block, const Poses& poses) noexcept {
  advance_block<1>(tables, block, poses);
}
void advance(const Tables& tables, Block<4>& block, const Poses& poses) noexcept {
  advance_block<4>(tables, block, poses);
}

}  // namespace gaitpad::anew
