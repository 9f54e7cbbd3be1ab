#include "gaitpad/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "animation/made_walker.h"

namespace gaitpad {
namespace {

bool is_finite(const Pose& pose) {
  double sum = pose.root_m.x + pose.root_m.y + pose.root_m.z;
  for (int j = 0; j < pose.joint_count; ++j) {
    const quat& q = pose.local[j];
    sum += q.w + q.x + q.y + q.z;
  }
  return std::isfinite(sum);
}

StyleValues with_hip_weight(double weight) {
  StyleValues style;
  for (LegWeights& w : style.weight) w[kHipX] = w[kHipY] = w[kHipZ] = weight;
  return style;
}

TEST(Walk, PlantedPointsStayOnTheirPlaceWhateverTheStickDoes) {
  MadeWalker walker;
  walker.walk(0, 0, 60);
  walker.walk(0, 1.0, 500);
  walker.walk(0.7, 0.6, 500);
  walker.walk(-0.5, 0.0, 500);
  walker.walk(0, 0.3, 500, limp());
  walker.walk(0, 0, 400);
  EXPECT_LT(walker.drift_m(), 1e-4);
}

TEST(Walk, StagesFollowInTheOrderOfTableOne) {
  MadeWalker walker;
  walker.walk(0, 0, 10);
  walker.walk(0, 0.8, 1500);
  walker.walk(0, 0, 500);
  using Key = std::pair<Stage, Side>;
  const std::map<Key, Key> next = {{{Stage::roll, kRightSide}, {Stage::flight, kLeftSide}},
                                   {{Stage::flight, kLeftSide}, {Stage::roll, kLeftSide}},
                                   {{Stage::roll, kLeftSide}, {Stage::flight, kRightSide}},
                                   {{Stage::flight, kRightSide}, {Stage::roll, kRightSide}}};
  int changes = 0;
  for (std::size_t k = 1; k < walker.frames().size(); ++k) {
    const WalkFrame &a = walker.frames()[k - 1], &b = walker.frames()[k];
    if (a.stage == b.stage && a.swing == b.swing) continue;
    ++changes;
    if (a.stage == Stage::idle || b.stage == Stage::idle) {
      EXPECT_TRUE(a.stage == Stage::roll || b.stage == Stage::roll);
    } else {
      EXPECT_EQ((Key{b.stage, b.swing}), next.at({a.stage, a.swing})) << "tick " << k;
    }
  }
  EXPECT_GT(changes, 20);
}

TEST(Walk, PlantedIsWhatTableOneSays) {
  MadeWalker walker;
  walker.walk(0.3, 0.7, 1200);
  walker.walk(0, 0, 500);
  for (const WalkFrame& f : walker.frames()) {
    for (Side side : {kLeftSide, kRightSide}) {
      const bool swings = f.stage != Stage::idle && f.swing == side;
      EXPECT_EQ(f.toe_planted[side], !swings);
      EXPECT_EQ(f.heel_planted[side], f.stage == Stage::idle || (f.stage == Stage::roll && swings));
    }
  }
}

TEST(Walk, AMirroredStickGivesTheMirroredWalk) {
  MadeWalker left, right;
  const struct {
    double x, y;
    int ticks;
  } plan[] = {{-0.5, 0.7, 700}, {0.3, 0.5, 500}, {-0.8, 0.0, 400}, {0.0, 0.0, 400}};
  for (const auto& p : plan) {
    left.walk(p.x, p.y, p.ticks);
    right.walk(-p.x, p.y, p.ticks);
  }
  const auto mirrored = [](const vec3& v) { return vec3(-v.x, v.y, v.z); };
  for (std::size_t k = 0; k < left.frames().size(); ++k) {
    const WalkFrame &l = left.frames()[k], &r = right.frames()[k];
    ASSERT_NEAR(l.heading_rad, -r.heading_rad, 1e-12) << "tick " << k;
    ASSERT_EQ(l.stage, r.stage) << "tick " << k;
    ASSERT_LT(glm::distance(l.pelvis_m, mirrored(r.pelvis_m)), 1e-3) << "tick " << k;
    for (Side side : {kLeftSide, kRightSide}) {
      ASSERT_LT(glm::distance(l.heel_m[side], mirrored(r.heel_m[other(side)])), 1e-3)
          << "tick " << k;
    }
  }
}

TEST(Walk, AStopEndsStandingStillWithTheFeetTogether) {
  for (int ticks = 300; ticks < 420; ticks += 13) {  // in every part of a step
    MadeWalker walker;
    walker.walk(0, 0.8, ticks);
    walker.walk(0, 0, 700);
    const WalkFrame& end = walker.last();
    EXPECT_EQ(end.stage, Stage::idle);
    EXPECT_EQ(end.speed_m_s, 0.0);
    EXPECT_NEAR(end.heel_m[0].z, end.heel_m[1].z, 1e-4);
    EXPECT_NEAR(end.heel_m[0].x - end.heel_m[1].x, adult().leg[0].track_m - adult().leg[1].track_m,
                1e-4);
    for (Side side : {kLeftSide, kRightSide}) {
      EXPECT_NEAR(end.heel_m[side].y, 0.0, 1e-4);
      EXPECT_NEAR(end.toe_m[side].y, adult().leg[side].model.toe_rest_m, 1e-4);
    }
    const WalkFrame& before = walker.frames()[walker.frames().size() - 2];
    EXPECT_LT(glm::distance(end.pelvis_m, before.pelvis_m), 1e-6);
  }
}

// A thumb that slips over the stick for a moment, and then pushes it.
TEST(Walk, ATouchOfTheStickDoesNotDelayTheWalkThatFollows) {
  const auto first_lift = [](double touched_y) {
    MadeWalker walker;
    walker.walk(0.0, 0.0, kRate / 4);
    walker.walk(0.0, touched_y, kRate * 6 / 100);
    walker.walk(0.0, 0.0, kRate / 10);
    int ticks = 0;
    for (; walker.last().stage != Stage::flight && ticks < 4 * kRate; ++ticks)
      walker.walk(0.0, 1.0, 1);
    return ticks;
  };
  const int untouched = first_lift(0.0);
  for (const double touched_y : {-0.04, 0.03}) EXPECT_EQ(first_lift(touched_y), untouched);
}

TEST(Walk, ALittleStickThatIsHeldBeginsAWalk) {
  for (const double y : {-0.05, 0.03, 0.05}) {
    MadeWalker walker;
    walker.walk(0.0, y, kRate);
    EXPECT_NE(walker.last().stage, Stage::idle) << y;
  }
}

TEST(Walk, StandingStillChangesNothing) {
  MadeWalker walker;
  walker.walk(0, 0, 2);
  const WalkFrame first = walker.last();
  walker.walk(0, 0, 480);
  EXPECT_LT(glm::distance(walker.last().pelvis_m, first.pelvis_m), 1e-9);
  EXPECT_EQ(walker.last().stage, Stage::idle);
}

TEST(Walk, AStepIsAsLongAsItsFrameSays) {
  for (double ratio : {0.6, 1.0, 1.6}) {
    const WalkModel model = model_of(ratio);
    MadeWalker walker(model);
    walker.walk(0, 0.4, 900);
    walker.walk(0, 0.9, 1200, limp());
    for (std::size_t k = 1; k < walker.frames().size(); ++k) {
      const WalkFrame &a = walker.frames()[k - 1], &b = walker.frames()[k];
      if (a.stage != Stage::flight || b.stage != Stage::roll) continue;
      const Side swing = b.swing;
      double stood_z = 0.0;  // where the standing foot's heel was last on the ground
      for (std::size_t j = 0; j < k; ++j) {
        if (walker.frames()[j].heel_planted[other(swing)])
          stood_z = walker.frames()[j].heel_m[other(swing)].z;
      }
      EXPECT_NEAR(b.heel_m[swing].z - stood_z, b.stride_m[swing], 1e-3) << ratio << " tick " << k;
    }
  }
}

TEST(Walk, SpeedIsTheNetDisplacementOverWholeCycles) {
  for (double y : {0.3, 0.6, 1.0}) {
    MadeWalker walker;
    walker.walk(0, y, 2400);
    std::vector<std::size_t> strikes;
    for (std::size_t k = 1200; k < walker.frames().size(); ++k) {
      const WalkFrame &a = walker.frames()[k - 1], &b = walker.frames()[k];
      if (a.stage == Stage::flight && b.stage == Stage::roll && b.swing == kRightSide)
        strikes.push_back(k);
    }
    ASSERT_GE(strikes.size(), 3u);
    const WalkFrame &first = walker.frames()[strikes.front()],
                    &last = walker.frames()[strikes.back()];
    const double time_s = static_cast<double>(strikes.back() - strikes.front()) * kDt;
    const double speed_m_s = (last.pelvis_m.z - first.pelvis_m.z) / time_s;
    EXPECT_NEAR(speed_m_s, last.speed_m_s, 0.01 * last.speed_m_s) << y;
    EXPECT_NEAR(last.pelvis_m.x, first.pelvis_m.x, 1e-4 * static_cast<double>(strikes.size()));
  }
}

struct HipMotion {
  double travel_m, yaw_rad, planted_drift_m;
};
HipMotion hips_of(const StyleValues& style) {
  MadeWalker walker;
  double low = 1e9, high = -1e9, left = -1e9, right = 1e9;
  walker.walk(0, 0.8, 1200, style);
  for (int tick = 0; tick < 600; ++tick) {
    walker.walk(0, 0.8, 1, style);
    const double yaw = heading_of(walker.pose().local[0] * kForward);  // the root is the pelvis
    low = std::min(low, walker.last().pelvis_m.y);
    high = std::max(high, walker.last().pelvis_m.y);
    left = std::max(left, yaw);
    right = std::min(right, yaw);
  }
  return {high - low, left - right, walker.drift_m()};
}

TEST(Walk, HipBounceGrowsTheVerticalTravelAndLeavesPlantedFeet) {
  double last_m = 0.0;
  for (double bounce : {0.0, 1.0, 2.0, 3.0}) {
    StyleValues style;
    style.hip_bounce = bounce;
    const HipMotion hips = hips_of(style);
    RecordProperty("travel_mm_at_" + std::to_string(static_cast<int>(bounce)),
                   static_cast<int>(1000.0 * hips.travel_m));
    EXPECT_GT(hips.travel_m, last_m) << bounce;
    EXPECT_LT(hips.planted_drift_m, 1e-4) << bounce;
    last_m = hips.travel_m;
  }
}

TEST(Walk, HipSwayIsProportionalAndLeavesPlantedFeet) {
  StyleValues style;
  const double once = hips_of(style).yaw_rad;
  EXPECT_GT(once, 2.0 * kDegree);
  for (double sway : {0.0, 2.0, 3.0}) {
    style.hip_sway = sway;
    const HipMotion hips = hips_of(style);
    EXPECT_NEAR(hips.yaw_rad, sway * once, 0.1 * once) << sway;
    EXPECT_LT(hips.planted_drift_m, 1e-4) << sway;
  }
}

TEST(Walk, WeightsChangeTheLegAndNeitherTheToesNorTheLandingPlace) {
  MadeWalker even, stiff;
  even.walk(0, 0.8, 2000);
  stiff.walk(0, 0.8, 2000, with_hip_weight(0.2));
  double square = 0.0;
  for (std::size_t k = 1; k < even.frames().size(); ++k) {
    const WalkFrame &a = even.frames()[k], &b = stiff.frames()[k];
    ASSERT_EQ(a.stage, b.stage) << "tick " << k;
    const double change = even.angles_rad()[k][0][kHipX] - stiff.angles_rad()[k][0][kHipX];
    if (k >= 1000) square += change * change / 1000.0;
    if (even.frames()[k - 1].stage == a.stage) continue;
    // Into a flight: the toe that lifts; into a roll: the heel that has landed.
    const auto place = a.stage == Stage::flight ? &WalkFrame::toe_m : &WalkFrame::heel_m;
    EXPECT_LT(glm::distance((a.*place)[a.swing], (b.*place)[b.swing]), 1e-3) << "tick " << k;
  }
  EXPECT_GT(std::sqrt(square), 1.5 * kDegree);
}

TEST(Walk, JointsStayWithinTheirLimits) {
  MadeWalker walker(adult());
  walker.walk(0, 1.0, 800);
  walker.walk(0.9, 0.3, 800, limp());
  walker.walk(0, 0.0, 400, with_hip_weight(0.2));
  for (const auto& legs : walker.angles_rad()) {
    for (Side side : {kLeftSide, kRightSide}) {
      for (int j = 0; j < kLegDofs; ++j) {
        const IkDof& dof = adult().leg[side].chain.dof[j];
        ASSERT_GE(legs[side][j], dof.min_rad - 1e-12);
        ASSERT_LE(legs[side][j], dof.max_rad + 1e-12);
      }
    }
  }
}

TEST(Walk, NeitherFailsNorJumpsOverRandomSticksAndStyles) {
  const StyleValues styles[] = {{}, limp(), with_hip_weight(0.2)};
  for (double ratio : {0.6, 1.0, 1.6}) {
    const WalkModel model = model_of(ratio);
    MadeWalker walker(model);
    std::mt19937 chance(7);
    const auto in = [&chance](double low, double high) {
      return low + (high - low) * (chance() >> 8) / double(1 << 24);
    };
    while (walker.frames().size() < 60 * kRate) {
      const double y = in(-0.3, 1.0), x = chance() % 3 == 0 ? 0.0 : in(-0.7, 0.7);
      const int ticks = 20 + static_cast<int>(chance() % 400);
      walker.walk(x, y, ticks, styles[chance() % 3]);
      ASSERT_TRUE(is_finite(walker.pose()));
    }
    int failures = 0;
    for (const WalkFrame& f : walker.frames()) failures += f.ik_failed[0] + f.ik_failed[1];
    EXPECT_EQ(failures, 0) << ratio;
    EXPECT_LT(walker.drift_m(), 1e-4) << ratio;
    EXPECT_LT(walker.sharpest_turn_rad(), 1.0 * kDegree) << ratio;
  }
}

// Its ankles bend up further than they can: the feet point down instead.
TEST(Walk, AChildThatStepsHighAtFullSpeedIsSmooth) {
  const WalkModel child = model_of(0.6);
  MadeWalker walker(child);
  for (int walks = 0; walks < 8; ++walks) {
    walker.walk(0, 1.0, 240 + 30 * walks, high_steps());
    walker.walk(0, 0, 2 * kRate, high_steps());
  }
  for (const WalkFrame& f : walker.frames()) ASSERT_FALSE(f.ik_failed[0] || f.ik_failed[1]);
  EXPECT_LT(walker.sharpest_turn_rad(), 1.5 * kDegree);
}

TEST(Walk, PaperModeStaysBoundedAndFinite) {
  for (const StyleValues& style : {StyleValues{}, limp(), with_hip_weight(0.2)}) {
    MadeWalker walker(adult(), IkMode::paper);
    walker.walk(0, 0.8, 10 * kRate, style);
    walker.walk(0.5, 0.6, 10 * kRate, style);
    ASSERT_TRUE(is_finite(walker.pose()));
    for (const WalkFrame& f : walker.frames()) {
      for (Side side : {kLeftSide, kRightSide}) {
        ASSERT_LT(glm::distance(f.heel_m[side], f.pelvis_m), 1.5 * adult().leg_length_m);
      }
    }
  }
}

// Whole-tick stages: nothing accumulates.
TEST(Walk, TheHundredthStrideIsTheTenth) {
  MadeWalker walker;
  walker.walk(0, 0.7, 120 * 300);
  std::vector<std::size_t> strikes;
  for (std::size_t k = 1; k < walker.frames().size(); ++k) {
    const WalkFrame &a = walker.frames()[k - 1], &b = walker.frames()[k];
    if (a.stage == Stage::flight && b.stage == Stage::roll && b.swing == kRightSide)
      strikes.push_back(k);
  }
  ASSERT_GT(strikes.size(), 101u);
  const std::size_t ticks = strikes[11] - strikes[10];
  ASSERT_EQ(strikes[101] - strikes[100], ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    for (Side side : {kLeftSide, kRightSide}) {
      for (int j = 0; j < kLegDofs; ++j) {
        ASSERT_NEAR(walker.angles_rad()[strikes[10] + i][side][j],
                    walker.angles_rad()[strikes[100] + i][side][j], 0.1 * kDegree);
      }
    }
  }
}

TEST(Walk, TheSameTicksGiveTheSameBits) {
  MadeWalker a, b;
  for (MadeWalker* walker : {&a, &b}) {
    walker->walk(0.2, 0.9, 500);
    walker->walk(0, 0.2, 300, limp());
  }
  EXPECT_EQ(a.angles_rad(), b.angles_rad());
  EXPECT_EQ(a.last().pelvis_m, b.last().pelvis_m);
}

int steps(const MadeWalker& walker) { return walker.last().steps[0] + walker.last().steps[1]; }

TEST(Range, BackwardDeflectionWalksBackwardsFacingAhead) {
  MadeWalker walker;
  walker.walk(0, -1.0, 480);
  const double from_m = walker.last().pelvis_m.z;
  walker.walk(0, -1.0, 960);
  const double speed_m_s = (walker.last().pelvis_m.z - from_m) / (960 * kDt);
  EXPECT_NEAR(speed_m_s, -kBackwardShare * kMaxSpeed_m_s, 0.05);
  EXPECT_NEAR(walker.last().speed_m_s, -kBackwardShare * kMaxSpeed_m_s, 0.01);
  EXPECT_EQ(walker.last().heading_rad, 0.0);
  EXPECT_LT(walker.drift_m(), 1e-4);
  EXPECT_LE(walker.sharpest_turn_rad(), 1.0 * kDegree);
  for (const WalkFrame& frame : walker.frames()) {
    for (int side = 0; side < 2; ++side) {
      EXPECT_GT(frame.heel_m[side].y, -1e-4);
      EXPECT_GT(frame.toe_m[side].y, adult().leg[side].model.toe_rest_m - 1e-4);
    }
  }
}

// The running step ends, the feet come together, the walk begins anew.
TEST(Range, BetweenTheDirectionsItStands) {
  MadeWalker walker;
  walker.walk(0, 0.8, 600);
  const std::size_t turned = walker.frames().size();
  walker.walk(0, -0.8, 960);
  bool stood = false;
  for (std::size_t t = turned; t < walker.frames().size(); ++t)
    stood = stood || walker.frames()[t].stage == Stage::idle;
  EXPECT_TRUE(stood);
  EXPECT_LT(walker.frames().back().speed_m_s, 0.0);
  EXPECT_LE(walker.sharpest_turn_rad(), 1.0 * kDegree);
}

// Adults: .52 to .64 cm per step a minute at any speed (paper-notes 4.1), from a stroll to a brisk
// walk of 1.5 m/s; cadence 86 to 141 a minute.
TEST(Range, OneClipWalksSlowlyAndBrisklyAtAPersonsWalkRatio) {
  MadeWalker walker;
  for (const double stick : {0.55, 0.7, 0.85, 1.0}) {
    walker.walk(0, stick, 720);
    const int steps_before = steps(walker);
    const double from_m = walker.last().pelvis_m.z;
    walker.walk(0, stick, 2400);
    const double cadence_per_min = (steps(walker) - steps_before) * 60.0 / (2400 * kDt);
    const double step_cm =
        100.0 * (walker.last().pelvis_m.z - from_m) / (steps(walker) - steps_before);
    EXPECT_NEAR(step_cm / cadence_per_min, 0.58, 0.06) << "stick " << stick;
    EXPECT_GT(cadence_per_min, 86.0);
    EXPECT_LT(cadence_per_min, 141.0);
  }
}

TEST(Range, SidewaysAloneTurnsOnTheSpotWithSmallSteps) {
  MadeWalker walker;
  walker.walk(1.0, 0.0, 1200);
  EXPECT_LT(walker.last().heading_rad, -kPi);
  EXPECT_GT(steps(walker), 6);
  for (const WalkFrame& frame : walker.frames()) {
    EXPECT_LT(glm::length(vec2(frame.pelvis_m.x, frame.pelvis_m.z)), 0.35);
    for (int side = 0; side < 2; ++side) EXPECT_LT(std::abs(frame.stride_m[side]), 0.2);
  }
  EXPECT_LT(walker.drift_m(), 1e-4);
  walker.walk(0, 0, 480);
  EXPECT_EQ(walker.last().stage, Stage::idle);
}

}  // namespace
}  // namespace gaitpad
