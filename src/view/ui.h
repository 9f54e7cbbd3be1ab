// The user interface over the scene: bars, panels, plots, names above heads, help. It reads a frame
// and returns the user's requests; it changes only its own state.
#pragma once
#include <imgui.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "draw/theme.h"
#include "gaitpad/live.h"
#include "gaitpad/session_frame.h"
#include "scene/scene.h"
#include "session/show.h"
#include "stick/reached_outline.h"
#include "view/controls.h"

namespace gaitpad {

struct Fonts;  // declared in view/gui.h

// State of draw_ui() between frames.
struct UiMemory {
  // A moved slider shows the user's value until the session has applied it.
  struct PendingValue {
    std::string name;
    int walker = -1;
    double value = 0.0;
    std::int64_t tick = 0;  // tick at which the value was sent
  };
  struct StickPlace {
    // Left and right stick; raw positions are in the stick's frame.
    std::array<vec2, 2> raw{}, calibrated{};
  };
  std::string focus;          // the item that keys and pad press; empty: no navigation
  bool is_focus_new = false;  // scroll until the item is visible
  std::vector<PendingValue> pending;
  double held = 0.0;                    // the last value of the slider being dragged
  std::vector<StickPlace> stick_trail;  // the latest positions of the stick, oldest first
  std::int64_t stick_tick = -1;
  std::array<ReachedOutline, 2> reached;  // where the left and the right stick has been
  std::array<bool, kPanels> was_open{};
  bool has_drawn = false;
  std::array<char, 64> style_name{};
  bool has_axis_weights = false;  // the style panel shows each axis of a joint
  bool has_body_keys = false;     // the style panel shows the keys of the upper body
};

// The state that is stored between two starts (view/layout.h), and what is open now.
struct UiState {
  std::array<bool, kPanels> is_open{true, true, false, true, false, false};
  ThemeName theme = ThemeName::dark;
  bool has_trails = true, has_grid = true, has_shadows = true, has_source = true, has_names = true;
  Side graph_leg = kLeftSide;
  // Index of the walker that panels and camera show; -1: all, and the numbers of the first.
  int walker = -1;
  // Two characters drawn in one place, half transparent; otherwise empty.
  std::vector<int> overlaid;
  double type_size = 1.0;  // factor on the display's scale for type, buttons and columns
  bool is_help_open = false;
  bool is_clean = false;  // only the scene is drawn, without bars
  UiMemory memory;
};

// Parts of the scene that can be hidden, by their names in options and the layout file.
struct ScenePart {
  std::string_view name, label;  // the action that shows and hides the part has the same name
  bool UiState::*is_shown;
};
inline constexpr ScenePart kSceneParts[] = {{"trails", "Trails", &UiState::has_trails},
                                            {"source", "Source figure", &UiState::has_source},
                                            {"grid", "Grid", &UiState::has_grid},
                                            {"shadows", "Shadows", &UiState::has_shadows},
                                            {"names", "Names", &UiState::has_names}};

struct UiLabel {  // a character's name above its head
  vec2 place_px{0.0};
  std::string text;
  Colour colour;
};
struct UiInput {
  const SessionFrame& frame;
  const Cast& cast;
  const History& history;
  const LiveStatus* status = nullptr;  // null in a playback
  const Timeline* timeline = nullptr;  // null in a live session
  std::string pad_name{};              // the driving pad; empty: none
  double pad_rate_hz = 0.0;
  double pace = 1.0;
  double frames_per_second = 0.0;  // mean over the last half second; 0: not shown, as in pictures
  double memory_mib = 0.0;         // memory of the whole program; 0: unknown
  std::string recording{};         // file that is being recorded; empty: none
  std::string source{};            // name of the played trace, for the bar
  std::string renderer{};
  std::vector<UiLabel> labels{};
  std::vector<std::string> messages{};         // errors and remarks, newest last
  std::vector<std::string> style_summaries{};  // what each of Cast::styles does, in a line
  std::string change{};              // the last change and the characters that it concerns; empty:
                                     // none lately
  std::string finished_recording{};  // the file that a message offers to replay; empty: none
  std::string hint{};                // how to start, shown over the scene until a character walks
  std::string pad_hint{};            // why a pad may not be found, and what to do
  bool can_leave = false;            // Esc ends the playback and returns to the previous live
                                     // session
  bool can_rumble = false;           // the driving pad has motors
  NavigationInput navigation{};
  std::span<const SDL_Keycode> keys{};  // keys that were pressed since the last frame
  bool is_modal = false;                // a dialog or the browser is open, so panels take no input
};
struct UiOutput {
  std::vector<Action> actions;
  // Commands for the session, for example `set 2 left_leg.weight.hip 0.4`.
  std::vector<std::string> commands;
  std::optional<std::int64_t> seek_tick;
  std::optional<double> pace;
  std::optional<bool> is_looping;
  // Name under which the selected style is saved; none: not asked for.
  std::optional<std::string> save_style;
  bool dismisses_messages = false;
  std::optional<double> type_size;
  bool replays = false;  // asks to replay UiInput::finished_recording
  bool rumbles = false;  // asks for one beat of the pad's motors
};

inline constexpr double kLeastTypeSize = 0.8, kMostTypeSize = 1.6, kTypeSizeStep = 0.1;

// Indices in Cast::styles of the styles that a `style` command can name; of equal names the first.
// Action::style_1 + n - 1 chooses the n-th of them.
std::vector<int> style_choices(const Cast& cast);

// The scene's part of the window while these panels are open.
Viewport scene_viewport(const UiState& state, bool has_timeline, int width_px, int height_px,
                        double scale) noexcept;
// Call it between ImGui::NewFrame and ImGui::Render. It does not change panels, theme and help; the
// returned actions do.
UiOutput draw_ui(const UiInput& input, const Theme& theme, const Fonts& fonts, double scale,
                 UiState& state);

// Moves UiMemory::focus; call it after everything was drawn.
void move_focus(const UiInput& input, UiMemory& memory);

// For tests and scripts: rectangles of the clickable items in the last drawn frame, in window
// pixels, by name ("panel pad", "close pad", "play", "slider speed_m_s"). Items that are scrolled
// out of sight are left out. "area pad" and similar names are panels; "left column", "top bar" and
// similar names are the areas that contain them.
struct UiItem {
  std::string name;
  ImVec2 min, max;
};
const std::vector<UiItem>& ui_items() noexcept;
// The texts of that frame as drawn, and the full texts of those that were cut.
const std::vector<std::string>& drawn_texts() noexcept;
const std::vector<std::string>& cut_texts() noexcept;

// The layout of the window: bars at top and bottom and a column of panels on each side of the
// scene; one column in a narrow window, none in a very narrow one.

struct UiRect {  // in pixels; an empty area is not shown
  float x = 0.0f, y = 0.0f, width = 0.0f, height = 0.0f;
  bool is_empty() const noexcept { return !(width > 0.0f && height > 0.0f); }
  ImVec2 min() const noexcept { return {x, y}; }
  ImVec2 max() const noexcept { return {x + width, y + height}; }
};
struct UiLayout {
  UiRect top, left, right, timeline, status, scene;
};
UiLayout ui_layout(const UiState& state, bool has_timeline, int width_px, int height_px,
                   double scale) noexcept;
// Height of the chips above the panels for this number of characters; 0 for one character.
float cast_height(int characters, float scale) noexcept;
// True if the panel is in the left column while there are two.
bool is_left(Panel panel) noexcept;

}  // namespace gaitpad
