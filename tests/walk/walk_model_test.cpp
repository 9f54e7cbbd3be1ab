#include "gaitpad/walk_model.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/walk/made_walker.h"

namespace gaitpad {
namespace {

const Joint& joint_of(const WalkModel& model, int index) {
  return model.cycle.skeleton.joints[index];
}

TEST(WalkModel, LegsGrowByTheRatioAndTheRestByTheScaleAlone) {
  const WalkModel plain = model_of(1.0), built = model_of(0.7, 1.2);
  EXPECT_NEAR(built.leg_length_m, 0.7 * 1.2 * plain.leg_length_m, 1e-12);
  EXPECT_NEAR(built.source_leg_length_m, plain.leg_length_m, 1e-12);
  for (Side side : {kLeftSide, kRightSide}) {
    const LegModel &a = plain.leg[side].model, &b = built.leg[side].model;
    EXPECT_NEAR(b.length_m(), built.leg_length_m, 1e-12);
    EXPECT_NEAR(b.thigh_m / a.thigh_m, 0.84, 1e-12);
    EXPECT_NEAR(b.shank_m / a.shank_m, 0.84, 1e-12);
    EXPECT_NEAR(glm::length(b.toe_m - b.heel_m) / glm::length(a.toe_m - a.heel_m), 0.84, 1e-12);
    EXPECT_LT(glm::distance(b.hip_m, 1.2 * a.hip_m), 1e-12);
  }
  const LegJoints& joints = plain.leg[kLeftSide].model.joints;
  for (std::size_t j = 0; j < plain.cycle.skeleton.joints.size(); ++j) {
    const int i = static_cast<int>(j);
    const bool in_leg = i == joints.knee || i == joints.ankle || i == joints.toe;
    const bool outside = i < joints.hip && i > 0;
    if (in_leg || outside) {
      EXPECT_LT(glm::distance(joint_of(built, i).offset_m,
                              (in_leg ? 0.84 : 1.2) * joint_of(plain, i).offset_m),
                1e-12)
          << joint_of(plain, i).name;
    }
  }
}

TEST(WalkModel, StepsAndFlightsScaleWithTheLeg) {
  const WalkModel plain = model_of(1.0), tall = model_of(1.44);
  EXPECT_NEAR(tall.source_step_m, 1.44 * plain.source_step_m, 1e-12);
  EXPECT_GT(tall.time_scale, plain.time_scale);
  EXPECT_NEAR(plain.size, plain.leg_length_m / kReferenceLeg_m, 1e-12);
  for (const double phase : {0.1, 0.4, 0.8}) {
    const StrideCell high = stride_of(tall, false, phase, 1.0).cell,
                     low = stride_of(plain, false, phase, 1.0).cell;
    EXPECT_NEAR(high.foot[0].heel_m.y, 1.44 * low.foot[0].heel_m.y, 1e-12);
    EXPECT_NEAR(high.foot[0].pitch_rad, low.foot[0].pitch_rad, 1e-12);
  }
}

TEST(WalkModel, TheAdultsPaceHasTheDatasSpeedAtTheStickThatIsTold) {
  GaitCycle cycle = procedural_gait();
  const double stick = own_stick(cycle).value();
  EXPECT_NEAR(stick, cycle.stride_m / cycle.duration_s / 1.5, 1e-15);
  EXPECT_EQ(gait_limits(adult()).max_speed_m_s, 1.5);
  cycle.duration_s *= 0.5;
  EXPECT_EQ(own_stick(cycle), std::nullopt) << "2.5 m/s";
}

TEST(WalkModel, LeavesTheSourcesCycleOfEventsAlone) {
  const WalkModel plain = model_of(1.0), small = model_of(0.6);
  EXPECT_EQ(plain.share, small.share);
  EXPECT_NEAR(std::accumulate(plain.share.begin(), plain.share.end(), 0.0), 1.0, 1e-12);
  for (double share : plain.share) EXPECT_GT(share, 0.05);
}

// Joints keep their angles on legs of any length if the distance from hip to ankle scales with the
// leg.
TEST(WalkModel, LegsOfAnyLengthSpanAsMuchOfTheirLength) {
  const WalkModel plain = model_of(1.0);
  const auto span = [](const WalkModel& model, double phase, Side side) {
    const StrideCell cell = stride_of(model, false, phase, 1.0).cell;
    const quat pelvis =
        rotation_y(cell.pelvis_yaw_rad) *
        from_rotation_vector(cell.pelvis_tilt + vec3(0.0, 0.0, model.stand_roll_rad));
    const LegBuild& leg = model.leg[side];
    const StrideFoot& foot = cell.foot[side];
    const quat turned = rotation_about(leg.side, foot.pitch_rad) *
                        from_rotation_vector(kUp * foot.twist_rad + leg.forward * foot.roll_rad);
    const vec3 hip = vec3(0.0, model.stand_m, 0.0) + cell.pelvis_m + pelvis * leg.model.hip_m;
    return glm::distance(hip, foot.heel_m - turned * leg.model.heel_m) / leg.model.length_m();
  };
  for (const double ratio : {0.6, 1.3, 1.6}) {
    const WalkModel model = model_of(ratio);
    for (double phase = 0.0; phase < 1.0; phase += 0.05) {
      for (const Side side : {kLeftSide, kRightSide})
        EXPECT_NEAR(span(model, phase, side), span(plain, phase, side), 5e-4)
            << ratio << ' ' << phase;
    }
  }
}

// config/README.md, Terrain: a tread has room for the sole and 2 cm (an adult's; scaled with the
// walker).
TEST(WalkModel, GroundGrowsUntilASoleAndSomeRoomFitItsTreads) {
  Terrain narrow, wide;
  ASSERT_FALSE(add_section(narrow, StairsSection{0.1, 0.2, 3}));
  ASSERT_FALSE(add_section(wide, StairsSection{0.1, 1.0, 3}));
  for (const double ratio : {0.6, 1.0, 1.3, 1.6}) {
    const WalkModel model = model_of(ratio);
    const LegBuild& leg = model.leg[kLeftSide];
    const vec3 sole = leg.tip_m - leg.model.heel_m;
    const double needed_m = glm::length(vec2(sole.x, sole.z)) + 0.02 * model.size;
    const double scale = terrain_scale(narrow, model);
    EXPECT_GE(0.2 * scale, needed_m - 1e-12) << ratio;
    EXPECT_EQ(scale > 1.0, needed_m > 0.2) << ratio;
    EXPECT_EQ(terrain_scale(wide, model), 1.0) << ratio;
  }
}

}  // namespace
}  // namespace gaitpad
