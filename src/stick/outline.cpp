#include "stick/outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stick/rim.h"

namespace gaitpad {
namespace {

constexpr double kSpacing = kOutlineSpacing;
constexpr double kGreatestNoise = 0.2;  // raw; beyond that nothing is a rim
// The radius comes from the widest line that agrees with all narrower ones.
constexpr double kWidths[] = {1.0 * kSpacing, 1.5 * kSpacing, 2.0 * kSpacing, 3.0 * kSpacing,
                              4.0 * kSpacing, 6.0 * kSpacing, 8.0 * kSpacing};
// Standard errors: of the estimates among each other (less is noisy, more rounds the corners of a
// square: 1.5 gives the least circularity error over all made gates), and from the direction's own
// samples.
constexpr double kAgreement = 1.5, kOwnAgreement = 3.0;
constexpr double kGreatestError = 0.025;  // raw, one standard error; beyond it was not seen
constexpr int kGap = 3;                   // directions that are filled in between seen ones
constexpr double kSharp = 0.6;            // sine of the angle by which a corner turns at least

// A side's reach is known where the outline was seen this near to it, on both of its sides or
// straight there.
constexpr double kOfSide = 15.0 * kDegree, kStraight = 3.0 * kSpacing;
constexpr int kParts = 8;                        // of each piece of the outline, for the bins
constexpr double kLeastCircularityRadius = 0.2;  // dualshock-tools'
constexpr int kLeastFilledBins = 44;             // the error of fewer is another number

double cross(const vec2& a, const vec2& b) noexcept { return a.x * b.y - a.y * b.x; }

int around(int k) noexcept { return (k + kOutlineDirections) % kOutlineDirections; }

// What gates are made of: an arc about the middle is straight as radius over angle, an edge as it
// is.
enum class Piece { arc, edge };

// The rim about a direction, and the same in coordinates in which such a piece is straight: along
// it in (nearly) radians from the direction, and outwards.
struct Neighbourhood {
  double direction;
  std::span<const Polar> rim;
  std::array<std::vector<Polar>, 2> straight;  // arc, edge

  std::span<const Polar> window(Piece piece, double from, double to) const {
    const auto inner = between(rim, direction + from, direction + to);
    return {straight[static_cast<std::size_t>(piece)].data() + (inner.data() - rim.data()),
            inner.size()};
  }
};

Neighbourhood about(std::span<const Polar> all, double direction) {
  const double widest = std::end(kWidths)[-1];
  Neighbourhood n{direction, between(all, direction - widest, direction + widest), {}};
  double mean = 0.0;
  for (const Polar& p : n.rim) mean += p.radius / static_cast<double>(n.rim.size());
  for (const Polar& p : n.rim) {
    const vec2 u = unit_vector(p.angle - direction);
    n.straight[0].push_back({p.angle - direction, p.radius});
    n.straight[1].push_back({p.radius * u.y / mean, p.radius * u.x});
  }
  return n;
}

struct Estimate {
  double radius = 0.0, error = 1.0;  // standard error
  double width = 0.0;                // of the window
  double residual = 0.0;             // mean square
};

// The line passes amid the samples of the direction itself, not beside them.
bool agrees(const Line& line, std::span<const Polar> own, double sigma) noexcept {
  double off = 0.0;
  for (const Polar& p : own) off += (p.radius - line.at(p.angle)) / static_cast<double>(own.size());
  return std::fabs(off) <=
         kOwnAgreement * radial_noise(line, sigma) / std::sqrt(static_cast<double>(own.size()));
}

// Of growing windows from `left` to `right` times the width the last one before the estimates'
// intervals no longer meet: wide where the rim is smooth, narrow beside a corner (the intersection
// of confidence intervals; Katkovnik 1999).
Estimate adaptive(const Neighbourhood& n, Piece piece, double left, double right, double sigma) {
  const auto own = n.window(piece, -0.5 * kSpacing, 0.5 * kSpacing);
  Estimate best;
  double low = 0.0, high = 1e9;
  for (const double width : kWidths) {
    const Line line = line_through(n.window(piece, std::min(-left * width, -0.5 * kSpacing),
                                            std::max(right * width, 0.5 * kSpacing)));
    double variance = 1.0 / line.samples;
    if (line.slope != 0.0) variance += line.angle * line.angle / line.spread;
    const double error = radial_noise(line, sigma) * std::sqrt(variance);
    const double radius = line.at(0.0);
    low = std::max(low, radius - kAgreement * error);
    high = std::min(high, radius + kAgreement * error);
    if (low > high) break;
    if (width > kWidths[0] && !agrees(line, own, sigma)) continue;
    if (error < best.error) best = {radius, error, width, line.residual};
  }
  return best;
}

double radius_at(std::span<const Polar> rim, double direction, double sigma) {
  const Neighbourhood n = about(rim, direction);
  Estimate best{.error = 1.0};
  for (const auto& [left, right] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}) {
    const Estimate arc = adaptive(n, Piece::arc, left, right, sigma);
    const Estimate edge = adaptive(n, Piece::edge, left, right, sigma);
    const bool is_arc =
        arc.width != edge.width ? arc.width > edge.width : arc.residual <= edge.residual;
    const Estimate& fitting = is_arc ? arc : edge;
    if (fitting.error < best.error) best = fitting;
  }
  return best.error <= kGreatestError ? best.radius : 0.0;
}

// By straight lines: by radius a side would bulge.
void fill_gaps(Radii& radius) noexcept {
  const Radii seen = radius;
  const auto at = [&](int k) { return seen[around(k)]; };
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (seen[k] > 0.0) continue;
    int before = 1, after = 1;
    while (before <= kGap && at(k - before) == 0.0) ++before;
    while (after <= kGap && at(k + after) == 0.0) ++after;
    if (before + after > kGap + 1) continue;
    const vec2 a = at(k - before) * unit_vector(-before * kSpacing);
    const vec2 b = at(k + after) * unit_vector(after * kSpacing);
    radius[k] = cross(a, b) / (b.y - a.y);
  }
}

