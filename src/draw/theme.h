// The window's colours, dark and light. Characters and curves use Okabe and Ito's palette, which is
// distinguishable with any colour vision.
#pragma once
#include <array>
#include <cstdint>

#include "draw/picture.h"

namespace gaitpad {

enum class ThemeName : std::uint8_t { dark, light };

// Text has a contrast of at least 4.5, edges of controls of 3 (tests/draw/theme_test.cpp).
struct Theme {
  ThemeName name = ThemeName::dark;
  Colour window, bar, panel, card, plot, frame, border;
  Colour edge;  // edges of buttons, sliders and fields
  Colour text, secondary, tick, accent, good, warning, bad;
  Colour sky_top, sky_bottom, floor, floor_far, riser, nose, grid, bone;  // colours of the scene
  std::array<Colour, 8> series;  // colours of characters and curves, used in turn
  Colour left, right, axis_x, axis_y, axis_z;
};
inline constexpr double kChosenShare = 0.35;  // share of the accent colour in selected items
// Share of `secondary` in the colour of a scroll bar's grab.
inline constexpr double kScrollShare = 0.65;

const Theme& theme_of(ThemeName name) noexcept;
const Colour& series_colour(const Theme& theme, std::size_t index) noexcept;

}  // namespace gaitpad
