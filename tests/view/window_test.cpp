// A person at the window, for tests: what is pressed, clicked and waited for, one thing a frame.
// The window is in memory (SDL's offscreen driver).

#include "view/window.h"

#include <SDL2/SDL.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/config_files.h"
#include "gaitpad/replay.h"
#include "pads/calibration_store.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"
#include "view/surface.h"

namespace gaitpad {
namespace fs = std::filesystem;
using Glance = WindowGlance;
namespace {

class Script {
 public:
  using Glance = WindowGlance;

  void until(const std::string& what, std::function<bool(const Glance&)> is_so) {
    steps_.push_back({what, std::move(is_so)});
  }
  void then(std::function<void(const Glance&)> act) {
    steps_.push_back({"", [act](const Glance& glance) {
                        act(glance);
                        return true;
                      }});
  }
  void wait(int frames) {
    for (int i = 0; i < frames; ++i) then([](const Glance&) {});
  }
  void push(const SDL_Event& event) {
    then([event](const Glance&) {
      SDL_Event copy = event;
      SDL_PushEvent(&copy);
    });
  }

  void press(SDL_Keycode code) { push(key(code, SDL_KEYDOWN)); }
  void release(SDL_Keycode code) { push(key(code, SDL_KEYUP)); }
  void tap(SDL_Keycode code) {
    press(code);
    release(code);
  }
  void tap_with_ctrl(SDL_Keycode code) {
    SDL_Event event = key(code, SDL_KEYDOWN);
    event.key.keysym.mod = KMOD_LCTRL;
    push(event);
    event.type = SDL_KEYUP;
    push(event);
  }
  void type(const std::string& text) {
    SDL_Event event = {};
    event.type = SDL_TEXTINPUT;
    text.copy(event.text.text, sizeof event.text.text - 1);
    push(event);
  }
  void drop(const std::string& file) {
    then([file](const Glance&) {
      SDL_Event event = {};
      event.type = SDL_DROPFILE;
      event.drop.file = SDL_strdup(file.c_str());
      SDL_PushEvent(&event);
    });
  }
  void window_event(Uint8 what) {
    SDL_Event event = {};
    event.type = SDL_WINDOWEVENT;
    event.window.event = what;
    push(event);
  }

  void point(float x, float y) {
    then([x, y](const Glance&) { move_to(x, y); });
  }
  void mouse(Uint32 type, Uint8 button, int x, int y) {
    SDL_Event event = {};
    event.type = type;
    event.button.button = button;
    event.button.x = x;
    event.button.y = y;
    push(event);
  }
  void drag(Uint8 button, int x, int y, int to_x, int to_y) {
    point(static_cast<float>(x), static_cast<float>(y));
    wait(1);
    mouse(SDL_MOUSEBUTTONDOWN, button, x, y);
    point(static_cast<float>(to_x), static_cast<float>(to_y));
    mouse(SDL_MOUSEBUTTONUP, button, to_x, to_y);
  }
  // Of ui_items(), once it is there; at `share` of its width.
  void click(const std::string& item, float share = 0.5f) {
    until("there is \"" + item + "\" to click", [this, item, share](const Glance&) {
      const UiItem* found = find(item);
      if (found == nullptr) return false;
      at_ = {found->min.x + (found->max.x - found->min.x) * share,
             (found->min.y + found->max.y) / 2};
      move_to(at_.x, at_.y);
      return true;
    });
    wait(1);
    for (const Uint32 type : {SDL_MOUSEBUTTONDOWN, SDL_MOUSEBUTTONUP}) {
      then([this, type](const Glance&) {
        SDL_Event event = {};
        event.type = type;
        event.button.button = SDL_BUTTON_LEFT;
        event.button.x = static_cast<int>(at_.x);
        event.button.y = static_cast<int>(at_.y);
        SDL_PushEvent(&event);
      });
    }
    wait(1);
  }
  static const UiItem* find(const std::string& name) {
    for (const UiItem& item : ui_items())
      if (item.name == name) return &item;
    return nullptr;
  }

