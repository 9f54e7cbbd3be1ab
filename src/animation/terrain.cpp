#include "animation/terrain.h"

namespace gaitpad {

Ground ground_at(const Terrain&, double, double) noexcept { return {}; }

std::shared_ptr<const Terrain> flat_terrain() {
  static const auto kFlat = std::make_shared<const Terrain>();
  return kFlat;
}

}  // namespace gaitpad
