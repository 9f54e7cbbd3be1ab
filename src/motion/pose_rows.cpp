#include "motion/pose_rows.h"

namespace gaitpad {
namespace {

constexpr int kWidest = 8;  // doubles in the widest register

bool is_still(const GaitCycle& cycle, std::size_t joint) {
  const std::size_t joints = cycle.standing_local.size();
  for (std::size_t i = joint; i < cycle.local.size(); i += joints) {
    if (cycle.local[i] != kIdentity) return false;
  }
  return cycle.standing_local[joint] == kIdentity;
}

}  // namespace

PoseRows pose_rows(const GaitCycle& cycle, std::span<const bool> is_left_out) {
  PoseRows rows;
  const int joints = static_cast<int>(cycle.standing_local.size());
  rows.joint_count = joints;
  for (int j = 0; j < joints; ++j) {
    if (is_left_out[j]) continue;
    (is_still(cycle, j) ? rows.still : rows.joint).push_back(j);
  }
  const std::size_t count = rows.joint.size();
  rows.stride = static_cast<int>((count + kWidest - 1) / kWidest) * kWidest;
  const auto add_row = [&](const quat* local, std::vector<double>& value) {
    const std::size_t first = value.size(), stride = rows.stride;
    value.resize(first + 4 * stride, 0.0);
    for (std::size_t i = 0; i < stride; ++i) {
      const quat q = i < count ? local[rows.joint[i]] : kIdentity;
      double* to = value.data() + first + i;
      to[0] = q.w, to[stride] = q.x, to[2 * stride] = q.y, to[3 * stride] = q.z;
    }
  };
  for (int sample = 0; sample < kCycleSamples; ++sample)
    add_row(cycle.local.data() + static_cast<std::ptrdiff_t>(sample) * joints, rows.value);
  add_row(cycle.standing_local.data(), rows.standing);
  return rows;
}

}  // namespace gaitpad
