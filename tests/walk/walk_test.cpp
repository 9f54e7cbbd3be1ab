#include "gaitpad/walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tests/finite_pose.h"
#include "tests/walk/made_walker.h"

namespace gaitpad {
namespace {

StyleValues with_hip_weight(double weight) {
  StyleValues style;
  for (LegWeights& w : style.weight) w[kHipX] = w[kHipY] = w[kHipZ] = weight;
  return style;
}

StyleValues statue() {
  StyleValues style;
  style.body.idle = 0.0;
  return style;
}

TEST(Walk, AStopEndsStandingStillWithTheFeetTogether) {
  for (int ticks = 300; ticks < 420; ticks += 13) {  // stops in every part of a step
    MadeWalker walker;
    walker.walk(0, 0.8, ticks, statue());
    walker.walk(0, 0, 700, statue());
    const WalkFrame& end = walker.last();
    EXPECT_EQ(end.stage, Stage::idle);
    EXPECT_EQ(end.speed_m_s, 0.0);
    EXPECT_NEAR(end.heel_m[0].z, end.heel_m[1].z, 1e-4);
    // At hip width: each heel is where a straight leg has it.
    const auto below_hip_m = [](int side) {
      const LegModel& leg = adult().leg[side].model;
      return leg.hip_m.x + leg.heel_m.x;
    };
    EXPECT_NEAR(end.heel_m[0].x - end.heel_m[1].x, below_hip_m(0) - below_hip_m(1), 1e-4);
    for (Side side : {kLeftSide, kRightSide}) {
      EXPECT_NEAR(end.heel_m[side].y, 0.0, 1e-4);
      EXPECT_NEAR(end.toe_m[side].y, adult().leg[side].model.toe_rest_m, 1e-4);
    }
    const WalkFrame& before = walker.frames()[walker.frames().size() - 2];
    EXPECT_LT(glm::distance(end.pelvis_m, before.pelvis_m), 1e-6);
  }
}

// The roll of the foot that has just landed goes on: to either side it would else be another
// foot's.
TEST(Walk, AWalkThatBeginsInTheLastRollOfAStopKeepsTheFootThatHasLanded) {
  for (const double x : {-0.9, 0.9}) {
    for (int ticks = 300; ticks < 420; ticks += 13) {
      MadeWalker walker;
      walker.walk(0, 0.8, ticks);
      do walker.walk(0, 0, 1);
      while (walker.state().walk.change.stands == 0.0f || walker.last().stage != Stage::roll);
      const Side landed = walker.last().swing;
      for (; walker.last().stage == Stage::roll; walker.walk(x, 0, 1))
        ASSERT_EQ(walker.last().swing, landed);
      EXPECT_EQ(walker.last().stage, Stage::flight);
      EXPECT_NE(walker.last().swing, landed);
    }
  }
}

// A thumb slips over the stick for a moment, and then pushes it.
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
  walker.walk(0, 0, 10 * kRate, statue());  // long enough for the style to take full effect
  const WalkFrame first = walker.last();
  walker.walk(0, 0, 480, statue());
  EXPECT_LT(glm::distance(walker.last().pelvis_m, first.pelvis_m), 1e-9);
  EXPECT_EQ(walker.last().stage, Stage::idle);
}

// The range of the pelvis' yaw.
double yaw_range_rad(const StyleValues& style) {
  MadeWalker walker;
  double left = -1e9, right = 1e9;
  walker.walk(0, 0.8, 1200, style);
  for (int tick = 0; tick < 600; ++tick) {
    walker.walk(0, 0.8, 1, style);
    const double yaw = heading_of(walker.pose().local[0] * kForward);  // the root is the pelvis
    left = std::max(left, yaw);
    right = std::min(right, yaw);
  }
  EXPECT_LT(walker.drift_m(), 1e-4);
  return left - right;
}

TEST(Walk, HipSwayIsProportionalAndLeavesPlantedFeet) {
  StyleValues style;
  const double once = yaw_range_rad(style);
  EXPECT_GT(once, 2.0 * kDegree);
  for (double sway : {0.0, 2.0, 3.0}) {
    style.hip_sway = sway;
    EXPECT_NEAR(yaw_range_rad(style), sway * once, 0.1 * once) << sway;
  }
}

bool within_limits(const WalkModel& model, const std::array<LegAngles, 2>& legs_rad) {
  for (Side side : {kLeftSide, kRightSide}) {
    for (int j = 0; j < kLegDofs; ++j) {
      const IkDof& dof = model.leg[side].chain.dof[j];
      if (legs_rad[side][j] < dof.min_rad - 1e-12 || legs_rad[side][j] > dof.max_rad + 1e-12)
        return false;
    }
  }
  return true;
}

TEST(Walk, NeitherFailsNorJumpsNorLeavesItsLimitsOverRandomSticksAndStyles) {
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
    for (const auto& legs_rad : walker.angles_rad()) ASSERT_TRUE(within_limits(model, legs_rad));
    EXPECT_LT(walker.drift_m(), 1e-4) << ratio;
    // 1.5 times the bound for a single change (0.8), because sticks and styles jump here; twice for
    // short legs, whose knees are straight more often.
    EXPECT_LT(walker.sharpest_turn_rad(), (ratio < 1.0 ? 1.6 : 1.2) * kDegree) << ratio;
  }
}

