// The stick's gate: the line to which it can be pushed in every direction, found from tracks in
// which the stick was turned along its rim.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "stick/stick_track.h"

namespace gaitpad {

inline constexpr int kOutlineDirections = 192;  // evenly spaced, the first one to the right
inline constexpr int kCircularityBins = 48;     // bin k is centred on k times 7.5 degrees

struct Outline {
  vec2 middle{0.0};  // raw position from which the directions start
  // Raw radius by direction, counter-clockwise from +x; 0: not seen.
  std::array<double, kOutlineDirections> radius{};
  std::int64_t samples = 0;  // number of samples from which it was made
};
// `sigma`: noise of one position, so that the outermost of many samples is not taken for the gate.
// Spikes are left out.
Outline outline_of(std::span<const StickTrack> tracks, const vec2& middle, double sigma);
// The raw point of the outline in direction k (modulo the number of directions).
vec2 point_of(const Outline& outline, int k) noexcept;

// The direction in which the outline reaches least far; none if no direction was seen.
std::optional<int> worst_direction(const Outline& outline) noexcept;
// The direction in which the outline lies deepest (by more than 0.1) inside its convex hull, as if
// the stick was turned there without being pressed to its rim; none if there is no such direction.
// Directions in which a push (`pushes`: raw) was held and reached no farther are left out: there
// the gate itself is short.
std::optional<int> unpressed_direction(const Outline& outline, std::span<const vec2> pushes);
// The least radius of the directions in each of the 48 bins about the middle; 0: not seen.
std::array<double, kCircularityBins> least_reaches(const Outline& outline) noexcept;

// Whole degrees of direction k from the right, counter-clockwise.
int degrees_of(int k) noexcept;
// "front left (135 degrees from the right)"
std::string direction_text(int k);

// The number of bins, of 48 about the middle, in which the outline was seen.
int filled_bins(const Outline& outline) noexcept;
// The raw ends of the outline to the left, right, back and front; none if it was not seen there.
struct Reach {
  std::optional<double> min_x, max_x, min_y, max_y;
};
Reach reach_of(const Outline& outline) noexcept;
// Percent, by the formula of dualshock-tools: 48 bins about the *raw* middle, the greatest radius r
// of each, 100 sqrt(mean((r - 1)^2)) over those above 0.2. None if the outline has holes.
using CircularityBins = std::array<double, kCircularityBins>;
std::optional<double> circularity_error(const CircularityBins& greatest) noexcept;
std::optional<double> circularity_error(const Outline& outline) noexcept;

// Whole turns round the middle beyond `radius` (raw); turns in both directions count.
int whole_turns(std::span<const StickTrack> tracks, const vec2& middle, double radius);

}  // namespace gaitpad
