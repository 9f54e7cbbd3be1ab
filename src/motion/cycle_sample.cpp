// Reading a gait cycle at any phase: cubic between samples, inside the loop.
#include <cassert>

#include "motion/gait_cycle.h"

namespace gaitpad {
namespace {

// The four samples around a phase and their Catmull-Rom weights.
struct Stencil {
  std::array<int, 4> index;
  std::array<double, 4> weight;
};

Stencil stencil_at(double phase) noexcept {
  const double turns = phase - std::floor(phase);
  const double place = turns * kCycleSamples;
  const int i = std::min(static_cast<int>(place), kCycleSamples - 1);
  const double t = place - i;
  Stencil s;
  for (int k = 0; k < 4; ++k) s.index[k] = (i + k - 1 + kCycleSamples) % kCycleSamples;
  s.weight[0] = 0.5 * t * (-1.0 + t * (2.0 - t));
  s.weight[1] = 1.0 + 0.5 * t * t * (3.0 * t - 5.0);
  s.weight[2] = 0.5 * t * (1.0 + t * (4.0 - 3.0 * t));
  s.weight[3] = 0.5 * t * t * (t - 1.0);
  return s;
}

// Neighbouring samples are less than some degrees apart, so blending the components will do; each
// is brought into the second one's hemisphere first.
quat blended(const std::array<const quat*, 4>& q, const std::array<double, 4>& weight) noexcept {
  quat sum = *q[1] * weight[1];
  for (const int k : {0, 2, 3}) {
    const double sign = glm::dot(*q[k], *q[1]) < 0.0 ? -1.0 : 1.0;
    sum = sum + *q[k] * (sign * weight[k]);
  }
  return glm::normalize(sum);
}

}  // namespace

CycleSample sample_at(const GaitCycle& cycle, double phase) noexcept {
  const Stencil s = stencil_at(phase);
  std::array<const CycleSample*, 4> at;
  for (int k = 0; k < 4; ++k) at[k] = &cycle.samples[s.index[k]];
  CycleSample out;
  for (int k = 0; k < 4; ++k) out.pelvis_m += at[k]->pelvis_m * s.weight[k];
  out.pelvis = blended({&at[0]->pelvis, &at[1]->pelvis, &at[2]->pelvis, &at[3]->pelvis}, s.weight);
  for (int side = 0; side < 2; ++side) {
    LegSample& leg = out.leg[side];
    std::array<const LegSample*, 4> from;
    for (int k = 0; k < 4; ++k) from[k] = &at[k]->leg[side];
    for (int k = 0; k < 4; ++k) {
      for (int d = 0; d < kLegDofs; ++d) leg.angles[d] += from[k]->angles[d] * s.weight[k];
      leg.toe_x += from[k]->toe_x * s.weight[k];
      leg.ankle_m += from[k]->ankle_m * s.weight[k];
    }
    leg.foot = blended({&from[0]->foot, &from[1]->foot, &from[2]->foot, &from[3]->foot}, s.weight);
  }
  return out;
}

void sample_local(const GaitCycle& cycle, double phase, Pose& pose) noexcept {
  const Stencil s = stencil_at(phase);
  const int joints = static_cast<int>(cycle.standing_local.size());
  assert(joints <= kMaxJoints);
  pose.joint_count = joints;
  std::array<const quat*, 4> row;
  for (int k = 0; k < 4; ++k) row[k] = cycle.local.data() + std::size_t(s.index[k]) * joints;
  for (int j = 0; j < joints; ++j) {
    pose.local[j] = blended({row[0] + j, row[1] + j, row[2] + j, row[3] + j}, s.weight);
  }
}

}  // namespace gaitpad
