// What a game takes out of a walk: the events of a tick, the joints that it wants, and the pose in
// floats, in its own memory and joint order.
//
//   const WalkFrame before = state.frame;
//   advance(model, params, IkMode::robust, 1.0 / 60.0, state, pose);
//   for (const WalkEvent& event : walk_events(before, state)) play_sound(event.place_m);
//   mix_pose(legs_and_pelvis_weights, pose, game_pose);
//   write_matrices(model.cycle.skeleton, game_pose, Placement{}, joints, matrices);
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "gaitpad/skeleton.h"
#include "gaitpad/walk.h"
#include "gaitpad/walk_model.h"

namespace gaitpad {

// step_begin: the other foot has landed or a stand ends, and this foot is the next to fly.
// toe_off: its toe leaves the ground. heel_strike: its heel lands.
enum class WalkEventKind : std::uint8_t { step_begin, toe_off, heel_strike };

// walk_events() fills it.
struct WalkEvent {
  WalkEventKind kind = WalkEventKind::heel_strike;
  Side side = kLeftSide;
  vec3 place_m{0.0};  // world: where the heel is or was planted; toe_off: the toe
};

// In their order in time. A tick of at most kMostTick_s has each event of a foot once at most.
struct WalkEvents {
  std::array<WalkEvent, 6> event;
  int count = 0;
  const WalkEvent* begin() const noexcept { return event.data(); }
  const WalkEvent* end() const noexcept { return event.data() + count; }
};

// What has happened since `before`, the frame of one tick earlier. A move of the walk in between is
// no event.
WalkEvents walk_events(const WalkFrame& before, const WalkState& state) noexcept;

// By joint of the model's skeleton: 1 for the legs, the pelvis and what it hangs on; else 0, so
// that a game's own trunk, arms and head stay as they are, in the frame of the pelvis.
std::vector<float> legs_and_pelvis(const WalkModel& model);

// Brings each joint of `own`, a pose of the same skeleton, to the walk's by its weight: 0 leaves
// its rotation, 1 makes it the walk's, both to the bit; between them lies the shorter way round.
// Weights beyond are clamped, one that is not a number counts as 0. The root's place goes by its
// weight, too. Joints beyond the shortest of the three stay.
void mix_pose(std::span<const float> weights, const Pose& walk, Pose& own) noexcept;

// Both write one entry a bone of the caller's: of joint `joints[i]`, or nothing where that is no
// joint of the pose. They write as many bones as `out` has room for, and return how many entries
// they considered. What stands in the world is seen from `model`, where the caller's object lies:
// {state.frame.root_m, state.frame.heading_rad} for an object that is moved by root motion, {} for
// the world. Where that is not finite nothing is written, and 0 returned.

// Local rotations, 4 floats each: x, y, z, w. The root's turns into the frame of `model`; its place
// there goes to `root_m`.
int write_rotations(const Pose& pose, const Placement& model, std::span<const int> joints,
                    std::span<float> out, std::array<float, 3>& root_m) noexcept;

// Rotation and place in the frame of `model`, 16 floats each: a matrix, column by column.
int write_matrices(const Skeleton& skeleton, const Pose& pose, const Placement& model,
                   std::span<const int> joints, std::span<float> out) noexcept;

}  // namespace gaitpad
