#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "gaitpad/config_files.h"
#include "gaitpad/math.h"
#include "gaitpad/style.h"
#include "gaitpad/walk_model.h"
#include "tests/folders.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {

// A temporary file; cause() is the error of reading it, without its path.
class OwnFile : public testing::Test {
 protected:
  std::string written(const std::string& text) const { return own_.write("mine.toml", text); }
  template <class T>
  std::string cause(const Result<T>& read) const {
    return read ? "none" : read.error().message.substr(own_.at("mine.toml").size());
  }
  OwnFolder own_;
};

class StyleFile : public OwnFile {
 protected:
  Result<Style> loaded(const std::string& text) { return load_style(written(text)); }
  std::string refusal(const std::string& text) { return cause(loaded(text)); }
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

// Tries random changes of equal and unequal legs, joints and single DOFs, one for each key.
TEST_F(StyleFile, TextReadsBackToTheSameValues) {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
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
  Style body;
  body.name = "mine";
  body.body.hand[kLeftSide].rail = 1.0;
  body.body.arm_weight[kLeftSide] = body.body.arm_weight[kRightSide] = {0.2, 0.2, 0.2, 1, 1, 0.5};
  const std::string of_body = style_text(body);
  EXPECT_EQ(of_body.substr(of_body.find('\n') + 1),
            "name = \"mine\"\n\n[arms]\nweight = { shoulder = 0.2, wrist_z = 0.5 }\n"
            "\n[left_hand]\nrail = 1\n");
}

// The file reader accepts every key with the same bounds.
TEST_F(StyleFile, KeysOfValuesAreThoseOfFiles) {
  bool is_below = false;
  for (const StyleKey& key : style_keys()) {
    is_below = !is_below;  // values at the bounds are tested in control/style_test
    const double outside = is_below ? key.min - 0.01 : key.max + 0.01;
    EXPECT_FALSE(loaded(key.name + " = " + std::to_string(outside))) << key.name;
    const double value = 0.5 * (key.min + key.max);
    const auto read = loaded(key.name + " = " + std::to_string(value));
    ASSERT_TRUE(read) << read.error().message;
    StyleValues set;
    ASSERT_TRUE(set_value(set, key.name, value)) << key.name;
    EXPECT_TRUE(set == *read) << key.name;
    EXPECT_EQ(value_of(set, key.name), value);
  }
}

// Keys with their ranges, as `leg: stride_length 0..1.5`; a limb's name stands for either side and
// for both.
using KeysOfLimbs = std::set<std::string>;

KeysOfLimbs known_keys() {
  KeysOfLimbs keys;
  for (const StyleKey& key : style_keys()) {
    std::string_view limb = key.limb, name = key.name;
    if (!limb.empty()) name.remove_prefix(limb.size() + 1);
    for (const std::string_view side : {"left_", "right_"}) {
      if (limb.starts_with(side)) limb.remove_prefix(side.size());
    }
    if (limb.ends_with('s')) limb.remove_suffix(1);  // `legs` means both of `leg`
    keys.insert(
        fmt::format("{}{}{} {:g}..{:g}", limb, limb.empty() ? "" : ": ", name, key.min, key.max));
  }
  return keys;
}

// Reads the keys in the tables of config/README.md: rows "| leg: `weight.hip`, `weight.knee` |
// 0..1, default 1 | ... |".
KeysOfLimbs documented_keys() {
  const std::string page = text_in(kSourceFolder + "/config/README.md");
  const std::size_t begin = page.find("## `styles/"), end = page.find("\n## ", begin);
  std::istringstream part(page.substr(begin, end - begin));
  const std::regex row(R"(\| (\w+: )?(`.*`) \| (-?[\d.]+\.\.[\d.]+), .*)"), quoted("`([^`]*)`");
  KeysOfLimbs keys;
  std::smatch found;
  for (std::string line; std::getline(part, line);) {
    if (!std::regex_match(line, found, row)) continue;
    const std::string names = found[2];
    for (std::sregex_iterator name(names.begin(), names.end(), quoted), last; name != last; ++name)
      keys.insert(fmt::format("{}{} {}", found[1].str(), (*name)[1].str(), found[3].str()));
  }
  return keys;
}

TEST(StyleKeys, ThePageOfFilesHasARowWithTheRangeOfEachKey) {
  EXPECT_EQ(documented_keys(), known_keys());
}

TEST_F(StyleFile, ArmsHandsSpineAndHeadHaveTables) {
  const auto style = loaded(
      "[arms]\nswing = 0.5\nweight = { shoulder = 0.2 }\n[right_arm]\nswing = 2\n"
      "weight = { shoulder_y = 1 }\n[hands]\ncarry = 1\n[left_hand]\nrail = 0.25\n"
      "[spine]\nweight = { lower = 0 }\n[head]\nlook = 1\nyaw_deg = -30");
  ASSERT_TRUE(style) << style.error().message;
  const UpperBodyParams& body = style->body;
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

class CharacterFile : public OwnFile {
 protected:
  Result<Character> loaded(const std::string& text) { return load_character(written(text)); }
  std::string refusal(const std::string& text) { return cause(loaded(text)); }
};

TEST_F(CharacterFile, OneLineIsEnoughAndASkeletonIsRelativeToTheFile) {
  auto character = loaded("leg_ratio = 0.6");
  ASSERT_TRUE(character) << character.error().message;
  EXPECT_EQ(character->leg_ratio, 0.6);
  EXPECT_EQ(character->scale, 1.0);
  EXPECT_EQ(character->name, "mine");
  EXPECT_EQ(character->skeleton, "");
  character = loaded("name = 'dancer'\nscale = 1.1\nskeleton = '../bvh/dancer.bvh'");
  ASSERT_TRUE(character) << character.error().message;
  EXPECT_EQ(character->name, "dancer");
  EXPECT_EQ(character->scale, 1.1);
  EXPECT_EQ(character->skeleton, own_.at("../bvh/dancer.bvh"));
  EXPECT_EQ(loaded("skeleton = '/a/b.bvh'")->skeleton, "/a/b.bvh");
}

TEST_F(CharacterFile, BadFilesAreRefusedWithFileAndLine) {
  EXPECT_EQ(refusal("\nleg_ratio = 0.2"), ":2: \"leg_ratio\" is 0.2, outside [0.3, 3]");
  EXPECT_EQ(refusal("scale = 4"), ":1: \"scale\" is 4, outside [0.3, 3]");
  EXPECT_EQ(refusal("skeleton = ''"), ":1: the path of the skeleton is empty");
  EXPECT_EQ(refusal("leg_ration = 1"),
            ":1: unknown key \"leg_ration\"; did you mean \"leg_ratio\"?");
  EXPECT_EQ(load_character("no.toml").error().message, "no.toml: no such file");
  EXPECT_EQ(load_style("no.toml").error().message, "no.toml: no such file");
}

}  // namespace
}  // namespace gaitpad
