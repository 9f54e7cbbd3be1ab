// Which samples of a stick lie on its gate, in polar coordinates, and straight lines through them.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "stick/outline.h"

namespace gaitpad {

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
