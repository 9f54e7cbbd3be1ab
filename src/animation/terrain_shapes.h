// The kinds of section that a terrain is made of, each in its own frame: u metres behind its begin,
// heights above it.
#pragma once
#include <optional>

#include "animation/terrain.h"

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

}  // namespace gaitpad
