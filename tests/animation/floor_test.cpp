// Ground that a game is asked for, in every direction.
#include "animation/floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/animation/made_walker.h"

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
// The same, which now rises along +x: turned by a quarter.
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

TEST(AskedGround, GivesTheBitsOfTheSectionsThatItRepeats) {
  const Terrain sections = slopes();
  const WalkModel laid_model = model_on(sections),
                  asked_model = model_on({&ask_sections, &sections});
  MadeWalker laid(laid_model), asked(asked_model);
  for (MadeWalker* walker : {&laid, &asked}) {
    walker->walk(0.0, 0.7, 8 * kRate);
    walker->walk(0.4, 0.6, 4 * kRate);
  }
  EXPECT_GT(laid.last().pelvis_m.y, 1.2);
  EXPECT_EQ(laid.pose().root_m, asked.pose().root_m);
  for (int j = 0; j < laid.pose().joint_count; ++j)
    EXPECT_EQ(laid.pose().local[j], asked.pose().local[j]) << j;
}

TEST(AskedGround, MayRiseInAnyDirection) {
  const Terrain sections = slopes();
  const WalkModel ahead_model = model_on(sections),
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

// A walk in circles, put elsewhere by whole waves: planted feet do not move, and soles lie on the
// ground under them, as well as a plane can.
TEST(AskedGround, IsTheGroundOfThePlaceThatAWalkIsPutTo) {
  const WalkModel model = model_on({&ask_waves, nullptr});
  Pose pose;
  WalkState state = standing(model, vec3(3.0, 0.0, -2.0), 0.7, pose);
  const GaitParams params =
      gait_params({.left = vec2(0.4, 0.7)}, StyleValues{}, gait_limits(adult()));
  std::array<vec3, 2> last{};
  std::array<bool, 2> stood{};
  double drift_m = 0.0, off_m = 0.0;
  for (int tick = 0; tick < 12 * kRate; ++tick) {
    const bool put = tick % kRate == 77;
    if (put)
      put_walk(state.frame.root_m +
                   vec3(2.0 * kPi / 0.8 * (tick / kRate % 2 ? 1.0 : -1.0), 0.0, 2.0 * kPi / 0.7),
               state.frame.heading_rad, state, pose);
    advance(model, params, IkMode::robust, kDt, state, pose);
    for (const int side : {0, 1}) {
      const WalkFrame& frame = state.frame;
      if (frame.toe_planted[side] && stood[side] && !put)
        drift_m = std::max(drift_m, glm::distance(frame.toe_m[side], last[side]));
      const vec3& heel = frame.heel_m[side];
      EXPECT_NEAR(frame.heel_ground_m[side], ask_waves(nullptr, heel.x, heel.z).height_m, 1e-9);
      if (frame.heel_planted[side])
        off_m = std::max(off_m, std::abs(heel.y - frame.heel_ground_m[side]));
      stood[side] = frame.toe_planted[side];
      last[side] = frame.toe_m[side];
    }
  }
  EXPECT_LT(drift_m, 1e-4);
  EXPECT_LT(off_m, 4e-3);
  EXPECT_GT(state.frame.steps[0], 8);
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
