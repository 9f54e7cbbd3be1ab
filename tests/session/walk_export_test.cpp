#include "session/walk_export.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

// --- output files, which are published together

namespace fs = std::filesystem;

class OutputFolder : public testing::Test {
 protected:
  std::string text(const std::string& name) const { return text_in(folder_ / name); }
  void write_and_publish(const std::string& content) {
    auto files = OutputFiles::open(folder_.string());
    ASSERT_TRUE(files);
    auto stream = files->add("a.txt");
    ASSERT_TRUE(stream);
    **stream << content;
    EXPECT_FALSE(files->publish());
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path / "deep";
};

TEST_F(OutputFolder, IsCreatedAndHoldsPublishedFiles) {
  write_and_publish("one");
  EXPECT_EQ(text("a.txt"), "one");
  EXPECT_EQ(entries_in(folder_), 1);
}

TEST_F(OutputFolder, KeepsTheOldFileUntilTheNewOneIsPublished) {
  write_and_publish("one");
  {
    auto files = OutputFiles::open(folder_.string());
    ASSERT_TRUE(files);
    **files->add("a.txt") << "two";
    EXPECT_EQ(text("a.txt"), "one");
  }
  EXPECT_EQ(text("a.txt"), "one");
  EXPECT_EQ(entries_in(folder_), 1) << "a temporary file stayed behind";
  write_and_publish("three");
  EXPECT_EQ(text("a.txt"), "three");
}

TEST_F(OutputFolder, AScratchFileKeepsItsTextAndStaysInvisible) {
  auto files = OutputFiles::open(folder_.string());
  ASSERT_TRUE(files);
  auto one = files->scratch(), two = files->scratch();
  ASSERT_TRUE(one && two);
  *one << "one";
  *two << "two";
  EXPECT_EQ(entries_in(folder_), 0);
  one->seekg(0);
  std::string back;
  *one >> back;
  EXPECT_EQ(back, "one");
}

TEST_F(OutputFolder, AFileInItsPlaceIsRefused) {
  write_and_publish("one");
  const auto files = OutputFiles::open((folder_ / "a.txt" / "below").string());
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message.find("a.txt/below"), std::string::npos);
  EXPECT_FALSE(OutputFiles::open((folder_ / "a.txt").string()));
}

TEST_F(OutputFolder, AFullDiskIsReportedAtPublishing) {
  fs::create_directories(folder_);
  auto files = OutputFiles::open(folder_.string());
  ASSERT_TRUE(files);
  auto stream = files->add("a.txt");
  ASSERT_TRUE(stream);
  (*stream)->setstate(std::ios::badbit);
  EXPECT_TRUE(files->publish());
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
}

// --- frames.csv

std::string row(const WalkFrame& frame) {
  std::string out;
  append_frames_row(480, 240, Stick{vec2(-0.25, 0.5), vec2(0.0)}, frame, out);
  return out;
}

TEST(FramesCsv, ARowHasAsManyColumnsAsTheHeader) {
  std::string header;
  append_frames_header(header);
  const std::string values = row(WalkFrame());
  EXPECT_EQ(std::ranges::count(header, ','), std::ranges::count(values, ','));
}

TEST(FramesCsv, TimeIsTheTickOverTheRateAndTheStickFollows) {
  EXPECT_TRUE(row(WalkFrame()).starts_with("480,2.000000000,-0.250000000,0.500000000,"));
}

TEST(FramesCsv, NoFootSwingsWhenIdle) {
  WalkFrame frame;
  frame.swing = kRightSide;
  EXPECT_NE(row(frame).find(",idle,none,1,1,1,1,"), std::string::npos);
  frame.stage = Stage::flight;
  frame.heel_planted = {true, false};
  frame.toe_planted = {true, false};
  EXPECT_NE(row(frame).find(",flight,right,1,1,0,0,"), std::string::npos);
  frame.stage = Stage::roll;
  EXPECT_NE(row(frame).find(",roll,right,"), std::string::npos);
}

TEST(FramesCsv, TheGroundUnderEachPointIsLast) {
  WalkFrame frame;
  frame.heel_ground_m = {0.5, -0.25};
  frame.toe_ground_m = {1.5, 2.0};
  EXPECT_TRUE(row(frame).ends_with(",0.500000000,1.500000000,-0.250000000,2.000000000\n"));
}

TEST(FramesCsv, NegativeZeroIsWrittenAsZero) {
  WalkFrame frame;
  frame.heading_rad = -0.0;
  EXPECT_EQ(row(frame).find("-0.000000000"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
