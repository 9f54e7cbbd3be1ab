// The procedural walk on other skeletons: larger ones, ones that only stand, ones in a T pose.
#include "motion/cycle_retarget.h"

#include <gtest/gtest.h>

#include "motion/bvh_text.h"
#include "motion/cycle_leg.h"
#include "motion/load.h"

namespace gaitpad {
namespace {

// A body that stands still in its one frame.
Motion standing_body(const GaitCycle& cycle) {
  Motion m = procedural_motion();
  m.name = "still.bvh";
  m.frames.resize(1);
  m.frames[0].local = cycle.standing_local;
  m.frames[0].root_m = vec3(0.3, cycle.leg[0].length_m() - cycle.leg[0].heel_m.y, -2.0);
  m.frames[0].root_m.y -= cycle.leg[0].hip_m.y;
  return m;
}

Motion grown(Motion m, double factor) {
  for (Joint& joint : m.skeleton.joints) joint.offset_m *= factor;
  for (MotionFrame& frame : m.frames) frame.root_m *= factor;
  return m;
}

// Of a skeleton alone the lowest joint counts as the sole; the procedural toe has some flesh below.
vec3 flesh(const GaitCycle& source) { return source.leg[0].toe_end_rest_m * kUp; }

LegPose pose_of(const GaitCycle& cycle, int i, int side) {
  const CycleSample& at = cycle.samples[i];
  return leg_pose(cycle.leg[side], at.pelvis_m, at.pelvis, at.leg[side].angles, at.leg[side].toe_x);
}

TEST(CycleOnSkeleton, OnItsOwnSkeletonIsTheSameWalk) {
  const GaitCycle source = procedural_gait();
  const auto same = cycle_on_skeleton(source, standing_body(source));
  ASSERT_TRUE(same);
  EXPECT_DOUBLE_EQ(same->stride_m, source.stride_m);
  for (int i = 0; i < kCycleSamples; ++i) {
    EXPECT_LT(glm::distance(same->samples[i].pelvis_m + flesh(source), source.samples[i].pelvis_m),
              1e-9);
    for (int side = 0; side < 2; ++side) {
      const LegPose a = pose_of(*same, i, side), b = pose_of(source, i, side);
      EXPECT_LT(glm::distance(a.ankle_m + flesh(source), b.ankle_m), 1e-9);
      EXPECT_LT(glm::distance(a.toe_m + flesh(source), b.toe_m), 1e-9);
    }
  }
  for (std::size_t k = 0; k < source.local.size(); ++k) {
    EXPECT_GT(std::abs(glm::dot(same->local[k], source.local[k])), 1.0 - 1e-9) << k;
  }
}

TEST(CycleOnSkeleton, HipsAndHeelsRunAsManyTimesLargerAsTheLegs) {
  const GaitCycle source = procedural_gait();
  const auto large = cycle_on_skeleton(source, grown(standing_body(source), 1.7));
  ASSERT_TRUE(large);
  EXPECT_NEAR(mean_leg_m(*large), 1.7 * mean_leg_m(source), 1e-12);
  EXPECT_NEAR(large->stride_m, 1.7 * source.stride_m, 1e-12);
  EXPECT_NEAR(large->duration_s, std::sqrt(1.7) * source.duration_s, 1e-12);
  for (int i = 0; i < kCycleSamples; i += 8) {
    const CycleSample &to = large->samples[i], &from = source.samples[i];
    EXPECT_LT(glm::distance(to.pelvis_m, 1.7 * (from.pelvis_m - flesh(source))), 1e-9);
    const vec3 to_heel = to.leg[0].ankle_m + to.leg[0].foot * large->leg[0].heel_m;
    const vec3 from_heel = from.leg[0].ankle_m + from.leg[0].foot * source.leg[0].heel_m;
    EXPECT_LT(glm::distance(to_heel, 1.7 * from_heel), 1e-9);
  }
}

TEST(CycleOnSkeleton, TheHeadingOfTheFileDoesNotMatter) {
  const GaitCycle source = procedural_gait();
  Motion turned = standing_body(source);
  turned.frames[0].local[0] = rotation_y(2.0) * turned.frames[0].local[0];
  const auto cycle = cycle_on_skeleton(source, turned);
  ASSERT_TRUE(cycle);
  for (int side = 0; side < 2; ++side) {
    EXPECT_LT(glm::distance(cycle->leg[side].toe_m, source.leg[side].toe_m), 1e-9);
    EXPECT_LT(glm::distance(cycle->leg[side].hip_m, source.leg[side].hip_m), 1e-9);
  }
}

TEST(CycleOnSkeleton, ArmsOfATPoseHangAsInTheSource) {
  const GaitCycle source = procedural_gait();
  Motion t_pose = standing_body(source);
  t_pose.frames[0].local[t_pose.skeleton.find("LeftArm")] = rotation_z(0.5 * kPi);
  const auto cycle = cycle_on_skeleton(source, t_pose);
  ASSERT_TRUE(cycle);
  const int forearm = source.skeleton.find("LeftForeArm");
  for (int i = 0; i < kCycleSamples; i += 16) {
    const auto from =
        world_rotations(source.skeleton, source.local.data() + i * source.skeleton.joints.size());
    const auto to =
        world_rotations(cycle->skeleton, cycle->local.data() + i * cycle->skeleton.joints.size());
    const vec3 bone = source.skeleton.joints[forearm].offset_m;
    const int arm = source.skeleton.joints[forearm].parent;
    EXPECT_LT(glm::distance(from[arm] * bone, to[arm] * bone), 1e-9) << i;
  }
}

TEST(CycleOnSkeleton, OfOtherNamesRestsAboveTheLegs) {
  const auto walker = motion_from_bvh(WalkerText().text(), "walker.bvh");
  ASSERT_TRUE(walker);
  const auto cycle = cycle_on_skeleton(procedural_gait(), *walker);
  ASSERT_TRUE(cycle);
  EXPECT_EQ(cycle->skeleton.joints[0].name, "Hips");
  EXPECT_NEAR(cycle->leg[0].thigh_m, 40 * walker->metres_per_unit, 1e-12);
  EXPECT_NEAR(cycle->leg[0].heel_m.y, -8 * walker->metres_per_unit, 1e-12) << "toes on the floor";
}

TEST(CycleOnSkeleton, AFootThatIsNowhereFlatStillPointsForward) {
  std::string text = WalkerText().text();
  text = replaced(text, "OFFSET 0 -8 12\n", "OFFSET 0 -8 -12\n");
  const auto walker = motion_from_bvh(text, "backward.bvh");
  ASSERT_TRUE(walker);
  const auto cycle = cycle_on_skeleton(procedural_gait(), *walker);
  ASSERT_TRUE(cycle);
  for (const LegModel& leg : cycle->leg) EXPECT_GT(leg.toe_m.z, 0.05);
}

}  // namespace
}  // namespace gaitpad
