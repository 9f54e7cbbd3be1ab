#include "files/keyframe.h"

#include <gtest/gtest.h>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/motion.h"
#include "tests/folders.h"

namespace gaitpad {
namespace {

Result<Motion> walked(const std::string& text) {
  auto file = TomlFile::parse(text, "walk.toml");
  if (!file) return file.error();
  EXPECT_TRUE(is_keyframe_file(*file));
  return keyframe_motion(*file);
}
std::string error_of(const std::string& text) {
  const auto motion = walked(text);
  return motion ? "" : motion.error().message;
}

// The smallest file of a walk: four poses.
std::string small_walk(const std::string& more = "", const std::string& in_first = "") {
  return "duration_s = 1.1\n" + more + "[[pose]]\nphase = 0.0\nhip = 23\nknee = 5\nankle = 0\n" +
         in_first +
         "[[pose]]\nphase = 0.3\nhip = 0\nknee = 8\nankle = 6\n"
         "[[pose]]\nphase = 0.52\nhip = -17\nknee = 9\nankle = 10\n"
         "[[pose]]\nphase = 0.74\nhip = 9\nknee = 62\nankle = -2\n";
}

TEST(PeriodicKeys, MeetTheirKeysAndStayBetweenThem) {
  EXPECT_EQ(PeriodicKeys({{0.3, 7.0}}).at(0.9), 7.0) << "one is a constant";
  EXPECT_EQ(PeriodicKeys().at(0.9), 0.0);
  const PeriodicKeys keys({{0.7, -3.0}, {0.1, 0.0}, {0.25, 10.0}, {0.3, 10.5}});
  EXPECT_DOUBLE_EQ(keys.at(0.25), 10.0);
  EXPECT_DOUBLE_EQ(keys.at(1.7), -3.0);
  for (double p = 0.0; p < 1.0; p += 0.001) {
    EXPECT_LE(keys.at(p), 10.5);
    EXPECT_GE(keys.at(p), -3.0);
    if (p > 0.25 && p < 0.3) {
      EXPECT_GE(keys.at(p), 10.0);
    }
  }
}

TEST(PeriodicKeys, HaveOneSlopeEverywhereAlsoOverTheSeam) {
  const PeriodicKeys keys({{0.05, 1.0}, {0.4, 4.0}, {0.6, 5.0}, {0.95, -2.0}});
  constexpr double kStep = 1e-5;
  for (const double p : {0.05, 0.4, 0.6, 0.95, 0.0, 0.5}) {
    const double before = (keys.at(p) - keys.at(p - kStep)) / kStep;
    const double after = (keys.at(p + kStep) - keys.at(p)) / kStep;
    EXPECT_NEAR(before, after, 0.02) << p;
  }
}

TEST(Keyframe, TheExampleWalksAsAdultsDo) {
  auto file = TomlFile::load(kSourceFolder + "/config/motions/keyframe_walk.toml");
  ASSERT_TRUE(file) << file.error().message;
  const auto motion = keyframe_motion(*file);
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_EQ(motion->name, "keyframe_walk.toml");
  const auto cycle = gait_cycle(*motion);
  ASSERT_TRUE(cycle) << cycle.error().message;
  EXPECT_NEAR(cycle->duration_s, 1.12, 0.01);
  EXPECT_GT(cycle->stride_m / cycle->duration_s, 1.0);
  EXPECT_LT(cycle->stride_m / cycle->duration_s, 1.4);
  EXPECT_NEAR(cycle->step_m[0], cycle->step_m[1], 0.01);
  EXPECT_NEAR(cycle->strike[kLeftSide], 0.5, 0.01);
  // The toe begins to leave before the toe-off of the keys, at 0.62.
  EXPECT_GT(cycle->toe_off[kRightSide], 0.53);
  EXPECT_LT(cycle->toe_off[kRightSide], 0.62);
}

TEST(Keyframe, KeysAreTheAnglesAtTheirPhases) {
  const auto motion = walked(small_walk("", "shoulder = 20\nelbow = 30\n"));
  ASSERT_TRUE(motion) << motion.error().message;
  const auto local = [&](int frame, const char* name) {
    return motion->frames[frame].local[motion->skeleton.find(name)];
  };
  const auto bend = [](const quat& q) { return glm::length(rotation_vector(q)) / kDegree; };
  EXPECT_NEAR(bend(local(0, "RightLeg")), 5.0, 0.1);
  EXPECT_NEAR(bend(local(64, "LeftLeg")), 5.0, 0.1) << "half a stride later";
  EXPECT_NEAR(bend(local(0, "RightForeArm")), 30.0, 1e-9);
  const vec3 arm = local(0, "RightArm") * vec3(0.0, -1.0, 0.0);
  EXPECT_NEAR(gaitpad::atan2(arm.z, -arm.y) / kDegree, 20.0, 0.2) << "forward";
}

TEST(Keyframe, SidesMayDiffer) {
  std::string text = "duration_s = 1.2\nsymmetric = false\n";
  const double poses[4][4] = {
      {0.0, 23, 5, 0}, {0.3, 0, 8, 6}, {0.52, -17, 9, 10}, {0.74, 9, 62, -2}};
  for (const auto& [phase, hip, knee, ankle] : poses) {
    const double later = phase < 0.5 ? phase + 0.5 : phase - 0.5;
    text += "[[pose]]\nphase = " + std::to_string(phase) + "\nright_hip = " + std::to_string(hip) +
            "\nright_knee = " + std::to_string(knee) + "\nright_ankle = " + std::to_string(ankle) +
            "\n[[pose]]\nphase = " + std::to_string(later) +
            "\nleft_hip = " + std::to_string(hip * 0.8) +
            "\nleft_knee = " + std::to_string(0.8 * knee) +
            "\nleft_ankle = " + std::to_string(ankle) + "\n";
  }
  const auto motion = walked(text);
  ASSERT_TRUE(motion) << motion.error().message;
  const auto cycle = gait_cycle(*motion);
  EXPECT_TRUE(cycle) << cycle.error().message;
  double most[2] = {0.0, 0.0};
  for (const CycleSample& at : cycle->samples) {
    for (int side = 0; side < 2; ++side)
      most[side] = std::max(most[side], at.leg[side].angles[kKneeX] / kDegree);
  }
  EXPECT_NEAR(most[kRightSide], 62.0, 1.5);
  EXPECT_NEAR(most[kLeftSide], 0.8 * 62.0, 1.5);
}

TEST(Keyframe, MistakesAreNamedWithFileAndLine) {
  EXPECT_EQ(error_of(small_walk()), "");
  std::string many = small_walk();
  for (int i = 0; i < 70; ++i) many += "[[pose]]\nphase = 0.1\n";
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {small_walk("", "nose = 3\n"), "walk.toml:7: unknown key \"nose\""},
           {small_walk("", "shoulder = 200\n"), "walk.toml:7: "},
           {small_walk("", "left_elbow = 20\n"), "unknown key \"left_elbow\""},
           {small_walk() + "[[pose]]\nphase = 0.5\npelvis_turn = 3\n[[pose]]\nphase = 0\n"
                           "pelvis_turn = 4\n",
            "pelvis_turn is keyed twice at phase"},
           {small_walk() + "[[pose]]\nphase = 1.0\nhip = 3\n", "the next stride's 0"},
           {small_walk() + "[[pose]]\nhip = 3\n", "phase"},
           {small_walk().substr(17), "duration_s"},
           {"duration_s = 1\n[[pose]]\nphase = 0.0\nelbow = 3\n", "nothing would walk"},
           {small_walk("duration_s = 2\n"), "walk.toml:"},
           {many, "walk.toml:"}})
    EXPECT_NE(error_of(text).find(says), std::string::npos) << error_of(text) << "\n" << text;
}

TEST(Keyframe, AnglesAtTheirBoundsGiveFinitePoses) {
  const auto motion = walked(
      "duration_s = 1.1\ntrack_m = 0.3\n[[pose]]\nphase = 0.0\nhip = 120\nknee = 0\n"
      "pelvis_list = 30\n[[pose]]\nphase = 0.3\nhip = 90\nknee = 150\npelvis_side_m = 0.2\n");
  ASSERT_TRUE(motion) << motion.error().message;
  for (const MotionFrame& frame : motion->frames) {
    EXPECT_TRUE(std::isfinite(frame.root_m.x + frame.root_m.y + frame.root_m.z));
    for (const quat& q : frame.local) EXPECT_NEAR(glm::length(q), 1.0, 1e-9);
  }
  (void)gait_cycle(*motion);
}

TEST(Keyframe, WhatDoesNotWalkSaysSo) {
  const auto motion = walked(
      "duration_s = 1.1\n[[pose]]\nphase = 0.0\nhip = 1\nknee = 5\n[[pose]]\nphase = 0.3\nhip = 0\n"
      "knee = 8\n");
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_FALSE(gait_cycle(*motion));
}

}  // namespace
}  // namespace gaitpad
