#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>

#include "gaitpad/control.h"

namespace gaitpad {
namespace {

static_assert(std::is_trivially_copyable_v<GaitOverrides>);

const GaitLimits kAdult = gait_limits(kReferenceLeg_m);
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
  }
}

TEST(GaitOverrides, ASpeedTakesThePlaceOfTheForwardDeflectionAlone) {
  const GaitParams p = with(pushed(-0.5, 0.9), {{GaitKey::speed_m_s, 0.6}});
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, p), 0.6, 1e-12);
  EXPECT_EQ(p.turn_rate_rad_s, 0.5);
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

TEST(GaitOverrides, AStrideWithoutSpeedKeepsTheSticksTime) {
  const GaitParams stick = with(pushed(0.1, 0.6), {});
  const GaitParams p = with(pushed(0.1, 0.6), {{GaitKey::stride_right_m, 0.2}});
  EXPECT_EQ(p.stride[kRightSide].length_m, 0.2);
  EXPECT_EQ(p.stride[kRightSide].time_s, stick.stride[kRightSide].time_s);
  EXPECT_EQ(p.stride[kLeftSide].length_m, stick.stride[kLeftSide].length_m);
}

TEST(GaitOverrides, AStrideWaitsForTheStick) {
  const GaitParams standing = with(pushed(0.0, 0.0), {{GaitKey::stride_left_m, 0.6}});
  EXPECT_FALSE(standing.walking);
  const GaitParams turning = with(pushed(0.8, 0.0), {{GaitKey::stride_left_m, 0.6}});
  EXPECT_TRUE(turning.walking);
  EXPECT_EQ(turning.stride[kLeftSide].length_m, 0.0);
}

TEST(GaitOverrides, ATurnRateAloneTurnsInPlaceAsTheStickSidewaysDoes) {
  expect_same(with(pushed(0.0, 0.0), {{GaitKey::turn_rate_rad_s, 0.25}}),
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
  EXPECT_TRUE(std::fabs(p.turn_rate_rad_s) <= limits.max_turn_rate_rad_s);
  EXPECT_TRUE(p.hip_sway >= 0.0 && p.hip_sway <= 3.0);
  EXPECT_TRUE(p.hip_bounce >= 0.0 && p.hip_bounce <= 3.0);
}

TEST(GaitOverrides, AnyCombinationIsSane) {
  std::mt19937 random(5);
  const double values[] = {0.0,  -0.0,  1e-310, 1e-9,   0.01, 0.4,  1.0,  3.0,
                           20.0, 1e300, -1.0,   -1e300, kNan, kInf, -kInf};
  const double sticks[] = {0.0, 1e-310, 1e-6, 0.3, 1.0, -1.0, kNan, kInf};
  const auto any = [&random](const auto& list) { return list[random() % std::size(list)]; };
  for (int i = 0; i < 50000; ++i) {
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
