#include <gtest/gtest.h>

#include "gaitpad/config_files.h"
#include "gaitpad/walk_model.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {

class CharacterFile : public testing::Test {
 protected:
  Result<Character> loaded(const std::string& text) {
    return load_character(own_.write("mine.toml", text));
  }
  std::string refusal(const std::string& text) {
    auto character = loaded(text);
    return character ? "none" : character.error().message.substr(path_.size());
  }

  OwnFolder own_;
  const std::string path_ = own_.at("mine.toml");
};

TEST_F(CharacterFile, OneLineIsEnough) {
  auto character = loaded("leg_ratio = 0.6");
  ASSERT_TRUE(character) << character.error().message;
  EXPECT_EQ(character->leg_ratio, 0.6);
  EXPECT_EQ(character->scale, 1.0);
  EXPECT_EQ(character->name, "mine");
  EXPECT_EQ(character->skeleton, "");
}

TEST_F(CharacterFile, SkeletonIsRelativeToTheFile) {
  auto character = loaded("name = 'dancer'\nscale = 1.1\nskeleton = '../bvh/dancer.bvh'");
  ASSERT_TRUE(character) << character.error().message;
  EXPECT_EQ(character->name, "dancer");
  EXPECT_EQ(character->scale, 1.1);
  EXPECT_EQ(character->skeleton, own_.at("../bvh/dancer.bvh"));
}

TEST_F(CharacterFile, AbsoluteSkeletonStaysAbsolute) {
  EXPECT_EQ(loaded("skeleton = '/a/b.bvh'")->skeleton, "/a/b.bvh");
}

TEST_F(CharacterFile, BadFilesAreRefusedWithFileAndLine) {
  EXPECT_EQ(refusal("\nleg_ratio = 0.2"), ":2: \"leg_ratio\" is 0.2, outside [0.3, 3]");
  EXPECT_EQ(refusal("scale = 4"), ":1: \"scale\" is 4, outside [0.3, 3]");
  EXPECT_EQ(refusal("skeleton = ''"), ":1: the path of the skeleton is empty");
  EXPECT_EQ(refusal("leg_ration = 1"),
            ":1: unknown key \"leg_ration\"; did you mean \"leg_ratio\"?");
  EXPECT_EQ(load_character("no.toml").error().message, "no.toml: no such file");
}

}  // namespace
}  // namespace gaitpad
