#include "gaitpad/bvh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "gaitpad/skeleton.h"
#include "motion/bvh_text.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

std::string error_of(const std::string& text) {
  const auto bvh = parse_bvh(text, "walk.bvh");
  return bvh ? "" : bvh.error().message;
}

const std::string kTiny =
    "HIERARCHY\nROOT a\n{\nOFFSET 1 2 3\nCHANNELS 2 Xrotation Yposition\n"
    "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n1 2\n3 4\n";

TEST(Bvh, KeepsJointsChannelsAndNumbersInTheFilesOrder) {
  const auto bvh = parse_bvh(kTiny, "walk.bvh");
  ASSERT_TRUE(bvh);
  ASSERT_EQ(bvh->joints.size(), 2u);
  EXPECT_EQ(bvh->joints[0].offset, vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(bvh->joints[0].channel[0], BvhChannel::x_rotation);
  EXPECT_EQ(bvh->joints[0].channel[1], BvhChannel::y_position);
  EXPECT_EQ(bvh->joints[1].name, "a_End");
  EXPECT_TRUE(bvh->joints[1].is_end_site);
  EXPECT_EQ(bvh->joints[1].parent, 0);
  EXPECT_EQ(bvh->values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(bvh->frame_time_s, 0.5);
}

TEST(Bvh, LineEndsTabsBlanksAndAMissingLastNewlineChangeNothing) {
  const auto plain = parse_bvh(kTiny, "a");
  std::string odd = replaced(kTiny, "\n", " \t\r\n");
  odd = replaced(odd, "1 2 \t", "1\t 2\t");
  odd = "\xef\xbb\xbf" + odd.substr(0, odd.find_last_of('4') + 1);
  const auto other = parse_bvh(odd, "b");
  ASSERT_TRUE(plain);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(plain->values, other->values);
  EXPECT_EQ(plain->joints[1].name, other->joints[1].name);
}

TEST(Bvh, ReadsEveryWayToWriteANumber) {
  const std::string text =
      replaced(replaced(kTiny, "0.5", ".0083333"), "3 4", "-9.39531e-005 +1.5E2");
  const auto bvh = parse_bvh(text, "a");
  ASSERT_TRUE(bvh) << bvh.error().message;
  EXPECT_EQ(bvh->frame_time_s, 0.0083333);
  EXPECT_EQ(bvh->values[2], -9.39531e-5);
  EXPECT_EQ(bvh->values[3], 150.0);
}

TEST(Bvh, NamesMayHoldColonsAndBlanksAndTheBraceMayFollowOnTheLine) {
  const auto bvh = parse_bvh(replaced(kTiny, "ROOT a\n{", "ROOT mixamorig:Left Foot {"), "a");
  ASSERT_TRUE(bvh) << bvh.error().message;
  EXPECT_EQ(bvh->joints[0].name, "mixamorig:Left Foot");
}

TEST(Bvh, SeveralEndSitesOfAJointHaveDifferentNames) {
  const auto bvh = parse_bvh(
      replaced(kTiny, "OFFSET 0 1 0\n}", "OFFSET 0 1 0\n}\nEnd Site\n{\nOFFSET 0 2 0\n}"), "a");
  ASSERT_TRUE(bvh) << bvh.error().message;
  EXPECT_EQ(bvh->joints[1].name, "a_End");
  EXPECT_EQ(bvh->joints[2].name, "a_End2");
}

TEST(Bvh, WrongOrMissingValuesAreNamedWithFileAndLine) {
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 x4")),
            "walk.bvh:15: frame 1, value 1: \"x4\" is no usable number");
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3")), "walk.bvh:15: frame 1 has 1 of 2 values");
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 4 5")),
            "walk.bvh:15: frame 1 has more than 2 values");
  EXPECT_EQ(error_of(replaced(kTiny, "1 2\n3 4\n", "1.000 2.000\n")),
            "walk.bvh:15: the motion ends after 1 of 2 frames");
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 4\n5 6")),
            "walk.bvh:16: \"5 6\" behind the last of 2 frames");
  EXPECT_EQ(error_of(replaced(kTiny, "OFFSET 1 2 3", "OFFSET 1 2")),
            "walk.bvh:5: OFFSET of \"a\": \"CHANNELS\" is no number");
}

