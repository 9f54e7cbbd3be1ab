#include "animation/character.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace gaitpad {
namespace {

class CharacterFile : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  Result<Character> loaded(const std::string& text) {
    std::ofstream(path_) << text;
    return load_character(path_);
  }
  std::string refusal(const std::string& text) {
    auto character = loaded(text);
    return character ? "none" : character.error().message.substr(path_.size());
  }
  // Tests run side by side, each in its own process.
  std::string folder_ = testing::TempDir() + "gaitpad_character_" + std::to_string(getpid());
  std::string path_ = folder_ + "/mine.toml";
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
  const auto folder = std::filesystem::path(path_).parent_path();
  EXPECT_EQ(character->skeleton, (folder / "../bvh/dancer.bvh").string());
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
