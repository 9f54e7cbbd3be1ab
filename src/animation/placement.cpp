#include "gaitpad/placement.h"

namespace gaitpad {

vec3 to_world(const Placement& placed, const vec3& place_m) noexcept {
  return placed.place_m + rotation_y(placed.heading_rad) * place_m;
}

vec3 from_world(const Placement& placed, const vec3& world_m) noexcept {
  return glm::conjugate(rotation_y(placed.heading_rad)) * (world_m - placed.place_m);
}

Placement moved(const Placement& by, const Placement& placed) noexcept {
  return {to_world(by, placed.place_m), by.heading_rad + placed.heading_rad};
}

}  // namespace gaitpad
