// Checks the run-time inputs of advance() and standing(), and replaces those that are not sound.
#pragma once
#include "gaitpad/walk.h"

namespace gaitpad {

// a == b; fast for equal bits, the usual case.
bool is_same(const UpperBodyParams& a, const UpperBodyParams& b) noexcept;

// Whether all numbers are finite and within their ranges (control/params_range.h), or those of the
// last tick, which were.
bool is_sound(const GaitParams& params, const WalkState& state) noexcept;
inline bool is_sound_tick(double dt_s) noexcept {
  return dt_s >= kLeastTick_s && dt_s <= kMostTick_s;
}
// A longer tick is walked in equal parts: with coarser ticks one would see a foot land late.
constexpr double kLongestPart_s = 1.0 / 60.0;
inline int tick_parts(double dt_s) noexcept {
  constexpr double kRounding = 1e-6;  // a host's single precision
  return std::max(1, static_cast<int>(std::ceil(dt_s / kLongestPart_s - kRounding)));
}

// The parameters, with the value in force in place of each number that is not sound. Counts these.
GaitParams mended_params(const GaitParams& params, WalkState& state) noexcept;
// The last tick's length, in place of one that is not sound; counted.
double mended_tick(WalkState& state) noexcept;
// A coordinate of a place, or 0 if it is not sound.
double mended_place(double place_m, WalkState& state) noexcept;

}  // namespace gaitpad