// The walk asks the ankles for more bend than they have, so the feet point down instead.
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

// The last step is shorter than the one before, but its heel must not fly high as in a limp.
TEST(Walk, AStopRaisesHighHeelsNoHigherThanTheWalkDoes) {
  const WalkModel child = model_of(0.6);
  const auto highest_m = [](const MadeWalker& walker, std::size_t from) {
    double highest = 0.0;
    for (std::size_t k = from; k < walker.frames().size(); ++k) {
      for (const vec3& heel_m : walker.frames()[k].heel_m) highest = std::max(highest, heel_m.y);
    }
    return highest;
  };
  for (int moment = 0; moment < 120; moment += 3) {
    MadeWalker walker(child);
    walker.walk(0, 1.0, 2 * kRate + moment, high_steps());
    const double walks_m = highest_m(walker, 0);
    const std::size_t released = walker.frames().size();
    walker.walk(0, 0, kRate, high_steps());
    EXPECT_LT(highest_m(walker, released), walks_m + 0.01) << moment;
    for (const WalkFrame& f : walker.frames()) ASSERT_FALSE(f.ik_failed[0] || f.ik_failed[1]);
  }
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

// The solver has no limits: what it is asked for must not bend a knee past straight.
TEST(Walk, PaperModeKeepsKneesBentForward) {
  for (const double forward : {0.5, 0.8, 1.0}) {
    MadeWalker walker(adult(), IkMode::paper);
    walker.walk(0, forward, 4 * kRate);
    for (const auto& legs : walker.angles_rad())
      ASSERT_GT(std::min(legs[0][kKneeX], legs[1][kKneeX]), 0.0) << forward;
  }
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
}

// True if both feet are down beside each other at some time after a walk at `from` is asked to walk
// at `to`.
bool stands_between(double from, double to) {
  MadeWalker walker;
  walker.walk(0, from, 600);
  const std::size_t turned = walker.frames().size();
  walker.walk(0, to, 960);
  EXPECT_GT(walker.last().speed_m_s * to, 0.0);
  EXPECT_LE(walker.sharpest_turn_rad(), 1.0 * kDegree);
  bool stands = false;
  for (std::size_t t = turned; t < walker.frames().size(); ++t) {
    const std::array<vec3, 2>& heel_m = walker.frames()[t].heel_m;
    stands = stands || (std::abs(heel_m[0].z - heel_m[1].z) < 1e-3 && heel_m[0].y < 1e-3 &&
                        heel_m[1].y < 1e-3);
  }
  return stands;
}
// The last step ahead is followed by the first one back.
TEST(Range, FromAheadItTurnsBackWithoutStanding) { EXPECT_FALSE(stands_between(0.8, -0.8)); }
// The present step ends, the feet come together, and the walk begins again.
TEST(Range, FromBackwardItStandsBeforeItGoesAhead) { EXPECT_TRUE(stands_between(-0.8, 0.8)); }

// Adults have a ratio of 0.52 to 0.64 cm per step a minute at any speed (paper-notes 4.1), from a
// stroll to a brisk walk of 1.5 m/s, with a cadence of 86 to 141 a minute.
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

// A start, a walk and a stop; keeps the values of its ticks 20 times a second.
struct RateRun {
  double walked_m = 0.0;
  std::vector<Pose> poses;
};
RateRun run_at(int rate_hz, const vec2& stick) {
  RateRun run;
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  const GaitLimits limits = gait_limits(adult());
  for (int tick = 1; tick <= 20 * rate_hz; ++tick) {
    const Stick asks{.left = tick <= 16 * rate_hz ? stick : vec2(0.0)};
    const vec3 before_m = state.root.place_m;
    advance(adult(), gait_params(asks, StyleValues{}, limits), IkMode::robust, 1.0 / rate_hz, state,
            pose);
    run.walked_m += glm::distance(state.root.place_m, before_m);
    if (tick * 10 % rate_hz == 0) run.poses.push_back(pose);
  }
  EXPECT_EQ(state.bad_inputs, 0);
  return run;
}
double rms_deg(const RateRun& a, const RateRun& b) {
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    for (int j = 1; j < a.poses[i].joint_count; ++j, ++count) {
      const quat off = glm::conjugate(a.poses[i].local[j]) * b.poses[i].local[j];
      const double turn = glm::length(rotation_vector(off)) / kDegree;
      squares += turn * turn;
    }
  }
  return std::sqrt(squares / count);
}

