#include "view/controls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

TEST(Actions, HelpIsOnF1AndH) {
  EXPECT_EQ(info_of(Action::help).key, SDLK_F1);
  EXPECT_EQ(info_of(Action::help).second_key, SDLK_h);
}

TEST(Actions, EachHasAKeyEveryKeyAndButtonANameOfItsOwnAndNoTwoShareThem) {
  std::set<std::string_view> names, labels;
  std::set<int> buttons;
  for (const Chord& chord : chords()) EXPECT_TRUE(names.insert(chord.name).second) << chord.name;
  for (const ActionInfo& info : actions()) {
    if (info.key == SDLK_UNKNOWN) {
      EXPECT_GT(std::ranges::count(chords(), info.action, &Chord::action), 0) << info.name;
    } else {
      EXPECT_NE(key_name(info.key), "?") << info.name;
      EXPECT_TRUE(names.insert(key_name(info.key)).second) << key_name(info.key);
    }
    if (info.second_key != SDLK_UNKNOWN) {
      EXPECT_TRUE(names.insert(key_name(info.second_key)).second) << key_name(info.second_key);
    }
    if (info.button >= 0) {
      EXPECT_TRUE(buttons.insert(info.button).second) << info.name;
      EXPECT_LT(info.button, kButtonCount);
    }
    EXPECT_FALSE(info.group.empty() || info.name.empty() || info.text.empty());
  }
  for (int b = 0; b < kButtonCount; ++b) {
    EXPECT_TRUE(labels.insert(button_label(static_cast<PadButton>(b))).second) << b;
  }
  for (const SDL_Keycode walking :
       {SDLK_w, SDLK_a, SDLK_s, SDLK_d, SDLK_UP, SDLK_DOWN, SDLK_LEFT, SDLK_RIGHT}) {
    EXPECT_FALSE(names.contains(key_name(walking))) << key_name(walking);
  }
}

ActionInfo with_keys(Action action, SDL_Keycode key, SDL_Keycode second_key = SDLK_UNKNOWN) {
  return {action, key, second_key, -1, "name", "group", "text"};
}

// The build of the window stops at such a table, for example if a panel gets F9, the key of record.
TEST(Actions, TwoWithTheSameKeyAreFound) {
  EXPECT_EQ(shared_key(actions()), SDLK_UNKNOWN);
  const ActionInfo record = with_keys(Action::record, SDLK_F9);
  const ActionInfo help = with_keys(Action::help, SDLK_F1, SDLK_h);
  const ActionInfo undo = with_keys(Action::undo, SDLK_UNKNOWN);
  using Table = std::vector<ActionInfo>;
  EXPECT_EQ(shared_key(Table{record, help, undo, undo}), SDLK_UNKNOWN);
  EXPECT_EQ(shared_key(Table{record, help, with_keys(Action::first_panel, SDLK_F9)}), SDLK_F9);
  EXPECT_EQ(shared_key(Table{help, with_keys(Action::first_panel, SDLK_h)}), SDLK_h);
  EXPECT_EQ(shared_key(Table{with_keys(Action::first_panel, SDLK_F2, SDLK_h), help}), SDLK_h);
  EXPECT_EQ(shared_key(Table{with_keys(Action::first_panel, SDLK_F2, SDLK_F2)}), SDLK_F2);
}

TEST(Actions, KeysAreNamedAsTheyArePrinted) {
  EXPECT_EQ(key_name(SDLK_SPACE), "Space");
  EXPECT_EQ(key_name(SDLK_F1), "F1");
  EXPECT_EQ(key_name(SDLK_w), "W");
  EXPECT_EQ(key_name(SDLK_LEFTBRACKET), "[");
  EXPECT_EQ(key_name(SDLK_UNKNOWN), "?");
  EXPECT_EQ(key_name(0x7fffffff), "?");
}

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

std::vector<Action> actions_of(const SDL_Event& event, const TakenInput& taken = {}) {
  Controls controls;
  controls.handle_event(event, taken);
  return controls.take_requests().actions;
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
  controls.handle_event(key(SDLK_w), {.keys = true});
  EXPECT_EQ(controls.walk(), vec2(0.0));
}

TEST(Controls, ChordsAreForTheWindowManager) {
  EXPECT_TRUE(actions_of(key(SDLK_SPACE, SDL_KEYDOWN, KMOD_LALT)).empty());
  Controls controls;
  controls.handle_event(key(SDLK_w, SDL_KEYDOWN, KMOD_LCTRL), {});
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
    controls.handle_event(key(code), {});
    EXPECT_EQ(controls.walk(), wanted);
    controls.handle_event(key(code, SDL_KEYUP), {});
    EXPECT_EQ(controls.walk(), vec2(0.0));
  }
  Controls controls;
  for (const SDL_Keycode code : {SDLK_w, SDLK_RIGHT}) controls.handle_event(key(code), {});
  EXPECT_NEAR(controls.walk().x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(controls.walk().y, std::sqrt(0.5), 1e-12);
  controls.handle_event(key(SDLK_UP), {});  // two keys of one direction have the effect of one
  EXPECT_NEAR(glm::length(controls.walk()), 1.0, 1e-12);
}

