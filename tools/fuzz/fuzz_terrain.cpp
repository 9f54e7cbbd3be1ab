// libFuzzer target: a terrain's text, or a height picture's bytes. An accepted terrain has a finite
// height and a unit normal at any place.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "files/height_picture.h"
#include "gaitpad/config_files.h"

namespace {

using namespace gaitpad;

void check_ground(const Terrain& terrain) {
  const double end_m = length_m(terrain) + 1.0;
  for (int i = 0; i <= 64; ++i) {
    const double z_m = -1.0 + (end_m + 1.0) * i / 64.0;
    for (const double x_m : {-1e9, -0.7, 0.0, 3.1}) {
      const Ground ground = ground_at(terrain, x_m, z_m);
      if (!std::isfinite(ground.height_m)) std::abort();
      if (!(std::fabs(glm::length(ground.normal) - 1.0) < 1e-9)) std::abort();
      // Y of the normal on a slope of 0.6, the steepest that is allowed, is 0.857.
      if (!(ground.normal.y > 0.85)) std::abort();
    }
    const Stretch piece = piece_at(terrain, z_m);
    if (!(piece.from_m <= z_m && z_m <= piece.to_m)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto picture = height_picture(text, "fuzz.png")) {
    const auto samples =
        static_cast<std::size_t>(picture->columns) * static_cast<std::size_t>(picture->rows);
    if (picture->samples.size() != samples) std::abort();
  }
  const auto terrain = parsed_terrain(text, "no/such/folder/fuzz.toml");
  if (!terrain) return 0;
  check_ground(*terrain);
  check_ground(scaled(*terrain, 1.7));
  return 0;
}
