#include "animation/leg_ik.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/animation/random.h"

namespace gaitpad::test {
namespace {

// A leg, the six rows of its foot, and where its solver starts.
struct Leg {
  IkChain chain;
  std::array<IkRow, 6> rows;
  IkAngles start{};
};

// `from_goal_rad`: how far the start is from a pose that meets the rows; `off_m`: how far all goals
// are shifted from that pose.
Leg random_leg(Random& random, double from_goal_rad, double off_m, double least_weight) {
  const std::array<vec3, kLegDofs> axis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0),
                                           vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 0, 1),
                                           vec3(0, 1, 0)};
  const std::array<double, kLegDofs> low = {-120, -50, -70, 1, -60, -60, -80},
                                     high = {60, 50, 70, 150, 75, 60, 80};
  Leg leg;
  leg.chain.dofs = kLegDofs;
  IkAngles pose{};
  for (int j = 0; j < kLegDofs; ++j) {
    IkDof& dof = leg.chain.dof[j];
    dof.axis = axis[j];
    dof.min_rad = low[j] * kDegree, dof.max_rad = high[j] * kDegree;
    dof.weight = random.between(least_weight, 1.0);
    pose[j] = random.between(0.6 * dof.min_rad, 0.6 * dof.max_rad);
    leg.start[j] = pose[j] + random.between(-from_goal_rad, from_goal_rad);
  }
  leg.chain.dof[kHipY].link_m = vec3(0.0, -random.between(0.2, 0.6), 0.0);
  leg.chain.dof[kKneeX].link_m = vec3(0.0, -random.between(0.2, 0.6), 0.0);
  leg.chain.dof[kKneeX].weight = 1.0;  // the knee has the largest weight of the chain
  const vec3 heel(0.01, -0.08, -0.05), toe(0.03, -0.06, 0.14), line = toe - heel;
  const vec3 side = glm::normalize(glm::cross(kUp, line)), beside = heel + 0.1 * side;
  const IkFrame end = end_frame(leg.chain, pose);
  const vec3 off = random.inside(off_m);
  const auto row = [&](const vec3& point, const vec3& direction) {
    const vec3 place = end.position_m + end.rotation * point + off;
    return IkRow{point, direction, glm::dot(direction, place)};
  };
  const vec3 s = end.rotation * side, along = end.rotation * glm::normalize(line),
             across = glm::cross(along, s);
  leg.rows = {row(heel, s), row(heel, across), row(heel, along),
              row(toe, s),  row(toe, across),  row(beside, across)};
  return leg;
}

// kLegs legs are solved together in registers of kNumbers numbers.
template <int kLegs, int kNumbers>
struct CompiledFor {
  static constexpr int kWidth = kLegs, kRegister = kNumbers;
};

template <class Compiled>
class LegIk : public testing::Test {
 protected:
  static constexpr int kWidth = Compiled::kWidth, kRegister = Compiled::kRegister;
  using Legs = std::array<LegToSolve, kWidth>;

