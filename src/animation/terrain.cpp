// The kinds of section that a terrain is made of, each in its own frame: u metres behind its begin,
// heights above it.

#include "gaitpad/terrain.h"

#include <fmt/format.h>

#include <optional>

namespace gaitpad {

struct ShapePoint {
  double height_m = 0.0;
  double dx = 0.0, dz = 0.0;  // its slopes
  int risers = 0;             // passed on the way from the begin
};
ShapePoint point_at(const FlatSection& flat, double x_m, double u_m) noexcept;
ShapePoint point_at(const SlopeSection& slope, double x_m, double u_m) noexcept;
ShapePoint point_at(const StairsSection& stairs, double x_m, double u_m) noexcept;
ShapePoint point_at(const RoughSection& rough, double x_m, double u_m) noexcept;
ShapePoint point_at(const FieldSection& section, double x_m, double u_m) noexcept;

inline double length_of(const StairsSection& stairs) noexcept {
  return stairs.tread_m * stairs.count;
}
template <class Section>
double length_of(const Section& section) noexcept {
  return section.length_m;
}
inline double rise_of(const SlopeSection& slope) noexcept {
  return slope.grade * (slope.length_m - slope.rounding_m);
}

// The cause why nobody could walk on it.
std::optional<Error> problem_of(const FlatSection& flat);
std::optional<Error> problem_of(const SlopeSection& slope);
std::optional<Error> problem_of(const StairsSection& stairs);
std::optional<Error> problem_of(const RoughSection& rough);
std::optional<Error> problem_of(const FieldSection& section);

// What is left of a section's waves at u: nothing at both ends, all between; and its slope.
struct Share {
  double value = 1.0, slope = 0.0;
};
Share share_at(double u_m, double length_m, double fade_m) noexcept;
// The greatest height, slope and bend of a surface.
struct Most {
  double height_m = 0.0, grade = 0.0, bend_1_m = 0.0;
};
struct MostOfShare {
  double slope_1_m = 0.0, bend_1_m2 = 0.0;
};
// Of a surface times its share.
std::optional<Error> faded_problem(double length_m, double fade_m, const MostOfShare& share,
                                   const Most& surface);
inline bool is_within(double x, double min, double max) noexcept { return x >= min && x <= max; }

void scale(FlatSection& flat, double factor) noexcept;
void scale(SlopeSection& slope, double factor) noexcept;
void scale(StairsSection& stairs, double factor) noexcept;
void scale(RoughSection& rough, double factor) noexcept;
void scale(FieldSection& section, double factor) noexcept;

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

namespace {

// Cubic B-spline at t in [0, 1) between the second and the third of four samples.
struct Spline {
  std::array<double, 4> value, slope;
};
Spline spline_at(double t) noexcept {
  const double s = 1.0 - t;
  return {{s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
           (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0},
          {-0.5 * s * s, 1.5 * t * t - 2.0 * t, -1.5 * s * s + 2.0 * s, 0.5 * t * t}};
}

double sample(const HeightField& field, int column, int row) noexcept {
  const int c = std::clamp(column, 0, field.columns - 1), r = std::clamp(row, 0, field.rows - 1);
  return field.height_m[static_cast<std::size_t>(r) * static_cast<std::size_t>(field.columns) +
                        static_cast<std::size_t>(c)];
}

// In samples from column 0 and row 0.
ShapePoint unfaded(const FieldSection& section, double across, double along) noexcept {
  const int c = static_cast<int>(floor(across)), r = static_cast<int>(floor(along));
  const Spline sc = spline_at(across - c), sr = spline_at(along - r);
  ShapePoint at;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const double h = sample(*section.field, c + i - 1, r + j - 1) * section.height_scale;
      at.height_m += h * sc.value[i] * sr.value[j];
      at.dx -= h * sc.slope[i] * sr.value[j] / section.pixel_m;
      at.dz += h * sc.value[i] * sr.slope[j] / section.pixel_m;
    }
  }
  return at;
}

// The greatest height, and first, second and mixed difference of neighbours.
struct Differences {
  double height = 0.0, step = 0.0, bend = 0.0, twist = 0.0;
};
Differences differences(const HeightField& f) noexcept {
  Differences most;
  for (int r = 0; r < f.rows; ++r) {
    for (int c = 0; c < f.columns; ++c) {
      const double h = sample(f, c, r), right = sample(f, c + 1, r), far = sample(f, c, r + 1);
      most.height = std::max(most.height, fabs(h));
      most.step = std::max({most.step, fabs(right - h), fabs(far - h)});
      // Beyond the borders lies nothing: the outermost samples have faded away.
      if (c > 0 && c + 1 < f.columns)
        most.bend = std::max(most.bend, fabs(right - 2.0 * h + sample(f, c - 1, r)));
      if (r > 0 && r + 1 < f.rows)
        most.bend = std::max(most.bend, fabs(far - 2.0 * h + sample(f, c, r - 1)));
      most.twist = std::max(most.twist, fabs(sample(f, c + 1, r + 1) - right - far + h));
    }
  }
  return most;
}

}  // namespace

