#include "gaitpad/config_files.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "gaitpad/pad_configuration.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"

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

TEST_F(ConfigFiles, APathStaysAPathAndAnUnknownNameListsTheKnownOnes) {
  EXPECT_EQ(*config_file({}, "styles", "some/where"), "some/where");
  EXPECT_EQ(*config_file({}, "styles", "mine.toml"), "mine.toml");
  EXPECT_EQ(cause_of(config_file({at("shipped")}, "styles", "tyred")),
            "there is no \"tyred\" in config/styles; did you mean \"tired\"?");
  EXPECT_EQ(cause_of(config_file({at("shipped")}, "styles", "sideways")),
            "there is no \"sideways\" in config/styles (known: even, tired)");
}

TEST_F(ConfigFiles, TheEnvironmentComesFirstAndTheUsersFolderLast) {
  const Environment config("GAITPAD_CONFIG", at("own").c_str());
  own_.write("home/gaitpad/styles/tired.toml", "hip_sway = 2\n");
  own_.write("home/gaitpad/styles/mine.toml", "\n");
  const Environment home("XDG_CONFIG_HOME", at("home").c_str());
  const std::vector<std::string> folders = config_folders(at("shipped"));
  ASSERT_GE(folders.size(), 3u);
  EXPECT_EQ(folders.front(), at("own"));
  EXPECT_EQ(folders.back(), at("home/gaitpad"));
  EXPECT_EQ(*config_file(folders, "styles", "tired"), at("shipped/styles/tired.toml"))
      << "a user's file hides no bundled one";
  EXPECT_EQ(*config_file(folders, "styles", "mine"), at("home/gaitpad/styles/mine.toml"));
}

TEST_F(ConfigFiles, FoldersThatDoNotExistAreLeftOut) {
  const Environment config("GAITPAD_CONFIG", at("nowhere").c_str());
  for (const std::string& folder : config_folders(at("nowhere"))) {
    EXPECT_NE(folder, at("nowhere"));
  }
}

class StyleStore : public testing::Test {
 protected:
  void SetUp() override {
    own_.write("shipped/styles/even.toml", "\n");
    values_.fatigue = 0.25;
    values_.weight[kLeftSide][kKneeX] = 0.3;
  }
  std::string shipped() const { return own_.at("shipped"); }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
  const Environment config_home_{"XDG_CONFIG_HOME", folder_.c_str()};
  StyleValues values_;
};

TEST_F(StyleStore, ASavedStyleIsFoundByItsNameAndReadBackTheSame) {
  const auto path = save_style({shipped()}, "my limp", values_);
  ASSERT_TRUE(path) << path.error().message;
  const auto folders = config_folders(shipped());
  const auto found = config_file(folders, "styles", "my limp");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(*found, *path);
  const auto style = load_style(*found);
  ASSERT_TRUE(style) << style.error().message;
  EXPECT_EQ(static_cast<const StyleValues&>(*style), values_);
}

TEST_F(StyleStore, AShippedStyleIsNeverHidden) {
  const auto path = save_style({shipped()}, "even", values_);
  ASSERT_FALSE(path);
  EXPECT_NE(path.error().message.find("even"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "gaitpad/styles/even.toml"));
}

TEST_F(StyleStore, TheOwnOneIsReplacedAndTheOldOneKept) {
  ASSERT_TRUE(save_style({shipped()}, "mine", StyleValues()));
  const auto path = save_style(config_folders(shipped()), "mine", values_);
  ASSERT_TRUE(path) << path.error().message;
  EXPECT_EQ(load_style(*path)->fatigue, 0.25);
  EXPECT_TRUE(fs::exists(*path + ".old"));
}

TEST_F(StyleStore, ANameIsNoPath) {
  for (const char* name : {"", "  ", "../x", "a/b", ".hidden", "\xff", "tab\there"})
    EXPECT_FALSE(save_style({shipped()}, name, values_)) << name;
  EXPECT_FALSE(save_style({shipped()}, std::string(49, 'a'), values_));
  EXPECT_FALSE(fs::exists(folder_ / "gaitpad"));
}

TEST_F(StyleStore, PadsOfTheUsersFolderSteerNoReplay) {
  fs::create_directories(folder_ / "gaitpad/calibration");
  own_.write("gaitpad/pads/mine.toml", "not = a pad file\n");
  const auto files = load_pad_files(config_folders(shipped()), "", "");
  ASSERT_TRUE(files) << files.error().message;
  for (const std::string& folder : files->calibration_folders)
    EXPECT_EQ(folder.find("gaitpad/calibration"), std::string::npos) << folder;
  EXPECT_EQ(files->user_calibrations, user_config_folder() + "/calibration");
}

}  // namespace
}  // namespace gaitpad
