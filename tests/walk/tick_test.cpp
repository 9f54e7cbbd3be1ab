// Steady walks, changes of pace, and walks side by side. Starts, stops and turns: changes_test.cpp.
#include <gtest/gtest.h>

#include "tests/walk/made_block.h"
#include "walk/hips.h"
#include "walk/walk.h"

namespace gaitpad {
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

// Slow steps, and those on the spot, too: a change of pace must not lead them without end.
TEST(SteadyWalk, RollsAsTheStridesWereMade) {
  for (float ratio = 0.0f; ratio < 2.0f; ratio += 0.05f)
    for (const float share : {0.03f, 0.12f, 0.25f})
      EXPECT_NEAR(roll_share(share, ratio), roll_time_share(share, ratio), 1e-7) << ratio;
}

TEST(SteadyWalk, RollsForTheShareThatItsStepsAskFor) {
  for (const vec2& stick : {vec2(0.0, 0.2), vec2(0.0, 0.8), vec2(0.0, -0.5), vec2(0.9, 0.0)}) {
    const GaitParams params = params_of(stick.x, stick.y);
    Alone walk;
    walk.walk(params, 8 * kRate);
    const StrideParams& stride = params.stride[kLeftSide];
    const double ratio = stride.length_m / walk.tables.leg[kLeftSide].own_step_m,
                 share = roll_time_share(walk.tables.stage_share[0], ratio);
    EXPECT_NEAR(walk.block.state.roll_ticks, 2.0 * stride.time_s * share * kRate, 1.0) << stick.x;
    EXPECT_EQ(walk.block.change.led, 0.0f) << stick.x << " " << stick.y;
  }
}

// The share of the tables that a walk shows goes on with its rate where a stop is planned, and
// where the stick comes back.
TEST(ChangeOfPlan, ShowsTheTablesWithoutAKink) {
  constexpr double kMostBend = 0.002;  // per tick^2: a fade of 0.3 s has 0.001
  double most = 0.0;
  for (int stops = 0; stops < kRate; stops += kRate / 8) {
    for (int resumes = kRate / 20; resumes < kRate; resumes += kRate / 20) {
      Alone walk;
      double last = 0.0, before = 0.0;
      const auto go = [&](double y, int ticks) {
        for (int tick = 0; tick < ticks; ++tick) {
          walk.step(params_of(0.0, y));
          const double shown = walk.block.change.shown;
          most = std::max(most, std::abs(shown - 2.0 * last + before));
          before = last, last = shown;
        }
      };
      go(0.8, 2 * kRate + stops), go(0.0, resumes), go(0.8, kRate);
    }
  }
  EXPECT_LT(most, kMostBend);
}

// Where the hips of a start, of two changes of pace and of a stop are, every 0.05 s.
std::vector<double> places_at(int rate_hz, double begin_s) {
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  std::vector<double> places_m;
  for (int tick = 0; tick < 8 * rate_hz; ++tick) {
    const double time_s = double(tick) / rate_hz - begin_s, y = time_s < 2.0   ? 0.4
                                                                : time_s < 4.0 ? 1.0
                                                                : time_s < 6.0 ? 0.4
                                                                               : 0.0;
    advance(adult(), params_of(0.0, y), IkMode::robust, 1.0 / rate_hz, state, pose);
    if ((tick + 1) % (rate_hz / 20) == 0) places_m.push_back(pose.root_m.z);
  }
  return places_m;
}

TEST(ChangeOfPlan, ReadsTheTablesAroundAStrikeOverTheSameTimeAtAnyRate) {
  for (const int rate_hz : {20, 60, 240, 1000}) {
    const Tables tables = tables_of(adult(), 1.0 / rate_hz);
    EXPECT_NEAR(aim_ticks(tables) / rate_hz, tables.time_scale / 60.0, 1e-6) << rate_hz;
  }
}

// Changes that begin just before or after a strike may take another step at another rate, so this
// is the median over some moments.
TEST(ChangeOfPlan, LeadsTheHipsAlikeAtAnyRate) {
  constexpr int kTimes = 9;
  for (const int rate_hz : {20, 60, 1000}) {
    std::array<double, kTimes> off_m{};
    for (int k = 0; k < kTimes; ++k) {
      const std::vector<double> usual = places_at(240, 0.1 * k),
                                places = places_at(rate_hz, 0.1 * k);
      for (std::size_t i = 0; i < usual.size(); ++i)
        off_m[k] = std::max(off_m[k], std::abs(places[i] - usual[i]));
    }
    std::sort(off_m.begin(), off_m.end());
    std::printf("%d Hz: %.4f m, %.4f to %.4f\n", rate_hz, off_m[kTimes / 2], off_m.front(),
                off_m.back());
    EXPECT_LT(off_m[kTimes / 2], 0.041) << rate_hz;
  }
}

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
}  // namespace gaitpad
