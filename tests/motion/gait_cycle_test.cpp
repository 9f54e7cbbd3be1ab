// The best stride of a motion as a periodic walk: from the procedural motion with typical faults of
// captures, and from captured clips if they are present.
#include "gaitpad/gait_cycle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "gaitpad/control.h"
#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/walk.h"
#include "motion/leg_pose.h"
#include "motion/made_motion.h"
#include "motion/made_walk.h"
#include "tests/clean_cycle.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

// The procedural motion cut to frames [first, last].
Motion cut(int first, int last) {
  Motion m = procedural_motion();
  m.name = "cut.bvh";
  m.frames = std::vector<MotionFrame>(m.frames.begin() + first, m.frames.begin() + last + 1);
  return m;
}

// Difference of the leg's sagittal angles from the procedural walk, in degrees, after the best fit
// of a phase offset (the strike is defined differently).
double angle_difference(const GaitCycle& cycle) {
  const GaitCycle own = procedural_gait();
  double best = 1e9;
  for (double offset = -0.04; offset <= 0.04; offset += 0.001) {
    double most = 0.0;
    for (double phase = 0.0; phase < 1.0; phase += 0.02) {
      const CycleSample a = sample_at(cycle, phase), b = sample_at(own, phase + offset);
      for (const int d : {kHipX, kKneeX, kAnkleX}) {
        const double hip = a.leg[0].angles[d] - b.leg[0].angles[d];
        most = std::max(most, std::abs(hip) / kDegree);
      }
    }
    best = std::min(best, most);
  }
  return best;
}

// The walk with a still root: the hips carry the position, as in some exports.
Motion under_still_root(const Motion& plain) {
  Motion m = plain;
  m.skeleton.joints.insert(m.skeleton.joints.begin(), {"Reference", -1, vec3(0.0), false});
  for (std::size_t j = 1; j < m.skeleton.joints.size(); ++j) ++m.skeleton.joints[j].parent;
  m.pelvis = plain.pelvis + 1;
  for (LegJoints& leg : m.legs) {
    for (int* joint : {&leg.hip, &leg.knee, &leg.ankle, &leg.toe, &leg.toe_end}) ++*joint;
  }
  for (MotionFrame& frame : m.frames) {
    frame.local.insert(frame.local.begin(), rotation_y(0.7));
    frame.translation_m.clear();
    for (const Joint& joint : m.skeleton.joints) frame.translation_m.push_back(joint.offset_m);
    frame.translation_m[1] = frame.root_m;
    frame.root_m = vec3(0.0);
  }
  return m;
}

TEST(GaitCycle, OfTheProceduralMotionIsTheProceduralGait) {
  const auto cycle = gait_cycle(procedural_motion());
  ASSERT_TRUE(cycle);
  const GaitCycle own = procedural_gait();
  EXPECT_NEAR(cycle->duration_s, own.duration_s, 0.002);
  EXPECT_NEAR(cycle->stride_m, own.stride_m, 0.003);
  for (const int side : {0, 1}) {
    EXPECT_NEAR(cycle->step_m[side], own.step_m[side], 0.005);
    EXPECT_NEAR(cycle->track_m[side], own.track_m[side], 0.01);
    EXPECT_NEAR(cycle->leg[side].thigh_m, own.leg[side].thigh_m, 1e-9);
    EXPECT_NEAR(cycle->leg[side].toe_end_rest_m, own.leg[side].toe_end_rest_m, 0.012);
    EXPECT_NEAR(cycle->leg[side].heel_m.y, own.leg[side].heel_m.y, 0.015);
  }
  EXPECT_LT(angle_difference(*cycle), 3.0);
}

