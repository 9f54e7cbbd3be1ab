#include "view/controls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace gaitpad {
namespace {

constexpr int kNoButton = -1;
constexpr SDL_Keycode kNoKey = SDLK_UNKNOWN;

// Headings of the help page.
constexpr std::string_view kSession = "Session", kStyles = "Styles and characters",
                           kFiles = "Files", kView = "View", kPanelGroup = "Panels",
                           kWindow = "Window";

// No key next to the walking keys ends a session, a recording or the program.
constexpr ActionInfo kBeforePanels[] = {
    {Action::pause, SDLK_SPACE, SDLK_p, kButtonStart, "pause", kSession, "pause or continue"},
    {Action::step, SDLK_PERIOD, kNoKey, kButtonDpadRight, "step", kSession,
     "one tick; pauses first"},
    {Action::slow_motion, SDLK_COMMA, kNoKey, kButtonA, "slow motion", kSession,
     "slow motion, on and off"},
    {Action::reset, SDLK_BACKSPACE, kNoKey, kButtonDpadDown, "reset", kSession,
     "all characters back to the start"},
    {Action::stick, SDLK_k, kNoKey, kNoButton, "stick", kSession,
     "stick: steers, or points as seen from the camera"},
    {Action::style_1, SDLK_1, SDLK_KP_1, kNoButton, "style 1", kStyles, "first style of the list"},
    {Action::style_2, SDLK_2, SDLK_KP_2, kNoButton, "style 2", kStyles, "second style"},
    {Action::style_3, SDLK_3, SDLK_KP_3, kNoButton, "style 3", kStyles, "third style"},
    {Action::style_4, SDLK_4, SDLK_KP_4, kNoButton, "style 4", kStyles, "fourth style"},
    {Action::style_5, SDLK_5, SDLK_KP_5, kNoButton, "style 5", kStyles, "fifth style"},
    {Action::style_6, SDLK_6, SDLK_KP_6, kNoButton, "style 6", kStyles, "sixth style"},
    {Action::style_7, SDLK_7, SDLK_KP_7, kNoButton, "style 7", kStyles, "seventh style"},
    {Action::style_8, SDLK_8, SDLK_KP_8, kNoButton, "style 8", kStyles, "eighth style"},
    {Action::style_9, SDLK_9, SDLK_KP_9, kNoButton, "style 9", kStyles, "ninth style"},
    {Action::next_style, SDLK_n, SDLK_RIGHTBRACKET, kButtonRightShoulder, "next style", kStyles,
     "next style of the list"},
    {Action::previous_style, SDLK_b, SDLK_LEFTBRACKET, kButtonLeftShoulder, "previous style",
     kStyles, "previous style of the list"},
    {Action::undo, kNoKey, kNoKey, kNoButton, "undo", kStyles, "undo a slider, style or override"},
    {Action::redo, kNoKey, kNoKey, kNoButton, "redo", kStyles, "do it again"},
    {Action::next_terrain, SDLK_m, kNoKey, kNoButton, "next terrain", kStyles,
     "next ground of the list, from the start"},
    {Action::next_walker, SDLK_TAB, kNoKey, kButtonY, "next walker", kStyles,
     "choose the next character, then all"},
    {Action::record, SDLK_F9, kNoKey, kButtonDpadUp, "record", kFiles,
     "restart and record; again: end"},
    {Action::screenshot, SDLK_F12, SDLK_PRINTSCREEN, kButtonX, "screenshot", kFiles,
     "save a picture"},
    {Action::open_file, SDLK_o, kNoKey, kNoButton, "open", kFiles,
     "open a motion, style, ground or recording"},
    {Action::calibrate, SDLK_F8, kNoKey, kNoButton, "calibrate", kFiles, "calibrate the sticks"},
    {Action::follow, SDLK_c, kNoKey, kButtonLeftStick, "follow", kView, "camera follows or stays"},
    {Action::reset_camera, SDLK_v, SDLK_HOME, kButtonRightStick, "reset camera", kView,
     "camera as at the start"},
    {Action::theme, SDLK_l, kNoKey, kNoButton, "theme", kView, "light or dark"},
    {Action::trails, SDLK_t, kNoKey, kButtonDpadLeft, "trails", kView, "trails of the feet"},
    {Action::source, SDLK_g, kNoKey, kNoButton, "source", kView,
     "stick figure of the source motion"},
};
constexpr ActionInfo kAfterPanels[] = {
    {Action::navigate, SDLK_RETURN, SDLK_KP_ENTER, kButtonGuide, "navigate", kWindow,
     "keys to the panels: arrows, Enter"},
    {Action::help, SDLK_F1, SDLK_h, kButtonBack, "help", kWindow, "this page"},
    {Action::fullscreen, SDLK_F11, kNoKey, kNoButton, "full screen", kWindow,
     "full screen, on and off"},
    {Action::quit, SDLK_F10, kNoKey, kNoButton, "quit", kWindow, "end the program"},
    {Action::back, SDLK_ESCAPE, kNoKey, kButtonB, "back", kWindow, "close what is open"},
};
constexpr auto kActions = [] {
  std::array<ActionInfo, std::size(kBeforePanels) + kPanels + std::size(kAfterPanels)> all{};
  auto* end = std::copy(std::begin(kBeforePanels), std::end(kBeforePanels), all.begin());
  for (std::size_t i = 0; i < kPanels; ++i) {
    const PanelInfo& panel = kPanelTable[i];
    *end++ = {action_of(i), panel.key, kNoKey, kNoButton, panel.id, kPanelGroup, panel.id};
  }
  std::copy(std::begin(kAfterPanels), std::end(kAfterPanels), end);
  return all;
}();

static_assert(shared_key(kActions) == kNoKey,
              "two actions have the same key: see the tables above and kPanelTable");

constexpr Chord kChords[] = {
    {SDLK_z, false, Action::undo, "Ctrl+Z"},
    {SDLK_y, false, Action::redo, "Ctrl+Y"},
    {SDLK_z, true, Action::redo, "Ctrl+Shift+Z"},
    {SDLK_q, false, Action::quit, "Ctrl+Q"},
};

struct KeyName {
  SDL_Keycode key;
  std::string_view name;
};
constexpr KeyName kKeyNames[] = {
    {SDLK_SPACE, "Space"},
    {SDLK_BACKSPACE, "Backspace"},
    {SDLK_TAB, "Tab"},
    {SDLK_RETURN, "Enter"},
    {SDLK_ESCAPE, "Esc"},
    {SDLK_DELETE, "Del"},
    {SDLK_INSERT, "Ins"},
    {SDLK_HOME, "Home"},
    {SDLK_END, "End"},
    {SDLK_PAGEUP, "PgUp"},
    {SDLK_PAGEDOWN, "PgDn"},
    {SDLK_PRINTSCREEN, "Print"},
    {SDLK_LEFT, "Left"},
    {SDLK_RIGHT, "Right"},
    {SDLK_UP, "Up"},
    {SDLK_DOWN, "Down"},
    {SDLK_F1, "F1"},
    {SDLK_F2, "F2"},
    {SDLK_F3, "F3"},
    {SDLK_F4, "F4"},
    {SDLK_F5, "F5"},
    {SDLK_F6, "F6"},
    {SDLK_F7, "F7"},
    {SDLK_F8, "F8"},
    {SDLK_F9, "F9"},
    {SDLK_F10, "F10"},
    {SDLK_F11, "F11"},
    {SDLK_F12, "F12"},
    {SDLK_KP_1, "Num 1"},
    {SDLK_KP_2, "Num 2"},
    {SDLK_KP_3, "Num 3"},
    {SDLK_KP_4, "Num 4"},
    {SDLK_KP_5, "Num 5"},
    {SDLK_KP_6, "Num 6"},
    {SDLK_KP_7, "Num 7"},
    {SDLK_KP_8, "Num 8"},
    {SDLK_KP_9, "Num 9"},
    {SDLK_KP_0, "Num 0"},
    {SDLK_KP_ENTER, "Num Enter"},
    {SDLK_KP_PLUS, "Num +"},
    {SDLK_KP_MINUS, "Num -"},
};
constexpr std::string_view kPrinted = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,-=+;:'/\\[]`#*<>?!";

constexpr std::array<std::string_view, kButtonCount> kButtonLabels = {
    "A",           "B",       "X",          "Y",          "Back",     "Guide",      "Start",
    "L stick",     "R stick", "L shoulder", "R shoulder", "D-pad up", "D-pad down", "D-pad left",
    "D-pad right", "Misc",    "Paddle 1",   "Paddle 2",   "Paddle 3", "Paddle 4",   "Touchpad",
    "Misc 2",      "Misc 3",  "Misc 4",     "Misc 5",     "Misc 6"};

constexpr HelpLine kWalkingHelp[] = {
    {"W A S D, arrows", "walk and turn, like a stick"}, {"left stick", "walk and turn"},
    {"right stick", "camera round the scene"},          {"drag", "camera round the scene"},
    {"right drag", "camera sideways and up"},           {"wheel", "camera nearer, farther"},
    {"blue floor line", "ahead from the start, 1 m"},   {"orange floor line", "to the left, 1 m"},
};

constexpr double kDollyAStep = 0.9;
// Most presses of one button that count between two frames.
constexpr std::uint32_t kMostPresses = 8;

constexpr SDL_Keycode kWalkingKeys[] = {SDLK_w,  SDLK_a,    SDLK_s,    SDLK_d,
                                        SDLK_UP, SDLK_LEFT, SDLK_DOWN, SDLK_RIGHT};

// Dear ImGui's index of an SDL mouse button; -1: none.
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

std::span<const ActionInfo> actions() noexcept { return kActions; }

const ActionInfo& info_of(Action action) noexcept {
  for (const ActionInfo& info : kActions) {
    if (info.action == action) return info;
  }
  return kActions[0];
}

std::span<const Chord> chords() noexcept { return kChords; }

std::string_view key_name(SDL_Keycode key) noexcept {
  for (const KeyName& entry : kKeyNames) {
    if (entry.key == key) return entry.name;
  }
  const bool is_letter = key >= SDLK_a && key <= SDLK_z;
  const SDL_Keycode printed = is_letter ? key - SDLK_a + 'A' : key;
  if (printed <= ' ' || printed > '~') return "?";
  const std::size_t at = kPrinted.find(static_cast<char>(printed));
  return at == std::string_view::npos ? "?" : kPrinted.substr(at, 1);
}

std::string_view button_label(PadButton button) noexcept {
  return button >= 0 && button < kButtonCount ? kButtonLabels[button] : "?";
}

std::span<const HelpLine> walking_help() noexcept { return kWalkingHelp; }

void Controls::handle_event(const SDL_Event& event, const TakenInput& taken) {
  switch (event.type) {
    case SDL_QUIT:
      requests_.actions.push_back(Action::quit);
      break;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      handle_key(event.key, taken);
      break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      handle_mouse_button(event.button, taken);
      break;
    case SDL_MOUSEMOTION:
      handle_mouse_motion(event.motion);
      break;
    case SDL_MOUSEWHEEL:
      if (!taken.mouse) {
        const double steps = event.wheel.preciseY != 0.0f ? event.wheel.preciseY : event.wheel.y;
        requests_.dolly *= std::pow(kDollyAStep, std::clamp(steps, -20.0, 20.0));
      }
      break;
    case SDL_WINDOWEVENT:
      handle_window_event(event.window);
      break;
    case SDL_DROPFILE:
      if (event.drop.file) requests_.files.emplace_back(event.drop.file);
      break;
    default:
      break;
  }
}

void Controls::handle_key(const SDL_KeyboardEvent& key, const TakenInput& taken) {
  const SDL_Keycode code = key.keysym.sym;
  const bool is_down = key.type == SDL_KEYDOWN;
  if (code == SDLK_LSHIFT || code == SDLK_RSHIFT) is_shifted_ = is_down;
  const bool is_chord = (key.keysym.mod & (KMOD_CTRL | KMOD_ALT | KMOD_GUI)) != 0;
  if (is_down && !taken.keys && (key.keysym.mod & KMOD_CTRL) != 0 && key.repeat == 0) {
    for (const Chord& chord : kChords) {
      const bool has_shift = (key.keysym.mod & KMOD_SHIFT) != 0;
      if (chord.key == code && chord.has_shift == has_shift)
        requests_.actions.push_back(chord.action);
    }
  }
  if (is_down && !taken.keys && !is_chord) {
    if (key.repeat == 0) requests_.keys.push_back(code);
    if (navigate(code, (key.keysym.mod & KMOD_SHIFT) != 0, taken)) return;
  }
  const auto walking = std::ranges::find(kWalkingKeys, code);
  if (walking != std::end(kWalkingKeys)) {
    const auto index = static_cast<std::size_t>(walking - std::begin(kWalkingKeys));
    is_held_[index] = is_down && !taken.keys && !is_chord;
    return;
  }
  if (!is_down || taken.keys || is_chord || code == SDLK_UNKNOWN) return;
  for (const ActionInfo& info : actions()) {
    if (info.key != code && info.second_key != code) continue;
    if (key.repeat == 0 || info.action == Action::step) requests_.actions.push_back(info.action);
    return;
  }
}

// True if the key was used to move between buttons and sliders; it then has no other effect.
bool Controls::navigate(SDL_Keycode key, bool is_back, const TakenInput& taken) {
  if (!taken.navigates && !(taken.is_modal && key == SDLK_TAB)) return false;
  NavigationInput& input = requests_.navigation;
  switch (key) {
    case SDLK_TAB:
      input.steps += is_back ? -1 : 1;
      return true;
    case SDLK_DOWN:
    case SDLK_UP:
      input.steps += key == SDLK_UP ? -1 : 1;
      return true;
    case SDLK_LEFT:
    case SDLK_RIGHT:
      input.sideways += key == SDLK_LEFT ? -1 : 1;
      return true;
    case SDLK_SPACE:
    case SDLK_RETURN:
    case SDLK_KP_ENTER:
      input.press = true;
      return true;
    default:
      return false;
  }
}

void Controls::handle_mouse_button(const SDL_MouseButtonEvent& button, const TakenInput& taken) {
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

void Controls::handle_mouse_motion(const SDL_MouseMotionEvent& motion) {
  const vec2 place(motion.x, motion.y);
  if (drag_ == Drag::orbit) requests_.orbit_px += place - mouse_.place_px;
  if (drag_ == Drag::pan) requests_.pan_px += place - mouse_.place_px;
  mouse_.place_px = place;
  mouse_.is_inside = true;
}

void Controls::handle_window_event(const SDL_WindowEvent& window) {
  switch (window.event) {
    case SDL_WINDOWEVENT_FOCUS_LOST:
    case SDL_WINDOWEVENT_MINIMIZED:
    case SDL_WINDOWEVENT_HIDDEN:
      release_all();
      break;
    case SDL_WINDOWEVENT_LEAVE:
      mouse_.is_inside = drag_ != Drag::none;
      break;
    case SDL_WINDOWEVENT_CLOSE:
      requests_.actions.push_back(Action::quit);
      break;
    default:
      break;
  }
}

UserRequests Controls::take_requests() { return std::exchange(requests_, {}); }

vec2 Controls::walk() const noexcept {
  const auto held = [this](std::size_t a, std::size_t b) {
    return is_held_[a] || is_held_[b] ? 1.0 : 0.0;
  };
  const vec2 sum(held(3, 7) - held(1, 5), held(0, 4) - held(2, 6));
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y);
  return length > 1.0 ? sum / length : sum;
}

void Controls::release_all() noexcept {
  is_held_ = {};
  is_shifted_ = false;
  mouse_.is_down = {};
  drag_ = Drag::none;
}

void ButtonPresses::add_new_presses(const SessionFrame& frame, std::vector<Action>& wanted) {
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
