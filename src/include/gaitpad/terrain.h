// The ground that a character walks on: its height, its slope and its edges at any place.
// Meredith & Maddock 2005, section 3.3: "examination of the surrounding terrain", uneven ground,
// climbing and descending steps.
//
// A terrain is sections in a row along +z, each beginning at the height where the one before ends;
// sideways they have no end. Before the first one and behind the last it is level. Only a riser of
// stairs is an edge: everything else bends so little that a sole of 0.25 m lies on it within 4 mm.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr int kMaxSections = 64;
inline constexpr int kMaxZones = 64;
inline constexpr int kMaxFieldSide = 1024;  // samples
// Of the height along any straight line on the ground but across a riser: its second derivative.
// A chord of s metres then leaves the ground by bend s^2 / 8 at most: 4 mm at 0.25 m.
inline constexpr double kMaxBend_1_m = 0.512;
inline constexpr double kMaxGrade = 0.6;  // steepest fall line

// What a probe finds under a place.
struct Ground {
  double height_m = 0.0;
  vec3 normal = kUp;  // unit
  int piece = 0;      // where it changes between two places, an edge (a riser) lies between them
};

struct FlatSection {
  double length_m = 1.0;
};
// Level at both ends: the grade grows over `rounding_m` (a parabola), holds, and fades over
// another.
struct SlopeSection {
  double length_m = 1.0, grade = 0.0, rounding_m = 0.5;
};
// Riser k stands at k tread_m from the section's begin, a tread behind each. Negative: downstairs.
struct StairsSection {
  double rise_m = 0.17, tread_m = 0.28;
  int count = 1;
};
struct Wave {
  double x_rad_m = 0.0, z_rad_m = 0.0, phase_rad = 0.0, height_m = 0.0;
};
// A sum of waves that have no common period, faded to level at both ends.
struct RoughSection {
  double length_m = 1.0, fade_m = 1.0;
  std::array<Wave, 5> wave;
};
// Samples of a height field, smoothed by cubic B-splines (so the slope has no jumps and a single
// pixel no spike), faded to level at both ends and both sides; beyond these it is level.
struct HeightField {
  int columns = 0, rows = 0;    // along -x, from the walker's left; along +z
  std::vector<float> height_m;  // above the section's begin, row by row; scaled() leaves them
};
struct FieldSection {
  double length_m = 1.0, fade_m = 1.0, pixel_m = 0.1, height_scale = 1.0;
  std::shared_ptr<const HeightField> field;
};

using SectionShape =
    std::variant<FlatSection, SlopeSection, StairsSection, RoughSection, FieldSection>;
struct TerrainSection {
  SectionShape shape;
  double begin_m = 0.0, length_m = 0.0;  // along z
  double base_m = 0.0, end_m = 0.0;      // heights at its begin and its end
  int piece = 0;                         // of the ground before it
};

// Who comes here walks in this style. On its border is within.
struct TerrainZone {
  double from_m = 0.0, to_m = 0.0;  // along z
  double left_m = std::numeric_limits<double>::infinity();
  double right_m = -std::numeric_limits<double>::infinity();  // along x: right_m <= x <= left_m
  std::string style;
  std::string where;  // "course.toml:12", for sentences
};

// Immutable after load. World frame: characters start at z = 0 and walk along +z.
struct Terrain {
  std::string name = "flat";
  std::vector<TerrainSection> sections;
  std::vector<TerrainZone> zones;  // of several that hold a place the last one counts
};

// Total: any place has a ground, NaN too. No heap. On the very line of a riser lies its upper
// tread.
Ground ground_at(const Terrain& terrain, double x_m, double z_m) noexcept;

// From the riser before a place to the one behind it, along z; without one infinite.
struct Stretch {
  double from_m = -std::numeric_limits<double>::infinity();
  double to_m = std::numeric_limits<double>::infinity();
};
Stretch piece_at(const Terrain& terrain, double z_m) noexcept;

// One plane at height 0: no section changes anything.
bool is_flat(const Terrain& terrain) noexcept;
// The shortest stretch between two risers; infinite where there are none.
double least_tread_m(const Terrain& terrain) noexcept;
// Where the last section ends; 0 without any.
double length_m(const Terrain& terrain) noexcept;

// Puts a section behind the others. Refused, with the cause as the sentence, are numbers that are
// not finite or out of proportion, ground that bends or climbs too much, and more than
// kMaxSections.
std::optional<Error> add_section(Terrain& terrain, const SectionShape& shape);
// The greatest height is at most `amplitude_m` off the mean; no wave is shorter than
// `wavelength_m`.
RoughSection rough_section(double length_m, double amplitude_m, double wavelength_m, double fade_m,
                           std::uint32_t seed);

// The same ground, all lengths and heights times `factor` (> 0), the zones' too.
Terrain scaled(const Terrain& terrain, double factor);

// One plane at height 0, shared by all that walk on it.
std::shared_ptr<const Terrain> flat_terrain();

}  // namespace gaitpad
