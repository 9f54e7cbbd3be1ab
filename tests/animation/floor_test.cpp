// Ground that a game answers through a function, sloped in every direction.
#include "animation/floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/walk/made_walker.h"

namespace gaitpad::test {
namespace {

Terrain slopes() {
  Terrain terrain;
  for (const SectionShape& shape :
       {SectionShape(FlatSection{1.0}), SectionShape(SlopeSection{3.0, 0.2, 0.5}),
        SectionShape(rough_section(5.0, 0.012, 2.0, 1.0, 7))})
    EXPECT_FALSE(add_section(terrain, shape));
  return terrain;
}
Ground ask_sections(const void* game, double x_m, double z_m) noexcept {
  return ground_at(*static_cast<const Terrain*>(game), x_m, z_m);
}
// The ground of ask(), turned by a quarter turn: it rises along +x.
Ground ask_turned(const void* game, double x_m, double z_m) noexcept {
  Ground ground = ask_sections(game, -z_m, x_m);
  ground.normal = vec3(ground.normal.z, ground.normal.y, -ground.normal.x);
  return ground;
}
Ground ask_waves(const void*, double x_m, double z_m) noexcept {
  return {0.2 * sin_cos(0.8 * x_m).sin + 0.15 * sin_cos(0.7 * z_m).sin, kUp, 0};
}
WalkModel model_on(Terrain terrain) {
  WalkModel model = adult();
  model.terrain = std::make_shared<const Terrain>(std::move(terrain));
  return model;
}
WalkModel model_on(AskedGround asked) {
  Terrain terrain;
  terrain.asked = asked;
  EXPECT_FALSE(check(terrain));
  return model_on(std::move(terrain));
}

// Sections fit a plane to the ground under a sole, but on a game's ground heel and ball touch it:
// the poses differ by some millimetres.
TEST(AskedGround, GivesTheWalkOfTheSectionsThatItRepeats) {
  const Terrain sections = slopes();
  const WalkModel laid_model = model_on(sections),
                  asked_model = model_on({&ask_sections, &sections});
  MadeWalker laid(laid_model), asked(asked_model);
  for (MadeWalker* walker : {&laid, &asked}) {
    walker->walk(0.0, 0.7, 8 * kRate);
    walker->walk(0.4, 0.6, 4 * kRate);
  }
  EXPECT_GT(laid.last().pelvis_m.y, 1.2);
  EXPECT_LT(glm::distance(laid.pose().root_m, asked.pose().root_m), 0.005);
  for (int j = 0; j < laid.pose().joint_count; ++j)
    EXPECT_GT(std::abs(glm::dot(laid.pose().local[j], asked.pose().local[j])),
              sin_cos(0.5 * kPi - 0.5 * 2.0 * kDegree).sin)
        << j;
}

TEST(AskedGround, MayRiseInAnyDirection) {
  const Terrain sections = slopes();
  const WalkModel ahead_model = model_on({&ask_sections, &sections}),
                  aside_model = model_on({&ask_turned, &sections});
  Pose ahead, aside;
  WalkState a = standing(ahead_model, vec3(0.0), ahead),
            b = standing(aside_model, vec3(0.0), 0.5 * kPi, aside);
  const GaitParams params =
      gait_params({.left = vec2(0.0, 0.7)}, StyleValues{}, gait_limits(adult()));
  for (int tick = 0; tick < 8 * kRate; ++tick) {
    advance(ahead_model, params, IkMode::robust, kDt, a, ahead);
    advance(aside_model, params, IkMode::robust, kDt, b, aside);
  }
  EXPECT_NEAR(aside.root_m.x, ahead.root_m.z, 1e-3);
  EXPECT_NEAR(aside.root_m.y, ahead.root_m.y, 1e-3);
  EXPECT_GT(aside.root_m.y, 1.3);
}

// The place of the sole below the toe joint.
vec3 ball_of(const WalkModel& model, const Pose& pose, Side side) {
  const LegBuild& leg = model.leg[side];
  static JointFrames joints;
  forward_kinematics(model.cycle.skeleton, pose, joints);
  const int ankle = leg.model.joints.ankle;
  return joints.position_m[ankle] +
         joints.rotation[ankle] * glm::conjugate(leg.model.standing[2]) * leg.ball_m;
}

// Walks in circles and moves the walk by a whole number of waves: planted feet do not move, and
// heel and ball of a flat foot are on the ground.
TEST(AskedGround, IsTheGroundOfThePlaceThatAWalkIsPutTo) {
  const WalkModel model = model_on({&ask_waves, nullptr});
  Pose pose;
  WalkState state = standing(model, vec3(3.0, 0.0, -2.0), 0.7, pose);
  const GaitParams params =
                       gait_params({.left = vec2(0.4, 0.7)}, StyleValues{}, gait_limits(adult())),
                   stand = gait_params({}, StyleValues{}, gait_limits(adult()));
  std::array<vec3, 2> last{};
  std::array<bool, 2> stood{};
  double drift_m = 0.0, off_m = 0.0, ball_off_m = 0.0;
  for (int tick = 0; tick < 12 * kRate; ++tick) {
    const bool put = tick % kRate == 77;
    if (put)
      put_walk(walk_frame(model, state, pose).root_m +
                   vec3(2.0 * kPi / 0.8 * (tick / kRate % 2 ? 1.0 : -1.0), 0.0, 2.0 * kPi / 0.7),
               walk_frame(model, state, pose).heading_rad, state, pose);
    // In each fourth second the stick rests, so that both feet stand flat for a while.
    const bool stands = tick / kRate % 4 == 3;
    advance(model, stands ? stand : params, IkMode::robust, kDt, state, pose);
    const WalkFrame frame = walk_frame(model, state, pose);
    for (const int side : {0, 1}) {
      if (frame.toe_planted[side] && stood[side] && !put)
        drift_m = std::max(drift_m, glm::distance(frame.toe_m[side], last[side]));
      const vec3& heel = frame.heel_m[side];
      EXPECT_NEAR(frame.heel_ground_m[side], ask_waves(nullptr, heel.x, heel.z).height_m, 1e-9);
      if (frame.heel_planted[side])
        off_m = std::max(off_m, std::abs(heel.y - frame.heel_ground_m[side]));
      if (frame.heel_planted[side] && frame.toe_planted[side]) {
        const vec3 ball = ball_of(model, pose, static_cast<Side>(side));
        ball_off_m =
            std::max(ball_off_m, std::abs(ball.y - ask_waves(nullptr, ball.x, ball.z).height_m));
      }
      stood[side] = frame.toe_planted[side];
      last[side] = frame.toe_m[side];
    }
  }
  EXPECT_LT(drift_m, 1e-4);
  EXPECT_LT(off_m, 1e-4);
  EXPECT_LT(ball_off_m, 1e-4);
  EXPECT_GT(walk_steps(state).steps[0], 6);
}

int asked_several = 0, asked_alone = 0;
void ask_several_waves(const void* game, std::span<const GroundPlace> places,
                       std::span<Ground> grounds) noexcept {
  ASSERT_LE(places.size(), std::size_t{kMostAsked});
  ASSERT_EQ(places.size(), grounds.size());
  ++asked_several;
  for (std::size_t i = 0; i < places.size(); ++i)
    grounds[i] = ask_waves(game, places[i].x_m, places[i].z_m);
}
Ground ask_wave(const void* game, double x_m, double z_m) noexcept {
  ++asked_alone;
  return ask_waves(game, x_m, z_m);
}

TEST(AskedGround, AGameMayAnswerSeveralPlacesInOneCall) {
  const WalkModel alone_model = model_on({&ask_wave, nullptr}),
                  several_model = model_on({&ask_wave, nullptr, &ask_several_waves});
  MadeWalker alone(alone_model);
  alone.walk(0.3, 0.7, 4 * kRate);
  const int calls_alone = asked_alone;
  asked_alone = 0;
  MadeWalker several(several_model);
  several.walk(0.3, 0.7, 4 * kRate);
  EXPECT_EQ(alone.pose().root_m, several.pose().root_m);
  EXPECT_GT(asked_several, 4 * kRate);
  EXPECT_LT(asked_several + asked_alone, calls_alone / 2);
}

// Samples of a wave that runs at an angle to the axes.
GroundGrid made_grid() {
  GroundGrid grid{.x_m = -10.0, .z_m = -5.0, .spacing_m = 0.25, .columns = 80, .rows = 120};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.height_m.push_back(static_cast<float>(
          0.15 * sin_cos(0.9 * (0.25 * column - 10.0) + 0.7 * (0.25 * row - 5.0)).sin));
  return grid;
}

TEST(GroundGrid, IsStraightBetweenItsSamplesAndGoesOnAtItsBorder) {
  const GroundGrid grid{.x_m = 1.0,
                        .z_m = 2.0,
                        .spacing_m = 0.5,
                        .columns = 2,
                        .rows = 2,
                        .height_m = {0.0f, 0.1f, 0.2f, 0.5f}};
  EXPECT_DOUBLE_EQ(ground_at(grid, 1.0, 2.0).height_m, 0.0);
  EXPECT_NEAR(ground_at(grid, 1.5, 2.0).height_m, 0.1, 1e-8);
  EXPECT_NEAR(ground_at(grid, 1.0, 2.5).height_m, 0.2, 1e-8);
  // The mean of the cell's four samples.
  EXPECT_NEAR(ground_at(grid, 1.25, 2.25).height_m, 0.2, 1e-8);
  EXPECT_NEAR(ground_at(grid, 99.0, 99.0).height_m, 0.5, 1e-8);
  EXPECT_NEAR(ground_at(grid, -99.0, 2.25).height_m, 0.1, 1e-8);
  const vec3 normal = ground_at(grid, 1.25, 2.0).normal;  // grades of 0.2 along x and 0.6 along z
  EXPECT_NEAR(normal.x / normal.y, -0.2, 1e-7);
  EXPECT_NEAR(normal.z / normal.y, -0.6, 1e-7);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isfinite(ground_at(grid, no_number, no_number).height_m));
}

TEST(GroundGrid, IsWalkedOnInAnyDirectionWithHeelsOnIt) {
  const GroundGrid grid = made_grid();
  ASSERT_FALSE(check(grid)) << check(grid)->message;
  const WalkModel model = model_on(asked_ground(grid));
  for (const double heading_rad : {0.0, 2.0, 4.0}) {
    Pose pose;
    WalkState state = standing(model, vec3(0.0, 0.0, 8.0), heading_rad, pose);
    const GaitParams params =
        gait_params({.left = vec2(0.0, 0.7)}, StyleValues{}, gait_limits(model));
    double off_m = 0.0;
    for (int tick = 0; tick < 5 * kRate; ++tick) {
      advance(model, params, IkMode::robust, kDt, state, pose);
      const WalkFrame frame = walk_frame(model, state, pose);
      for (const int side : {0, 1}) {
        const vec3& heel = frame.heel_m[side];
        if (frame.heel_planted[side])
          off_m = std::max(off_m, std::abs(heel.y - ground_at(grid, heel.x, heel.z).height_m));
      }
    }
    EXPECT_LT(off_m, 1e-4) << heading_rad;
    EXPECT_GT(walk_steps(state).steps[0], 3);
  }
}

TEST(GroundGrid, IsRefusedWithTheFieldThatIsWrong) {
  const auto refused = [](const auto& change) {
    GroundGrid grid = made_grid();
    change(grid);
    const auto problem = check(grid);
    return problem ? problem->message : std::string("taken");
  };
  EXPECT_NE(refused([](GroundGrid& g) { g.spacing_m = 0.0; }).find("spacing_m is 0"),
            std::string::npos);
  EXPECT_NE(refused([](GroundGrid& g) { g.columns = 81; }).find("81 x 120"), std::string::npos);
  EXPECT_NE(refused([](GroundGrid& g) {
              g.height_m[5] = std::numeric_limits<float>::infinity();
            }).find("column 5, row 0"),
            std::string::npos);
  EXPECT_NE(refused([](GroundGrid& g) { g.height_m[200] += 0.3f; }).find("grade"),
            std::string::npos);
  EXPECT_NE(refused([](GroundGrid& g) { g.height_m[200] += 0.1f; }).find("bends"),
            std::string::npos);
  EXPECT_EQ(refused([](GroundGrid&) {}), "taken");
}

TEST(AskedGround, AnAnswerThatIsNoHeightCountsAsTheFloor) {
  Terrain terrain;
  terrain.asked.ask = [](const void*, double, double) noexcept {
    return Ground{std::numeric_limits<double>::quiet_NaN(), kUp, 0};
  };
  EXPECT_EQ(ground_at(terrain, 1.0, 1.0).height_m, 0.0);
  ASSERT_FALSE(add_section(terrain, FlatSection{1.0}));
  EXPECT_TRUE(check(terrain));
}

}  // namespace
}  // namespace gaitpad::test
