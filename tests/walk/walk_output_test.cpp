// The output of a walk for a game: events, partial poses, poses in its own floats.
#include "gaitpad/walk_output.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/walk/made_walker.h"

namespace gaitpad::test {
namespace {

// Walks straight on, then stops; returns the events of all ticks.
std::vector<WalkEvent> walked_and_stopped(double dt_s, WalkState& state) {
  const GaitLimits limits = gait_limits(adult());
  const GaitParams go = gait_params({.left = vec2(0.2, 0.9)}, StyleValues{}, limits),
                   stop = gait_params({}, StyleValues{}, limits);
  Pose pose;
  state = standing(adult(), vec3(0.0), pose);
  std::vector<WalkEvent> events;
  for (int tick = 0; tick < static_cast<int>(12.0 / dt_s); ++tick) {
    const WalkSteps before = walk_steps(state);
    advance(adult(), tick * dt_s < 6.0 ? go : stop, IkMode::robust, dt_s, state, pose);
    for (const WalkEvent& event : walk_events(before, state)) events.push_back(event);
  }
  return events;
}

TEST(WalkEvents, EachFootBeginsItsStepLeavesAndLandsInTurnAtEachRate) {
  for (const double dt_s : {1.0 / 240.0, 1.0 / 60.0, 0.05, kMostTick_s}) {
    WalkState state;
    std::array<std::vector<WalkEventKind>, 2> of_foot;
    for (const WalkEvent& event : walked_and_stopped(dt_s, state))
      of_foot[event.side].push_back(event.kind);
    const WalkSteps end = walk_steps(state);
    ASSERT_EQ(end.stage, Stage::idle);
    for (const int side : {0, 1}) {
      ASSERT_EQ(of_foot[side].size(), 3u * end.steps[side]) << dt_s;
      ASSERT_GT(end.steps[side], 3);
      for (std::size_t i = 0; i < of_foot[side].size(); ++i)
        ASSERT_EQ(static_cast<int>(of_foot[side][i]), static_cast<int>(i % 3)) << dt_s << ' ' << i;
    }
  }
}

TEST(WalkEvents, StandWhereTheFrameHasTheFoot) {
  const GaitParams go = gait_params({.left = vec2(0.2, 0.9)}, {}, gait_limits(adult()));
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  move_walk({vec3(7.0, 2.0, -3.0), 0.8}, state, pose);
  int strikes = 0;
  std::array<vec3, 2> struck_m = walk_frame(adult(), state, pose).heel_m;
  for (int tick = 0; tick < 6 * kRate; ++tick) {
    const WalkFrame before = walk_frame(adult(), state, pose);
    advance(adult(), go, IkMode::robust, kDt, state, pose);
    const WalkFrame now = walk_frame(adult(), state, pose);
    for (const WalkEvent& event : walk_events(before, state)) {
      const bool strikes_now = event.kind == WalkEventKind::heel_strike;
      const vec3& seen_m = strikes_now                            ? now.heel_m[event.side]
                           : event.kind == WalkEventKind::toe_off ? before.toe_m[event.side]
                                                                  : struck_m[event.side];
      EXPECT_LT(glm::distance(event.place_m, seen_m), 1e-3) << tick;
      if (strikes_now) struck_m[event.side] = now.heel_m[event.side];
      strikes += strikes_now;
    }
  }
  EXPECT_GT(strikes, 8);
}

TEST(WalkEvents, AMoveOfTheWalkIsNone) {
  MadeWalker walker;
  walker.walk(0.0, 0.8, 500);
  WalkState state = walker.state();
  Pose pose = walker.pose();
  const WalkSteps before = walk_steps(state);
  put_walk(vec3(40.0, 0.0, 2.0), 2.0, state, pose);
  EXPECT_EQ(walk_events(before, state).count, 0);
}

TEST(PartialPose, LegsAndPelvisAreTheWalksAndTheRestIsTheGames) {
  MadeWalker walker;
  walker.walk(0.0, 0.8, 500);
  const Skeleton& skeleton = adult().cycle.skeleton;
  const std::vector<float> weights = legs_and_pelvis(adult());
  Pose own;
  own.joint_count = walker.pose().joint_count;
  for (int j = 0; j < own.joint_count; ++j) own.local[j] = rotation_x(0.01 * (j + 1));
  const Pose game = own;
  mix_pose(weights, walker.pose(), own);
  EXPECT_EQ(own.root_m, walker.pose().root_m);
  int kept = 0;
  for (int j = 0; j < own.joint_count; ++j) {
    kept += weights[j] == 0.0f;
    EXPECT_EQ(own.local[j], (weights[j] == 0.0f ? game : walker.pose()).local[j]) << j;
  }
  EXPECT_GT(kept, 5);
  for (const int side : {0, 1}) {
    for (const LegJointFrame& joint : adult().leg[side].joint)
      if (joint.joint >= 0) {
        EXPECT_EQ(weights[joint.joint], 1.0f);
      }
  }
  const UpperBodyJoints& body = adult().body.joints;
  for (const ArmChain& arm : body.arm) EXPECT_EQ(weights[arm.shoulder], 0.0f);
  // The feet have the places that the walk gives them.
  JointFrames walk_frames, own_frames;
  forward_kinematics(skeleton, walker.pose(), walk_frames);
  forward_kinematics(skeleton, own, own_frames);
  const int ankle = adult().leg[0].joint[2].joint;
  EXPECT_EQ(own_frames.position_m[ankle], walk_frames.position_m[ankle]);
}

TEST(PartialPose, AWeightBetweenIsThatShareOfTheWayAndAnOddOneIsBounded) {
  Pose walk, own;
  walk.joint_count = own.joint_count = 4;
  for (int j = 0; j < 4; ++j) walk.local[j] = rotation_x(0.2), own.local[j] = kIdentity;
  walk.root_m = vec3(4.0, 0.0, 0.0);
  own.root_m = vec3(0.0);
  const std::array<float, 5> weights = {0.5f, std::numeric_limits<float>::quiet_NaN(), -3.0f, 7.0f,
                                        1.0f};
  mix_pose(weights, walk, own);
  EXPECT_LT(glm::length(rotation_vector(own.local[0]) - vec3(0.1, 0.0, 0.0)), 1e-12);
  EXPECT_DOUBLE_EQ(own.root_m.x, 2.0);
  EXPECT_EQ(own.local[1], kIdentity);
  EXPECT_EQ(own.local[2], kIdentity);
  EXPECT_EQ(own.local[3], walk.local[3]);
}

TEST(PoseOut, MatricesAreThoseOfTheJointsInTheCallersOrderAndFrame) {
  MadeWalker walker;
  walker.walk(0.4, 0.8, 700);
  const Skeleton& skeleton = adult().cycle.skeleton;
  const int ankle = adult().leg[1].joint[2].joint;
  const std::array<int, 4> joints = {ankle, -1, 9999, 0};
  std::array<float, 5 * 16> out;
  out.fill(-7.0f);
  const Placement model{walker.last().root_m, walker.last().heading_rad};
  EXPECT_EQ(write_matrices(skeleton, walker.pose(), model, joints, out), 4);
  JointFrames frames;
  forward_kinematics(skeleton, walker.pose(), frames);
  // Transforms a point of the ankle's frame to the world by the caller's matrix and by the object.
  const vec3 point(0.1, -0.2, 0.3);
  vec3 seen(out[12], out[13], out[14]);
  for (int axis = 0; axis < 3; ++axis)
    seen += point[axis] * vec3(out[4 * axis], out[4 * axis + 1], out[4 * axis + 2]);
  EXPECT_LT(glm::distance(to_world(model, seen),
                          frames.position_m[ankle] + frames.rotation[ankle] * point),
            1e-6);
  EXPECT_EQ(out[3] + out[7] + out[11], 0.0f);
  EXPECT_EQ(out[15], 1.0f);
  for (int i = 16; i < 48; ++i) EXPECT_EQ(out[i], -7.0f) << "no joint: left alone";
  for (int i = 64; i < 80; ++i) EXPECT_EQ(out[i], -7.0f);
  EXPECT_NEAR(out[48 + 12], from_world(model, walker.pose().root_m).x, 1e-6);
}

TEST(PoseOut, RotationsRebuildThePoseAndStopAtTheEndOfTheMemory) {
  MadeWalker walker;
  walker.walk(0.4, 0.8, 700);
  const std::array<int, 3> joints = {5, 0, 4};
  std::array<float, 11> out{};  // room for two bones
  std::array<float, 3> root_m{};
  const Placement model{walker.last().root_m, walker.last().heading_rad};
  EXPECT_EQ(write_rotations(walker.pose(), model, joints, out, root_m), 2);
  EXPECT_EQ(out[8], 0.0f);
  const quat five(out[3], out[0], out[1], out[2]), root(out[7], out[4], out[5], out[6]);
  EXPECT_LT(glm::length(rotation_vector(glm::conjugate(five) * walker.pose().local[5])), 1e-6);
  const quat turned = rotation_y(model.heading_rad) * root;
  EXPECT_LT(glm::length(rotation_vector(glm::conjugate(turned) * walker.pose().local[0])), 1e-6);
  EXPECT_LT(
      glm::distance(to_world(model, vec3(root_m[0], root_m[1], root_m[2])), walker.pose().root_m),
      1e-6);
}

}  // namespace
}  // namespace gaitpad::test
