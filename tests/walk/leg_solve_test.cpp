// The closed form of a leg: forward kinematics of its answer is where the foot was to be.
#include "walk/leg_solve.h"

#include <gtest/gtest.h>

#include <array>

#include "gaitpad/ik.h"
#include "gaitpad/limbs.h"
#include "tests/animation/random.h"
#include "tests/walk/made_block.h"

namespace gaitpad {
namespace {

constexpr float kThigh_m = 0.42f, kShank_m = 0.41f;

using Angles = std::array<float, kLegAngles>;
struct Goal {
  Vec<float> ankle_m;
  Turn<float> foot;
};
Turn<float> turn_of(float x, float z, float y) {
  const Turn<float> turns[3] = {turn_about(Vec<float>{1.0f, 0.0f, 0.0f}, x),
                                turn_about(Vec<float>{0.0f, 0.0f, 1.0f}, z),
                                turn_about(Vec<float>{0.0f, 1.0f, 0.0f}, y)};
  return turns[0] * turns[1] * turns[2];
}
Goal posed(const Turn<float>& hip, const Turn<float>& knee, const Turn<float>& ankle) {
  const Turn<float> shank = hip * knee;
  return {hip * Vec<float>{0.0f, -kThigh_m, 0.0f} + shank * Vec<float>{0.0f, -kShank_m, 0.0f},
          shank * ankle};
}
Goal goal_of(const Angles& a) {
  return posed(turn_of(a[0], a[1], a[2]), turn_of(a[3], 0.0f, 0.0f), turn_of(a[4], a[5], a[6]));
}
// Angles of a leg in a walk.
Angles random_angles(test::Random& random) {
  constexpr Angles kLow = {-0.6f, -0.2f, -0.3f, 0.1f, -0.4f, -0.2f, -0.3f},
                   kHigh = {0.4f, 0.2f, 0.3f, 1.1f, 0.3f, 0.2f, 0.3f};
  Angles angles;
  for (int j = 0; j < kLegAngles; ++j)
    angles[j] = static_cast<float>(random.between(kLow[j], kHigh[j]));
  return angles;
}
Angles near(const Angles& angles, test::Random& random, double off_rad) {
  Angles moved = angles;
  for (float& angle : moved) angle += static_cast<float>(random.between(-off_rad, off_rad));
  moved[3] = std::max(moved[3], kLeastKnee_rad);
  return moved;
}
Leg<float> solved(const Goal& goal, const Angles& start, Angles& moved) {
  LegGoal<float> of{kThigh_m, kShank_m, goal.ankle_m, goal.foot, {}, {}};
  std::copy(start.begin(), start.end(), of.table_rad);
  const Leg<float> leg = solve_leg(of);
  for (int j = 0; j < kLegAngles; ++j) moved[j] = start[j] + of.off_rad[j];
  return leg;
}

TEST(LegSolve, PutsTheFootExactlyWhereItIsToBe) {
  constexpr double kSame_m = 2e-6;
  test::Random random(3);
  for (int k = 0; k < 2000; ++k) {
    const Angles angles = random_angles(random);
    const Goal goal = goal_of(angles);
    Angles moved;
    const Leg<float> leg = solved(goal, near(angles, random, 0.1), moved);
    EXPECT_EQ(leg.short_m, 0.0f);
    const Goal is = posed(leg.hip, leg.knee, leg.ankle);
    const Vec<float> off = is.ankle_m - goal.ankle_m;
    EXPECT_LT(std::sqrt(dot(off, off)), kSame_m);
    const Turn<float> turn = back(goal.foot) * is.foot;
    EXPECT_LT(std::abs(turn.x) + std::abs(turn.y) + std::abs(turn.z), 1e-5f);
  }
}

TEST(LegSolve, LeavesALegThatIsThereAsItIs) {
  test::Random random(4);
  for (int k = 0; k < 500; ++k) {
    const Angles angles = random_angles(random);
    Angles moved;
    solved(goal_of(angles), angles, moved);
    for (int j = 0; j < kLegAngles; ++j) EXPECT_NEAR(moved[j], angles[j], 2e-5) << j;
  }
}

// The solver of chains, with even weights, goes the least way, too.
TEST(LegSolve, GoesAsFarAsTheGeneralSolver) {
  constexpr std::array<vec3, kLegDofs> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0),
                                                vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 0, 1),
                                                vec3(0, 1, 0)};
  IkChain chain;
  chain.dofs = kLegDofs;
  for (int j = 0; j < kLegDofs; ++j) chain.dof[j].axis = kAxis[j];
  chain.dof[kHipY].link_m = vec3(0.0, -kThigh_m, 0.0);
  chain.dof[kKneeX].link_m = vec3(0.0, -kShank_m, 0.0);
  test::Random random(5);
  for (int k = 0; k < 200; ++k) {
    const Angles angles = random_angles(random), start = near(angles, random, 0.02);
    IkAngles goal_rad{}, general{};
    for (int j = 0; j < kLegDofs; ++j) goal_rad[j] = angles[j], general[j] = start[j];
    const IkFrame end = end_frame(chain, goal_rad);
    std::array<IkRow, 6> rows;
    const std::array<vec3, 3> points = {vec3(0.0), vec3(0.0, 0.0, 0.2), vec3(0.1, 0.0, 0.0)};
    const auto row = [&](const vec3& point, const vec3& direction) {
      return IkRow{point, direction, glm::dot(direction, end.position_m + end.rotation * point)};
    };
    rows = {row(points[0], kLeft),
            row(points[0], kUp),
            row(points[0], kForward),
            row(points[1], end.rotation * kLeft),
            row(points[1], end.rotation * kUp),
            row(points[2], end.rotation * kUp)};
    ASSERT_EQ(solve_robust(chain, rows, RobustOptions{}, general).status, IkStatus::converged);
    Angles moved;
    solved(goal_of(angles), start, moved);
    double closed = 0.0, iterated = 0.0;
    for (int j = 0; j < kLegDofs; ++j) {
      closed += (moved[j] - start[j]) * (moved[j] - start[j]);
      iterated += (general[j] - start[j]) * (general[j] - start[j]);
    }
    EXPECT_LE(std::sqrt(closed), 1.05 * std::sqrt(iterated) + 1e-4) << k;
  }
}

TEST(LegSolve, SaysByHowMuchALegIsTooShort) {
  Angles moved;
  const Goal far{{0.0f, -0.9f, 0.0f}, {1.0f, 0.0f, 0.0f, 0.0f}};
  const Leg<float> leg = solved(far, {0.0f, 0.0f, 0.0f, 0.1f, 0.0f, 0.0f, 0.0f}, moved);
  const Goal is = posed(leg.hip, leg.knee, leg.ankle);
  EXPECT_NEAR(leg.short_m, 0.9f - (kThigh_m + kShank_m), 1e-4);
  EXPECT_NEAR(is.ankle_m.y, -0.9f + leg.short_m, 1e-5);
}

}  // namespace
}  // namespace gaitpad
