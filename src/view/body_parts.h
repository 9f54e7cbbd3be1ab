// What the joints of a skeleton are, as far as a body needs it: trunk, neck and head, arms. Told by
// the standing pose, and by names where they help.
#pragma once
#include <array>
#include <vector>

#include "gaitpad/walk_model.h"

namespace gaitpad {

struct ArmJoints {
  int shoulder = -1, elbow = -1, wrist = -1;
  int hand_end = -1;  // the farthest joint of the hand, -1: none below the wrist
  bool is_known() const noexcept { return shoulder >= 0; }
};
struct BodyParts {
  JointFrames standing;          // world, facing +z, the feet on the floor
  std::vector<int> trunk;        // from the pelvis or the root upwards to the head
  int head = -1, top = -1;       // top: the highest joint on the head, or the head itself; -1: none
  std::array<ArmJoints, 2> arm;  // by Side
  vec3 hips_m{0.0}, shoulders_m{0.0};  // standing, between left and right; else a guess
};
BodyParts body_parts(const WalkModel& model);

}  // namespace gaitpad
