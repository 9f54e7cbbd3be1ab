#include "animation/terrain_shapes.h"

#include <fmt/format.h>

namespace gaitpad {
namespace {

constexpr double kMinLength_m = 0.1, kMaxLength_m = 1000.0;
constexpr double kMinTread_m = 0.15, kMaxTread_m = 2.0, kMaxRise_m = 0.4;
constexpr int kMaxRisers = 100;

std::optional<Error> length_problem(double length_m) {
  if (is_within(length_m, kMinLength_m, kMaxLength_m)) return std::nullopt;
  return Error{fmt::format("a length of {} m is not within {} and {} m", length_m, kMinLength_m,
                           kMaxLength_m)};
}

std::optional<Error> shape_problem(double bend_1_m, double grade) {
  if (!(grade <= kMaxGrade))
    return Error{fmt::format("a grade of {:.2f} is too steep: at most {}", grade, kMaxGrade)};
  if (!(bend_1_m <= kMaxBend_1_m)) {
    return Error{
        fmt::format("a sole would not lie on ground that bends by {:.2f} per metre: at most {}",
                    bend_1_m, kMaxBend_1_m)};
  }
  return std::nullopt;
}

// A number in [0, 1) of a seed, by the mixer of splitmix32.
double random_share(std::uint32_t seed) noexcept {
  std::uint32_t x = seed + 0x9e3779b9u;
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0x735a2d97u;
  return static_cast<double>(x ^ (x >> 15)) / 4294967296.0;
}

}  // namespace

Share share_at(double u_m, double length_m, double fade_m) noexcept {
  const bool near = u_m < 0.5 * length_m;
  const double s = (near ? u_m : length_m - u_m) / fade_m;
  if (s >= 1.0) return {};
  const double t = std::max(s, 0.0);
  return {t * t * (3.0 - 2.0 * t), (near ? 6.0 : -6.0) * t * (1.0 - t) / fade_m};
}

std::optional<Error> faded_problem(double length_m, double fade_m, const MostOfShare& share,
                                   const Most& surface) {
  if (auto problem = length_problem(length_m)) return problem;
  if (!(fade_m > 0.0 && 2.0 * fade_m <= length_m)) {
    return Error{fmt::format("{} m of fading at both ends do not fit into {} m", fade_m, length_m)};
  }
  return shape_problem(
      surface.bend_1_m + 2.0 * share.slope_1_m * surface.grade + share.bend_1_m2 * surface.height_m,
      surface.grade + share.slope_1_m * surface.height_m);
}

ShapePoint point_at(const FlatSection&, double, double) noexcept { return {}; }

ShapePoint point_at(const SlopeSection& slope, double, double u) noexcept {
  const double r = slope.rounding_m, g = slope.grade;
  if (u < r) return {.height_m = 0.5 * g * u * u / r, .dz = g * u / r};
  const double left = slope.length_m - u;
  if (left < r) return {.height_m = rise_of(slope) - 0.5 * g * left * left / r, .dz = g * left / r};
  return {.height_m = g * (u - 0.5 * r), .dz = g};
}

// Upstairs a riser's line is part of the tread behind it, downstairs of the one before.
ShapePoint point_at(const StairsSection& stairs, double, double u) noexcept {
  int passed = 0;
  for (int k = 0; k < stairs.count; ++k) {
    const double riser_m = k * stairs.tread_m;
    passed += stairs.rise_m > 0.0 ? u >= riser_m : u > riser_m;
  }
  return {.height_m = stairs.rise_m * passed, .risers = passed};
}

ShapePoint point_at(const RoughSection& rough, double x, double u) noexcept {
  ShapePoint waves;
  for (const Wave& w : rough.wave) {
    const SinCos s = sin_cos(w.x_rad_m * x + w.z_rad_m * u + w.phase_rad);
    waves.height_m += w.height_m * s.sin;
    waves.dx += w.height_m * s.cos * w.x_rad_m;
    waves.dz += w.height_m * s.cos * w.z_rad_m;
  }
  const Share share = share_at(u, rough.length_m, rough.fade_m);
  return {.height_m = waves.height_m * share.value,
          .dx = waves.dx * share.value,
          .dz = waves.dz * share.value + waves.height_m * share.slope};
}

std::optional<Error> problem_of(const FlatSection& flat) { return length_problem(flat.length_m); }

std::optional<Error> problem_of(const SlopeSection& slope) {
  if (auto problem = length_problem(slope.length_m)) return problem;
  if (!(slope.rounding_m > 0.0 && 2.0 * slope.rounding_m <= slope.length_m)) {
    return Error{fmt::format("{} m of rounding at both ends do not fit into {} m", slope.rounding_m,
                             slope.length_m)};
  }
  const double grade = fabs(slope.grade);
  return shape_problem(grade / slope.rounding_m, grade);
}

std::optional<Error> problem_of(const StairsSection& stairs) {
  if (!is_within(stairs.tread_m, kMinTread_m, kMaxTread_m))
    return Error{fmt::format("a tread of {} m is not within {} and {} m", stairs.tread_m,
                             kMinTread_m, kMaxTread_m)};
  if (!is_within(fabs(stairs.rise_m), 0.01, kMaxRise_m))
    return Error{fmt::format("a rise of {} m is not within 0.01 and {} m, up or down",
                             stairs.rise_m, kMaxRise_m)};
  if (stairs.count < 1 || stairs.count > kMaxRisers)
    return Error{fmt::format("{} risers are not 1 to {}", stairs.count, kMaxRisers)};
  return std::nullopt;
}

std::optional<Error> problem_of(const RoughSection& rough) {
  Most most;
  for (const Wave& w : rough.wave) {
    const double k = sqrt(w.x_rad_m * w.x_rad_m + w.z_rad_m * w.z_rad_m);
    if (!(k < 100.0)) return Error{"a wave is shorter than 6 cm"};
    const double height_m = fabs(w.height_m);
    most.height_m += height_m, most.grade += height_m * k, most.bend_1_m += height_m * k * k;
  }
  // smoothstep's greatest slope and bend
  const MostOfShare share{1.5 / rough.fade_m, 6.0 / (rough.fade_m * rough.fade_m)};
  return faded_problem(rough.length_m, rough.fade_m, share, most);
}

RoughSection rough_section(double length_m, double amplitude_m, double wavelength_m, double fade_m,
                           std::uint32_t seed) {
  // Wavelengths over the shortest one: square roots without a common measure, an octave and more.
  constexpr std::array<double, 5> kSquares{1.0, 1.7, 2.6, 3.7, 5.3};
  constexpr double kGoldenAngle = 2.399963229728653;  // directions never line up
  RoughSection rough;
  rough.length_m = length_m, rough.fade_m = fade_m;
  double sum = 0.0;
  for (const double square : kSquares) sum += square;
  const double turn = 2.0 * kPi * random_share(seed);
  for (std::size_t i = 0; i < kSquares.size(); ++i) {
    const double k = 2.0 * kPi / (wavelength_m * sqrt(kSquares[i]));
    const SinCos direction = sin_cos(turn + kGoldenAngle * static_cast<double>(i));
    // Heights with the square of the length: each wave bends the ground alike.
    rough.wave[i] = {
        .x_rad_m = k * direction.sin,
        .z_rad_m = k * direction.cos,
        .phase_rad = 2.0 * kPi * random_share(seed + 1 + static_cast<std::uint32_t>(i)),
        .height_m = amplitude_m * kSquares[i] / sum};
  }
  return rough;
}

void scale(FlatSection& flat, double factor) noexcept { flat.length_m *= factor; }

void scale(SlopeSection& slope, double factor) noexcept {
  slope.length_m *= factor, slope.rounding_m *= factor;
}

void scale(StairsSection& stairs, double factor) noexcept {
  stairs.rise_m *= factor, stairs.tread_m *= factor;
}

void scale(RoughSection& rough, double factor) noexcept {
  rough.length_m *= factor, rough.fade_m *= factor;
  for (Wave& w : rough.wave) w.height_m *= factor, w.x_rad_m /= factor, w.z_rad_m /= factor;
}
}  // namespace gaitpad
