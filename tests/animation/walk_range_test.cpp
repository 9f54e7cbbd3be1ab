// What one clip is asked for beyond its own walk: slow and brisk, backwards, on the spot.
#include <gtest/gtest.h>

#include <cmath>

#include "animation/made_walker.h"

namespace gaitpad {
namespace {

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
