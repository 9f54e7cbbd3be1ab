// Where hands are and how arms swing, on the built-in motion.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "animation/made_body.h"

namespace gaitpad {
namespace {

struct Range {
  double low = 1e9, high = -1e9;
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  double width() const { return high - low; }
};

Range arm_arc(double length_m, double time_s) {
  MadeBody walker;
  walker.pace(1500, length_m, time_s);
  Range arc;
  for (int i = 0; i < 400; ++i) {
    walker.pace(1, length_m, time_s);
    arc.add(walker.swing(kLeftSide));
  }
  return arc;
}

TEST(WalkBody, HandsCarryAtTheirPlacesBeforeTheChest) {
  const StyleValues carry =
      style({{"hands.carry", 1.0}, {"hands.x_m", 0.1}, {"hands.y_m", -0.25}, {"hands.z_m", 0.4}});
  MadeBody walker;
  walker.walk(1200, carry, 0.7);
  const double scale = adult().body.arm_m / kReferenceArm_m;
  for (int i = 0; i < 300; ++i) {
    walker.step(carry, 0.7);
    vec3 across = walker.shoulder(kLeftSide) - walker.shoulder(kRightSide);
    across = glm::normalize(vec3(across.x, 0.0, across.z));
    const vec3 ahead = glm::cross(across, kUp);
    for (const Side side : {kLeftSide, kRightSide}) {
      const vec3 place = walker.shoulders() + scale * ((side == kLeftSide ? 0.1 : -0.1) * across -
                                                       0.25 * kUp + 0.4 * ahead);
      EXPECT_LT(glm::distance(walker.hand(side), place), 0.001);
    }
  }
}

TEST(WalkBody, ACarriedTrayStaysLevel) {
  const StyleValues carry = style({{"hands.carry", 1.0}});
  MadeBody walker;
  walker.walk(1200, carry, 0.8);
  Range wide;
  for (int i = 0; i < 300; ++i) {
    walker.step(carry, 0.8, 0.3);
    EXPECT_NEAR(walker.hand(kLeftSide).y, walker.hand(kRightSide).y, 0.001);
    wide.add(glm::distance(walker.hand(kLeftSide), walker.hand(kRightSide)));
  }
  EXPECT_LT(wide.width(), 0.001);
}

TEST(WalkBody, ElbowsOfCarryingArmsPointDownAndOut) {
  const StyleValues carry = style({{"hands.carry", 1.0}});
  MadeBody walker;
  walker.walk(1200, carry, 0.8);
  for (const Side side : {kLeftSide, kRightSide}) {
    const vec3 elbow = walker.at(adult().body.arm[side].joints.elbow);
    EXPECT_LT(elbow.y, walker.shoulder(side).y - 0.2);
    EXPECT_GT((elbow.x - walker.shoulders().x) * (side == kLeftSide ? 1.0 : -1.0), 0.15);
  }
}

TEST(WalkBody, AHandSlidesAlongARailOfConstantHeight) {
  const StyleValues rail = style(
      {{"left_hand.rail", 1.0}, {"left_hand.rail_height_m", 0.95}, {"left_hand.rail_side_m", 0.4}});
  MadeBody walker;
  walker.walk(1200, rail, 0.7);
  const double scale = adult().body.shoulder_height_m / kReferenceShoulder_m;
  for (int i = 0; i < 300; ++i) {
    walker.step(rail, 0.7);
    EXPECT_NEAR(walker.hand(kLeftSide).y, 0.95 * scale, 0.001);
    EXPECT_NEAR(walker.hand(kLeftSide).x, 0.4 * scale, 0.001);
  }
}

// Twelve steps up: the rail is a straight line of the stairs' slope, the hand on it does not bump.
TEST(WalkBody, ARailRisesEvenlyOverStairs) {
  Terrain stairs;
  ASSERT_FALSE(add_section(stairs, FlatSection{3.0}));
  ASSERT_FALSE(add_section(stairs, StairsSection{0.17, 0.28, 12}));
  WalkModel model = adult();
  model.terrain = std::make_shared<const Terrain>(stairs);
  const StyleValues rail = style({{"right_hand.rail", 1.0}});
  MadeBody walker(model);
  const double scale = model.body.shoulder_height_m / kReferenceShoulder_m;
  std::vector<double> height;
  int on_stairs = 0;
  for (int i = 0; i < 4800; ++i) {
    walker.step(rail, 0.5);
    const vec3 hips = walker.state().hips_m;
    if (hips.z < 4.0 || hips.z > 5.5) continue;
    ++on_stairs;
    const double line = 0.17 / 0.28 * (hips.z - 3.0) + 0.085;  // the treads' mean
    EXPECT_NEAR(walker.hand(kRightSide).y, line + 0.9 * scale, 0.03);
    height.push_back(walker.hand(kRightSide).y);
  }
  EXPECT_GT(on_stairs, 200);
  for (std::size_t i = 2; i < height.size(); ++i)
    EXPECT_LT(std::abs(height[i] - 2.0 * height[i - 1] + height[i - 2]), 0.0005);
}

TEST(WalkBody, WhatIsOutOfReachIsReachedFor) {
  const StyleValues far =
      style({{"hands.carry", 1.0}, {"hands.x_m", 1.0}, {"hands.y_m", 1.0}, {"hands.z_m", 1.0}});
  MadeBody walker;
  walker.walk(1500, far, 0.7);
  for (const Side side : {kLeftSide, kRightSide}) {
    const vec3 arm = walker.hand(side) - walker.shoulder(side);
    EXPECT_GT(arm.y, 0.2);  // up
    EXPECT_GT(arm.z, 0.2);  // and ahead
    EXPECT_LT(walker.elbow(side), 45.0);
  }
}

TEST(WalkBody, ArmsSwingFartherWithLongerAndWithQuickerSteps) {
  const double own_m = adult().source_step_m, own_s = adult().body.own_step_s;
  double before = 0.0;
  for (const double share : {0.25, 0.5, 0.75, 1.0, 1.25}) {
    const double arc = arm_arc(share * own_m, own_s).width();
    EXPECT_GT(arc, before + 1.0) << share;
    before = arc;
  }
  before = 0.0;
  for (const double share : {0.7, 0.85, 1.0, 1.2, 1.4}) {
    const double arc = arm_arc(own_m, own_s / share).width();
    EXPECT_GT(arc, before + 1.0) << share;
    before = arc;
  }
}

TEST(WalkBody, AtTheDatasPaceArmsSwingAsInTheData) {
  MadeBody walker;
  walker.pace(2400, adult().source_step_m, adult().body.own_step_s);
  EXPECT_NEAR(walker.state().body.swing[0], 1.0, 1e-6);
  const double arc = arm_arc(adult().source_step_m, adult().body.own_step_s).width();
  EXPECT_GT(arc, 24.6);  // normative arc at free speed
  EXPECT_LT(arc, 32.0);
}

TEST(WalkBody, ArmsSwingAgainstEachOther) {
  for (const double forward : {0.3, 0.6, 1.0}) {
    MadeBody walker;
    walker.walk(1500, {}, forward);
    double left_mean = 0.0, right_mean = 0.0;
    std::vector<vec2> both;
    for (int i = 0; i < 720; ++i) {
      walker.step({}, forward);
      both.push_back({walker.swing(kLeftSide), walker.swing(kRightSide)});
      left_mean += both.back().x / 720.0, right_mean += both.back().y / 720.0;
    }
    double product = 0.0, left = 0.0, right = 0.0;
    for (const vec2& b : both) {
      product += (b.x - left_mean) * (b.y - right_mean);
      left += (b.x - left_mean) * (b.x - left_mean);
      right += (b.y - right_mean) * (b.y - right_mean);
    }
    EXPECT_LT(product / std::sqrt(left * right), -0.9) << forward;
  }
}

TEST(WalkBody, TheStylesFactorScalesTheSwing) {
  std::vector<double> arcs;
  for (const double factor : {0.0, 0.5, 1.0, 2.0, 3.0}) {
    const StyleValues swings = style({{"left_arm.swing", factor}});
    MadeBody walker;
    walker.walk(1500, swings, 0.7);
    Range arc;
    Range elbow;
    for (int i = 0; i < 400; ++i) {
      walker.step(swings, 0.7);
      arc.add(walker.swing(kLeftSide));
      elbow.add(walker.elbow(kLeftSide));
    }
    if (!arcs.empty()) {
      EXPECT_GT(arc.width(), arcs.back() + 5.0);
    }
    arcs.push_back(arc.width());
    EXPECT_GT(elbow.low, 2.0);  // no elbow is stretched
  }
  EXPECT_LT(arcs.front(), 5.0);  // what is left is the trunk's
}

TEST(WalkBody, InPaperModeItIsTheDatas) {
  MadeBody walker(adult(), IkMode::paper);
  walker.walk(2000, {}, 0.8);
  ASSERT_NEAR(presence(walker.state()), 1.0, 1e-9);
  Pose data;
  sample_local(adult().cycle, walker.state().phase, data);
  for (const ArmBuild& arm : adult().body.arm) {
    for (const int j : {arm.joints.shoulder, arm.joints.elbow, arm.joints.wrist}) {
      EXPECT_LT(
          glm::length(rotation_vector(glm::conjugate(data.local[j]) * walker.pose().local[j])),
          1e-6 * kDegree);
    }
  }
}

// The elbow answers a stiff shoulder, the hand goes where it went.
TEST(WalkBody, WeightsChangeTheJointsAndNotTheHandsPath) {
  const StyleValues stiff = style({{"left_arm.weight.shoulder", 0.15}});
  MadeBody plain, weighted;
  plain.walk(1500, {}, 0.8);
  weighted.walk(1500, stiff, 0.8);
  Range own, other_own, elbow, other_elbow;
  double farthest = 0.0, highest = 0.0, right_farthest = 0.0;
  for (int i = 0; i < 480; ++i) {
    plain.step({}, 0.8);
    weighted.step(stiff, 0.8);
    own.add(plain.swing(kLeftSide)), other_own.add(weighted.swing(kLeftSide));
    elbow.add(plain.elbow(kLeftSide)), other_elbow.add(weighted.elbow(kLeftSide));
    const vec3 off = plain.hand(kLeftSide) - weighted.hand(kLeftSide);
    farthest = std::max(farthest, glm::length(vec2(off.x, off.z)));
    highest = std::max(highest, std::abs(off.y));
    right_farthest =
        std::max(right_farthest, glm::distance(plain.hand(kRightSide), weighted.hand(kRightSide)));
  }
  EXPECT_LT(farthest, 0.001);
  EXPECT_LT(highest, 0.06);
  EXPECT_EQ(right_farthest, 0.0);
  EXPECT_LT(other_own.width(), own.width() - 3.0);
  EXPECT_GT(other_elbow.width(), elbow.width() + 3.0);
}

}  // namespace
}  // namespace gaitpad
