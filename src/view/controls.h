// Actions of the window and their keys, pad buttons and mouse gestures. One table of actions serves
// the dispatch, the help page and the tests.
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
#include "view/panels.h"

namespace gaitpad {

enum class Action : std::uint8_t {
  pause,
  step,         // computes one tick; pauses the session first
  slow_motion,  // switches slow motion on and off
  reset,
  stick,    // switches between a stick that steers and one that points where to go
  style_1,  // gives the walker the first style of the session's list; the next eight follow
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
  undo,  // takes back the last change of a slider, style or override
  redo,
  next_terrain,  // starts the session again on the next ground
  next_walker,   // selects the next walker for camera and panels; after the last one: all
  record,
  screenshot,
  open_file,
  calibrate,
  follow,  // the camera follows the walkers, or stops following them
  reset_camera,
  theme,
  trails,
  source,       // shows the source motion as a stick figure
  first_panel,  // opens and closes the first panel; the other panels' actions follow it
  navigate = first_panel + kPanels,  // lets keys and pad move between buttons and sliders
  help,
  fullscreen,
  quit,
  back,  // closes the open help, browser or dialog
};

constexpr Action action_of(std::size_t panel) noexcept {
  return static_cast<Action>(static_cast<std::size_t>(Action::first_panel) + panel);
}

struct ActionInfo {
  Action action;
  SDL_Keycode key;         // SDLK_UNKNOWN: none
  SDL_Keycode second_key;  // another key with the same effect
  int button;              // a PadButton; -1: none
  std::string_view name;   // the action's name, for example "pause"
  std::string_view group;  // heading on the help page
  std::string_view text;   // one line for the help page
};
// A key that two of these actions have; SDLK_UNKNOWN: each key has one action.
constexpr SDL_Keycode shared_key(std::span<const ActionInfo> table) noexcept {
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (const SDL_Keycode key : {table[i].key, table[i].second_key}) {
      if (key == SDLK_UNKNOWN) continue;
      if (table[i].key == table[i].second_key) return key;
      for (std::size_t j = i + 1; j < table.size(); ++j)
        if (table[j].key == key || table[j].second_key == key) return key;
    }
  }
  return SDLK_UNKNOWN;
}
// Every action once, in the order of the help page. The walking keys (WASD, arrows) are not listed.
std::span<const ActionInfo> actions() noexcept;
const ActionInfo& info_of(Action action) noexcept;
// Keys pressed with Ctrl. They are not in the table's columns.
struct Chord {
  SDL_Keycode key;
  bool has_shift;
  Action action;
  std::string_view name;  // the keys' names, for example "Ctrl+Z"
};
std::span<const Chord> chords() noexcept;
// The name of a key: "Space", "F1", "W"; "?" for an unknown key.
std::string_view key_name(SDL_Keycode key) noexcept;
std::string_view button_label(PadButton button) noexcept;  // The name of a pad's button: "A", "left
                                                           // shoulder".

// Input that is not an action, for the help page.
struct HelpLine {
  std::string_view input, text;
};
std::span<const HelpLine> walking_help() noexcept;

// Translates SDL's events into actions, a walking direction, camera moves and dropped files. It
// does not poll SDL's state, so that events pushed by a test have the same effect as real ones.

struct Mouse {
  vec2 place_px{0.0};  // the pointer's place in the window
  bool is_inside = false;
  std::array<bool, 3> is_down{};  // buttons: left, right, middle (Dear ImGui's order)
};

// Input that the panels used in the previous frame.
struct TakenInput {
  bool keys = false;       // the user types text
  bool mouse = false;      // the pointer is over a panel
  bool navigates = false;  // arrows, Tab, Enter and Space move between the panels' items
  bool is_modal = false;   // a modal box is open: Tab starts the navigation
};

// Moves between buttons and sliders, and changes of the focused one.
struct NavigationInput {
  int steps = 0;     // number of items to move on; negative: to earlier ones
  int sideways = 0;  // number of steps that a slider moves to the right
  bool press = false;
};

// Requests since the last call of take_requests().
struct UserRequests {
  std::vector<Action> actions;
  std::vector<std::string> files;  // files that were dropped on the window
  // Keys that were pressed, by the letter printed on them; without those typed as text.
  std::vector<SDL_Keycode> keys;
  NavigationInput navigation;
  vec2 orbit_px{0.0}, pan_px{0.0};
  double dolly = 1.0;  // factor for the camera's distance
};

class Controls {
 public:
  void handle_event(const SDL_Event& event, const TakenInput& taken);
  UserRequests take_requests();

  // Direction of the walking keys, +x right, +y forward, of length 1 at most.
  vec2 walk() const noexcept;
  void release_all() noexcept;  // Treats all walking keys and mouse buttons as released.
  const Mouse& mouse() const noexcept { return mouse_; }

 private:
  enum class Drag { none, orbit, pan };
  void handle_key(const SDL_KeyboardEvent& key, const TakenInput& taken);
  bool navigate(SDL_Keycode key, bool is_back, const TakenInput& taken);
  void handle_mouse_button(const SDL_MouseButtonEvent& button, const TakenInput& taken);
  void handle_mouse_motion(const SDL_MouseMotionEvent& motion);
  void handle_window_event(const SDL_WindowEvent& window);

  UserRequests requests_;
  std::array<bool, 8> is_held_{};  // keys W A S D, then arrows up left down right
  bool is_shifted_ = false;
  Mouse mouse_;
  Drag drag_ = Drag::none;
};

// Turns presses of a pad's buttons into actions.
class ButtonPresses {
 public:
  void add_new_presses(const SessionFrame& frame, std::vector<Action>& actions);
  // Call it for a new session, which counts presses from 0.
  void start_again() noexcept { is_first_ = true; }

 private:
  bool is_first_ = true;
  std::array<std::uint32_t, kButtonCount> presses_{};
};

}  // namespace gaitpad
