#include "stick/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gaitpad {

namespace {

// ---- The samples on the rim

constexpr double kSpacing = 2.0 * kPi / kOutlineDirections;  // rad
// Least radius of a gate, raw; no gate is nearer to the middle.
constexpr double kLeastRadius = 0.25;
constexpr double kLeastNoise = 0.003;  // least noise, raw; rounding to 8 bits gives 0.0023
// Angle (rad) on either side of the seam, 0 = 2 pi, whose samples are repeated at the other end; no
// window reaches farther.
constexpr double kSeam = 30.0 * kDegree;
constexpr double kMeanOfUpperHalf = 0.8;  // mean of the upper half of a Gaussian, in sigma

constexpr double kGreatestRadius = 4.0;  // more than from any middle to any corner of the range
// Least radius of a gate as a share of its convex hull's: no gate bends inwards by more.
constexpr double kInsideHull = 0.85;
// Greatest slope of a gate, in radii per rad; at a square's corner it is 1.
constexpr double kSteepest = 2.0;
// Number of directions to either side that the slope limits; farther off the hull is the better
// limit.
constexpr int kSteepReach = 8;
constexpr double kLeastSpread = 0.1 * kSpacing * kSpacing;  // rad^2; less gives no slope

// Half width, rad, of the lines that tell the rim from samples inside it: wide enough for two
// samples of the slowest pad after two turns, narrow enough for a corner.
constexpr double kSelectionWidth = 3.0 * kSpacing;
constexpr int kFewOfDirection = 8;
constexpr int kSelectionRounds = 6;  // rounds of selecting samples; three or four are enough
// Quantile of the samples' heights at which the search begins.
constexpr double kSelectionQuantile = 0.9;
constexpr double kSigmas = 3.0;  // a sample that lies less far below the line is on the rim

using Radii = std::array<double, kOutlineDirections>;  // raw radius in each direction

struct Polar {
  double angle, radius;  // angle in rad, radius raw
};

// A straight line radius(angle) through samples.
struct Line {
  // Number of samples, means of angle (rad) and radius (raw), slope (raw per rad); the line passes
  // through the means.
  double samples = 0.0, angle = 0.0, radius = 0.0, slope = 0.0;
  double spread = 0.0;    // sum of squared angles about their mean
  double residual = 0.0;  // mean square of the differences from the line

