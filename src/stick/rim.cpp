#include "stick/rim.h"

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

constexpr double kSpacing = kOutlineSpacing;
constexpr double kLeastRadius = 0.25;     // raw; nearer to the middle no gate is looked for
constexpr double kLeastNoise = 0.003;     // raw; rounding to 8 bits comes to 0.0023
constexpr double kSeam = 30.0 * kDegree;  // more than any window reaches
constexpr double kMeanOfUpperHalf = 0.8;  // of a Gaussian, in sigma

constexpr double kGreatestRadius = 4.0;  // more than from any middle to any corner of the range
constexpr double kInsideHull = 0.85;     // no gate bends inwards by more
constexpr double kSteepest = 2.0;        // slope over radius; at a square's corner it is 1
constexpr int kSteepReach = 8;           // directions; beyond, the hull is the better bound
constexpr double kLeastSpread = 0.1 * kSpacing * kSpacing;

// The rim is told from what lies inside it by lines over this half width: wide enough for two
// samples of the slowest pad's two turns, narrow enough for a corner.
constexpr double kSelectionWidth = 3.0 * kSpacing;
constexpr int kFewOfDirection = 8;
constexpr int kSelectionRounds = 6;         // it has settled after three or four
constexpr double kSelectionQuantile = 0.9;  // of the samples' heights: there the search begins
constexpr double kSigmas = 3.0;             // so far under the line a sample is still on the rim

// At the end of the range noise goes one way only. Beyond it would be half of the samples of a gate
// that ends there, on average by 0.8 sigma (of a gate further in fewer, by little less).
double without_end(double raw, double sigma) noexcept {
  return std::fabs(raw) < 1.0 ? raw : std::copysign(1.0 + kMeanOfUpperHalf * sigma, raw);
}

std::vector<Polar> polar_samples(std::span<const StickTrack> tracks, const vec2& middle,
                                 double sigma) {
  std::vector<Polar> samples;
  for (const StickTrack& track : tracks) {
    vec2 before(0.0);
    for (const StickSample& sample : track) {
      if (!std::isfinite(sample.raw.x) || !std::isfinite(sample.raw.y)) continue;
      // Most pads do not repeat themselves; the others are made alike.
      if (sample.raw == before) continue;
      before = sample.raw;
      const vec2 p =
          vec2(without_end(sample.raw.x, sigma), without_end(sample.raw.y, sigma)) - middle;
      const double radius = std::sqrt(p.x * p.x + p.y * p.y);
      if (!(radius > kLeastRadius)) continue;
      const double angle = gaitpad::atan2(p.y, p.x);
      samples.push_back({angle < 0.0 ? angle + 2.0 * kPi : angle, radius});
    }
  }
  return samples;
}

Radii greatest_of(const std::vector<Polar>& samples) noexcept {
  Radii greatest{};
  for (const Polar& p : samples) {
    double& g = greatest[direction_of(p.angle)];
    g = std::max(g, p.radius);
  }
  return greatest;
}

// Radius of the convex hull of the samples and the middle.
Radii hull_of(const Radii& greatest) noexcept {
  Radii cosine{}, support{}, hull{};
  for (int k = 0; k < kOutlineDirections; ++k) cosine[k] = unit_vector(k * kSpacing).x;
  for (int k = 0; k < kOutlineDirections; ++k) {
    for (int n = 0; n < kOutlineDirections; ++n) {
      support[k] = std::max(support[k], greatest[n] * cosine[std::abs(k - n)]);
    }
  }
  for (int k = 0; k < kOutlineDirections; ++k) {
    hull[k] = kGreatestRadius;
    for (int n = 0; n < kOutlineDirections; ++n) {
      const double c = cosine[std::abs(k - n)];
      if (c > 0.0) hull[k] = std::min(hull[k], support[n] / c);
    }
  }
  return hull;
}

// Radii below which nothing can be the rim: it would bend inwards, or from what was seen beside it
// fall off more steeply than a gate does.
Radii inside_of(const Radii& greatest, double sigma) {
  Radii inside = hull_of(greatest);
  for (double& radius : inside) radius = kInsideHull * radius - kSigmas * sigma;
  for (int k = 0; k < kOutlineDirections; ++k) {
    for (int n = -kSteepReach; n <= kSteepReach; ++n) {
      const int beside = (k + n + kOutlineDirections) % kOutlineDirections;
      // Both samples lie somewhere in their direction, and noise lifts one and lowers the other.
      const double least = greatest[beside] * (1.0 - kSteepest * kSpacing * (std::abs(n) + 1)) -
                           2.0 * (kSigmas * sigma + kLeastNoise);
      inside[k] = std::max(inside[k], least);
    }
  }
  return inside;
}

