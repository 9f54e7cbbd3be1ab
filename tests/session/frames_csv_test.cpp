#include <gtest/gtest.h>

#include <algorithm>

#include "session/walk_export.h"

namespace gaitpad {
namespace {

std::string row(const WalkFrame& frame) {
  fmt::memory_buffer out;
  append_frames_row(480, 240, Stick{vec2(-0.25, 0.5), vec2(0.0)}, frame, out);
  return fmt::to_string(out);
}

TEST(FramesCsv, ARowHasAsManyColumnsAsTheHeader) {
  fmt::memory_buffer header;
  append_frames_header(header);
  const std::string names = fmt::to_string(header), values = row(WalkFrame());
  EXPECT_EQ(std::ranges::count(names, ','), std::ranges::count(values, ','));
}

TEST(FramesCsv, TimeIsTheTickOverTheRateAndTheStickFollows) {
  EXPECT_TRUE(row(WalkFrame()).starts_with("480,2.000000000,-0.250000000,0.500000000,"));
}

TEST(FramesCsv, IdleSwingsNoFoot) {
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

TEST(FramesCsv, TheGroundUnderEachPointStandsLast) {
  WalkFrame frame;
  frame.heel_ground_m = {0.5, -0.25};
  frame.toe_ground_m = {1.5, 2.0};
  EXPECT_TRUE(row(frame).ends_with(",0.500000000,1.500000000,-0.250000000,2.000000000\n"));
}

TEST(FramesCsv, ThereIsNoMinusZero) {
  WalkFrame frame;
  frame.heading_rad = -0.0;
  EXPECT_EQ(row(frame).find("-0.000000000"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
