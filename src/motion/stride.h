// Finds the stride of a motion that repeats best: its last pose is most like its first.
#pragma once
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct StrideWindow {
  double start = 0.0;       // first frame, with fractions
  double period = 0.0;      // length in frames
  double turn_rad = 0.0;    // change of heading during the stride
  int first = 0, last = 0;  // frames around it that belong to the same unbroken movement
};

// All strides of a motion, the best first. Each contains every event (lift and landing of either
// foot) once and may begin with any of them. The error does not name the file.
Result<std::vector<StrideWindow>> best_strides(const Motion& motion);

// The place of a point at a frame with fractions: linear between frames.
vec3 point_at(const std::vector<vec3>& track, double frame);

// The motion twice in a row, if its last pose equals its first one apart from the travel. A small
// difference is spread over the clip. No frames if the motion is not a loop.
Motion looped_twice(const Motion& motion);

}  // namespace gaitpad
