#include "gaitpad/style.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "gaitpad/config_files.h"
#include "gaitpad/math.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {

class StyleFile : public testing::Test {
 protected:
  Result<Style> loaded(const std::string& text) {
    return load_style(own_.write("mine.toml", text));
  }
  std::string refusal(const std::string& text) {
    auto style = loaded(text);
    return style ? "none" : style.error().message.substr(path_.size());
  }

  OwnFolder own_;
  const std::string path_ = own_.at("mine.toml");
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

// As many random changes as there are keys: equal and unequal legs, joints and single DOFs.
TEST_F(StyleFile, TextReadsBackToTheSameValues) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    Style style;
    style.name = "a \"quoted\" \\ name\twith \xc3\xa4 and \x01";
    for (int i = 0; i < round % 20; ++i) {
      const StyleKey& key = style_keys()[random() % style_keys().size()];
      const double share = std::generate_canonical<double, 53>(random);
      set_value(style, key.name, mix(key.min, key.max, share));
    }
    auto read = loaded(style_text(style));
    ASSERT_TRUE(read) << read.error().message << "\n" << style_text(style);
    EXPECT_TRUE(static_cast<const StyleValues&>(*read) == style) << style_text(style);
    EXPECT_EQ(read->name, style.name);
  }
}

TEST_F(StyleFile, TextIsAsPeopleWouldWriteIt) {
  Style style;
  style.name = "mine";
  style.stride[kLeftSide].length = 0.5;
  style.weight[kLeftSide] = {0.2, 0.2, 0.2, 1.0, 1.0, 0.3, 1.0};
  const std::string text = style_text(style);
  EXPECT_EQ(text.substr(text.find('\n') + 1),
            "name = \"mine\"\n\n[left_leg]\nstride_length = 0.5\n"
            "weight = { hip = 0.2, ankle_z = 0.3 }\n");
  EXPECT_FALSE(style_text(Style{}).empty());
}

// Every key is what the file's reader takes, with the same bounds.
TEST_F(StyleFile, KeysOfValuesAreThoseOfFiles) {
  for (const StyleKey& key : style_keys()) {
    const auto below = loaded(key.name + " = " + std::to_string(key.min - 0.01));
    const auto above = loaded(key.name + " = " + std::to_string(key.max + 0.01));
    EXPECT_FALSE(below) << key.name;
    EXPECT_FALSE(above) << key.name;
    const double value = 0.5 * (key.min + key.max);
    const auto read = loaded(key.name + " = " + std::to_string(value));
    ASSERT_TRUE(read) << read.error().message;
    StyleValues set;
    ASSERT_TRUE(set_value(set, key.name, value)) << key.name;
    EXPECT_TRUE(set == *read) << key.name;
    EXPECT_EQ(value_of(set, key.name), value);
  }
  constexpr std::size_t kLegKeys = 3 + 10, kArmKeys = 1 + 9, kHandKeys = 7, kSpineAndHead = 2 + 8;
  EXPECT_EQ(style_keys().size(), 6 + 3 * (kLegKeys + kArmKeys + kHandKeys) + kSpineAndHead);
}

TEST(StyleValue, OneLegOrBothChange) {
  StyleValues style;
  EXPECT_TRUE(set_value(style, "legs.stride_length", 0.8));
  EXPECT_TRUE(set_value(style, "right_leg.weight.hip", 0.25));
  EXPECT_TRUE(set_value(style, "right_leg.weight.hip_z", 0.75));
  EXPECT_EQ(style.stride[kLeftSide].length, 0.8);
  EXPECT_EQ(style.stride[kRightSide].length, 0.8);
  EXPECT_EQ(style.weight[kLeftSide], kEvenWeights);
  EXPECT_EQ(style.weight[kRightSide], (LegWeights{0.25, 0.75, 0.25, 1, 1, 1, 1}));
  EXPECT_EQ(value_of(style, "legs.weight.hip"), 1.0);
}

TEST(StyleValue, WhatIsUnknownOrOutOfBoundsChangesNothing) {
  StyleValues style;
  const char* const names[] = {"",
                               ".",
                               "legs",
                               "legs.",
                               "legs.weight",
                               "legs.weight.",
                               "legs.hip",
                               "weight.hip",
                               "arms.weight.hip",
                               "legs.weight.hip.x",
                               "legs.fatigue",
                               "fatigue.",
                               "hip_sway.x",
                               "left_leg.weight.elbow",
                               "arms",
                               "arms.carry",
                               "hands.weight.shoulder",
                               "spine.weight",
                               "spine.weight.",
                               "spine.weightlower",
                               "head.swing",
                               "heads.look",
                               " fatigue"};
  for (const char* name : names) {
    EXPECT_FALSE(set_value(style, name, 0.5)) << name;
    EXPECT_FALSE(value_of(style, name)) << name;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const StyleKey& key : style_keys()) {
    for (const double value : {key.min - 1e-9, key.max + 1e-9, nan, HUGE_VAL})
      EXPECT_FALSE(set_value(style, key.name, value)) << key.name;
  }
  EXPECT_TRUE(style == StyleValues{});
}

