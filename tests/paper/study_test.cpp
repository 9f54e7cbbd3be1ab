#include "paper/study.h"

#include <gtest/gtest.h>

#include "paper/paper_fixture.h"

namespace gaitpad {
namespace {

using test::even;
using test::study;

TEST(WalkRun, StridesFollowOneAnotherFromStrikeToStrike) {
  const auto all = strides(even(), kRightSide);
  ASSERT_GE(all.size(), 5u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const WalkFrame& frame = even().samples[all[i].begin].frame;
    EXPECT_EQ(frame.stage, Stage::roll);
    EXPECT_EQ(frame.swing, kRightSide);
    EXPECT_EQ(even().samples[all[i].begin - 1].frame.stage, Stage::flight);
    EXPECT_TRUE(i == 0 || all[i].begin == all[i - 1].end);
  }
}

TEST(WalkRun, FlightsAreWholeAndOfThatFoot) {
  for (const Ticks& f : flights(even(), kLeftSide, 2.0)) {
    EXPECT_GE(f.begin, 480u);
    for (std::size_t k = f.begin - 1; k <= f.end; ++k) {
      const WalkFrame& frame = even().samples[k].frame;
      const bool flies = frame.stage == Stage::flight && frame.swing == kLeftSide;
      EXPECT_EQ(flies, k >= f.begin && k < f.end);
    }
  }
}

TEST(WalkRun, AnglesAreFlexionsInDegrees) {
  LegAngles angles{};
  angles[kHipX] = -0.5, angles[kKneeX] = 1.0, angles[kAnkleX] = 0.25;
  EXPECT_NEAR(joint_deg(angles, LegJoint::hip), 28.64789, 1e-5);
  EXPECT_NEAR(joint_deg(angles, LegJoint::knee), 57.29578, 1e-5);
  EXPECT_NEAR(joint_deg(angles, LegJoint::ankle), -14.32394, 1e-5);
}

TEST(WalkRun, ShortWalksHaveNoStride) {
  WalkCase what;
  what.model = &study().model();
  what.end_s = 1.0;
  EXPECT_EQ(stride_after(walked(what), kRightSide, 0.0).count(), 0u);
}

}  // namespace
}  // namespace gaitpad
