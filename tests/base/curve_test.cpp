#include "gaitpad/curve.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

double follow(double goal, double time_constant_s, double dt_s, double end_s) {
  const Damping damping(time_constant_s, dt_s);
  double x = 0.0, v = 0.0;
  for (double t = 0.0; t < end_s; t += dt_s) {
    const double before = x;
    v = (v + (goal - x) * damping.pull) * damping.keep;
    x += v * damping.dt_s;
    EXPECT_GE(x, before - 1e-15) << dt_s;
    EXPECT_LE(x, goal + 1e-12) << dt_s;
  }
  return x;
}
TEST(Damping, LeadsToAStepWithoutOvershootWhateverTheTick) {
  for (double dt_s : {1.0 / 1000.0, 1.0 / 240.0, 1.0 / 30.0, 1.0})
    EXPECT_NEAR(follow(1.0, 0.12, dt_s, 4.0), 1.0, dt_s < 0.5 ? 1e-9 : 0.05) << dt_s;
}
// A critically damped filter stands at 1 - 2/e after one time constant.
TEST(Damping, HasItsTimeConstant) {
  EXPECT_NEAR(follow(1.0, 0.12, 1e-5, 0.12), 1.0 - 2.0 * std::exp(-1.0), 1e-3);
}

TEST(SoftPositive, IsThePositivePartOutsideItsWidthAndNeverLess) {
  for (double x = -1.0; x <= 1.0; x += 0.01) {
    const double soft = soft_positive(x, 0.1), hard = std::max(x, 0.0);
    EXPECT_GE(soft, hard - 1e-15);
    EXPECT_LE(soft, hard + 0.1 / 4.0 + 1e-15);
    if (std::abs(x) >= 0.1) {
      EXPECT_NEAR(soft, hard, 1e-15);
    }
  }
}

}  // namespace
}  // namespace gaitpad
