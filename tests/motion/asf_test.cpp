#include <gtest/gtest.h>

#include "files/acclaim.h"
#include "gaitpad/skeleton.h"
#include "motion/acclaim_text.h"

namespace gaitpad {
namespace {

std::string error_of(const std::string& text) {
  const auto asf = parse_asf(text, "body.asf");
  return asf ? "" : asf.error().message;
}

const AsfBone& bone_of(const Asf& asf, const std::string& name) {
  for (const AsfBone& bone : asf.bones)
    if (bone.name == name) return bone;
  ADD_FAILURE() << name;
  return asf.bones[0];
}

TEST(Asf, KeepsBonesInTheHierarchysOrderWithTheirChannels) {
  const auto asf = parse_asf(acclaim_skeleton(), "body.asf");
  ASSERT_TRUE(asf) << asf.error().message;
  ASSERT_EQ(asf->bones.size(), 12u);
  EXPECT_EQ(asf->bones[0].name, "root");
  EXPECT_EQ(asf->bones[2].name, "lfemur");
  EXPECT_EQ(asf->bones[2].parent, 1);
  EXPECT_EQ(asf->length_unit, 0.45);
  EXPECT_EQ(asf->channels, 6 + 2 * (3 + 1 + 2 + 1) + 3);
  const AsfBone& foot = bone_of(*asf, "rfoot");
  EXPECT_EQ(foot.channels, 2);
  EXPECT_EQ(foot.channel[1], AsfChannel::rz);
  EXPECT_NEAR(glm::length(foot.direction), 1.0, 1e-15);
  EXPECT_NEAR(foot.end().z, 2.4 * 2.0 / std::sqrt(5.0), 1e-12);
}

TEST(Asf, AxesTurnAboutXThenYThenZ) {
  const auto asf = parse_asf(acclaim_skeleton(), "body.asf");
  ASSERT_TRUE(asf);
  const quat expected = rotation_z(20.0 * kDegree) * rotation_x(-90.0 * kDegree);
  EXPECT_GT(std::abs(glm::dot(bone_of(*asf, "lfoot").axes, expected)), 1.0 - 1e-12);
  const auto other = parse_asf(replaced(acclaim_skeleton(), "-90 0 20 XYZ", "-90 0 20 zyx"), "a");
  ASSERT_TRUE(other) << other.error().message;
  const quat reversed = rotation_x(-90.0 * kDegree) * rotation_z(20.0 * kDegree);
  EXPECT_GT(std::abs(glm::dot(bone_of(*other, "lfoot").axes, reversed)), 1.0 - 1e-12);
}

TEST(Asf, RadiansMayBeToldAfterTheBones) {
  std::string text = replaced(acclaim_skeleton(), "  angle deg\n", "");
  text = replaced(text, "0 0 20 XYZ", "0 0 0.5 XYZ") + ":units\n  ANGLE rad\n";
  const auto asf = parse_asf(text, "a");
  ASSERT_TRUE(asf) << asf.error().message;
  EXPECT_EQ(asf->angle_unit, 1.0);
  EXPECT_GT(std::abs(glm::dot(bone_of(*asf, "lfemur").axes, rotation_z(0.5))), 1.0 - 1e-12);
}

TEST(Asf, OldDialectsReadTheSame) {
  const auto plain = parse_asf(acclaim_skeleton(), "a");
  std::string odd = replaced(acclaim_skeleton(), "\n", "  \r\n");
  odd = replaced(odd, ":bonedata", ":BONEDATA\n\n# limbs");
  odd = replaced(odd, "dof rx ry rz", "DOF RX RY RZ   # all");
  odd = replaced(odd, "TX TY TZ RX RY RZ", "tx ty tz rx ry rz");
  odd = replaced(odd, "(-10.0 170.0)", "(-inf inf)");
  const auto other = parse_asf("\xef\xbb\xbf" + odd, "b");
  ASSERT_TRUE(plain);
  ASSERT_TRUE(other) << other.error().message;
  ASSERT_EQ(plain->bones.size(), other->bones.size());
  for (std::size_t i = 0; i < plain->bones.size(); ++i) {
    EXPECT_EQ(plain->bones[i].name, other->bones[i].name);
    EXPECT_EQ(plain->bones[i].channel, other->bones[i].channel);
    EXPECT_EQ(plain->bones[i].end(), other->bones[i].end());
  }
}

TEST(Asf, SectionsMayStandInAnyOrderAndUnknownOnesAreSkipped) {
  const std::string text = acclaim_skeleton();
  const auto root = text.find(":root"), bones = text.find(":bonedata");
  const auto moved = text.substr(0, root) + text.substr(bones) + text.substr(root, bones - root) +
                     ":skin\n  character.skin\n";
  EXPECT_EQ(error_of(moved), "");
}

TEST(Asf, DamageIsNamedWithFileAndLine) {
  const std::string good = acclaim_skeleton();
  EXPECT_EQ(error_of(""), "body.asf:0: no bones: not a skeleton (.asf)");
  EXPECT_EQ(error_of("HIERARCHY\n"),
            "body.asf:1: \"HIERARCHY\" stands in no section (\":bonedata\" ...)");
  EXPECT_EQ(error_of(replaced(good, "length 7.5", "length x")),
            "body.asf:27: length \"x\" is none");
  EXPECT_EQ(error_of(replaced(good, "length 0.45", "length -1")),
            "body.asf:6: length \"-1\" is no unit");
  EXPECT_EQ(error_of(replaced(good, "angle deg", "angle turns")),
            "body.asf:7: angles in \"turns\": deg or rad is known");
  EXPECT_EQ(error_of(replaced(good, "ltibia lfoot", "ltibia lfoot lfoot")),
            "body.asf:118: \"lfoot\" hangs on two bones");
  EXPECT_EQ(error_of(replaced(good, "    lfemur ltibia\n", "")),
            "body.asf:34: \"ltibia\" hangs on no bone");
  EXPECT_EQ(error_of(replaced(good, "lfoot ltoes", "lfoot ltows")),
            "body.asf:119: no bone \"ltows\" in :bonedata above");
  EXPECT_EQ(error_of(replaced(good, "dof rx rz", "dof rx rq")),
            "body.asf:49: dof \"rq\" is none of rx ry rz tx ty tz");
  EXPECT_EQ(error_of(replaced(good, "dof rx rz", "dof rx l")),
            "body.asf:49: \"lfoot\" changes its length (dof l), which no joint here can");
  EXPECT_EQ(error_of(replaced(good, "dof rx rz", "dof rx rx")),
            "body.asf:49: \"lfoot\" has dof rx twice");
  EXPECT_EQ(error_of(replaced(good, "name rtoes", "name ltoes")),
            "body.asf:94: a second bone \"ltoes\"");
  EXPECT_EQ(error_of(replaced(good, "20 XYZ", "20 XYX")),
            "body.asf:28: axis: \"XYX\" is no order of X, Y and Z");
}

TEST(Asf, WhatIsMissingIsRefused) {
  const std::string good = acclaim_skeleton();
  EXPECT_NE(error_of(replaced(good, "    name lfoot\n", "")), "");
  EXPECT_NE(error_of(replaced(good, "    direction 0 -1 2\n", "")), "");
  EXPECT_NE(error_of(replaced(good, "direction 0 -1 2", "direction 0 0 0")), "");
  EXPECT_NE(error_of(replaced(good, "direction 0 -1 2", "direction 0 nan 2")), "");
  EXPECT_NE(error_of(replaced(good, "direction 0 -1 2", "direction 0 -1")), "");
  EXPECT_NE(error_of(good.substr(0, good.find(":hierarchy"))), "");
  EXPECT_NE(error_of(replaced(good, "root lhipjoint rhipjoint thorax", "thorax root")), "");
  EXPECT_NE(error_of(replaced(good, "begin\n    id 1", "id 1")), "");
  std::string ring = replaced(good, "root lhipjoint", "root");
  EXPECT_NE(error_of(replaced(ring, "lfoot ltoes", "lfoot ltoes lhipjoint")), "") << "a ring";
}

TEST(Asf, TooManyBonesAreRefused) {
  std::string text = ":bonedata\n", tree;
  for (int i = 0; i < kMaxJoints; ++i) {
    text += acclaim_bone("b" + std::to_string(i), "0 1 0", "1", "");
  }
  EXPECT_NE(error_of(text).find("more than 320 bones"), std::string::npos) << error_of(text);
}

TEST(Asf, NoTruncationIsMistakenForABody) {
  const std::string text = acclaim_skeleton();
  for (std::size_t n = 0; n < text.rfind("rtoes"); ++n) {
    EXPECT_NE(error_of(text.substr(0, n)), "") << "first " << n << " bytes";
  }
}

}  // namespace
}  // namespace gaitpad
