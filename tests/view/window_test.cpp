#include "view/window.h"

#include <algorithm>
#include <memory>

#include "gaitpad/config_files.h"
#include "tests/view/window_script.h"

namespace gaitpad {
namespace {

using Glance = WindowGlance;

// For the steps of one action: its key, and what is to be seen.
class ActionScript : public Script {
 public:
  explicit ActionScript(const WindowOptions& options) {
    styles_ = options.session.walk.styles;
    // Those of config/ that are not among them, by name.
    for (const std::string& path : config_files(options.session.config_folders, "styles")) {
      if (std::ranges::count(styles_, config_name(path)) == 0) styles_.push_back(config_name(path));
    }
  }
  void add(const ActionInfo& info);

 private:
  // Turns a thing over and back again.
  void turn(const ActionInfo& info, const std::function<bool(const Glance&)>& is_on) {
    for (int i = 0; i < 2; ++i) {
      then([this, is_on](const Glance& g) { was_on_ = is_on(g); });
      tap(info.key);
      until(std::string(info.name) + " turns",
            [this, is_on](const Glance& g) { return is_on(g) != was_on_; });
    }
  }
  void add_pause(const ActionInfo& info);
  void add_step(const ActionInfo& info);
  void add_reset(const ActionInfo& info);
  void add_style(const ActionInfo& info, std::size_t index);
  void add_neighbours(const ActionInfo& info, std::size_t from, std::size_t to);
  void add_walkers(const ActionInfo& info);
  void add_record(const ActionInfo& info);
  void add_screenshot(const ActionInfo& info);
  void add_camera(const ActionInfo& info);
  void add_modal(const ActionInfo& info, const std::function<bool(const Glance&)>& is_open);
  bool add_flag(const ActionInfo& info);

