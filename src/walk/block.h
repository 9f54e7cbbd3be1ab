// What a tick changes of a block of walks: its poses and its numbers, which lie one after the
// other.
#pragma once
#include <type_traits>

#include "gaitpad/walk_state.h"
#include "walk/lanes.h"

namespace gaitpad {

// Memory for the poses of a block's walks.
struct Poses {
  quat* const* local = nullptr;  // of each walk: rotations by joint
  vec3* const* root_m = nullptr;
  int walks = 0;  // of the block; lanes after them are not written
};

// Stands for Footing on level ground, which is compiled without it.
struct NoFooting {};
template <class F>
inline constexpr bool kIsUneven = !std::is_same_v<F, NoFooting>;

template <class V>
inline constexpr int kStateNumbers = (sizeof(State<V>) + sizeof(Change<V>) + sizeof(Weighted<V>) +
                                      sizeof(Styled<V>) + sizeof(Footing<V>) + sizeof(Poise<V>) +
                                      sizeof(Told<V>)) /
                                     sizeof(V);
static_assert(sizeof(State<float>) <= 512);

// Functions are local to each source, because those for wider registers must not share one: the
// linker would keep one of them for all, which an old processor may not know.
namespace {

// Copies a walk from a lane of one block to a lane of another.
template <int kFrom, int kTo>
void copy_walk(const Block<kFrom>& from, int from_lane, Block<kTo>& to, int to_lane) noexcept {
  for (int n = 0; n < kStateNumbers<float>; ++n)
    reinterpret_cast<float*>(&to)[n * kTo + to_lane] =
        reinterpret_cast<const float*>(&from)[n * kFrom + from_lane];
  to.origin[to_lane] = from.origin[from_lane];
  to.placed[to_lane] = from.placed[from_lane];
  to.is_placed |= from.is_placed;
  to.piece[to_lane] = from.piece[from_lane];
}

}  // namespace
}  // namespace gaitpad
