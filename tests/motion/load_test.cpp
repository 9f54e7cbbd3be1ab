#include <gtest/gtest.h>

#include <filesystem>

#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "motion/bvh_text.h"
#include "motion/euler.h"
#include "motion/made_motion.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

Motion loaded(const std::string& text) { return value_of(motion_from_bvh(text, "walk.bvh")); }

void expect_near(const vec3& a, const vec3& b, double tolerance, const std::string& what = "") {
  EXPECT_LT(glm::distance(a, b), tolerance) << what << a.x << " " << a.y << " " << a.z;
}

TEST(Load, GivesMetresAndTheFileNameWithoutItsFolder) {
  const auto m = motion_from_bvh(WalkerText().text(), "/some/where/walk.bvh");
  ASSERT_TRUE(m);
  EXPECT_EQ(m->name, "walk.bvh");
  EXPECT_EQ(m->metres_per_unit, 0.01);
  EXPECT_DOUBLE_EQ(leg_length_m(*m), 0.8);
  expect_near(m->frames[0].root_m, vec3(0.0, 0.9, 0.0), 1e-12);
}

TEST(Load, UnitsCanBeGiven) {
  LoadOptions options;
  options.metres_per_unit = 0.02;
  const auto m = motion_from_bvh(WalkerText().text(), "a", options);
  ASSERT_TRUE(m);
  EXPECT_DOUBLE_EQ(leg_length_m(*m), 1.6);
  expect_near(m->frames[0].root_m, vec3(0.0, 1.8, 0.0), 1e-12);
}

TEST(Load, AppliesRotationsInTheOrderOfEachJointsChannels) {
  const char* kNames[] = {"Xrotation", "Yrotation", "Zrotation"};
  for (const EulerOrder& order : kEulerOrders) {
    WalkerText walker;
    walker.joint_channels = "3";
    for (const int axis : order) walker.joint_channels += std::string(" ") + kNames[axis];
    std::string text = walker.text();
    text = replaced(text, "0 90 0 0 0 0 0 0 0", "0 90 0 0 0 0 10 20 30");  // first joint: LeftUpLeg
    const Motion m = loaded(text);
    // v' = R1 R2 R3 v with matrices written out.
    const double angle[] = {10 * kDegree, 20 * kDegree, 30 * kDegree};
    vec3 v(0.1, -0.7, 0.3);
    const vec3 got = m.frames[0].local[1] * v;
    for (int i = 2; i >= 0; --i) {
      const double c = std::cos(angle[i]), s = std::sin(angle[i]);
      const int a = (order[i] + 1) % 3, b = (order[i] + 2) % 3;
      const double va = v[a], vb = v[b];
      v[a] = c * va - s * vb;
      v[b] = s * va + c * vb;
    }
    expect_near(got, v, 1e-12);
  }
}

TEST(Load, MixedOrdersStandBesideEachOther) {
  std::string text =
      replaced(WalkerText().text(), "OFFSET -10 -2 0\nCHANNELS 3 Zrotation Xrotation Yrotation",
               "OFFSET -10 -2 0\nCHANNELS 3 Yrotation Xrotation Zrotation");
  text = replaced(text, "0 90 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0",
                  "0 90 0 0 0 0 90 90 0 0 0 0 0 0 0 0 0 0 90 90 0");
  const Motion m = loaded(text);
  expect_near(m.frames[0].local[1] * kForward, vec3(1, 0, 0), 1e-12);   // Rz Rx z = Rz (-y) = x
  expect_near(m.frames[0].local[6] * kForward, vec3(0, -1, 0), 1e-12);  // Ry Rx z = Ry (-y) = -y
}

TEST(Load, AnOffsetThatThePositionsContainIsNotAddedTwice) {
  WalkerText contained;
  contained.root_offset = "5 90 7";
  contained.frames = "5 90 7 0 0 0";
  expect_near(loaded(contained.text()).frames[0].root_m, vec3(0.05, 0.9, 0.07), 1e-12);
}

TEST(Load, AnOffsetThatThePositionsLackIsAdded) {
  WalkerText lacking;
  lacking.root_offset = "5 90 7";
  lacking.frames = "1 0 2 0 0 0";
  const Motion m = loaded(lacking.text());
  expect_near(m.frames[0].root_m, vec3(0.06, 0.9, 0.09), 1e-12);
  EXPECT_EQ(m.skeleton.joints[0].offset_m, vec3(0.0));
  EXPECT_NEAR(world_of(m)->position_m[m.legs[0].toe].y, 0.0, 1e-12);
}

