// How long a file's unit is. BVH does not say, ASF not reliably; a leg does, since adults' legs are
// much alike.
#pragma once

namespace gaitpad {

// Hip to ankle of the adult that unknown units are scaled to.
inline constexpr double kAdultLegM = 0.84;

// Of m, dm, cm, mm, inch, foot and the CMU data base's unit (1 inch / 0.45) the one that makes the
// leg 0.65 to 1.05 m long (at most one does); where none fits, the unit that makes it kAdultLegM.
double metres_per_unit(double leg_length_units) noexcept;
// The same for a file that states its unit: that one wherever it makes a leg of 0.4 to 1.3 m, as of
// children and giants; else the file is wrong about it, as endorphin's are.
double metres_per_unit(double leg_length_units, double stated_unit_m) noexcept;

}  // namespace gaitpad
