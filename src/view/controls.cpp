#include "view/controls.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace gaitpad {
namespace {

constexpr double kDollyAStep = 0.9;
constexpr std::uint32_t kMostPresses = 8;  // of one button between two frames

constexpr SDL_Keycode kWalkingKeys[] = {SDLK_w,  SDLK_a,    SDLK_s,    SDLK_d,
                                        SDLK_UP, SDLK_LEFT, SDLK_DOWN, SDLK_RIGHT};

// Dear ImGui's number of SDL's button, -1: none.
int button_index(std::uint8_t button) noexcept {
  switch (button) {
    case SDL_BUTTON_LEFT:
      return 0;
    case SDL_BUTTON_RIGHT:
      return 1;
    case SDL_BUTTON_MIDDLE:
      return 2;
    default:
      return -1;
  }
}

}  // namespace

void Controls::take(const SDL_Event& event, const Taken& taken) {
  switch (event.type) {
    case SDL_QUIT:
      wishes_.actions.push_back(Action::quit);
      break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      take_key(event.key, taken);
      break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      take_button(event.button, taken);
      break;
    case SDL_MOUSEMOTION:
      take_motion(event.motion);
      break;
    case SDL_MOUSEWHEEL:
      if (!taken.mouse) {
        const double steps = event.wheel.preciseY != 0.0f ? event.wheel.preciseY : event.wheel.y;
        wishes_.dolly *= std::pow(kDollyAStep, std::clamp(steps, -20.0, 20.0));
      }
      break;
    case SDL_WINDOWEVENT:
      take_window(event.window);
      break;
    case SDL_DROPFILE:
      if (event.drop.file) wishes_.files.emplace_back(event.drop.file);
      break;
    default:
      break;
  }
}

void Controls::take_key(const SDL_KeyboardEvent& key, const Taken& taken) {
  const SDL_Keycode code = key.keysym.sym;
  const bool is_down = key.type == SDL_KEYDOWN;
  if (code == SDLK_LSHIFT || code == SDLK_RSHIFT) is_shifted_ = is_down;
  const bool is_chord = (key.keysym.mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI)) != 0;
  const auto walking = std::ranges::find(kWalkingKeys, code);
  if (walking != std::end(kWalkingKeys)) {
    const auto index = static_cast<std::size_t>(walking - std::begin(kWalkingKeys));
    is_held_[index] = is_down && !taken.keys && !is_chord;
    return;
  }
  if (!is_down || taken.keys || is_chord || code == SDLK_UNKNOWN) return;
  for (const ActionInfo& info : actions()) {
    if (info.key != code && info.second_key != code) continue;
    if (key.repeat == 0 || info.action == Action::step) wishes_.actions.push_back(info.action);
    return;
  }
}

void Controls::take_button(const SDL_MouseButtonEvent& button, const Taken& taken) {
  mouse_.place_px = vec2(button.x, button.y);
  mouse_.is_inside = true;
  const int index = button_index(button.button);
  if (index < 0) return;
  const bool is_down = button.type == SDL_MOUSEBUTTONDOWN;
  mouse_.is_down[static_cast<std::size_t>(index)] = is_down;
  if (!is_down) drag_ = Drag::none;
  if (!is_down || taken.mouse) return;
  drag_ = index > 0 || is_shifted_ ? Drag::pan : Drag::orbit;
}

void Controls::take_motion(const SDL_MouseMotionEvent& motion) {
  const vec2 place(motion.x, motion.y);
  if (drag_ == Drag::orbit) wishes_.orbit_px += place - mouse_.place_px;
  if (drag_ == Drag::pan) wishes_.pan_px += place - mouse_.place_px;
  mouse_.place_px = place;
  mouse_.is_inside = true;
}

void Controls::take_window(const SDL_WindowEvent& window) {
  switch (window.event) {
    case SDL_WINDOWEVENT_FOCUS_LOST:
    case SDL_WINDOWEVENT_MINIMIZED:
    case SDL_WINDOWEVENT_HIDDEN:
      let_go();
      break;
    case SDL_WINDOWEVENT_LEAVE:
      mouse_.is_inside = drag_ != Drag::none;
      break;
    case SDL_WINDOWEVENT_CLOSE:
      wishes_.actions.push_back(Action::quit);
      break;
    default:
      break;
  }
}

Wishes Controls::wishes() { return std::exchange(wishes_, {}); }

vec2 Controls::walk() const noexcept {
  const auto held = [this](std::size_t a, std::size_t b) {
    return is_held_[a] || is_held_[b] ? 1.0 : 0.0;
  };
  const vec2 sum(held(3, 7) - held(1, 5), held(0, 4) - held(2, 6));
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y);
  return length > 1.0 ? sum / length : sum;
}

void Controls::let_go() noexcept {
  is_held_ = {};
  is_shifted_ = false;
  mouse_.is_down = {};
  drag_ = Drag::none;
}

void ButtonPresses::take(const SessionFrame& frame, std::vector<Action>& wanted) {
  const auto before = std::exchange(presses_, frame.presses);
  if (std::exchange(is_first_, false)) return;
  for (const ActionInfo& info : actions()) {
    if (info.button < 0 || info.button >= kButtonCount) continue;
    const auto button = static_cast<std::size_t>(info.button);
    const std::uint32_t fresh = std::min(presses_[button] - before[button], kMostPresses);
    for (std::uint32_t i = 0; i < fresh; ++i) wanted.push_back(info.action);
  }
}

}  // namespace gaitpad
