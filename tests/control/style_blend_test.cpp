#include <gtest/gtest.h>

#include "gaitpad/style.h"

namespace gaitpad {
namespace {

// All values as far as they go, the even ones' opposite.
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

// No key is left out, those that a style may gain later neither.
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
  StyleBlend blend = begun_blend(from, from, to);  // the longer one counts
  double before = 0.0, step = 0.0, largest = 0.0;
  for (int tick = 0; tick < 120; ++tick) {
    const double now = advance(blend, to, 1.0 / 240.0).fatigue;
    EXPECT_GE(now, before);
    EXPECT_LT(std::abs(now - before - step), 0.8 * 6.5 / (120.0 * 120.0));  // smoothstep's bend
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

}  // namespace
}  // namespace gaitpad
