#include "gaitpad/motion_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "files/acclaim_text.h"
#include "files/bvh_text.h"
#include "files/euler.h"
#include "gaitpad/motion.h"
#include "motion/made_motion.h"
#include "tests/own_folder.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

TEST(Units, AnAdultsLegTellsTheUnit) {
  EXPECT_EQ(metres_per_unit(0.84), 1.0);
  EXPECT_EQ(metres_per_unit(8.4), 0.1);
  EXPECT_EQ(metres_per_unit(86.0), 0.01);
  EXPECT_EQ(metres_per_unit(840.0), 0.001);
  EXPECT_EQ(metres_per_unit(35.7), 0.0254);  // a leg of 35.7 units: inches
  EXPECT_EQ(metres_per_unit(2.8), 0.3048);   // a leg of 2.8 units: feet
  // A leg of 14.8 units: CMU's inches times 0.45.
  EXPECT_NEAR(metres_per_unit(14.8), 0.0564, 0.0001);
}

TEST(Units, WhereNoUnitFitsTheLegBecomesAnAdults) {
  EXPECT_DOUBLE_EQ(metres_per_unit(50.0) * 50.0, kReferenceLeg_m);
  EXPECT_DOUBLE_EQ(metres_per_unit(0.01) * 0.01, kReferenceLeg_m);
}

TEST(Units, NoLegFitsTwoUnits) {
  constexpr double kUnits[] = {1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.0254 / 0.45};
  for (double leg = 0.1; leg < 2000.0; leg *= 1.01) {
    int fits = 0;
    for (const double unit : kUnits) fits += leg * unit >= 0.65 && leg * unit <= 1.05;
    EXPECT_LE(fits, 1) << leg;
  }
}

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
    // Changes the first joint, LeftUpLeg.
    text = replaced(text, "0 90 0 0 0 0 0 0 0", "0 90 0 0 0 0 10 20 30");
    const Motion m = loaded(text);
    // Expect v' = R1 R2 R3 v, with matrices written out.
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

// The root's offset is added only if its positions do not contain it; a root without positions
// stands at its offset.
TEST(Load, TheRootsOffsetCountsOnce) {
  struct Row {
    const char *channels, *values;
    vec3 root_m;
  };
  const std::string six = WalkerText().root_channels;
  for (const Row& row : {Row{six.c_str(), "5 90 7 0 0 0", vec3(0.05, 0.9, 0.07)},
                         {six.c_str(), "1 0 2 0 0 0", vec3(0.06, 0.9, 0.09)},
                         {"3 Zrotation Xrotation Yrotation", "0 0 0", vec3(0.05, 0.9, 0.07)}}) {
    WalkerText walker;
    walker.root_offset = "5 90 7";
    walker.root_channels = row.channels;
    walker.frames = row.values;
    const Motion m = loaded(walker.text());
    expect_near(m.frames[0].root_m, row.root_m, 1e-12, row.values);
    EXPECT_EQ(m.skeleton.joints[0].offset_m, vec3(0.0));
    EXPECT_NEAR(world_of(m)->position_m[m.legs[0].toe].y, 0.0, 1e-12);
  }
}

// Hips may have positions under a root that never moves. They replace the OFFSET in some files, and
// are added to it in others.
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
  // The file has x left, z up, -y forward.
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

TEST(Load, SharedFilesStandOnTheFloor) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const std::string& entry : files_in(kCapturedMotions, ".bvh")) {
    const std::string name = std::filesystem::path(entry).filename().string();
    const auto m = load_motion(entry);
    ASSERT_TRUE(m) << m.error().message;
    const bool has_floor =
        name != "bvhfiles_example.bvh" && name != "wisc_example.bvh";  // these are not walks
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
  // SNU's walk exists with and without helper joints: hips, knees and ankles agree.
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

Result<Motion> loaded_acclaim(const std::string& asf, const std::string& amc,
                              const LoadOptions& options = {}) {
  return motion_from_acclaim({"body.asf", asf}, {"walk.amc", amc}, options);
}

vec3 place(const Motion& m, const std::string& joint, std::size_t frame = 0) {
  return world_of(m, frame)->position_m[static_cast<std::size_t>(m.skeleton.find(joint))];
}

TEST(LoadAcclaim, BonesAreJointsAtTheirStartsAndChainsEndInEndSites) {
  const auto m = loaded_acclaim(acclaim_skeleton(), acclaim_motion());
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m->name, "walk.amc");
  EXPECT_EQ(m->skeleton.joints[0].name, "root");
  EXPECT_EQ(m->skeleton.joints[static_cast<std::size_t>(m->legs[kLeftSide].hip)].name, "lfemur");
  EXPECT_EQ(m->skeleton.joints[static_cast<std::size_t>(m->legs[kRightSide].toe)].name, "rtoes");
  EXPECT_EQ(m->skeleton.joints[static_cast<std::size_t>(m->legs[kRightSide].toe_end)].name,
            "rtoes_End");
  EXPECT_NEAR(m->metres_per_unit, 0.0254 / 0.45, 1e-15);
  EXPECT_EQ(m->frame_time_s, 1.0 / 120.0);
}

