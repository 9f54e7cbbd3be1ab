#include <gtest/gtest.h>

#include "files/acclaim.h"
#include "motion/acclaim_text.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

Result<Amc> parsed(const std::string& text) {
  static const Asf asf = value_of(parse_asf(acclaim_skeleton(), "body.asf"));
  return parse_amc(text, "walk.amc", asf, "body.asf");
}

std::string error_of(const std::string& text) {
  const auto amc = parsed(text);
  return amc ? "" : amc.error().message;
}

TEST(Amc, PutsEachBonesNumbersWhereTheSkeletonHasThem) {
  const auto amc = parsed(acclaim_motion());
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
  const auto other = parsed(odd.substr(0, odd.size() - 1));
  const auto plain = parsed(acclaim_motion());
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
  EXPECT_EQ(parsed(":radians\n" + bare)->angle_unit, 1.0);
  EXPECT_EQ(parsed(":SAMPLES-PER-SECOND 60\n" + bare)->frame_rate_hz, 60.0);
}

TEST(Amc, ABoneThatIsLeftOutKeepsItsValuesUnlessAllWerePromised) {
  const std::string last = replaced(acclaim_frame(2), "lfemur 30 0 0\n", "");
  const auto amc = parsed(acclaim_frame(1) + last);
  ASSERT_TRUE(amc) << amc.error().message;
  EXPECT_EQ(amc->values[23 + 6], 30.0);
  EXPECT_EQ(error_of(":FULLY-SPECIFIED\n" + acclaim_frame(1) + last),
            "walk.amc:22: frame 2 lacks \"lfemur\", against the first one");
}

TEST(Amc, DamageIsNamedWithFileAndLine) {
  const std::string good = acclaim_motion();
  EXPECT_EQ(error_of(""),
            "walk.amc:0: no frame: a motion (.amc) has a line \"1\" where the first begins");
  EXPECT_EQ(error_of(replaced(good, "rtibia 0", "rtibia 0 1")),
            "walk.amc:12: frame 1: \"rtibia\" has 2 values, its skeleton says 1");
  EXPECT_EQ(error_of(replaced(good, "rtibia 0", "rtibia")),
            "walk.amc:12: frame 1: \"rtibia\" has 0 values, its skeleton says 1");
  EXPECT_EQ(error_of(replaced(good, "rtibia 0", "rtibia 1,5")),
            "walk.amc:12: frame 1, \"rtibia\": \"1,5\" is no usable number");
  EXPECT_EQ(error_of(replaced(good, "rtibia 0", "rshin 0")),
            "walk.amc:12: frame 1: body.asf has no bone \"rshin\"");
  EXPECT_EQ(error_of(replaced(good, "rtibia 0", "ltibia 0")),
            "walk.amc:12: frame 1: \"ltibia\" stands twice");
  EXPECT_EQ(error_of(replaced(good, "\n2\n", "\n4\n")), "walk.amc:15: frame 4 follows frame 1");
  EXPECT_EQ(error_of(replaced(good, "root 0 17 0 0 0 0\n", "")),
            "walk.amc:14: frame 1 has no root");
  EXPECT_EQ(error_of("HIERARCHY\n"),
            "walk.amc:1: \"HIERARCHY\" stands before the first frame's number");
}

TEST(Amc, NumbersThatAreNoneOrOutOfReachAreRefused) {
  for (const char* bad : {"nan", "inf", "-inf", "1e30", "1e999", "0x10", "--1", "1.#IND"}) {
    EXPECT_NE(error_of(replaced(acclaim_motion(), "rtibia 0", std::string("rtibia ") + bad)), "")
        << bad;
  }
  EXPECT_EQ(error_of(replaced(acclaim_motion(), "rtibia 0", "rtibia 6.3e-015")), "");
}

TEST(Amc, AFramesNumberThatIsNoneIsRefused) {
  EXPECT_NE(error_of(replaced(acclaim_motion(), "\n2\n", "\n99999999999999999999\n")), "");
  EXPECT_NE(error_of(replaced(acclaim_motion(), "\n2\n", "\n-2\n")), "");
}

TEST(Amc, ShortFramesCannotTakeMoreMemoryThanTheBound) {
  std::string text = acclaim_frame(1);
  for (int f = 2; f < 900000; ++f) text += std::to_string(f) + "\n";
  EXPECT_NE(error_of(text).find("more than 833333 frames of 12 bones"), std::string::npos)
      << error_of(text);
}

}  // namespace
}  // namespace gaitpad
