#include "gaitpad/control.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
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

// At 1.6 m/s steps have 0.746 m and 128.7 per minute: 0.58 cm per step/min.
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

TEST(GaitParams, ContinuousInTheStickAndRisingWithItsForwardDeflection) {
  constexpr double kStep = 1e-3;
  for (const double x : {-0.6, 0.0, 0.05, 0.3}) {
    for (double y = x == 0.0 ? kStep : -0.1; y < 1.0; y += kStep) {
      const StrideParams a = at(x, y).stride[kLeftSide], b = at(x, y + kStep).stride[kLeftSide];
      ASSERT_NEAR(a.length_m, b.length_m, 40 * kStep) << x << " " << y;
      ASSERT_NEAR(a.time_s, b.time_s, 20 * kStep) << x << " " << y;
      if (y <= 0.0) continue;
      ASSERT_GT(b.length_m, a.length_m) << x << " " << y;
      ASSERT_GT(speed_of(b), speed_of(a)) << x << " " << y;
    }
  }
  for (const double y : {0.05, 0.3, 1.0}) {
    for (double x = -1.0; x < 1.0; x += kStep) {
      const GaitParams a = at(x, y), b = at(x + kStep, y);
      ASSERT_NEAR(a.stride[0].time_s, b.stride[0].time_s, 20 * kStep) << x << " " << y;
      ASSERT_NEAR(a.stride[0].length_m, b.stride[0].length_m, 20 * kStep) << x << " " << y;
      ASSERT_NEAR(a.turn_rate_rad_s, b.turn_rate_rad_s, 2 * kStep);
    }
  }
}

TEST(GaitParams, SidewaysTurnsAgainstTheStickAndMirrors) {
  EXPECT_EQ(at(1.0, 0.0).turn_rate_rad_s, -kQuickerInPlace * kMaxTurnRate_rad_s);
  EXPECT_EQ(at(1.0, kNotInPlace).turn_rate_rad_s, -kMaxTurnRate_rad_s);
  for (double x = 0.01; x <= 1.0; x += 0.01) {
    const GaitParams right = at(x, 0.5), left = at(-x, 0.5);
    EXPECT_LT(right.turn_rate_rad_s, 0.0);
    EXPECT_EQ(left.turn_rate_rad_s, -right.turn_rate_rad_s);
    EXPECT_EQ(left.stride[0].length_m, right.stride[0].length_m);
    EXPECT_EQ(left.stride[0].time_s, right.stride[0].time_s);
    EXPECT_LT(at(x + 0.01, 0.5).turn_rate_rad_s, right.turn_rate_rad_s);
  }
}