  void SetUp() override {
    if (widest_lanes() < kRegister)
      GTEST_SKIP() << "this processor has no " << kRegister << " lanes";
  }
  static Vec3Of<double> three(const vec3& v) { return {v.x, v.y, v.z}; }
  static LegToSolve to_solve(const Leg& leg) {
    LegToSolve one;
    LegGoals<double>& goals = one.goals;
    goals.thigh_m = -leg.chain.dof[kHipY].link_m.y;
    goals.shank_m = -leg.chain.dof[kKneeX].link_m.y;
    for (int j = 0; j < kLegDofs; ++j) {
      goals.weight[j] = leg.chain.dof[j].weight;
      goals.min_rad[j] = leg.chain.dof[j].min_rad;
      goals.max_rad[j] = leg.chain.dof[j].max_rad;
      one.angles_rad[j] = leg.start[j];
    }
    goals.point_m = {three(leg.rows[0].point_m), three(leg.rows[3].point_m),
                     three(leg.rows[5].point_m)};
    goals.side = three(leg.rows[0].direction);
    goals.across = three(leg.rows[1].direction);
    goals.along = three(leg.rows[2].direction);
    for (int r = 0; r < 6; ++r) goals.goal_m[r] = leg.rows[r].goal_m;
    return one;
  }
  static Legs solved(const std::vector<Leg>& legs) {
    Legs several;
    std::array<LegToSolve*, kWidth> places;
    for (int lane = 0; lane < kWidth; ++lane) {
      several[lane] = to_solve(legs[lane]);
      places[lane] = &several[lane];
    }
    solve_legs<kWidth, false, kRegister>(places);
    return several;
  }
  // A leg for each lane; the legs differ in difficulty.
  static std::vector<Leg> random_legs(Random& random, double off_m, double limit_rad) {
    std::vector<Leg> legs;
    for (int lane = 0; lane < kWidth; ++lane)
      legs.push_back(lane % 2 == 0 ? random_leg(random, off_m, 0.0, limit_rad == 0.0 ? 1.0 : 0.05)
                                   : random_leg(random, off_m, limit_rad, 0.05));
    return legs;
  }
  // Expects that every leg has the angles, error and iterations that solve_robust() gives it alone.
  static void expect_same(const std::vector<Leg>& legs, int number) {
    const Legs lanes = solved(legs);
    for (int lane = 0; lane < kWidth; ++lane) {
      IkAngles alone = legs[lane].start;
      const IkResult result = solve_robust(legs[lane].chain, legs[lane].rows, kRobust, alone);
      for (int j = 0; j < kLegDofs; ++j) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(lanes[lane].angles_rad[j]),
                  std::bit_cast<std::uint64_t>(alone[j]))
            << "legs " << number << ", lane " << lane << ", angle " << j;
      }
      const auto& solution = lanes[lane].solution;
      EXPECT_EQ(static_cast<int>(solution.iterations), result.iterations) << number;
      EXPECT_EQ(std::sqrt(solution.squares), result.error_m) << number;
      const vec3 heel(solution.heel_m.x, solution.heel_m.y, solution.heel_m.z);
      const IkFrame end = end_frame(legs[lane].chain, alone);
      EXPECT_LT(glm::distance(heel, end.position_m + end.rotation * legs[lane].rows[0].point_m),
                1e-12)
          << number;
    }
  }
};
using Widths = testing::Types<CompiledFor<2, 2>, CompiledFor<2, 4>, CompiledFor<2, 8>,
                              CompiledFor<4, 4>, CompiledFor<8, 8>>;
TYPED_TEST_SUITE(LegIk, Widths);

TYPED_TEST(LegIk, GivesTheBitsOfTheGeneralSolverNearTheGoal) {
  Random random(1);
  for (int k = 0; k < 2000; ++k) this->expect_same(this->random_legs(random, 0.02, 0.0), k);
}

TYPED_TEST(LegIk, GivesTheBitsOfTheGeneralSolverAtLimitsAndOutOfReach) {
  Random random(2);
  for (int k = 0; k < 500; ++k) this->expect_same(this->random_legs(random, 0.8, 0.4), k);
}

TYPED_TEST(LegIk, AnInputThatIsNotFiniteFailsAloneAndEnds) {
  Random random(4);
  std::vector<Leg> legs = this->random_legs(random, 0.02, 0.0);
  legs[0].rows[2].goal_m = std::nan("");
  const auto lanes = this->solved(legs);
  EXPECT_FALSE(lanes[0].solution.squares <= 1e-12);
  for (std::size_t lane = 1; lane < legs.size(); ++lane) {
    EXPECT_LE(lanes[lane].solution.squares, 1e-12);
    for (int j = 0; j < kLegDofs; ++j) EXPECT_TRUE(std::isfinite(lanes[lane].angles_rad[j]));
  }
}

// --- The closed form -----------------------------------------------------------------------------

Vec3Of<double> parts(const vec3& v) { return {v.x, v.y, v.z}; }

// Two legs, each with a pose that it can take as its goal and a start `off_rad` away from it.
struct ClosedLegs {
  std::array<IkChain, 2> chain;
  std::array<IkAngles, 2> pose{}, start{};
  std::array<IkFrame, 2> goal;
  std::array<LegToClose, 2> legs;

