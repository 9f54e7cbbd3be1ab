// Finds the stretch of a motion that is worth repeating: one stride whose end is most like its
// start.
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

// Every event (either foot's lift or landing) happens once in the window; which one it starts with
// does not matter. Best first. Error, without file name, where the motion holds no such stretch.
Result<std::vector<StrideWindow>> best_strides(const Motion& motion);

// The motion twice, if its last pose is its first one again (its travel removed); what little they
// differ by is spread over the clip. Empty frames where it is no loop.
Motion looped_twice(const Motion& motion);

}  // namespace gaitpad
