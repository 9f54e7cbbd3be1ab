#include "view/gui.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

class FontTest : public ::testing::Test {
 protected:
  void SetUp() override { context_ = ImGui::CreateContext(); }
  void TearDown() override {
    ImGui::DestroyContext(context_);
    ::unsetenv("GAITPAD_FONT");
  }
  ImGuiContext* context_ = nullptr;
};

TEST_F(FontTest, SizesGrowWithTheScale) {
  const float body = load_fonts(1.0).body->FontSize;
  const Fonts twice = load_fonts(2.0);
  EXPECT_NEAR(twice.body->FontSize, 2.0f * body, 1.5f);
  EXPECT_LT(twice.tick->FontSize, twice.small->FontSize);
  EXPECT_LT(twice.small->FontSize, twice.body->FontSize);
  EXPECT_EQ(twice.heading->FontSize, twice.body->FontSize);
  EXPECT_LT(twice.body->FontSize, twice.title->FontSize);
}

TEST_F(FontTest, HasTheLettersThatPlotsNeed) {
  const Fonts fonts = load_fonts(1.0);
  if (fonts.family == "built in") GTEST_SKIP() << "DejaVu Sans is not installed";
  for (const ImWchar letter : {0x00b0, 0x00b5, 0x00e9, 0x03b1, 0x2190, 0x2264}) {
    EXPECT_NE(fonts.body->FindGlyphNoFallback(letter), nullptr) << letter;
  }
}

TEST_F(FontTest, AFileThatIsNoFontIsPassedOver) {
  const OwnFolder own;
  for (const std::string& file : {own.write("font", "no font at all, whatever its name says"),
                                  std::string("/nowhere/font.ttf"), std::string("/")}) {
    ::setenv("GAITPAD_FONT", file.c_str(), 1);
    const Fonts fonts = load_fonts(1.0);
    EXPECT_NE(fonts.family, file);
    ASSERT_NE(fonts.body, nullptr);
    EXPECT_NE(fonts.body->FindGlyphNoFallback('a'), nullptr);
  }
}

TEST_F(FontTest, TheUsersOwnFontComesFirst) {
  const char* dejavu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  if (!std::filesystem::exists(dejavu)) GTEST_SKIP() << dejavu << " is not installed";
  ::setenv("GAITPAD_FONT", dejavu, 1);
  EXPECT_EQ(load_fonts(1.0).family, dejavu);
}

TEST_F(FontTest, TypeGrowsAsFarAsItsScale) {
  EXPECT_EQ(load_fonts(6.4).body->FontSize, std::round(14.5 * 6.4));  // scale 4 and type at 160 %
}

TEST_F(FontTest, StyleIsScaledFromItsBeginningEachTime) {
  apply_style(theme_of(ThemeName::dark), 2.0);
  apply_style(theme_of(ThemeName::light), 2.0);
  EXPECT_EQ(ImGui::GetStyle().FramePadding.x, 20.0f);
  EXPECT_EQ(ImGui::GetStyle().Colors[ImGuiCol_Text].x,
            imgui_colour(theme_of(ThemeName::light).text).x);
}

TEST(DisplayScale, IsTheAskedOneElseTheEnvironmentsElseTheDisplays) {
  ::unsetenv("GDK_SCALE");
  EXPECT_EQ(display_scale(1.5, 192.0), 1.5);
  EXPECT_EQ(display_scale(0.0, 192.0), 2.0);
  EXPECT_EQ(display_scale(0.0, 96.0), 1.0);
  EXPECT_EQ(display_scale(0.0, 60.0), 1.0);
  EXPECT_EQ(display_scale(0.0, 960.0), 3.0);
  ::setenv("GDK_SCALE", "2", 1);
  EXPECT_EQ(display_scale(0.0, 96.0), 2.0);
  EXPECT_EQ(display_scale(1.25, 96.0), 1.25);
  ::setenv("GDK_SCALE", "no number", 1);
  EXPECT_EQ(display_scale(0.0, 144.0), 1.5);
  ::unsetenv("GDK_SCALE");
}

TEST(DisplayScale, WhatIsNoNumberIsOne) {
  ::unsetenv("GDK_SCALE");
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(display_scale(0.0, 0.0), 1.0);
  EXPECT_EQ(display_scale(none, none), 1.0);
  EXPECT_EQ(display_scale(0.0, std::numeric_limits<double>::infinity()), 1.0);
  EXPECT_LE(display_scale(1e9, 96.0), 4.0);
}

}  // namespace
}  // namespace gaitpad
