#include <gtest/gtest.h>

#include <filesystem>

#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "motion/acclaim_text.h"
#include "motion/made_motion.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {
namespace fs = std::filesystem;

Result<Motion> loaded(const std::string& asf, const std::string& amc,
                      const LoadOptions& options = {}) {
  return motion_from_acclaim({"body.asf", asf}, {"walk.amc", amc}, options);
}

vec3 place(const Motion& m, const std::string& joint, std::size_t frame = 0) {
  return world_of(m, frame)->position_m[static_cast<std::size_t>(m.skeleton.find(joint))];
}

TEST(LoadAcclaim, BonesAreJointsAtTheirStartsAndChainsEndInEndSites) {
  const auto m = loaded(acclaim_skeleton(), acclaim_motion());
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
  const auto m = loaded(acclaim_skeleton(), acclaim_motion());
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
  const auto x_first = loaded(asf, amc);
  const auto y_first = loaded(replaced(asf, "dof rx ry rz", "dof ry rx rz"), amc);
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
  const auto m = loaded(asf, replaced(amc, "thorax 1 2 3", "thorax 0 0 0"));
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_LT(glm::distance(m->frames[0].root_m, m->metres_per_unit * vec3(1.0, 19.0, 3.0)), 1e-12);
  const vec3 thigh = place(*m, "ltibia") - place(*m, "lfemur");
  EXPECT_NEAR(gaitpad::atan2(thigh.z, -thigh.y), -0.5, 1e-12);
}

TEST(LoadAcclaim, AMissingDofHoldsStill) {
  std::string asf = replaced(acclaim_skeleton(), "    dof rx\n    limits (-10.0 170.0)\n", "");
  std::string amc = replaced(replaced(acclaim_motion(), "ltibia 20\n", ""), "rtibia 0\n", "");
  const auto m = loaded(asf, amc);
  ASSERT_TRUE(m) << m.error().message;
  EXPECT_EQ(m->frames[0].local[static_cast<std::size_t>(m->skeleton.find("ltibia"))], kIdentity);
}

TEST(LoadAcclaim, BonesMayMoveInTheirAxes) {
  const std::string asf = replaced(acclaim_skeleton(), "dof rx rz", "dof rx rz ty");
  std::string amc = replaced(acclaim_motion(), "foot 0 0\n", "foot 0 0 2\n");
  const auto m = loaded(asf, amc), still = loaded(acclaim_skeleton(), acclaim_motion());
  ASSERT_TRUE(m && still) << m.error().message;
  const vec3 moved = (place(*m, "rtoes") - place(*still, "rtoes")) / m->metres_per_unit;
  const vec3 axis = rotation_z(-20.0 * kDegree) * rotation_x(-90.0 * kDegree) * vec3(0.0, 2.0, 0.0);
  EXPECT_LT(glm::distance(moved, axis), 1e-9);
}

TEST(LoadAcclaim, AStatedUnitThatMakesNoLegIsNotBelieved) {
  std::string asf = acclaim_skeleton();
  const auto child = loaded(replaced(asf, "length 0.45", "length 0.75"), acclaim_motion());
  ASSERT_TRUE(child);
  EXPECT_NEAR(child->metres_per_unit, 0.0254 / 0.75, 1e-15) << "a leg of 50 cm is a child's";
  const auto wrong = loaded(replaced(asf, "length 0.45", "length 0.01"), acclaim_motion());
  ASSERT_TRUE(wrong);
  EXPECT_NEAR(wrong->metres_per_unit, 0.0254 / 0.45, 1e-15);
  LoadOptions given;
  given.metres_per_unit = 0.05;
  given.frame_rate_hz = 60.0;
  const auto told = loaded(asf, acclaim_motion(), given);
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
                "other .asf file stands beside it");
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
            path + ": brings its skeleton itself, body.asf is not for it");
}

}  // namespace
}  // namespace gaitpad