TEST(Load, ARootWithoutPositionsStandsAtItsOffset) {
  WalkerText still;
  still.root_offset = "5 90 7";
  still.root_channels = "3 Zrotation Xrotation Yrotation";
  still.frames = "0 0 0";
  expect_near(loaded(still.text()).frames[0].root_m, vec3(0.05, 0.9, 0.07), 1e-12);
}

// Hips with positions under a root that never moves; positions instead of the OFFSET, and on top of
// it.
TEST(Load, HipsMayMoveUnderAStillRoot) {
  const auto text = [](const std::string& values) {
    std::string t =
        replaced(WalkerText().text(), "ROOT Hips\n{\nOFFSET 0 0 0\n",
                 "ROOT Still\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT Hips\n{\nOFFSET 0 88 0\n");
    t = replaced(t, "}\nMOTION", "}\n}\nMOTION");
    return replaced(t, "\n0 90 0 0 0 0 ", "\n" + values + " 0 0 0 ");
  };
  for (const char* values : {"3 91 4", "3 3 4"}) {
    const Motion m = loaded(text(values));
    ASSERT_EQ(m.pelvis, 1);
    expect_near(m.frames[0].root_m, vec3(0.0), 1e-12);
    expect_near(world_of(m)->position_m[m.pelvis], vec3(0.03, 0.91, 0.04), 1e-12, values);
  }
}

TEST(Load, ZUpIsTurnedToYUp) {
  WalkerText walker;
  std::string text = walker.text();
  // x left, z up, -y forward.
  text = replaced(text, "OFFSET 10 -2 0", "OFFSET 10 0 -2");
  text = replaced(text, "OFFSET -10 -2 0", "OFFSET -10 0 -2");
  text = replaced(text, "OFFSET 0 -40 0", "OFFSET 0 0 -40");
  text = replaced(text, "OFFSET 0 -8 12", "OFFSET 0 -12 -8");
  text = replaced(text, "OFFSET 0 0 6", "OFFSET 0 -6 0");
  text = replaced(text, "\n0 90 0 ", "\n1 -5 90 ");
  const Motion m = loaded(text);
  const auto world = world_of(m);
  expect_near(world->position_m[0], vec3(0.01, 0.9, 0.05), 1e-12);
  expect_near(world->position_m[m.legs[0].ankle], vec3(0.11, 0.08, 0.05), 1e-12);
  expect_near(world->position_m[m.legs[0].toe_end], vec3(0.11, 0.0, 0.23), 1e-12);
}

TEST(Load, SharedFilesStandOnTheFloorWithAnAdultsLegs) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const std::string& entry : files_in(kCapturedMotions, ".bvh")) {
    const std::string name = std::filesystem::path(entry).filename().string();
    const auto m = load_motion(entry);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_GT(leg_length_m(*m), 0.65) << name;
    EXPECT_LT(leg_length_m(*m), 1.05) << name;
    const bool has_floor =
        name != "bvhfiles_example.bvh" && name != "wisc_example.bvh";  // a jump, two odd frames
    if (!has_floor) continue;
    const std::array<int, 2> toes = {m->legs[0].toe, m->legs[1].toe};
    const auto tracks = joint_tracks_m(*m, toes);
    std::vector<double> lowest;
    for (std::size_t f = 0; f < tracks[0].size(); ++f) {
      lowest.push_back(std::min(tracks[0][f].y, tracks[1][f].y));
    }
    std::ranges::sort(lowest);
    EXPECT_NEAR(lowest[lowest.size() / 2], 0.04, 0.08) << name;
  }
}

TEST(Load, TheSameMotionFromTwoFilesIsTheSame) {
  GAITPAD_NEEDS(kCapturedMotions);
  // SNU's walk with and without helper joints: hips, knees and ankles agree.
  const auto a = load_motion(kCapturedMotions + "dpr_walk_simple.bvh");
  const auto b = load_motion(kCapturedMotions + "mass_walk.bvh");
  ASSERT_TRUE(a && b);
  for (const Side side : {kLeftSide, kRightSide}) {
    const std::array<int, 1> ankle_a = {a->legs[side].ankle}, ankle_b = {b->legs[side].ankle};
    const auto one = joint_tracks_m(*a, ankle_a), two = joint_tracks_m(*b, ankle_b);
    for (std::size_t f = 0; f < one[0].size(); ++f)
      ASSERT_LT(glm::distance(one[0][f], two[0][f]), 1e-4);
  }
}

}  // namespace
}  // namespace gaitpad
