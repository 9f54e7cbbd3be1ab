// Who walks far tires, who stands recovers: a share of fatigue on top of the style's own.
#pragma once
#include "control/style.h"

namespace gaitpad {

// One tick more: linear in the way and in the time of rest, from 0 to 1. A style without a fatigue
// model leaves it as it is.
double tired(double before, const StyleValues& style, double way_m, bool is_resting,
             double dt_s) noexcept;
// The style with `tired` added to its fatigue, at most 1, where it has a fatigue model.
StyleValues with_fatigue(const StyleValues& style, double tired) noexcept;

}  // namespace gaitpad
