// The output of a walk for a game: the events of a tick, the joints that it wants, and the pose in
// floats, in its own memory and joint order.
//
//   const WalkSteps before = walk_steps(state);
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

// step_begin: the other foot has landed or a stand ends, and this foot will fly next. toe_off: the
// toe of this foot leaves the ground. heel_strike: its heel lands.
enum class WalkEventKind : std::uint8_t { step_begin, toe_off, heel_strike };

// An event of a foot; walk_events() fills it.
struct WalkEvent {
  WalkEventKind kind = WalkEventKind::heel_strike;
  Side side = kLeftSide;
  // Place in the world where the heel is or was planted; for toe_off: that of the toe.
  vec3 place_m{0.0};
};

// The events in their order in time. A tick of at most kMostTick_s has each event of a foot at most
// once.
struct WalkEvents {
  std::array<WalkEvent, 6> event;
  int count = 0;
  const WalkEvent* begin() const noexcept { return event.data(); }
  const WalkEvent* end() const noexcept { return event.data() + count; }
};

// The events since `before`, the steps of one tick earlier. A move of the walk in between is no
// event.
WalkEvents walk_events(const WalkSteps& before, const WalkState& state) noexcept;

// Weights for mix_pose(), one for each joint of the model's skeleton: 1 for the legs, the pelvis
// and the joints that carry it; else 0, so that a game's own trunk, arms and head stay as they are,
// in the frame of the pelvis.
std::vector<float> legs_and_pelvis(const WalkModel& model);

// Mixes each joint of `own`, a pose of the same skeleton, with the walk's by its weight: 0 keeps
// its rotation, 1 makes it the walk's, both to the bit; other weights follow the shorter arc.
// Weights outside are clamped, a weight that is not a number counts as 0. The root's place follows
// the root's weight. Joints beyond the shortest of the three lists stay.
void mix_pose(std::span<const float> weights, const Pose& walk, Pose& own) noexcept;

// The pose at `share` of the way from one tick's pose to the next tick's, for a game that draws
// more often than its walks tick. Joints are blended along the shorter arc, the pelvis goes
// straight, and both legs are then ended at their feet: a heel or toe that stands in both poses
// stays where it stands, a flying foot goes straight from place to place. Shares outside 0 to 1
// count as 0 and 1, which give the two poses to the bit. Returns false and writes nothing if the
// share is not a number or a pose does not have the model's joints. `pose` may be one of the two.
// No heap. A teleport in between is drawn by moving `from` as well, or by share 1.
bool pose_between(const WalkModel& model, const Pose& from, const Pose& to, double share,
                  Pose& pose) noexcept;

// Both functions below write one entry for each of the caller's bones: that of joint `joints[i]`,
// or nothing if there is no such joint in the pose. They write as many bones as `out` has room for,
// and return the number of entries that they considered. Places in the world are converted to the
// frame of `model`, the caller's object: moved(state.placed, state.root) for an object that is
// moved by root motion, {} for the world. If that is not finite nothing is written,
// and 0 returned.

// Writes local rotations, 4 floats each: x, y, z, w. The root's turns into the frame of `model`;
// its place in that frame goes to `root_m`.
int write_rotations(const Pose& pose, const Placement& model, std::span<const int> joints,
                    std::span<float> out, std::array<float, 3>& root_m) noexcept;

// Writes rotation and place in the frame of `model`, 16 floats each: a matrix, column by column.
int write_matrices(const Skeleton& skeleton, const Pose& pose, const Placement& model,
                   std::span<const int> joints, std::span<float> out) noexcept;

}  // namespace gaitpad
