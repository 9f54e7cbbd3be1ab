// What a person can ask the window for, by key, pad button or mouse: one table for the dispatch,
// the help page and the tests.
#pragma once
#include <SDL2/SDL_keycode.h>

#include <cstdint>
#include <span>
#include <string_view>

#include "gaitpad/report.h"

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

}  // namespace gaitpad
