// What a person can ask the window for, by key, pad button or mouse: one table for the dispatch,
// the help page and the tests.
#pragma once
#include <SDL2/SDL_events.h>
#include <SDL2/SDL_keycode.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/report.h"
#include "gaitpad/session_frame.h"

namespace gaitpad {

enum class Action : std::uint8_t {
  pause,
  step,         // one tick, pausing first
  slow_motion,  // on and off
  reset,
  style_1,  // the first style of the session's list ...
  style_2,
  style_3,
  style_4,
  style_5,
  style_6,
  style_7,
  style_8,
  style_9,
  next_style,
  previous_style,
  next_terrain,  // another ground: the session begins anew on it
  next_walker,   // whom the camera follows and the panels tell of; after the last one: all
  record,
  screenshot,
  open_file,
  calibrate,
  follow,  // the camera: follows, stands
  reset_camera,
  theme,
  trails,
  source,  // the stick figure
  panel_pad,
  panel_control,
  panel_style,
  panel_graphs,
  panel_solver,
  panel_loop,
  help,
  fullscreen,
  quit,
  back,  // closes what is open: help, browser, calibration
};

struct ActionInfo {
  Action action;
  SDL_Keycode key;         // SDLK_UNKNOWN: none
  SDL_Keycode second_key;  // the same by another key
  int button;              // PadButton, -1: none
  std::string_view name;   // "pause"
  std::string_view group;  // heading on the help page
  std::string_view text;   // one line for the help page
};
// Every action once, in the order of the help page. Walking keys (WASD, arrows) are not among them.
std::span<const ActionInfo> actions() noexcept;
const ActionInfo& info_of(Action action) noexcept;
std::string_view key_name(SDL_Keycode key) noexcept;       // "Space", "F1", "W"; "?": no known one
std::string_view button_label(PadButton button) noexcept;  // "A", "left shoulder"

// What is no action: `text` by `input`, for the help page.
struct HelpLine {
  std::string_view input, text;
};
std::span<const HelpLine> walking_help() noexcept;

// SDL's events as what a person means by them: actions, a direction to walk in, moves of the
// camera, files that were dropped. No SDL state is polled: events that a test pushes count like
// real ones.

struct Mouse {
  vec2 place_px{0.0};  // of the window
  bool is_inside = false;
  std::array<bool, 3> is_down{};  // left, right, middle, as Dear ImGui counts them
};

// What the panels have taken for themselves, in the frame before.
struct Taken {
  bool keys = false;   // somebody types text
  bool mouse = false;  // the pointer is over a panel
};

// Since it was asked last.
struct Wishes {
  std::vector<Action> actions;
  std::vector<std::string> files;  // dropped
  vec2 orbit_px{0.0}, pan_px{0.0};
  double dolly = 1.0;  // factor on the distance
};

class Controls {
 public:
  void take(const SDL_Event& event, const Taken& taken);
  Wishes wishes();

  // Where the walking keys point, +x right, +y forward, at most 1 long.
  vec2 walk() const noexcept;
  void let_go() noexcept;  // of the walking keys and the mouse
  const Mouse& mouse() const noexcept { return mouse_; }

 private:
  enum class Drag { none, orbit, pan };
  void take_key(const SDL_KeyboardEvent& key, const Taken& taken);
  void take_button(const SDL_MouseButtonEvent& button, const Taken& taken);
  void take_motion(const SDL_MouseMotionEvent& motion);
  void take_window(const SDL_WindowEvent& window);

  Wishes wishes_;
  std::array<bool, 8> is_held_{};  // W A S D, up left down right
  bool is_shifted_ = false;
  Mouse mouse_;
  Drag drag_ = Drag::none;
};

// Presses of a pad's buttons as actions, by the table.
class ButtonPresses {
 public:
  void take(const SessionFrame& frame, std::vector<Action>& actions);
  void begin_anew() noexcept { is_first_ = true; }  // another session counts from 0

 private:
  bool is_first_ = true;
  std::array<std::uint32_t, kButtonCount> presses_{};
};

}  // namespace gaitpad