vec2 point_of(const Outline& outline, int k) noexcept {
  k = around(k);
  return outline.middle + outline.radius[k] * unit_vector(k * kSpacing);
}

// Where the outline turns sharply its sides before and behind, prolonged, meet in a corner that
// neither shows. `k`: two directions before, two behind; the corner is to lie between the inner
// two.
std::optional<vec2> corner_between(const Outline& outline, const std::array<int, 4>& k) noexcept {
  std::array<vec2, 4> p;
  for (int i = 0; i < 4; ++i) {
    if (outline.radius[around(k[i])] == 0.0) return {};
    p[i] = point_of(outline, k[i]);
  }
  const vec2 in = p[1] - p[0], out = p[3] - p[2];
  const double turned = cross(in, out);
  if (turned <= kSharp * std::sqrt(glm::dot(in, in) * glm::dot(out, out))) return {};
  const double beyond = cross(p[2] - p[1], out) / turned;
  const vec2 corner = p[1] + beyond * in, seen = corner - outline.middle;
  const bool is_between = beyond > 0.0 && cross(p[1] - outline.middle, seen) > 0.0 &&
                          cross(seen, p[2] - outline.middle) > 0.0;
  return is_between ? std::optional(corner) : std::nullopt;
}

// Noise also strays along the rim and so rounds a corner: the directions next to it are taken from
// the corner's sides.
void sharpen(Outline& outline) noexcept {
  const Outline round = outline;
  for (int k = 0; k < kOutlineDirections; ++k) {
    const auto corner = corner_between(round, {k - 5, k - 2, k + 2, k + 5});
    if (!corner) continue;
    const vec2 at = *corner - outline.middle;
    if (direction_of(gaitpad::atan2(at.y, at.x)) != k) continue;  // the next one's
    const vec2 in = *corner - point_of(round, k - 2), out = point_of(round, k + 2) - *corner;
    for (int n = k - 1; n <= k + 1; ++n) {
      // Where the ray meets the side.
      const vec2 u = unit_vector(n * kSpacing), side = cross(u, at) > 0.0 ? in : out;
      double& radius = outline.radius[around(n)];
      radius = std::max(radius, cross(at, side) / cross(u, side));
    }
  }
}

void keep_in_range(Outline& outline) noexcept {
  for (int k = 0; k < kOutlineDirections; ++k) {
    const vec2 u = unit_vector(k * kSpacing);
    for (int i = 0; i < 2; ++i) {
      const double room = std::max(0.0, 1.0 - std::copysign(1.0, u[i]) * outline.middle[i]);
      outline.radius[k] = std::min(outline.radius[k], room / std::max(std::fabs(u[i]), 1e-9));
    }
  }
}

}  // namespace

