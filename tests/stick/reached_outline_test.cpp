#include "stick/reached_outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

// The stick is turned by 10 degrees a frame. The error is that of gamepad testers: 0 % for a circle
// of radius 1, 20.5 % for a full square; after ten seconds nothing is left.
TEST(ReachedOutline, HasTheErrorOfItsGateAndIsForgotten) {
  constexpr int kRate_hz = 240;
  const auto turned = [](auto gate) {
    ReachedOutline reached;
    vec2 before = gate(0.0);
    for (int k = 0; k <= 144; ++k) {  // four turns of 36 frames
      const vec2 now = gate(k * 10.0 * kDegree + (k / 36) * 2.5 * kDegree);
      reached.add(before, now, k, kRate_hz);
      before = now;
    }
    return reached;
  };
  auto circle = turned([](double a) { return 0.95 * vec2(std::cos(a), std::sin(a)); });
  ASSERT_TRUE(circle.error());
  EXPECT_NEAR(*circle.error(), 5.0, 0.01);
  const auto square = turned([](double a) {
    const vec2 p(std::cos(a), std::sin(a));
    return p / std::max(std::abs(p.x), std::abs(p.y));
  });
  ASSERT_TRUE(square.error());
  EXPECT_NEAR(*square.error(), 20.5, 1.0);
  circle.add(vec2(0.0), vec2(0.0), 144 + 10 * kRate_hz + 1, kRate_hz);
  EXPECT_FALSE(circle.error());
}

}  // namespace
}  // namespace gaitpad
