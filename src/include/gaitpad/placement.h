// A frame in the world, in which a walk is computed.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

// The greatest coordinate of a place in the world, positive or negative.
inline constexpr double kFarthest_m = 1e6;

// A frame in the world, turned by `heading_rad` about the vertical through its origin, which is at
// `place_m`.
struct Placement {
  vec3 place_m{0.0};         // place of the origin in the world; each coordinate at most
                             // kFarthest_m
  double heading_rad = 0.0;  // turn to the left, radians, at most kFarthest_m
  bool operator==(const Placement&) const = default;
};
// Convert a place from the frame to the world, and back.
vec3 to_world(const Placement& placed, const vec3& place_m) noexcept;
vec3 from_world(const Placement& placed, const vec3& world_m) noexcept;
// `placed` after the world has been turned and shifted by `by`.
Placement moved(const Placement& by, const Placement& placed) noexcept;

}  // namespace gaitpad
