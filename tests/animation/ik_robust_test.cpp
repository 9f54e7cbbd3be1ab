#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gaitpad/limbs.h"
#include "ik_chains.h"

namespace gaitpad::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Cold starts: how many fail, fail unnoticed, or leave the limits.
struct ColdStarts {
  int failed = 0, unflagged = 0, outside = 0;
  void solve(const IkChain& c, std::span<const IkRow> rows) {
    IkAngles q = standing();
    const IkResult result = solve_robust(c, rows, {}, q);
    const bool reached = error_of(c, rows, q) <= 1.01e-6;
    failed += !reached;
    unflagged += !reached && result.status == IkStatus::converged;
    outside += !within_limits(c, q);
  }
  void expect_rare_failures(int count) const {
    EXPECT_LT(failed, count / 1000);
    EXPECT_EQ(unflagged, 0);
    EXPECT_EQ(outside, 0);
    testing::Test::RecordProperty("failed", failed);
  }
};

TEST(IkRobust, AMillionColdStartsFailRarelyAndEachIsFlagged) {
  Random random(21);
  const IkChain c = human_leg();
  ColdStarts starts;
  for (int i = 0; i < kMillion; ++i) {
    const vec3& point_m = i % 2 ? kHeel : kToe;
    const auto rows = point_goal(point_m, point_at(c, random_pose(c, random), point_m));
    starts.solve(c, rows);
  }
  starts.expect_rare_failures(kMillion);
}

// Heel and toe together, as in the roll stage: five rows.
TEST(IkRobust, ColdStartsWithFiveRowsFailRarelyAndEachIsFlagged) {
  Random random(22);
  const IkChain c = human_leg();
  const int count = kMillion / 5;
  ColdStarts starts;
  for (int i = 0; i < count; ++i) {
    const IkAngles pose = random_pose(c, random);
    const auto heel = point_goal(kHeel, point_at(c, pose, kHeel));
    const vec3 toe_m = point_at(c, pose, kToe);
    const std::array<IkRow, 5> rows = {heel[0], heel[1], heel[2], IkRow{kToe, kY, toe_m.y},
                                       IkRow{kToe, kX, toe_m.x}};
    starts.solve(c, rows);
  }
  starts.expect_rare_failures(count);
}

// Places of a heel relative to the hip, 1 to 4 cm apart, along strides drawn at random.
class GaitPath {
 public:
  explicit GaitPath(Random& random) : random_(random) { draw(); }
  // The next place, at most `reach_m` from the hip.
  vec3 next(double reach_m) {
    if (phase_ > 6.0 * kPi) draw();
    const double faster = std::hypot(0.5 * stride_m_ * std::sin(phase_),
                                     std::sin(phase_) > 0.0 ? lift_m_ * std::cos(phase_) : 0.0);
    phase_ += std::min(step_m_ / std::max(faster, 1e-3), 0.15);
    const vec3 p(side_m_ + 0.02 * std::sin(phase_),
                 -height_m_ + lift_m_ * std::max(std::sin(phase_), 0.0),
                 -0.5 * stride_m_ * std::cos(phase_));
    return p * std::min(1.0, reach_m / glm::length(p));
  }
  bool fresh() const { return phase_ < 0.2; }

 private:
  void draw() {
    phase_ = 0.0;
    stride_m_ = random_.between(0.3, 0.75), lift_m_ = random_.between(0.03, 0.2);
    height_m_ = random_.between(0.84, 0.93), side_m_ = random_.between(-0.08, 0.08);
    step_m_ = random_.between(0.01, 0.04);
  }
  Random& random_;
  double phase_, stride_m_, lift_m_, height_m_, side_m_, step_m_;
};

TEST(IkRobust, AMillionTargetsAlongGaitLikePathsAllConverge) {
  Random random(23);
  IkChain c = human_leg();
  for (const double hip_weight : {1.0, 0.2}) {
    for (int j = 0; j < 3; ++j) c.dof[j].weight = hip_weight;
    const double reach_m = 0.84 + glm::length(kHeel);
    GaitPath path(random);
    IkAngles q = standing();
    long iterations = 0;
    int failed = 0, outside = 0, jumped = 0;
    const int count = kMillion / 2;
    for (int i = 0; i < count; ++i) {
      const auto rows = point_goal(kHeel, path.next(0.995 * reach_m));
      if (path.fresh()) q = standing();
      const IkResult result = solve_robust(c, rows, {}, q);
      failed += result.status != IkStatus::converged || !(error_of(c, rows, q) <= 1.01e-6);
      outside += !within_limits(c, q);
      jumped += result.tries > 1;
      iterations += result.iterations;
    }
    EXPECT_EQ(failed, 0);
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(jumped, 0);
    EXPECT_LT(static_cast<double>(iterations) / count, 4.0);
    RecordProperty("iterations", static_cast<int>(iterations));
  }
}

