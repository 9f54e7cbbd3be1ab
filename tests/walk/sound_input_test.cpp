// Feeds numbers out of range to every function that takes run-time inputs: none crashes, none
// reaches a pose, each is counted.
#include "walk/sound_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "control/params_range.h"
#include "gaitpad/crowd.h"
#include "tests/finite_pose.h"
#include "tests/walk/made_walker.h"

namespace gaitpad::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

GaitParams usual_params() {
  return gait_params({.left = vec2(0.2, 0.8)}, StyleValues{}, gait_limits(adult()));
}
// Values that this number of GaitParams must not have.
std::vector<double> bad_values(std::size_t number) {
  const ParamsRange& range = params_range();
  return {kNaN,
          kInfinity,
          -kInfinity,
          1e300,
          numbers_of(range.least)[number] - 0.01,
          numbers_of(range.most)[number] + 0.01};
}
TEST(SoundInput, EveryBadParameterIsCountedAndLeavesThePoseFinite) {
  const GaitParams usual = usual_params();
  int fed = 0;
  for (std::size_t number = 0; number < kParamsNumbers; ++number) {
    for (const double bad : bad_values(number)) {
      Pose pose;
      WalkState state = standing(adult(), vec3(0.0), pose);
      for (int tick = 0; tick < 12; ++tick) {
        GaitParams params = usual;
        if (tick % 4 == 3) numbers_of(params)[number] = bad;
        EXPECT_EQ(check(params).has_value(), tick % 4 == 3) << "number " << number << ", " << bad;
        advance(adult(), params, IkMode::robust, 1.0 / 30.0, state, pose);
        ASSERT_TRUE(is_finite(pose)) << "number " << number << ", " << bad;
      }
      EXPECT_EQ(state.bad_inputs, 3) << "number " << number << ", " << bad;
      ++fed;
    }
  }
  EXPECT_GE(fed, 300);
}

TEST(SoundInput, AWalkGoesOnWhileAllItsParametersAreBad) {
  MadeWalker good, bad;
  good.walk(usual_params(), 3 * kRate);
  bad.walk(usual_params(), 3 * kRate);
  GaitParams nothing = usual_params();
  for (double& number : numbers_of(nothing)) number = kNaN;
  bad.walk(nothing, kRate);
  good.walk(usual_params(), kRate);
  EXPECT_EQ(bad.state().bad_inputs, int(kParamsNumbers) * kRate);
  EXPECT_TRUE(is_finite(bad.pose()));
  EXPECT_LT(glm::distance(bad.last().pelvis_m, good.last().pelvis_m), 0.05);
}

TEST(SoundInput, ABadTickLastsAsLongAsTheOneBefore) {
  MadeWalker walker;
  walker.walk(usual_params(), kRate);
  WalkState state = walker.state(), same = walker.state();
  Pose pose = walker.pose(), same_pose = walker.pose();
  int count = 0;
  for (const double bad : {kNaN, kInfinity, -kInfinity, 0.0, -0.01, 1e-9, 1.0, 1e300}) {
    advance(adult(), usual_params(), IkMode::robust, bad, state, pose);
    advance(adult(), usual_params(), IkMode::robust, kDt, same, same_pose);
    EXPECT_EQ(pose.root_m, same_pose.root_m) << bad;
    EXPECT_EQ(state.bad_inputs, ++count) << bad;
  }
}

TEST(SoundInput, ABadPlaceIsCountedAsTheOrigin) {
  Pose pose;
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
    const WalkState state = standing(adult(), vec3(bad, bad, 2.0), pose);
    EXPECT_EQ(state.bad_inputs, 1) << bad;
    EXPECT_TRUE(is_finite(pose)) << bad;
    EXPECT_NEAR(state.root.place_m.z, 2.0, 1e-9);
  }
}

TEST(SoundInput, ACrowdCountsThemToo) {
  const auto model = std::make_shared<const WalkModel>(adult());
  const std::vector<CrowdMember> members(5, CrowdMember{model, vec3(0.0)});
  auto crowd = value_of(Crowd::create(members));
  for (int tick = 0; tick < 60; ++tick) {
    for (int i = 0; i < 5; ++i) {
      crowd.params()[i] = usual_params();
      if (i > 0 && tick % 7 == i) numbers_of(crowd.params()[i])[10 * i] = kNaN;
    }
    crowd.advance(tick == 30 ? kNaN : kDt);
  }
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(is_finite(crowd.root_m(i), crowd.local(i)));
    EXPECT_GE(crowd.state(i).bad_inputs, i == 0 ? 1 : 8) << i;
    EXPECT_LE(crowd.state(i).bad_inputs, i == 0 ? 1 : 10) << i;
  }
}

TEST(SoundInput, ACrowdWithoutAModelOrAPlaceIsRefused) {
  const auto model = std::make_shared<const WalkModel>(adult());
  std::vector<CrowdMember> members(3, CrowdMember{model, vec3(0.0)});
  members[1].model = nullptr;
  EXPECT_EQ(Crowd::create(members).error().message, "members[1].model is null");
  members[1] = {model, vec3(0.0, kNaN, 0.0)};
  EXPECT_EQ(Crowd::create(members).error().message,
            "members[1].place_m.y is nan, outside [-1e+06, 1e+06]");
}

// Sticks, styles and limits of a stateless function: the walk refuses what results from bad ones.
TEST(SoundInput, BadSticksStylesAndLimitsReachNoPose) {
  const auto limits = gait_limits(adult());
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300, -1e300}) {
    Stick stick{.left = vec2(bad, 0.5)};
    StyleValues style;
    GaitLimits broken = limits;
    style.stride[1].speed = bad;
    broken.max_step_m = bad;
    const std::vector<GaitParams> all = {
        gait_params(stick, StyleValues{}, limits), gait_params(Stick{}, style, limits),
        gait_params({.left = vec2(0.1, 0.7)}, style, limits),
        gait_params({.left = vec2(0.1, 0.7)}, StyleValues{}, broken),
        gait_params(pointed_stick(stick, bad, bad, limits), StyleValues{}, limits)};
    for (const GaitParams& params : all) {
      MadeWalker walker;
      walker.walk(usual_params(), 20);
      walker.walk(params, 40);
      EXPECT_TRUE(is_finite(walker.pose())) << bad;
    }
  }
}

TEST(SoundInput, AHeadThatLooksAlmostWhollyDoesNotJump) {
  GaitParams params;
  HeadParams& head = params.body.head;
  head = {.look_at = 0.999999, .x_m = 0.6, .y_m = 1.0, .z_m = 0.8};
  const auto pose_at = [&](double look_at) {
    head.look_at = look_at;
    MadeWalker walker;
    walker.walk(params, 2 * kRate);
    return walker.pose();
  };
  const Pose almost = pose_at(0.999999), wholly = pose_at(1.0);
  // The product of rotations of floats is 1 to 1e-7 alone, so the angle between them is judged.
  for (int j = 0; j < wholly.joint_count; ++j)
    EXPECT_LT(glm::length(rotation_vector(glm::conjugate(almost.local[j]) * wholly.local[j])), 1e-5)
        << j;
}

}  // namespace
}  // namespace gaitpad::test
