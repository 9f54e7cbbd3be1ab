// Starts, stops, changes of pace and reversals, and walks side by side.
#include "walk/walk.h"

#include <gtest/gtest.h>

#include "tests/walk/made_block.h"

namespace gaitpad::anew {
namespace {

constexpr double kMostSlid_m = 1e-5;

// Walks straight, backward and in turns: planted points stay, and hips do not jump.
class Pace : public testing::TestWithParam<vec2> {};

TEST_P(Pace, PlantsFeetThatDoNotMove) {
  Alone walk;
  walk.walk(params_of(GetParam().x, GetParam().y), 6 * kRate);
  double slid_m = 0.0;
  Planted was_planted;
  vec3 was;
  Jerks jerks;
  for (int tick = 0; tick < 8 * kRate; ++tick) {
    const Planted planted = planted_of(walk.block);
    walk.step();
    jerks.add(walk.pose);
    const vec3 place = end_of(walk.pose, planted.side, planted.toe);
    if (tick > 0 && planted == was_planted) slid_m = std::max(slid_m, glm::distance(place, was));
    was = place, was_planted = planted;
  }
  std::printf("planted points move %.5f mm a tick; second differences %.3f deg/tick^2\n",
              slid_m * 1e3, jerks.most_deg);
  EXPECT_LE(slid_m, kMostSlid_m);
  EXPECT_LE(jerks.most_deg, 1.0);
}
INSTANTIATE_TEST_SUITE_P(Straight, Pace,
                         testing::Values(vec2(0.0, 0.3), vec2(0.0, 0.8), vec2(0.0, 1.0)));
INSTANTIATE_TEST_SUITE_P(Backward, Pace, testing::Values(vec2(0.0, -0.5), vec2(0.0, -1.0)));
INSTANTIATE_TEST_SUITE_P(Turning, Pace, testing::Values(vec2(-0.3, 0.8), vec2(0.7, 0.7)));

// From the one stick to the other, at ten moments of a step: hips are no lower than in the steady
// walks.
class ChangeOfPace : public testing::TestWithParam<std::array<double, 2>> {};

TEST_P(ChangeOfPace, LeadsOverSoftly) {
  constexpr double kMostDip_m = 0.01, kMostBend_deg = 1.2;
  const auto [from, to] = GetParam();
  double bend = 0.0, dip_m = 0.0;
  for (int wait = 0; wait < kRate; wait += kRate / 10) {
    Alone walk;
    walk.walk(params_of(0.0, from), 6 * kRate);
    Jerks jerks;
    double low_m = 9.0, steady_m = 9.0;
    const int ticks = wait + 6 * kRate;
    for (int tick = 0; tick < ticks + kRate; ++tick) {
      walk.step(params_of(0.0, tick < kRate + wait ? from : to));
      jerks.add(walk.pose);
      if (tick < kRate || tick >= ticks) steady_m = std::min(steady_m, walk.pose.root_m.y);
      low_m = std::min(low_m, walk.pose.root_m.y);
    }
    bend = std::max(bend, jerks.most_deg);
    dip_m = std::max(dip_m, steady_m - low_m);
  }
  std::printf("second differences %.3f deg/tick^2; hips %.1f mm lower\n", bend, dip_m * 1e3);
  EXPECT_LE(bend, kMostBend_deg);
  EXPECT_LE(dip_m, kMostDip_m);
}
INSTANTIATE_TEST_SUITE_P(From, ChangeOfPace,
                         testing::Values(std::array<double, 2>{0.3, 1.0},
                                         std::array<double, 2>{1.0, 0.3},
                                         std::array<double, 2>{0.8, 1.0}));

// From a stand to a walk and back again.
struct Journey {
  double bend_deg = 0.0;             // greatest second differences of the legs
  double dip_m = 0.0, back_m = 0.0;  // hips below the steady walk's lowest; on their way back
  double forwards_m_s2 = 0.0, stop_s = 0.0;
  double slid_m = 0.0, deep_m = 0.0;  // planted points in a tick; heels and toes below the floor
};
// `y` = 0: turns in place by `x` rad/s.
GaitParams params_of_journey(double x, double y) {
  GaitParams params = params_of(x, y > 0.0 ? y : 0.5);
  if (y > 0.0) return params;
  for (StrideParams& stride : params.stride) stride.length_m = 0.0;
  params.turn_rate_rad_s = x;
  return params;
}
Journey go(double x, double y, int stop_after) {
  constexpr int kStand = 30, kStop = 2 * kRate;
  Alone walk;
  const Pose& pose = walk.pose;
  Jerks jerks;
  Journey journey;
  double low_m = 9.0, steady_m = 9.0;
  std::array<double, 9> z{};
  vec3 was;
  Planted was_planted;
  for (int tick = 0; tick < kStand + stop_after + kStop; ++tick) {
    GaitParams params;
    if (tick >= kStand && tick < kStand + stop_after) params = params_of_journey(x, y);
    const Planted planted = planted_of(walk.block);
    walk.step(params);
    if (tick < 20) continue;
    jerks.add(pose);
    for (int i = 8; i > 0; --i) z[i] = z[i - 1];
    z[0] = pose.root_m.z;
    if (tick > 30) {
      const double per_s2 = kRate * kRate / 16.0;
      journey.forwards_m_s2 =
          std::max(journey.forwards_m_s2, std::abs(z[0] - 2.0 * z[4] + z[8]) * per_s2);
      if (x == 0.0) journey.back_m = std::max(journey.back_m, z[1] - z[0]);
    }
    for (const Side side : {kLeftSide, kRightSide}) {
      for (const bool toe : {false, true}) {
        const double rest_m = toe ? adult().leg[side].model.toe_rest_m : 0.0;
        journey.deep_m = std::max(journey.deep_m, rest_m - end_of(pose, side, toe).y);
      }
    }
    const vec3 place = end_of(pose, planted.side, planted.toe);
    if (planted == was_planted)
      journey.slid_m = std::max(journey.slid_m, glm::distance(place, was));
    was = place, was_planted = planted;
    low_m = std::min(low_m, pose.root_m.y);
    if (walk.stands() && tick > kStand + stop_after && journey.stop_s == 0.0)
      journey.stop_s = (tick - kStand - stop_after) * kDt;
  }
  Alone steady;
  steady.walk(params_of_journey(x, y), 6 * kRate);
  for (int tick = 0; tick < kRate; ++tick) {
    steady.step();
    steady_m = std::min(steady_m, steady.pose.root_m.y);
  }
  journey.bend_deg = jerks.most_deg;
  journey.dip_m = steady_m - low_m;
  return journey;
}

class Start : public testing::TestWithParam<vec2> {};

TEST_P(Start, LeavesTheStandAndComesBackToItSoftly) {
  constexpr double kMostBend_deg = 1.3, kMostDip_m = 0.014, kMostBack_m = 1e-4,
                   kSlowestStop_s = 1.5, kMostSlid_m = 1e-4, kDeepest_m = 0.01;
  Journey most;
  double quickest_s = 9.0;
  for (int stop_after = 2 * kRate; stop_after < 3 * kRate; stop_after += kRate / 5) {
    const Journey journey = go(GetParam().x, GetParam().y, stop_after);
    EXPECT_GT(journey.stop_s, 0.0);
    quickest_s = std::min(quickest_s, journey.stop_s);
    for (const auto part : {&Journey::bend_deg, &Journey::dip_m, &Journey::back_m,
                            &Journey::forwards_m_s2, &Journey::stop_s, &Journey::slid_m,
                            &Journey::deep_m})
      most.*part = std::max(most.*part, journey.*part);
  }
  std::printf(
      "second differences %.3f deg/tick^2; hips %.1f mm lower, forwards %.1f m/s^2, back %.4f mm a "
      "tick; stands after %.2f to %.2f s; planted points move %.4f mm a tick; %.1f mm below the "
      "floor\n",
      most.bend_deg, most.dip_m * 1e3, most.forwards_m_s2, most.back_m * 1e3, quickest_s,
      most.stop_s, most.slid_m * 1e3, most.deep_m * 1e3);
  EXPECT_LE(most.bend_deg, kMostBend_deg);
  EXPECT_LE(most.dip_m, kMostDip_m);
  EXPECT_LE(most.back_m, kMostBack_m);
  EXPECT_LE(most.stop_s, kSlowestStop_s);
  EXPECT_LE(most.slid_m, kMostSlid_m);
  EXPECT_LE(most.deep_m, kDeepest_m);
}
INSTANTIATE_TEST_SUITE_P(AndStop, Start,
                         testing::Values(vec2(0.0, 0.3), vec2(0.0, 0.8), vec2(0.0, 1.0),
                                         vec2(-0.3, 0.8), vec2(0.7, 0.7), vec2(0.9, 0.1),
                                         vec2(-0.9, 0.0), vec2(0.5, 0.0)));

// A walk whose hips are measured.
class Measured : public Alone {
 public:
  void walk(double x, double y, int ticks) {
    const GaitParams params = y == 0.0 && x == 0.0 ? GaitParams{} : params_of(x, y);
    for (int tick = 0; tick < ticks; ++tick) {
      step(params);
      for (std::size_t i = z_m.size() - 1; i > 0; --i) z_m[i] = z_m[i - 1];
      z_m[0] = pose.root_m.z;
      if (++ticks_ < 9) continue;
      const double per_s2 = kRate * kRate / 16.0, bend = (z_m[0] - 2.0 * z_m[4] + z_m[8]) * per_s2;
      forwards_m_s2 = std::max(forwards_m_s2, bend);
      brakes_m_s2 = std::max(brakes_m_s2, -bend);
      slowest_m_s = std::min(slowest_m_s, (z_m[0] - z_m[1]) * kRate);
    }
  }
  void forget() { forwards_m_s2 = brakes_m_s2 = 0.0, slowest_m_s = 9.0; }
  double forwards_m_s2 = 0.0, brakes_m_s2 = 0.0, slowest_m_s = 9.0;  // the hips, over 4 ticks
  std::array<double, 9> z_m{};  // where they were, the last tick first

