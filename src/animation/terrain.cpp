#include "gaitpad/terrain.h"

#include <optional>

#include "base/ranges.h"
#include "base/text.h"
#include "motion/stencil.h"

namespace gaitpad {
namespace {

// A terrain is a row of sections. Each kind of section answers the same four questions: how long it
// is, whether one can walk on it, how it grows with a scale, and its surface at a place. Such a
// place has two coordinates: x as in the world, and u, the metres from the section's begin. Heights
// are relative to the height at which the section begins.

bool is_within(double x, double min, double max) noexcept { return x >= min && x <= max; }

std::optional<Error> metres_problem(const char* what, double is_m, double min_m, double max_m) {
  if (is_within(is_m, min_m, max_m)) return std::nullopt;
  return Error{std::string("a ") + what + " of " + short_number(is_m) + " m is not within " +
               short_number(min_m) + " and " + short_number(max_m) + " m"};
}
std::optional<Error> length_problem(double length_m) {
  return metres_problem("length", length_m, 0.1, 1000.0);
}

// The reason why `what`, at both ends of a length, is longer than that, if it is.
std::optional<Error> ends_problem(double end_m, const char* what, double length_m) {
  if (end_m > 0.0 && 2.0 * end_m <= length_m) return std::nullopt;
  return Error{short_number(end_m) + " m of " + what + " do not fit into " +
               short_number(length_m) + " m"};
}

// The reason why a sole would not lie on a surface with this bend and grade.
std::optional<Error> shape_problem(double bend_1_m, double grade) {
  if (!(grade <= kMaxGrade))
    return Error{"a grade of " + fixed(grade, 2) + " is too steep: at most " +
                 short_number(kMaxGrade)};
  if (!(bend_1_m <= kMaxBend_1_m)) {
    const std::string bend = std::isfinite(bend_1_m) ? "by " + fixed(bend_1_m, 2) : "infinitely";
    return Error{"a sole would not lie on ground that bends " + bend + " per metre: at most " +
                 short_number(kMaxBend_1_m)};
  }
  return std::nullopt;
}

struct ShapePoint {
  double height_m = 0.0;
  double dx = 0.0, dz = 0.0;  // slopes along x and z
  int risers = 0;             // passed since the section's begin
};

// Waves and height fields are multiplied by a share that is 0 at both ends of the section and 1 in
// the middle, so that the section is level where it joins its neighbours. This is the share at u,
// and its slope.
struct Share {
  double value = 1.0, slope = 0.0;
};
Share share_at(double u_m, double length_m, double fade_m) noexcept {
  const bool near = u_m < 0.5 * length_m;
  const double s = (near ? u_m : length_m - u_m) / fade_m;
  if (s >= 1.0) return {};
  const double t = std::max(s, 0.0);
  return {t * t * (3.0 - 2.0 * t), (near ? 6.0 : -6.0) * t * (1.0 - t) / fade_m};
}

// The greatest height, slope and bend of a surface, and the greatest slope and bend of its share.
struct Most {
  double height_m = 0.0, grade = 0.0, bend_1_m = 0.0;
};
struct MostOfShare {
  double slope_1_m = 0.0, bend_1_m2 = 0.0;
};
// Checks the slope and the bend of surface times share, by the product rule.
std::optional<Error> faded_problem(double length_m, double fade_m, const MostOfShare& share,
                                   const Most& surface) {
  if (auto problem = length_problem(length_m)) return problem;
  if (auto problem = ends_problem(fade_m, "fading at both ends", length_m)) return problem;
  return shape_problem(
      surface.bend_1_m + 2.0 * share.slope_1_m * surface.grade + share.bend_1_m2 * surface.height_m,
      surface.grade + share.slope_1_m * surface.height_m);
}

vec3 normal_of(double dx, double dz) noexcept {
  return vec3(-dx, 1.0, -dz) / std::sqrt(1.0 + dx * dx + dz * dz);
}

// --- Flat ----------------------------------------------------------------------------------------

template <class Section>
double length_of(const Section& section) noexcept {
  return section.length_m;
}
ShapePoint point_at(const FlatSection&, double, double) noexcept { return {}; }

std::optional<Error> problem_of(const FlatSection& flat) { return length_problem(flat.length_m); }

void scale(FlatSection& flat, double factor) noexcept { flat.length_m *= factor; }

// --- Slope: level at both ends, rounded by parabolas ---------------------------------------------

double rise_of(const SlopeSection& slope) noexcept {
  return slope.grade * (slope.length_m - slope.rounding_m);
}
ShapePoint point_at(const SlopeSection& slope, double, double u) noexcept {
  const double r = slope.rounding_m, g = slope.grade;
  if (u < r) return {.height_m = 0.5 * g * u * u / r, .dz = g * u / r};
  const double left = slope.length_m - u;
  if (left < r) return {.height_m = rise_of(slope) - 0.5 * g * left * left / r, .dz = g * left / r};
  return {.height_m = g * (u - 0.5 * r), .dz = g};
}

std::optional<Error> problem_of(const SlopeSection& slope) {
  if (auto problem = length_problem(slope.length_m)) return problem;
  if (auto problem = ends_problem(slope.rounding_m, "rounding at both ends", slope.length_m))
    return problem;
  const double grade = std::abs(slope.grade);
  return shape_problem(grade / slope.rounding_m, grade);
}

void scale(SlopeSection& slope, double factor) noexcept {
  slope.length_m *= factor, slope.rounding_m *= factor;
}

// --- Stairs --------------------------------------------------------------------------------------

double length_of(const StairsSection& stairs) noexcept { return stairs.tread_m * stairs.count; }
// The line of a riser belongs to the upper tread: upstairs to the tread after it, downstairs to the
// one before it.
ShapePoint point_at(const StairsSection& stairs, double, double u) noexcept {
  int passed = 0;
  for (int k = 0; k < stairs.count; ++k) {
    const double riser_m = k * stairs.tread_m;
    passed += stairs.rise_m > 0.0 ? u >= riser_m : u > riser_m;
  }
  return {.height_m = stairs.rise_m * passed, .risers = passed};
}

std::optional<Error> problem_of(const StairsSection& stairs) {
  constexpr int kMaxRisers = 100;  // of one section
  if (auto problem = metres_problem("tread", stairs.tread_m, 0.15, 2.0)) return problem;
  if (auto problem = metres_problem("rise", std::abs(stairs.rise_m), 0.01, 0.4))
    return Error{problem->message + ", up or down"};
  if (stairs.count < 1 || stairs.count > kMaxRisers)
    return Error{std::to_string(stairs.count) + " risers are not 1 to " +
                 std::to_string(kMaxRisers)};
  return std::nullopt;
}

void scale(StairsSection& stairs, double factor) noexcept {
  stairs.rise_m *= factor, stairs.tread_m *= factor;
}

// --- Rough: a sum of waves -----------------------------------------------------------------------

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

std::optional<Error> problem_of(const RoughSection& rough) {
  Most most;
  for (const Wave& w : rough.wave) {
    const double k = std::sqrt(w.x_rad_m * w.x_rad_m + w.z_rad_m * w.z_rad_m);
    if (!(k < 100.0)) return Error{"a wave is shorter than 6 cm"};
    if (!std::isfinite(w.phase_rad)) return Error{"phase_rad of a wave is not finite"};
    const double height_m = std::abs(w.height_m);
    most.height_m += height_m, most.grade += height_m * k, most.bend_1_m += height_m * k * k;
  }
  // Greatest slope and bend of the share, which is a smoothstep.
  const MostOfShare share{1.5 / rough.fade_m, 6.0 / (rough.fade_m * rough.fade_m)};
  return faded_problem(rough.length_m, rough.fade_m, share, most);
}

void scale(RoughSection& rough, double factor) noexcept {
  rough.length_m *= factor, rough.fade_m *= factor;
  for (Wave& w : rough.wave) w.height_m *= factor, w.x_rad_m /= factor, w.z_rad_m /= factor;
}

// --- Height field: samples under a spline --------------------------------------------------------

// Weights of four samples for the value and the slope of a cubic B-spline at t in [0, 1) between
// the second and the third of them.
struct Spline {
  std::array<double, 4> value, slope;
};
Spline spline_at(double t) noexcept {
  const double s = 1.0 - t;
  return {spline_weights(t),
          {-0.5 * s * s, 1.5 * t * t - 2.0 * t, -1.5 * s * s + 2.0 * s, 0.5 * t * t}};
}

// A sample of a height field or of a game's grid, which lie in rows.
template <class Heights>
double height_in(const Heights& heights, int column, int row) noexcept {
  return heights
      .height_m[static_cast<std::size_t>(row) * static_cast<std::size_t>(heights.columns) +
                static_cast<std::size_t>(column)];
}
// True if the sides have 2 to `most` samples, and the heights are as many as they say.
template <class Heights>
bool has_sides(const Heights& heights, int most) noexcept {
  const int columns = heights.columns, rows = heights.rows;
  return columns >= 2 && rows >= 2 && columns <= most && rows <= most &&
         heights.height_m.size() ==
             static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}
// The same, beyond the border the sample at the border.
template <class Heights>
double sample(const Heights& heights, int column, int row) noexcept {
  return height_in(heights, std::clamp(column, 0, heights.columns - 1),
                   std::clamp(row, 0, heights.rows - 1));
}

// The spline's surface before it is faded. `across` and `along` count samples from column 0, row 0.
ShapePoint unfaded(const FieldSection& section, double across, double along) noexcept {
  const int c = static_cast<int>(std::floor(across)), r = static_cast<int>(std::floor(along));
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

// The greatest height in a field or a grid, and the greatest first, second and mixed difference of
// neighbouring samples.
struct Differences {
  double height = 0.0, step = 0.0, bend = 0.0, twist = 0.0;
};
template <class Heights>
Differences differences(const Heights& f) noexcept {
  Differences most;
  for (int r = 0; r < f.rows; ++r) {
    for (int c = 0; c < f.columns; ++c) {
      const double h = sample(f, c, r), right = sample(f, c + 1, r), far = sample(f, c, r + 1);
      most.height = std::max(most.height, std::abs(h));
      most.step = std::max({most.step, std::abs(right - h), std::abs(far - h)});
      // Samples at the border need no bend: beyond it the ground is level, or a share is 0 there.
      if (c > 0 && c + 1 < f.columns)
        most.bend = std::max(most.bend, std::abs(right - 2.0 * h + sample(f, c - 1, r)));
      if (r > 0 && r + 1 < f.rows)
        most.bend = std::max(most.bend, std::abs(far - 2.0 * h + sample(f, c, r - 1)));
      most.twist = std::max(most.twist, std::abs(sample(f, c + 1, r + 1) - right - far + h));
    }
  }
  return most;
}

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

// Slopes and bends of a B-spline are means of its samples' differences, so those bound them.
std::optional<Error> problem_of(const FieldSection& section) {
  if (!section.field) return Error{"the height field is missing"};
  const HeightField& f = *section.field;
  if (!has_sides(f, kMaxFieldSide))
    return Error{std::to_string(f.columns) + " x " + std::to_string(f.rows) +
                 " samples are not 2 to " + std::to_string(kMaxFieldSide) + " a side"};
  const auto is_finite = [](float h) { return std::isfinite(h); };
  if (!std::all_of(f.height_m.begin(), f.height_m.end(), is_finite))
    return Error{"a height of the field is not finite"};
  const double m = section.pixel_m, n = section.height_scale;
  if (!is_within(m, 1e-3, 100.0)) return Error{"a sample is not 1 mm to 100 m wide"};
  const double width_m = (f.columns - 1) * m;
  if (auto problem = ends_problem(section.fade_m, "fading at both sides", width_m)) return problem;
  const Differences most = differences(f);
  if (!(most.height * n < 100.0)) return Error{"a height is beyond 100 m"};
  // The share is a product of two, across and along; these numbers bound it in any direction.
  const double slope = std::sqrt(2.0) * 1.5 / section.fade_m;
  const double bend = (6.0 + 1.5 * 1.5) / (section.fade_m * section.fade_m);
  // Within one sample of the border the surface is cut off, where the share is small.
  const double cut = 3.0 * most.step * n / (section.fade_m * section.fade_m);
  return faded_problem(section.length_m, section.fade_m, {slope, bend},
                       {most.height * n, std::sqrt(2.0) * most.step * n / m,
                        (most.bend + most.twist) * n / (m * m) + cut});
}

void scale(FieldSection& section, double factor) noexcept {
  section.length_m *= factor, section.fade_m *= factor;
  section.pixel_m *= factor, section.height_scale *= factor;
}

// --- The row of sections -------------------------------------------------------------------------

// Places farther away count as this far, because sin_cos() is exact up to 1e5 rad only. NaN becomes
// -kFar_m.
constexpr double kFar_m = 1e4;

double bounded_place(double x_m) noexcept {
  return x_m > -kFar_m ? std::min(x_m, kFar_m) : -kFar_m;
}

// The difference in height between a section's end and its begin.
double rise_of(const SectionShape& shape) noexcept {
  if (const auto* slope = std::get_if<SlopeSection>(&shape)) return rise_of(*slope);
  const auto* stairs = std::get_if<StairsSection>(&shape);
  return stairs ? stairs->rise_m * stairs->count : 0.0;
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

// Calls `visit(z_m, is_up)` for each riser, in order along z.
template <class Visit>
void for_each_riser(const Terrain& terrain, const Visit& visit) noexcept {
  for (const TerrainSection& s : terrain.sections) {
    const auto* stairs = std::get_if<StairsSection>(&s.shape);
    for (int k = 0; stairs && k < stairs->count; ++k)
      visit(s.begin_m + k * stairs->tread_m, stairs->rise_m > 0.0);
  }
}

// A pseudo-random number in [0, 1) for a seed, by the mixer of splitmix32.
double random_share(std::uint32_t seed) noexcept {
  std::uint32_t x = seed + 0x9e3779b9u;
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0x735a2d97u;
  return static_cast<double>(x ^ (x >> 15)) / 4294967296.0;
}

// --- The ground of a game ------------------------------------------------------------------------

Ground finite_or_floor(const Ground& ground) noexcept {
  return std::isfinite(ground.height_m) ? ground : Ground{};
}

// A coordinate as the index of the sample before it, and the share of the way to the next sample.
struct GridPlace {
  int cell = 0;
  double share = 0.0;
};
GridPlace grid_place(double from_m, double spacing_m, int samples) noexcept {
  const double at = from_m / spacing_m, last = samples - 1;
  if (!(at > 0.0)) return {};
  if (at >= last) return {samples - 2, 1.0};
  const int cell = static_cast<int>(at);
  return {cell, at - cell};
}

Ground ask_grid(const void* grid, double x_m, double z_m) noexcept {
  return ground_at(*static_cast<const GroundGrid*>(grid), x_m, z_m);
}

}  // namespace

std::optional<Error> check(const GroundGrid& grid) {
  constexpr int kMaxGridSide = 16'384;  // samples of a side: 1 GiB in all
  if (auto problem = range_problem("GroundGrid: spacing_m", grid.spacing_m, 0.01, 100.0))
    return problem;
  if (!std::isfinite(grid.x_m) || !std::isfinite(grid.z_m))
    return Error{"GroundGrid: x_m or z_m is not finite"};
  const int columns = grid.columns, rows = grid.rows;
  if (!has_sides(grid, kMaxGridSide))
    return Error{"GroundGrid: " + std::to_string(grid.height_m.size()) + " heights are not " +
                 std::to_string(columns) + " x " + std::to_string(rows) + " samples, 2 to " +
                 std::to_string(kMaxGridSide) + " a side"};
  for (int i = 0; i < columns * rows; ++i) {
    if (!std::isfinite(grid.height_m[i]))
      return Error{"GroundGrid: height_m of column " + std::to_string(i % columns) + ", row " +
                   std::to_string(i / columns) + " is not finite"};
  }
  const Differences most = differences(grid);
  if (auto problem =
          shape_problem(most.bend / (grid.spacing_m * grid.spacing_m), most.step / grid.spacing_m))
    return Error{"GroundGrid: " + problem->message};
  return std::nullopt;
}

Ground ground_at(const GroundGrid& grid, double x_m, double z_m) noexcept {
  const GridPlace x = grid_place(x_m - grid.x_m, grid.spacing_m, grid.columns),
                  z = grid_place(z_m - grid.z_m, grid.spacing_m, grid.rows);
  const double near = height_in(grid, x.cell, z.cell), left = height_in(grid, x.cell + 1, z.cell),
               ahead = height_in(grid, x.cell, z.cell + 1),
               far = height_in(grid, x.cell + 1, z.cell + 1);
  const double twist = near - left - ahead + far;
  const double dx = (left - near + twist * z.share) / grid.spacing_m,
               dz = (ahead - near + twist * x.share) / grid.spacing_m;
  return {near + (left - near) * x.share + (ahead - near) * z.share + twist * x.share * z.share,
          normal_of(dx, dz), 0};
}

AskedGround asked_ground(const GroundGrid& grid) noexcept { return {&ask_grid, &grid}; }

Ground ground_at(const Terrain& terrain, double x_m, double z_m) noexcept {
  if (terrain.asked.ask != nullptr)
    return finite_or_floor(terrain.asked.ask(terrain.asked.game, x_m, z_m));
  const double z = bounded_place(z_m);
  const TerrainSection* s = section_at(terrain, z);
  if (!s) return {};
  const double u = z - s->begin_m;
  if (u > s->length_m) return {s->end_m, kUp, s->piece + risers_of(s->shape)};
  const double x = bounded_place(x_m);
  const ShapePoint at =
      std::visit([&](const auto& shape) { return point_at(shape, x, u); }, s->shape);
  const vec3 normal = at.dx == 0.0 && at.dz == 0.0 ? kUp : normal_of(at.dx, at.dz);
  return {s->base_m + at.height_m, normal, s->piece + at.risers};
}

void grounds_at(const Terrain& terrain, std::span<const GroundPlace> places,
                std::span<Ground> grounds) noexcept {
  if (terrain.asked.ask == nullptr || terrain.asked.ask_several == nullptr) {
    for (std::size_t i = 0; i < places.size(); ++i)
      grounds[i] = ground_at(terrain, places[i].x_m, places[i].z_m);
    return;
  }
  terrain.asked.ask_several(terrain.asked.game, places, grounds);
  for (Ground& ground : grounds) ground = finite_or_floor(ground);
}

Stretch piece_at(const Terrain& terrain, double z_m) noexcept {
  Stretch stretch;
  for_each_riser(terrain, [&](double riser_m, bool is_up) {
    if (is_up ? riser_m <= z_m : riser_m < z_m) {
      stretch.from_m = riser_m;
    } else if (riser_m < stretch.to_m) {
      stretch.to_m = riser_m;
    }
  });
  return stretch;
}

bool is_flat(const Terrain& terrain) noexcept {
  if (terrain.asked.ask != nullptr) return false;
  return std::all_of(terrain.sections.begin(), terrain.sections.end(), [](const TerrainSection& s) {
    return std::holds_alternative<FlatSection>(s.shape);
  });
}

double least_tread_m(const Terrain& terrain) noexcept {
  double least = std::numeric_limits<double>::infinity(), last = -least;
  for_each_riser(terrain, [&](double riser_m, bool) {
    least = std::min(least, riser_m - last);
    last = riser_m;
  });
  return least;
}

double length_m(const Terrain& terrain) noexcept {
  if (terrain.sections.empty()) return 0.0;
  return terrain.sections.back().begin_m + terrain.sections.back().length_m;
}

RoughSection rough_section(double length_m, double amplitude_m, double wavelength_m, double fade_m,
                           std::uint32_t seed) {
  // The squares of the waves' lengths relative to the shortest one. The lengths have no common
  // measure, so the sum never repeats.
  constexpr std::array<double, 5> kSquares{1.0, 1.7, 2.6, 3.7, 5.3};
  // Angle between the directions of two waves, so that no two have the same direction.
  constexpr double kGoldenAngle_rad = 2.399963229728653;
  RoughSection rough;
  rough.length_m = length_m, rough.fade_m = fade_m;
  double sum = 0.0;
  for (const double square : kSquares) sum += square;
  const double turn = 2.0 * kPi * random_share(seed);
  for (std::size_t i = 0; i < kSquares.size(); ++i) {
    const double k = 2.0 * kPi / (wavelength_m * std::sqrt(kSquares[i]));
    const SinCos direction = sin_cos(turn + kGoldenAngle_rad * static_cast<double>(i));
    // A wave's height grows with the square of its length, so that all waves bend the ground
    // equally.
    rough.wave[i] = {
        .x_rad_m = k * direction.sin,
        .z_rad_m = k * direction.cos,
        .phase_rad = 2.0 * kPi * random_share(seed + 1 + static_cast<std::uint32_t>(i)),
        .height_m = amplitude_m * kSquares[i] / sum};
  }
  return rough;
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
  section.end_m = section.base_m + rise_of(shape);
  terrain.sections.push_back(std::move(section));
  return std::nullopt;
}

std::optional<Error> check(const Terrain& terrain) {
  if (terrain.asked.ask != nullptr && !terrain.sections.empty())
    return Error{terrain.name + ": has sections and a ground that is asked for: one of them"};
  Terrain laid;
  for (std::size_t i = 0; i < terrain.sections.size(); ++i) {
    const std::string what = terrain.name + ": sections[" + std::to_string(i) + "]";
    const TerrainSection& is = terrain.sections[i];
    if (auto problem = add_section(laid, is.shape)) return Error{what + ": " + problem->message};
    const TerrainSection& should = laid.sections.back();
    if (is.begin_m != should.begin_m || is.length_m != should.length_m ||
        is.base_m != should.base_m || is.end_m != should.end_m || is.piece != should.piece)
      return Error{what + " does not begin where the one before ends: lay it with add_section()"};
  }
  if (terrain.zones.size() > static_cast<std::size_t>(kMaxZones))
    return Error{terrain.name + ": there are too many zones"};
  for (const TerrainZone& zone : terrain.zones) {
    if (!(zone.from_m <= zone.to_m && zone.right_m <= zone.left_m))
      return Error{terrain.name + ": a zone ends before it begins, or a bound is not a number"};
  }
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