ShapePoint point_at(const FieldSection& section, double x, double u) noexcept {
  const HeightField& field = *section.field;
  const double width_m = (field.columns - 1) * section.pixel_m;
  const double from_left_m = 0.5 * width_m - x;  // column 0 is the leftmost
  if (!(from_left_m > 0.0 && from_left_m < width_m)) return {};
  const Share across = share_at(from_left_m, width_m, section.fade_m);
  const Share along = share_at(u, section.length_m, section.fade_m);
  const ShapePoint at = unfaded(section, from_left_m / section.pixel_m, u / section.pixel_m);
  return {.height_m = at.height_m * across.value * along.value,
          .dx = (at.dx * across.value - at.height_m * across.slope) * along.value,
          .dz = (at.dz * along.value + at.height_m * along.slope) * across.value};
}

// A spline's slopes and bends are means of its samples' differences, so theirs bound them.
std::optional<Error> problem_of(const FieldSection& section) {
  if (!section.field) return Error{"the height field is missing"};
  const HeightField& f = *section.field;
  if (f.columns < 2 || f.rows < 2 || f.columns > kMaxFieldSide || f.rows > kMaxFieldSide ||
      f.height_m.size() != static_cast<std::size_t>(f.columns) * static_cast<std::size_t>(f.rows))
    return Error{
        fmt::format("{} x {} samples are not 2 to {} a side", f.columns, f.rows, kMaxFieldSide)};
  const double m = section.pixel_m, n = section.height_scale;
  if (!is_within(m, 1e-3, 100.0)) return Error{"a sample is not 1 mm to 100 m wide"};
  const double width_m = (f.columns - 1) * m;
  if (!(2.0 * section.fade_m <= width_m)) {
    return Error{
        fmt::format("{} m of fading at both sides do not fit into {} m", section.fade_m, width_m)};
  }
  const Differences most = differences(f);
  if (!(most.height * n < 100.0)) return Error{"a height is beyond 100 m"};
  // Of the two shares' product, in any direction.
  const double slope = sqrt(2.0) * 1.5 / section.fade_m;
  const double bend = (6.0 + 1.5 * 1.5) / (section.fade_m * section.fade_m);
  // Within a sample of the border the surface is cut off, but hardly any of it is left there.
  const double cut = 3.0 * most.step * n / (section.fade_m * section.fade_m);
  return faded_problem(section.length_m, section.fade_m, {slope, bend},
                       {most.height * n, sqrt(2.0) * most.step * n / m,
                        (most.bend + most.twist) * n / (m * m) + cut});
}

void scale(FieldSection& section, double factor) noexcept {
  section.length_m *= factor, section.fade_m *= factor;
  section.pixel_m *= factor, section.height_scale *= factor;
}

