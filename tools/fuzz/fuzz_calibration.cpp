// libFuzzer target: a calibration file. An accepted calibration must survive writing and reading
// unchanged, and no position that it gives leaves the unit disc.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gaitpad/calibration.h"

namespace {

using namespace gaitpad;

bool is_sound(const vec2& p) { return p.x * p.x + p.y * p.y <= 1.0 + 1e-12; }

void check_positions(const Calibration& c) {
  for (double x = -1.0; x <= 1.0; x += 0.25) {
    for (double y = -1.0; y <= 1.0; y += 0.25) {
      if (!is_sound(stick_position(c.left, {x, y})) || !is_sound(stick_position(c.right, {x, y})))
        std::abort();
    }
    const double left = trigger_position(c.left_trigger, x);
    if (!(left >= 0.0 && left <= 1.0)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto file = parse_calibration(text, "fuzz.toml");
  if (!file) return 0;
  const auto again = parse_calibration(calibration_text(*file), "again.toml");
  if (!again || !(*again == *file)) std::abort();
  check_positions(file->calibration);
  return 0;
}