  std::vector<std::string> styles_;
  bool was_on_ = false;
  std::int64_t tick_ = 0;
  double yaw_rad_ = 0.0;
  int frames_left_ = 0;
};

void ActionScript::add_pause(const ActionInfo& info) {
  tap(info.key);
  until("it pauses", [](const Glance& g) { return g.pace == 0.0; });
  wait(3);
  then([this](const Glance& g) { tick_ = g.session.tick; });
  wait(3);
  then([this](const Glance& g) { EXPECT_EQ(g.session.tick, tick_); });
  tap(info.key);
  until("it goes on", [this](const Glance& g) { return g.session.tick > tick_ && g.pace == 1.0; });
}

void ActionScript::add_step(const ActionInfo& info) {
  tap(info.key);  // pauses first
  until("it stands still", [](const Glance& g) { return g.pace == 0.0; });
  wait(3);
  then([this](const Glance& g) { tick_ = g.session.tick; });
  tap(info.key);
  until("one tick is run", [this](const Glance& g) { return g.session.tick == tick_ + 1; });
  wait(3);
  then([this](const Glance& g) { EXPECT_EQ(g.session.tick, tick_ + 1); });
  tap(SDLK_SPACE);
  until("it goes on", [this](const Glance& g) { return g.session.tick > tick_ + 1; });
}

void ActionScript::add_reset(const ActionInfo& info) {
  press(SDLK_w);
  until("they walk", [](const Glance& g) { return forward_m(g) > 0.3; });
  release(SDLK_w);
  tap(info.key);
  until("they stand at the start", [](const Glance& g) { return std::abs(forward_m(g)) < 0.02; });
}

void ActionScript::add_style(const ActionInfo& info, std::size_t index) {
  tap(info.key);
  if (index >= styles_.size()) return;  // there are not so many: nothing happens
  until("all walk in style " + styles_[index], [this, index](const Glance& g) {
    for (int i = 0; i < g.session.walker_count; ++i)
      if (style_of(g, i) != styles_[index]) return false;
    return true;
  });
}

void ActionScript::add_neighbours(const ActionInfo& info, std::size_t from, std::size_t to) {
  tap(static_cast<SDL_Keycode>(SDLK_1 + static_cast<int>(from)));
  until("a first style", [this, from](const Glance& g) { return style_of(g, 0) == styles_[from]; });
  tap(info.key);
  until("its neighbour", [this, to](const Glance& g) { return style_of(g, 3) == styles_[to]; });
}

void ActionScript::add_walkers(const ActionInfo& info) {
  for (const int walker : {0, 1, 2, 3, -1}) {
    tap(info.key);
    until("the next one is chosen", [walker](const Glance& g) { return g.ui.walker == walker; });
  }
}

void ActionScript::add_record(const ActionInfo& info) {
  tap(info.key);
  until("it records", [](const Glance& g) { return !g.recording.empty() && g.session.tick > 20; });
  then([](const Glance& g) { EXPECT_TRUE(g.recording.starts_with("gaitpad-")) << g.recording; });
  tap(info.key);
  until("it goes on unrecorded", [](const Glance& g) { return g.recording.empty(); });
  until("the new session runs", [](const Glance& g) { return g.session.tick > 0; });
}

void ActionScript::add_screenshot(const ActionInfo& info) {
  tap(info.key);
  until("a picture is there", [](const Glance& g) { return says(g, ".png"); });
}

void ActionScript::add_camera(const ActionInfo& info) {
  then([this](const Glance& g) { yaw_rad_ = g.camera.yaw_rad; });
  drag(SDL_BUTTON_LEFT, 600, 400, 700, 380);
  until("it turns",
        [this](const Glance& g) { return std::abs(g.camera.yaw_rad - yaw_rad_) > 0.3; });
  tap(info.key);
  until("it is back", [this](const Glance& g) { return g.camera.yaw_rad == yaw_rad_; });
}

void ActionScript::add_modal(const ActionInfo& info,
                             const std::function<bool(const Glance&)>& is_open) {
  tap(info.key);
  until(std::string(info.name) + " is open", is_open);
  tap(SDLK_ESCAPE);
  until(std::string(info.name) + " is closed", [is_open](const Glance& g) { return !is_open(g); });
  until("the session runs", [](const Glance& g) { return g.session.tick > 0; });
}

// Those that are on or off.
bool ActionScript::add_flag(const ActionInfo& info) {
  if (info.action >= Action::panel_pad && info.action <= Action::panel_loop) {
    const auto panel =
        static_cast<std::size_t>(info.action) - static_cast<std::size_t>(Action::panel_pad);
    turn(info, [panel](const Glance& g) { return g.ui.is_open[panel]; });
    return true;
  }
  switch (info.action) {
    case Action::slow_motion:
      turn(info, [](const Glance& g) { return g.pace == 0.25; });
      return true;
    case Action::follow:
      turn(info, [](const Glance& g) { return g.camera.is_following; });
      return true;
    case Action::theme:
      turn(info, [](const Glance& g) { return g.ui.theme == ThemeName::light; });
      return true;
    case Action::trails:
      turn(info, [](const Glance& g) { return g.ui.has_trails; });
      return true;
    case Action::source:
      turn(info, [](const Glance& g) { return g.ui.has_source; });
      return true;
    default:
      return false;
  }
}

void ActionScript::add(const ActionInfo& info) {
  if (add_flag(info)) return;
  if (info.action >= Action::style_1 && info.action <= Action::style_9) {
    return add_style(
        info, static_cast<std::size_t>(info.action) - static_cast<std::size_t>(Action::style_1));
  }
  switch (info.action) {
    case Action::pause:
      return add_pause(info);
    case Action::step:
      return add_step(info);
    case Action::reset:
      return add_reset(info);
    case Action::next_style:
      return add_neighbours(info, 6, 7);
    case Action::previous_style:
      return add_neighbours(info, 0, styles_.size() - 1);  // before the first one the last
    case Action::next_terrain:
      tap(info.key);
      until("another ground", [](const Glance& g) { return g.cast.terrain->name == "rough"; });
      return until("the session runs", [](const Glance& g) { return g.session.tick > 0; });
    case Action::next_walker:
      return add_walkers(info);
    case Action::record:
      return add_record(info);
    case Action::screenshot:
      return add_screenshot(info);
    case Action::open_file:
      return add_modal(info, [](const Glance& g) { return g.is_browsing; });
    case Action::calibrate:
      return add_modal(info, [](const Glance& g) { return g.is_calibrating; });
    case Action::reset_camera:
      return add_camera(info);
    case Action::help:
    case Action::back:
      tap(SDLK_F1);
      until("help is open", [](const Glance& g) { return g.ui.is_help_open; });
      tap(info.key);
      return until("help is closed", [](const Glance& g) { return !g.ui.is_help_open; });
    case Action::fullscreen:  // of a window in memory it changes nothing to be seen
      tap(info.key);
      return tap(info.key);
    default:
      ADD_FAILURE() << "nobody looks at what \"" << info.name << "\" does";
  }
}

TEST_F(Window, EveryActionsKeyDoesWhatTheTableSays) {
  ActionScript script(options_);
  for (const ActionInfo& info : actions())
    if (info.action != Action::quit) script.add(info);
  for (const ActionInfo& info : actions()) {
    if (info.action == Action::quit) script.press(info.key);  // the last step
  }
  run(script);
  EXPECT_EQ(files(".png").size(), 1u);
  ASSERT_EQ(files(".hid").size(), 1u);
  SessionSpec replayed = options_.session;
  replayed.replay.trace = files(".hid").front();
  const auto again = replay(replayed);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_GT(again->summary.ticks, 20);
}

TEST_F(Window, QuitEndsItAtOnce) {
  for (const ActionInfo& info : actions()) {
    if (info.action != Action::quit) continue;
    std::int64_t frames = 0;
    options_.frames = 500;
    options_.script = [&](const Glance& g) {
      frames = g.frame;
      if (g.frame != 3) return;
      SDL_Event event = {};
      event.type = SDL_KEYDOWN;
      event.key.keysym.sym = info.key;
      SDL_PushEvent(&event);
    };
    const auto result = run_window(options_);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->frames, 4);
    EXPECT_EQ(frames, 3);
  }
}

TEST_F(Window, EveryPanelOpensAndClosesByTheMouse) {
  Script script;
  options_.are_panels_given = true;
  for (std::size_t i = 0; i < kPanels; ++i) {
    const std::string name(kPanelNames[i]);
    const auto is_open = [i](const Glance& g) { return g.ui.is_open[i]; };
    script.click("panel " + name);
    script.until(name + " is open", is_open);
    script.until(name + " is there",
                 [name](const Glance&) { return Script::find("area " + name); });
    script.click("close " + name);
    script.until(name + " is closed", [is_open](const Glance& g) { return !is_open(g); });
  }
  run(script);
}

TEST_F(Window, TheMouseTurnsMovesAndNearsTheCamera) {
  Script script;
  Camera first;
  script.until("it is drawn", [](const Glance& g) { return g.frame > 2; });
  script.then([&](const Glance& g) { first = g.camera; });
  script.drag(SDL_BUTTON_LEFT, 600, 400, 650, 440);
  script.until("it orbits", [&](const Glance& g) {
    return g.camera.yaw_rad != first.yaw_rad && g.camera.pitch_rad > first.pitch_rad;
  });
  SDL_Event wheel = {};
  wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.y = 3;
  script.push(wheel);
  script.until("it nears", [&](const Glance& g) {
    return std::abs(g.camera.distance_m / first.distance_m - 0.9 * 0.9 * 0.9) < 1e-9;
  });
  script.drag(SDL_BUTTON_MIDDLE, 600, 400, 640, 400);
  script.until("it stands aside", [](const Glance& g) { return !g.camera.is_following; });
  run(script);
}

TEST_F(Window, KeysWalkAndFocusLossMakesTheStickNeutral) {
  Script script;
  script.press(SDLK_UP);
  script.press(SDLK_d);
  script.until("the stick is pushed", [](const Glance& g) {
    return g.session.stick.left.y > 0.5 && g.session.stick.left.x > 0.3;
  });
  script.window_event(SDL_WINDOWEVENT_FOCUS_LOST);
  script.until("the stick is neutral",
               [](const Glance& g) { return g.session.stick.left == vec2(0.0); });
  script.wait(5);
  script.then([](const Glance& g) { EXPECT_EQ(g.session.stick.left, vec2(0.0)); });
  run(script);
}

TEST_F(Window, ASessionAndItsRecordingAreTheSamePoses) {
  options_.session.live.record = (folder_ / "session.hid").string();
  options_.are_panels_given = true;
  options_.panels = {Panel::control};
  Script script;
  script.press(SDLK_w);
  script.until("they walk", [](const Glance& g) { return forward_m(g) > 0.5; });
  script.tap(SDLK_TAB);  // the first one alone
  script.tap(SDLK_4);
  script.until("it limps", [](const Glance& g) { return style_of(g, 0) == "limp_left"; });
  script.click("slider flight_left", 0.8f);
  script.until("it lifts the left foot", [](const Glance& g) {
    return g.session.walkers[0].overrides.is_set[static_cast<int>(GaitKey::flight_left)];
  });
  script.tap(SDLK_COMMA);
  script.wait(5);
  script.tap(SDLK_PERIOD);
  script.tap(SDLK_PERIOD);
  script.tap(SDLK_SPACE);
  script.press(SDLK_a);
  script.wait(10);
  script.release(SDLK_w);
  script.release(SDLK_a);
  script.tap(SDLK_BACKSPACE);
  script.until("they are back", [](const Glance& g) { return std::abs(forward_m(g)) < 0.02; });
  script.press(SDLK_UP);
  script.wait(10);
  const WindowResult result = run(script);
  ASSERT_EQ(result.summary.walkers.size(), 4u);
  SessionSpec replayed = options_.session;
  replayed.replay.trace = options_.session.live.record;
  const auto again = replay(replayed);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_GT(result.summary.ticks, 240);
  EXPECT_EQ(result.summary.ticks, again->summary.ticks);
  EXPECT_EQ(result.summary.pose_hash, again->summary.pose_hash);
  EXPECT_EQ(result.summary.bad_commands, 0);
}

TEST_F(Window, FramesAreCountedAndEndedFromOutside) {
  options_.frames = 7;
  auto result = run_window(options_);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->frames, 7);
  options_.frames = 0;
  int asked = 0;
  options_.is_ended_from_outside = [&] { return ++asked == 4; };
  result = run_window(options_);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->frames, 4);
}

