// What one clip is asked for beyond its own walk: slow and brisk, backwards, on the spot.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "animation/walk.h"
#include "control/control.h"

namespace gaitpad {
namespace {

constexpr double kDt = 1.0 / 240.0;

const WalkModel& adult() {
  static const WalkModel model = *walk_model(procedural_gait(), Character{});
  return model;
}

class Range : public testing::Test {
 protected:
  void walk(double x, double y, int ticks) {
    Stick stick;
    stick.left = vec2(x, y);
    for (int i = 0; i < ticks; ++i) {
      advance(adult(), gait_params(stick, StyleValues{}, limits_), IkMode::robust, kDt, state_,
              pose_);
      frames_.push_back(state_.frame);
      angles_.push_back(state_.angles_rad);
    }
  }
  // Second difference of any leg angle, degrees per tick squared.
  double sharpest_turn() const {
    double worst = 0.0;
    for (std::size_t t = 2; t < angles_.size(); ++t) {
      for (int side = 0; side < 2; ++side) {
        for (int j = 0; j < kLegDofs; ++j) {
          const double d2 =
              angles_[t][side][j] - 2.0 * angles_[t - 1][side][j] + angles_[t - 2][side][j];
          worst = std::max(worst, std::abs(d2) / kDegree);
        }
      }
    }
    return worst;
  }
  double slide_m() const {
    double worst = 0.0;
    for (std::size_t t = 1; t < frames_.size(); ++t) {
      const WalkFrame &a = frames_[t - 1], &b = frames_[t];
      for (int side = 0; side < 2; ++side) {
        if (a.heel_planted[side] && b.heel_planted[side])
          worst = std::max(worst, glm::distance(a.heel_m[side], b.heel_m[side]));
        if (a.toe_planted[side] && b.toe_planted[side])
          worst = std::max(worst, glm::distance(a.toe_m[side], b.toe_m[side]));
      }
    }
    return worst;
  }
  int steps() const { return state_.frame.steps[0] + state_.frame.steps[1]; }

  GaitLimits limits_ = gait_limits(kReferenceLeg_m);
  Pose pose_;
  WalkState state_ = standing(adult(), vec3(0.0), pose_);
  std::vector<WalkFrame> frames_;
  std::vector<std::array<LegAngles, 2>> angles_;
};

TEST_F(Range, BackwardDeflectionWalksBackwardsFacingAhead) {
  walk(0, -1.0, 480);
  const double from_m = state_.frame.pelvis_m.z;
  walk(0, -1.0, 960);
  const double speed_m_s = (state_.frame.pelvis_m.z - from_m) / (960 * kDt);
  EXPECT_NEAR(speed_m_s, -kBackwardShare * kMaxSpeed_m_s, 0.05);
  EXPECT_NEAR(state_.frame.speed_m_s, -kBackwardShare * kMaxSpeed_m_s, 0.01);
  EXPECT_EQ(state_.frame.heading_rad, 0.0);
  EXPECT_LT(slide_m(), 1e-4);
  EXPECT_LE(sharpest_turn(), 1.0);
  for (const WalkFrame& frame : frames_) {
    for (int side = 0; side < 2; ++side) {
      EXPECT_GT(frame.heel_m[side].y, -1e-4);
      EXPECT_GT(frame.toe_m[side].y, adult().leg[side].model.toe_rest_m - 1e-4);
    }
  }
}

// The running step ends, the feet come together, the walk begins anew.
TEST_F(Range, BetweenTheDirectionsItStands) {
  walk(0, 0.8, 600);
  const std::size_t turned = frames_.size();
  walk(0, -0.8, 960);
  bool stood = false;
  for (std::size_t t = turned; t < frames_.size(); ++t)
    stood = stood || frames_[t].stage == Stage::idle;
  EXPECT_TRUE(stood);
  EXPECT_LT(frames_.back().speed_m_s, 0.0);
  EXPECT_LE(sharpest_turn(), 1.0);
}

// Adults: .52 to .64 cm per step a minute at any speed (paper-notes 4.1), from a stroll to a brisk
// walk of 1.5 m/s; cadence 86 to 141 a minute.
TEST_F(Range, OneClipWalksSlowlyAndBrisklyAtAPersonsWalkRatio) {
  for (const double stick : {0.55, 0.7, 0.85, 1.0}) {
    walk(0, stick, 720);
    const int steps_before = steps();
    const double from_m = state_.frame.pelvis_m.z;
    walk(0, stick, 2400);
    const double cadence_per_min = (steps() - steps_before) * 60.0 / (2400 * kDt);
    const double step_cm = 100.0 * (state_.frame.pelvis_m.z - from_m) / (steps() - steps_before);
    EXPECT_NEAR(step_cm / cadence_per_min, 0.58, 0.06) << "stick " << stick;
    EXPECT_GT(cadence_per_min, 86.0);
    EXPECT_LT(cadence_per_min, 141.0);
  }
}

TEST_F(Range, SidewaysAloneTurnsOnTheSpotWithSmallSteps) {
  walk(1.0, 0.0, 1200);
  EXPECT_LT(state_.frame.heading_rad, -kPi);
  EXPECT_GT(steps(), 6);
  for (const WalkFrame& frame : frames_) {
    EXPECT_LT(glm::length(vec2(frame.pelvis_m.x, frame.pelvis_m.z)), 0.35);
    for (int side = 0; side < 2; ++side) EXPECT_LT(std::abs(frame.stride_m[side]), 0.2);
  }
  EXPECT_LT(slide_m(), 1e-4);
  walk(0, 0, 480);
  EXPECT_EQ(state_.frame.stage, Stage::idle);
}

}  // namespace
}  // namespace gaitpad
