// SDL's events as what a person means by them: actions, a direction to walk in, moves of the
// camera, files that were dropped. No SDL state is polled: events that a test pushes count like
// real ones.
#pragma once
#include <SDL2/SDL_events.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/session_frame.h"
#include "view/actions.h"

namespace gaitpad {

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
