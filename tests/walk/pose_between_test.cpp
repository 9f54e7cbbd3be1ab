// A walk that is drawn between its ticks: pose_between() of gaitpad/walk_output.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "gaitpad/walk_output.h"
#include "tests/walk/made_walker.h"

namespace gaitpad::test {
namespace {

struct Feet {
  std::array<vec3, 2> heel_m, toe_m, toe_end_m;
};
Feet feet_of(const WalkModel& model, const Pose& pose) {
  JointFrames frames;
  forward_kinematics(model.cycle.skeleton, pose, frames);
  Feet feet;
  for (const int side : {0, 1}) {
    const LegModel& leg = model.leg[side].model;
    const int ankle = leg.joints.ankle;
    const quat foot = frames.rotation[ankle] * glm::conjugate(leg.standing[2]);
    feet.heel_m[side] = frames.position_m[ankle] + foot * leg.heel_m;
    feet.toe_m[side] = frames.position_m[ankle] + foot * leg.toe_m;
    feet.toe_end_m[side] = frames.position_m[leg.joints.toe_end];
  }
  return feet;
}

// A body whose thighs have a twist joint and whose toes are tips.
WalkModel twisted_body() {
  Motion body;
  body.name = "twisted";
  const auto add = [&](const char* name, int parent, const vec3& offset_m, bool is_tip = false) {
    body.skeleton.joints.push_back({name, parent, offset_m, is_tip});
    return static_cast<int>(body.skeleton.joints.size()) - 1;
  };
  const int hips = add("Hips", -1, vec3(0.0));
  for (const double x : {1.0, -1.0}) {
    const std::string side = x > 0.0 ? "Left" : "Right";
    const int thigh = add((side + "UpLeg").c_str(), hips, vec3(0.1 * x, -0.05, 0.0)),
              twist = add((side + "UpLegTwist").c_str(), thigh, vec3(0.0, -0.2, 0.0)),
              shank = add((side + "Leg").c_str(), twist, vec3(0.0, -0.22, 0.0)),
              foot = add((side + "Foot").c_str(), shank, vec3(0.0, -0.42, 0.0));
    add((side + "Foot_End").c_str(), foot, vec3(0.0, -0.07, 0.15), true);
  }
  body.frames = {
      {vec3(0.0, 0.98, 0.0), std::vector<quat>(body.skeleton.joints.size(), kIdentity), {}}};
  body.legs = value_of(find_legs(body));
  return model_of(value_of(cycle_on_skeleton(procedural_gait(), body)));
}

// The largest distances of a walk that is drawn between its ticks.
struct Drawn {
  double slides_m = 0.0;    // of a planted heel or toe from where it stands
  double foot_off_m = 0.0;  // of heel, toe and tip from the tick that was left out
  double root_off_m = 0.0, turn_off_rad = 0.0;
  int planted = 0;
};

// Walks at `rate_hz` and draws four poses between two ticks.
void draw_between(const WalkModel& model, double rate_hz, const StyleValues& style, Drawn& drawn) {
  Pose before, pose, shown;
  WalkState state = standing(model, vec3(0.0), pose);
  move_walk({vec3(30.0, 0.0, -20.0), 0.7}, state, pose);
  for (int tick = 0; tick < 12 * rate_hz; ++tick) {
    const double time_s = tick / rate_hz;
    Stick stick;
    if (time_s < 8.0) stick.left = vec2(time_s < 4.0 ? 0.0 : 0.5, time_s < 6.0 ? 0.8 : 0.4);
    before = pose;
    const WalkFrame was = walk_frame(model, state, pose);
    advance(model, gait_params(stick, style, gait_limits(model)), IkMode::robust, 1.0 / rate_hz,
            state, pose);
    const WalkFrame now = walk_frame(model, state, pose);
    for (const double share : {0.2, 0.4, 0.6, 0.8}) {
      ASSERT_TRUE(pose_between(model, before, pose, share, shown));
      const Feet feet = feet_of(model, shown);
      const auto judge = [&](bool stands, const vec3& from_m, const vec3& to_m, const vec3& m) {
        if (!stands) return;
        ++drawn.planted;
        drawn.slides_m = std::max(drawn.slides_m, glm::distance(m, mix(from_m, to_m, share)));
      };
      for (const int side : {0, 1}) {
        judge(was.heel_planted[side] && now.heel_planted[side], was.heel_m[side], now.heel_m[side],
              feet.heel_m[side]);
        judge(was.toe_planted[side] && now.toe_planted[side], was.toe_m[side], now.toe_m[side],
              feet.toe_m[side]);
      }
    }
  }
}

// Leaves out each second tick of a walk at twice that rate, and draws it from the ticks around it.
Drawn drawn_instead(double rate_hz) {
  const WalkModel& model = adult();
  Drawn drawn;
  std::array<Pose, 3> poses;
  Pose pose, shown;
  WalkState state = standing(model, vec3(0.0), pose);
  for (int tick = 0; tick < 24 * rate_hz; ++tick) {
    const double time_s = tick / (2.0 * rate_hz);
    Stick stick;
    if (time_s < 8.0) stick.left = vec2(time_s < 4.0 ? 0.0 : 0.5, time_s < 6.0 ? 0.8 : 0.4);
    advance(model, gait_params(stick, {}, gait_limits(model)), IkMode::robust, 0.5 / rate_hz, state,
            pose);
    poses = {poses[1], poses[2], pose};
    if (tick < 2 || tick % 2 == 0) continue;
    EXPECT_TRUE(pose_between(model, poses[0], poses[2], 0.5, shown));
    const Feet is = feet_of(model, shown), was = feet_of(model, poses[1]);
    for (const int side : {0, 1}) {
      for (const auto of : {&Feet::heel_m, &Feet::toe_m, &Feet::toe_end_m})
        drawn.foot_off_m =
            std::max(drawn.foot_off_m, glm::distance((is.*of)[side], (was.*of)[side]));
    }
    drawn.root_off_m = std::max(drawn.root_off_m, glm::distance(shown.root_m, poses[1].root_m));
    for (int j = 0; j < shown.joint_count; ++j)
      drawn.turn_off_rad = std::max(
          drawn.turn_off_rad,
          glm::length(rotation_vector(glm::conjugate(shown.local[j]) * poses[1].local[j])));
  }
  return drawn;
}

TEST(PoseBetween, PlantedFeetDoNotMoveBetweenTicks) {
  WalkModel slope = adult();
  Terrain climbs;
  add_section(climbs, SlopeSection{40.0, 0.15, 0.5});
  slope.terrain = std::make_shared<const Terrain>(std::move(climbs));
  const WalkModel child = model_of(0.6, 0.9), twisted = twisted_body();
  struct Case {
    const WalkModel& model;
    StyleValues style;
  };
  for (const double rate_hz : {30.0, 60.0, 120.0}) {
    Drawn drawn;
    for (const Case& c : {Case{adult(), {}}, Case{adult(), limp()}, Case{child, {}},
                          Case{slope, {}}, Case{twisted, {}}})
      draw_between(c.model, rate_hz, c.style, drawn);
    std::printf("%g Hz: %.5f mm\n", rate_hz, 1e3 * drawn.slides_m);
    EXPECT_GT(drawn.planted, 1000);
    EXPECT_LT(drawn.slides_m, 1e-6) << rate_hz;
  }
}

// Feet are farthest off where the data brake them, by 230 m/s^2, before they land.
TEST(PoseBetween, IsNearTheTickThatWasLeftOut) {
  struct Case {
    double rate_hz, most_foot_m, most_root_m, most_rad;
  };
  for (const Case& c :
       {Case{120.0, 3e-3, 2e-4, 0.5 * kDegree}, {60.0, 9e-3, 5e-4, 1.5 * kDegree}}) {
    const Drawn drawn = drawn_instead(c.rate_hz);
    std::printf("%g Hz: feet %.3f mm, root %.3f mm, joints %.3f degrees\n", c.rate_hz,
                1e3 * drawn.foot_off_m, 1e3 * drawn.root_off_m, drawn.turn_off_rad / kDegree);
    EXPECT_LT(drawn.foot_off_m, c.most_foot_m);
    EXPECT_LT(drawn.root_off_m, c.most_root_m);
    EXPECT_LT(drawn.turn_off_rad, c.most_rad);
  }
}

TEST(PoseBetween, ItsEndsAreThePosesToTheBit) {
  MadeWalker walker;
  walker.walk(0.2, 0.8, 500);
  const Pose from = walker.pose();
  walker.walk(0.2, 0.8, 2);
  const Pose& to = walker.pose();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [share, end] : {std::pair{0.0, &from},
                                   {-3.0, &from},
                                   {-infinity, &from},
                                   {1.0, &to},
                                   {1.001, &to},
                                   {infinity, &to}}) {
    Pose shown;
    ASSERT_TRUE(pose_between(adult(), from, to, share, shown));
    EXPECT_EQ(shown.root_m, end->root_m);
    for (int j = 0; j < end->joint_count; ++j) EXPECT_EQ(shown.local[j], end->local[j]) << share;
  }
  // Near them, too, and in the memory of one of them.
  for (const double share : {1e-9, 0.5, 1.0 - 1e-9}) {
    Pose shown, in_place = to;
    ASSERT_TRUE(pose_between(adult(), from, to, share, shown));
    ASSERT_TRUE(pose_between(adult(), from, in_place, share, in_place));
    for (int j = 0; j < to.joint_count; ++j) {
      EXPECT_EQ(shown.local[j], in_place.local[j]);
      if (share == 0.5) continue;
      const quat& end = (share < 0.5 ? from : to).local[j];
      EXPECT_LT(glm::length(rotation_vector(glm::conjugate(end) * shown.local[j])), 1e-6) << j;
    }
  }
}

TEST(PoseBetween, WhatIsNoShareOrNoPoseOfTheModelIsRefused) {
  Pose pose, other, shown;
  standing(adult(), vec3(0.0), pose);
  standing(adult(), vec3(0.0), shown);
  const Pose before = shown;
  const auto is_refused = [&](const Pose& from, const Pose& to, double share) {
    const bool refused = !pose_between(adult(), from, to, share, shown);
    return refused && shown.root_m == before.root_m &&
           std::equal(before.local.begin(), before.local.begin() + before.joint_count,
                      shown.local.begin());
  };
  EXPECT_TRUE(is_refused(pose, pose, std::numeric_limits<double>::quiet_NaN()));
  for (const int joints : {0, -1, pose.joint_count - 1, pose.joint_count + 1, kMaxJoints + 1}) {
    other = pose;
    other.joint_count = joints;
    EXPECT_TRUE(is_refused(pose, other, 0.5)) << joints;
    EXPECT_TRUE(is_refused(other, pose, 0.5)) << joints;
  }
}

}  // namespace
}  // namespace gaitpad::test
