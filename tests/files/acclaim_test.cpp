#include "files/acclaim.h"

#include <gtest/gtest.h>

#include "files/acclaim_text.h"
#include "gaitpad/skeleton.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

std::string asf_error(const std::string& text) {
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
  EXPECT_EQ(asf_error(moved), "");
}

TEST(Asf, DamageIsNamedWithFileAndLine) {
  const std::string good = acclaim_skeleton();
  EXPECT_EQ(asf_error(""), "body.asf:0: no bones: not a skeleton (.asf)");
  EXPECT_EQ(asf_error("HIERARCHY\n"),
            "body.asf:1: \"HIERARCHY\" is outside of a section (\":bonedata\" ...)");
  struct Row {
    const char *sound, *damaged, *says;
  };
  for (const Row& row :
       {Row{"length 7.5", "length x", "27: length \"x\" is not a length"},
        {"length 0.45", "length -1", "6: length \"-1\" is not a unit"},
        {"angle deg", "angle turns", "7: angles in \"turns\": only deg and rad are known"},
        {"ltibia lfoot", "ltibia lfoot lfoot", "118: \"lfoot\" has two parents"},
        {"    lfemur ltibia\n", "", "34: \"ltibia\" has no parent"},
        {"lfoot ltoes", "lfoot ltows", "119: no bone \"ltows\" in :bonedata above"},
        {"dof rx rz", "dof rx rq", "49: dof \"rq\" is not one of rx ry rz tx ty tz"},
        {"dof rx rz", "dof rx l",
         "49: \"lfoot\" changes its length (dof l), which no joint here can"},
        {"dof rx rz", "dof rx rx", "49: \"lfoot\" has dof rx twice"},
        {"name rtoes", "name ltoes", "94: a second bone \"ltoes\""},
        {"20 XYZ", "20 XYX", "28: axis: \"XYX\" is not an order of X, Y and Z"}})
    EXPECT_EQ(asf_error(replaced(good, row.sound, row.damaged)),
              std::string("body.asf:") + row.says);
  // Missing parts and cycles of bones are errors.
  for (const auto& [sound, damaged] : {std::pair("    name lfoot\n", ""),
                                       {"    direction 0 -1 2\n", ""},
                                       {"direction 0 -1 2", "direction 0 0 0"},
                                       {"direction 0 -1 2", "direction 0 nan 2"},
                                       {"direction 0 -1 2", "direction 0 -1"},
                                       {"root lhipjoint rhipjoint thorax", "thorax root"},
                                       {"begin\n    id 1", "id 1"}})
    EXPECT_NE(asf_error(replaced(good, sound, damaged)), "") << damaged;
  EXPECT_NE(asf_error(good.substr(0, good.find(":hierarchy"))), "");
  std::string ring = replaced(good, "root lhipjoint", "root");
  EXPECT_NE(asf_error(replaced(ring, "lfoot ltoes", "lfoot ltoes lhipjoint")), "");
}

TEST(Asf, TooManyBonesAreRefused) {
  std::string text = ":bonedata\n", tree;
  for (int i = 0; i < kMaxJoints; ++i) {
    text += acclaim_bone("b" + std::to_string(i), "0 1 0", "1", "");
  }
  EXPECT_NE(asf_error(text).find("more than 320 bones"), std::string::npos) << asf_error(text);
}

TEST(Asf, NoTruncationIsMistakenForABody) {
  const std::string text = acclaim_skeleton();
  for (std::size_t n = 0; n < text.rfind("rtoes"); ++n) {
    EXPECT_NE(asf_error(text.substr(0, n)), "") << "first " << n << " bytes";
  }
}

Result<Amc> parsed_amc(const std::string& text) {
  static const Asf asf = value_of(parse_asf(acclaim_skeleton(), "body.asf"));
  return parse_amc(text, "walk.amc", asf, "body.asf");
}

std::string amc_error(const std::string& text) {
  const auto amc = parsed_amc(text);
  return amc ? "" : amc.error().message;
}

TEST(Amc, PutsEachBonesNumbersWhereTheSkeletonHasThem) {
  const auto amc = parsed_amc(acclaim_motion());
  ASSERT_TRUE(amc) << amc.error().message;
  EXPECT_EQ(amc->frames, 2);
  EXPECT_EQ(amc->frame_rate_hz, 0.0);
  ASSERT_EQ(amc->values.size(), 2u * 23u);
  EXPECT_EQ(amc->values[1], 17.0);
  EXPECT_EQ(amc->values[6], 30.0) << "lfemur rx";
  EXPECT_EQ(amc->values[9], 20.0) << "ltibia rx";
  EXPECT_EQ(amc->values[22], 3.0) << "thorax rz";
}

