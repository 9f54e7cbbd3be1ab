#include "control/style_blend.h"

#include "base/math.h"

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

}  // namespace gaitpad