 private:
  int ticks_ = 0;
};
constexpr int kMoments = 12;

TEST(Stop, AtFullStickTakesNineTenthsOfASecondAndOfAMetre) {
  double slowest_s = 0.0, farthest_m = 0.0;
  std::vector<double> brakes_m_s2;
  for (int moment = 0; moment < kMoments; ++moment) {
    Measured walk;
    walk.walk(0.0, 1.0, 3 * kRate + moment * kRate * 11 / 10 / kMoments);
    walk.forget();
    const double from_m = walk.pose.root_m.z;
    int ticks = 0;
    for (; !walk.stands() && ticks < 2 * kRate; ++ticks) walk.walk(0.0, 0.0, 1);
    slowest_s = std::max(slowest_s, ticks * kDt);
    farthest_m = std::max(farthest_m, walk.pose.root_m.z - from_m);
    brakes_m_s2.push_back(walk.brakes_m_s2);
    EXPECT_GE(walk.slowest_m_s, -0.01) << moment;
  }
  std::sort(brakes_m_s2.begin(), brakes_m_s2.end());
  const double median = brakes_m_s2[kMoments / 2], worst = brakes_m_s2.back();
  std::printf("stands after %.2f s, %.2f m; brakes with %.1f m/s^2, most %.1f\n", slowest_s,
              farthest_m, median, worst);
  EXPECT_LE(slowest_s, 0.9);
  EXPECT_LE(farthest_m, 0.9);
  EXPECT_LE(median, 4.0);
  EXPECT_LE(worst, 6.0);
}

TEST(Stop, GoesOnIfTheStickComesBackInTime) {
  double forwards_m_s2 = 0.0, brakes_m_s2 = 0.0, slowest_m_s = 9.0;
  for (int moment = 0; moment < kMoments; ++moment) {
    Measured walk;
    walk.walk(0.0, 1.0, 3 * kRate + moment * kRate * 11 / 10 / kMoments);
    walk.forget();
    walk.walk(0.0, 0.0, kRate / 10);
    for (int tick = 0; tick < 2 * kRate; ++tick) {
      walk.walk(0.0, 1.0, 1);
      ASSERT_FALSE(walk.stands()) << moment;
    }
    forwards_m_s2 = std::max(forwards_m_s2, walk.forwards_m_s2);
    brakes_m_s2 = std::max(brakes_m_s2, walk.brakes_m_s2);
    slowest_m_s = std::min(slowest_m_s, walk.slowest_m_s);
  }
  std::printf("forwards %.1f, brakes %.1f m/s^2; slowest %.2f m/s\n", forwards_m_s2, brakes_m_s2,
              slowest_m_s);
  EXPECT_LE(forwards_m_s2, 6.0);
  EXPECT_LE(brakes_m_s2, 6.0);
  EXPECT_GE(slowest_m_s, 0.4);
}

TEST(Stand, HasItsAnklesBelowTheHipsBeforeAWalkAndAfterIt) {
  constexpr double kOff_m = 0.002;
  static JointFrames frames;
  Measured walk;
  const auto expect_hip_width = [&] {
    forward_kinematics(adult().cycle.skeleton, walk.pose, frames);
    for (const LegBuild& leg : adult().leg) {
      const vec3 &hip = frames.position_m[leg.joint[0].joint],
                 &ankle = frames.position_m[leg.joint[2].joint];
      EXPECT_NEAR(ankle.x, hip.x, kOff_m);
    }
  };
  walk.walk(0.0, 0.0, 10);
  expect_hip_width();
  for (const double y : {0.3, 1.0, -1.0}) {
    walk.walk(0.0, y, 2 * kRate);
    walk.walk(0.0, 0.0, 2 * kRate);
    ASSERT_TRUE(walk.stands());
    expect_hip_width();
  }
}

TEST(Reversal, LeadsBackWithinTwelveTenthsOfASecond) {
  constexpr double kGoes_m_s = 0.1;
  for (const double y : {1.0, -1.0}) {
    double slowest_s = 0.0, most_m_s2 = 0.0;
    for (int moment = 0; moment < kMoments; ++moment) {
      Measured walk;
      walk.walk(0.0, y, 3 * kRate + moment * kRate * 11 / 10 / kMoments);
      walk.forget();
      int ticks = 0;
      for (; (walk.z_m[1] - walk.z_m[0]) * kRate * y < kGoes_m_s && ticks < 2 * kRate; ++ticks)
        walk.walk(0.0, -y, 1);
      slowest_s = std::max(slowest_s, ticks * kDt);
      walk.walk(0.0, -y, kRate);
      most_m_s2 = std::max({most_m_s2, walk.forwards_m_s2, walk.brakes_m_s2});
    }
    std::printf("from %.0f: goes the other way after %.2f s; most %.1f m/s^2\n", y, slowest_s,
                most_m_s2);
    EXPECT_LE(slowest_s, 1.2);
    EXPECT_LE(most_m_s2, 6.0);
  }
}

// The fainter a push, the longer a stand waits whether it is meant, at most 0.2 s.
TEST(Stand, WaitsWhetherAFaintPushIsMeant) {
  double last_s = 0.3;
  for (const double faint : {0.02, 0.1, 0.3, 1.0}) {
    GaitParams params = params_of(0.0, 0.3);
    for (StrideParams& stride : params.stride) stride.length_m *= faint;
    Alone walk;
    int ticks = 0;
    for (; walk.stands() && ticks < kRate; ++ticks) walk.step(params);
    EXPECT_LE(ticks * kDt, std::min(last_s, 0.21)) << faint;
    last_s = ticks * kDt;
  }
  EXPECT_LE(last_s, 2.0 * kDt) << "one that is surely meant";
}

// Walks of different phases that stop, turn round and start again.
TEST(Widths, WalksSideBySideHaveTheBitsOfOneAlone) {
  for_each_width([](auto width) {
    Alone walk;
    walk.walk(params_of(0.2, 0.8), 4 * kRate);
    std::vector<Block<1>> alone;
    for (int w = 0; w < width; ++w) {
      for (int tick = 0; tick < 11 * w + 3; ++tick) walk.step();
      Asked<float>& asked = alone.emplace_back(walk.block).state.asked;
      asked.length_m[0] += 0.01f * static_cast<float>(w);
      if (w % 3 == 1) asked.length_m[1] *= 0.7f;
      if (w % 4 == 2) asked.walks = 0.0f;
      if (w % 4 == 3) asked.backward = 1.0f;
    }
    expect_bits_of_one<width>(walk.tables, alone, 600, [](int tick, int, Block<1>& block) {
      block.state.asked.walks = tick == 400 ? 1.0f : block.state.asked.walks;
      return tick == 400;
    });
  });
}

TEST(State, OfALevelWalkFitsIn512Bytes) { EXPECT_LE(sizeof(State<float>), 512u); }

}  // namespace
}  // namespace gaitpad::anew