TEST(Amc, LineEndsBlankLinesCommentsAndTheFirstNumberDoNotMatter) {
  std::string odd = ":fully-specified\r\n\r\n# from frame 0 on\r\n";
  odd += replaced(acclaim_frame(17), "\n", " \t\r\n") + "\n" + acclaim_frame(18);
  const auto other = parsed_amc(odd.substr(0, odd.size() - 1));
  const auto plain = parsed_amc(acclaim_motion());
  ASSERT_TRUE(plain);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(plain->values, other->values);
}

TEST(Amc, AnglesAreTheSkeletonsUnlessTheFileSaysItself) {
  Asf rad = value_of(parse_asf(acclaim_skeleton(), "body.asf"));
  rad.angle_unit = 1.0;
  const std::string bare = acclaim_frame(1);
  EXPECT_EQ(parse_amc(bare, "a", rad, "b")->angle_unit, 1.0);
  EXPECT_EQ(parse_amc(":DEGREES\n" + bare, "a", rad, "b")->angle_unit, kDegree);
  EXPECT_EQ(parsed_amc(":radians\n" + bare)->angle_unit, 1.0);
  EXPECT_EQ(parsed_amc(":SAMPLES-PER-SECOND 60\n" + bare)->frame_rate_hz, 60.0);
}

TEST(Amc, ABoneThatIsLeftOutKeepsItsValuesUnlessAllWerePromised) {
  const std::string last = replaced(acclaim_frame(2), "lfemur 30 0 0\n", "");
  const auto amc = parsed_amc(acclaim_frame(1) + last);
  ASSERT_TRUE(amc) << amc.error().message;
  EXPECT_EQ(amc->values[23 + 6], 30.0);
  EXPECT_EQ(amc_error(":FULLY-SPECIFIED\n" + acclaim_frame(1) + last),
            "walk.amc:22: frame 2 lacks \"lfemur\", against the first one");
}

TEST(Amc, DamageIsNamedWithFileAndLine) {
  const std::string good = acclaim_motion();
  EXPECT_EQ(amc_error(""),
            "walk.amc:0: no frame: a motion (.amc) has a line \"1\" where the first begins");
  EXPECT_EQ(amc_error("HIERARCHY\n"),
            "walk.amc:1: \"HIERARCHY\" is before the number of the first frame");
  struct Row {
    const char *sound, *damaged, *says;
  };
  for (const Row& row :
       {Row{"rtibia 0", "rtibia 0 1", "12: frame 1: \"rtibia\" has 2 values, its skeleton says 1"},
        {"rtibia 0", "rtibia", "12: frame 1: \"rtibia\" has 0 values, its skeleton says 1"},
        {"rtibia 0", "rtibia 1,5", "12: frame 1, \"rtibia\": \"1,5\" is not a usable number"},
        {"rtibia 0", "rshin 0", "12: frame 1: body.asf has no bone \"rshin\""},
        {"rtibia 0", "ltibia 0", "12: frame 1: \"ltibia\" occurs twice"},
        {"\n2\n", "\n4\n", "15: frame 4 follows frame 1"},
        {"root 0 17 0 0 0 0\n", "", "14: frame 1 has no root"}})
    EXPECT_EQ(amc_error(replaced(good, row.sound, row.damaged)),
              std::string("walk.amc:") + row.says);
  for (const char* bad : {"nan", "inf", "-inf", "1e30", "1e999", "0x10", "--1", "1.#IND"})
    EXPECT_NE(amc_error(replaced(good, "rtibia 0", std::string("rtibia ") + bad)), "") << bad;
  EXPECT_EQ(amc_error(replaced(good, "rtibia 0", "rtibia 6.3e-015")), "");
  for (const char* number : {"\n99999999999999999999\n", "\n-2\n"})
    EXPECT_NE(amc_error(replaced(good, "\n2\n", number)), "") << number;
}

TEST(Amc, ShortFramesCannotTakeMoreMemoryThanTheBound) {
  std::string text = acclaim_frame(1);
  for (int f = 2; f < 900000; ++f) text += std::to_string(f) + "\n";
  EXPECT_NE(amc_error(text).find("more than 833333 frames of 12 bones"), std::string::npos)
      << amc_error(text);
}

}  // namespace
}  // namespace gaitpad
