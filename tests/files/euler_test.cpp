#include "files/euler.h"

#include <gtest/gtest.h>

#include <random>

namespace gaitpad {
namespace {

quat from_euler(const EulerOrder& order, const EulerAngles& angles_rad) {
  return rotation_about_axis(order[0], angles_rad[0]) *
         rotation_about_axis(order[1], angles_rad[1]) *
         rotation_about_axis(order[2], angles_rad[2]);
}
double angle_between(const quat& a, const quat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

TEST(Euler, TripleGivesTheRotationBackInEveryOrder) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-7.0, 7.0);
  for (const EulerOrder& order : kEulerOrders) {
    for (int i = 0; i < 2000; ++i) {
      const quat q = from_euler(order, {angle(random), angle(random), angle(random)});
      const EulerAngles previous = {angle(random), angle(random), angle(random)};
      EXPECT_LT(angle_between(q, from_euler(order, nearest_euler(order, q, previous))), 1e-7);
    }
  }
}

TEST(Euler, TheTripleItselfIsTheNearestToItself) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> angle(-7.0, 7.0);
  for (const EulerOrder& order : kEulerOrders) {
    for (int i = 0; i < 2000; ++i) {
      const EulerAngles a = {angle(random), angle(random), angle(random)};
      if (std::abs(std::cos(a[1])) < 1e-3) continue;
      const EulerAngles b = nearest_euler(order, from_euler(order, a), a);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-9);
    }
  }
}

TEST(Euler, AtThePoleTheFreeAngleStaysWhereItWas) {
  for (const EulerOrder& order : kEulerOrders) {
    for (const double pole : {0.5 * kPi, -0.5 * kPi}) {
      const EulerAngles a = {0.7, pole, -0.4};
      const EulerAngles b = nearest_euler(order, from_euler(order, a), {0.71, pole - 0.01, -0.4});
      EXPECT_LT(angle_between(from_euler(order, a), from_euler(order, b)), 1e-6);
      EXPECT_NEAR(b[0], 0.7, 0.011);
      EXPECT_NEAR(b[2], -0.4, 0.011);
    }
  }
}

TEST(Euler, ASweepThroughThePoleDoesNotFlip) {
  for (const EulerOrder& order : kEulerOrders) {
    EulerAngles previous = {};
    for (int i = 0; i <= 720; ++i) {
      const EulerAngles want = {0.3, i * kDegree, 0.2};
      const EulerAngles got = nearest_euler(order, from_euler(order, want), previous);
      if (i > 0) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], want[k], 1e-6) << i;
      }
      previous = got;
    }
  }
}

TEST(Euler, PoleClosenessIsTheSineOfTheSecondAngle) {
  for (const EulerOrder& order : kEulerOrders) {
    EXPECT_NEAR(pole_closeness(order, from_euler(order, {0.3, 0.9, -1.2})), std::sin(0.9), 1e-12);
  }
}

}  // namespace
}  // namespace gaitpad
