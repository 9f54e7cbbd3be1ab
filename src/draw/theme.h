// The window's colours, dark and light. Characters and curves have Okabe and Ito's palette, whose
// colours people with any colour vision can tell apart.
#pragma once
#include <array>
#include <cstdint>

#include "draw/picture.h"

namespace gaitpad {

enum class ThemeName : std::uint8_t { dark, light };

struct Theme {
  ThemeName name = ThemeName::dark;
  Colour window, bar, panel, card, plot, frame, border;
  Colour text, secondary, tick, accent, good, warning, bad;
  Colour sky_top, sky_bottom, floor, floor_far, riser, nose, grid, bone;  // of the scene
  std::array<Colour, 8> series;  // of characters and curves, used in turn
  Colour left, right, axis_x, axis_y, axis_z;
};
const Theme& theme_of(ThemeName name) noexcept;
const Colour& series_colour(const Theme& theme, std::size_t index) noexcept;

}  // namespace gaitpad
