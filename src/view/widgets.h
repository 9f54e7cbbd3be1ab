// What bars and panels are made of: text that stays in its place, buttons, sliders, rows. An `id`
// is always the program's own word, never a stranger's; it is also the name in ui_items().
#pragma once
#include <imgui.h>

#include <optional>
#include <string>
#include <string_view>

#include "view/plot.h"
#include "view/ui.h"

namespace gaitpad {

// All that a part of the picture reads and answers with.
struct Ui {
  const UiInput& in;
  const Theme& theme;
  const Fonts& fonts;
  float scale;
  UiState& state;
  UiOutput& out;

  float px(double at_scale_1) const noexcept { return static_cast<float>(at_scale_1) * scale; }
  bool is_live() const noexcept { return in.timeline == nullptr; }
  // The walker that panels tell of: the chosen one, else the first; -1: there is none.
  int walker() const noexcept;
  PlotStyle plot_style() const noexcept { return {&theme, &fonts, scale}; }
};

inline Colour with_alpha(Colour colour, double alpha) noexcept {
  colour.alpha = alpha;
  return colour;
}

// Text.
float text_width(const ImFont* font, std::string_view text);
// At `at`, one line; what is wider than `max_width` ends with an ellipsis. Text of strangers is
// fit.
void put_text(ImDrawList& list, const ImFont* font, const Colour& colour, const ImVec2& at,
              std::string_view text, float max_width);
// The same at the cursor, over the rest of the row or `max_width`.
void text_line(Ui& ui, const ImFont* font, const Colour& colour, std::string_view text,
               float max_width = 0.0f);
// A label at the left and a value at the right end of a row; the label gives way.
void value_row(Ui& ui, std::string_view label, std::string_view value);
// Small grey words over as many lines as they need, at most `max_lines`.
void note(Ui& ui, std::string_view text, int max_lines = 3);
// At most `max_lines` lines no wider than `width`; a longer text's last one goes on past it, for
// put_text() to end.
std::vector<std::string> text_lines(const ImFont* font, std::string_view text, float width,
                                    int max_lines);

// For ui_items(): the last widget, or a rectangle, as far as it is to be seen.
void clear_items();
void keep_item(std::string_view name);
void keep_item(std::string_view name, const ImVec2& min, const ImVec2& max);
void keep_area(std::string_view name, const ImVec2& min, const ImVec2& max);  // no widget

enum class Icon { none, play, pause, record, stop, close, to_begin, step, loop };
void draw_icon(ImDrawList& list, Icon icon, const ImVec2& middle, float radius, ImU32 colour);
struct ButtonLook {
  Icon icon = Icon::none;
  bool is_on = false;       // pressed in, open
  bool is_primary = false;  // the one that is wanted most
  bool is_enabled = true;
  float width = 0.0f;   // 0: as the label needs
  float height = 0.0f;  // 0: of a row
  std::optional<Colour> dot;
};
float button_width(const Ui& ui, std::string_view label, const ButtonLook& look);
bool button(Ui& ui, std::string_view id, std::string_view label, const ButtonLook& look = {});

// A slider over the rest of the row, or `width`. `mark`: a notch, for instance the stick's value.
struct SliderLook {
  double min = 0.0, max = 1.0;
  int decimals = 2;
  std::optional<double> mark;
  bool is_changed = false;  // outlined
  bool is_enabled = true;
  float width = 0.0f;
  std::string_view letter;  // in front of the number: "L"
};
// True in frames in which the person moved it; the value then has as many decimals as it shows.
// While it is held `value` is the person's.
bool slider(Ui& ui, std::string_view id, double& value, const SliderLook& look);

// The value to be shown for `name`: the person's where the session has it not yet.
double wished(Ui& ui, const std::string& name, double value);
void wish(Ui& ui, const std::string& name, double value);
void forget_wish(Ui& ui, const std::string& name);  // "": all
// `set 2 KEY VALUE`, without a number for all; the value as short as reads back the same.
void send(Ui& ui, std::string_view verb, std::string_view rest);
void send(Ui& ui, std::string_view verb, std::string_view key, double value);

Colour walker_colour(const Ui& ui, int walker);
// "2 stiff_hip": its number and the style it walks in now.
std::string walker_name(const Ui& ui, int walker);
std::string style_name(const Ui& ui, int style_index);

// A box in the middle of the window, over everything else, which is veiled.

// Its size at scale 1, at most that of the window. To be followed by end_modal(), whatever is
// drawn. `id` also names it in ui_items(): "area ID". The box's size in pixels.
ImVec2 begin_modal(Ui& ui, const char* id, double width, double height, const ImVec2& window_px);
void end_modal();

}  // namespace gaitpad
