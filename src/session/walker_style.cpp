#include "session/walker_style.h"

#include "gaitpad/style.h"

namespace gaitpad {
namespace {

void change_style(Walker& w, int style, const StyleValues& values) noexcept {
  w.blend = begun_blend(w.in_force, w.values, values);
  w.style = style;
  w.values = values;
}

// Of several the last one; -1: none.
int zone_at(const Terrain& terrain, const vec3& place_m) noexcept {
  for (int i = static_cast<int>(terrain.zones.size()) - 1; i >= 0; --i) {
    const TerrainZone& zone = terrain.zones[static_cast<std::size_t>(i)];
    if (place_m.z >= zone.from_m && place_m.z <= zone.to_m && place_m.x >= zone.right_m &&
        place_m.x <= zone.left_m)
      return i;
  }
  return -1;
}

}  // namespace

void take_style(Walker& w, int style, std::span<const Style> styles) noexcept {
  w.zone.gives_back = false;
  change_style(w, style, styles[static_cast<std::size_t>(style)]);
}

void look_at_zones(Walker& w, const Terrain& terrain, std::span<const int> zone_styles,
                   std::span<const Style> styles) noexcept {
  if (terrain.zones.empty()) return;
  const int zone = zone_at(terrain, w.state.hips_m);
  if (zone == w.zone.index) return;
  // From one zone straight into another the style from before both is kept.
  const bool has_own = w.zone.gives_back;
  const ZoneStyle before = w.zone;
  w.zone.index = zone;
  w.zone.gives_back = zone >= 0;
  if (zone < 0) {
    if (has_own) change_style(w, before.own_style, before.own_values);
    return;
  }
  if (!has_own) {
    w.zone.own_style = w.style;
    w.zone.own_values = w.values;
  }
  const int style = zone_styles[static_cast<std::size_t>(zone)];
  change_style(w, style, styles[static_cast<std::size_t>(style)]);
}

StyleValues style_of_tick(Walker& w, double dt_s) noexcept {
  w.in_force = advance(w.blend, with_fatigue(w.values, w.tired), dt_s);
  return w.in_force;
}

void restart_style(Walker& w, std::span<const Style> styles) noexcept {
  if (w.zone.gives_back) w.style = w.zone.own_style;
  w.values = w.in_force = styles[static_cast<std::size_t>(w.style)];
  w.zone = {};
  w.blend = {};
  w.tired = 0.0;
}

}  // namespace gaitpad
