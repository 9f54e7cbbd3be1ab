// The ground that a character walks on: its height, its slope and its edges at any place.
// Meredith & Maddock 2005, section 3.3: "examination of the surrounding terrain", uneven ground,
// climbing and descending steps.
//
// A terrain is a row of sections along +z. Each begins at the height where the one before ends, and
// sideways it has no end. Before the first and behind the last section the ground is level. Only
// the risers of stairs are edges: everything else bends so little that a sole of 0.25 m lies on it
// within 4 mm. add_section() refuses ground on which a sole would not lie.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr int kMaxSections = 64;
inline constexpr int kMaxZones = 64;
inline constexpr int kMaxFieldSide = 1024;  // most samples on a side of a height field
// Bound on the second derivative of the height along any straight line that crosses no riser. A
// chord of s metres then leaves the ground by bend s^2 / 8 at most: 4 mm at 0.25 m.
inline constexpr double kMaxBend_1_m = 0.512;
inline constexpr double kMaxGrade = 0.6;  // greatest rise over run along the steepest line

// The ground at one place, from ground_at(). Risers cut the ground into pieces, counted along +z:
// if two places are on different pieces, a riser is between them.
struct Ground {
  double height_m = 0.0;  // height in the world
  vec3 normal = kUp;      // unit vector in the world
  int piece = 0;          // number of the piece; 0 before the first riser
};

// A level section. The caller fills sections; add_section() refuses numbers outside of the ranges
// below. Each section is 0.1 to 1000 m long.
struct FlatSection {
  double length_m = 1.0;  // along z, as the length of all sections
};
// A section that is level at both ends: over `rounding_m` the grade grows from 0 (a parabola),
// stays constant, and over another `rounding_m` falls back to 0. A negative grade leads down.
struct SlopeSection {
  double length_m = 1.0;
  double grade = 0.0;       // rise over run, -kMaxGrade .. kMaxGrade
  double rounding_m = 0.5;  // length of each rounding, above 0, at most half the section's
};
// Stairs with `count` risers. Riser k (from 0) is k tread_m after the section's begin, with a tread
// after it. A negative rise leads down.
struct StairsSection {
  double rise_m = 0.17;   // height of a riser: 0.01 to 0.4, or as much down
  double tread_m = 0.28;  // length of a tread along z, 0.15 to 2
  int count = 1;          // number of risers, 1 to 100
};
// A wave of height_m sin(x_rad_m x + z_rad_m u + phase_rad), with u counted from the section's
// begin. Waves are longer than 6 cm, and their sum keeps the bounds on bend and grade.
struct Wave {
  double x_rad_m = 0.0, z_rad_m = 0.0, phase_rad = 0.0, height_m = 0.0;
};
// A sum of waves that have no common period, faded to level at both ends.
struct RoughSection {
  double length_m = 1.0;
  // Length of the fade at each end; above 0, at most half of the section's length.
  double fade_m = 1.0;
  std::array<Wave, 5> wave;
};
// Samples of heights. A section smooths them by cubic B-splines, so that the slope does not jump
// and a single pixel is no spike, and fades them to level at both ends and both sides. Beyond its
// sides the section is level.
struct HeightField {
  // Numbers of samples along -x from the walker's left and along +z; 2 .. kMaxFieldSide.
  int columns = 0, rows = 0;
  // Heights above the section's begin, row by row; multiplied by height_scale.
  std::vector<float> height_m;
};
struct FieldSection {
  double length_m = 1.0;
  // Width of the fade at each end and side; above 0, at most half of length and width.
  double fade_m = 1.0;
  double pixel_m = 0.1;                      // distance of neighbouring samples, 0.001 to 100
  double height_scale = 1.0;                 // factor on the samples; no height may exceed 100 m
  std::shared_ptr<const HeightField> field;  // never null
};

using SectionShape =
    std::variant<FlatSection, SlopeSection, StairsSection, RoughSection, FieldSection>;
// A section in its place. add_section() fills it. Metres in the world.
struct TerrainSection {
  SectionShape shape;
  double begin_m = 0.0, length_m = 0.0;  // begin and length along z
  double base_m = 0.0, end_m = 0.0;      // heights at the section's begin and end
  int piece = 0;                         // number of the piece of ground that leads up to it
};

// A rectangle of the ground in which all characters walk in one style. Its border belongs to it. A
// terrain's file or the caller fills it. Bounds are in the world; they may be infinite.
struct TerrainZone {
  double from_m = 0.0, to_m = 0.0;  // along z: from_m <= z <= to_m
  double left_m = std::numeric_limits<double>::infinity();
  double right_m = -std::numeric_limits<double>::infinity();  // along x: right_m <= x <= left_m
  std::string style;
  std::string where;  // line that names the style, "course.toml:12"; errors begin with it
};

