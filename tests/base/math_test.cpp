#include "gaitpad/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gaitpad {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kTries = 50000;

// Distance of two numbers in units of the wanted value's last place.
double ulps(double got, double wanted) {
  const double size = std::max(std::abs(wanted), std::numeric_limits<double>::min());
  return std::abs(got - wanted) / (kEpsilon * std::exp2(std::floor(std::log2(size))));
}

struct Chance {
  std::mt19937_64 engine{20051};
  double in(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  // A random number of either sign, log-uniform between the exponents.
  double wide(double low_exponent, double high_exponent) {
    const double size = std::pow(10.0, in(low_exponent, high_exponent));
    return in(0.0, 1.0) < 0.5 ? -size : size;
  }
  vec3 direction() {
    for (;;) {
      const vec3 v(in(-1.0, 1.0), in(-1.0, 1.0), in(-1.0, 1.0));
      if (glm::length(v) > 0.1) return glm::normalize(v);
    }
  }
};

void expect_same_rotation(const quat& a, const quat& b, double tolerance) {
  EXPECT_NEAR(std::abs(glm::dot(a, b)), 1.0, tolerance);
}

TEST(SinCos, AreWithinTwoUlpOfTheStandardOnes) {
  Chance chance;
  for (int i = 0; i < kTries; ++i) {
    const double a = i % 2 ? chance.in(-20.0, 20.0) : chance.wide(-12.0, 5.0);
    const SinCos s = sin_cos(a);
    EXPECT_LE(ulps(s.sin, std::sin(a)), 2.0) << a;
    EXPECT_LE(ulps(s.cos, std::cos(a)), 2.0) << a;
  }
}

TEST(SinCos, AreExactlyOddAndEven) {
  Chance chance;
  for (int i = 0; i < 2000; ++i) {
    const double a = chance.wide(-6.0, 5.0);
    EXPECT_EQ(sin_cos(-a).sin, -sin_cos(a).sin);
    EXPECT_EQ(sin_cos(-a).cos, sin_cos(a).cos);
  }
  EXPECT_EQ(sin_cos(0.0).sin, 0.0);
  EXPECT_EQ(sin_cos(0.0).cos, 1.0);
}

TEST(SinCos, StayBoundedForWhatIsNoAngle) {
  for (double a : {std::numeric_limits<double>::quiet_NaN(),
                   std::numeric_limits<double>::infinity(), -1e300, 1e6}) {
    EXPECT_EQ(sin_cos(a).sin, 0.0);
    EXPECT_EQ(sin_cos(a).cos, 1.0);
  }
}

TEST(Atan2, IsWithinTwoUlpOfTheStandardOneInEveryQuadrant) {
  Chance chance;
  for (int i = 0; i < kTries; ++i) {
    const double y = chance.wide(-8.0, 8.0), x = chance.wide(-8.0, 8.0);
    EXPECT_LE(ulps(gaitpad::atan2(y, x), std::atan2(y, x)), 2.0) << y << ' ' << x;
  }
}

TEST(Atan2, KnowsTheAxes) {
  EXPECT_EQ(gaitpad::atan2(0.0, 0.0), 0.0);
  EXPECT_EQ(gaitpad::atan2(0.0, 2.0), 0.0);
  EXPECT_EQ(gaitpad::atan2(0.0, -2.0), kPi);
  EXPECT_EQ(gaitpad::atan2(3.0, 0.0), kPi / 2.0);
  EXPECT_EQ(gaitpad::atan2(-3.0, 0.0), -kPi / 2.0);
}

// (1 - x)(1 + x) keeps digits that 1 - x^2 would lose near +-1.
TEST(Acos, IsWithinThreeUlpOfTheStandardOne) {
  Chance chance;
  for (int i = 0; i < kTries; ++i) {
    const double x = i % 2 ? chance.in(-1.0, 1.0) : 1.0 - std::abs(chance.wide(-15.0, -1.0));
    EXPECT_LE(ulps(gaitpad::acos(x), std::acos(x)), 3.0) << x;
  }
}

TEST(Acos, ClampsItsArgument) {
  EXPECT_EQ(gaitpad::acos(1.5), 0.0);
  EXPECT_EQ(gaitpad::acos(-7.0), kPi);
}

TEST(Wrapped, IsTheSameDirectionWithinHalfATurn) {
  Chance chance;
  for (int i = 0; i < 20000; ++i) {
    const double a = chance.in(-1000.0, 1000.0), w = wrapped(a);
    EXPECT_LE(std::abs(w), kPi + 1e-12);
    EXPECT_NEAR(std::remainder(a - w, 2.0 * kPi), 0.0, 1e-12);
  }
  EXPECT_EQ(wrapped(0.0), 0.0);
}

TEST(Rotations, AboutTheAxesTurnRightHanded) {
  const double quarter = kPi / 2.0;
  EXPECT_LT(glm::distance(rotation_x(quarter) * kUp, kForward), 1e-15);
  EXPECT_LT(glm::distance(rotation_y(quarter) * kForward, kLeft), 1e-15);
  EXPECT_LT(glm::distance(rotation_z(quarter) * kLeft, kUp), 1e-15);
  expect_same_rotation(rotation_about(kUp, 0.7), rotation_y(0.7), 1e-15);
}

TEST(Rotations, VectorsGoBackAndForth) {
  Chance chance;
  for (int i = 0; i < 20000; ++i) {
    const double angle = i % 2 ? chance.in(0.0, kPi) : std::abs(chance.wide(-14.0, 0.4));
    const vec3 v = chance.direction() * angle;
    EXPECT_LT(glm::distance(rotation_vector(from_rotation_vector(v)), v), 1e-13 * (1.0 + angle));
  }
  EXPECT_EQ(rotation_vector(kIdentity), vec3(0.0));
}

TEST(Rotations, AQuaternionAndItsNegativeHaveOneVector) {
  const quat q = from_rotation_vector(vec3(0.3, -1.2, 0.5));
  EXPECT_LT(glm::distance(rotation_vector(q), rotation_vector(-q)), 1e-15);
}

TEST(Rotations, BetweenTwoDirectionsCarriesTheFirstToTheSecondTheShortestWay) {
  Chance chance;
  for (int i = 0; i < 20000; ++i) {
    const vec3 a = chance.direction(), b = chance.direction();
    const quat q = rotation_between(a, b);
    EXPECT_LT(glm::distance(q * a, b), 1e-9);
    EXPECT_NEAR(glm::length(rotation_vector(q)),
                std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)), 1e-9);
  }
}

