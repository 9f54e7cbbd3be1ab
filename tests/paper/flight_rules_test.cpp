#include "paper/flight_rules.h"

#include <gtest/gtest.h>

#include "gaitpad/flight.h"

namespace gaitpad {
namespace {

TEST(FlightRules, TheLiteralRuleIsThatOfTheMotionModule) {
  const GaitCycle cycle = procedural_gait();
  for (const Side side : {kLeftSide, kRightSide}) {
    for (const FootPoint point : {FootPoint::ankle, FootPoint::heel, FootPoint::toe_tip}) {
      const auto heights = stride_heights(cycle, side, point, 120);
      const auto ours = flight_targets(heights, {});
      const auto theirs = paper_flight(heights);
      ASSERT_EQ(ours.has_value(), theirs.has_value());
      if (!ours) continue;
      EXPECT_EQ(*ours, (FlightTargets{theirs->lift, theirs->peak, theirs->land}));
    }
  }
}

TEST(FlightRules, WithoutBandsABlipIsTakenForTheLanding) {
  const auto curve = blip_curve(0.003);
  const auto with = flight_targets(curve, {}), without = flight_targets(curve, {false, false});
  ASSERT_TRUE(with && without);
  EXPECT_GT(with->land, kBlipFrame + 10);
  EXPECT_NEAR(without->land, kBlipFrame, 2);
}

TEST(FlightRules, AStandStillIsNoBlip) {
  const auto curve = blip_curve(0.0);
  EXPECT_EQ(flight_targets(curve, {}), flight_targets(curve, {false, false}));
}

TEST(FlightRules, TheLastLowBeforeThePeakLeavesTheStanceOut) {
  auto heights = stride_heights(procedural_gait(), kRightSide, FootPoint::ankle, 120);
  add_standing_jitter(heights, 120);
  const auto first = flight_targets(heights, {true, false}),
             last = flight_targets(heights, {true, true});
  ASSERT_TRUE(first && last);
  EXPECT_LT(first->lift, 12);
  EXPECT_GT(last->lift, 42);
  EXPECT_EQ(first->peak, last->peak);
}

TEST(FlightRules, NothingIsFoundInHalfAFlight) {
  const std::vector<double> half = {0.02, 0.0, 0.01, 0.1, 0.2, 0.19, 0.1};
  EXPECT_FALSE(flight_targets(half, {}));
  EXPECT_FALSE(flight_targets({}, {}));
  EXPECT_FALSE(flight_targets({0.0, 0.0, 0.0, 0.0}, {}));
}

}  // namespace
}  // namespace gaitpad
