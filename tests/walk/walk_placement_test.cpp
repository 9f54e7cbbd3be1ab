// A walk's place in the world: a walk that is moved at any tick walks on with the bits that it has
// unmoved.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "gaitpad/crowd.h"
#include "gaitpad/placement.h"
#include "tests/walk/made_walker.h"

namespace gaitpad::test {
namespace {

GaitParams asked(double x, double y) {
  return gait_params({.left = vec2(x, y)}, StyleValues{}, gait_limits(adult()));
}
// The parameters of a tick: the walk starts, turns, stops and goes on.
GaitParams asked_at(int tick) {
  const int s = tick / kRate;
  return s % 5 == 4 ? asked(0.0, 0.0) : asked(0.3 * (s % 3 - 1), 0.5 + 0.1 * (s % 4));
}
double angle_between(const quat& a, const quat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b));
}

TEST(Placement, AMovedWalkHasTheBitsOfOneThatIsNot) {
  Pose pose, moved_pose;
  WalkState state = standing(adult(), vec3(0.0), pose), moving = state;
  moved_pose = pose;
  for (int tick = 0; tick < 12 * kRate; ++tick) {
    const GaitParams params = asked_at(tick);
    if (tick % 97 == 0)
      move_walk({vec3(1e3 * (tick % 7), 3.0, -20.0), 0.7 * (tick % 5)}, moving, moved_pose);
    if (tick % 301 == 0) put_walk(vec3(5.0, 1.0, 7.0), -2.0, moving, moved_pose);
    advance(adult(), params, IkMode::robust, kDt, state, pose);
    advance(adult(), params, IkMode::robust, kDt, moving, moved_pose);
    ASSERT_EQ(moving.root, state.root) << tick;
    ASSERT_TRUE(std::equal(pose.local.begin() + 1, pose.local.begin() + pose.joint_count,
                           moved_pose.local.begin() + 1))
        << tick;
    ASSERT_EQ(moved_pose.root_m, to_world(moving.placed, pose.root_m)) << tick;
    const WalkFrame still = walk_frame(adult(), state, pose),
                    frame = walk_frame(adult(), moving, moved_pose);
    for (const int side : {0, 1}) {
      // Through another root's rotation, whose length is 1 to the rounding of floats.
      constexpr double kRounding_m = 5e-7;
      ASSERT_LT(glm::distance(frame.heel_m[side], to_world(moving.placed, still.heel_m[side])),
                kRounding_m);
      ASSERT_LT(glm::distance(frame.toe_m[side], to_world(moving.placed, still.toe_m[side])),
                kRounding_m);
    }
    ASSERT_EQ(frame.root_moved_m, still.root_moved_m);
  }
}

TEST(Placement, MovingWritesThePoseAtOnceAndPlantedFeetStayInTheMovedFrame) {
  MadeWalker walker;
  walker.walk(asked(0.2, 0.7), 500);
  WalkState state = walker.state();
  Pose pose = walker.pose();
  const Placement by{vec3(30.0, 2.0, -4.0), 1.1};
  move_walk(by, state, pose);
  EXPECT_LT(glm::distance(pose.root_m, to_world(by, walker.pose().root_m)), 1e-12);
  EXPECT_LT(glm::distance(from_world(by, to_world(by, vec3(1.0, 2.0, 3.0))), vec3(1.0, 2.0, 3.0)),
            1e-12);
  const WalkFrame before = walk_frame(adult(), state, pose);
  advance(adult(), asked(0.2, 0.7), IkMode::robust, kDt, state, pose);
  const WalkFrame now = walk_frame(adult(), state, pose);
  for (const int side : {0, 1}) {
    if (before.heel_planted[side] && now.heel_planted[side])
      EXPECT_LT(glm::distance(now.heel_m[side], before.heel_m[side]), 1e-4);
  }
  EXPECT_NEAR(now.heading_rad, state.root.heading_rad + 1.1, 1e-12);
}

TEST(Placement, PutBringsTheHipsToAPlaceAndHeading) {
  MadeWalker walker;
  walker.walk(asked(-0.5, 0.7), 700);
  WalkState state = walker.state();
  Pose pose = walker.pose();
  put_walk(vec3(-3.0, 0.5, 9.0), 2.5, state, pose);
  const WalkFrame frame = walk_frame(adult(), state, pose);
  EXPECT_LT(glm::distance(frame.root_m, vec3(-3.0, 0.5, 9.0)), 1e-9);
  EXPECT_NEAR(frame.heading_rad, 2.5, 1e-9);
}

TEST(Placement, AStandThatFacesAnotherWayIsTheSameStand) {
  Pose ahead, aside;
  const double heading = 2.0;
  WalkState a = standing(adult(), vec3(0.0), ahead),
            b = standing(adult(), vec3(4.0, 0.0, -1.0), heading, aside);
  const Placement by{vec3(4.0, 0.0, -1.0), heading};
  for (int tick = 0; tick < 8 * kRate; ++tick) {
    advance(adult(), asked_at(tick), IkMode::robust, kDt, a, ahead);
    advance(adult(), asked_at(tick), IkMode::robust, kDt, b, aside);
  }
  EXPECT_LT(glm::distance(to_world(by, ahead.root_m), aside.root_m), 1e-6);
  for (int j = 1; j < ahead.joint_count; ++j)
    EXPECT_LT(angle_between(ahead.local[j], aside.local[j]), 1e-6) << j;
  EXPECT_NEAR(walk_frame(adult(), b, aside).heading_rad,
              walk_frame(adult(), a, ahead).heading_rad + heading, 1e-9);
}