  // What run_window() calls; quits behind the last step, and where one takes too long.
  void operator()(const Glance& glance) {
    if (next_ == steps_.size()) return quit();
    const auto now = std::chrono::steady_clock::now();
    if (next_ != waiting_for_) since_ = now;
    waiting_for_ = next_;
    if (steps_[next_].act(glance)) {
      ++next_;
    } else if (now - since_ > std::chrono::seconds(20)) {
      std::string said;
      for (const std::string& message : glance.messages) said += "\n  " + message;
      ADD_FAILURE() << "never: " << steps_[next_].what << said;
      next_ = steps_.size();
    }
  }
  bool is_done() const { return next_ == steps_.size(); }

 private:
  struct Step {
    std::string what;
    std::function<bool(const Glance&)> act;
  };
  static SDL_Event key(SDL_Keycode code, Uint32 type) {
    SDL_Event event = {};
    event.type = type;
    event.key.keysym.sym = code;
    event.key.keysym.scancode = SDL_GetScancodeFromKey(code);
    event.key.state = type == SDL_KEYDOWN ? SDL_PRESSED : SDL_RELEASED;
    return event;
  }
  static void move_to(float x, float y) {
    SDL_Event event = {};
    event.type = SDL_MOUSEMOTION;
    event.motion.x = static_cast<int>(x);
    event.motion.y = static_cast<int>(y);
    SDL_PushEvent(&event);
  }
  static void quit() {
    SDL_Event event = {};
    event.type = SDL_QUIT;
    SDL_PushEvent(&event);
  }

  std::vector<Step> steps_;
  std::size_t next_ = 0, waiting_for_ = ~std::size_t{0};
  std::chrono::steady_clock::time_point since_;
  ImVec2 at_{0, 0};
};

// Four characters in a window of 1280 x 720, in a folder of their own; no pad of the machine.
class Window : public testing::Test {
 protected:
  void SetUp() override {
    SurfaceOptions surface;
    surface.is_hidden = true;
    const auto opened = WindowSurface::open(surface);
    if (!opened) GTEST_SKIP() << opened.error().message;
    ::setenv("SDL_VIDEODRIVER", "offscreen", 1);
    std::filesystem::current_path(folder_);
    options_.session.config_folders = {kSourceFolder + "/config"};
    options_.session.walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
    options_.session.pad.wish.pad = "no pad of this machine";
    options_.scale = 1.0;
  }
  void TearDown() override {
    std::filesystem::current_path(std::filesystem::temp_directory_path());
    ::unsetenv("SDL_VIDEODRIVER");
  }

  // Done by the script to its end.
  WindowResult run(Script& script) {
    options_.script = std::ref(script);
    const WindowResult result = value_of(run_window(options_));
    EXPECT_TRUE(script.is_done());
    return result;
  }
  std::string make(const std::string& name, const std::string& text) {
    return own_.write(name, text);
  }
  std::vector<std::string> files(const std::string& ending) const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (entry.path().extension() == ending) all.push_back(entry.path().string());
    return all;
  }

