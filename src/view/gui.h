// Dear ImGui on the window: its context, the SDL2 and OpenGL 3 back ends, fonts, style and colours.
#pragma once
#include <imgui.h>

#include <string>

#include "draw/theme.h"
#include "view/controls.h"
#include "view/surface.h"

namespace gaitpad {

ImU32 packed(const Colour& colour) noexcept;
ImVec4 imgui_colour(const Colour& colour) noexcept;

struct Fonts {
  ImFont* body = nullptr;
  ImFont* small = nullptr;
  ImFont* tick = nullptr;
  ImFont* heading = nullptr;  // font of a panel's heading: as high as body, bolder
  ImFont* title = nullptr;
  std::string family;  // name of the fonts that were found: "DejaVu Sans", "built in"
};
// Loads the fonts into the current ImGui context, before its first frame, or between frames and
// followed by a rebuild of the font texture. Without a font file ImGui's own font is used.
Fonts load_fonts(double scale);
void apply_style(const Theme& theme, double scale);

// Returns `asked` if it is positive, else $GDK_SCALE, else (display's dots per inch) / 96 within
// 1 .. 3; 1 if all are unknown.
double display_scale(double asked, double dots_per_inch) noexcept;

class Gui {
 public:
  explicit Gui(const WindowSurface& surface);  // Only one Gui may exist at a time.
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  const Fonts& fonts() const noexcept { return fonts_; }
  void apply(const Theme& theme);
  // Changes the size of type and of everything else; call it between frames.
  void set_scale(double scale);
  void handle_event(const SDL_Event& event);
  TakenInput taken_input() const noexcept;
  // `passed_s` > 0 replaces ImGui's measured time, for pictures.
  void begin(const Mouse& mouse, double passed_s);
  void end();  // Draws into the bound frame buffer.
  void end_undrawn();

 private:
  double scale_ = 1.0;
  Fonts fonts_;
};

}  // namespace gaitpad
