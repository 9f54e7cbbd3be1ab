// From one stylization state to the next over a time.
#pragma once
#include "control/style.h"

namespace gaitpad {

// All values part of the way from `from` (share 0) to `to` (share 1, exactly that).
StyleValues mixed(const StyleValues& from, const StyleValues& to, double share) noexcept;

// Plain, trivially copyable.
struct StyleBlend {
  StyleValues from;
  double length_s = 0.0, passed_s = 0.0;  // over: as long as it has passed
};
// From what is in force towards another style, which takes the longer of both styles' blend_s.
StyleBlend begun_blend(const StyleValues& in_force, const StyleValues& before,
                       const StyleValues& after) noexcept;
// What is in force after dt more seconds. Its own when it is over.
StyleValues advance(StyleBlend& blend, const StyleValues& to, double dt_s) noexcept;

}  // namespace gaitpad
