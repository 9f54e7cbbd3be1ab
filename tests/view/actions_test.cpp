#include "view/controls.h"

#include <gtest/gtest.h>

#include <set>

namespace gaitpad {
namespace {

TEST(Actions, EachIsThereOnce) {
  std::set<Action> seen;
  for (const ActionInfo& info : actions())
    EXPECT_TRUE(seen.insert(info.action).second) << info.name;
  for (int a = 0; a <= static_cast<int>(Action::back); ++a) {
    EXPECT_TRUE(seen.count(static_cast<Action>(a))) << a;
    EXPECT_EQ(info_of(static_cast<Action>(a)).action, static_cast<Action>(a));
  }
}

TEST(Actions, EachHasAKeyAndNoTwoShareAKeyOrAButton) {
  std::set<SDL_Keycode> keys;
  std::set<int> buttons;
  for (const ActionInfo& info : actions()) {
    EXPECT_NE(info.key, SDLK_UNKNOWN) << info.name;
    EXPECT_TRUE(keys.insert(info.key).second) << info.name;
    if (info.second_key != SDLK_UNKNOWN) {
      EXPECT_TRUE(keys.insert(info.second_key).second) << info.name;
    }
    if (info.button >= 0) {
      EXPECT_TRUE(buttons.insert(info.button).second) << info.name;
      EXPECT_LT(info.button, kButtonCount);
    }
  }
  for (const SDL_Keycode walking :
       {SDLK_w, SDLK_a, SDLK_s, SDLK_d, SDLK_UP, SDLK_DOWN, SDLK_LEFT, SDLK_RIGHT}) {
    EXPECT_FALSE(keys.count(walking)) << key_name(walking);
  }
}

TEST(Actions, HelpIsOnF1AndH) {
  EXPECT_EQ(info_of(Action::help).key, SDLK_F1);
  EXPECT_EQ(info_of(Action::help).second_key, SDLK_h);
}

TEST(Actions, EveryKeyAndButtonHasANameOfItsOwn) {
  std::set<std::string_view> names, labels;
  for (const ActionInfo& info : actions()) {
    EXPECT_NE(key_name(info.key), "?") << info.name;
    EXPECT_TRUE(names.insert(key_name(info.key)).second) << key_name(info.key);
    if (info.second_key != SDLK_UNKNOWN) {
      EXPECT_TRUE(names.insert(key_name(info.second_key)).second) << key_name(info.second_key);
    }
    EXPECT_FALSE(info.group.empty() || info.name.empty() || info.text.empty());
  }
  for (int b = 0; b < kButtonCount; ++b) {
    EXPECT_TRUE(labels.insert(button_label(static_cast<PadButton>(b))).second) << b;
  }
}

TEST(Actions, KeysAreNamedAsTheyArePrinted) {
  EXPECT_EQ(key_name(SDLK_SPACE), "Space");
  EXPECT_EQ(key_name(SDLK_F1), "F1");
  EXPECT_EQ(key_name(SDLK_w), "W");
  EXPECT_EQ(key_name(SDLK_LEFTBRACKET), "[");
  EXPECT_EQ(key_name(SDLK_UNKNOWN), "?");
  EXPECT_EQ(key_name(0x7fffffff), "?");
}

}  // namespace
}  // namespace gaitpad