namespace {

// sin_cos() is exact up to 1e5 rad; also where no place is one (NaN).
constexpr double kFar_m = 1e4;

double place(double x_m) noexcept {
  if (x_m > kFar_m) return kFar_m;
  return x_m > -kFar_m ? x_m : -kFar_m;
}

double level_of(const SectionShape& shape) noexcept {
  if (const auto* slope = std::get_if<SlopeSection>(&shape)) return rise_of(*slope);
  if (const auto* stairs = std::get_if<StairsSection>(&shape))
    return stairs->rise_m * stairs->count;
  return 0.0;
}

int risers_of(const SectionShape& shape) noexcept {
  const auto* stairs = std::get_if<StairsSection>(&shape);
  return stairs ? stairs->count : 0;
}

const TerrainSection* section_at(const Terrain& terrain, double z_m) noexcept {
  const TerrainSection* found = nullptr;
  for (const TerrainSection& s : terrain.sections) {
    if (s.begin_m > z_m) break;
    found = &s;
  }
  return found;
}

// Calls `see(z_m, is_up)` for each riser, in order.
template <class See>
void see_risers(const Terrain& terrain, const See& see) noexcept {
  for (const TerrainSection& s : terrain.sections) {
    const auto* stairs = std::get_if<StairsSection>(&s.shape);
    for (int k = 0; stairs && k < stairs->count; ++k)
      see(s.begin_m + k * stairs->tread_m, stairs->rise_m > 0.0);
  }
}

}  // namespace

Ground ground_at(const Terrain& terrain, double x_m, double z_m) noexcept {
  const double z = place(z_m);
  const TerrainSection* s = section_at(terrain, z);
  if (!s) return {};
  const double u = z - s->begin_m;
  if (u > s->length_m) return {s->end_m, kUp, s->piece + risers_of(s->shape)};
  const double x = place(x_m);
  const ShapePoint at =
      std::visit([&](const auto& shape) { return point_at(shape, x, u); }, s->shape);
  const vec3 normal = at.dx == 0.0 && at.dz == 0.0
                          ? kUp
                          : vec3(-at.dx, 1.0, -at.dz) / sqrt(1.0 + at.dx * at.dx + at.dz * at.dz);
  return {s->base_m + at.height_m, normal, s->piece + at.risers};
}

Stretch piece_at(const Terrain& terrain, double z_m) noexcept {
  Stretch stretch;
  see_risers(terrain, [&](double riser_m, bool is_up) {
    if (is_up ? riser_m <= z_m : riser_m < z_m) {
      stretch.from_m = riser_m;
    } else if (riser_m < stretch.to_m) {
      stretch.to_m = riser_m;
    }
  });
  return stretch;
}

bool is_flat(const Terrain& terrain) noexcept {
  return std::all_of(terrain.sections.begin(), terrain.sections.end(), [](const TerrainSection& s) {
    return std::holds_alternative<FlatSection>(s.shape);
  });
}

double least_tread_m(const Terrain& terrain) noexcept {
  double least = std::numeric_limits<double>::infinity(), last = -least;
  see_risers(terrain, [&](double riser_m, bool) {
    least = std::min(least, riser_m - last);
    last = riser_m;
  });
  return least;
}

double length_m(const Terrain& terrain) noexcept {
  if (terrain.sections.empty()) return 0.0;
  return terrain.sections.back().begin_m + terrain.sections.back().length_m;
}

std::optional<Error> add_section(Terrain& terrain, const SectionShape& shape) {
  if (terrain.sections.size() >= kMaxSections) return Error{"there are too many sections"};
  if (auto problem = std::visit([](const auto& s) { return problem_of(s); }, shape)) return problem;
  TerrainSection section;
  section.shape = shape;
  section.length_m = std::visit([](const auto& s) { return length_of(s); }, shape);
  if (!terrain.sections.empty()) {
    const TerrainSection& before = terrain.sections.back();
    section.begin_m = before.begin_m + before.length_m;
    section.base_m = before.end_m;
    section.piece = before.piece + risers_of(before.shape);
  }
  if (section.begin_m + section.length_m > kFar_m) return Error{"the terrain is too long"};
  section.end_m = section.base_m + level_of(shape);
  terrain.sections.push_back(std::move(section));
  return std::nullopt;
}

Terrain scaled(const Terrain& terrain, double factor) {
  Terrain t = terrain;
  for (TerrainSection& s : t.sections) {
    std::visit([factor](auto& shape) { scale(shape, factor); }, s.shape);
    for (double* length : {&s.begin_m, &s.length_m, &s.base_m, &s.end_m}) *length *= factor;
  }
  for (TerrainZone& zone : t.zones) {
    for (double* length : {&zone.from_m, &zone.to_m, &zone.left_m, &zone.right_m})
      *length *= factor;
  }
  return t;
}

std::shared_ptr<const Terrain> flat_terrain() {
  static const auto kFlat = std::make_shared<const Terrain>();
  return kFlat;
}

}  // namespace gaitpad
