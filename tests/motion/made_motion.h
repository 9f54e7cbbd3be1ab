// Helpers to check motions and walks.
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "gaitpad/motion.h"
#include "motion/leg_pose.h"

namespace gaitpad {

inline std::unique_ptr<JointFrames> world_of(const Motion& m, std::size_t frame = 0) {
  auto world = std::make_unique<JointFrames>();
  forward_kinematics(m, m.frames[frame], *world);
  return world;
}

inline LegPose pose_of(const GaitCycle& cycle, const CycleSample& at, int side) {
  return leg_pose(cycle.leg[side], at.pelvis_m, at.pelvis, at.leg[side].angles, at.leg[side].toe_x);
}
inline LegPose pose_at(const GaitCycle& cycle, int side, double phase) {
  return pose_of(cycle, sample_at(cycle, phase), side);
}

// Expects the body's joints at the places that the legs' model gives.
inline void expect_body_agrees_with_legs(const GaitCycle& cycle, double tolerance_m) {
  const auto pose = std::make_unique<Pose>();
  const auto world = std::make_unique<JointFrames>();
  for (int i = 0; i < kCycleSamples; i += 5) {
    const double phase = double(i) / kCycleSamples;
    sample_local(cycle, phase, *pose);
    pose->root_m = sample_at(cycle, phase).pelvis_m;
    forward_kinematics(cycle.skeleton, *pose, *world);
    for (const int side : {0, 1}) {
      const LegPose leg = pose_at(cycle, side, phase);
      const LegJoints& j = cycle.leg[side].joints;
      EXPECT_LT(glm::distance(world->position_m[j.hip], leg.hip_m), tolerance_m) << phase;
      EXPECT_LT(glm::distance(world->position_m[j.ankle], leg.ankle_m), tolerance_m) << phase;
      EXPECT_LT(glm::distance(world->position_m[j.toe], leg.toe_m), tolerance_m) << phase;
      EXPECT_LT(glm::distance(world->position_m[j.toe_end], leg.toe_end_m), tolerance_m) << phase;
    }
  }
}

// Removes everything above the hips from the built-in walk; pelvis and two legs of five joints
// remain.
inline void keep_legs_alone(GaitCycle& cycle) {
  const std::size_t all = cycle.skeleton.joints.size(), kept = 11;
  std::vector<quat> local;
  for (int i = 0; i < kCycleSamples; ++i) {
    const auto row = cycle.local.begin() + static_cast<std::ptrdiff_t>(i * all);
    local.insert(local.end(), row, row + static_cast<std::ptrdiff_t>(kept));
  }
  cycle.local = local;
  cycle.skeleton.joints.resize(kept);
  cycle.standing_local.resize(kept);
}

}  // namespace gaitpad
