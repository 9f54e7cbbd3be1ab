// What advance() and standing() take of their run-time inputs.
#pragma once
#include "gaitpad/walk.h"

namespace gaitpad {

// a == b, and fast where not a bit differs, as most often.
bool is_same(const UpperBodyParams& a, const UpperBodyParams& b) noexcept;

// Whether all numbers are finite and within their ranges (control/params_range.h), or those of the
// last tick, which were.
bool is_sound(const GaitParams& params, const WalkState& state) noexcept;
inline bool is_sound_tick(double dt_s) noexcept {
  return dt_s >= kLeastTick_s && dt_s <= kMostTick_s;
}
// A long tick is walked in equal parts: a foot that lands at a coarse tick would be seen to.
constexpr double kLongestPart_s = 1.0 / 60.0;
inline int tick_parts(double dt_s) noexcept {
  constexpr double kRounding = 1e-6;  // a host's single precision
  return std::max(1, static_cast<int>(std::ceil(dt_s / kLongestPart_s - kRounding)));
}

// The parameters with what is in force in place of each number that is not sound. Counts them.
GaitParams mended_params(const GaitParams& params, WalkState& state) noexcept;
// The last tick's length, counted.
double mended_tick(WalkState& state) noexcept;
// A coordinate of a place, or 0.
double mended_place(double place_m, WalkState& state) noexcept;

}  // namespace gaitpad