// The femur's axes are turned by 20 degrees about z, so its rx is about an axis in that plane.
TEST(LoadAcclaim, ABoneTurnsInItsOwnAxes) {
  const auto m = loaded_acclaim(acclaim_skeleton(), acclaim_motion());
  ASSERT_TRUE(m);
  const vec3 thigh = (place(*m, "ltibia") - place(*m, "lfemur")) / m->metres_per_unit / 7.5;
  const SinCos tilt = sin_cos(20.0 * kDegree), turn = sin_cos(30.0 * kDegree);
  const vec3 axis(tilt.cos, tilt.sin, 0.0), down(0.0, -1.0, 0.0);  // Rodrigues' formula
  const vec3 expected = down * turn.cos + glm::cross(axis, down) * turn.sin +
                        axis * glm::dot(axis, down) * (1.0 - turn.cos);
  EXPECT_LT(glm::distance(thigh, expected), 1e-12);
}

TEST(LoadAcclaim, TheOrderOfTheDofsIsTheOrderOfTheTurns) {
  const std::string asf = replaced(acclaim_skeleton(), "0 0 20 XYZ", "0 0 0 XYZ");
  const std::string amc = replaced(acclaim_motion(), "lfemur 30 0 0", "lfemur 90 90 0");
  const auto x_first = loaded_acclaim(asf, amc);
  const auto y_first = loaded_acclaim(replaced(asf, "dof rx ry rz", "dof ry rx rz"), amc);
  ASSERT_TRUE(x_first && y_first);
  const auto thigh = [](const Motion& m) { return place(m, "ltibia") - place(m, "lfemur"); };
  EXPECT_LT(thigh(*x_first).x, -0.3) << "up to the back, then round to the right";
  EXPECT_LT(thigh(*y_first).z, -0.3) << "in its own line, then back";
}

TEST(LoadAcclaim, RadiansAndRootPositionsAreFollowed) {
  std::string asf = replaced(acclaim_skeleton(), "angle deg", "angle rad");
  asf = replaced(replaced(asf, "20 XYZ", "0 XYZ"), "-90 0", "-1.5707963267948966 0");
  asf = replaced(asf, "position 0 0 0", "position 1 2 3");
  std::string amc = replaced(acclaim_motion(), ":DEGREES\n", "");
  amc = replaced(replaced(amc, "lfemur 30 0 0", "lfemur 0.5 0 0"), "ltibia 20", "ltibia 0.3");
  const auto m = loaded_acclaim(asf, replaced(amc, "thorax 1 2 3", "thorax 0 0 0"));
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_LT(glm::distance(m->frames[0].root_m, m->metres_per_unit * vec3(1.0, 19.0, 3.0)), 1e-12);
  const vec3 thigh = place(*m, "ltibia") - place(*m, "lfemur");
  EXPECT_NEAR(gaitpad::atan2(thigh.z, -thigh.y), -0.5, 1e-12);
}

TEST(LoadAcclaim, AMissingDofHoldsStill) {
  std::string asf = replaced(acclaim_skeleton(), "    dof rx\n    limits (-10.0 170.0)\n", "");
  std::string amc = replaced(replaced(acclaim_motion(), "ltibia 20\n", ""), "rtibia 0\n", "");
  const auto m = loaded_acclaim(asf, amc);
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m->frames[0].local[static_cast<std::size_t>(m->skeleton.find("ltibia"))], kIdentity);
}