TEST(Rotations, BetweenOppositeDirectionsIsHalfATurn) {
  for (const vec3& a : {kLeft, kUp, kForward}) {
    EXPECT_LT(glm::distance(rotation_between(a, -a) * a, -a), 1e-12);
  }
}

TEST(Rotations, NlerpGoesTheShorterWayBetweenItsEnds) {
  const quat from = rotation_y(0.2), to = rotation_y(1.0);
  expect_same_rotation(nlerp(from, to, 0.0), from, 1e-15);
  expect_same_rotation(nlerp(from, to, 1.0), to, 1e-15);
  expect_same_rotation(nlerp(from, to, 0.5), rotation_y(0.6), 1e-15);
  expect_same_rotation(nlerp(from, -to, 0.5), rotation_y(0.6), 1e-15);
  EXPECT_NEAR(glm::length(nlerp(from, to, 0.3)), 1.0, 1e-15);
}

// Half turns about the axes, and about directions between them, take each of the four branches.
TEST(Rotations, AxesGoBackAndForth) {
  Chance chance;
  for (int i = 0; i < 20000; ++i) {
    const double angle = i % 3 ? chance.in(0.0, kPi) : kPi;
    const quat q = rotation_about(chance.direction(), angle);
    const quat back = from_axes(q * kLeft, q * kUp, q * kForward);
    expect_same_rotation(back, q, 1e-14);
  }
  for (const vec3& axis : {kLeft, kUp, kForward}) {
    const quat q = rotation_about(axis, kPi);
    expect_same_rotation(from_axes(q * kLeft, q * kUp, q * kForward), q, 1e-15);
  }
}

TEST(Headings, AreZeroAlongZAndPositiveToTheLeft) {
  EXPECT_EQ(heading_direction(0.0), kForward);
  EXPECT_LT(glm::distance(heading_direction(kPi / 2.0), kLeft), 1e-15);
  for (double h = -3.1; h < 3.1; h += 0.1) {
    EXPECT_NEAR(heading_of(heading_direction(h)), h, 1e-15);
    EXPECT_LT(glm::distance(rotation_y(h) * kForward, heading_direction(h)), 1e-15);
  }
}

TEST(Smoothstep, RisesFromZeroToOneWithLevelEnds) {
  EXPECT_EQ(smoothstep(2.0, 4.0, 1.0), 0.0);
  EXPECT_EQ(smoothstep(2.0, 4.0, 3.0), 0.5);
  EXPECT_EQ(smoothstep(2.0, 4.0, 9.0), 1.0);
  EXPECT_NEAR(smoothstep(0.0, 1.0, 1e-4), 3e-8, 1e-11);
}

}  // namespace
}  // namespace gaitpad