TEST(GaitCycle, EventsComeInOrder) {
  const auto c = gait_cycle(procedural_motion());
  ASSERT_TRUE(c);
  EXPECT_EQ(c->strike[kRightSide], 0.0);
  EXPECT_NEAR(c->strike[kLeftSide], 0.5, 0.01);
  // The toe begins to leave before the published toe-off, and after the other heel is still.
  EXPECT_GT(c->toe_off[kLeftSide], 0.04);
  EXPECT_LT(c->toe_off[kLeftSide], 0.12);
  EXPECT_NEAR(c->toe_off[kRightSide] - c->toe_off[kLeftSide], 0.5, 0.01);
}

TEST(GaitCycle, IsPeriodicInValueAndSlope) {
  const auto c = gait_cycle(cut(0, 200));
  ASSERT_TRUE(c);
  constexpr double kStep = 1e-4;
  const CycleSample a = sample_at(*c, 1.0 - kStep), b = sample_at(*c, 0.0),
                    d = sample_at(*c, kStep);
  for (int k = 0; k < kLegDofs; ++k) {
    const double before = b.leg[0].angles[k] - a.leg[0].angles[k];
    const double after = d.leg[0].angles[k] - b.leg[0].angles[k];
    EXPECT_NEAR(before, after, 2e-5) << k;
  }
  EXPECT_LT(glm::distance(a.pelvis_m, b.pelvis_m), 1e-3);
}

TEST(GaitCycle, NeedsHardlyMoreThanOneStride) {
  const int stride = static_cast<int>(procedural_gait().duration_s * 120.0 + 0.5);
  for (const int first : {0, 20, 45, 70, 95}) {
    const auto cycle = gait_cycle(cut(first, first + stride * 23 / 20));
    if (!cycle) {
      ADD_FAILURE() << first << ": " << cycle.error().message;
      continue;
    }
    EXPECT_LT(angle_difference(*cycle), 4.0) << first;
  }
}

TEST(GaitCycle, ALoopOfExactlyOneStrideRunsOverItsEndAndIsInTheFile) {
  const int stride = static_cast<int>(procedural_gait().duration_s * 120.0 + 0.5);
  for (const int first : {0, 30, 60, 90}) {
    const auto cycle = gait_cycle(cut(first, first + stride));
    ASSERT_TRUE(cycle) << cycle.error().message;
    EXPECT_LT(angle_difference(*cycle), 3.0) << first;
    EXPECT_NEAR(cycle->frames, stride, 1.5);
    EXPECT_GE(cycle->first_frame, 0.0);
    EXPECT_LE(cycle->first_frame + cycle->frames, stride + 1e-9);
    EXPECT_TRUE(gait_cycle(under_still_root(cut(first, first + stride))));
  }
}

TEST(GaitCycle, LosesHeadingPlaceAndHeightOfTheFile) {
  Motion m = procedural_motion();
  const quat turn = rotation_y(2.1);
  for (MotionFrame& frame : m.frames) {
    frame.root_m = turn * frame.root_m + vec3(12.0, 3.0, -7.0);
    frame.local[0] = turn * frame.local[0];
  }
  const auto moved = gait_cycle(m), still = gait_cycle(procedural_motion());
  ASSERT_TRUE(moved);
  ASSERT_TRUE(still);
  for (double phase = 0.0; phase < 1.0; phase += 0.1) {
    const CycleSample a = sample_at(*moved, phase), b = sample_at(*still, phase);
    EXPECT_LT(glm::distance(a.pelvis_m, b.pelvis_m), 1e-6);
    EXPECT_LT(glm::distance(a.leg[1].ankle_m, b.leg[1].ankle_m), 1e-6);
  }
}

TEST(GaitCycle, ACurvedWalkIsStraightenedAndItsTurnTold) {
  Motion m = procedural_motion();
  const double radius_m = 6.0;
  for (MotionFrame& frame : m.frames) {
    const quat turn = rotation_y(frame.root_m.z / radius_m);
    const vec3 aside(radius_m - frame.root_m.x, 0.0, 0.0);
    const double height_m = frame.root_m.y;
    frame.root_m = vec3(radius_m, height_m, 0.0) - turn * aside;
    frame.local[0] = turn * frame.local[0];
  }
  const auto cycle = gait_cycle(m);
  ASSERT_TRUE(cycle);
  EXPECT_NEAR(cycle->stride_m, procedural_gait().stride_m, 0.01);
  EXPECT_NEAR(cycle->turn_rad, cycle->stride_m / radius_m, 0.01);
  EXPECT_LT(angle_difference(*cycle), 4.0);
}

