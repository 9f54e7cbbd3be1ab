// Colours, type and measures of the window: dark and light, at any display scale. Colours of
// characters and curves are Okabe and Ito's, which every eye tells apart.
#pragma once
#include <imgui.h>

#include <array>
#include <string>

#include "view/drawing.h"

namespace gaitpad {

enum class ThemeName : std::uint8_t { dark, light };

struct Theme {
  ThemeName name = ThemeName::dark;
  Colour window, bar, panel, card, plot, frame, border;
  Colour text, secondary, tick, accent, good, warning, bad;
  Colour sky_top, sky_bottom, floor, floor_far, grid, bone;  // of the scene
  std::array<Colour, 8> series;  // characters, curves: the n-th takes the n-th, then again
  Colour left, right, axis_x, axis_y, axis_z;
};
const Theme& theme_of(ThemeName name) noexcept;
const Colour& series_colour(const Theme& theme, std::size_t index) noexcept;
ImU32 packed(const Colour& colour) noexcept;
ImVec4 imgui_colour(const Colour& colour) noexcept;

struct Fonts {
  ImFont* body = nullptr;
  ImFont* small = nullptr;
  ImFont* tick = nullptr;
  ImFont* heading = nullptr;  // of a panel: as high as body, heavier
  ImFont* title = nullptr;
  std::string family;  // what was found: "Inter", "DejaVu Sans", "built in"
};
// For the current ImGui context, before its first frame or between frames with the font texture
// made anew after it. Without any font file the built-in one, scaled.
Fonts load_fonts(double scale);
void apply_style(const Theme& theme, double scale);

// `wish` where > 0, else $GDK_SCALE, else the display's dots per inch over 96, 1 .. 3; 1: unknown.
double display_scale(double wish, double dots_per_inch) noexcept;

}  // namespace gaitpad
