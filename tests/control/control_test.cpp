#include "gaitpad/control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace gaitpad {
namespace {

const GaitLimits kAdult = gait_limits(kReferenceLeg_m);

GaitParams at(double x, double y, const Style& style = {}, const GaitLimits& limits = kAdult) {
  Stick stick;
  stick.left = vec2(x, y);
  return gait_params(stick, style, limits);
}
double speed_of(const StrideParams& step) { return step.length_m / step.time_s; }

TEST(GaitParams, FullStickIsTheMaximumStrideAndSpeed) {
  const GaitParams p = at(0.0, 1.0);
  for (const StrideParams& step : p.stride) {
    EXPECT_NEAR(step.length_m, kAdult.max_step_m, 1e-15);
    EXPECT_NEAR(speed_of(step), kAdult.max_speed_m_s, 1e-14);
  }
  EXPECT_TRUE(p.walking);
  EXPECT_EQ(p.turn_rate_rad_s, 0.0);
}

// At 1.6 m/s 0.746 m and 128.7 steps a minute: 0.58 cm per step/min.
TEST(GaitParams, AdultNumbersFollowFromTheWalkRatio) {
  GaitLimits limits = kAdult;
  limits.max_speed_m_s = 1.6;
  limits.max_step_m = 0.746;
  const StrideParams step = at(0.0, 1.0, {}, limits).stride[kLeftSide];
  EXPECT_NEAR(60.0 / step.time_s, 128.7, 0.05);
  EXPECT_NEAR(kAdult.max_step_m, std::sqrt(0.348 * kMaxSpeed_m_s), 1e-15);
}

TEST(GaitParams, WalkRatioIsConstantUntilTheStepTimeLimit) {
  for (double y = 0.02; y <= 1.0; y += 0.01) {
    const StrideParams step = at(0.0, y).stride[kRightSide];
    const double ratio = step.length_m / (60.0 / step.time_s);
    EXPECT_NEAR(speed_of(step), y * kAdult.max_speed_m_s, 1e-14);
    EXPECT_LE(step.time_s, kAdult.max_step_time_s);
    if (step.time_s < kAdult.max_step_time_s) {
      EXPECT_NEAR(ratio, 0.0058, 1e-15);
    } else {
      EXPECT_LT(ratio, 0.0058 + 1e-15);
    }
  }
}

TEST(GaitParams, LengthAndSpeedRiseWithForwardDeflection) {
  for (double x : {-0.6, 0.0, 0.01, 0.3}) {
    for (double y = 0.001; y < 1.0; y += 0.001) {
      const StrideParams a = at(x, y).stride[kLeftSide], b = at(x, y + 0.001).stride[kLeftSide];
      EXPECT_GT(b.length_m, a.length_m);
      EXPECT_GT(speed_of(b), speed_of(a));
    }
  }
}

TEST(GaitParams, ContinuousInTheForwardDeflection) {
  constexpr double kStep = 1e-4;
  for (double x : {0.0, 0.05, 0.5, -1.0}) {
    for (double y = x == 0.0 ? kStep : -0.1; y < 1.0; y += kStep) {
      const StrideParams a = at(x, y).stride[kLeftSide], b = at(x, y + kStep).stride[kLeftSide];
      ASSERT_NEAR(a.length_m, b.length_m, 40 * kStep) << x << " " << y;
      ASSERT_NEAR(a.time_s, b.time_s, 20 * kStep) << x << " " << y;
    }
  }
}

TEST(GaitParams, ContinuousInTheSidewaysDeflection) {
  constexpr double kStep = 1e-4;
  for (double y : {0.05, 0.3, 1.0}) {
    for (double x = -1.0; x < 1.0; x += kStep) {
      const GaitParams a = at(x, y), b = at(x + kStep, y);
      ASSERT_NEAR(a.stride[0].time_s, b.stride[0].time_s, 20 * kStep) << x << " " << y;
      ASSERT_NEAR(a.stride[0].length_m, b.stride[0].length_m, 20 * kStep) << x << " " << y;
      ASSERT_NEAR(a.turn_rate_rad_s, b.turn_rate_rad_s, 2 * kStep);
    }
  }
}

TEST(GaitParams, SidewaysTurnsAgainstTheStickAndMirrors) {
  EXPECT_EQ(at(1.0, 0.0).turn_rate_rad_s, -kMaxTurnRate_rad_s);
  for (double x = 0.01; x <= 1.0; x += 0.01) {
    const GaitParams right = at(x, 0.5), left = at(-x, 0.5);
    EXPECT_LT(right.turn_rate_rad_s, 0.0);
    EXPECT_EQ(left.turn_rate_rad_s, -right.turn_rate_rad_s);
    EXPECT_EQ(left.stride[0].length_m, right.stride[0].length_m);
    EXPECT_EQ(left.stride[0].time_s, right.stride[0].time_s);
    EXPECT_LT(at(x + 0.01, 0.5).turn_rate_rad_s, right.turn_rate_rad_s);
  }
}

TEST(GaitParams, NeutralStands) {
  for (double y : {0.0, -0.0}) {
    const GaitParams p = at(0.0, y);
    EXPECT_FALSE(p.walking);
    EXPECT_EQ(p.stride[kLeftSide].length_m, 0.0);
    EXPECT_EQ(p.turn_rate_rad_s, 0.0);
    EXPECT_FALSE(std::signbit(p.turn_rate_rad_s));
    EXPECT_GT(p.stride[kLeftSide].time_s, 0.0);
  }
}

TEST(GaitParams, SidewaysAloneTurnsInPlace) {
  for (double y : {0.0, -0.05}) {  // 6 degrees behind the side: a thumb's noise
    const GaitParams p = at(-0.5, y);
    EXPECT_FALSE(p.backward);
    EXPECT_TRUE(p.walking);
    EXPECT_EQ(p.stride[kRightSide].length_m, 0.0);
    EXPECT_EQ(p.stride[kRightSide].time_s, kTurnInPlaceStepTime_s);
    EXPECT_GT(p.turn_rate_rad_s, 0.0);
  }
}

TEST(GaitParams, BackwardDeflectionWalksBackwardsSlowlyInShortSteps) {
  for (double y : {0.1, 0.5, 1.0}) {
    const GaitParams back = at(0.0, -y), ahead = at(0.0, y);
    EXPECT_TRUE(back.walking && back.backward);
    EXPECT_FALSE(ahead.backward);
    const StrideParams &step = back.stride[kLeftSide], &forth = ahead.stride[kLeftSide];
    EXPECT_LT(step.length_m, kBackwardStep * forth.length_m);
    EXPECT_NEAR(step.length_m / step.time_s, kBackwardShare * y * kMaxSpeed_m_s, 1e-12);
  }
}

TEST(GaitParams, ABackwardBendTurnsAsAForwardOneAndBeginsFromNothing) {
  const double edge = -kBackwardSector * 0.5;
  EXPECT_EQ(at(0.5, -0.6).turn_rate_rad_s, at(0.5, 0.6).turn_rate_rad_s);
  EXPECT_TRUE(at(0.5, -0.6).backward);
  EXPECT_LT(at(0.5, edge - 0.001).stride[kLeftSide].length_m, 0.002);
}

// The paper scales lengths by the ratio of the legs; times follow by its fourth root: for a leg a
// sixteenth as long, half the time, an eighth of the speed.
TEST(GaitLimits, ScaleWithTheLegs) {
  const GaitLimits tiny = gait_limits(kReferenceLeg_m / 16.0);
  EXPECT_NEAR(tiny.max_step_m, kAdult.max_step_m / 16.0, 1e-15);
  EXPECT_NEAR(tiny.max_step_time_s, 0.5 * kAdult.max_step_time_s, 1e-15);
  EXPECT_NEAR(tiny.max_speed_m_s, kAdult.max_speed_m_s / 8.0, 1e-15);
  EXPECT_NEAR(tiny.max_step_m / tiny.max_speed_m_s, 0.5 * kAdult.max_step_m / kAdult.max_speed_m_s,
              1e-15);
}

TEST(Fatigue, LowersMaximumSpeedAndStrideLinearly) {
  const StrideParams fresh = at(0.0, 1.0).stride[kLeftSide];
  for (double f = 0.0; f <= 1.0; f += 0.125) {
    Style style;
    style.fatigue = f;
    const StrideParams tired = at(0.0, 1.0, style).stride[kLeftSide];
    const double share = 1.0 - f * (1.0 - kFullFatigueLeaves);
    EXPECT_NEAR(tired.length_m, fresh.length_m * share, 1e-15);
    EXPECT_NEAR(speed_of(tired), speed_of(fresh) * share, 1e-14);
  }
}

TEST(Fatigue, NoneIsIdenticalToFresh) {
  Style style;
  style.fatigue = 0.0;
  for (double y = 0.0; y <= 1.0; y += 0.01) {
    EXPECT_EQ(at(0.2, y, style).stride[0].length_m, at(0.2, y).stride[0].length_m);
    EXPECT_EQ(at(0.2, y, style).stride[0].time_s, at(0.2, y).stride[0].time_s);
  }
}

// The paper's injured leg: stride -50 %, flight height -50 %, speed +30 %.
TEST(GaitParams, StyleFactorsActOnTheirLegOnly) {
  Style limp;
  limp.stride[kLeftSide] = {0.5, 1.3, 0.5};
  limp.weight[kLeftSide][kHipX] = 0.2;
  limp.hip_sway = 0.7;
  limp.hip_bounce = 1.4;
  const GaitParams even = at(0.0, 0.8), p = at(0.0, 0.8, limp);
  EXPECT_EQ(p.stride[kLeftSide].length_m, 0.5 * even.stride[kLeftSide].length_m);
  EXPECT_EQ(p.stride[kLeftSide].time_s, even.stride[kLeftSide].time_s / 1.3);
  EXPECT_EQ(p.stride[kLeftSide].flight_height, 0.5);
  EXPECT_EQ(p.stride[kRightSide].length_m, even.stride[kRightSide].length_m);
  EXPECT_EQ(p.stride[kRightSide].time_s, even.stride[kRightSide].time_s);
  EXPECT_EQ(p.weight, limp.weight);
  EXPECT_EQ(p.hip_sway, 0.7);
  EXPECT_EQ(p.hip_bounce, 1.4);
}

TEST(GaitParams, OddSticksGiveFiniteParameters) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (double x : {nan, inf, -inf, 5.0, 1e-310, 0.0}) {
    for (double y : {nan, inf, -inf, 5.0, 1e-310, 0.0}) {
      const GaitParams p = at(x, y);
      EXPECT_TRUE(std::isfinite(p.stride[0].length_m) && std::isfinite(p.stride[0].time_s));
      EXPECT_GT(p.stride[0].time_s, 0.0);
      EXPECT_LE(p.stride[0].length_m, kAdult.max_step_m);
      EXPECT_LE(std::fabs(p.turn_rate_rad_s), kMaxTurnRate_rad_s);
    }
  }
  static_assert(std::is_trivially_copyable_v<GaitParams>);
}

}  // namespace
}  // namespace gaitpad
