// Constants for guessing a foot's sole from its joints: captures have no joint at the heel, some
// have no toe. Lengths are shares of the leg (thigh + shank) unless the comment says otherwise.
#pragma once
#include "gaitpad/math.h"

namespace gaitpad {

inline constexpr double kHeelShare = 0.3;           // heel behind the ankle, share of ankle to toe
inline constexpr double kShortestFoot_legs = 0.04;  // length below which a foot has no toe joint
inline bool is_short_foot(const vec3& from_ankle_m, double leg_m) noexcept {
  return horizontal_length(from_ankle_m) < kShortestFoot_legs * leg_m;
}
inline constexpr double kOwnToe_legs = 0.155;     // ankle to ball of a foot without toe joint
inline constexpr double kLeastAnkle_legs = 0.02;  // least height of the ankle above the sole
// Flat feet are slow and low: their score adds the speeds of ankle and toe and this rate times
// their heights, so 1 m of height counts as 14 m/s.
inline constexpr double kFlatRate_per_s = 14.0;

}  // namespace gaitpad
