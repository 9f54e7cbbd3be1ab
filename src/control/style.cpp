#include "gaitpad/style.h"

#include <algorithm>

#include "gaitpad/math.h"

namespace gaitpad {

StyleBlend begun_blend(const StyleValues& in_force, const StyleValues& before,
                       const StyleValues& after) noexcept {
  return {in_force, std::max(before.blend_s, after.blend_s), 0.0};
}

StyleValues advance(StyleBlend& blend, const StyleValues& to, double dt_s) noexcept {
  if (!(blend.passed_s < blend.length_s)) return to;
  blend.passed_s += dt_s;
  return mixed(blend.from, to, smoothstep(0.0, blend.length_s, blend.passed_s));
}

double tired(double before, const StyleValues& style, double way_m, bool is_resting,
             double dt_s) noexcept {
  const double change =
      is_resting ? -style.fatigue_recovery_per_s * dt_s : style.fatigue_per_100_m * way_m / 100.0;
  return std::clamp(before + change, 0.0, 1.0);
}

StyleValues with_fatigue(const StyleValues& style, double tired) noexcept {
  const bool has_model = style.fatigue_per_100_m > 0.0 || style.fatigue_recovery_per_s > 0.0;
  StyleValues tiring = style;
  if (has_model) tiring.fatigue = std::min(style.fatigue + tired, 1.0);
  return tiring;
}

}  // namespace gaitpad
