#include "control/style.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace gaitpad {
namespace {

class StyleFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  Result<Style> loaded(const std::string& text) {
    std::ofstream(path_) << text;
    return load_style(path_);
  }
  std::string refusal(const std::string& text) {
    auto style = loaded(text);
    return style ? "none" : style.error().message.substr(path_.size());
  }
  // Tests run side by side, each in its own process.
  std::string folder_ = testing::TempDir() + "gaitpad_style_" + std::to_string(getpid());
  std::string path_ = folder_ + "/mine.toml";
};

TEST_F(StyleFile, EmptyFileIsTheEvenStyleNamedAfterTheFile) {
  auto style = loaded("");
  ASSERT_TRUE(style);
  EXPECT_EQ(style->name, "mine");
  EXPECT_EQ(style->weight[kLeftSide], kEvenWeights);
  EXPECT_EQ(style->stride[kRightSide].length, 1.0);
  EXPECT_EQ(style->fatigue, 0.0);
  EXPECT_EQ(style->hip_sway, 1.0);
}

TEST_F(StyleFile, OneLegOverridesBothAndOneDofItsJoint) {
  auto style = loaded(
      "fatigue = 0.25\nhip_sway = 2\nhip_bounce = 0.5\n"
      "[legs]\nstride_length = 0.9\nweight = {hip_z = 0.7, hip = 0.5, ankle = 0.4}\n"
      "[left_leg]\nstride_speed = 1.3\nweight = {knee = 0.3, ankle_y = 0}\n");
  ASSERT_TRUE(style) << style.error().message;
  EXPECT_EQ(style->fatigue, 0.25);
  EXPECT_EQ(style->hip_sway, 2.0);
  EXPECT_EQ(style->hip_bounce, 0.5);
  EXPECT_EQ(style->stride[kLeftSide].length, 0.9);
  EXPECT_EQ(style->stride[kRightSide].length, 0.9);
  EXPECT_EQ(style->stride[kLeftSide].speed, 1.3);
  EXPECT_EQ(style->stride[kRightSide].speed, 1.0);
  EXPECT_EQ(style->weight[kRightSide], (LegWeights{0.5, 0.7, 0.5, 1.0, 0.4, 0.4, 0.4}));
  EXPECT_EQ(style->weight[kLeftSide], (LegWeights{0.5, 0.7, 0.5, 0.3, 0.4, 0.4, 0.0}));
}

TEST_F(StyleFile, WeightsOutsideZeroToOneAreRefused) {
  EXPECT_EQ(refusal("[legs]\nweight = {hip = 1.2}"), ":2: \"hip\" is 1.2, outside [0, 1]");
  EXPECT_EQ(refusal("[left_leg.weight]\n\nknee_x = -0.1"),
            ":3: \"knee_x\" is -0.1, outside [0, 1]");
  EXPECT_EQ(refusal("[left_leg.weight]\nhip = nan"), ":2: \"hip\" is nan, outside [0, 1]");
  EXPECT_EQ(refusal("[right_leg]\nweight = {hip = 0, knee = 0, ankle = 0}"),
            ":2: all weights of the leg are 0: it could not move");
}

TEST_F(StyleFile, UnknownKeysAndWrongValuesAreRefused) {
  EXPECT_EQ(refusal("\nfatige = 1"), ":2: unknown key \"fatige\"; did you mean \"fatigue\"?");
  EXPECT_EQ(refusal("[legs]\nweight = {elbow = 1}"), ":2: unknown key \"elbow\"");
  EXPECT_EQ(refusal("fatigue = 1.5"), ":1: \"fatigue\" is 1.5, outside [0, 1]");
  EXPECT_EQ(refusal("[left_leg]\nstride_speed = 0"), ":2: \"stride_speed\" is 0, outside [0.5, 2]");
  EXPECT_EQ(refusal("legs = 1"), ":1: \"legs\" is not a table");
  EXPECT_EQ(refusal("name = ''"), ":1: the name is empty");
  EXPECT_EQ(refusal("name = \n").substr(0, 4), ":1: ");
}

TEST(LoadStyle, AbsentFileIsNamed) {
  EXPECT_EQ(load_style("no/such.toml").error().message, "no/such.toml: no such file");
}

}  // namespace
}  // namespace gaitpad