  OwnFolder own_;
  const std::filesystem::path folder_ = own_.path;
  const Environment config_home_{"XDG_CONFIG_HOME", own_.at("config").c_str()};
  const std::string round_ = kSourceFolder + "/config/traces/round.hid";
  WindowOptions options_;
};

inline bool says(const WindowGlance& glance, const std::string& words) {
  for (const std::string& message : glance.messages)
    if (message.find(words) != std::string::npos) return true;
  return false;
}
inline const std::string& style_of(const WindowGlance& glance, int walker) {
  const WalkerFrame& frame = glance.session.walkers[static_cast<std::size_t>(walker)];
  return glance.cast.styles[static_cast<std::size_t>(frame.style_index)];
}
inline double forward_m(const WindowGlance& glance) {
  return glance.session.walkers[0].walk.pelvis_m.z;
}

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
    case Action::undo:  // a style that another key has chosen
      tap(SDLK_1);
      wait(3);
      tap(SDLK_2);
      until("the second style",
            [](const Glance& g) { return g.session.walkers[0].style_index == 1; });
      tap_with_ctrl(SDLK_z);
      return until("the first again",
                   [](const Glance& g) { return g.session.walkers[0].style_index == 0; });
    case Action::redo:
      tap_with_ctrl(SDLK_y);
      return until("the second again",
                   [](const Glance& g) { return g.session.walkers[0].style_index == 1; });
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

TEST_F(Window, PicturesThatAreCutOffAreNotWritten) {
  options_.is_hidden = true;
  options_.frames = 100;
  options_.screenshot = own_.at("still.png");
  int asked = 0;
  options_.is_ended_from_outside = [&] { return ++asked == 4; };
  const auto result = run_window(options_);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->is_cut_off);
  EXPECT_EQ(result->frames, 3);
  EXPECT_FALSE(fs::exists(options_.screenshot));
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

// The window and files: opened, dropped, typed, played, calibrated, and pictures made of it.

// A motion file: the bundled recording's walk, as replay exports it.
std::string exported_walk(const Window&, const fs::path& folder, const SessionSpec& session,
                          const std::string& trace) {
  SessionSpec spec;
  spec.config_folders = session.config_folders;
  spec.replay.trace = trace;
  spec.replay.out = (folder / "out").string();
  spec.replay.fps = 60;
  value_of(replay(spec));
  return spec.replay.out + "/pose.bvh";
}

class WindowFiles : public Window {};

TEST_F(WindowFiles, DroppedFilesChangeTheSessionAndDamagedOnesDoNot) {
  const std::string walk = exported_walk(*this, folder_, options_.session, round_);
  const std::string damaged = make("damaged.bvh", text_in(walk).substr(0, 3000));
  const std::string style = make("styles/own.toml", "fatigue = 0.75\n");
  const std::string bad_style = make("styles/bad.toml", "fatigue = \"very\"\n");
  const std::string build = make("characters/small.toml", "scale = 0.5\n");
  Script script;
  script.drop(walk);
  script.until("it walks by the motion",
               [](const Glance& g) { return g.cast.motion != "procedural"; });
  for (const std::string& bad : {damaged, bad_style, make("notes.txt", "x"), folder_.string(),
                                 make("cut.hid", "R: 3 05\n"), (folder_ / "none.bvh").string()}) {
    script.drop(bad);
    script.until("it tells of " + bad, [bad](const Glance& g) { return says(g, bad); });
    script.then([](const Glance& g) {
      EXPECT_NE(g.cast.motion, "procedural");
      EXPECT_FALSE(g.is_playback);
    });
    script.until("it runs on", [](const Glance& g) { return g.session.tick > 0; });
  }
  script.drop(style);
  script.until("all are tired", [](const Glance& g) {
    return g.cast.members.size() == 1 && g.cast.members[0].style == "own";
  });
  script.drop(build);
  script.until("it is small", [](const Glance& g) { return g.cast.members[0].character != ""; });
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.then([](const Glance& g) {
    EXPECT_NEAR(g.cast.members[0].model->leg_length_m,
                0.5 * g.cast.members[0].model->source_leg_length_m, 1e-3);
  });
  run(script);
}

TEST_F(WindowFiles, AKeyTurnsToTheNextGroundAndADroppedOneIsWalkedOn) {
  const std::string ramp =
      make("terrain/ramp.toml", "[[section]]\nkind = \"slope\"\nlength_m = 5\ngrade = 0.1\n");
  const std::string bad = make("terrain/bad.toml", "[[section]]\nkind = \"hole\"\n");
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.then([](const Glance& g) { EXPECT_TRUE(is_flat(*g.cast.terrain)); });
  script.tap(SDLK_m);
  script.until("it has turned on", [](const Glance& g) { return g.cast.terrain->name == "rough"; });
  script.drop(bad);
  script.until("it tells of it", [bad](const Glance& g) { return says(g, "bad.toml:2"); });
  script.drop(ramp);
  script.until("the ramp", [](const Glance& g) { return g.cast.terrain->name == "ramp"; });
  script.until("it runs on", [](const Glance& g) { return g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, ADroppedRecordingPlaysAndEscapeGoesBack) {
  Script script;
  script.drop(round_);
  script.until("it plays", [](const Glance& g) { return g.is_playback && g.session.tick > 20; });
  script.then([](const Glance& g) { EXPECT_EQ(g.cast.members.size(), 4u); });
  script.tap(SDLK_ESCAPE);
  script.until("it is live again", [](const Glance& g) { return !g.is_playback; });
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, APlaybackIsPausedSteppedSoughtAndTakesNoStyles) {
  options_.session.replay.trace = round_;
  Script script;
  std::int64_t tick = 0;
  script.until("it plays", [](const Glance& g) { return g.session.tick > 10; });
  script.tap(SDLK_SPACE);
  script.until("it stands", [](const Glance& g) { return g.pace == 0.0; });
  script.wait(2);
  script.then([&](const Glance& g) { tick = g.session.tick; });
  script.tap(SDLK_PERIOD);
  script.until("one tick on", [&](const Glance& g) { return g.session.tick == tick + 1; });
  script.click("timeline", 0.5f);
  script.until("half-way", [](const Glance& g) {  // of 4800 ticks
    return std::abs(static_cast<double>(g.session.tick) - 2400.0) < 120.0;
  });
  script.tap(SDLK_3);
  script.until("it says why not", [](const Glance& g) { return says(g, "read-only"); });
  script.tap(SDLK_BACKSPACE);
  script.until("it is at the beginning", [](const Glance& g) { return g.session.tick == 0; });
  script.tap(SDLK_F9);
  script.until("it records nothing", [](const Glance& g) { return says(g, "read-only"); });
  run(script);
  EXPECT_TRUE(files(".hid").empty());
}

TEST_F(WindowFiles, TheBrowserOpensWhatIsTypedOrClicked) {
  make("walks/limp.hid", text_in(round_));
  make("walks/other.txt", "x");
  Script script;
  script.tap(SDLK_o);
  script.until("it is open", [](const Glance& g) { return g.is_browsing; });
  script.click("browser filter Recordings");
  script.click("browser entry walks");
  script.until("the folder is open", [](const Glance&) {
    return Script::find("browser entry limp.hid") && !Script::find("browser entry other.txt");
  });
  script.click("browser entry limp.hid");
  script.click("browser open");
  script.until("it plays", [](const Glance& g) { return g.is_playback && !g.is_browsing; });
  script.tap(SDLK_o);
  script.click("browser recent 0");
  script.until("it plays again", [](const Glance& g) { return g.is_playback && !g.is_browsing; });
  script.tap(SDLK_o);
  script.click("browser path");
  script.type("none.bvh");
  script.tap(SDLK_RETURN);
  script.wait(2);
  script.then([](const Glance& g) { EXPECT_TRUE(g.is_browsing); });
  script.click("browser up");
  script.click("browser cancel");
  script.until("it is closed", [](const Glance& g) { return !g.is_browsing; });
  options_.recent_file = (folder_ / "recent").string();
  run(script);
  EXPECT_EQ(text_in(options_.recent_file), (folder_ / "walks/limp.hid").string() + "\n");
}

// A pad with one stick that is let go four times from all sides, at once and often enough to be
// measured: sooner than any thumb.
std::string thumb_trace() {
  std::string text =
      "R: 54 05 01 09 05 a1 01 15 00 26 ff 00 75 08 95 04 09 30 09 31 09 32 09 35 81 02 15 00 25 "
      "07 "
      "75 04 95 01 09 39 81 42 05 09 15 00 25 01 75 01 95 0c 19 01 29 0c 81 02 c0\n"
      "N: Thumb Pad\nI: 3 1209 0002\n";
  int ms = 0;
  const auto report = [&](int x, int y) {
    char line[80];
    std::snprintf(line, sizeof line, "E: %06d.%06d 6 %02x %02x 80 80 08 00\n", ms / 1000,
                  ms % 1000 * 1000, x, y);
    text += line;
    ms += 8;
  };
  for (int i = 0; i < 120; ++i) report(0x80 + i % 2, 0x80);
  constexpr std::array<std::array<int, 2>, 4> kSides = {
      {{0x80, 0}, {0xff, 0x80}, {0x80, 0xff}, {0, 0x80}}};
  for (const auto& side : kSides) {
    for (int i = 0; i < 25; ++i) report(side[0], side[1]);
    for (int i = 0; i < 100; ++i) report(0x80 + i % 2, 0x80);
  }
  return text;
}

TEST_F(WindowFiles, TheSelfTestNeedsThePadItselfAndTheSessionGoesOnWithoutIt) {
  options_.session.pad.wish.pad = make("thumb.hid", thumb_trace());
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.tap(SDLK_F8);
  script.until("it calibrates", [](const Glance& g) { return g.is_calibrating; });
  script.click("calibration test");
  script.until("it says why",
               [](const Glance& g) { return says(g, "the test needs the pad itself"); });
  script.until("it runs again",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
}

// The bytes of one report of six: X, Y, Z, Rz, two spare ones; for so many reports of 50 ms.
void add_reports(std::string& text, int& ms, const std::array<int, 6>& bytes, int count) {
  for (int i = 0; i < count; ++i, ms += 50) {
    char line[80];
    std::snprintf(line, sizeof line, "E: %06d.%06d 6", ms / 1000, ms % 1000 * 1000);
    text += line;
    for (const int byte : bytes) {
      std::snprintf(line, sizeof line, " %02x", byte);
      text += line;
    }
    text += "\n";
  }
}

// A person who pushes the left stick, which is Z and Rz on this pad, upside down.
std::string odd_pad_trace() {
  std::string text =
      "D: 0\nN: Odd Pad\nP: made/0\nI: 3 1209 0077\nR: 30 05 01 09 05 a1 01 15 00 26 ff 00 75 08 "
      "95 06 09 30 09 31 09 32 09 35 09 33 09 34 81 02 c0\n";
  constexpr std::array<int, 6> kRest = {0x80, 0x80, 0x80, 0x80, 0, 0};
  int ms = 0;
  for (const int moved : {3, 2}) {
    add_reports(text, ms, kRest, 30);
    std::array<int, 6> pushed = kRest;
    pushed[static_cast<std::size_t>(moved)] = 0xff;
    add_reports(text, ms, pushed, 12);
  }
  add_reports(text, ms, kRest, 60);
  return text;
}

TEST_F(WindowFiles, ControlsThatAreWrongAreAskedForAndKept) {
  options_.session.pad.wish.pad = make("odd.hid", odd_pad_trace());
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.tap(SDLK_F8);
  script.click("calibration map");
  script.click("map keep");  // is there once the left stick is known
  script.until("it is kept", [](const Glance& g) { return says(g, "2 controls are kept in"); });
  script.until("it runs again",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
  const std::string kept = text_in(folder_ / "config/gaitpad/gamecontrollerdb.txt");
  for (const char* part : {"Odd Pad", ",leftx:a2,", ",lefty:a5~,"})
    EXPECT_NE(kept.find(part), std::string::npos) << kept;
}

TEST_F(WindowFiles, ACalibrationIsMeasuredShownSavedAndInForce) {
  options_.session.pad.wish.pad = make("thumb.hid", thumb_trace());
  options_.calibration_folder = (folder_ / "config/gaitpad/calibration").string();
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.tap(SDLK_F8);
  script.until("it calibrates", [](const Glance& g) { return g.is_calibrating; });
  script.click("calibration repeat");
  script.until("the recording is over", [](const Glance& g) { return says(g, "has ended"); });
  script.until("the result is there",
               [](const Glance&) { return Script::find("calibration save"); });
  script.click("calibration save");
  script.until("it is kept", [](const Glance& g) { return says(g, "is saved in"); });
  script.until("it runs again",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
  const auto found = fs::directory_iterator(options_.calibration_folder);
  ASSERT_NE(found, fs::directory_iterator());
  const auto file = load_calibration_file(found->path().string());
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->name, "Thumb Pad");
  // 0x80 and 0x81 by turns, in fractions of half of 0 .. 255.
  EXPECT_NEAR(file->calibration.left.x.centre, (128.5 - 127.5) / 127.5, 0.004);
}

TEST_F(WindowFiles, ACalibrationIsGivenUp) {
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 20; });
  script.tap(SDLK_F8);
  script.until("it waits for a pad", [](const Glance& g) { return g.is_calibrating; });
  script.drop(round_);
  script.until("files wait", [](const Glance& g) { return says(g, "before opening a file"); });
  script.click("calibration give up");
  script.until("it walks on",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, ASavedStyleKeepsItsNameAndIsUsedAtOnceAndInTheNextSession) {
  options_.are_panels_given = true;
  options_.panels = {Panel::style};
  Script script;
  script.tap(SDLK_TAB);
  script.until("the first one is chosen", [](const Glance& g) { return g.ui.walker == 0; });
  script.click("style slider fatigue", 0.75f);
  script.until("it is tired", [](const Glance& g) {
    return g.session.walkers[0].style.fatigue > 0.5 && g.session.walkers[1].style.fatigue == 0.0;
  });
  script.click("style name");
  script.type("my walk");
  script.click("save style");
  script.until("it is kept", [](const Glance& g) { return says(g, "my walk.toml"); });
  script.until("its character walks in it",
               [](const Glance& g) { return style_of(g, 0) == "my walk"; });
  script.tap(SDLK_TAB);
  script.until("the second one is chosen", [](const Glance& g) { return g.ui.walker == 1; });
  script.tap(SDLK_b);  // before the first style the last one: the new
  script.wait(2);
  script.tap(SDLK_b);
  script.until("so does another", [](const Glance& g) {
    return style_of(g, 1) == "my walk" && g.session.walkers[1].style.fatigue > 0.5;
  });
  script.drop(make("x.toml", "fatigue = 0\nhip_sway = 1\n"));  // another session
  script.until("it is known",
               [](const Glance& g) { return std::ranges::count(g.cast.styles, "my walk") == 1; });
  const WindowResult result = run(script);
  EXPECT_EQ(result.summary.bad_commands, 0);
}

TEST_F(WindowFiles, PicturesOfATraceAreTheSameEveryTime) {
  std::array<std::string, 2> pictures;
  std::array<std::uint64_t, 2> hashes{};
  options_.session.replay.trace = round_;
  options_.is_hidden = true;
  options_.frames = 45;
  for (std::size_t i = 0; i < 2; ++i) {
    options_.screenshot = (folder_ / (std::to_string(i) + ".png")).string();
    const auto result = run_window(options_);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->frames, 45);
    pictures[i] = text_in(options_.screenshot);
    hashes[i] = result->summary.pose_hash;
    EXPECT_EQ(result->summary.ticks, 45 * 240 / 60);
  }
  EXPECT_GT(pictures[0].size(), 50'000u);
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(WindowFiles, ALiveSessionIsPicturedByHandTheSameEveryTime) {
  std::array<std::string, 2> pictures;
  options_.is_hidden = true;
  options_.are_panels_given = true;
  options_.panels = {Panel::pad, Panel::loop};
  options_.frames = 30;
  for (std::string& picture : pictures) {
    options_.screenshot = (folder_ / "live.png").string();
    const auto result = run_window(options_);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->summary.ticks, 30 * 240 / 60);
    picture = text_in(options_.screenshot);
  }
  EXPECT_FALSE(pictures[0].empty());
  EXPECT_EQ(pictures[0], pictures[1]);
}

TEST_F(WindowFiles, APictureThatCannotBeWrittenIsAnError) {
  options_.screenshot = (folder_ / "none/x.png/y.png").string();
  make("none/x.png", "a file");
  options_.is_hidden = true;
  options_.frames = 2;
  const auto result = run_window(options_);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("x.png"), std::string::npos);
}

}  // namespace

}  // namespace gaitpad