TEST(IkRobust, ASlightlyMovedGoalMovesTheAnswerSlightly) {
  Random random(24);
  const IkChain c = human_leg();
  int large = 0;
  for (int i = 0; i < 20000; ++i) {
    IkAngles start = random_pose(c, random);
    start[3] = random.between(5.0, 120.0) * kDegree;
    const vec3 goal_m = point_at(c, start, kHeel) + 0.03 * random.direction();
    IkAngles a = start, b = start;
    RobustOptions options;
    options.max_tries = 1;
    options.tolerance_m = 1e-9;
    const IkResult first = solve_robust(c, point_goal(kHeel, goal_m), options, a);
    const IkResult second =
        solve_robust(c, point_goal(kHeel, goal_m + 1e-6 * random.direction()), options, b);
    if (first.status != IkStatus::converged || second.status != IkStatus::converged) continue;
    double greatest = 0.0;
    for (int j = 0; j < c.dofs; ++j) greatest = std::max(greatest, std::abs(a[j] - b[j]));
    large += greatest > 1e-4;
  }
  EXPECT_LE(large, 20);
}

TEST(IkRobust, WeightsCountOnlyRelativeToEachOther) {
  Random random(25);
  for (int trial = 0; trial < 200; ++trial) {
    IkChain c = random_chain(7, random), halved = c, tenth = c;
    for (int j = 0; j < c.dofs; ++j) halved.dof[j].weight *= 0.5, tenth.dof[j].weight *= 0.1;
    const IkAngles start = random_angles(c, random);
    const auto rows =
        point_goal(vec3(0.0), end_frame(c, start).position_m + 0.05 * random.direction());
    IkAngles a = start, b = start, d = start;
    solve_robust(c, rows, {}, a);
    solve_robust(halved, rows, {}, b);
    solve_robust(tenth, rows, {}, d);
    EXPECT_EQ(a, b);
    for (int j = 0; j < c.dofs; ++j) EXPECT_NEAR(a[j], d[j], 1e-9);
  }
}

TEST(IkRobust, SmallerWeightTurnsThatJointLessAndZeroLocksIt) {
  Random random(26);
  for (int trial = 0; trial < 200; ++trial) {
    const IkChain even = human_leg();
    IkAngles start = standing();
    start[kKneeX] = 0.6, start[kAnkleX] = 0.3;
    const auto rows = point_goal(kHeel, point_at(even, start, kHeel) + 0.01 * random.direction());
    double last = 1e9;
    for (const double w : {1.0, 0.5, 0.2, 0.05, 0.0}) {
      IkChain c = even;
      c.dof[kHipX].weight = w;
      IkAngles q = start;
      EXPECT_EQ(solve_robust(c, rows, {}, q).status, IkStatus::converged);
      const double moved = std::abs(q[kHipX] - start[kHipX]);
      EXPECT_LT(moved, last + 1e-3);
      last = moved;
    }
    EXPECT_EQ(last, 0.0);
  }
}

// No redundancy: hip x, hip z and knee to the ankle. The pose is the same for every W.
TEST(IkRobust, WeightsChangeNothingOnAChainWithoutRedundancy) {
  IkChain c;
  c.dofs = 3;
  c.dof[0] = {kZ, vec3(0.0)};
  c.dof[1] = {kX, vec3(0.0, -0.42, 0.0)};
  c.dof[2] = {kX, vec3(0.0, -0.42, 0.0), 1.0 * kDegree, 150.0 * kDegree};
  IkAngles even{}, stiff{};
  even[2] = stiff[2] = 0.3;
  const auto rows = point_goal(vec3(0.0), vec3(0.05, -0.75, 0.2));
  solve_robust(c, rows, {}, even);
  c.dof[1].weight = 0.1;
  solve_robust(c, rows, {}, stiff);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(even[j], stiff[j], 1e-5);
}

TEST(IkRobust, OutOfReachIsFlaggedAndStretchesTowardsTheGoal) {
  Random random(27);
  const IkChain c = human_leg();
  for (int trial = 0; trial < 2000; ++trial) {
    const double far = trial % 2 ? random.between(0.96, 1.5) : random.between(2.0, 1e6);
    const vec3 direction = glm::normalize(vec3(0.0, -1.0, 0.0) + 0.3 * random.direction());
    const auto rows = point_goal(kHeel, far * direction);
    IkAngles q = standing();
    const IkResult result = solve_robust(c, rows, {}, q);
    ASSERT_EQ(result.status, IkStatus::unreachable);
    ASSERT_TRUE(within_limits(c, q));
    ASSERT_NEAR(result.error_m, error_of(c, rows, q), 1e-9 * far);
    if (trial % 2) {
      EXPECT_LT(result.error_m, far - (0.84 + glm::length(kHeel)) + 0.02);
    }
  }
}

