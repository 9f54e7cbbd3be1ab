#include "view/controls.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaitpad {
namespace {

SDL_Event key(SDL_Keycode code, Uint32 type = SDL_KEYDOWN, Uint16 mod = 0) {
  SDL_Event event = {};
  event.type = type;
  event.key.keysym.sym = code;
  event.key.keysym.mod = mod;
  return event;
}
SDL_Event button(Uint32 type, Uint8 number, int x, int y) {
  SDL_Event event = {};
  event.type = type;
  event.button.button = number;
  event.button.x = x;
  event.button.y = y;
  return event;
}
SDL_Event motion(int x, int y) {
  SDL_Event event = {};
  event.type = SDL_MOUSEMOTION;
  event.motion.x = x;
  event.motion.y = y;
  return event;
}
SDL_Event window(Uint8 what) {
  SDL_Event event = {};
  event.type = SDL_WINDOWEVENT;
  event.window.event = what;
  return event;
}

std::vector<Action> actions_of(const SDL_Event& event, const Taken& taken = {}) {
  Controls controls;
  controls.take(event, taken);
  return controls.wishes().actions;
}

TEST(Controls, EveryKeyOfTheTableAsksForItsActionAndForNoOther) {
  for (const ActionInfo& info : actions()) {
    for (const SDL_Keycode code : {info.key, info.second_key}) {
      if (code == SDLK_UNKNOWN) continue;
      EXPECT_EQ(actions_of(key(code)), std::vector{info.action}) << info.name;
      EXPECT_TRUE(actions_of(key(code, SDL_KEYUP)).empty()) << info.name;
    }
  }
}

TEST(Controls, WhoTypesAsksForNothing) {
  EXPECT_TRUE(actions_of(key(SDLK_SPACE), {.keys = true}).empty());
  Controls controls;
  controls.take(key(SDLK_w), {.keys = true});
  EXPECT_EQ(controls.walk(), vec2(0.0));
}

TEST(Controls, ChordsAreForTheWindowManager) {
  EXPECT_TRUE(actions_of(key(SDLK_SPACE, SDL_KEYDOWN, KMOD_LALT)).empty());
  Controls controls;
  controls.take(key(SDLK_w, SDL_KEYDOWN, KMOD_LCTRL), {});
  EXPECT_EQ(controls.walk(), vec2(0.0));
}

TEST(Controls, AHeldKeyPausesOnceAndStepsAgainAndAgain) {
  SDL_Event held = key(SDLK_SPACE);
  held.key.repeat = 1;
  EXPECT_TRUE(actions_of(held).empty());
  for (const ActionInfo& info : actions()) {
    if (info.action != Action::step) continue;
    held.key.keysym.sym = info.key;
    EXPECT_EQ(actions_of(held), std::vector{Action::step});
  }
}

TEST(Controls, BothSetsOfKeysWalkAndADiagonalIsNoLonger) {
  const std::pair<SDL_Keycode, vec2> kKeys[] = {
      {SDLK_w, {0, 1}},  {SDLK_a, {-1, 0}},    {SDLK_s, {0, -1}},    {SDLK_d, {1, 0}},
      {SDLK_UP, {0, 1}}, {SDLK_LEFT, {-1, 0}}, {SDLK_DOWN, {0, -1}}, {SDLK_RIGHT, {1, 0}}};
  for (const auto& [code, wanted] : kKeys) {
    Controls controls;
    controls.take(key(code), {});
    EXPECT_EQ(controls.walk(), wanted);
    controls.take(key(code, SDL_KEYUP), {});
    EXPECT_EQ(controls.walk(), vec2(0.0));
  }
  Controls controls;
  for (const SDL_Keycode code : {SDLK_w, SDLK_RIGHT}) controls.take(key(code), {});
  EXPECT_NEAR(controls.walk().x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(controls.walk().y, std::sqrt(0.5), 1e-12);
  controls.take(key(SDLK_UP), {});  // the same way by both: as by one
  EXPECT_NEAR(glm::length(controls.walk()), 1.0, 1e-12);
}

TEST(Controls, FocusLossLetsEverythingGo) {
  for (const Uint8 what : {SDL_WINDOWEVENT_FOCUS_LOST, SDL_WINDOWEVENT_MINIMIZED}) {
    Controls controls;
    controls.take(key(SDLK_w), {});
    controls.take(button(SDL_MOUSEBUTTONDOWN, SDL_BUTTON_LEFT, 10, 10), {});
    controls.take(window(what), {});
    controls.take(motion(50, 50), {});
    EXPECT_EQ(controls.walk(), vec2(0.0));
    EXPECT_FALSE(controls.mouse().is_down[0]);
    EXPECT_EQ(controls.wishes().orbit_px, vec2(0.0));
  }
}

TEST(Controls, ADragOrbitsWithAnotherButtonOrShiftItPans) {
  const auto dragged = [](Uint8 number, bool is_shifted) {
    Controls controls;
    if (is_shifted) controls.take(key(SDLK_LSHIFT), {});
    controls.take(motion(100, 100), {});
    controls.take(button(SDL_MOUSEBUTTONDOWN, number, 100, 100), {});
    controls.take(motion(130, 90), {});
    controls.take(button(SDL_MOUSEBUTTONUP, number, 130, 90), {});
    controls.take(motion(200, 200), {});  // let go: moves nothing
    return controls.wishes();
  };
  EXPECT_EQ(dragged(SDL_BUTTON_LEFT, false).orbit_px, vec2(30, -10));
  EXPECT_EQ(dragged(SDL_BUTTON_LEFT, false).pan_px, vec2(0, 0));
  EXPECT_EQ(dragged(SDL_BUTTON_MIDDLE, false).pan_px, vec2(30, -10));
  EXPECT_EQ(dragged(SDL_BUTTON_RIGHT, false).pan_px, vec2(30, -10));
  EXPECT_EQ(dragged(SDL_BUTTON_LEFT, true).pan_px, vec2(30, -10));
  EXPECT_EQ(dragged(SDL_BUTTON_LEFT, true).orbit_px, vec2(0, 0));
}

TEST(Controls, AboveAPanelTheMouseIsThePanels) {
  Controls controls;
  controls.take(button(SDL_MOUSEBUTTONDOWN, SDL_BUTTON_LEFT, 100, 100), {.mouse = true});
  controls.take(motion(130, 90), {.mouse = true});
  SDL_Event wheel = {};
  wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.y = 1;
  controls.take(wheel, {.mouse = true});
  EXPECT_TRUE(controls.mouse().is_down[0]);
  const Wishes wishes = controls.wishes();
  EXPECT_EQ(wishes.orbit_px, vec2(0.0));
  EXPECT_EQ(wishes.dolly, 1.0);
}

TEST(Controls, TheWheelGoesNearerAndBackToWhereItWas) {
  Controls controls;
  SDL_Event wheel = {};
  wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.y = 2;
  controls.take(wheel, {});
  const double nearer = controls.wishes().dolly;
  EXPECT_LT(nearer, 1.0);
  wheel.wheel.y = -2;
  controls.take(wheel, {});
  EXPECT_NEAR(nearer * controls.wishes().dolly, 1.0, 1e-12);
}

SessionFrame pressed_times(int button, std::uint32_t times) {
  SessionFrame frame;
  frame.presses[static_cast<std::size_t>(button)] = times;
  return frame;
}

TEST(ButtonPresses, EachPressAsksOnceWhetherTheFramesSawItOrNot) {
  for (const ActionInfo& info : actions()) {
    if (info.button < 0) continue;
    ButtonPresses presses;
    std::vector<Action> wanted;
    presses.take(pressed_times(info.button, 7), wanted);  // before the window was there
    EXPECT_TRUE(wanted.empty());
    presses.take(pressed_times(info.button, 9), wanted);  // twice between two frames
    EXPECT_EQ(wanted, (std::vector{info.action, info.action})) << info.name;
    wanted.clear();
    presses.take(pressed_times(info.button, 9), wanted);
    EXPECT_TRUE(wanted.empty());
  }
}

TEST(ButtonPresses, AnotherSessionCountsAnew) {
  ButtonPresses presses;
  std::vector<Action> wanted;
  presses.take(pressed_times(kButtonStart, 5), wanted);
  presses.begin_anew();
  presses.take(pressed_times(kButtonStart, 0), wanted);
  EXPECT_TRUE(wanted.empty());
  presses.take(pressed_times(kButtonStart, 1), wanted);
  EXPECT_EQ(wanted, std::vector{Action::pause});
}

}  // namespace
}  // namespace gaitpad