// By angle, and those beside the seam again beyond the other end.
std::vector<Polar> ordered(std::vector<Polar> samples) {
  const std::size_t count = samples.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Polar p = samples[i];
    if (p.angle < kSeam) samples.push_back({p.angle + 2.0 * kPi, p.radius});
    if (p.angle >= 2.0 * kPi - kSeam) samples.push_back({p.angle - 2.0 * kPi, p.radius});
  }
  std::sort(samples.begin(), samples.end(),
            [](const Polar& a, const Polar& b) { return a.angle < b.angle; });
  return samples;
}

// Upper envelope: from high up down until the samples under the line are no longer its noise.
Line envelope(std::span<const Polar> samples, double sigma) {
  Line line = line_through(samples);
  std::vector<double> heights;
  for (const Polar& p : samples) heights.push_back(p.radius - line.at(p.angle));
  const auto high =
      heights.begin() +
      static_cast<std::ptrdiff_t>(kSelectionQuantile * static_cast<double>(heights.size() - 1));
  std::nth_element(heights.begin(), high, heights.end());
  line.radius += *high;
  std::vector<Polar> chosen;
  for (int round = 0; round < kSelectionRounds; ++round) {
    const double allowed = kSigmas * radial_noise(line, sigma);
    chosen.clear();
    for (const Polar& p : samples) {
      if (p.radius >= line.at(p.angle) - allowed) chosen.push_back(p);
    }
    if (chosen.empty()) break;
    line = line_through(chosen);
  }
  return line;
}

// A stick that is held somewhere must not outweigh what lies beside it: so many a direction.
std::vector<Polar> thinned(const std::vector<Polar>& samples) {
  std::vector<Polar> few;
  for (auto first = samples.begin(); first != samples.end();) {
    const int k = direction_of(first->angle);
    const auto last = std::find_if(first, samples.end(),
                                   [k](const Polar& p) { return direction_of(p.angle) != k; });
    const auto stride = (last - first + kFewOfDirection - 1) / kFewOfDirection;
    for (auto i = 0 * stride; i < last - first; i += stride) few.push_back(first[i]);
    first = last;
  }
  return few;
}

// Those that are not the noise of the rim lie inside of it.
std::vector<Polar> rim_of(const std::vector<Polar>& samples, double sigma) {
  const std::vector<Polar> few = thinned(samples);
  std::vector<Polar> rim;
  for (int k = 0; k < kOutlineDirections; ++k) {
    const double angle = k * kSpacing;
    const auto own = between(samples, angle - 0.5 * kSpacing, angle + 0.5 * kSpacing);
    if (own.empty()) continue;
    const Line line =
        envelope(between(few, angle - kSelectionWidth, angle + kSelectionWidth), sigma);
    const double least = -kSigmas * radial_noise(line, sigma);
    for (const Polar& p : own) {
      if (p.radius - line.at(p.angle) < least) continue;
      rim.push_back({p.angle < 0.0 ? p.angle + 2.0 * kPi : p.angle, p.radius});
    }
  }
  return rim;
}

}  // namespace

vec2 unit_vector(double angle) noexcept {
  const SinCos s = sin_cos(angle);
  return {s.cos, s.sin};
}

int direction_of(double angle) noexcept {
  return static_cast<int>(std::lround(angle / kSpacing) + kOutlineDirections) % kOutlineDirections;
}

std::span<const Polar> between(std::span<const Polar> samples, double from, double to) {
  const auto is_below = [](const Polar& p, double angle) { return p.angle < angle; };
  const auto first = std::lower_bound(samples.begin(), samples.end(), from, is_below);
  return {first, std::lower_bound(first, samples.end(), to, is_below)};
}

Line line_through(std::span<const Polar> samples) noexcept {
  Line line;
  if (samples.empty()) return line;
  line.samples = static_cast<double>(samples.size());
  for (const Polar& p : samples) {
    line.angle += p.angle / line.samples;
    line.radius += p.radius / line.samples;
  }
  double product = 0.0;
  for (const Polar& p : samples) {
    line.spread += (p.angle - line.angle) * (p.angle - line.angle);
    product += (p.angle - line.angle) * (p.radius - line.radius);
  }
  // Samples of one place have no slope.
  const double steepest = kSteepest * line.radius;
  if (line.spread > kLeastSpread) {
    line.slope = std::clamp(product / line.spread, -steepest, steepest);
  }
  for (const Polar& p : samples) {
    const double off = p.radius - line.at(p.angle);
    line.residual += off * off / line.samples;
  }
  return line;
}

double radial_noise(const Line& line, double sigma) noexcept {
  const double steepness = line.slope / std::max(line.radius, kLeastRadius);
  return std::max(sigma * std::sqrt(1.0 + steepness * steepness), kLeastNoise);
}

std::vector<Polar> rim_samples(std::span<const StickTrack> tracks, const vec2& middle,
                               double sigma) {
  std::vector<Polar> samples = polar_samples(tracks, middle, sigma);
  const Radii inside = inside_of(greatest_of(samples), sigma);
  std::erase_if(samples, [&](const Polar& p) { return p.radius < inside[direction_of(p.angle)]; });
  return ordered(rim_of(ordered(std::move(samples)), sigma));
}

}  // namespace gaitpad