TEST(GaitCycle, MovingHipsUnderAStillRootAreTheSameWalk) {
  const auto plain = gait_cycle(procedural_motion());
  const auto under = gait_cycle(under_still_root(procedural_motion()));
  ASSERT_TRUE(plain);
  ASSERT_TRUE(under) << under.error().message;
  EXPECT_EQ(under->skeleton.joints[1].offset_m, vec3(0.0));
  Pose a, b;
  const auto world_a = std::make_unique<JointFrames>(), world_b = std::make_unique<JointFrames>();
  for (double phase = 0.0; phase < 1.0; phase += 0.1) {
    sample_local(*plain, phase, a);
    sample_local(*under, phase, b);
    a.root_m = sample_at(*plain, phase).pelvis_m;
    b.root_m = sample_at(*under, phase).pelvis_m;
    forward_kinematics(plain->skeleton, a, *world_a);
    forward_kinematics(under->skeleton, b, *world_b);
    for (int j = 0; j < a.joint_count; ++j) {
      EXPECT_LT(glm::distance(world_a->position_m[j], world_b->position_m[j + 1]), 1e-3);
    }
  }
}

TEST(GaitCycle, TwentyFourFramesASecondAreEnough) {
  const Motion fine = procedural_motion();
  Motion coarse = fine;
  coarse.frame_time_s = 5.0 * fine.frame_time_s;
  coarse.frames.clear();
  for (std::size_t f = 0; f < fine.frames.size(); f += 5) coarse.frames.push_back(fine.frames[f]);
  const auto cycle = gait_cycle(coarse);
  ASSERT_TRUE(cycle);
  EXPECT_LT(angle_difference(*cycle), 4.0);
}

TEST(GaitCycle, AFarPoseInFrontDoesNotMatter) {
  Motion m = procedural_motion();
  MotionFrame pose = m.frames.front();
  pose.root_m += vec3(2.0, 0.0, 3.0);
  m.frames.insert(m.frames.begin(), pose);
  EXPECT_TRUE(gait_cycle(m));
}

TEST(GaitCycle, ZeroLengthEndSitesBecomeToes) {
  Motion m = procedural_motion();
  // Removes the toe's end, as if the foot ended in an End Site without length.
  for (LegJoints& leg : m.legs) {
    m.skeleton.joints[leg.toe].offset_m = vec3(0.0);
    m.skeleton.joints[leg.toe_end].offset_m = vec3(0.0);
  }
  const auto cycle = gait_cycle(m);
  ASSERT_TRUE(cycle) << cycle.error().message;
  EXPECT_NEAR(cycle->leg[kLeftSide].toe_m.z, 0.155 * 0.84, 1e-6);
  EXPECT_LT(pose_at(*cycle, kLeftSide, 0.8).heel_m.y, 0.3);
}

TEST(GaitCycle, ALowSlowShuffleIsAWalk) {
  const auto cycle = gait_cycle(
      made_walk({.stride_m = 0.30, .stride_s = 1.4, .stance = 0.72, .lift_m = 0.01, .end_s = 6.0}));
  ASSERT_TRUE(cycle) << cycle.error().message;
  EXPECT_NEAR(cycle->stride_m, 0.30, 0.003);
  // With an acceleration of 12 m/s^2 a foot reaches the speed of a leaving toe after 17 ms, and
  // falls to that of a struck heel 26 ms before its end.
  EXPECT_NEAR(cycle->toe_off[kLeftSide], 0.72 - 0.5 + 0.043 / 1.4, 0.015);
}

