// The line along which a stick can go, its gate, found from tracks that went round it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "stick/stick_track.h"

namespace gaitpad {

inline constexpr int kOutlineDirections = 192;  // evenly, the first one to the right
inline constexpr int kCircularityBins = 48;     // bin k is centred on k times 7.5 degrees

struct Outline {
  vec2 middle{0.0};  // raw, from where the directions are counted
  // Radius by direction, counter-clockwise from +x; 0: not seen.
  std::array<double, kOutlineDirections> radius{};
  std::int64_t samples = 0;  // that it rests on
};
// `sigma`: the noise of one position, so that the outermost of many samples is not taken for the
// gate. Spikes are left out.
Outline outline_of(std::span<const StickTrack> tracks, const vec2& middle, double sigma);

// How many of the 48 bins about the middle the outline covers.
int filled_bins(const Outline& outline) noexcept;
// The ends of the outline to the left, right, back and front, raw; none where it was not seen
// there.
struct Reach {
  std::optional<double> min_x, max_x, min_y, max_y;
};
Reach reach_of(const Outline& outline) noexcept;
// 48 bins about the *raw* middle, the greatest radius of each: 100 sqrt(mean((r - 1)^2)) over those
// above 0.2 (dualshock-tools' formula). None where the outline has holes.
std::optional<double> circularity_error(const Outline& outline) noexcept;

}  // namespace gaitpad