TEST(Controls, FocusLossLetsEverythingGo) {
  for (const Uint8 what : {SDL_WINDOWEVENT_FOCUS_LOST, SDL_WINDOWEVENT_MINIMIZED}) {
    Controls controls;
    controls.handle_event(key(SDLK_w), {});
    controls.handle_event(button(SDL_MOUSEBUTTONDOWN, SDL_BUTTON_LEFT, 10, 10), {});
    controls.handle_event(window(what), {});
    controls.handle_event(motion(50, 50), {});
    EXPECT_EQ(controls.walk(), vec2(0.0));
    EXPECT_FALSE(controls.mouse().is_down[0]);
    EXPECT_EQ(controls.take_requests().orbit_px, vec2(0.0));
  }
}

TEST(Controls, ADragOrbitsWithAnotherButtonOrShiftItPans) {
  const auto dragged = [](Uint8 number, bool is_shifted) {
    Controls controls;
    if (is_shifted) controls.handle_event(key(SDLK_LSHIFT), {});
    controls.handle_event(motion(100, 100), {});
    controls.handle_event(button(SDL_MOUSEBUTTONDOWN, number, 100, 100), {});
    controls.handle_event(motion(130, 90), {});
    controls.handle_event(button(SDL_MOUSEBUTTONUP, number, 130, 90), {});
    controls.handle_event(motion(200, 200), {});  // after the release the pointer has no effect
    return controls.take_requests();
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
  controls.handle_event(button(SDL_MOUSEBUTTONDOWN, SDL_BUTTON_LEFT, 100, 100), {.mouse = true});
  controls.handle_event(motion(130, 90), {.mouse = true});
  SDL_Event wheel = {};
  wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.y = 1;
  controls.handle_event(wheel, {.mouse = true});
  EXPECT_TRUE(controls.mouse().is_down[0]);
  const UserRequests requests = controls.take_requests();
  EXPECT_EQ(requests.orbit_px, vec2(0.0));
  EXPECT_EQ(requests.dolly, 1.0);
}

TEST(Controls, TheWheelGoesNearerAndBackToWhereItWas) {
  Controls controls;
  SDL_Event wheel = {};
  wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.y = 2;
  controls.handle_event(wheel, {});
  const double nearer = controls.take_requests().dolly;
  EXPECT_LT(nearer, 1.0);
  wheel.wheel.y = -2;
  controls.handle_event(wheel, {});
  EXPECT_NEAR(nearer * controls.take_requests().dolly, 1.0, 1e-12);
}

// On a QWERTZ keyboard Y is at the place of QWERTY's Z; the letter printed on the key counts.
TEST(Controls, KeysAreTakenByWhatIsEngravedOnThem) {
  SDL_Event event = {};
  event.type = SDL_KEYDOWN;
  event.key.keysym.sym = SDLK_y;
  event.key.keysym.scancode = SDL_SCANCODE_Z;
  Controls controls;
  controls.handle_event(event, {});
  EXPECT_EQ(controls.take_requests().keys, std::vector<SDL_Keycode>{SDLK_y});
  TakenInput typing;
  typing.keys = true;
  controls.handle_event(event, typing);
  EXPECT_TRUE(controls.take_requests().keys.empty());
}

TEST(Controls, WhileKeysNavigateTheyNeitherWalkNorAct) {
  TakenInput taken;
  taken.navigates = true;
  Controls controls;
  for (const SDL_Keycode code : {SDLK_DOWN, SDLK_TAB, SDLK_RIGHT, SDLK_RIGHT, SDLK_SPACE}) {
    SDL_Event event = {};
    event.type = SDL_KEYDOWN;
    event.key.keysym.sym = code;
    controls.handle_event(event, taken);
  }
  EXPECT_EQ(controls.walk(), vec2(0.0));
  const UserRequests requests = controls.take_requests();
  EXPECT_TRUE(requests.actions.empty());
  EXPECT_EQ(requests.navigation.steps, 2);
  EXPECT_EQ(requests.navigation.sideways, 2);
  EXPECT_TRUE(requests.navigation.press);
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
    // These presses came before the window opened.
    presses.add_new_presses(pressed_times(info.button, 7), wanted);
    EXPECT_TRUE(wanted.empty());
    // Two presses between two frames.
    presses.add_new_presses(pressed_times(info.button, 9), wanted);
    EXPECT_EQ(wanted, (std::vector{info.action, info.action})) << info.name;
    wanted.clear();
    presses.add_new_presses(pressed_times(info.button, 9), wanted);
    EXPECT_TRUE(wanted.empty());
  }
}

TEST(ButtonPresses, AnotherSessionCountsAnew) {
  ButtonPresses presses;
  std::vector<Action> wanted;
  presses.add_new_presses(pressed_times(kButtonStart, 5), wanted);
  presses.start_again();
  presses.add_new_presses(pressed_times(kButtonStart, 0), wanted);
  EXPECT_TRUE(wanted.empty());
  presses.add_new_presses(pressed_times(kButtonStart, 1), wanted);
  EXPECT_EQ(wanted, std::vector{Action::pause});
}

}  // namespace
}  // namespace gaitpad