// In the data the left foot only comes up to the right one. In the walk it passes by a tenth of the
// stride; each foot moves by half of that.
TEST(GaitCycle, AStepToLimpIsAWalk) {
  for (const double past_m : {0.0, -0.05}) {
    const MadeWalk made{.stride_m = 0.7,
                        .stride_s = 1.6,
                        .stance = 0.65,
                        .left_behind_m = 0.35 - past_m,
                        .lift_m = 0.06,
                        .end_s = 8.0};
    const auto cycle = gait_cycle(made_walk(made));
    ASSERT_TRUE(cycle) << cycle.error().message;
    EXPECT_NEAR(cycle->stride_m, 0.7, 0.01);
    EXPECT_NEAR(cycle->step_m[kLeftSide], 0.07, 0.002);
    EXPECT_NEAR(cycle->step_m[kRightSide], 0.63, 0.01);
  }
  // A step that is longer by itself is not changed.
  const auto longer = gait_cycle(made_walk({.stride_m = 0.7,
                                            .stride_s = 1.6,
                                            .stance = 0.65,
                                            .left_behind_m = 0.25,
                                            .lift_m = 0.06,
                                            .end_s = 8.0}));
  EXPECT_NEAR(value_of(longer).step_m[kLeftSide], 0.10, 0.005);
}

TEST(GaitCycle, AStepToLimpWalksBackwardsInACurveWithoutSuddenJoints) {
  const auto cycle = gait_cycle(made_walk({.stride_m = 0.7,
                                           .stride_s = 1.6,
                                           .stance = 0.65,
                                           .left_behind_m = 0.35,
                                           .lift_m = 0.06,
                                           .end_s = 8.0}));
  const WalkModel model = value_of(walk_model(clean_cycle(value_of(cycle)), {}));
  Pose pose, before;
  WalkState state = standing(model, vec3(0.0), pose);
  double fastest_deg = 0.0;  // largest turn of a joint in a tick
  for (int tick = 0; tick < 240 * 6; ++tick) {
    Stick stick;
    stick.left = {tick % 700 < 350 ? 0.6 : -0.6, -0.5};
    before = pose;
    advance(model, gait_params(stick, StyleValues{}, gait_limits(model)), IkMode::robust,
            1.0 / 240.0, state, pose);
    const WalkFrame frame = walk_frame(model, state, pose);
    EXPECT_FALSE(frame.ik_failed[kLeftSide] || frame.ik_failed[kRightSide]) << tick;
    for (int j = 0; j < pose.joint_count; ++j) {
      const double cosine = std::min(std::abs(glm::dot(before.local[j], pose.local[j])), 1.0);
      fastest_deg = std::max(fastest_deg, 2.0 * std::acos(cosine) / kDegree);
    }
  }
  EXPECT_LT(pose.root_m.z, -0.4);
  EXPECT_LT(fastest_deg * 240.0, 700.0);  // people's knees and ankles: 400 to 700 degrees/s
}

