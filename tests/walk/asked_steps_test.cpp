// Steps that a program asks for: a footprint at a place of its own, and a push.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "tests/walk/made_walker.h"

namespace gaitpad::test {
namespace {

// Largest change of a joint's rate, per tick, as for sticks that jump (walk_test.cpp).
constexpr double kSharpest_rad = 1.2 * kDegree;

GaitParams ahead(double y, double x = 0.0) {
  return gait_params({.left = vec2(x, y)}, StyleValues{}, gait_limits(adult()));
}

Side flying_next(const WalkSteps& frame) {
  return frame.stage == Stage::flight ? frame.swing : other(frame.swing);
}

// A walk that is asked for something in the middle of a step.
struct AskedWalk {
  const WalkModel& model;
  GaitParams params;
  Pose pose;
  WalkState state;
  double most_slide_m = 0.0, most_bend_rad = 0.0;
  int failed = 0;
  std::array<LegAngles, 2> last{}, before{};

  AskedWalk(const WalkModel& of, const GaitParams& with, int ticks)
      : model(of), params(with), state(standing(of, vec3(0.0), pose)) {
    last = before = leg_angles(model, pose);
    for (int i = 0; i < ticks; ++i) step();
    most_slide_m = most_bend_rad = 0.0;
    failed = 0;
  }
  WalkFrame frame() const { return walk_frame(model, state, pose); }
  void step() {
    const WalkFrame was = frame();
    advance(model, params, IkMode::robust, kDt, state, pose);
    const std::array<LegAngles, 2> now = leg_angles(model, pose);
    const WalkFrame is = frame();
    for (const int side : {0, 1}) {
      failed += is.ik_failed[side];
      if (was.toe_planted[side] && is.toe_planted[side])
        most_slide_m = std::max(most_slide_m, glm::distance(was.toe_m[side], is.toe_m[side]));
      if (was.heel_planted[side] && is.heel_planted[side])
        most_slide_m = std::max(most_slide_m, glm::distance(was.heel_m[side], is.heel_m[side]));
      for (int j = 0; j < kLegDofs; ++j)
        most_bend_rad =
            std::max(most_bend_rad, std::abs(now[side][j] - 2.0 * last[side][j] + before[side][j]));
    }
    before = last;
    last = now;
  }
  // Walks until that foot has landed.
  void land(Side side) {
    const int steps = walk_steps(state).steps[side];
    for (int i = 0; i < 2 * kRate && walk_steps(state).steps[side] == steps; ++i) step();
    ASSERT_EQ(walk_steps(state).steps[side], steps + 1);
  }
  // The landing of the running step as the walk has planned it, `by` away in axes of the heading.
  Placement planned(const vec3& by, double turn_rad) const {
    const State<float>& step = state.walk.state;
    const Placement heel = moved(
        stands_at(), {vec3(step.landing_x_m, 0.0, step.landing_z_m), step.landing_rad + turn_rad});
    return {heel.place_m + rotation_y(frame().heading_rad) * by, heel.heading_rad};
  }
  // The heel of the foot that stands, or has landed last.
  Placement stands_at() const {
    const Origin& origin = state.walk.origin[0];
    return moved(state.placed, {vec3(origin.x_m, origin.y_m, origin.z_m), origin.heading_rad});
  }
};

TEST(AskedSteps, AFootLandsWhereItIsAskedTo) {
  double most_m = 0.0, most_slide_m = 0.0, most_bend_rad = 0.0;
  int failed = 0, asked = 0;
  for (const double stick : {0.5, 0.8, -0.5}) {
    for (const int ticks : {400, 425, 450, 475, 500, 525, 550}) {
      for (const vec3& by : {vec3(0.05, 0.0, 0.1), vec3(-0.05, 0.0, -0.12), vec3(0.0, 0.0, 0.0)}) {
        AskedWalk walk(adult(), ahead(stick), ticks);
        move_walk({vec3(20.0, 1.0, -5.0), 2.0}, walk.state, walk.pose);
        const auto heel = nearest_step(walk.model, walk.planned(by, 0.15), walk.state);
        if (!heel) continue;  // this foot lands soon
        ++asked;
        ASSERT_TRUE(step_to(walk.model, *heel, walk.state));
        const Side side = flying_next(walk_steps(walk.state));
        walk.land(side);
        vec3 off = walk.frame().heel_m[side] - heel->place_m;
        off.y = 0.0;
        most_m = std::max(most_m, glm::length(off));
        EXPECT_NEAR(wrapped(walk.stands_at().heading_rad - heel->heading_rad), 0.0, 1e-6);
        for (int i = 0; i < 2 * kRate; ++i) walk.step();
        most_slide_m = std::max(most_slide_m, walk.most_slide_m);
        most_bend_rad = std::max(most_bend_rad, walk.most_bend_rad);
        failed += walk.failed;
      }
    }
  }
  EXPECT_GE(asked, 30);
  EXPECT_LT(most_m, 1e-4);
  EXPECT_LT(most_slide_m, 1e-4);
  EXPECT_EQ(failed, 0);
  EXPECT_LT(most_bend_rad, kSharpest_rad);
}

TEST(AskedSteps, OneOnWavesLandsThereToo) {
  WalkModel model = adult();
  auto waves = std::make_shared<Terrain>();
  waves->asked = {[](const void*, double x, double z) noexcept {
    return Ground{0.1 * sin_cos(0.8 * x).sin + 0.1 * sin_cos(0.8 * z).sin};
  }};
  model.terrain = waves;
  AskedWalk walk(model, ahead(0.7), 400);
  while (walk_steps(walk.state).stage != Stage::roll) walk.step();
  const auto heel = nearest_step(model, walk.planned(vec3(0.04, 0.0, 0.08), 0.1), walk.state);
  ASSERT_TRUE(heel && step_to(model, *heel, walk.state));
  const Side side = flying_next(walk_steps(walk.state));
  walk.land(side);
  vec3 off = walk.frame().heel_m[side] - heel->place_m;
  EXPECT_NEAR(walk.frame().heel_m[side].y, walk.frame().heel_ground_m[side], 1e-4);
  off.y = 0.0;
  EXPECT_LT(glm::length(off), 1e-3);
  EXPECT_LT(walk.most_slide_m, 1e-4);
}

TEST(AskedSteps, AfterItTheWalkGoesOnAsItsStickSays) {
  AskedWalk walk(adult(), ahead(0.8), 480), other_walk(adult(), ahead(0.8), 480);
  const auto heel = nearest_step(walk.model, walk.planned(vec3(0.0, 0.0, -0.2), 0.0), walk.state);
  ASSERT_TRUE(heel && step_to(walk.model, *heel, walk.state));
  for (int i = 0; i < 4 * kRate; ++i) walk.step(), other_walk.step();
  EXPECT_NEAR(walk.frame().speed_m_s, other_walk.frame().speed_m_s, 0.01);
  EXPECT_NEAR(walk.frame().stride_m[0], other_walk.frame().stride_m[0], 0.01);
  EXPECT_LT(walk.state.root.place_m.z, other_walk.state.root.place_m.z - 0.1)
      << "it is a step back";
}

TEST(AskedSteps, APlaceOutOfReachIsRefusedAndTheNearestOneIsTold) {
  AskedWalk walk(adult(), ahead(0.8), 480);
  const Placement far = walk.planned(vec3(0.0, 0.0, 2.0), 0.0);
  EXPECT_FALSE(step_to(walk.model, far, walk.state));
  EXPECT_EQ(walk.state.walk.change.is_aimed, 0.0f);
  const auto near = nearest_step(walk.model, far, walk.state);
  ASSERT_TRUE(near);
  EXPECT_LE(near->place_m.z - walk.stands_at().place_m.z, 0.95 * walk.model.leg_length_m + 1e-9);
  EXPECT_TRUE(step_to(walk.model, *near, walk.state));
}

TEST(AskedSteps, WhoStandsOrAsksForWhatIsNoPlaceIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pose pose;
  WalkState rests = standing(adult(), vec3(0.0), pose);
  EXPECT_FALSE(nearest_step(adult(), {}, rests));
  EXPECT_FALSE(step_to(adult(), {}, rests));
  EXPECT_FALSE(push_walk(vec3(0.5, 0.0, 0.0), rests));
  AskedWalk walk(adult(), ahead(0.8), 480);
  EXPECT_FALSE(nearest_step(walk.model, {vec3(nan, 0.0, 0.0), 0.0}, walk.state));
  EXPECT_FALSE(step_to(walk.model, {vec3(0.0), nan}, walk.state));
  Placement heel = walk.planned(vec3(0.0), 0.0);
  heel.place_m.y = nan;
  EXPECT_FALSE(step_to(walk.model, heel, walk.state));
  EXPECT_FALSE(push_walk(vec3(nan, 0.0, 0.0), walk.state));
  EXPECT_FALSE(push_walk(vec3(0.1, nan, 0.0), walk.state));
  EXPECT_FALSE(push_walk(vec3(0.0, 0.0, 2.0 * kMostPush_m_s), walk.state));
  EXPECT_EQ(walk.state.walk.change.push_x_m_s, 0.0f);
  EXPECT_EQ(walk.state.walk.change.push_z_m_s, 0.0f);
}

TEST(AskedSteps, AStickThatIsReleasedDoesNotMoveTheLanding) {
  AskedWalk walk(adult(), ahead(0.8), 480);
  const auto heel = nearest_step(walk.model, walk.planned(vec3(0.0, 0.0, 0.1), 0.0), walk.state);
  ASSERT_TRUE(heel && step_to(walk.model, *heel, walk.state));
  walk.params = ahead(0.0);
  const Side side = flying_next(walk_steps(walk.state));
  walk.land(side);
  EXPECT_LT(horizontal_length(walk.stands_at().place_m - heel->place_m), 1e-6);
  for (int i = 0; i < 4 * kRate; ++i) walk.step();
  EXPECT_EQ(walk_steps(walk.state).stage, Stage::idle);
  EXPECT_LT(walk.most_slide_m, 1e-4);
}

TEST(AskedSteps, APushedWalkCatchesItselfWithItsNextFootprint) {
  for (const vec3& push : {vec3(0.4, 0.0, 0.0), vec3(-0.4, 0.0, 0.0), vec3(0.0, 0.0, 0.4)}) {
    double most_m = 0.0;
    for (const int ticks : {400, 430, 460, 490, 520, 550}) {
      AskedWalk walk(adult(), ahead(0.7), ticks), other_walk(adult(), ahead(0.7), ticks);
      ASSERT_TRUE(push_walk(push, walk.state));
      for (int i = 0; i < kRate; ++i) {
        walk.step(), other_walk.step();
        const vec3 off_m = walk.state.root.place_m - other_walk.state.root.place_m;
        most_m = std::max(most_m, glm::dot(off_m, push) / glm::length(push));
      }
      for (int i = 0; i < 3 * kRate; ++i) walk.step(), other_walk.step();
      EXPECT_EQ(walk.failed, 0);
      EXPECT_LT(walk.most_slide_m, 1e-4);
      EXPECT_LT(walk.most_bend_rad, kSharpest_rad);
      EXPECT_NEAR(walk.frame().speed_m_s, other_walk.frame().speed_m_s, 0.01);
    }
    EXPECT_GT(most_m, 0.05) << "the hips go where they are pushed";
  }
}

// A pendulum as long as the leg falls v sqrt(l / g) far.
TEST(AskedSteps, APushedStepLandsAsFarAsideAsTheHipsFall) {
  constexpr double kPush_m_s = 0.4, kGravity_m_s2 = 9.81;
  for (const int ticks : {400, 430, 460, 490, 520, 550}) {
    AskedWalk walk(adult(), ahead(0.7), ticks), other_walk(adult(), ahead(0.7), ticks);
    while (walk_steps(walk.state).stage != Stage::roll) walk.step(), other_walk.step();
    const Side side = flying_next(walk_steps(walk.state));
    const double outwards = side == kLeftSide ? 1.0 : -1.0;
    ASSERT_TRUE(push_walk(vec3(outwards * kPush_m_s, 0.0, 0.0), walk.state));
    walk.land(side), other_walk.land(side);
    const double aside_m =
        outwards * (walk.stands_at().place_m.x - other_walk.stands_at().place_m.x);
    EXPECT_NEAR(aside_m, kPush_m_s * std::sqrt(walk.model.leg_length_m / kGravity_m_s2), 1e-3);
  }
}

}  // namespace
}  // namespace gaitpad::test