TEST(GaitParams, NeutralStandsAndSidewaysAloneTurnsInPlace) {
  for (double y : {0.0, -0.0}) {
    const GaitParams p = at(0.0, y);
    EXPECT_FALSE(p.walking);
    EXPECT_EQ(p.stride[kLeftSide].length_m, 0.0);
    EXPECT_EQ(p.turn_rate_rad_s, 0.0);
    EXPECT_FALSE(std::signbit(p.turn_rate_rad_s));
    EXPECT_GT(p.stride[kLeftSide].time_s, 0.0);
  }

  for (double y : {0.0, -0.05}) {  // 6 degrees behind the sideways direction, as by a thumb's noise
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

// --- The own pace of a walk: a slow one with a short left step.

constexpr OwnGait kSlowLimp = {.stick = 0.8, .step_m = {0.31, 0.47}, .step_time_s = 1.05};
const GaitLimits kOwn = gait_limits(0.9, kSlowLimp);

// At the own pace's deflection, steps and times are exactly the walk's; a full deflection is a
// quarter faster. Step length over cadence stays the walk's: 0.39 m at 60 / 1.05 steps a minute.
TEST(OwnPace, SpeedGoesWithTheStickAndTheStepWithItsRoot) {
  EXPECT_NEAR(kOwn.max_speed_m_s, 1.25 * 0.78 / 2.1, 1e-15);
  EXPECT_NEAR(at(0.0, 0.8, {}, kOwn).stride[kLeftSide].time_s, 1.05, 1e-14);
  for (const double y : {0.25, 0.4, 0.6, 0.8, 0.9, 1.0}) {
    const GaitParams p = at(0.0, y, {}, kOwn);
    EXPECT_NEAR(value_of(GaitKey::speed_m_s, p), y / 0.8 * 0.78 / 2.1, 1e-14);
    for (const Side side : {kLeftSide, kRightSide}) {
      EXPECT_NEAR(p.stride[side].length_m, std::sqrt(y / 0.8) * kSlowLimp.step_m[side], 1e-14);
      EXPECT_EQ(p.stride[side].time_s, p.stride[kLeftSide].time_s);
    }
    const double mean_m = 0.5 * (p.stride[0].length_m + p.stride[1].length_m);
    EXPECT_NEAR(mean_m * p.stride[0].time_s, 0.39 * 1.05, 1e-14);
  }
}

// Steps reach their limit at the same deflection as an adult's do.
TEST(OwnPace, TheLongestStepIsAsMuchLongerAsTheOwnOne) {
  const GaitLimits adult = gait_limits(0.9);
  const double adult_s = at(0.0, 0.8, {}, adult).stride[kLeftSide].time_s;
  EXPECT_NEAR(kOwn.max_step_time_s / 1.05, adult.max_step_time_s / adult_s, 1e-14);
  EXPECT_EQ(at(0.0, 0.02, {}, kOwn).stride[kLeftSide].time_s, kOwn.max_step_time_s);
}

TEST(OwnPace, TurnsAsTheAdultDoes) {
  const GaitLimits adult = gait_limits(0.9);
  const GaitParams turn = at(-1.0, 0.0, {}, kOwn);
  EXPECT_EQ(turn.turn_rate_rad_s, kQuickerInPlace * kMaxTurnRate_rad_s);
  EXPECT_EQ(turn.stride[kLeftSide].time_s, adult.turn_step_time_s);
  EXPECT_EQ(turn.stride[kLeftSide].length_m, 0.0);
  for (double y = 0.01; y <= 1.0; y += 0.01) {
    for (double x = 0.1; x <= 1.0; x += 0.1) {
      const double step_s = at(x, y, {}, kOwn).stride[kLeftSide].time_s;
      EXPECT_LE(step_s * x, adult.max_turning_step_time_s + 1e-12);
    }
  }
}

TEST(OwnPace, BackwardsFatigueAndStylesAreSharesOfIt) {
  const double speed_m_s = value_of(GaitKey::speed_m_s, at(0.0, 1.0, {}, kOwn));
  const GaitParams back = at(0.0, -1.0, {}, kOwn);
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, back), -kBackwardShare * speed_m_s, 1e-14);
  Style style;
  style.fatigue = 1.0;
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, at(0.0, 1.0, style, kOwn)),
              kFullFatigueLeaves * speed_m_s, 1e-14);
  style.fatigue = 0.0;
  style.stride[kLeftSide] = {.length = 0.5, .speed = 1.25};
  const StrideParams left = at(0.0, 0.8, style, kOwn).stride[kLeftSide];
  EXPECT_NEAR(left.length_m, 0.5 * 0.31, 1e-15);
  EXPECT_NEAR(left.time_s, 1.05 / 1.25, 1e-14);
}

