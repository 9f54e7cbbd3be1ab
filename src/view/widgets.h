// What bars and panels are made of: text, buttons, icons, sliders, rows, modal boxes. An `id` is
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

// What every part of the user interface reads and writes.
struct Ui {
  const UiInput& in;
  const Theme& theme;
  const Fonts& fonts;
  float scale;
  UiState& state;
  UiOutput& out;

  float px(double at_scale_1) const noexcept { return static_cast<float>(at_scale_1) * scale; }
  bool is_live() const noexcept { return in.timeline == nullptr; }
  // The walker that panels show: the chosen one, else the first; -1: none.
  int walker() const noexcept;
  // Those whose values they show and change: the chosen one, else all.
  std::span<const WalkerFrame> selected() const noexcept;
  PlotStyle plot_style() const noexcept { return {&theme, &fonts, scale}; }
};

inline Colour with_alpha(Colour colour, double alpha) noexcept {
  colour.alpha = alpha;
  return colour;
}

float text_width(const ImFont* font, std::string_view text);
// Draws one line at `at`; text wider than `max_width` is cut and ends with `...`. Text from outside
// is made drawable first.
void put_text(ImDrawList& list, const ImFont* font, const Colour& colour, const ImVec2& at,
              std::string_view text, float max_width);
// The same at the cursor, at most as wide as the rest of the row or `max_width`.
void text_line(Ui& ui, const ImFont* font, const Colour& colour, std::string_view text,
               float max_width = 0.0f);
// A label at the left and a value at the right end of a row, or of two rows if one is too narrow.
void value_row(Ui& ui, std::string_view label, std::string_view value);
// Small grey text over at most `max_lines` lines.
void note(Ui& ui, std::string_view text, int max_lines = 3);
// A bar over the rest of the row that is filled as far as `done`, 0 to 1; in another colour at 1.
void progress_bar(Ui& ui, double done);
// Breaks the text into at most `max_lines` lines of this width. The last line holds all the rest,
// which put_text() then cuts.
std::vector<std::string> text_lines(const ImFont* font, std::string_view text, float width,
                                    int max_lines);

// Records, for ui_items(), the last widget or a rectangle, as far as it is visible.
void clear_items();
void keep_item(std::string_view name);
void keep_item(std::string_view name, const ImVec2& min, const ImVec2& max);
void keep_area(std::string_view name, const ImVec2& min, const ImVec2& max);  // not a widget
// Keys and pad reach the last widget by this name. True: they are there; it is outlined.
bool is_focused(Ui& ui, std::string_view name);
// Whether the key was pressed (by what is engraved on it); Enter only while nothing is focused.
bool is_typed(const Ui& ui, SDL_Keycode key);
// Explains the last widget while the pointer rests on it (view/tooltips.h).
void explain(Ui& ui, std::string_view item);
void show_tip(Ui& ui, std::string_view text);  // the same with another text
// Keeps and explains a rectangle that is no widget: a graph, a picture.
void keep_picture(Ui& ui, std::string_view name, const ImVec2& min, const ImVec2& max);

enum class Icon { none, play, pause, record, stop, close, to_begin, step, loop };
void draw_icon(ImDrawList& list, Icon icon, const ImVec2& middle, float radius, ImU32 colour);
struct ButtonLook {
  Icon icon = Icon::none;
  bool is_on = false;       // pressed in, open
  bool is_primary = false;  // the most important button
  bool is_enabled = true;
  float width = 0.0f;   // 0: by the label
  float height = 0.0f;  // 0: a row's height
  std::optional<Colour> dot;
};
float button_width(const Ui& ui, std::string_view label, const ButtonLook& look);
bool button(Ui& ui, std::string_view id, std::string_view label, const ButtonLook& look = {});

// A slider as wide as the rest of the row, or `width`. `mark`: a notch, for instance at the stick's
// value.
struct SliderLook {
  double min = 0.0, max = 1.0;
  int decimals = 2;
  std::optional<double> mark;
  bool is_changed = false;  // outlined
  bool is_mixed = false;    // the characters have different values
  bool is_enabled = true;
  float width = 0.0f;
  std::string_view letter;  // before the number, for instance "L"
};
// Returns true in frames in which the person moved it; the value then has the decimals that are
// shown. While the slider is dragged `value` is the person's.
bool slider(Ui& ui, std::string_view id, double& value, const SliderLook& look);

// The value to show for `name`: the person's, until the session has taken it over. None of both:
// the characters have different values.
std::optional<double> wished_value(Ui& ui, const std::string& name, std::optional<double> value);
void remember_wish(Ui& ui, const std::string& name, double value);
void forget_wish(Ui& ui, const std::string& name);  // "": all
// Sends `VERB 2 KEY VALUE` to the session, without the number for all characters. The value has the
// fewest digits that read back the same.
void send(Ui& ui, std::string_view verb, std::string_view rest);
void send(Ui& ui, std::string_view verb, std::string_view key, double value);

Colour walker_colour(const Ui& ui, int walker);
// The number and the present style: "2 stiff_hip".
std::string walker_name(const Ui& ui, int walker);
std::string style_name(const Ui& ui, int style_index);

// Menus that a button has opened.
bool is_menu_open() noexcept;
void close_menus() noexcept;

// Begins a box in the middle of the window and darkens everything else; end it with end_modal().
// The size is at scale 1 and limited by the window's; returns it in pixels. ui_items() has the box
// as "area ID".
ImVec2 begin_modal(Ui& ui, const char* id, double width, double height, const ImVec2& window_px);
void end_modal();

}  // namespace gaitpad
