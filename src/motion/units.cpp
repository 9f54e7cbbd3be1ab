#include "motion/units.h"

namespace gaitpad {

double metres_per_unit(double leg_length_units) noexcept {
  constexpr double kMinLegM = 0.65, kMaxLegM = 1.05;
  constexpr double kUnitsM[] = {1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.0254 / 0.45};
  for (const double unit_m : kUnitsM) {
    const double leg_m = leg_length_units * unit_m;
    if (leg_m >= kMinLegM && leg_m <= kMaxLegM) return unit_m;
  }
  return kAdultLegM / leg_length_units;
}

double metres_per_unit(double leg_length_units, double stated_unit_m) noexcept {
  constexpr double kMinLegM = 0.4, kMaxLegM = 1.3;
  const double leg_m = leg_length_units * stated_unit_m;
  return leg_m >= kMinLegM && leg_m <= kMaxLegM ? stated_unit_m : metres_per_unit(leg_length_units);
}

}  // namespace gaitpad