TEST(StyleValue, ALegIsNeverLockedAsAWhole) {
  StyleValues style;
  EXPECT_TRUE(set_value(style, "left_leg.weight.hip", 0.0));
  EXPECT_TRUE(set_value(style, "left_leg.weight.knee", 0.0));
  EXPECT_FALSE(set_value(style, "left_leg.weight.ankle", 0.0));
  EXPECT_FALSE(set_value(style, "legs.weight.ankle", 0.0)) << "the right one could, the left not";
  EXPECT_EQ(value_of(style, "right_leg.weight.ankle"), 1.0);
  EXPECT_TRUE(set_value(style, "left_leg.weight.ankle_y", 0.0));
}

TEST_F(StyleFile, ArmsHandsSpineAndHeadHaveTables) {
  const auto style = loaded(
      "[arms]\nswing = 0.5\nweight = { shoulder = 0.2 }\n[right_arm]\nswing = 2\n"
      "weight = { shoulder_y = 1 }\n[hands]\ncarry = 1\n[left_hand]\nrail = 0.25\n"
      "[spine]\nweight = { lower = 0 }\n[head]\nlook = 1\nyaw_deg = -30");
  ASSERT_TRUE(style) << style.error().message;
  const BodyParams& body = style->body;
  EXPECT_EQ(body.arm_swing, (std::array<double, 2>{0.5, 2.0}));
  EXPECT_EQ(body.arm_weight[kLeftSide], (ArmWeights{0.2, 0.2, 0.2, 1, 1, 1}));
  EXPECT_EQ(body.arm_weight[kRightSide], (ArmWeights{0.2, 0.2, 1, 1, 1, 1}));
  EXPECT_EQ(body.hand[kRightSide].carry, 1.0);
  EXPECT_EQ(body.hand[kLeftSide].rail, 0.25);
  EXPECT_EQ(body.hand[kRightSide].rail, 0.0);
  EXPECT_EQ(body.spine_weight, (SpineWeights{0.0, 1.0}));
  EXPECT_EQ(body.head.yaw_deg, -30.0);
}

TEST_F(StyleFile, ABodyThatCouldNotMoveIsRefused) {
  EXPECT_FALSE(loaded("[arms]\nweight = { shoulder = 0, elbow = 0, wrist = 0 }"));
  EXPECT_FALSE(loaded("[spine]\nweight = { lower = 0, upper = 0 }"));
  EXPECT_FALSE(loaded("[hands]\ngrip = 1"));
}

TEST_F(StyleFile, TextOfABodyIsAsPeopleWouldWriteIt) {
  Style style;
  style.name = "mine";
  style.body.hand[kLeftSide].rail = 1.0;
  style.body.arm_weight[kLeftSide] = style.body.arm_weight[kRightSide] = {0.2, 0.2, 0.2, 1, 1, 0.5};
  const std::string text = style_text(style);
  EXPECT_EQ(text.substr(text.find('\n') + 1),
            "name = \"mine\"\n\n[arms]\nweight = { shoulder = 0.2, wrist_z = 0.5 }\n"
            "\n[left_hand]\nrail = 1\n");
}

TEST(StyleValue, NoArmIsLockedAsAWhole) {
  StyleValues style;
  EXPECT_TRUE(set_value(style, "left_arm.weight.shoulder", 0.0));
  EXPECT_TRUE(set_value(style, "left_arm.weight.elbow", 0.0));
  EXPECT_FALSE(set_value(style, "left_arm.weight.wrist", 0.0));
  EXPECT_TRUE(set_value(style, "spine.weight.upper", 0.0));
  EXPECT_FALSE(set_value(style, "spine.weight.lower", 0.0));
  EXPECT_EQ(value_of(style, "right_arm.weight.shoulder"), 1.0);
}

TEST(LoadStyle, AbsentFileIsNamed) {
  EXPECT_EQ(load_style("no/such.toml").error().message, "no/such.toml: no such file");
}

}  // namespace
}  // namespace gaitpad