  ClosedLegs(Random& random, double off_rad) {
    for (int i : {0, 1}) {
      const Leg leg = random_leg(random, 0.0, 0.0, 1.0);
      chain[i] = leg.chain;
      pose[i] = start[i] = leg.start;
      goal[i] = end_frame(chain[i], pose[i]);
      PlannedLeg<double>& planned = legs[i].planned;
      planned.thigh_m = -chain[i].dof[kHipY].link_m.y;
      planned.shank_m = -chain[i].dof[kKneeX].link_m.y;
      planned.ankle_m = parts(goal[i].position_m);
      planned.foot_x = parts(goal[i].rotation * kLeft);
      planned.foot_y = parts(goal[i].rotation * kUp);
      planned.foot_z = parts(goal[i].rotation * kForward);
      for (int j = 0; j < kLegDofs; ++j) {
        start[i][j] += random.between(-off_rad, off_rad);
        legs[i].angles_rad[j] = start[i][j];
        planned.min_rad[j] = chain[i].dof[j].min_rad;
        planned.max_rad[j] = chain[i].dof[j].max_rad;
      }
    }
    close_two_legs(legs);
  }
  IkAngles closed(int i) const {
    IkAngles all{};
    std::copy(legs[i].angles_rad.begin(), legs[i].angles_rad.end(), all.begin());
    return all;
  }
  double way(int i, const IkAngles& to) const {
    double squares = 0.0;
    for (int j = 0; j < kLegDofs; ++j) squares += (to[j] - start[i][j]) * (to[j] - start[i][j]);
    return std::sqrt(squares);
  }
};

TEST(LegInClosedForm, BringsTheFootExactlyToItsPlaceByTheNearestPose) {
  Random random(7);
  int reached = 0;
  for (int k = 0; k < 2000; ++k) {
    const ClosedLegs both(random, 0.01);
    for (int i : {0, 1}) {
      if (both.legs[i].reached == 0.0) continue;
      ++reached;
      const IkFrame end = end_frame(both.chain[i], both.closed(i));
      EXPECT_LT(glm::distance(end.position_m, both.goal[i].position_m), 1e-9) << k;
      EXPECT_LT(glm::length(rotation_vector(glm::conjugate(both.goal[i].rotation) * end.rotation)),
                1e-9)
          << k;
      // The pose that the goal was made from is one of those that reach it.
      EXPECT_LT(both.way(i, both.closed(i)), 1.01 * both.way(i, both.pose[i]) + 1e-6) << k;
    }
  }
  EXPECT_GT(reached, 3000);
}

TEST(LegInClosedForm, LeavesALegAloneThatIsTooShortOrFarFromItsStart) {
  Random random(8);
  int missed = 0;
  for (int k = 0; k < 200; ++k) {
    ClosedLegs both(random, 0.0);
    for (LegToClose& leg : both.legs) {
      const double most_m = leg.planned.thigh_m + leg.planned.shank_m;
      leg.planned.ankle_m = {0.0, -most_m - 0.001, 0.0};
    }
    const std::array<LegAngles, 2> before = {both.legs[0].angles_rad, both.legs[1].angles_rad};
    close_two_legs(both.legs);
    for (int i : {0, 1}) {
      EXPECT_EQ(both.legs[i].reached, 0.0);
      EXPECT_EQ(both.legs[i].angles_rad, before[i]);
    }
    const ClosedLegs far(random, 0.5);
    for (int i : {0, 1}) {
      if (far.legs[i].reached == 0.0) EXPECT_EQ(far.closed(i), far.start[i]);
      missed += far.legs[i].reached == 0.0;
    }
  }
  EXPECT_GT(missed, 390);  // of 400 legs
}

TEST(Lanes, SineAndCosineAreThoseOfOneNumber) {
  Random random(5);
  for (int k = 0; k < 20'000; ++k) {
    Lanes<2> angle, sine, cosine;
    for (int lane : {0, 1}) angle[lane] = random.between(-8.0, 8.0) * (k % 5 == 0 ? 1e4 : 1.0);
    sin_cos_of(angle, sine, cosine);
    for (int lane : {0, 1}) {
      const SinCos alone = sin_cos(angle[lane]);
      EXPECT_EQ(sine[lane], alone.sin) << angle[lane];
      EXPECT_EQ(cosine[lane], alone.cos) << angle[lane];
    }
  }
}

}  // namespace
}  // namespace gaitpad::test
