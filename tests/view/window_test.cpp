// Tests the window by a script of presses, clicks and waits, one step a frame. The window is in
// memory (SDL's offscreen driver).

#include "view/window.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gaitpad/config_files.h"
#include "gaitpad/replay.h"
#include "pads/calibration_store.h"
#include "scene/mannequin.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"
#include "view/surface.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;
using Glance = WindowGlance;

class Script {
 public:
  void until(const std::string& what, std::function<bool(const Glance&)> is_so) {
    steps_.push_back({what, std::move(is_so)});
  }
  void then(const std::function<void(const Glance&)>& act) {
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
  void tap(SDL_Keycode code, Uint16 with = KMOD_NONE) {
    then([code, with](const Glance&) {
      for (const Uint32 type : {SDL_KEYDOWN, SDL_KEYUP}) {
        SDL_Event event = key(code, type);
        event.key.keysym.mod = with;
        SDL_PushEvent(&event);
      }
    });
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
  // Clicks an item of ui_items() when it exists, at the fraction `share` of its width.
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
  // Moves the focus to the item by Tab.
  void reach(const std::string& item) {
    until("\"" + item + "\" is reached", [item](const Glance& glance) {
      if (glance.ui.memory.focus == item) return true;
      SDL_Event event = key(SDLK_TAB, SDL_KEYDOWN);
      SDL_PushEvent(&event);
      return false;
    });
  }
  static const UiItem* find(const std::string& name) {
    for (const UiItem& item : ui_items())
      if (item.name == name) return &item;
    return nullptr;
  }

  // Called by run_window(); quits after the last step, and if a step takes too long.
  void operator()(const Glance& glance) {
    if (next_ == steps_.size()) return quit();
    const auto now = std::chrono::steady_clock::now();
    if (next_ != waiting_for_) since_ = now;
    waiting_for_ = next_;
    while (next_ < steps_.size() && steps_[next_].act(glance)) {
      if (steps_[next_++].what.empty()) return;  // a wait whose condition is met takes no frame
    }
    if (next_ == waiting_for_ && now - since_ > std::chrono::seconds(120)) {
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

// Four characters in a window of 960 x 540, in a temporary folder, without the machine's pads.
class Window : public testing::Test {
 protected:
  void SetUp() override {
    SurfaceOptions surface;
    surface.is_hidden = true;
    const auto opened = WindowSurface::open(surface);
    if (!opened) GTEST_SKIP() << opened.error().message;
    ::setenv("SDL_VIDEODRIVER", "offscreen", 1);
    fs::current_path(folder_);
    options_.session.config_folders = {kSourceFolder + "/config"};
    options_.session.walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
    options_.session.pad.selector.pad = "no pad of this machine";
    options_.scale = 1.0;
    options_.width = 960;  // a small window, because fewer pixels are drawn faster
    options_.height = 540;
  }
  void TearDown() override {
    fs::current_path(fs::temp_directory_path());
    ::unsetenv("SDL_VIDEODRIVER");
  }

  // Runs the window; the script must reach its end.
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
    for (const auto& entry : fs::directory_iterator(folder_))
      if (entry.path().extension() == ending) all.push_back(entry.path().string());
    return all;
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
  const Environment config_home_{"XDG_CONFIG_HOME", own_.at("config").c_str()};
  const std::string round_ = kSourceFolder + "/config/traces/round.hid";
  WindowOptions options_;
};

bool says(const Glance& glance, const std::string& words) {
  for (const std::string& message : glance.messages)
    if (message.find(words) != std::string::npos) return true;
  return false;
}
const std::string& style_of(const Glance& glance, int walker) {
  const WalkerFrame& frame = glance.session.walkers[static_cast<std::size_t>(walker)];
  return glance.cast.styles[static_cast<std::size_t>(frame.style_index)];
}
double forward_m(const Glance& glance) { return glance.session.walkers[0].walk.pelvis_m.z; }

bool runs(const Glance& glance) { return glance.session.tick > 0; }

// Presses the keys of actions; `pressed` holds the actions whose keys were pressed.
class ActionScript : public Script {
 public:
  using Condition = std::function<bool(const Glance&)>;
  void press_key_of(Action action) {
    pressed.insert(action);
    for (const Chord& chord : chords())
      if (chord.action == action && info_of(action).key == SDLK_UNKNOWN)
        return tap(chord.key, KMOD_LCTRL);
    tap(info_of(action).key);
  }
  void expect(Action action, const Condition& is_so) {
    press_key_of(action);
    until(std::string(info_of(action).name) + " does it", is_so);
  }
  // Switches a state and, by the same or another action, switches it back.
  void turn(Action action, Action back, const Condition& is_on) {
    for (const Action each : {action, back}) {
      then([this, is_on](const Glance& g) { was_on_ = is_on(g); });
      expect(each, [this, is_on](const Glance& g) { return is_on(g) != was_on_; });
    }
  }
  void turn(Action action, const Condition& is_on) { turn(action, action, is_on); }

  std::set<Action> pressed = {Action::quit};  // quit is tested in the next test

 private:
  bool was_on_ = false;
};

Action after(Action action, std::size_t places) {
  return static_cast<Action>(static_cast<std::size_t>(action) + places);
}

TEST_F(Window, EveryActionsKeyDoesWhatTheTableSays) {
  ActionScript script;
  std::int64_t tick = 0;
  double yaw_rad = 0.0;
  script.turn(Action::pause, [](const Glance& g) { return g.pace == 0.0; });
  script.expect(Action::step, [](const Glance& g) { return g.pace == 0.0; });  // pauses first
  script.wait(3);
  script.then([&](const Glance& g) { tick = g.session.tick; });
  script.expect(Action::step, [&](const Glance& g) { return g.session.tick == tick + 1; });
  script.wait(3);
  script.then([&](const Glance& g) { EXPECT_EQ(g.session.tick, tick + 1); });
  script.expect(Action::pause, [&](const Glance& g) { return g.session.tick > tick + 1; });
  script.turn(Action::slow_motion, [](const Glance& g) { return g.pace == 0.25; });
  script.press(SDLK_w);
  script.until("they walk", [](const Glance& g) { return forward_m(g) > 0.3; });
  script.release(SDLK_w);
  script.expect(Action::reset, [](const Glance& g) { return std::abs(forward_m(g)) < 0.02; });

  // The session's styles, then those of config/ by name.
  std::vector<std::string> styles = options_.session.walk.styles;
  for (const std::string& path : config_files(options_.session.config_folders, "styles")) {
    if (std::ranges::count(styles, config_name(path)) == 0) styles.push_back(config_name(path));
  }
  ASSERT_GE(styles.size(), 9u);
  const auto walk_in = [&styles](std::size_t index) {
    return [name = styles[index]](const Glance& g) {
      return style_of(g, 0) == name && style_of(g, 3) == name;
    };
  };
  for (std::size_t i = 0; i < 9; ++i) script.expect(after(Action::style_1, i), walk_in(i));
  script.expect(Action::previous_style, walk_in(7));
  script.expect(Action::next_style, walk_in(8));
  script.expect(Action::style_1, walk_in(0));
  script.expect(Action::previous_style,
                walk_in(styles.size() - 1));  // the last style, which precedes the first one
  script.expect(Action::undo, walk_in(0));
  script.expect(Action::redo, walk_in(styles.size() - 1));
  script.turn(Action::stick,
              [](const Glance& g) { return g.session.stick_means == StickMeans::points; });
  script.expect(Action::next_terrain,
                [](const Glance& g) { return g.cast.terrain->name == "rough" && runs(g); });
  for (const int walker : {0, 1, 2, 3, -1})
    script.expect(Action::next_walker, [=](const Glance& g) { return g.ui.walker == walker; });
  script.expect(Action::record, [](const Glance& g) {
    return g.recording.starts_with("gaitpad-") && g.session.tick > 20;
  });
  script.expect(Action::record, [](const Glance& g) { return g.recording.empty() && runs(g); });
  script.expect(Action::screenshot, [](const Glance& g) { return says(g, ".png"); });
  script.turn(Action::open_file, Action::back, [](const Glance& g) { return g.is_browsing; });
  script.turn(Action::calibrate, Action::back, [](const Glance& g) { return g.is_calibrating; });
  script.until("the session runs", runs);
  script.turn(Action::follow, [](const Glance& g) { return g.camera.is_following; });
  script.then([&](const Glance& g) { yaw_rad = g.camera.yaw_rad; });
  script.drag(SDL_BUTTON_LEFT, 500, 300, 600, 280);
  script.until("it turns",
               [&](const Glance& g) { return std::abs(g.camera.yaw_rad - yaw_rad) > 0.3; });
  script.expect(Action::reset_camera, [&](const Glance& g) { return g.camera.yaw_rad == yaw_rad; });
  script.turn(Action::theme, [](const Glance& g) { return g.ui.theme == ThemeName::light; });
  script.turn(Action::trails, [](const Glance& g) { return g.ui.has_trails; });
  script.turn(Action::source, [](const Glance& g) { return g.ui.has_source; });
  for (std::size_t i = 0; i < kPanels; ++i)
    script.turn(action_of(i), [i](const Glance& g) { return g.ui.is_open[i]; });
  script.turn(Action::navigate, Action::back,
              [](const Glance& g) { return !g.ui.memory.focus.empty(); });
  script.turn(Action::help, [](const Glance& g) { return g.ui.is_help_open; });
  script.turn(Action::help, Action::back, [](const Glance& g) { return g.ui.is_help_open; });
  // A window in memory shows no full screen, so the key is only pressed twice.
  for (int i = 0; i < 2; ++i) script.press_key_of(Action::fullscreen);
  run(script);
  for (const ActionInfo& info : actions())
    EXPECT_TRUE(script.pressed.contains(info.action))
        << "nobody looks at what it does: " << info.name;
  EXPECT_EQ(files(".png").size(), 1u);
  ASSERT_EQ(files(".hid").size(), 1u);
  SessionSpec replayed = options_.session;
  replayed.replay.trace = files(".hid").front();
  EXPECT_GT(value_of(replay(replayed)).summary.ticks, 20);
}

TEST_F(Window, EscapeClosesTheMenu) {
  Script script;
  script.until("it is drawn", [](const Glance& g) { return g.frame > 2; });
  script.click("view");
  script.until("the menu is open",
               [](const Glance&) { return Script::find("type larger") != nullptr; });
  script.tap(SDLK_ESCAPE);
  script.until("the menu is closed",
               [](const Glance&) { return Script::find("type larger") == nullptr; });
  run(script);
}

TEST_F(Window, QuitEndsItAtOnce) {
  options_.frames = 500;
  options_.script = [&](const Glance& g) {
    if (g.frame != 3) return;
    SDL_Event event = {};
    event.type = SDL_KEYDOWN;
    event.key.keysym.sym = info_of(Action::quit).key;
    SDL_PushEvent(&event);
  };
  EXPECT_EQ(value_of(run_window(options_)).frames, 4);
}

TEST_F(Window, TheMouseTurnsMovesAndNearsTheCamera) {
  Script script;
  Camera first;
  script.until("it is drawn", [](const Glance& g) { return g.frame > 2; });
  script.then([&](const Glance& g) { first = g.camera; });
  script.drag(SDL_BUTTON_LEFT, 500, 300, 550, 340);
  script.until("it orbits", [&](const Glance& g) {
    return g.camera.yaw_rad != first.yaw_rad && g.camera.pitch_rad > first.pitch_rad;
  });
  SDL_Event wheel = {};
  wheel.type = SDL_MOUSEWHEEL;
  wheel.wheel.y = 3;
  script.push(wheel);
  script.until("it nears", [&](const Glance& g) {
    return std::abs(g.camera.distance_m / g.camera.framed_m - 0.9 * 0.9 * 0.9) < 1e-9;
  });
  script.drag(SDL_BUTTON_MIDDLE, 500, 300, 540, 300);
  script.until("it stands aside", [](const Glance& g) { return !g.camera.is_following; });
  run(script);
}

// Frames last 1/60 s; only the last is drawn. Four characters walk; panels open one after the
// other, the selection changes, names and the source are switched. One second after each change all
// characters are visible beside the panels from head to foot, and no frame before jumps.
TEST_F(Window, EverybodyIsInSightWhateverIsOpenAtEverySize) {
  struct Size {
    int width, height;
    double scale;
  };
  for (const Size& size : {Size{1280, 720, 1.0}, Size{640, 400, 1.0}, Size{1920, 1080, 2.0}}) {
    SCOPED_TRACE(fmt::format("{} x {} at scale {}", size.width, size.height, size.scale));
    options_.width = size.width;
    options_.height = size.height;
    options_.scale = size.scale;
    options_.screenshot = (folder_ / "last.png").string();
    options_.are_panels_given = true;
    options_.panels = {};
    const std::vector<SDL_Keycode> keys = {SDLK_F2,  SDLK_F3, SDLK_F5, SDLK_TAB, SDLK_TAB,
                                           SDLK_TAB, SDLK_F4, SDLK_F2, SDLK_F3,  SDLK_F5};
    constexpr int kSettles = 60, kBegin = 120;
    options_.frames = kBegin + kSettles * static_cast<int>(keys.size() + 1);
    std::vector<Mannequin> people;
    int looks = 0;
    Camera last;
    options_.script = [&](const Glance& g) {
      if (people.empty())
        for (const CastMember& member : g.cast.members)
          people.push_back(mannequin_of(member.model));
      if (g.frame > 2) {
        EXPECT_NEAR(g.camera.distance_m / last.distance_m, 1.0, 0.08) << g.frame;
        EXPECT_LT(glm::distance(g.camera.target_m, last.target_m), 0.2) << g.frame;
      }
      last = g.camera;
      const std::int64_t behind = g.frame - kBegin;
      if (behind < 0 || behind % kSettles != 0) return;
      const int width_px = static_cast<int>(size.width * size.scale),
                height_px = static_cast<int>(size.height * size.scale);
      const Viewport scene = scene_viewport(g.ui, false, width_px, height_px, size.scale);
      const auto expect_seen = [&](const vec3& place_m, const char* what) {
        const vec3 at = projected(g.camera, place_m, scene.width, scene.height);
        EXPECT_TRUE(at.z > 0.0 && at.x > 0.0 && at.x < scene.width && at.y > 0.0 &&
                    at.y < scene.height)
            << what << " at " << at.x << ", " << at.y << " of " << scene.width << " x "
            << scene.height << " in frame " << g.frame;
      };
      for (std::size_t i = 0; i < people.size(); ++i) {
        const WalkerFrame& walker = g.session.walkers[i];
        expect_seen(head_m(people[i], walker.pose), "a head");
        for (const Side side : {kLeftSide, kRightSide}) {
          expect_seen(walker.walk.heel_m[side], "a heel");
          expect_seen(walker.walk.toe_m[side], "a toe");
        }
      }
      ++looks;
      const auto next = static_cast<std::size_t>(behind / kSettles);
      if (next >= keys.size()) return;
      SDL_Event event = {};
      event.type = SDL_KEYDOWN;
      event.key.keysym.sym = keys[next];
      event.key.keysym.scancode = SDL_GetScancodeFromKey(keys[next]);
      SDL_PushEvent(&event);
      event.type = SDL_KEYUP;
      SDL_PushEvent(&event);
    };
    options_.take_commands = [walks = false]() mutable {
      return std::exchange(walks, true) ? std::vector<std::string>{}
                                        : std::vector<std::string>{"gait speed_m_s 1.3"};
    };
    value_of(run_window(options_));
    EXPECT_EQ(looks, static_cast<int>(keys.size()) + 1);
  }
}

TEST_F(Window, ASessionAndItsRecordingAreTheSamePoses) {
  options_.session.live.record = (folder_ / "session.hid").string();
  options_.are_panels_given = true;
  options_.panels = {Panel::control};
  Script script;
  script.press(SDLK_w);
  script.until("they walk", [](const Glance& g) { return forward_m(g) > 0.5; });
  script.tap(SDLK_TAB);  // selects the first character
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
  script.press(SDLK_d);
  script.until("the stick is pushed", [](const Glance& g) {
    return g.session.stick.left.y > 0.5 && g.session.stick.left.x > 0.3;
  });
  script.window_event(SDL_WINDOWEVENT_FOCUS_LOST);
  script.until("the stick is neutral",
               [](const Glance& g) { return g.session.stick.left == vec2(0.0); });
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

TEST_F(Window, KeysReachWhatTheMouseReaches) {
  options_.are_panels_given = true;
  options_.panels = {Panel::control, Panel::style};
  Script script;
  script.until("it runs", runs);
  script.tap(SDLK_RETURN);
  script.reach("view");
  script.tap(SDLK_RETURN);
  for (const char* part : {"grid", "shadows", "type larger"}) {
    script.reach(part);
    script.tap(SDLK_SPACE);
  }
  script.until("the grid and shadows are hidden and the type is larger", [](const Glance& g) {
    return !g.ui.has_grid && !g.ui.has_shadows && g.ui.type_size > 1.05;
  });
  script.tap(SDLK_ESCAPE);  // closes the menu
  script.reach("slider speed_m_s");
  script.tap(SDLK_RIGHT);
  script.until("the speed is set", [](const Glance& g) {
    return g.session.walkers[0].overrides.is_set[static_cast<int>(GaitKey::speed_m_s)];
  });
  script.reach("style 4");
  script.tap(SDLK_RETURN);
  script.until("all limp", [](const Glance& g) { return style_of(g, 3) == "limp_left"; });
  script.reach("style name");
  script.tap(SDLK_RETURN);
  script.wait(2);
  script.type("mine");
  script.wait(2);
  // Held for a frame, because Dear ImGui sees only keys that are down during a frame.
  script.press(SDLK_RETURN);
  script.wait(2);
  script.release(SDLK_RETURN);
  script.until("it is saved", [](const Glance& g) { return says(g, "saved as"); });
  script.wait(2);
  script.tap(SDLK_ESCAPE);
  script.until("the keys walk again", [](const Glance& g) { return g.ui.memory.focus.empty(); });
  script.press(SDLK_UP);
  script.until("they walk", [](const Glance& g) { return forward_m(g) > 0.1; });
  run(script);
}

TEST_F(Window, AStyleCanBeExaggerated) {
  options_.are_panels_given = true;
  options_.panels = {Panel::style};
  Script script;
  script.until("it runs", runs);
  script.tap(SDLK_TAB);
  script.tap(SDLK_TAB);  // selects the second character, stiff_hip
  script.tap(SDLK_RETURN);
  script.reach("exaggerate");
  script.tap(SDLK_RIGHT);
  script.until("it differs from even by 1.1 times as much", [](const Glance& g) {
    const WalkerFrame& walker = g.session.walkers[1];
    const StyleValues& own = g.cast.style_values[static_cast<std::size_t>(walker.style_index)];
    int deviating = 0;
    for (const StyleKey& key : style_keys()) {
      const double even = *value_of(StyleValues(), key.name), as_loaded = *value_of(own, key.name);
      deviating += as_loaded != even;
      const double wanted = std::clamp(even + 1.1 * (as_loaded - even), key.min, key.max);
      if (std::abs(*value_of(walker.style, key.name) - wanted) > 1e-9) return false;
    }
    return deviating > 0;
  });
  script.then([](const Glance& g) {  // no other character has changed
    EXPECT_EQ(g.session.walkers[2].style,
              g.cast.style_values[static_cast<std::size_t>(g.session.walkers[2].style_index)]);
  });
  run(script);
}

TEST_F(Window, TwoCharactersAreMarkedForAnOverlayAndAThirdReplacesOne) {
  options_.are_panels_given = true;
  options_.panels = {Panel::style};
  Script script;
  const auto expect = [&script](const std::vector<int>& wanted) {
    script.until(fmt::format("{} are marked", wanted),
                 [wanted](const Glance& g) { return g.ui.overlaid == wanted; });
  };
  script.click("overlay 1");
  expect({0});
  script.click("overlay 4");
  expect({0, 3});
  script.click("overlay 3");
  expect({0, 2});
  script.click("overlay 1");
  expect({2});
  script.tap(SDLK_m);  // restarts on the next terrain, with new characters
  expect({});
  run(script);
}

bool points(const Glance& g) { return g.session.stick_means == StickMeans::points; }

// True if the first character walks along the camera's heading, turned to the left by `left_rad`.
bool goes_along(const Glance& g, double left_rad) {
  const vec3 seen = g.camera.target_m - g.camera.eye_m();
  const double along_rad = std::atan2(seen.x, seen.z) + left_rad;
  const double off_rad = g.session.walkers[0].walk.heading_rad - along_rad;
  return std::abs(std::remainder(off_rad, 2.0 * kPi)) < 2.0 * kDegree;
}

TEST_F(Window, AStickThatPointsIsSeenFromTheCameraAndReplaysWithoutOne) {
  options_.session.live.record = (folder_ / "session.hid").string();
  Script script;
  script.until("it runs", runs);
  script.tap(SDLK_k);
  script.until("the stick points", points);
  script.until("the status line says so", [](const Glance&) {
    return std::ranges::any_of(drawn_texts(), [](const std::string& text) {
      return text.find("stick points") != std::string::npos;
    });
  });
  script.press(SDLK_w);
  script.until("forward is away from the camera",
               [](const Glance& g) { return goes_along(g, 0.0); });
  script.drag(SDL_BUTTON_LEFT, 500, 300, 700, 300);
  script.until("it turns with the camera", [](const Glance& g) {
    return std::abs(g.camera.yaw_rad) > 0.5 && goes_along(g, 0.0);
  });
  script.release(SDLK_w);
  script.press(SDLK_a);
  script.until("left is left of that", [](const Glance& g) { return goes_along(g, kPi / 2.0); });
  script.tap(SDLK_k);
  script.until("it steers", [](const Glance& g) { return !points(g); });
  const WindowResult result = run(script);

  SessionSpec replayed = options_.session;
  replayed.replay.trace = options_.session.live.record;
  EXPECT_EQ(value_of(replay(replayed)).summary.pose_hash, result.summary.pose_hash);
  EXPECT_EQ(result.summary.bad_commands, 0);
  // A drag of two frames turns the camera: there are at most 20 directions a second, and none after
  // it has stopped.
  const Trace trace = value_of(read_trace(replayed.replay.trace));
  std::vector<std::int64_t> aims;
  for (const TraceEvent& event : trace.events) {
    if (event.kind == ReportKind::command &&
        text_of(report_of(trace, event)).starts_with("stick points"))
      aims.push_back(event.tick);
  }
  ASSERT_GE(aims.size(), 2u);
  EXPECT_LE(aims.size(), 10u);
  for (std::size_t i = 1; i < aims.size(); ++i) EXPECT_GE(aims[i] - aims[i - 1], 10);
}

TEST_F(Window, AStickThatPointsDoesSoOnTheNextGround) {
  options_.session.walk.stick = StickMeans::points;
  Script script;
  script.until("it points", points);
  script.tap(SDLK_m);  // begins a new session on another terrain
  script.until("it points on the next ground, too",
               [](const Glance& g) { return g.cast.terrain->name == "rough" && points(g); });
  script.tap(SDLK_k);
  script.until("it steers", [](const Glance& g) { return !points(g); });
  script.tap(SDLK_m);
  script.until("it steers there", [](const Glance& g) {
    return g.cast.terrain->name != "rough" && runs(g) && !points(g);
  });
  run(script);
}

// Recordings go to a separate folder. A recording begins a session in the styles of the previous
// one; when it ends, the session continues.
TEST_F(Window, TheSessionGoesOnWhenItsRecordingEnds) {
  options_.record_folder = (folder_ / "takes").string();
  Script script;
  std::int64_t tick = 0;
  double z_m = 0.0;
  std::string recording;
  script.until("it runs", runs);
  script.tap(SDLK_TAB);
  script.tap(SDLK_4);
  script.until("the first one limps",
               [](const Glance& g) { return style_of(g, 0) == "limp_left"; });
  script.tap(SDLK_F9);
  script.until("it records", [&](const Glance& g) {
    recording = g.recording;
    return recording.starts_with(options_.record_folder + "/gaitpad-");
  });
  script.until("it still limps", [](const Glance& g) {
    return style_of(g, 0) == "limp_left" && style_of(g, 1) == "stiff_hip";
  });
  script.press(SDLK_w);
  script.until("they walk", [](const Glance& g) { return forward_m(g) > 0.5; });
  script.then([&](const Glance& g) { tick = g.session.tick, z_m = forward_m(g); });
  script.tap(SDLK_F9);
  script.until("it is told", [&](const Glance& g) { return says(g, recording + " is complete"); });
  script.then([&](const Glance& g) {
    EXPECT_TRUE(g.recording.empty());
    EXPECT_GE(g.session.tick, tick);
    EXPECT_GE(forward_m(g), z_m);
    EXPECT_EQ(style_of(g, 0), "limp_left");
    EXPECT_TRUE(fs::exists(recording));
  });
  script.until("they walk on", [&](const Glance& g) { return forward_m(g) > z_m + 0.2; });
  script.release(SDLK_w);
  script.click("replay recording");
  script.until("it plays", [](const Glance& g) { return g.is_playback && runs(g); });
  script.until("in that style", [](const Glance& g) { return style_of(g, 0) == "limp_left"; });
  run(script);
  EXPECT_TRUE(files(".hid").empty());
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
  // Unfinished pictures are not written.
  options_.is_hidden = true;
  options_.frames = 100;
  options_.screenshot = own_.at("still.png");
  asked = 0;
  result = run_window(options_);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->is_cut_off);
  EXPECT_EQ(result->frames, 3);
  EXPECT_FALSE(fs::exists(options_.screenshot));
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

// Files in the window are opened, dropped, typed, played, calibrated, and made into pictures.

// Exports the walk of the bundled recording as a motion file, as replay does.
std::string exported_walk(const fs::path& folder, const SessionSpec& session,
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
  const std::string walk = exported_walk(folder_, options_.session, round_);
  const std::string damaged = make("damaged.bvh", text_in(walk).substr(0, 3000));
  const std::string style = make("styles/own.toml", "fatigue = 0.75\n");
  const std::string bad_style = make("styles/bad.toml", "fatigue = \"very\"\n");
  const std::string build = make("characters/small.toml", "scale = 0.5\n");
  const std::string ramp =
      make("terrain/ramp.toml", "[[section]]\nkind = \"slope\"\nlength_m = 5\ngrade = 0.1\n");
  const std::string bad_ground = make("terrain/bad.toml", "[[section]]\nkind = \"hole\"\n");
  Script script;
  script.drop(walk);
  script.until("it walks by the motion",
               [](const Glance& g) { return g.cast.motion != "procedural"; });
  for (const std::string& bad :
       {damaged, bad_style, bad_ground, make("notes.txt", "x"), folder_.string(),
        make("cut.hid", "R: 3 05\n"), (folder_ / "none.bvh").string()}) {
    script.drop(bad);
    script.until("it tells of " + bad, [bad](const Glance& g) { return says(g, bad); });
    script.then([](const Glance& g) {
      EXPECT_NE(g.cast.motion, "procedural");
      EXPECT_FALSE(g.is_playback);
    });
    script.until("it runs on", runs);
  }
  script.drop(style);
  script.until("all are tired", [](const Glance& g) {
    return g.cast.members.size() == 1 && g.cast.members[0].style == "own";
  });
  script.drop(build);
  script.until("it is small", [](const Glance& g) { return !g.cast.members[0].character.empty(); });
  script.until("it runs", runs);
  script.then([](const Glance& g) {
    EXPECT_NEAR(g.cast.members[0].model->leg_length_m,
                0.5 * g.cast.members[0].model->source_leg_length_m, 1e-3);
    EXPECT_TRUE(is_flat(*g.cast.terrain));
  });
  script.drop(ramp);
  script.until("the ramp", [](const Glance& g) { return g.cast.terrain->name == "ramp"; });
  script.until("it runs on", runs);
  run(script);
}

TEST_F(WindowFiles, ADroppedRecordingPlaysAndEscapeGoesBack) {
  Script script;
  script.drop(round_);
  script.until("it plays", [](const Glance& g) { return g.is_playback && g.session.tick > 20; });
  script.then([](const Glance& g) { EXPECT_EQ(g.cast.members.size(), 4u); });
  script.tap(SDLK_ESCAPE);
  script.until("it is live again", [](const Glance& g) { return !g.is_playback; });
  script.until("it runs", runs);
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
  script.until("half-way", [](const Glance& g) {  // half-way through 4800 ticks
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

// Appends `count` reports of six bytes to a recording: X, Y, Z, Rz and two more.
void add_reports(std::string& text, int& ms, const std::array<int, 6>& bytes, int count,
                 int every_ms) {
  for (int i = 0; i < count; ++i, ms += every_ms) {
    text +=
        fmt::format("E: {:06}.{:03}000 6 {:02x}\n", ms / 1000, ms % 1000, fmt::join(bytes, " "));
  }
}

// A pad whose left stick is released four times from all sides and turned round twice, faster than
// by a thumb. At rest it varies by one count.
std::string thumb_trace() {
  std::string text =
      "R: 54 05 01 09 05 a1 01 15 00 26 ff 00 75 08 95 04 09 30 09 31 09 32 09 35 81 02 15 00 25 "
      "07 75 04 95 01 09 39 81 42 05 09 15 00 25 01 75 01 95 0c 19 01 29 0c 81 02 c0\n"
      "N: Thumb Pad\nI: 3 1209 0002\n";
  int ms = 0;
  const auto rest = [&](int count) {
    for (int i = 0; i < count; ++i)
      add_reports(text, ms, {0x80 + i % 2, 0x80, 0x80, 0x80, 8, 0}, 1, 8);
  };
  rest(120);
  for (const auto& [x, y] : {std::pair(0x80, 0), {0xff, 0x80}, {0x80, 0xff}, {0, 0x80}}) {
    add_reports(text, ms, {x, y, 0x80, 0x80, 8, 0}, 25, 8);
    rest(100);
  }
  for (int degrees = 0; degrees <= 720; degrees += 4) {
    const auto place = [degrees](double (*of)(double)) {
      return static_cast<int>(std::lround(127.5 + 127.5 * of(degrees * kDegree)));
    };
    add_reports(text, ms, {place(&std::cos), place(&std::sin), 0x80, 0x80, 8, 0}, 1, 8);
  }
  rest(100);
  return text;
}

// A recording in which the user pushes the left stick, which is Z and Rz on this pad, upside down.
std::string odd_pad_trace() {
  std::string text =
      "D: 0\nN: Odd Pad\nP: made/0\nI: 3 1209 0077\nR: 30 05 01 09 05 a1 01 15 00 26 ff 00 75 08 "
      "95 06 09 30 09 31 09 32 09 35 09 33 09 34 81 02 c0\n";
  constexpr std::array<int, 6> kRest = {0x80, 0x80, 0x80, 0x80, 0, 0};
  int ms = 0;
  for (const std::size_t moved : {3, 2}) {
    add_reports(text, ms, kRest, 30, 50);
    std::array<int, 6> pushed = kRest;
    pushed[moved] = 0xff;
    add_reports(text, ms, pushed, 12, 50);
  }
  add_reports(text, ms, kRest, 60, 50);
  return text;
}

TEST_F(WindowFiles, TheSelfTestNeedsThePadItselfAndTheSessionGoesOnWithoutIt) {
  options_.session.pad.selector.pad = make("thumb.hid", thumb_trace());
  Script script;
  script.until("it runs", runs);
  script.tap(SDLK_F8);
  script.until("it calibrates", [](const Glance& g) { return g.is_calibrating; });
  script.click("calibration test");
  script.until("it says why",
               [](const Glance& g) { return says(g, "the test needs the pad itself"); });
  script.until("it runs again",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, ControlsThatAreWrongAreAskedForAndKept) {
  options_.session.pad.selector.pad = make("odd.hid", odd_pad_trace());
  Script script;
  script.until("it runs", runs);
  script.tap(SDLK_F8);
  script.click("calibration map");
  script.click("map keep");  // the button appears when the left stick is known
  script.until("it is kept", [](const Glance& g) { return says(g, "2 controls are kept in"); });
  script.until("it runs again",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
  const std::string kept = text_in(folder_ / "config/gaitpad/gamecontrollerdb.txt");
  for (const char* part : {"Odd Pad", ",leftx:a2,", ",lefty:a5~,"})
    EXPECT_NE(kept.find(part), std::string::npos) << kept;
}

TEST_F(WindowFiles, ACalibrationIsMeasuredShownSavedAndInForce) {
  options_.session.pad.selector.pad = make("thumb.hid", thumb_trace());
  options_.calibration_folder = (folder_ / "config/gaitpad/calibration").string();
  Script script;
  script.until("it runs", runs);
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
  // At rest 0x80 and 0x81 alternate; the numbers are fractions of half of 0 .. 255.
  EXPECT_NEAR(file->calibration.left.x.centre, (128.5 - 127.5) / 127.5, 0.004);
}

TEST_F(WindowFiles, TheGuideOfACalibrationFitsInASmallWindow) {
  options_.session.pad.selector.pad = make("thumb.hid", thumb_trace());
  options_.width = 640;
  options_.height = 400;
  Script script;
  script.until("it runs", runs);
  script.tap(SDLK_F8);
  script.until("the guide is there",
               [](const Glance&) { return Script::find("calibration of the right stick"); });
  std::vector<UiItem> items;
  script.until("it is looked at", [&items](const Glance&) {
    items.assign(ui_items().begin(), ui_items().end());
    return true;
  });
  run(script);
  const auto found = [&items](const std::string& name) {
    const auto item = std::ranges::find(items, name, &UiItem::name);
    EXPECT_NE(item, items.end()) << name;
    return item == items.end() ? UiItem{} : *item;
  };
  // Items have their visible size: nothing is cut, and no stick is below the buttons.
  const float buttons_y = found("calibration skip").min.y;
  for (const char* name : {"calibration of the left stick", "calibration of the right stick"}) {
    const UiItem stick = found(name);
    EXPECT_LE(stick.max.y, buttons_y) << name;
    // Room for its name, its bar and a line of text.
    EXPECT_GE(stick.max.y - stick.min.y, 55.0f) << name;
  }
  for (const auto& [name, width] :
       {std::pair("calibration map", 140.0f), {"calibration test", 100.0f}}) {
    const UiItem button = found(name);
    EXPECT_GE(button.max.x - button.min.x, width) << name;
    EXPECT_GE(button.max.y - button.min.y, 25.0f) << name;
  }
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
  options_.height = 640;  // high enough for the slider to be visible
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
  script.tap(SDLK_b);  // goes to the last style, which is new and precedes the first
  script.wait(2);
  script.tap(SDLK_b);
  script.until("so does another", [](const Glance& g) {
    return style_of(g, 1) == "my walk" && g.session.walkers[1].style.fatigue > 0.5;
  });
  // A dropped style starts another session.
  script.drop(make("x.toml", "fatigue = 0\nhip_sway = 1\n"));
  script.until("it is known",
               [](const Glance& g) { return std::ranges::count(g.cast.styles, "my walk") == 1; });
  const WindowResult result = run(script);
  EXPECT_EQ(result.summary.bad_commands, 0);
}

TEST_F(WindowFiles, PicturesAreTheSameEveryTime) {
  options_.is_hidden = options_.are_panels_given = true;
  options_.panels = {Panel::pad, Panel::loop};
  options_.frames = 20;
  options_.screenshot = own_.at("still.png");
  // Pictures of a recording, or of a live session that ends by hand.
  for (const std::string& trace : {round_, std::string()}) {
    options_.session.replay.trace = trace;
    std::array<std::string, 2> pictures;
    std::array<std::uint64_t, 2> hashes{};
    for (std::size_t i = 0; i < 2; ++i) {
      const WindowResult result = value_of(run_window(options_));
      EXPECT_EQ(result.frames, 20);
      EXPECT_EQ(result.summary.ticks, 20 * 240 / 60);
      pictures[i] = text_in(options_.screenshot);
      hashes[i] = result.summary.pose_hash;
    }
    EXPECT_GT(pictures[0].size(), 50'000u);
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_EQ(hashes[0], hashes[1]);
  }
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