TEST_F(Window, WhatCannotBeLoadedIsOneSentenceBeforeAnythingIsDrawn) {
  options_.script = [](const Glance&) { ADD_FAILURE() << "it was drawn"; };
  options_.session.walk.motion = (folder_ / "none.bvh").string();
  auto result = run_window(options_);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("none.bvh"), std::string::npos);
  options_.session.walk.motion.clear();
  options_.session.replay.trace = make("damaged.hid", "R: 3 05 01\n");
  result = run_window(options_);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("damaged.hid:1"), std::string::npos);
}

TEST_F(Window, LayoutIsRememberedButNotWhatWasAskedForOnce) {
  options_.layout_file = (folder_ / "window.toml").string();
  Script first;
  first.tap(SDLK_l);
  first.until("it is light", [](const Glance& g) { return g.ui.theme == ThemeName::light; });
  first.click("panel loop");
  first.until("loop is open", [](const Glance& g) { return g.ui.is_open[5]; });
  run(first);
  options_.are_panels_given = true;
  options_.theme = ThemeName::dark;
  Script once;
  once.then([](const Glance& g) { EXPECT_EQ(g.ui.theme, ThemeName::dark); });
  run(once);
  options_.are_panels_given = false;
  options_.theme.reset();
  Script again;
  again.then([](const Glance& g) {
    EXPECT_EQ(g.ui.theme, ThemeName::light);
    EXPECT_TRUE(g.ui.is_open[5]);
  });
  run(again);
}

}  // namespace
}  // namespace gaitpad