TEST(Placement, RootMotionAddsUpToTheWay) {
  for (const int rate_hz : {20, 240}) {
    Pose pose;
    WalkState state = standing(adult(), vec3(2.0, 0.0, 1.0), 0.4, pose);
    Placement capsule{vec3(2.0, 0.0, 1.0), 0.4};
    for (int tick = 0; tick < 9 * rate_hz; ++tick) {
      advance(adult(), asked_at(tick * kRate / rate_hz), IkMode::robust, 1.0 / rate_hz, state,
              pose);
      const WalkFrame frame = walk_frame(adult(), state, pose);
      capsule.place_m = to_world(capsule, frame.root_moved_m);
      capsule.heading_rad += frame.root_turned_rad;
    }
    EXPECT_GT(glm::distance(capsule.place_m, vec3(2.0, 0.0, 1.0)), 3.0);
    // A stand's hips are where floats have them: some 1e-8 m from where it was put.
    const WalkFrame frame = walk_frame(adult(), state, pose);
    EXPECT_LT(glm::distance(capsule.place_m, frame.root_m), 1e-7) << rate_hz;
    EXPECT_NEAR(capsule.heading_rad, frame.heading_rad, 1e-9) << rate_hz;
  }
}

TEST(Placement, MembersOfACrowdMoveAsWalksAlone) {
  const auto model = std::make_shared<const WalkModel>(adult());
  Crowd crowd(std::vector<CrowdMember>(4, CrowdMember{model, vec3(0.0)}));
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  for (int tick = 0; tick < 3 * kRate; ++tick) {
    if (tick % 100 == 50) {
      crowd.move(2, {vec3(1.0, 0.0, 2.0), 0.5});
      move_walk({vec3(1.0, 0.0, 2.0), 0.5}, state, pose);
    }
    for (GaitParams& params : crowd.params()) params = asked_at(tick);
    crowd.advance(kDt);
    advance(adult(), asked_at(tick), IkMode::robust, kDt, state, pose);
    ASSERT_EQ(crowd.root_m(2), pose.root_m) << tick;
    ASSERT_EQ(crowd.local(2)[0], pose.local[0]) << tick;
    ASSERT_EQ(crowd.frame(2).root_m, walk_frame(adult(), state, pose).root_m) << tick;
  }
}

TEST(Placement, AHeadLooksAtAPlaceOfTheWorld) {
  GaitParams params;
  params.body.head = {.look_at = 1.0, .x_m = 102.0, .y_m = 1.5, .z_m = 52.0};
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  move_walk({vec3(100.0, 0.0, 50.0), 0.6}, state, pose);
  Pose near;
  WalkState other = standing(adult(), vec3(0.0), 0.6, near);
  GaitParams near_params = params;
  near_params.body.head.x_m = 2.0, near_params.body.head.z_m = 2.0;
  for (int tick = 0; tick < 3 * kRate; ++tick) {
    advance(adult(), params, IkMode::robust, kDt, state, pose);
    advance(adult(), near_params, IkMode::robust, kDt, other, near);
  }
  for (int j = 1; j < pose.joint_count; ++j)
    EXPECT_LT(angle_between(pose.local[j], near.local[j]), 1e-3) << j;
}

// An engine moves a capsule on a circle of 4 m at 1 m/s and then stops it: the walk follows it by
// its own steps, has its heading in the end, and its feet do not slide.
TEST(Placement, AWalkFollowsWhatAnEngineMoves) {
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  const GaitLimits limits = gait_limits(adult());
  const double radius_m = 4.0, speed_m_s = 1.0;
  double worst_m = 0.0, drift_m = 0.0;
  CapsuleMotion capsule;
  std::array<vec3, 2> toe_m{};
  std::array<bool, 2> planted{};
  for (int tick = 0; tick < 30 * kRate; ++tick) {
    const double turned = speed_m_s * kDt * tick / radius_m;
    if (tick < 20 * kRate) {
      const SinCos at = sin_cos(turned);
      capsule = {vec3(radius_m * (1.0 - at.cos), 0.0, radius_m * at.sin), turned,
                 speed_m_s * heading_direction(turned), speed_m_s / radius_m};
    } else {
      capsule.velocity_m_s = vec3(0.0);
      capsule.turn_rate_rad_s = 0.0;
    }
    advance(adult(), following(capsule, state, StyleValues{}, limits), IkMode::robust, kDt, state,
            pose);
    const WalkFrame frame = walk_frame(adult(), state, pose);
    const double off_m = horizontal_length(capsule.place_m - frame.root_m);
    if (tick > 4 * kRate && tick < 20 * kRate) worst_m = std::max(worst_m, off_m);
    for (const int side : {0, 1}) {
      const bool stands = frame.toe_planted[side];
      if (stands && planted[side])
        drift_m = std::max(drift_m, glm::distance(toe_m[side], frame.toe_m[side]));
      planted[side] = stands;
      toe_m[side] = frame.toe_m[side];
    }
  }
  EXPECT_LT(worst_m, 0.15);
  EXPECT_LT(drift_m, 1e-4);
  const WalkFrame end = walk_frame(adult(), state, pose);
  EXPECT_EQ(end.stage, Stage::idle);
  EXPECT_LT(horizontal_length(capsule.place_m - end.root_m), 0.2);
  EXPECT_LT(std::abs(wrapped(end.heading_rad - capsule.heading_rad)), 6.0 * kDegree);
}

}  // namespace
}  // namespace gaitpad::test