struct GroundPlace {
  double x_m = 0.0, z_m = 0.0;  // place in the world
};
// The ground of a game, of any slope in any direction, asked for by place in the world. The game
// fills all of it. It must keep the bounds of sections (kMaxBend_1_m, kMaxGrade) and has no edges:
// only Ground::height_m is read. A tick asks for some places, up to a few hundred when a flight is
// planned. The functions must not use heap or locks or throw, and for a crowd several threads may
// call them at once. A height that is not finite counts as 0.
struct AskedGround {
  Ground (*ask)(const void* game, double x_m, double z_m) noexcept = nullptr;
  const void* game = nullptr;  // passed to both functions; lives as long as the terrain
  // Asks for several places in one call: writes grounds[i] for each places[i]. May be null: then
  // ask() is called for each. The walk asks for at most kMostAsked at a time.
  void (*ask_several)(const void* game, std::span<const GroundPlace> places,
                      std::span<Ground> grounds) noexcept = nullptr;
};
inline constexpr int kMostAsked = 6;

// A height field in the world: samples on a square grid, straight between neighbours (bilinear).
// Beyond its border the ground is as at the border.
// The caller fills it.
struct GroundGrid {
  // Place of the first sample in the world: the corner of least x and z.
  double x_m = 0.0, z_m = 0.0;
  double spacing_m = 1.0;       // distance of neighbouring samples, 0.01 to 100
  int columns = 0, rows = 0;    // numbers of samples along +x and +z: 2 to 16,384 each
  std::vector<float> height_m;  // heights in the world, row by row: column + row * columns
};
// Checks that its numbers are in their ranges, and that it bends and climbs little enough for a
// sole: neighbouring cells differ in grade by at most kMaxBend_1_m * spacing_m, grades are at most
// kMaxGrade.
std::optional<Error> check(const GroundGrid& grid);
Ground ground_at(const GroundGrid& grid, double x_m, double z_m) noexcept;
// Makes the grid the ground of a game. The grid must live as long as the terrain.
AskedGround asked_ground(const GroundGrid& grid) noexcept;

// The whole ground. It does not change after loading. World frame: characters start at z = 0 and
// walk along +z.
struct Terrain {
  std::string name = "flat";
  std::vector<TerrainSection> sections;  // made by add_section(), at most kMaxSections
  std::vector<TerrainZone> zones;        // if zones overlap, the last one counts
  AskedGround asked;                     // if it is set, there are no sections
};
// Checks that all sections are as add_section() makes them, and that the zones' numbers are not
// NaN.
std::optional<Error> check(const Terrain& terrain);

// The ground at a place. Every place has one, even NaN. The line of a riser belongs to the upper
// tread. No heap.
Ground ground_at(const Terrain& terrain, double x_m, double z_m) noexcept;
// The ground at several places, in one call of a game that answers several. `grounds` has the
// length of `places`.
void grounds_at(const Terrain& terrain, std::span<const GroundPlace> places,
                std::span<Ground> grounds) noexcept;

// An interval of z between two risers; infinite on a side without one.
struct Stretch {
  double from_m = -std::numeric_limits<double>::infinity();
  double to_m = std::numeric_limits<double>::infinity();
};
// The piece of ground that a place is on.
Stretch piece_at(const Terrain& terrain, double z_m) noexcept;

// True if all of it is one plane at height 0.
bool is_flat(const Terrain& terrain) noexcept;
// The shortest interval between two risers; infinite if there are none.
double least_tread_m(const Terrain& terrain) noexcept;
// z of the end of the last section; 0 without sections.
double length_m(const Terrain& terrain) noexcept;

// Adds a section after the others, or returns why not: a number is not finite or out of proportion,
// the ground bends or climbs too much, or there are kMaxSections already.
std::optional<Error> add_section(Terrain& terrain, const SectionShape& shape);
// A rough section whose heights stay within `amplitude_m` of the mean and whose waves are
// `wavelength_m` long or longer. The same seed gives the same ground.
RoughSection rough_section(double length_m, double amplitude_m, double wavelength_m, double fade_m,
                           std::uint32_t seed);

// The ground with all lengths and heights multiplied by `factor` (> 0), also those of the zones.
Terrain scaled(const Terrain& terrain, double factor);

// One plane at height 0; all users share it.
std::shared_ptr<const Terrain> flat_terrain();

}  // namespace gaitpad
