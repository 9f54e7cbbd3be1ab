// What a tick did, read from a block and the pose where somebody asks for it: no tick pays for it.
#pragma once
#include "walk/state.h"
#include "walk/tables.h"

namespace gaitpad::anew {

// The frame of a walk's last tick, and what is kept from one report to the next. Reports of all
// ticks count all steps; what has happened between two of them is theirs together.
struct Report {
  WalkFrame frame;
  Placement root;  // in the walk's own coordinates: the hips' place on the ground and the heading
  int step_ticks = 0, last_step_ticks = 0;  // of the running step and of the one before it
  bool overhangs = false, has_root = false;
};
void report(const WalkModel& model, const Tables& tables, const Block<1>& block, const Pose& pose,
            Report& report) noexcept;
template <int kWidth>
void report(const WalkModel& model, const Tables& tables, const Block<kWidth>& block, int walk,
            const Pose& pose, Report& of) noexcept {
  Block<1> one;
  copy_walk(block, walk, one, 0);
  report(model, tables, one, pose, of);
}

}  // namespace gaitpad::anew
