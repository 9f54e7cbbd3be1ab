// The walk over uneven ground, moved walks, aims and pushes.
#include <gtest/gtest.h>

#include "tests/walk/grounds.h"

namespace gaitpad {
namespace {

class OnHills : public testing::TestWithParam<std::array<double, 3>> {};

TEST_P(OnHills, PlantsSolesOnTheGroundWhereverItLeads) {
  constexpr double kOnGround_m = 1e-4;
  const auto [slope_x, slope_z, wave_m] = GetParam();
  const Hills hills{slope_x, slope_z, wave_m};
  const WalkModel model = model_on(asked_of(hills));
  double slid_m = 0.0, heel_off_m = 0.0, ball_off_m = 0.0, deep_m = 0.0;
  int steady_planning = 0, steady_ticks = 0, planning = 0, asked = 0, ticks = 0;
  for (const double heading : {0.0, 1.7}) {
    Alone hiker(model, {0.4, -0.3, heading});
    vec3 was;
    Planted was_planted;
    for (int tick = 0; tick < 12 * kRate; ++tick, ++ticks) {
      const Planted planted = planted_of(hiker.block);
      const bool rolls = hiker.block.state.tick >= hiker.block.state.roll_ticks - 2.0f &&
                         hiker.block.state.flies == 0.0f && hiker.block.change.stands == 0.0f;
      const int before = hills.calls;
      GaitParams params = params_of(0.0, 0.8);
      if (tick % (4 * kRate) > 2 * kRate) params = params_of(0.4, 0.6);
      hiker.step(params);
      if (tick % (4 * kRate) > kRate && tick % (4 * kRate) < 2 * kRate)
        steady_planning += hills.calls > before, ++steady_ticks;
      planning += hills.calls > before;
      asked += hills.calls - before;
      const vec3 place = end_of(hiker.pose, planted.side, planted.toe);
      if (tick > 0 && planted == was_planted) slid_m = std::max(slid_m, glm::distance(place, was));
      was = place, was_planted = planted;
      const vec3 heel = end_of(hiker.pose, planted.side, false);
      const double under = Hills::ask(&hills, heel.x, heel.z).height_m;
      --const_cast<Hills&>(hills).calls;
      if (!planted.toe) heel_off_m = std::max(heel_off_m, std::abs(heel.y - under));
      if (rolls && tick > kRate) {
        // Flat on its sole: the ball lies on the ground, too.
        static JointFrames frames;
        forward_kinematics(model.cycle.skeleton, hiker.pose, frames);
        const LegBuild& leg = model.leg[planted.side];
        const vec3 ball = frames.position_m[leg.model.joints.ankle] +
                          frames.rotation[leg.model.joints.ankle] *
                              (glm::conjugate(leg.model.standing[2]) * leg.ball_m);
        ball_off_m =
            std::max(ball_off_m, std::abs(ball.y - Hills::ask(&hills, ball.x, ball.z).height_m));
        --const_cast<Hills&>(hills).calls;
      }
      deep_m = std::max(deep_m, under - heel.y);
    }
  }
  std::printf(
      "planted points move %.5f mm a tick; heels %.4f, balls %.3f mm off the ground; %d of %d "
      "ticks "
      "ask, %.1f calls each; heels %.2f mm deep\n",
      slid_m * 1e3, heel_off_m * 1e3, ball_off_m * 1e3, planning, ticks,
      static_cast<double>(asked) / planning, deep_m * 1e3);
  EXPECT_LE(slid_m, kPlanted_m);
  EXPECT_LE(steady_planning, steady_ticks / 5);  // the pace still settles
  EXPECT_LE(heel_off_m, kOnGround_m);
}
INSTANTIATE_TEST_SUITE_P(Asked, OnHills,
                         testing::Values(std::array<double, 3>{0.0, 0.15, 0.0},
                                         std::array<double, 3>{0.15, 0.0, 0.0},
                                         std::array<double, 3>{-0.1, -0.1, 0.0},
                                         std::array<double, 3>{0.05, 0.0, 0.15}));

class OnStairs : public testing::TestWithParam<double> {};

TEST_P(OnStairs, ClearsTheEdgesFromAStandToAStand) {
  constexpr double kDeepest_m = 0.006;
  const WalkModel model =
      model_on(ground_of({FlatSection{2.5}, StairsSection{GetParam(), 0.28, 6}, FlatSection{4.0}}));
  double deep_m = 0.0, at_m = 0.0;
  for (const double y : {0.3, 0.8, 1.0}) {
    for (int wait = 0; wait < 60; wait += 12) {
      Alone hiker(model, {0.0, 0.01 * wait, 0.0});
      for (int tick = 0; tick < 14 * kRate; ++tick) {
        GaitParams params = params_of(0.0, y);
        if (tick < 20 || tick > 12 * kRate) params = GaitParams{};
        hiker.step(params);
        const double deep = deepest_m(model, hiker.pose);
        if (deep > deep_m) deep_m = deep, at_m = hiker.pose.root_m.z;
      }
      EXPECT_EQ(hiker.block.change.stands, 1.0f);
      EXPECT_GT(hiker.pose.root_m.z, 3.0);
      // It stands upright again, on its ground.
      const double over_m =
          hiker.pose.root_m.y - ground_at(*model.terrain, 0.0, hiker.pose.root_m.z).height_m;
      EXPECT_NEAR(over_m, hiker.tables.stand_m, 0.03) << y << " " << wait;
    }
  }
  std::printf("soles %.1f mm deep with the hips at %.3f m\n", deep_m * 1e3, at_m);
  EXPECT_LE(deep_m, kDeepest_m);
}
INSTANTIATE_TEST_SUITE_P(UpAndDown, OnStairs, testing::Values(0.17, -0.17, 0.1, -0.1));

// Walks of different phases up and down stairs.
TEST(GroundWidths, WalksSideBySideHaveTheBitsOfOneAlone) {
  const WalkModel model =
      model_on(ground_of({SlopeSection{3.0, 0.12, 0.5}, StairsSection{-0.15, 0.3, 4},
                          StairsSection{0.17, 0.28, 5}, FlatSection{2.0}}));
  const Tables tables = tables_of(model, kDt);
  for_each_width([&](auto width) {
    std::vector<Block<1>> alone(width);
    for (int w = 0; w < width; ++w) {
      stand(tables, {0.1 * w, 0.2 * w + 0.8, 0.02 * w}, alone[w]);
      ask(params_of(w % 3 == 2 ? 0.1 : 0.0, 0.4 + 0.03 * w), alone[w]);
    }
    expect_bits_of_one<width>(tables, alone, 8 * kRate, [](int tick, int, Block<1>& block) {
      if (tick == 7 * kRate) block.state.asked.walks = 0.0f;
      return tick == 7 * kRate;
    });
  });
}

// --- Moved walks ---------------------------------------------------------------------------------

TEST(Moved, WalkHasInItsOwnCoordinatesTheBitsOfOneThatIsNot) {
  const WalkModel model = model_on(ground_of({FlatSection{3.0}, StairsSection{0.17, 0.28, 5}}));
  Alone stays(model), goes(model);
  Placement placed;
  for (int tick = 0; tick < 8 * kRate; ++tick) {
    const GaitParams params = params_of(tick > 5 * kRate ? 0.2 : 0.0, 0.7);
    if (tick % 37 == 5) {  // a platform, and now and then a teleport
      const Placement by{vec3(0.3, tick == 1189 ? 200.0 : 0.1, tick == 1226 ? -5e4 : 0.02),
                         0.1 * tick};
      place(moved(by, goes.block.placed[0]), 0, goes.block);
      placed = moved(by, placed);
    }
    stays.step(params);
    goes.step(params);
    ASSERT_EQ(std::memcmp(&stays.block, &goes.block, kStateNumbers<float> * sizeof(float)), 0);
    ASSERT_EQ(goes.pose.root_m, to_world(placed, stays.pose.root_m));
    for (int j = 1; j < stays.pose.joint_count; ++j)
      ASSERT_EQ(stays.pose.local[j], goes.pose.local[j]) << j;
    ASSERT_EQ(goes.pose.local[0], rotation_y(placed.heading_rad) * stays.pose.local[0]);
  }
}

TEST(Stand, MayBeAnywhereAndFaceAnyWay) {
  Alone here(adult());
  const Placement there{vec3(-7e5, 0.0, 3e5), 2.5};
  Alone far(adult(), {there.place_m.x, there.place_m.z, there.heading_rad});
  for (int tick = 0; tick < 3 * kRate; ++tick) {
    here.step(params_of(0.2, 0.8));
    far.step(params_of(0.2, 0.8));
    EXPECT_LE(glm::distance(far.pose.root_m, to_world(there, here.pose.root_m)), 1e-6);
  }
}

}  // namespace
}  // namespace gaitpad
