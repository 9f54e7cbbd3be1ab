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

TEST(Hermite, BasisCarriesOneValueOrSlopeEach) {
  constexpr double kStep = 1e-6;
  const auto slope = [](double (*f)(double), double s) {
    return (f(s + kStep) - f(s - kStep)) / (2.0 * kStep);
  };
  const auto expect = [&](double (*f)(double), double p0, double v0, double p1, double v1) {
    EXPECT_NEAR(f(0.0), p0, 1e-15);
    EXPECT_NEAR(f(1.0), p1, 1e-15);
    EXPECT_NEAR(slope(f, 0.0), v0, 1e-9);
    EXPECT_NEAR(slope(f, 1.0), v1, 1e-9);
  };
  expect([](double s) { return h00(s); }, 1, 0, 0, 0);
  expect([](double s) { return h10(s); }, 0, 1, 0, 0);
  expect([](double s) { return h11(s); }, 0, 0, 0, 1);
}

// From place 1 and speed 2 to place 4 and speed -1 in 0.5 s, in 60 ticks.
TEST(Approach, FollowsOneCubicWhileTheGoalStays) {
  constexpr int kTicks = 60;
  constexpr double kTime = 0.5, kDt = kTime / kTicks;
  double x = 1.0, v = 2.0;
  for (int i = 0; i < kTicks; ++i) {
    const double s = static_cast<double>(i) / kTicks;
    const double cubic = 4.0 - 3.0 * h00(s) + 2.0 * kTime * h10(s) - 1.0 * kTime * h11(s);
    EXPECT_NEAR(x, cubic, 1e-12) << "tick " << i;
    approach(x, v, 4.0, -1.0, kTime - i * kDt, kDt);
  }
  EXPECT_NEAR(x, 4.0, 1e-12);
  EXPECT_NEAR(v, -1.0, 1e-11);
}

TEST(Approach, BendsWithoutAJumpWhenTheGoalMoves) {
  constexpr int kTicks = 100;
  double x = 0.0, v = 0.0, before = 0.0, greatest = 0.0;
  for (int i = 0; i < kTicks; ++i) {
    approach(x, v, i < 50 ? 1.0 : 0.6, 0.0, (kTicks - i) * 0.01, 0.01);
    greatest = std::max(greatest, std::abs(x - before));
    before = x;
  }
  EXPECT_NEAR(x, 0.6, 1e-12);
  EXPECT_LT(greatest, 0.03);
}

TEST(Fade, StartsWithItsValueAndSlopeAndEndsLevelAtZero) {
  const Fade fade = {0.4, -3.0, 2.0};
  constexpr double kStep = 1e-6;
  EXPECT_EQ(fade.at(0.0), 0.4);
  EXPECT_NEAR((fade.at(kStep) - fade.at(0.0)) / kStep, -3.0, 1e-4);
  EXPECT_NEAR(fade.at(2.0 - kStep), 0.0, 1e-9);
  EXPECT_EQ(fade.at(2.0), 0.0);
  EXPECT_EQ(fade.at(100.0), 0.0);
}

TEST(Fade, OfNothingIsNothing) {
  for (double x : {0.0, 0.5, 1.0, 7.0}) EXPECT_EQ(Fade{}.at(x), 0.0);
}

TEST(Damped, ReachesAStepWithoutOvershootWhateverTheTick) {
  for (double dt : {1.0 / 1000.0, 1.0 / 240.0, 1.0 / 30.0, 1.0}) {
    Damped<double> filter;
    double before = 0.0;
    for (double t = 0.0; t < 4.0; t += dt) {
      filter.advance(1.0, 0.12, dt);
      EXPECT_GE(filter.x, before - 1e-15) << dt;
      EXPECT_LE(filter.x, 1.0 + 1e-12) << dt;
      before = filter.x;
    }
    EXPECT_NEAR(filter.x, 1.0, dt < 0.5 ? 1e-9 : 0.05) << dt;
  }
}

// A critically damped filter stands at 1 - 2/e after one time constant.
TEST(Damped, HasItsTimeConstant) {
  Damped<double> filter;
  constexpr double kDt = 1e-5;
  for (int i = 0; i < 12000; ++i) filter.advance(1.0, 0.12, kDt);
  EXPECT_NEAR(filter.x, 1.0 - 2.0 * std::exp(-1.0), 1e-3);
}

TEST(Damped, LeavesWhatHasArrivedExactlyWhereItIs) {
  Damped<double> filter{0.3, 0.0};
  for (int i = 0; i < 100; ++i) filter.advance(0.3, 0.12, 1.0 / 240.0);
  EXPECT_EQ(filter.x, 0.3);
}

TEST(SoftMin, IsTheLesserOneOutsideItsWidthAndNeverMore) {
  for (double b = -1.0; b <= 1.0; b += 0.01) {
    const double soft = soft_min(0.2, b, 0.1), hard = std::min(0.2, b);
    EXPECT_LE(soft, hard + 1e-15);
    EXPECT_GE(soft, hard - 0.1 / 4.0 - 1e-15);
    if (std::abs(b - 0.2) >= 0.1) {
      EXPECT_NEAR(soft, hard, 1e-15);
    }
    EXPECT_NEAR(soft, soft_min(b, 0.2, 0.1), 1e-15);
    EXPECT_NEAR(soft_max(-0.2, -b, 0.1), -soft, 1e-15);
  }
}

TEST(SoftMin, HasNoKink) {
  constexpr double kStep = 1e-4;
  double before = 1.0;
  for (double b = -0.5; b < 0.5; b += kStep) {
    const double slope = (soft_min(0.0, b + kStep, 0.1) - soft_min(0.0, b, 0.1)) / kStep;
    EXPECT_NEAR(slope, before, 0.51 * kStep / 0.1 + 1e-9);
    before = slope;
  }
}

TEST(EndSlope, IsExactOnParabolas) {
  EXPECT_NEAR(end_slope(parabola(0.0), parabola(1.0), parabola(2.0)), -1.3 + 4.2 * 2.0, 1e-13);
}

}  // namespace
}  // namespace gaitpad
