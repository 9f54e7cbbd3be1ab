// The ground that a character walks on: its height, its slope and its edges at any place.
// Meredith & Maddock 2005, section 3.3: "examination of the surrounding terrain", uneven ground,
// climbing and descending steps.
#pragma once
#include <memory>
#include <string>

#include "base/math.h"

namespace gaitpad {

// What a probe finds under a place.
struct Ground {
  double height_m = 0.0;
  vec3 normal = kUp;  // unit
  int piece = 0;      // where it changes between two places, an edge (a riser) lies between them
};

// Immutable after load. World frame: characters start at z = 0 and walk along +z.
struct Terrain {
  std::string name = "flat";
};

// Total: any place has a ground. No heap.
Ground ground_at(const Terrain& terrain, double x_m, double z_m) noexcept;

// One plane at height 0, shared by all that walk on it.
std::shared_ptr<const Terrain> flat_terrain();

}  // namespace gaitpad
