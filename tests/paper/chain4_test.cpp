#include "paper/chain4.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

TEST(Chain4, JointsAreThoseOfTheSolversForwardKinematics) {
  Lcg random(1);
  const IkChain chain = plane_chain({1.0, 1.0, 1.0, 1.0});
  for (int n = 0; n < 100; ++n) {
    const ChainTask task = near_task(random, {});
    const vec3 end = end_frame(chain, task.start_rad).position_m;
    EXPECT_LT(glm::distance(plane_end(chain, task.start_rad), vec2(end.x, end.y)), 1e-12);
    EXPECT_NEAR(end.z, 0.0, 1e-15);
  }
}

TEST(Chain4, AnswersReachTheGoalInBothModes) {
  Lcg random(2);
  for (int n = 0; n < 100; ++n) {
    const ChainTask task = near_task(random, {});
    for (const IkMode mode : {IkMode::paper, IkMode::robust}) {
      const IkChain chain = plane_chain({0.2, 1.0, 1.0, 1.0});
      const ChainSolve solve = solve_chain(chain, task, mode);
      EXPECT_EQ(solve.angles_rad.front(), task.start_rad);
      EXPECT_EQ(solve.angles_rad.size(), solve.error_m.size());
      EXPECT_LT(glm::distance(plane_end(chain, solve.answer()), task.goal_m),
                1.1 * kChainTolerance_m);
    }
  }
}

TEST(Chain4, GoalsAreNear) {
  Lcg random(3);
  const IkChain chain = plane_chain({1.0, 1.0, 1.0, 1.0});
  for (int n = 0; n < 1000; ++n) {
    const ChainTask task = near_task(random, {1.2, 0.1});
    const vec2 way = task.goal_m - plane_end(chain, task.start_rad);
    EXPECT_LE(std::max(std::fabs(way.x), std::fabs(way.y)), 0.1 * kChainLink_m);
    EXPECT_LE(std::fabs(task.start_rad[2]), 1.2);
  }
}

TEST(Chain4, RandomNumbersAreTheSameEverywhere) {
  Lcg random(2005);
  // The expected number is (2005 * 6364136223846793005 + 1442695040888963407 mod 2^64) >> 11, over
  // 2^53, computed by Python.
  EXPECT_EQ(random.between(0.0, 1.0), 7243978965043345.0 / 9007199254740992.0);
}

}  // namespace
}  // namespace gaitpad
