// Foot flights of a walk: when each foot lifts, is highest and lands. Frames are of the ankle
// joint. Meredith & Maddock 2005, section 3.2 and figure 2 (the literal rule); the robust rule is
// ours.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "gaitpad/motion.h"

namespace gaitpad {

// Frames count from 0 in the file. A swing over the end of a looping clip has frames >=
// frames.size(); it always lifts inside the file. A loop's last frame is its first one again, so
// frame frames.size() - 1 + i is frame i, the pelvis' travel over the clip further on.
struct Swing {
  int heel_off = 0;  // last low of the ankle's height before the lift: the heel begins to rise;
                     // 0 where the file begins later
  int lift = 0;      // horizontal speed rises through a fifth of the swing's greatest
  int peak = 0;      // ankle highest between lift and land
  int land = 0;      // horizontal speed has fallen through the same fifth
};

// Robust rule: all swings of a foot that the motion holds whole, in time order. A swing is a run of
// frames in which the ankle moves horizontally at 0.3 of its usual fast speed or more, for 0.15
// to 1.8 s and over 0.25 to 2.6 leg lengths; it touches neither end of the file nor a jump (a
// posture in front that has nothing to do with the motion ends in one). Where a foot has none and
// the last pose is the first one again, the clip is taken as a loop.
std::vector<Swing> swings(const Motion& motion, Side side);

// Of these the most typical one: nearest to the foot's median duration and length.
std::optional<Swing> robust_flight(const Motion& motion, Side side);

// The paper's rule to the letter on the ankle's height: the first gradient change - to + within 10
// % of the range of the lowest height, from there the first + to - within 10 % of the greatest,
// from there the first - to + within 10 % of the lowest. `heel_off` repeats `lift`.
std::optional<Swing> paper_flight(const Motion& motion, Side side);
// The same on bare heights.
std::optional<Swing> paper_flight(const std::vector<double>& heights);

}  // namespace gaitpad