TEST(IkRobust, AGoalThatWandersOutOfReachIsFollowedWithoutAJerk) {
  const IkChain c = human_leg();
  RobustOptions options;
  options.max_tries = 1;
  IkAngles q = standing(), last = q;
  IkAngles step{};
  for (int tick = 0; tick < 2400; ++tick) {
    const double sway = sin_cos(2.0 * kPi * tick / 240.0).sin;
    solve_robust(c, point_goal(kHeel, vec3(0.0, -0.96, 0.3 * sway)), options, q);
    for (int j = 0; j < c.dofs; ++j) {
      const double change = q[j] - last[j];
      if (tick > 20) {
        ASSERT_LT(std::abs(change - step[j]), 0.5 * kDegree) << tick;
      }
      step[j] = change;
    }
    last = q;
  }
}

TEST(IkRobust, NotFiniteInputsLeaveTheAnglesUntouched) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e200}) {
    const IkChain c = human_leg();
    IkAngles q = standing();
    q[0] = 2.0;  // outside the limits: not even clamped
    const IkAngles before = q;
    const IkResult result = solve_robust(c, point_goal(kHeel, vec3(0.0, bad, 0.1)), {}, q);
    EXPECT_EQ(result.status, IkStatus::not_finite);
    EXPECT_EQ(q, before);
  }
  for (const double bad : {std::nan(""), kInfinity}) {
    const auto rows = point_goal(kHeel, vec3(0.0, -0.8, 0.1));
    IkAngles q = standing();
    q[4] = bad;
    EXPECT_EQ(solve_robust(human_leg(), rows, {}, q).status, IkStatus::not_finite);
    for (int what = 0; what < 4; ++what) {
      IkChain c = human_leg();
      if (what == 0) c.dof[2].link_m.y = bad;
      if (what == 1) c.dof[3].weight = bad;
      if (what == 2) c.dof[3].axis.x = bad;
      if (what == 3) c.dof[3].min_rad = bad;
      q = standing();
      EXPECT_EQ(solve_robust(c, rows, {}, q).status, IkStatus::not_finite) << what;
      EXPECT_EQ(q, standing());
    }
  }
}

TEST(IkRobust, AnglesOutsideTheirLimitsComeBackInside) {
  Random random(28);
  const IkChain c = human_leg();
  for (int trial = 0; trial < 2000; ++trial) {
    IkAngles q{};
    for (int j = 0; j < c.dofs; ++j) q[j] = random.between(-4.0, 4.0);
    const double far_m = random.between(0.1, 2.0);
    const auto rows = point_goal(kHeel, far_m * random.direction());
    solve_robust(c, rows, {}, q);
    ASSERT_TRUE(within_limits(c, q));
  }
}

TEST(IkRobust, AFrozenKneeLeavesTheStepToTheOthersAndComesBack) {
  const IkChain c = human_leg();
  IkAngles q = standing();
  q[3] = c.dof[3].min_rad;
  const vec3 there = point_at(c, q, kHeel) + vec3(0.0, 0.0, 0.08);
  EXPECT_EQ(solve_robust(c, point_goal(kHeel, there), {}, q).status, IkStatus::converged);
  const vec3 up = point_at(c, q, kHeel) + vec3(0.0, 0.1, 0.0);
  EXPECT_EQ(solve_robust(c, point_goal(kHeel, up), {}, q).status, IkStatus::converged);
  EXPECT_GT(q[3], 10.0 * kDegree);
}

TEST(IkRobust, TheTraceEndsWithTheAnswerAndItsErrorsDoNotRiseWithinATry) {
  const IkChain c = human_leg();
  std::array<IkAngles, 200> poses;
  std::array<double, 200> error_m;
  IkTrace trace{poses, error_m};
  IkAngles q = standing();
  const IkResult result = solve_robust(c, point_goal(kHeel, vec3(0.05, -0.6, 0.4)), {}, q, &trace);
  ASSERT_EQ(result.tries, 1);
  ASSERT_EQ(trace.rows, result.iterations + 1);
  EXPECT_EQ(poses[static_cast<std::size_t>(result.iterations)], q);
  for (int k = 1; k < trace.rows; ++k) {
    EXPECT_LE(error_m[static_cast<std::size_t>(k)], error_m[static_cast<std::size_t>(k - 1)]);
  }
}

}  // namespace
}  // namespace gaitpad::test