TEST(GaitCycle, WhatIsNoWalkSaysWhyInOneSentence) {
  const auto bent = [](Motion m, const std::function<void(Motion&)>& bend) {
    bend(m);
    return m;
  };
  struct Row {
    Motion motion;
    const char* says;
  };
  const Row kRows[] = {
      {bent(cut(0, 200),
            [](Motion& m) {
              for (MotionFrame& frame : m.frames) frame = m.frames.front();
            }),
       "cut.bvh: holds no full walking stride of both feet: the hips go "},
      {bent(procedural_motion(),
            [](Motion& m) {
              for (MotionFrame& frame : m.frames) frame.root_m.z = 0.0;
            }),
       "procedural: walks on the spot: the hips go 0.0"},
      {bent(procedural_motion(), [](Motion& m) { std::ranges::reverse(m.frames); }), ""},
      {cut(0, 60), "cut.bvh: "},  // the clip has half a stride
      {made_walk({.stride_s = 0.8, .stance = 0.28, .lift_m = 0.15}),
       "made.bvh: holds no walk: both feet leave the floor, it is a run"},
      // Feet lifted as low as in a shuffle: heights do not show that both are in the air.
      {made_walk({.stride_s = 0.9, .stance = 0.35, .lift_m = 0.005}),
       "made.bvh: holds no walk whose events are in order: the "},
      // At a higher speed the same flight is reported as a run.
      {made_walk({.stride_m = 1.6, .stride_s = 0.65, .stance = 0.35, .lift_m = 0.005}),
       "made.bvh: holds no walk: both feet are in the air for 0."},
      {bent(cut(0, 60), [](Motion& m) { m.frame_time_s *= 0.25; }), " s, it is a run"},
      // One foot never comes up to the other.
      {made_walk({.stride_m = 0.7, .stride_s = 1.6, .left_behind_m = 0.35 + 0.12}),
       "made.bvh: holds no walk: one foot stays 0.12 m behind the other"},
      // The error about a wrong frame time names the key that corrects it.
      {bent(procedural_motion(), [](Motion& m) { m.frame_time_s *= 0.5; }), "frame_rate_hz"},
      {bent(procedural_motion(), [](Motion& m) { m.frame_time_s *= 3.0; }), "frame_rate_hz"},
  };
  for (const Row& row : kRows) {
    const auto cycle = gait_cycle(row.motion);
    ASSERT_FALSE(cycle) << row.says;
    EXPECT_NE(cycle.error().message.find(row.says), std::string::npos) << cycle.error().message;
  }
}

TEST(GaitCycle, TellsWhereItsStrideStandsInTheFile) {
  const MadeWalk walk{.left_at = 0.45, .start_s = 0.37, .end_s = 5.0};
  const auto cycle = gait_cycle(made_walk(walk));
  ASSERT_TRUE(cycle) << cycle.error().message;
  EXPECT_NEAR(cycle->frames, walk.stride_s * walk.rate_hz, 1.0);
  EXPECT_GE(cycle->first_frame, 0.0);
  EXPECT_LE(cycle->first_frame + cycle->frames, (walk.end_s - walk.start_s) * walk.rate_hz);
  EXPECT_NEAR(cycle->step_m[kLeftSide], 0.45 * walk.stride_m, 0.01);
  EXPECT_NEAR(cycle->turn_rad, 0.0, 1e-6);
}

// ---- real clips

class CapturedWalk : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    GAITPAD_NEEDS(kCapturedMotions);
    motion = value_of(load_motion(kCapturedMotions + GetParam() + ".bvh"));
    cycle = value_of(gait_cycle(motion));
  }
  Motion motion;
  GaitCycle cycle;
};

TEST_P(CapturedWalk, IsAWalk) {
  EXPECT_EQ(cycle.strike[kRightSide], 0.0);
  EXPECT_NEAR(cycle.strike[kLeftSide], 0.5, 0.1);
  EXPECT_GT(cycle.duration_s, 0.7);
  EXPECT_LT(cycle.duration_s, 2.5);
  for (const Side side : {kLeftSide, kRightSide}) {
    EXPECT_GT(cycle.step_m[side], 0.3 * cycle.stride_m);
    const double stance = cycle.toe_off[side] - cycle.strike[side];
    EXPECT_GT(stance - std::floor(stance), 0.5);
    EXPECT_LT(stance - std::floor(stance), 0.8);
    EXPECT_GE(cycle.leg[side].toe_rest_m, 0.0);
    EXPECT_LT(cycle.leg[side].toe_rest_m, 0.05 * cycle.leg[side].length_m());
  }
}

