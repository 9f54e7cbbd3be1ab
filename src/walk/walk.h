// The walk of a build, alone and in crowds: one source (tick.h) for 1, 4, 8 and 16 walks side by
// side, whose bits are the same. Each width is compiled for the instructions that hold it.
#pragma once
#include <cstdint>

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

// Asks a walk to land the foot that swings there, in the world: as near as its leg can step, or not
// at all where that is not the very place. On uneven ground a landing keeps off edges as ever.
// Refused where no step runs, or where the landing is settled.
enum class Aim : std::uint8_t { taken, nearest, refused };
Aim step_to(const Tables& tables, const Placement& place, bool nearest, Block<1>& block) noexcept;

// Pushes a walk: its hips have this velocity more, in the world, and come back to their path; the
// next landing that is not settled is as far aside as catches them. False, and nothing happens, of
// a walk that stands, or less than 0.2 s before a strike.
bool push(const Tables& tables, const vec3& velocity_m_s, Block<1>& block) noexcept;

// Moves a walk with all that it stands on: a teleport, a platform, a world that is shifted. In its
// own coordinates nothing changes; a ground that is asked for by place in the world is not moved.
template <int kWidth>
void move_walk(const Placement& by, int walk, Block<kWidth>& block) noexcept {
  block.placed[walk] = moved(by, block.placed[walk]);
  block.is_placed = true;
}

}  // namespace gaitpad
