#include "draw/theme.h"

namespace gaitpad {

namespace {

constexpr std::array<Colour, 8> kSeries = {
    rgb(0x56b4e9), rgb(0xe69f00), rgb(0x009e73), rgb(0xcc79a7),
    rgb(0xd8680f), rgb(0x348fc2), rgb(0xf0e442), rgb(0x999999),
};
// Darker colours, for thin lines and numbers on white.
constexpr std::array<Colour, 8> kSeriesOnLight = {
    rgb(0x2474a7), rgb(0x986400), rgb(0x007e5c), rgb(0xa65381),
    rgb(0xb74f00), rgb(0x005d94), rgb(0x7a7000), rgb(0x6f6f6f),
};

constexpr Theme dark_theme() {
  Theme t;
  t.name = ThemeName::dark;
  t.window = rgb(0x16191f);
  t.bar = rgb(0x16191f);
  t.panel = rgb(0x1b1f26);
  t.card = rgb(0x22272f);
  t.plot = rgb(0x14171c);
  t.frame = rgb(0x2a303a);
  t.border = rgb(0x303744);
  t.edge = rgb(0x707a8a);
  t.text = rgb(0xe6e9ee);
  t.secondary = rgb(0xa9b2bf);
  t.tick = rgb(0x8f98a6);
  t.accent = rgb(0x2f6f9b);
  t.good = rgb(0x2fc79a);
  t.warning = rgb(0xe69f00);
  t.bad = rgb(0xe8743b);
  t.sky_top = {.125, .141, .168};
  t.sky_bottom = {.205, .228, .268};
  t.floor = {.285, .308, .345};
  t.floor_far = {.205, .226, .262};
  t.riser = {.62, .53, .43};
  t.nose = {.72, .74, .76};
  t.grid = {.47, .51, .57};
  t.bone = rgb(0xd5dae2);
  t.series = kSeries;
  t.left = rgb(0x56b4e9);
  t.right = rgb(0xe69f00);
  t.axis_x = rgb(0xe8743b);
  t.axis_y = rgb(0x2fc79a);
  t.axis_z = rgb(0x56b4e9);
  return t;
}

constexpr Theme light_theme() {
  Theme t;
  t.name = ThemeName::light;
  t.window = rgb(0xe9ebef);
  t.bar = rgb(0xfbfcfd);
  t.panel = rgb(0xf4f5f7);
  t.card = rgb(0xffffff);
  t.plot = rgb(0xffffff);
  t.frame = rgb(0xe2e6eb);
  t.border = rgb(0xd5d9df);
  t.edge = rgb(0x7b838e);
  t.text = rgb(0x1d2430);
  t.secondary = rgb(0x4a5362);
  t.tick = rgb(0x666e7a);
  t.accent = rgb(0x2d7baf);
  t.good = rgb(0x007e5c);
  t.warning = rgb(0x986000);
  t.bad = rgb(0xb74f00);
  t.sky_top = {.86, .89, .93};
  t.sky_bottom = {.95, .96, .97};
  t.floor = {.83, .85, .88};
  t.floor_far = {.92, .93, .95};
  t.riser = {.60, .66, .75};
  t.nose = {.36, .42, .52};
  t.grid = {.62, .66, .71};
  t.bone = rgb(0x4a5362);
  t.series = kSeriesOnLight;
  t.left = rgb(0x2474a7);
  t.right = rgb(0x986400);
  t.axis_x = rgb(0xc25400);
  t.axis_y = rgb(0x00805d);
  t.axis_z = rgb(0x2b8cc9);
  return t;
}

constexpr Theme kDark = dark_theme(), kLight = light_theme();

}  // namespace

const Theme& theme_of(ThemeName name) noexcept { return name == ThemeName::dark ? kDark : kLight; }

const Colour& series_colour(const Theme& theme, std::size_t index) noexcept {
  return theme.series[index % theme.series.size()];
}

}  // namespace gaitpad