TEST_P(CapturedWalk, ModelPutsAnkleAndFootWhereTheyWereCaptured) {
  for (const int side : {0, 1}) {
    double farthest_m = 0.0, widest_rad = 0.0;
    for (int i = 0; i < kCycleSamples; ++i) {
      const LegSample& leg = cycle.samples[i].leg[side];
      const LegPose p = pose_at(cycle, side, double(i) / kCycleSamples);
      farthest_m = std::max(farthest_m, glm::distance(p.ankle_m, leg.ankle_m));
      widest_rad =
          std::max(widest_rad, glm::length(rotation_vector(glm::conjugate(p.foot) * leg.foot)));
    }
    // Two of the clips bend a knee backwards by 9 degrees, which a hinge does not.
    EXPECT_LT(farthest_m, 0.0025);
    EXPECT_LT(widest_rad, 0.1 * kDegree);
  }
}

TEST_P(CapturedWalk, BodyPoseAgreesWithTheLegModel) { expect_body_agrees_with_legs(cycle, 1e-6); }

// Angle between two successive turns, degrees.
double bend(const quat& a, const quat& b, const quat& c) {
  const vec3 first = rotation_vector(glm::conjugate(a) * b);
  const vec3 second = rotation_vector(glm::conjugate(b) * c);
  return glm::length(second - first) / kDegree;
}

TEST_P(CapturedWalk, NoJointIsRougherThanInTheClip) {
  const std::size_t joints = cycle.skeleton.joints.size();
  const double to_ticks = 1.0 / (240.0 * motion.frame_time_s);
  const int ticks = static_cast<int>(cycle.duration_s * 240.0 + 0.5);
  std::vector<double> clip(joints, 0.0), made(joints, 0.0);
  for (std::size_t f = 2; f + 1 < motion.frames.size(); ++f) {
    for (std::size_t j = 0; j < joints; ++j) {
      const double here = bend(motion.frames[f - 1].local[j], motion.frames[f].local[j],
                               motion.frames[f + 1].local[j]);
      clip[j] = std::max(clip[j], here * to_ticks * to_ticks);
    }
  }
  auto a = std::make_unique<Pose>(), b = std::make_unique<Pose>(), c = std::make_unique<Pose>();
  for (int k = 0; k < ticks; ++k) {
    sample_local(cycle, (k - 1.0) / ticks, *a);
    sample_local(cycle, double(k) / ticks, *b);
    sample_local(cycle, (k + 1.0) / ticks, *c);
    for (std::size_t j = 0; j < joints; ++j) {
      made[j] = std::max(made[j], bend(a->local[j], b->local[j], c->local[j]));
    }
  }
  for (std::size_t j = 0; j < joints; ++j) {
    EXPECT_LT(made[j], clip[j] + 0.2) << cycle.skeleton.joints[j].name;
  }
}

TEST_P(CapturedWalk, StandsOnTheFloor) {
  Pose pose;
  pose.joint_count = static_cast<int>(cycle.standing_local.size());
  std::ranges::copy(cycle.standing_local, pose.local.begin());
  const auto world = std::make_unique<JointFrames>();
  for (const int side : {0, 1}) {
    const LegModel& leg = cycle.leg[side];
    pose.root_m = vec3(0.0, leg.length_m() - leg.heel_m.y - leg.hip_m.y, 0.0);
    forward_kinematics(cycle.skeleton, pose, *world);
    const auto& at = world->position_m;
    EXPECT_NEAR(at[leg.joints.toe].y, leg.toe_rest_m, 1e-6);
    EXPECT_NEAR(at[leg.joints.ankle].y, -leg.heel_m.y, 1e-6);
    const vec3 down = at[leg.joints.ankle] - at[leg.joints.hip];
    EXPECT_NEAR(down.y, -leg.length_m(), 1e-6);
    EXPECT_GT(at[leg.joints.toe].z, at[leg.joints.ankle].z);
  }
}

INSTANTIATE_TEST_SUITE_P(SharedData, CapturedWalk, testing::ValuesIn(kCapturedWalks),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace gaitpad
