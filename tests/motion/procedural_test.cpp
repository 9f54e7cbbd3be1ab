// The embedded walk against the published table (paper-notes, section 4.2) and against itself.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gaitpad/gait_cycle.h"
#include "motion/leg_pose.h"
#include "motion/made_motion.h"

namespace gaitpad {
namespace {

const GaitCycle& walk() {
  static const GaitCycle cycle = procedural_gait();
  return cycle;
}

// Adults' angles (gaitutils normal.gcd) in degrees at every 8 % of the cycle: hip minus mean tilt,
// knee, ankle.
constexpr double kHip[] = {33.5, 32.3, 26.1, 17.9, 7.5,  -0.6, -6.5,
                           -9.8, -2.4, 14.8, 27.9, 34.3, 34.1};
constexpr double kKnee[] = {0.4, 8.1, 15.4, 13.1, 6.5, 1.8, 2.0, 9.8, 36.9, 61.0, 61.0, 38.5, 8.4};
constexpr double kAnkle[] = {2.0,  -1.0, 3.1,  7.7, 10.3, 13.6, 16.5,
                             12.5, -4.3, -8.5, 0.6, 1.9,  1.8};
constexpr double kMeanTilt = 9.76;

TEST(ProceduralGait, FollowsThePublishedCurves) {
  for (int i = 0; i < 13; ++i) {
    const LegAngles a = sample_at(walk(), 0.08 * i).leg[kRightSide].angles;
    EXPECT_NEAR(-a[kHipX] / kDegree, kHip[i] - kMeanTilt, 2.0) << i;
    EXPECT_NEAR(a[kKneeX] / kDegree, kKnee[i], 2.0) << i;
    // The tolerance includes the correction of 3.5 for the foot.
    EXPECT_NEAR(-a[kAnkleX] / kDegree, kAnkle[i], 5.0) << i;
  }
}

TEST(ProceduralGait, LeftIsRightHalfACycleLaterToTheLastBit) {
  const GaitCycle& c = walk();
  for (int i = 0; i < kCycleSamples; ++i) {
    const CycleSample& a = c.samples[i];
    const CycleSample& b = c.samples[(i + kCycleSamples / 2) % kCycleSamples];
    EXPECT_EQ(a.pelvis_m, mirrored(b.pelvis_m));
    EXPECT_EQ(a.pelvis, mirrored(b.pelvis));
    const LegAngles& right = a.leg[kRightSide].angles;
    const LegAngles& left = b.leg[kLeftSide].angles;
    for (const int d : {kHipX, kKneeX, kAnkleX}) EXPECT_EQ(right[d], left[d]);
    for (const int d : {kHipZ, kHipY, kAnkleZ, kAnkleY}) EXPECT_EQ(right[d], -left[d]);
    EXPECT_EQ(a.leg[kRightSide].ankle_m, mirrored(b.leg[kLeftSide].ankle_m));
  }
}

TEST(ProceduralGait, LegIsAnAdultsAndSpeedIsTheChosenOne) {
  const GaitCycle& c = walk();
  EXPECT_DOUBLE_EQ(c.leg[kLeftSide].length_m(), 0.84);
  EXPECT_NEAR(c.stride_m / c.duration_s, 1.25, 0.01);
  const double steps_per_minute = 120.0 / c.duration_s;
  EXPECT_GT(steps_per_minute, 99.0);  // adults: 99 to 113 (paper-notes 4.1)
  EXPECT_LT(steps_per_minute, 113.0);
  EXPECT_NEAR(c.step_m[kLeftSide] + c.step_m[kRightSide], c.stride_m, 1e-12);
}

TEST(ProceduralGait, HeelStrikesFirstAndTheStandingFootStays) {
  const LegPose strike = pose_at(walk(), kRightSide, 0.0);
  EXPECT_LT(strike.heel_m.y, 0.015);
  EXPECT_GT(strike.toe_m.y, 0.05);
  const double stride_m = walk().stride_m;
  const double stood = pose_at(walk(), kRightSide, 0.25).heel_m.z + 0.25 * stride_m;
  for (double phase = 0.06; phase < 0.40; phase += 0.02) {
    const LegPose p = pose_at(walk(), kRightSide, phase);
    EXPECT_NEAR(p.heel_m.z + phase * stride_m, stood, 0.015) << phase;
    EXPECT_LT(p.heel_m.y, 0.010) << phase;
  }
}

TEST(ProceduralGait, NoFootPointGoesUnderTheFloorTheSwingingToeClearsItAndNoKneeIsStraight) {
  for (double phase = 0.0; phase < 1.0; phase += 0.005) {
    const LegPose p = pose_at(walk(), kRightSide, phase);
    const LegModel& leg = walk().leg[kRightSide];
    EXPECT_GT(sample_at(walk(), phase).leg[kLeftSide].angles[kKneeX], 1.4 * kDegree) << phase;
    const double toe_end_m = p.toe_end_m.y - leg.toe_end_rest_m;
    EXPECT_GT(p.heel_m.y, -0.003) << phase;
    EXPECT_GT(p.toe_m.y - leg.toe_rest_m, -0.003) << phase;
    EXPECT_GT(toe_end_m, -0.003) << phase;
    if (phase > 0.7 && phase < 0.95) {
      EXPECT_GT(toe_end_m, 0.008) << phase;
    }
  }
}

TEST(ProceduralGait, IsSmoothAcrossTheSeamAt240Hz) {
  const GaitCycle& c = walk();
  const double tick = 1.0 / (240.0 * c.duration_s);
  for (double phase = -0.05; phase < 1.05; phase += 0.5 * tick) {
    const auto before = sample_at(c, phase - tick), at = sample_at(c, phase),
               after = sample_at(c, phase + tick);
    for (int d = 0; d < kLegDofs; ++d) {
      const double bend =
          before.leg[0].angles[d] - 2.0 * at.leg[0].angles[d] + after.leg[0].angles[d];
      EXPECT_LT(std::abs(bend), 0.25 * kDegree) << d << " at " << phase;
    }
  }
}

TEST(ProceduralGait, BodyPoseAgreesWithTheLegModel) { expect_body_agrees_with_legs(walk(), 1e-4); }

TEST(ProceduralGait, ArmsSwingAgainstTheLegs) {
  const GaitCycle& c = walk();
  Pose pose;
  const auto world = std::make_unique<JointFrames>();
  sample_local(c, 0.0, pose);  // the right foot is in front
  pose.root_m = sample_at(c, 0.0).pelvis_m;
  forward_kinematics(c.skeleton, pose, *world);
  const auto ahead = [&](const char* joint) { return world->position_m[c.skeleton.find(joint)].z; };
  EXPECT_GT(ahead("RightFoot"), ahead("LeftFoot") + 0.3);
  EXPECT_GT(ahead("LeftHand"), ahead("RightHand") + 0.3);
}

TEST(ProceduralMotion, IsFourStridesOfTheSameWalk) {
  const Motion m = procedural_motion();
  const GaitCycle& c = walk();
  EXPECT_NEAR((m.frames.size() - 1) * m.frame_time_s, 4.0 * c.duration_s, 1e-9);
  EXPECT_NEAR(m.frames.back().root_m.z - m.frames.front().root_m.z, 4.0 * c.stride_m, 1e-9);
  EXPECT_EQ(m.skeleton.joints[m.legs[kLeftSide].ankle].name, "LeftFoot");
}

}  // namespace
}  // namespace gaitpad