  double at(double a) const noexcept { return radius + slope * (a - angle); }
};

vec2 unit_vector(double angle) noexcept {
  const SinCos s = sin_cos(angle);
  return {s.cos, s.sin};
}

// The outline's direction that is nearest.
int direction_of(double angle) noexcept {
  return static_cast<int>(std::lround(angle / kSpacing) + kOutlineDirections) % kOutlineDirections;
}

// The samples in [from, to); they are ordered by angle.
std::span<const Polar> between(std::span<const Polar> samples, double from, double to) {
  const auto is_below = [](const Polar& p, double angle) { return p.angle < angle; };
  const auto first = std::lower_bound(samples.begin(), samples.end(), from, is_below);
  return {first, std::lower_bound(first, samples.end(), to, is_below)};
}

// Least-squares line, no steeper than a gate can be.
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
  // Samples at one angle have no slope.
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

// The radial noise of samples on a rim that is not at right angles to the radius:
// sigma sqrt(1 + (slope / radius)^2), at least that of rounding to 8 bits.
double radial_noise(const Line& line, double sigma) noexcept {
  const double steepness = line.slope / std::max(line.radius, kLeastRadius);
  return std::max(sigma * std::sqrt(1.0 + steepness * steepness), kLeastNoise);
}

// Reports are clipped at the end of the range. If a gate ends there, half of its samples would lie
// beyond it, by 0.8 sigma on average (for a gate farther in: fewer samples, by a little less).
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
      // Most pads report changes only; dropping repeats makes the others like them.
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

// Radii below which a sample cannot be on the rim: the gate would bend inwards there, or fall off
// from its neighbours more steeply than gates do.
Radii inside_of(const Radii& greatest, double sigma) {
  Radii inside = hull_of(greatest);
  for (double& radius : inside) radius = kInsideHull * radius - kSigmas * sigma;
  for (int k = 0; k < kOutlineDirections; ++k) {
    for (int n = -kSteepReach; n <= kSteepReach; ++n) {
      const int beside = (k + n + kOutlineDirections) % kOutlineDirections;
      // Both samples lie anywhere within their direction; noise may lift one and lower the other.
      const double least = greatest[beside] * (1.0 - kSteepest * kSpacing * (std::abs(n) + 1)) -
                           2.0 * (kSigmas * sigma + kLeastNoise);
      inside[k] = std::max(inside[k], least);
    }
  }
  return inside;
}

// Sorts by angle; samples beside the seam (0 and 2 pi) are repeated beyond the other end.
std::vector<Polar> sort_by_angle(std::vector<Polar> samples) {
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

// Upper envelope: begins high, then fits the line again to the samples that are not below it by
// more than 3 sigma, up to six times.
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

// At most eight samples a direction, so that a stick that is held does not outweigh its neighbours.
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

// The samples on the rim: those not below its envelope by more than noise.
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

// All samples on the rim about `middle`, ordered by angle. A sample 3 sigma inside the envelope is
// still on it.
std::vector<Polar> rim_samples(std::span<const StickTrack> tracks, const vec2& middle,
                               double sigma) {
  std::vector<Polar> samples = polar_samples(tracks, middle, sigma);
  const Radii inside = inside_of(greatest_of(samples), sigma);
  std::erase_if(samples, [&](const Polar& p) { return p.radius < inside[direction_of(p.angle)]; });
  return sort_by_angle(rim_of(sort_by_angle(std::move(samples)), sigma));
}

// ---- The gate through them

constexpr double kGreatestNoise = 0.2;  // largest noise, raw, with which a rim can be found
// Half widths of the windows, rad. Wider ones are used as long as their lines agree with the
// narrower ones'.
constexpr double kWidths[] = {1.0 * kSpacing, 1.5 * kSpacing, 2.0 * kSpacing, 3.0 * kSpacing,
                              4.0 * kSpacing, 6.0 * kSpacing, 8.0 * kSpacing};
// The greatest difference, in standard errors, between the estimates (fewer: noisy; more: rounds
// the corners of a square; 1.5 gives the least circularity error over all made gates) and between
// an estimate and the direction's own samples.
constexpr double kAgreement = 1.5, kOwnAgreement = 3.0;
// Greatest standard error, raw; beyond it the direction was not seen.
constexpr double kGreatestError = 0.025;
constexpr int kGap = 3;         // most unseen directions between seen ones that are filled in
constexpr double kSharp = 0.6;  // sine of the least angle by which a corner turns

// The reach to a side is known if the outline was seen within kBesideSide_rad both clockwise and
// counter-clockwise of it, or within kOnSide_rad of the side itself.
constexpr double kBesideSide_rad = 15.0 * kDegree, kOnSide_rad = 3.0 * kSpacing;
// circularity_error() samples the line between two directions at the ends of its parts.
constexpr int kLineParts = 8;
// Smallest radius that counts, as in dualshock-tools.
constexpr double kLeastCircularityRadius = 0.2;
// Fewest bins with a radius; with fewer the error is not comparable.
constexpr int kLeastFilledBins = 44;

double cross(const vec2& a, const vec2& b) noexcept { return a.x * b.y - a.y * b.x; }

int around(int k) noexcept { return (k + kOutlineDirections) % kOutlineDirections; }

// Gates consist of arcs and edges. An arc about the middle is a straight line as radius over angle,
// an edge is one in space.
enum class Piece { arc, edge };

// The rim near a direction, also in the coordinates in which a piece is straight: along the piece
// (about radians from the direction), and outwards.
struct Neighbourhood {
  double direction;
  std::span<const Polar> rim;
  std::array<std::vector<Polar>, 2> straight;  // samples that may form an arc, an edge

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
  double radius = 0.0, error = 1.0;  // radius and its standard error
  double width = 0.0;                // width of the window
  double residual = 0.0;             // mean square of the samples' distances from the line
};

// Whether the line passes through the middle of the direction's own samples.
bool agrees(const Line& line, std::span<const Polar> own, double sigma) noexcept {
  double off = 0.0;
  for (const Polar& p : own) off += (p.radius - line.at(p.angle)) / static_cast<double>(own.size());
  return std::fabs(off) <=
         kOwnAgreement * radial_noise(line, sigma) / std::sqrt(static_cast<double>(own.size()));
}

// Windows grow (to `left` and `right` times each width) until the estimates' confidence intervals
// no longer intersect: wide where the rim is smooth, narrow beside a corner (Katkovnik 1999).
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

// Fills gaps by straight lines in space: interpolated radii would make a side bulge.
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

}  // namespace

vec2 point_of(const Outline& outline, int k) noexcept {
  k = around(k);
  return outline.middle + outline.radius[k] * unit_vector(k * kSpacing);
}

namespace {

// The corner where the extended sides before and behind a sharp turn meet. `k`: two directions
// before it and two behind; the corner must lie between the inner two.
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

// Noise along the rim rounds a corner: the directions next to it are taken from the corner's sides.
void sharpen(Outline& outline) noexcept {
  const Outline round = outline;
  for (int k = 0; k < kOutlineDirections; ++k) {
    const auto corner = corner_between(round, {k - 5, k - 2, k + 2, k + 5});
    if (!corner) continue;
    const vec2 at = *corner - outline.middle;
    if (direction_of(gaitpad::atan2(at.y, at.x)) != k) continue;  // another k adds this corner
    const vec2 in = *corner - point_of(round, k - 2), out = point_of(round, k + 2) - *corner;
    for (int n = k - 1; n <= k + 1; ++n) {
      // Intersection of the ray and the side.
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

// Samples of whole turns, without the 10 degrees at either end, where the stick moves outwards and
// back. Only a whole turn shows that a sector of the gate reaches less far: a single push may just
// have been shorter.
std::vector<Polar> turned_samples(std::span<const StickTrack> tracks, const vec2& middle) {
  constexpr double kOfTurn = 10.0 * kDegree;
  std::vector<Polar> turned;
  for (const StickTrack& track : tracks) {
    // Samples, each with the angle (rad) turned until then.
    std::vector<std::pair<Polar, double>> run;
    const auto end_run = [&] {
      const double whole = run.empty() ? 0.0 : run.back().second;
      for (const auto& [polar, way] : run) {
        const double from = std::copysign(way, way * whole), to = std::fabs(whole) - from;
        if (std::fabs(whole) > 1.9 * kPi && from > kOfTurn && to > kOfTurn) turned.push_back(polar);
      }
      run.clear();
    };
    for (const StickSample& sample : track) {
      const vec2 p = sample.raw - middle;
      const double radius = glm::length(p);
      if (!(radius > kLeastRadius) || radius > kGreatestRadius) {
        end_run();
        continue;
      }
      const Polar polar{gaitpad::atan2(p.y, p.x), radius};
      const double way =
          run.empty() ? 0.0 : run.back().second + wrapped(polar.angle - run.back().first.angle);
      run.emplace_back(polar, way);
    }
    end_run();
  }
  return turned;
}

// Sets the radius in directions in which even the farthest sample stays below 0.88 of the convex
// hull although whole turns passed: a sector of the gate that reaches less far. rim_samples()
// leaves such samples out.
void take_weak_sectors(std::span<const StickTrack> tracks, double sigma, Outline& outline) {
  constexpr double kWeak = 0.88, kSlack = 0.02;
  constexpr std::size_t kFewest = 3;
  std::array<std::vector<double>, kOutlineDirections> radii;
  for (const Polar& p : turned_samples(tracks, outline.middle))
    radii[direction_of(p.angle)].push_back(p.radius);
  const Radii greatest = greatest_of(polar_samples(tracks, outline.middle, sigma));
  const Radii hull = hull_of(greatest);
  for (int k = 0; k < kOutlineDirections; ++k) {
    std::vector<double> near;
    double most = 0.0;
    for (const int n : {around(k - 1), k, around(k + 1)}) {
      near.insert(near.end(), radii[n].begin(), radii[n].end());
      most = std::max(most, greatest[n]);
    }
    if (near.size() < kFewest || most > kWeak * hull[k]) continue;
    std::erase_if(near, [&](double radius) { return radius < most - kSlack - 3.0 * sigma; });
    double sum = 0.0;
    for (const double radius : near) sum += radius;
    if (!near.empty()) outline.radius[k] = sum / static_cast<double>(near.size());
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
  take_weak_sectors(tracks, sigma, outline);
  fill_gaps(outline.radius);
  if (sigma > 0.0) sharpen(outline);
  keep_in_range(outline);
  return outline;
}

std::optional<int> worst_direction(const Outline& outline) noexcept {
  std::optional<int> worst;
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (outline.radius[k] > 0.0 && !(worst && outline.radius[*worst] <= outline.radius[k]))
      worst = k;
  }
  return worst;
}

std::array<double, kCircularityBins> least_reaches(const Outline& outline) noexcept {
  constexpr int kShare = kOutlineDirections / kCircularityBins;
  std::array<double, kCircularityBins> least{};
  for (int k = 0; k < kOutlineDirections; ++k) {
    const double radius = outline.radius[k];
    double& reach = least[(k + kShare / 2) / kShare % kCircularityBins];
    if (radius > 0.0 && std::isfinite(radius) && !(reach > 0.0 && reach <= radius)) reach = radius;
  }
  return least;
}

std::optional<int> unpressed_direction(const Outline& outline, std::span<const vec2> pushes) {
  // Raw lengths: depth of a dent, and how far a push may exceed the outline.
  constexpr double kDeep = 0.1, kAsFar = 0.06;
  Radii farthest = outline.radius;
  const auto direction = [&](const vec2& push) {
    const vec2 p = push - outline.middle;
    return direction_of(gaitpad::atan2(p.y, p.x));
  };
  const auto reach = [&](const vec2& push) { return glm::length(push - outline.middle); };
  for (const vec2& push : pushes)
    farthest[direction(push)] = std::max(farthest[direction(push)], reach(push));
  const Radii hull = hull_of(farthest);
  std::array<bool, kOutlineDirections> is_deep{};
  for (int k = 0; k < kOutlineDirections; ++k)
    is_deep[k] = outline.radius[k] > 0.0 && hull[k] - outline.radius[k] > kDeep;
  for (const vec2& push : pushes) {
    const int k = direction(push);
    if (!is_deep[k] || reach(push) > outline.radius[k] + kAsFar) continue;
    for (const int step : {-1, 1})
      for (int n = k; n == k || is_deep[around(n)]; n += step) is_deep[around(n)] = false;
  }
  std::optional<int> deepest;
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (!is_deep[k]) continue;
    const auto depth = [&](int n) { return hull[n] - outline.radius[n]; };
    if (!deepest || depth(k) > depth(*deepest)) deepest = k;
  }
  return deepest;
}

int degrees_of(int k) noexcept {
  return (k * 360 + kOutlineDirections / 2) / kOutlineDirections % 360;
}

std::string direction_text(int k) {
  constexpr const char* kNames[] = {"right", "front right", "front", "front left",
                                    "left",  "back left",   "back",  "back right"};
  const int eighth = (k * 8 + kOutlineDirections / 2) / kOutlineDirections % 8;
  return fmt::format("{} ({} degrees from the right)", kNames[eighth], degrees_of(k));
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

// The outline's distance in direction k towards a side: right, front, left, back.
double outwards(const Outline& outline, int k, int side) noexcept {
  const vec2 p = point_of(outline, k);
  return (side < 2 ? 1.0 : -1.0) * (side % 2 == 0 ? p.x : p.y);
}

// A single direction that juts out beyond both of its neighbours (a corner, as a rule) counts only
// as far as they reach.
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
  // Reaches by side: right, front, left, back.
  std::array<double, 4> furthest;
  furthest.fill(-2.0);
  std::array<bool, 4> is_before{}, is_behind{};
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (outline.radius[k] == 0.0) continue;
    for (int side = 0; side < 4; ++side) {
      furthest[side] = std::max(furthest[side], supported(outline, k, side));
      const double beside = wrapped((k - side * kOutlineDirections / 4) * kSpacing);
      if (std::fabs(beside) <= kBesideSide_rad && beside <= kOnSide_rad) is_before[side] = true;
      if (std::fabs(beside) <= kBesideSide_rad && beside >= -kOnSide_rad) is_behind[side] = true;
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
  for (int part = 0; part <= kLineParts; ++part) {
    const vec2 p = a + (b - a) * (static_cast<double>(part) / kLineParts);
    const double turn = gaitpad::atan2(p.y, p.x) / (2.0 * kPi) + 1.0;
    double& g = greatest[std::lround(turn * kCircularityBins) % kCircularityBins];
    g = std::max(g, std::sqrt(p.x * p.x + p.y * p.y));
  }
}

}  // namespace

std::optional<double> circularity_error(const CircularityBins& greatest) noexcept {
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

std::optional<double> circularity_error(const Outline& outline) noexcept {
  Bins greatest{};
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (outline.radius[k] == 0.0 || outline.radius[around(k + 1)] == 0.0) continue;
    const vec2 a = point_of(outline, k), b = point_of(outline, k + 1);
    const vec2 corner = corner_between(outline, {k - 2, k, k + 1, k + 3}).value_or(a);
    add_piece(a, corner, greatest);
    add_piece(corner, b, greatest);
  }
  return circularity_error(greatest);
}

namespace {

// Counts whole turns in either direction; turning back begins anew.
struct Turning {
  int turns = 0;
  // The running turn and its farthest point, in whole turns.
  double turned = 0.0, farthest = 0.0;
  void add(double angle) noexcept {
    turned += angle;
    if (std::fabs(turned) > std::fabs(farthest) && turned * farthest >= 0.0) farthest = turned;
    if (std::fabs(turned - farthest) <= 0.25) return;
    const double back = turned - farthest;
    end();
    turned = farthest = back;
  }
  void end() noexcept {
    // A turn that ends a little early counts as whole.
    turns += static_cast<int>(std::min(std::fabs(farthest) + 0.05, 1e6));
    turned = farthest = 0.0;
  }
};

}  // namespace

int whole_turns(std::span<const StickTrack> tracks, const vec2& middle, double radius) {
  constexpr int kStray = 3;  // most reports in a row that may be spikes
  Turning turning;
  for (const StickTrack& track : tracks) {
    vec2 before(0.0);  // the position before, from the middle; 0: it was within `radius`
    int strays = 0;
    for (const StickSample& sample : track) {
      const vec2 p = sample.raw - middle;
      const bool is_out = glm::length(p) > radius;
      const double angle =
          atan2(before.x * p.y - before.y * p.x, glm::dot(before, p)) / (2.0 * kPi);
      const bool is_stray = before != vec2(0.0) && (!is_out || std::fabs(angle) > 0.2);
      if (is_stray && ++strays <= kStray) continue;
      strays = 0;
      if (is_out && before != vec2(0.0)) turning.add(angle);
      if (!is_out) turning.end();
      before = is_out ? p : vec2(0.0);
    }
    turning.end();
  }
  return turning.turns;
}

}  // namespace gaitpad