TEST(Bvh, NumbersThatAreNoneOrOutOfReachAreRefused) {
  for (const char* bad : {"nan", "inf", "-inf", "1e30", "1e999", "0x10", "1,5", "1.#IND", "--1"}) {
    EXPECT_NE(error_of(replaced(kTiny, "3 4", std::string("3 ") + bad)), "") << bad;
  }
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 1e-999")), "");
}

TEST(Bvh, LyingCountsAreRefusedBeforeMemoryIsTaken) {
  EXPECT_EQ(error_of(replaced(kTiny, "Frames: 2", "Frames: 1000000")),
            "walk.bvh:13: 1000000 frames of 2 channels do not fit in the 9 bytes left");
  EXPECT_NE(error_of(replaced(kTiny, "Frames: 2", "Frames: -1")), "");
  EXPECT_NE(error_of(replaced(kTiny, "Frames: 2", "Frames: 1.5")), "");
  EXPECT_NE(error_of(replaced(kTiny, "CHANNELS 2", "CHANNELS 7")), "");
  EXPECT_NE(error_of(replaced(kTiny, "CHANNELS 2", "CHANNELS 3")), "");
  EXPECT_NE(error_of(replaced(kTiny, "0.5", "0")), "");
}

TEST(Bvh, TooManyJointsAndTooDeepASkeletonAreRefused) {
  std::string deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 100000; ++i) deep += "JOINT b\n{\n";
  EXPECT_NE(error_of(deep).find("more than 320 joints"), std::string::npos);
}

TEST(Bvh, EveryTruncationIsRefused) {
  const std::string text = WalkerText().text();
  // Without its last characters the last number may still be one; from there on all is missing.
  for (std::size_t n = 0; n + 2 < text.size(); ++n) {
    EXPECT_NE(error_of(text.substr(0, n)), "") << "first " << n << " bytes";
  }
}

TEST(Bvh, DamagedHierarchiesAreRefused) {
  EXPECT_NE(error_of(""), "");
  EXPECT_NE(error_of(replaced(kTiny, "HIERARCHY", "BIERARCHY")), "");
  EXPECT_NE(error_of(replaced(kTiny, "Yposition", "Wposition")), "");
  EXPECT_NE(error_of(replaced(kTiny, "Yposition", "Xrotation")), "");
  EXPECT_NE(error_of(replaced(kTiny, "OFFSET 0 1 0", "OFFSET 0 1 0\nJOINT b\n{\n}")), "");
  EXPECT_NE(error_of(replaced(kTiny, "MOTION", "ROOT b\n{\n}\nMOTION")), "");
}

TEST(Bvh, AJointHasOneOffset) {
  EXPECT_NE(error_of(replaced(kTiny, "OFFSET 0 1 0", "OFFSET 0 1 0\nOFFSET 0 1 0")), "");
  const std::string text = replaced(WalkerText().text(), "OFFSET 10 -2 0\n", "");
  EXPECT_NE(error_of(text).find("\"LeftUpLeg\" has no OFFSET"), std::string::npos);
}

TEST(Bvh, AMissingFileOrAFolderIsOneSentence) {
  EXPECT_EQ(read_bvh("/nowhere/walk.bvh").error().message, "/nowhere/walk.bvh: no such file");
  EXPECT_FALSE(read_bvh(std::filesystem::temp_directory_path().string()));
}

TEST(Bvh, AllSharedFilesAreRead) {
  GAITPAD_NEEDS(kCapturedMotions);
  int files = 0;
  for (const std::string& entry : files_in(kCapturedMotions, ".bvh")) {
    const auto bvh = read_bvh(entry);
    EXPECT_TRUE(bvh) << bvh.error().message;
    ++files;
  }
  EXPECT_GE(files, 30);
}

TEST(Bvh, LineEndsOfASharedFileChangeNothing) {
  GAITPAD_NEEDS(kCapturedMotions);
  const auto lf = read_bvh(kCapturedMotions + "mocapbank_test.bvh");
  const auto crlf = read_bvh(kCapturedMotions + "mocapbank_test_crlf.bvh");
  ASSERT_TRUE(lf && crlf);
  EXPECT_EQ(lf->values, crlf->values);
}

}  // namespace
}  // namespace gaitpad
