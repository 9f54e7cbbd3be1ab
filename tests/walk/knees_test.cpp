// Knees that are nearly straight: the hips give way by little, and come back.
#include "walk/knees.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/walk/made_walker.h"
#include "walk/tables.h"

namespace gaitpad {
namespace {

constexpr double kDt_s = 1.0 / 240.0;

class Knees : public testing::Test {
 protected:
  // Hips with both legs straight down; the ankles are so far below that the knees bend as given.
  static double span_m(double knee_deg) {  // by the law of cosines
    const double a = adult().leg[kLeftSide].model.thigh_m, b = adult().leg[kLeftSide].model.shank_m;
    return std::sqrt(a * a + b * b + 2.0 * a * b * std::cos(knee_deg * kDegree));
  }
  // One tick; returns by how much the hips were raised.
  float tick(double swing_deg, double stand_deg) {
    Pelvis<float> pelvis;
    pelvis.place_m.y = 1.0f;
    Vec<float> ankle_m[2];
    for (int k : {0, 1})
      ankle_m[k].y = 1.0f - static_cast<float>(span_m(k == 0 ? swing_deg : stand_deg));
    ease_knees(tables_of(adult(), kDt_s), Time<float>{}, ankle_m, change_, pelvis);
    return pelvis.place_m.y - 1.0f;
  }
  double knee_deg(int k) const { return change_.knee_rad[0][k] / kDegree; }

  Change<float> change_;
};

TEST_F(Knees, ThatMoveEvenlyLeaveTheHipsAlone) {
  for (int n = 0; n < 20; ++n) {
    EXPECT_EQ(tick(4.0 + 0.4 * n, 40.0 - n), 0.0f) << n;
    EXPECT_NEAR(knee_deg(0), 4.0 + 0.4 * n, 0.01);
  }
}

TEST_F(Knees, ThatJumpNearlyStraightTurnByABoundedDifference) {
  tick(6.0, 40.0), tick(6.0, 40.0);
  // From 6 to 9 degrees within a tick; 1 degree is the bound.
  const float raised_m = tick(9.0, 40.0);
  EXPECT_NEAR(knee_deg(0), 7.0, 0.02);
  EXPECT_NEAR(raised_m, span_m(7.0) - span_m(9.0), 2e-5);
  EXPECT_LT(std::abs(raised_m), 0.002f);
}

TEST_F(Knees, GiveTheHipsBackSoftly) {
  tick(6.0, 40.0), tick(6.0, 40.0);
  double last = tick(8.0, 40.0), rate = last;
  EXPECT_NE(last, 0.0);
  for (int n = 0; n < 40; ++n) {
    const double now = tick(8.0, 40.0);
    EXPECT_LT(std::abs(now - last - rate), span_m(8.0) - span_m(9.0)) << n;  // 1 degree's
    rate = now - last, last = now;
  }
  EXPECT_EQ(last, 0.0);
}

TEST_F(Knees, ThatBendFartherMayTurnAsTheyAreAsked) {
  tick(60.0, 40.0), tick(60.0, 40.0);
  EXPECT_EQ(tick(63.0, 40.0), 0.0f);
}

}  // namespace
}  // namespace gaitpad
