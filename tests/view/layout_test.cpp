#include "view/layout.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class LayoutTest : public ::testing::Test {
 protected:
  std::string path() const { return own_.at("sub/layout.toml"); }
  Layout loaded(const std::string& text) {
    return load_layout(own_.write("sub/layout.toml", text));
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
};

TEST_F(LayoutTest, WhatIsSavedIsLoadedAgain) {
  UiState state;
  state.is_open = {false, true, true, false, true, true};
  state.theme = ThemeName::light;
  state.has_trails = state.has_shadows = state.has_names = false;
  state.graph_leg = kRightSide;
  ASSERT_FALSE(save_layout(path(), state));
  const Layout layout = load_layout(path());
  EXPECT_EQ(layout.remark, "");
  EXPECT_EQ(layout.state.is_open, state.is_open);
  EXPECT_EQ(layout.state.theme, ThemeName::light);
  EXPECT_EQ(layout.state.graph_leg, kRightSide);
  EXPECT_FALSE(layout.state.has_trails);
  EXPECT_TRUE(layout.state.has_grid);
  EXPECT_FALSE(layout.state.has_shadows);
  EXPECT_TRUE(layout.state.has_source);
  EXPECT_FALSE(layout.state.has_names);
  state.is_open.fill(false);
  ASSERT_FALSE(save_layout(path(), state));
  EXPECT_EQ(load_layout(path()).state.is_open, state.is_open);
}

TEST_F(LayoutTest, WithoutAFileItIsAsAtFirst) {
  for (const std::string& none : {std::string(), path()}) {
    const Layout layout = load_layout(none);
    EXPECT_EQ(layout.remark, "");
    EXPECT_EQ(layout.state.is_open, UiState{}.is_open);
  }
}

TEST_F(LayoutTest, ADamagedFileIsToldInOneSentenceAndNothingOfItUsed) {
  const char* damaged[] = {"theme = \"light\"\npanels = [\"pad\", \"nonsense\"]",
                           "theme = \"light\"\ngrids = true",
                           "theme = \"light\"\ntrails = 1",
                           "theme = \"pink\"",
                           "theme = \"light",
                           "\xff\xfe\x01"};
  for (const char* text : damaged) {
    const Layout layout = loaded(text);
    EXPECT_EQ(layout.remark.rfind(path() + ":", 0), 0u) << layout.remark;
    EXPECT_EQ(layout.remark.find('\n'), std::string::npos);
    EXPECT_EQ(layout.state.theme, ThemeName::dark) << text;
    EXPECT_EQ(layout.state.is_open, UiState{}.is_open);
  }
}

TEST_F(LayoutTest, WhatCannotBeWrittenIsAnErrorAndNothingIsLeftBehind) {
  own_.write("file", "x");
  const auto problem = save_layout((folder_ / "file" / "layout.toml").string(), UiState{});
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->message.find("file"), std::string::npos);
  EXPECT_TRUE(save_layout((folder_ / "").string(), UiState{}));
  ASSERT_FALSE(save_layout((folder_ / "layout.toml").string(), UiState{}));
  EXPECT_EQ(own_.entries(), 2);
}

}  // namespace
}  // namespace gaitpad