// The numbers were printed by the version before walks had their own pace.
TEST(OwnPace, TheAdultsIsUnchanged) {
  for (const Side side : {kLeftSide, kRightSide}) EXPECT_EQ(kAdult.step_share[side], 1.0);
  EXPECT_EQ(kAdult.max_turning_step_time_s, kMaxStepTime_s);
  std::uint64_t bits = 0xcbf29ce484222325u;
  const auto add = [&bits](double x) {
    bits = (bits ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3u;
  };
  for (const double leg_m : {0.5, kReferenceLeg_m, 1.3}) {
    const GaitLimits limits = gait_limits(leg_m);
    for (int x = -8; x <= 8; ++x) {
      for (int y = -8; y <= 8; ++y) {
        Stick stick;
        stick.left = vec2(x / 8.0, y / 8.0);
        GaitOverrides overrides;
        for (const bool is_set : {false, true}) {
          overrides.value[0] = 0.1 * (x + y);
          overrides.is_set[0] = is_set;
          const GaitParams p = gait_params(stick, {}, overrides, limits);
          for (const StrideParams& step : p.stride) add(step.length_m), add(step.time_s);
        }
      }
    }
  }
  EXPECT_EQ(bits, 0x3ccf454ad9e1a481u);
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

static_assert(std::is_trivially_copyable_v<GaitParams>);
static_assert(std::is_trivially_copyable_v<GaitOverrides>);

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Stick pushed(double x, double y) {
  Stick stick;
  stick.left = vec2(x, y);
  return stick;
}

struct Given {
  GaitKey key;
  double value;
};
GaitOverrides overrides(std::initializer_list<Given> list) {
  GaitOverrides o;
  for (const Given& g : list) {
    o.value[static_cast<int>(g.key)] = g.value;
    o.is_set[static_cast<int>(g.key)] = true;
  }
  return o;
}
GaitParams with(const Stick& stick, std::initializer_list<Given> list,
                const StyleValues& style = {}, const GaitLimits& limits = kAdult) {
  return gait_params(stick, style, overrides(list), limits);
}

StyleValues limp() {
  StyleValues style;
  style.stride[kLeftSide] = {.length = 0.5, .speed = 1.3, .flight_height = 0.5};
  return style;
}

void expect_same(const GaitParams& a, const GaitParams& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  EXPECT_EQ(a.walking, b.walking);
  EXPECT_EQ(a.weight, b.weight);
  for (int k = 0; k < kGaitKeys; ++k) {
    const auto key = static_cast<GaitKey>(k);
    EXPECT_EQ(bits(value_of(key, a)), bits(value_of(key, b))) << info_of(key).name;
  }
  for (const Side side : {kLeftSide, kRightSide})
    EXPECT_EQ(bits(a.stride[side].time_s), bits(b.stride[side].time_s));
}

TEST(GaitOverrides, NothingTakenOverIsTheSticksBitByBit) {
  for (const double x : {0.0, -0.4, 1.0}) {
    for (const double y : {0.0, 0.02, 0.7, 1.0, -0.5}) {
      expect_same(with(pushed(x, y), {}, limp()), gait_params(pushed(x, y), limp(), kAdult));
    }
  }
}

// Length over cadence is 0.58 cm per step/min, so length^2 = 60 s * 0.0058 m min * speed.
TEST(GaitOverrides, ASpeedWalksWithoutTheStickAtTheWalkRatio) {
  for (const double speed_m_s : {0.5, 1.0, 1.5}) {
    const GaitParams p = with(pushed(0.0, 0.0), {{GaitKey::speed_m_s, speed_m_s}});
    EXPECT_TRUE(p.walking);
    EXPECT_NEAR(value_of(GaitKey::speed_m_s, p), speed_m_s, 1e-12);
    for (const StrideParams& step : p.stride)
      EXPECT_NEAR(step.length_m, std::sqrt(0.348 * speed_m_s), 1e-12);
    EXPECT_EQ(p.turn_rate_rad_s, 0.0);
    // The override replaces only the forward deflection.
    const GaitParams turning = with(pushed(-0.5, 0.9), {{GaitKey::speed_m_s, speed_m_s}});
    EXPECT_NEAR(value_of(GaitKey::speed_m_s, turning), speed_m_s, 1e-12);
    EXPECT_EQ(turning.turn_rate_rad_s, 0.5);
  }
}

TEST(GaitOverrides, ASpeedOf0StandsWhateverElseIsGiven) {
  const GaitParams p = with(pushed(0.7, 1.0), {{GaitKey::speed_m_s, 0.0},
                                               {GaitKey::stride_left_m, 0.6},
                                               {GaitKey::turn_rate_rad_s, 0.4},
                                               {GaitKey::hip_sway, 2.0}});
  EXPECT_FALSE(p.walking);
  EXPECT_EQ(p.turn_rate_rad_s, 0.0);
  EXPECT_EQ(p.stride[kLeftSide].length_m, 0.0);
  EXPECT_EQ(p.hip_sway, 2.0);
}

TEST(GaitOverrides, ALimpKeepsItsRhythmAtAGivenSpeed) {
  const GaitParams p = with(pushed(0.0, 0.0), {{GaitKey::speed_m_s, 1.2}}, limp());
  EXPECT_NEAR(p.stride[kLeftSide].length_m, 0.5 * p.stride[kRightSide].length_m, 1e-12);
  EXPECT_NEAR(p.stride[kLeftSide].time_s, p.stride[kRightSide].time_s / 1.3, 1e-12);
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, p), 1.2, 1e-12);
  EXPECT_EQ(p.stride[kLeftSide].flight_height, 0.5);
}

