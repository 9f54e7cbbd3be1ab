// The line along which a stick can go, its gate, found from tracks that went round it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

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

// Which samples of a stick lie on its gate, in polar coordinates, and straight lines through them.

inline constexpr double kOutlineSpacing = 2.0 * kPi / kOutlineDirections;
using Radii = std::array<double, kOutlineDirections>;  // raw, by direction

struct Polar {
  double angle, radius;  // rad, raw
};

// Samples on the rim about `middle`, by angle 0..2 pi; those beside the seam stand again beyond the
// other end. Position noise `sigma`: a sample 3 sigma inside the running upper envelope still
// counts.
std::vector<Polar> rim_samples(std::span<const StickTrack> tracks, const vec2& middle,
                               double sigma);
// Those in [from, to) of samples that are ordered by angle.
std::span<const Polar> between(std::span<const Polar> samples, double from, double to);

// A straight line radius(angle) through samples.
struct Line {
  double samples = 0.0, angle = 0.0, radius = 0.0, slope = 0.0;  // the means; it passes there
  double spread = 0.0;    // sum of squared angles about the mean
  double residual = 0.0;  // mean square

  double at(double a) const noexcept { return radius + slope * (a - angle); }
};
// Least squares, no steeper than a gate can be.
Line line_through(std::span<const Polar> samples) noexcept;
// How far a sample's radius strays from a rim that is not at right angles to it; at least that of
// rounding to 8 bits.
double radial_noise(const Line& line, double sigma) noexcept;

vec2 unit_vector(double angle) noexcept;
// The outline's direction that is nearest.
int direction_of(double angle) noexcept;

}  // namespace gaitpad