TEST(LoadAcclaim, BonesMayMoveInTheirAxes) {
  const std::string asf = replaced(acclaim_skeleton(), "dof rx rz", "dof rx rz ty");
  std::string amc = replaced(acclaim_motion(), "foot 0 0\n", "foot 0 0 2\n");
  const auto m = loaded_acclaim(asf, amc),
             still = loaded_acclaim(acclaim_skeleton(), acclaim_motion());
  ASSERT_TRUE(m && still) << m.error().message;
  const vec3 moved = (place(*m, "rtoes") - place(*still, "rtoes")) / m->metres_per_unit;
  const vec3 axis = rotation_z(-20.0 * kDegree) * rotation_x(-90.0 * kDegree) * vec3(0.0, 2.0, 0.0);
  EXPECT_LT(glm::distance(moved, axis), 1e-9);
}

TEST(LoadAcclaim, AStatedUnitThatMakesNoLegIsNotBelieved) {
  std::string asf = acclaim_skeleton();
  const auto child = loaded_acclaim(replaced(asf, "length 0.45", "length 0.75"), acclaim_motion());
  ASSERT_TRUE(child);
  EXPECT_NEAR(child->metres_per_unit, 0.0254 / 0.75, 1e-15) << "a leg of 50 cm is a child's";
  const auto wrong = loaded_acclaim(replaced(asf, "length 0.45", "length 0.01"), acclaim_motion());
  ASSERT_TRUE(wrong);
  EXPECT_NEAR(wrong->metres_per_unit, 0.0254 / 0.45, 1e-15);
  LoadOptions given;
  given.metres_per_unit = 0.05;
  given.frame_rate_hz = 60.0;
  const auto told = loaded_acclaim(asf, acclaim_motion(), given);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->metres_per_unit, 0.05);
  EXPECT_EQ(told->frame_time_s, 1.0 / 60.0);
}

class AcclaimFolder : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    return own_.write(name, text);
  }
  OwnFolder own_;
  const fs::path folder_ = own_.path;
};

TEST_F(AcclaimFolder, TheSkeletonIsFoundByTheMotionsName) {
  const std::string motion = write("cmu_01_02.amc", acclaim_motion());
  EXPECT_EQ(load_motion(motion).error().message,
            motion +
                ": its skeleton is missing: neither cmu_01_02.asf nor cmu_01.asf nor a single "
                "other .asf file is in its folder");
  write("else.asf", acclaim_skeleton());
  EXPECT_TRUE(load_motion(motion));
  write("another.asf", "broken");
  EXPECT_FALSE(load_motion(motion)) << "which of two?";
  write("cmu_01.asf", acclaim_skeleton());
  EXPECT_TRUE(load_motion(motion));
  write("cmu_01_02.asf", "broken");
  EXPECT_NE(load_motion(motion).error().message.find("cmu_01_02.asf:1:"), std::string::npos);
  LoadOptions given;
  given.skeleton = (folder_ / "else.asf").string();
  EXPECT_TRUE(load_motion(motion, given));
  given.skeleton = (folder_ / "none.asf").string();
  EXPECT_EQ(load_motion(motion, given).error().message,
            given.skeleton + ": no such file (the skeleton of " + motion + ")");
}

TEST_F(AcclaimFolder, ASkeletonAloneStandsInItsRestPose) {
  const auto m = load_motion(write("Body.ASF", acclaim_skeleton()));
  ASSERT_TRUE(m) << m.error().message;
  ASSERT_EQ(m->frames.size(), 1u);
  EXPECT_LT(glm::distance(place(*m, "ltibia") - place(*m, "lfemur"),
                          vec3(0.0, -7.5 * m->metres_per_unit, 0.0)),
            1e-12);
}

TEST_F(AcclaimFolder, ABvhFileNeedsNoSkeleton) {
  LoadOptions given;
  given.skeleton = "body.asf";
  const std::string path = write("walk.bvh", WalkerText().text());
  EXPECT_EQ(load_motion(path, given).error().message,
            path + ": has its own skeleton, body.asf is not used with it");
}

}  // namespace
}  // namespace gaitpad