Outline outline_of(std::span<const StickTrack> tracks, const vec2& middle, double sigma) {
  Outline outline;
  outline.middle = middle;
  sigma = sigma > 0.0 ? std::min(sigma, kGreatestNoise) : 0.0;
  const std::vector<Polar> rim = rim_samples(tracks, middle, sigma);
  outline.samples = static_cast<std::int64_t>(between(rim, 0.0, 2.0 * kPi).size());
  for (int k = 0; k < kOutlineDirections; ++k) {
    const double angle = k * kSpacing;
    if (between(rim, angle - 0.5 * kSpacing, angle + 0.5 * kSpacing).empty()) continue;
    outline.radius[k] = radius_at(rim, angle, sigma);
  }
  fill_gaps(outline.radius);
  if (sigma > 0.0) sharpen(outline);
  keep_in_range(outline);
  return outline;
}

int filled_bins(const Outline& outline) noexcept {
  constexpr int kShare = kOutlineDirections / kCircularityBins;
  int filled = 0;
  for (int bin = 0; bin < kCircularityBins; ++bin) {
    bool is_seen = false;
    for (int n = -1; n <= 1; ++n) {
      const int k = around(bin * kShare + n);
      is_seen = is_seen || outline.radius[k] > 0.0;
    }
    filled += is_seen;
  }
  return filled;
}

namespace {

double outwards(const Outline& outline, int k, int side) noexcept {  // right, front, left, back
  const vec2 p = point_of(outline, k);
  return (side < 2 ? 1.0 : -1.0) * (side % 2 == 0 ? p.x : p.y);
}

// A single direction that juts out beyond both of its neighbours, a corner's as a rule, counts no
// more than they do.
double supported(const Outline& outline, int k, int side) noexcept {
  double beside = -2.0;
  for (const int n : {k - 1, k + 1}) {
    if (outline.radius[around(n)] == 0.0) continue;
    beside = std::max(beside, outwards(outline, n, side));
  }
  const double own = outwards(outline, k, side);
  return beside > -2.0 ? std::min(own, beside) : own;
}

}  // namespace

Reach reach_of(const Outline& outline) noexcept {
  // By side: right, front, left, back. How far out, and what was seen beside it.
  std::array<double, 4> furthest;
  furthest.fill(-2.0);
  std::array<bool, 4> is_before{}, is_behind{};
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (outline.radius[k] == 0.0) continue;
    for (int side = 0; side < 4; ++side) {
      furthest[side] = std::max(furthest[side], supported(outline, k, side));
      const double beside = wrapped((k - side * kOutlineDirections / 4) * kSpacing);
      if (std::fabs(beside) <= kOfSide && beside <= kStraight) is_before[side] = true;
      if (std::fabs(beside) <= kOfSide && beside >= -kStraight) is_behind[side] = true;
    }
  }
  const auto reach = [&](int side, double sign) {
    const bool is_known = is_before[side] && is_behind[side];
    return is_known ? std::optional(sign * std::clamp(furthest[side], -1.0, 1.0)) : std::nullopt;
  };
  return {reach(2, -1.0), reach(0, 1.0), reach(3, -1.0), reach(1, 1.0)};
}

namespace {

using Bins = std::array<double, kCircularityBins>;

void add_piece(const vec2& a, const vec2& b, Bins& greatest) noexcept {
  for (int part = 0; part <= kParts; ++part) {
    const vec2 p = a + (b - a) * (static_cast<double>(part) / kParts);
    const double turn = gaitpad::atan2(p.y, p.x) / (2.0 * kPi) + 1.0;
    double& g = greatest[std::lround(turn * kCircularityBins) % kCircularityBins];
    g = std::max(g, std::sqrt(p.x * p.x + p.y * p.y));
  }
}

}  // namespace

std::optional<double> circularity_error(const Outline& outline) noexcept {
  Bins greatest{};
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (outline.radius[k] == 0.0 || outline.radius[around(k + 1)] == 0.0) continue;
    const vec2 a = point_of(outline, k), b = point_of(outline, k + 1);
    const vec2 corner = corner_between(outline, {k - 2, k, k + 1, k + 3}).value_or(a);
    add_piece(a, corner, greatest);
    add_piece(corner, b, greatest);
  }
  double sum = 0.0;
  int filled = 0;
  for (const double g : greatest) {
    if (g <= kLeastCircularityRadius) continue;
    sum += (g - 1.0) * (g - 1.0);
    ++filled;
  }
  if (filled < kLeastFilledBins) return std::nullopt;
  return 100.0 * std::sqrt(sum / filled);
}

}  // namespace gaitpad
