// Foot flights of a walk: the frames in which a foot lifts, is highest and lands, found on the
// track of its ankle joint. Meredith & Maddock 2005, section 3.2 and figure 2, give a rule that
// takes any dip for a landing, so a robust rule is offered as well.
//
// These functions run when a motion is examined; they allocate. They find nothing in a motion that
// check() refuses or that has no legs.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "gaitpad/motion.h"

namespace gaitpad {

// A flight in frames, counted from 0 in the file; the functions below fill it. A swing over the end
// of a looping clip lifts inside the file and lands at a frame >= frames.size(). A loop's last
// frame is its first one again, so frame frames.size() - 1 + i is frame i, moved by the pelvis'
// travel over the clip.
struct Swing {
  // The heel begins to rise: last low of the ankle's height before the lift; 0 if that is before
  // the file.
  int heel_off = 0;
  int lift = 0;  // the toe begins to leave the place from which it pushes
  int peak = 0;  // the ankle is highest between lift and land
  int land = 0;  // the heel is down and still
};

// Robust rule: all swings of a foot that the motion contains completely, in time order, between the
// same events as those of a GaitCycle, to the nearest frame. A swing touches neither end of the
// file nor a jump (some files begin with a posture that does not belong to the motion). If a foot
// has no swing and the last pose is the first one again, the clip is treated as a loop.
std::vector<Swing> swings(const Motion& motion, Side side);

// The most typical of these swings: nearest to the foot's median duration and length. None if there
// is no swing.
std::optional<Swing> robust_flight(const Motion& motion, Side side);

// The paper's rule, followed literally, on the ankle's height: the first gradient change - to +
// within 10 % of the range of the lowest height, from there the first + to - within 10 % of the
// greatest, from there the first - to + within 10 % of the lowest. `heel_off` repeats `lift`. None
// if a target is not found.
std::optional<Swing> paper_flight(const Motion& motion, Side side);
// The paper's rule on a list of heights.
std::optional<Swing> paper_flight(const std::vector<double>& heights);

}  // namespace gaitpad
