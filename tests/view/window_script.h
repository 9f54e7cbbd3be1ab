// A person at the window, for tests: what is pressed, clicked and waited for, one thing a frame.
// The window is in memory (SDL's offscreen driver).
#pragma once
#include <SDL2/SDL.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "gaitpad/replay.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"
#include "view/surface.h"
#include "view/window.h"

namespace gaitpad {

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
    options_.session.config_folders = {GAITPAD_SOURCE_DIR "/config"};
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
  const std::string round_ = GAITPAD_SOURCE_DIR "/config/traces/round.hid";
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

}  // namespace gaitpad
