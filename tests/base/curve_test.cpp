#include "gaitpad/curve.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

double parabola(double x) { return 0.7 - 1.3 * x + 2.1 * x * x; }

TEST(CatmullRom, MeetsTheInnerSamplesAndIsExactOnParabolas) {
  for (double t = 0.0; t <= 1.0; t += 0.05) {
    const double p = catmull_rom(parabola(-1.0), parabola(0.0), parabola(1.0), parabola(2.0), t);
    EXPECT_NEAR(p, parabola(t), 1e-14);
  }
  EXPECT_EQ(catmull_rom(5.0, 1.0, 2.0, -3.0, 0.0), 1.0);
  EXPECT_EQ(catmull_rom(5.0, 1.0, 2.0, -3.0, 1.0), 2.0);
}

PeriodicTable<32> sine_table() {
  PeriodicTable<32> table;
  for (int i = 0; i < 32; ++i) table.value[i] = sin_cos(2.0 * kPi * i / 32).sin;
  return table;
}

TEST(PeriodicTable, RepeatsEveryTurnAlsoBackwards) {
  const PeriodicTable<32> table = sine_table();
  for (double phase = 0.0; phase < 1.0; phase += 0.013) {
    EXPECT_NEAR(table.at(phase + 3.0), table.at(phase), 1e-13);
    EXPECT_NEAR(table.at(phase - 5.0), table.at(phase), 1e-13);
  }
}

TEST(PeriodicTable, FollowsASmoothFunctionWithoutAStepAtTheSeam) {
  const PeriodicTable<32> table = sine_table();
  for (double phase = -1.0; phase < 1.0; phase += 0.0037) {
    EXPECT_NEAR(table.at(phase), sin_cos(2.0 * kPi * phase).sin, 1e-3);
  }
  const double h = 1e-6;
  EXPECT_NEAR((table.at(h) - table.at(0.0)) / h, (table.at(0.0) - table.at(-h)) / h, 1e-3);
}

TEST(PeriodicTable, HoldsAtPhasesThatRoundUpToAWholeTurn) {
  const PeriodicTable<32> table = sine_table();
  EXPECT_NEAR(table.at(-1e-18), 0.0, 1e-12);
  EXPECT_NEAR(table.at(std::nextafter(1.0, 0.0)), 0.0, 1e-12);
}

TEST(Curve, HasItsEndsItsSlopesAndNothingBeyond) {
  Curve<9> curve;
  for (int i = 0; i < 9; ++i) curve.value[i] = 2.0 + 3.0 * i / 8.0;
  EXPECT_EQ(curve.at(0.0), 2.0);
  EXPECT_EQ(curve.at(1.0), 5.0);
  EXPECT_EQ(curve.at(-4.0), 2.0);
  EXPECT_EQ(curve.at(4.0), 5.0);
  EXPECT_NEAR(curve.at(0.3), 2.9, 1e-14);
  EXPECT_NEAR(curve.start_slope(), 3.0, 1e-13);
  EXPECT_NEAR(curve.end_slope(), 3.0, 1e-13);
}

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
