#include <fmt/format.h>

#include "animation/terrain_shapes.h"

namespace gaitpad {
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

}  // namespace gaitpad