// One begins with the foot that limps, so they strike at other ticks.
TEST(Walk, MirroredSticksHaveExactlyMirroredHeadings) {
  MadeWalker right, left;
  bool other_ticks = false;
  for (int tick = 0; tick < 20 * kRate; ++tick) {
    const double x = tick < 15 * kRate ? 0.5 : 0.1;
    right.walk(x, 0.7, 1, limp());
    left.walk(-x, 0.7, 1, limp());
    ASSERT_EQ(right.state().root.heading_rad, -left.state().root.heading_rad) << tick;
    other_ticks = other_ticks || right.last().stage != left.last().stage;
  }
  EXPECT_TRUE(other_ticks);
}

TEST(Walk, MirroredSticksHaveMirroredWalks) {
  MadeWalker right, left;
  double most_m = 0.0;
  for (int tick = 0; tick < 6 * kRate; ++tick) {
    right.walk(0.5, 0.7, 1), left.walk(-0.5, 0.7, 1);
    const auto gap = [&](const vec3& a, const vec3& b) {
      most_m = std::max(most_m, glm::distance(a, vec3(-b.x, b.y, b.z)));
    };
    gap(right.last().pelvis_m, left.last().pelvis_m);
    for (const int side : {0, 1}) {
      gap(right.last().heel_m[side], left.last().heel_m[1 - side]);
      gap(right.last().toe_m[side], left.last().toe_m[1 - side]);
    }
  }
  std::printf("%.2e m\n", most_m);
  EXPECT_LT(most_m, 2e-5);
}

TEST(Walk, GoesEquallyFarAndLooksAlikeAtAnyRate) {
  for (const vec2 stick : {vec2(0.0, 0.3), vec2(0.4, 0.6), vec2(0.0, 0.8), vec2(0.0, 1.0)}) {
    const RateRun usual = run_at(240, stick);
    for (const int rate_hz : {10, 20, 30, 60, 120, 1000}) {
      const RateRun run = run_at(rate_hz, stick);
      EXPECT_NEAR(run.walked_m / usual.walked_m, 1.0, 0.005) << rate_hz << " Hz, " << stick.y;
      EXPECT_LT(rms_deg(run, usual), 1.0) << rate_hz << " Hz, " << stick.y;
    }
  }
}

// The length of a tick is a constant of a walk. With another one its plans mean nothing, but they
// end; the sanitizers see what is read beyond them.
TEST(Walk, StaysFiniteWhereTheTickChangesItsLength) {
  MadeWalker walker;
  walker.walk(0, 0.8, 300);
  const GaitParams rest = gait_params({}, {}, gait_limits(adult()));
  for (int stop = 0; stop < 40; ++stop) {
    walker.walk(0, 0, 5);
    WalkState state = walker.state();
    Pose pose = walker.pose();
    for (int tick = 0; tick < 120; ++tick) {
      advance(adult(), rest, IkMode::robust, 1.0 / 60.0, state, pose);
      ASSERT_TRUE(is_finite(pose)) << stop << " " << tick;
    }
  }
}

}  // namespace
}  // namespace gaitpad
