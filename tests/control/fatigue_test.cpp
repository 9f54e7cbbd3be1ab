#include <gtest/gtest.h>

#include "gaitpad/style.h"

namespace gaitpad {
namespace {

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
