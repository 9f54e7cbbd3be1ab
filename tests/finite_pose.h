// Whether a pose can be shown: no number of it is infinite or NaN.
#pragma once
#include <cmath>
#include <span>

#include "gaitpad/motion.h"

namespace gaitpad {

// `local`: the rotations of the joints that the pose has.
inline bool is_finite(const vec3& root_m, std::span<const quat> local) {
  double sum = root_m.x + root_m.y + root_m.z;
  for (const quat& q : local) sum += q.w + q.x + q.y + q.z;
  return std::isfinite(sum);
}
inline bool is_finite(const Pose& pose) {
  return is_finite(pose.root_m, std::span(pose.local).first(pose.joint_count));
}

}  // namespace gaitpad