TEST(GaitOverrides, ATiredWalkerTakesShorterAndQuickerStepsAtAGivenSpeed) {
  StyleValues tired;
  tired.fatigue = 1.0;
  const Given speed = {GaitKey::speed_m_s, 1.0};
  const GaitParams fresh = with(pushed(0, 0), {speed}), p = with(pushed(0, 0), {speed}, tired);
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, p), 1.0, 1e-12);
  EXPECT_LT(p.stride[0].length_m, 0.8 * fresh.stride[0].length_m);
  EXPECT_LT(p.stride[0].time_s, 0.8 * fresh.stride[0].time_s);
}

TEST(GaitOverrides, SpeedSetsTheStepTimesFromGivenStrides) {
  const GaitParams p = with(
      pushed(0.0, 0.0),
      {{GaitKey::speed_m_s, 1.0}, {GaitKey::stride_left_m, 0.3}, {GaitKey::stride_right_m, 0.7}});
  EXPECT_EQ(p.stride[kLeftSide].length_m, 0.3);
  EXPECT_EQ(p.stride[kRightSide].length_m, 0.7);
  EXPECT_NEAR(p.stride[kLeftSide].time_s, 0.5, 1e-12);
  EXPECT_NEAR(p.stride[kRightSide].time_s, 0.5, 1e-12);
}

// Half the stick's shortest step time (0.7225 m at 1.5 m/s), twice its longest (1.1 s).
TEST(GaitOverrides, StepTimesStayWithinWhatAStickAndAStyleCanGive) {
  const GaitParams quick = with(
      pushed(0, 0),
      {{GaitKey::speed_m_s, 1.5}, {GaitKey::stride_left_m, 0.0}, {GaitKey::stride_right_m, 0.0}});
  const GaitParams slow = with(
      pushed(0, 0),
      {{GaitKey::speed_m_s, 0.01}, {GaitKey::stride_left_m, 0.7}, {GaitKey::stride_right_m, 0.7}});
  EXPECT_NEAR(quick.stride[0].time_s, 0.5 * std::sqrt(0.348 / 1.5), 1e-12);
  EXPECT_NEAR(slow.stride[0].time_s, 2.2, 1e-12);
  const GaitParams sharp = with(
      pushed(1, 0),
      {{GaitKey::speed_m_s, 0.01}, {GaitKey::stride_left_m, 0.7}, {GaitKey::stride_right_m, 0.7}});
  EXPECT_NEAR(sharp.stride[0].time_s, 1.1, 1e-12);
}

TEST(GaitOverrides, AStrideWithoutSpeedKeepsTheSticksTimeAndWaitsForTheStick) {
  const GaitParams stick = with(pushed(0.1, 0.6), {});
  const GaitParams p = with(pushed(0.1, 0.6), {{GaitKey::stride_right_m, 0.2}});
  EXPECT_EQ(p.stride[kRightSide].length_m, 0.2);
  EXPECT_EQ(p.stride[kRightSide].time_s, stick.stride[kRightSide].time_s);
  EXPECT_EQ(p.stride[kLeftSide].length_m, stick.stride[kLeftSide].length_m);
  EXPECT_FALSE(with(pushed(0.0, 0.0), {{GaitKey::stride_left_m, 0.6}}).walking);
  const GaitParams turning = with(pushed(0.8, 0.0), {{GaitKey::stride_left_m, 0.6}});
  EXPECT_TRUE(turning.walking);
  EXPECT_EQ(turning.stride[kLeftSide].length_m, 0.0);
}

TEST(GaitOverrides, ATurnRateAloneTurnsInPlaceAsTheStickSidewaysDoes) {
  expect_same(with(pushed(0.0, 0.0), {{GaitKey::turn_rate_rad_s, kQuickerInPlace * 0.25}}),
              with(pushed(-0.25, 0.0), {}));
  expect_same(with(pushed(-1.0, 0.0), {{GaitKey::turn_rate_rad_s, 0.0}}),
              with(pushed(0.0, 0.0), {}));
}

TEST(GaitOverrides, TheOtherFactorsAreTakenAsTheyAre) {
  const GaitParams p =
      with(pushed(0.0, 0.5), {{GaitKey::flight_left, 1.7}, {GaitKey::hip_bounce, 0.0}}, limp());
  EXPECT_EQ(p.stride[kLeftSide].flight_height, 1.7);
  EXPECT_EQ(p.stride[kRightSide].flight_height, 1.0);
  EXPECT_EQ(p.hip_bounce, 0.0);
  EXPECT_EQ(p.hip_sway, 1.0);
}

