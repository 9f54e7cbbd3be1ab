// Foot flights of a walk: the frames in which a foot lifts, is highest and lands, found on the
// track of its ankle joint. Meredith & Maddock 2005, section 3.2 and figure 2, give the literal
// rule; it takes any dip for a landing, so a robust rule stands beside it.
//
// These functions run when a motion is examined; they allocate. They find nothing in a motion that
// check() refuses or that has no legs.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "gaitpad/motion.h"

namespace gaitpad {

// Filled by the functions below. Frames count from 0 in the file. A swing over the end of a looping
// clip lifts inside the file and lands at a frame >= frames.size(). A loop's last frame is its
// first one again, so frame frames.size() - 1 + i is frame i, moved on by the pelvis' travel over
// the clip.
struct Swing {
  int heel_off = 0;  // last low of the ankle's height before the lift: the heel begins to rise;
                     // 0 where the file begins later
  int lift = 0;      // the toe begins to leave the place from which it pushes
  int peak = 0;      // ankle highest between lift and land
  int land = 0;      // the heel is down and still
};

// Robust rule: all swings of a foot that the motion holds whole, in time order, between the same
// events as those of a GaitCycle, to the nearest frame. A swing touches neither end of the file nor
// a jump (some files begin with a posture that has nothing to do with the motion). Where a foot has
// no swing and the last pose is the first one again, the clip is taken as a loop.
std::vector<Swing> swings(const Motion& motion, Side side);

// The most typical one of these: nearest to the foot's median duration and length. None where there
// is no swing.
std::optional<Swing> robust_flight(const Motion& motion, Side side);

// The paper's rule to the letter on the ankle's height: the first gradient change - to + within 10
// % of the range of the lowest height, from there the first + to - within 10 % of the greatest,
// from there the first - to + within 10 % of the lowest. `heel_off` repeats `lift`. None where a
// target is not found.
std::optional<Swing> paper_flight(const Motion& motion, Side side);
// The same on bare heights.
std::optional<Swing> paper_flight(const std::vector<double>& heights);

}  // namespace gaitpad
