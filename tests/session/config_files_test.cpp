#include "gaitpad/config_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class ConfigFiles : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"own/styles/even.toml", "own/styles/notes.txt",
                             "shipped/styles/even.toml", "shipped/styles/tired.toml"}) {
      own_.write(name, "\n");
    }
  }
  std::string at(const std::string& path) const { return own_.at(path); }

  OwnFolder own_;
};

TEST_F(ConfigFiles, TheFirstFolderThatHasANameWins) {
  const std::vector<std::string> folders = {at("own"), at("shipped")};
  EXPECT_EQ(*config_file(folders, "styles", "even"), at("own/styles/even.toml"));
  EXPECT_EQ(*config_file(folders, "styles", "tired"), at("shipped/styles/tired.toml"));
  EXPECT_EQ(config_files(folders, "styles"),
            (std::vector{at("own/styles/even.toml"), at("shipped/styles/tired.toml")}));
}

TEST_F(ConfigFiles, APathStaysAPath) {
  EXPECT_EQ(*config_file({}, "styles", "some/where"), "some/where");
  EXPECT_EQ(*config_file({}, "styles", "mine.toml"), "mine.toml");
}

TEST_F(ConfigFiles, AnUnknownNameListsTheKnownOnes) {
  const auto file = config_file({at("shipped")}, "styles", "tyred");
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().message, "there is no \"tyred\" in config/styles (known: even, tired)");
}

TEST_F(ConfigFiles, TheEnvironmentComesFirstAndTheBuiltInFolderLast) {
  const Environment config("GAITPAD_CONFIG", at("own").c_str());
  const std::vector<std::string> folders = config_folders(at("shipped"));
  ASSERT_GE(folders.size(), 2u);
  EXPECT_EQ(folders.front(), at("own"));
  EXPECT_EQ(folders.back(), at("shipped"));
}

TEST_F(ConfigFiles, FoldersThatDoNotExistAreLeftOut) {
  const Environment config("GAITPAD_CONFIG", at("nowhere").c_str());
  for (const std::string& folder : config_folders(at("nowhere"))) {
    EXPECT_NE(folder, at("nowhere"));
  }
}

}  // namespace
}  // namespace gaitpad
