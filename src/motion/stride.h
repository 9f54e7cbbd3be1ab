// Finds the stride of a motion that repeats best: the one whose end is most like its start.
#pragma once
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct StrideWindow {
  double start = 0.0;       // frame, between frames where need be
  double period = 0.0;      // frames
  double turn_rad = 0.0;    // change of heading in it
  int first = 0, last = 0;  // frames around it that belong to the same unbroken movement
};

// All strides of a motion, the best one first. In each of them every event (either foot's lift or
// landing) happens once; it may begin with any of them. The error does not name the file.
Result<std::vector<StrideWindow>> best_strides(const Motion& motion);

// The motion twice in a row, if its last pose is its first one again but for the travel. The little
// that they differ by is spread over the clip. No frames where the motion is no loop.
Motion looped_twice(const Motion& motion);

}  // namespace gaitpad