TEST(GaitOverrides, ValuesAreBoundedByTheCharacter) {
  const GaitLimits child = gait_limits(0.5 * kReferenceLeg_m);
  const GaitParams p = with(
      pushed(0, 0), {{GaitKey::speed_m_s, 20.0}, {GaitKey::turn_rate_rad_s, -50.0}}, {}, child);
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, p), child.max_speed_m_s, 1e-12);
  EXPECT_EQ(p.turn_rate_rad_s, -kMaxTurnRate_rad_s);
  EXPECT_EQ(range_of(GaitKey::speed_m_s, child).max, child.max_speed_m_s);
  EXPECT_NEAR(range_of(GaitKey::stride_left_m, child).max, 0.65 * kAdult.max_step_m, 1e-12);
}

TEST(GaitOverrides, WhatIsNoNumberCountsAsNotTakenOver) {
  for (const double odd : {kNan, kInf, -kInf}) {
    for (int k = 0; k < kGaitKeys; ++k) {
      expect_same(with(pushed(0.2, 0.6), {{static_cast<GaitKey>(k), odd}}),
                  with(pushed(0.2, 0.6), {}));
    }
  }
}

void expect_sane(const GaitParams& p, const GaitLimits& limits) {
  for (const StrideParams& step : p.stride) {
    EXPECT_TRUE(step.length_m >= 0.0 && step.length_m <= 1.3 * limits.max_step_m);
    EXPECT_TRUE(step.time_s >= 0.1 && step.time_s <= 2.0 * limits.max_step_time_s);
    EXPECT_TRUE(step.flight_height >= 0.0 && step.flight_height <= 3.0);
  }
  EXPECT_TRUE(std::fabs(p.turn_rate_rad_s) <= kQuickerInPlace * limits.max_turn_rate_rad_s);
  EXPECT_TRUE(p.hip_sway >= 0.0 && p.hip_sway <= 3.0);
  EXPECT_TRUE(p.hip_bounce >= 0.0 && p.hip_bounce <= 3.0);
}

TEST(GaitOverrides, AnyCombinationIsSane) {
  std::mt19937 random(5);
  const double values[] = {0.0,  -0.0,  1e-310, 1e-9,   0.01, 0.4,  1.0,  3.0,
                           20.0, 1e300, -1.0,   -1e300, kNan, kInf, -kInf};
  const double sticks[] = {0.0, 1e-310, 1e-6, 0.3, 1.0, -1.0, 5.0, 1e300};
  const auto any = [&random](const auto& list) { return list[random() % std::size(list)]; };
  for (int i = 0; i < 5000; ++i) {
    GaitOverrides o;
    for (int k = 0; k < kGaitKeys; ++k) {
      o.value[k] = any(values);
      o.is_set[k] = random() % 2 == 0;
    }
    StyleValues style = limp();
    style.fatigue = 0.5 * static_cast<double>(random() % 3);
    expect_sane(gait_params(pushed(any(sticks), any(sticks)), style, o, kAdult), kAdult);
    if (HasFailure()) FAIL() << "combination " << i;
  }
}

// The walk then ignores such a value (walk/sound_input_test).
TEST(GaitOverrides, AStickThatIsNoNumberGivesNoneWhereNothingReplacesIt) {
  for (const double odd : {kNan, kInf, -kInf}) {
    for (const Stick& stick : {pushed(odd, 0.6), pushed(0.2, odd)}) {
      const GaitParams p = gait_params(stick, StyleValues{}, kAdult);
      EXPECT_TRUE(std::isnan(p.turn_rate_rad_s) && std::isnan(p.stride[0].length_m) &&
                  std::isnan(p.stride[1].length_m));
      EXPECT_TRUE(check(p));
    }
    expect_same(
        with(pushed(odd, odd), {{GaitKey::speed_m_s, 1.0}, {GaitKey::turn_rate_rad_s, 0.2}}),
        with(pushed(0, 0), {{GaitKey::speed_m_s, 1.0}, {GaitKey::turn_rate_rad_s, 0.2}}));
  }
}

TEST(GaitOverrides, NamesLeadToTheirKeysAndBack) {
  for (int k = 0; k < kGaitKeys; ++k) {
    const auto key = static_cast<GaitKey>(k);
    EXPECT_EQ(gait_key(info_of(key).name), key);
    EXPECT_LT(info_of(key).min, info_of(key).max);
  }
  EXPECT_FALSE(gait_key(""));
  EXPECT_FALSE(gait_key("speed"));
}

}  // namespace
}  // namespace gaitpad
