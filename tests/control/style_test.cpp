#include "gaitpad/style.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gaitpad {
namespace {

TEST(StyleValue, OneLegOrBothChange) {
  StyleValues style;
  EXPECT_TRUE(set_value(style, "legs.stride_length", 0.8));
  EXPECT_TRUE(set_value(style, "right_leg.weight.hip", 0.25));
  EXPECT_TRUE(set_value(style, "right_leg.weight.hip_z", 0.75));
  EXPECT_EQ(style.stride[kLeftSide].length, 0.8);
  EXPECT_EQ(style.stride[kRightSide].length, 0.8);
  EXPECT_EQ(style.weight[kLeftSide], kEvenWeights);
  EXPECT_EQ(style.weight[kRightSide], (LegWeights{0.25, 0.75, 0.25, 1, 1, 1, 1}));
  EXPECT_EQ(value_of(style, "legs.weight.hip"), 1.0);
}

TEST(StyleValue, WhatIsUnknownOrOutOfBoundsChangesNothing) {
  StyleValues style;
  const char* const names[] = {"",
                               ".",
                               "legs",
                               "legs.",
                               "legs.weight",
                               "legs.weight.",
                               "legs.hip",
                               "weight.hip",
                               "arms.weight.hip",
                               "legs.weight.hip.x",
                               "legs.fatigue",
                               "fatigue.",
                               "hip_sway.x",
                               "left_leg.weight.elbow",
                               "arms",
                               "arms.carry",
                               "hands.weight.shoulder",
                               "spine.weight",
                               "spine.weight.",
                               "spine.weightlower",
                               "head.swing",
                               "heads.look",
                               " fatigue"};
  for (const char* name : names) {
    EXPECT_FALSE(set_value(style, name, 0.5)) << name;
    EXPECT_FALSE(value_of(style, name)) << name;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const StyleKey& key : style_keys()) {
    for (const double value : {key.min - 1e-9, key.max + 1e-9, nan, HUGE_VAL})
      EXPECT_FALSE(set_value(style, key.name, value)) << key.name;
  }
  EXPECT_TRUE(style == StyleValues{});
}

TEST(StyleValue, NoLimbIsLockedAsAWhole) {
  StyleValues style;
  for (const auto& [first, second, third] :
       {std::tuple("left_leg.weight.hip", "left_leg.weight.knee", "left_leg.weight.ankle"),
        {"left_arm.weight.shoulder", "left_arm.weight.elbow", "left_arm.weight.wrist"},
        {"spine.weight.upper", "spine.weight.upper", "spine.weight.lower"}}) {
    EXPECT_TRUE(set_value(style, first, 0.0)) << first;
    EXPECT_TRUE(set_value(style, second, 0.0)) << second;
    EXPECT_FALSE(set_value(style, third, 0.0)) << third;
  }
  EXPECT_FALSE(set_value(style, "legs.weight.ankle", 0.0)) << "the right one could, the left not";
  EXPECT_EQ(value_of(style, "right_leg.weight.ankle"), 1.0);
  EXPECT_EQ(value_of(style, "right_arm.weight.shoulder"), 1.0);
  EXPECT_TRUE(set_value(style, "left_leg.weight.ankle_y", 0.0));
}

// A style with every value at the end of its range that is farther from the even style's.
StyleValues extreme() {
  StyleValues style;
  for (const StyleKey& key : style_keys()) EXPECT_TRUE(set_value(style, key.name, key.max));
  for (const StyleKey& key : style_keys()) {
    const auto has = [&](const char* part) { return key.name.find(part) != std::string::npos; };
    if (!has("weight") || has("ankle") || has("elbow") || has("upper")) continue;
    EXPECT_TRUE(set_value(style, key.name, key.min)) << key.name;
  }
  return style;
}

// Every key is covered, including keys added later.
TEST(StyleBlend, EveryValueIsHalfWayAtHalfTheShare) {
  const StyleValues from, to = extreme();
  const StyleValues half = mixed(from, to, 0.5);
  for (const StyleKey& key : style_keys()) {
    const double a = *value_of(from, key.name), b = *value_of(to, key.name);
    EXPECT_NEAR(*value_of(half, key.name), 0.5 * (a + b), 1e-12) << key.name;
  }
  EXPECT_TRUE(mixed(from, to, 0.0) == from);
  EXPECT_TRUE(mixed(from, to, 1.0) == to);
}

TEST(StyleBlend, WithoutATimeTheNextTickHasTheNewStyle) {
  const StyleValues from, to = mixed(from, extreme(), 0.3);
  StyleValues at_once = to;
  at_once.blend_s = 0.0;
  StyleBlend blend = begun_blend(from, from, at_once);
  EXPECT_TRUE(advance(blend, at_once, 1.0 / 240.0) == at_once);
}

TEST(StyleBlend, GoesSmoothlyAndEndsExactly) {
  StyleValues from, to;
  from.blend_s = 0.5;
  to.fatigue = 0.8, to.blend_s = 0.25;
  StyleBlend blend = begun_blend(from, from, to);  // the longer of two blending times is used
  double before = 0.0, step = 0.0, largest = 0.0;
  for (int tick = 0; tick < 120; ++tick) {
    const double now = advance(blend, to, 1.0 / 240.0).fatigue;
    EXPECT_GE(now, before);
    // Largest second difference of the smoothstep curve.
    EXPECT_LT(std::abs(now - before - step), 0.8 * 6.5 / (120.0 * 120.0));
    step = now - before, before = now;
    largest = std::max(largest, step);
    if (tick == 59) {
      EXPECT_NEAR(now, 0.4, 1e-12);
    }
  }
  EXPECT_NEAR(largest, 0.8 * 1.5 / 120.0, 1e-4);
  EXPECT_EQ(advance(blend, to, 1.0 / 240.0).fatigue, 0.8);
}

TEST(StyleBlend, AChangeInTheMiddleGoesOnFromWhatIsInForce) {
  StyleValues even, tired;
  even.blend_s = 1.0;
  tired.fatigue = 1.0;
  StyleBlend blend = begun_blend(even, even, tired);
  const StyleValues half = advance(blend, tired, 0.5);
  EXPECT_NEAR(half.fatigue, 0.5, 1e-12);
  blend = begun_blend(half, tired, even);
  EXPECT_NEAR(advance(blend, even, 1.0 / 240.0).fatigue, 0.5, 1e-4);
}

constexpr double kTick_s = 1.0 / 240.0;

StyleValues tiring() {
  StyleValues style;
  style.fatigue_per_100_m = 0.5;
  style.fatigue_recovery_per_s = 0.02;
  return style;
}

TEST(Fatigue, GrowsWithTheWayAndNotWithTheTime) {
  double slow = 0.0, fast = 0.0;
  for (int k = 0; k < 4000; ++k) slow = tired(slow, tiring(), 0.01, false, kTick_s);
  for (int k = 0; k < 1000; ++k) fast = tired(fast, tiring(), 0.04, false, kTick_s);
  EXPECT_NEAR(slow, 0.2, 1e-9);
  EXPECT_NEAR(fast, 0.2, 1e-9);
}

TEST(Fatigue, FadesAtRestAndStaysWithinItsBounds) {
  double now = 0.2;
  for (int k = 0; k < 240; ++k) now = tired(now, tiring(), 0.0, true, kTick_s);
  EXPECT_NEAR(now, 0.18, 1e-9);
  for (int k = 0; k < 240 * 60; ++k) now = tired(now, tiring(), 0.0, true, kTick_s);
  EXPECT_EQ(now, 0.0);
  for (int k = 0; k < 1000; ++k) now = tired(now, tiring(), 1.0, false, kTick_s);
  EXPECT_EQ(now, 1.0);
}

TEST(Fatigue, AddsToTheStylesOwnOnlyWithAModel) {
  StyleValues style;
  style.fatigue = 0.3;
  EXPECT_TRUE(with_fatigue(style, 0.5) == style);
  EXPECT_EQ(tired(0.4, style, 100.0, false, kTick_s), 0.4);
  StyleValues model = tiring();
  model.fatigue = 0.3;
  EXPECT_EQ(with_fatigue(model, 0.5).fatigue, 0.8);
  EXPECT_EQ(with_fatigue(model, 0.9).fatigue, 1.0);
}

}  // namespace
}  // namespace gaitpad
