// The ground in a walk's own coordinates. Sections are in these coordinates; a game's ground is
// asked for by its place in the world.
#pragma once
#include <array>

#include "gaitpad/placement.h"
#include "gaitpad/terrain.h"

namespace gaitpad {

struct Floor {
  const Terrain& terrain;
  const Placement& placed;
  // True if places have to be turned and shifted to those of the ground.
  bool is_moved() const noexcept {
    return terrain.asked.ask != nullptr && !(placed == Placement{});
  }
};
inline Ground ground_at(const Floor& floor, double x_m, double z_m) noexcept {
  const Placement& placed = floor.placed;
  if (!floor.is_moved()) return ground_at(floor.terrain, x_m, z_m);
  const vec3 at = to_world(placed, vec3(x_m, 0.0, z_m));
  Ground ground = ground_at(floor.terrain, at.x, at.z);
  ground.height_m -= placed.place_m.y;
  ground.normal = from_world({vec3(0.0), placed.heading_rad}, ground.normal);
  return ground;
}
// Heights of the ground at several places, at most kMostAsked.
template <std::size_t kPlaces>
std::array<double, kPlaces> heights_at(const Floor& floor,
                                       const std::array<vec3, kPlaces>& places) noexcept {
  static_assert(kPlaces <= kMostAsked);
  const Placement& placed = floor.placed;
  const bool moves = floor.is_moved();
  std::array<GroundPlace, kPlaces> asked;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const vec3 at = moves ? to_world(placed, vec3(places[i].x, 0.0, places[i].z)) : places[i];
    asked[i] = {at.x, at.z};
  }
  std::array<Ground, kPlaces> grounds;
  grounds_at(floor.terrain, asked, grounds);
  std::array<double, kPlaces> heights;
  for (std::size_t i = 0; i < kPlaces; ++i)
    heights[i] = moves ? grounds[i].height_m - placed.place_m.y : grounds[i].height_m;
  return heights;
}
inline Stretch piece_at(const Floor& floor, double z_m) noexcept {
  return piece_at(floor.terrain, z_m);
}

}  // namespace gaitpad
