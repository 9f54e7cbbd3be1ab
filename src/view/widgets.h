// The elements of bars and panels: text, buttons, icons, sliders, rows, modal boxes. An `id` is
// always a constant of the program, never text from outside; it is also the name in ui_items().
#pragma once
#include <imgui.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "view/plot.h"
#include "view/ui.h"

namespace gaitpad {

// The input and output that all parts of the user interface share.
struct Ui {
  const UiInput& in;
  const Theme& theme;
  const Fonts& fonts;
  float scale;
  UiState& state;
  UiOutput& out;

  float px(double at_scale_1) const noexcept { return static_cast<float>(at_scale_1) * scale; }
  bool is_live() const noexcept { return in.timeline == nullptr; }
  // The walker that panels show: the selected one, else the first; -1: none.
  int walker() const noexcept;
  // The walkers whose values panels show and change: the selected one, else all.
  std::span<const WalkerFrame> selected() const noexcept;
  PlotStyle plot_style() const noexcept { return {&theme, &fonts, scale}; }
};

inline Colour with_alpha(Colour colour, double alpha) noexcept {
  colour.alpha = alpha;
  return colour;
}

// Both numbers with their signs and two decimals; `-` for one that is not finite. Zero is +0.00 on
// either side of it.
std::string signed_pair(const vec2& v);

float text_width(const ImFont* font, std::string_view text);
// Draws one line at `at`, after drawable(); text wider than `max_width` is cut and ends with `...`.
void put_text(ImDrawList& list, const ImFont* font, const Colour& colour, const ImVec2& at,
              std::string_view text, float max_width);
// Draws one line of text at the cursor; its width is limited by the rest of the row or `max_width`.
void text_line(Ui& ui, const ImFont* font, const Colour& colour, std::string_view text,
               float max_width = 0.0f);
// A label at the left and a value at the right end of a row, or of two rows if one is too narrow.
void value_row(Ui& ui, std::string_view label, std::string_view value);
// Small grey text over at most `max_lines` lines.
void note(Ui& ui, std::string_view text, int max_lines = 3);
// A bar over the rest of the row, filled to `done`, 0 to 1; its colour changes at 1.
void progress_bar(Ui& ui, double done);
// Breaks the text into at most `max_lines` lines of this width. The last line holds the rest, which
// put_text() cuts.
std::vector<std::string> text_lines(const ImFont* font, std::string_view text, float width,
                                    int max_lines);

// Clears the list of ui_items(). The functions below add the last widget or a rectangle to it,
// clipped to the visible part.
void clear_items();
void keep_item(std::string_view name);
void keep_item(std::string_view name, const ImVec2& min, const ImVec2& max);
// Adds an area that is not a widget.
void keep_area(std::string_view name, const ImVec2& min, const ImVec2& max);
// Makes the last widget reachable by keys and pad. Returns true if it has the focus, and outlines
// it.
bool is_focused(Ui& ui, std::string_view name);
// True if the key was pressed (by its engraved letter); Enter only while no item has the focus.
bool is_typed(const Ui& ui, SDL_Keycode key);
// Explains the last widget while the pointer rests on it (view/tooltips.h).
void explain(Ui& ui, std::string_view item);
// Shows `text` as the tip of the last widget while the pointer rests on it.
void show_tip(Ui& ui, std::string_view text);
// Records and explains a rectangle that is not a widget: a graph, a picture.
void keep_picture(Ui& ui, std::string_view name, const ImVec2& min, const ImVec2& max);

enum class Icon { none, play, pause, record, stop, close, to_begin, step, loop };
void draw_icon(ImDrawList& list, Icon icon, const ImVec2& middle, float radius, ImU32 colour);
struct ButtonLook {
  Icon icon = Icon::none;
  bool is_on = false;       // drawn as a button that is switched on
  bool is_primary = false;  // the most important button
  bool is_enabled = true;
  float width = 0.0f;   // width in pixels; 0: as wide as the label
  float height = 0.0f;  // height in pixels; 0: as high as a row
  std::optional<Colour> dot;
};
float button_width(const Ui& ui, std::string_view label, const ButtonLook& look);
bool button(Ui& ui, std::string_view id, std::string_view label, const ButtonLook& look = {});

// A slider as wide as the rest of the row, or `width`. `mark` draws a notch, for example at the
// stick's value.
struct SliderLook {
  double min = 0.0, max = 1.0;
  int decimals = 2;
  std::optional<double> mark;
  bool is_changed = false;  // outlined, because the value was changed
  bool is_mixed = false;    // the characters have different values
  bool is_enabled = true;
  float width = 0.0f;
  std::string_view letter;  // shown before the number, for example "L"
};
// Returns true in frames in which the user moved it; `value` is then rounded to `decimals`. While
// the slider is dragged, `value` is the user's.
bool slider(Ui& ui, std::string_view id, double& value, const SliderLook& look);

// The value to show for `name`: the user's until the session has applied it, then `value`. None:
// the characters have different values.
std::optional<double> pending_value(Ui& ui, const std::string& name, std::optional<double> value);
void remember_pending(Ui& ui, const std::string& name, double value);
// Forgets the user's value for `name`; "": of all sliders.
void forget_pending(Ui& ui, const std::string& name);
// Sends `VERB 2 KEY VALUE` to the session, without the number if all characters are selected. The
// value has the fewest digits that read back exactly.
void send(Ui& ui, std::string_view verb, std::string_view rest);
void send(Ui& ui, std::string_view verb, std::string_view key, double value);

Colour walker_colour(const Ui& ui, int walker);
// The number and the present style: "2 stiff_hip".
std::string walker_name(const Ui& ui, int walker);
std::string style_name(const Ui& ui, int style_index);

// Opens a menu below the button that was drawn last.
void open_menu(const char* name);
bool is_menu_open() noexcept;
void close_menus() noexcept;

// Begins a box in the middle of the window and darkens everything else; end it with end_modal().
// The size is at scale 1 and limited by the window; returns it in pixels. ui_items() has the box as
// "area ID".
ImVec2 begin_modal(Ui& ui, const char* id, double width, double height, const ImVec2& window_px);
void end_modal();

}  // namespace gaitpad
