// Checks the run-time inputs of advance() and standing(), and replaces those that are not sound.
#pragma once
#include "gaitpad/walk.h"

namespace gaitpad {

// True if all numbers are finite and within their ranges (control/params_range.h).
bool is_sound(const GaitParams& params) noexcept;
bool is_finite(const Placement& place) noexcept;
inline bool is_sound_tick(double dt_s) noexcept {
  return dt_s >= kLeastTick_s && dt_s <= kMostTick_s;
}
inline bool is_sound(Detail detail) noexcept {
  return detail == Detail::full || detail == Detail::tables;
}
// A longer tick is walked in equal parts; otherwise a foot would visibly land late.
constexpr double kLongestPart_s = 1.0 / 60.0;
inline int tick_parts(double dt_s) noexcept {
  constexpr double kRounding =
      1e-6;  // share of a part: tolerance for a host that computes in single precision
  return std::max(1, static_cast<int>(std::ceil(dt_s / kLongestPart_s - kRounding)));
}

// The parameters, with the values in force in place of numbers that are not sound. Counts those.
GaitParams mended_params(const GaitParams& params, WalkState& state) noexcept;
// A coordinate of a place, or 0 if it is not sound; counts that.
double mended_place(double place_m, WalkState& state) noexcept;

}  // namespace gaitpad
