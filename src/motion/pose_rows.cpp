#include "motion/pose_rows.h"

#include "motion/rows.h"
#include "motion/stencil.h"

namespace gaitpad {
namespace {

constexpr int kWidest = 8;

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
  for (int sample = 0; sample < kCycleSamples; ++sample) {
    const std::size_t first = rows.value.size(), stride = rows.stride;
    rows.value.resize(first + 4 * stride, 0.0);
    for (std::size_t i = 0; i < stride; ++i) {
      const quat q = i < count ? cycle.local[sample * joints + rows.joint[i]] : kIdentity;
      double* to = rows.value.data() + first + i;
      to[0] = q.w, to[stride] = q.x, to[2 * stride] = q.y, to[3 * stride] = q.z;
    }
  }
  return rows;
}

void sample_rows(const PoseRows& rows, double phase, Pose& pose) noexcept {
  const Stencil s = stencil_at(phase);
  alignas(64) std::array<double, 4 * (kMaxJoints + kWidest)> blend;
  BlendedRows blended{{}, {}, blend.data(), rows.stride};
  for (int k = 0; k < 4; ++k) {
    blended.sample[k] = rows.value.data() + static_cast<std::size_t>(s.index[k]) * 4 * rows.stride;
    blended.weight[k] = s.weight[k];
  }
  blend_rows(blended);
  pose.joint_count = rows.joint_count;
  for (std::size_t i = 0; i < rows.joint.size(); ++i) {
    const double* q = blend.data() + i;
    pose.local[rows.joint[i]] = quat(q[0], q[rows.stride], q[2 * rows.stride], q[3 * rows.stride]);
  }
  for (const int j : rows.still) pose.local[j] = kIdentity;
}

}  // namespace gaitpad
