// A family of clean strides: what a walk reads while it runs. For each of several stride lengths it
// holds one periodic stride in which heel and toe stand exactly where Table I of the paper
// (Meredith & Maddock 2005) plants them, and the joints are as near to the captured ones as that
// allows. gaitpad/clean_strides.h makes a family from a gait cycle.
//
// Strides are told apart by their *ratio*: their length over the data's. Phases count as in a
// GaitCycle. Places are in the travel frame of the stride (x to the left, y up, z ahead), which
// advances by stride_m in a phase of 1: where a place stands along the walk's path is its z plus
// phase * stride_m.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "gaitpad/gait_cycle.h"

namespace gaitpad {

inline constexpr int kStrideRatios = 8;
inline constexpr double kRatioStep = 0.2;  // ratios 0, 0.2 .. 1.4; 1 is the data's own stride
inline constexpr double kMostRatio = kRatioStep * (kStrideRatios - 1);
inline constexpr int kBackRatios = 5;  // backwards 0 .. 0.8: steps are shorter

// Structs of numbers alone may be those of several walks side by side (V as in gaitpad/math.h).
template <class V>
struct StrideFootOf {
  Vec<V> heel_m{};
  // The foot's rotation from flat and straight ahead: about its transverse axis, toe down positive;
  // then, in the turned foot, by the rotation vector whose parts are about its upward axis and
  // about its length.
  V pitch_rad{}, twist_rad{}, roll_rad{};
};

// A stride at one phase. What is 0 when standing is 0 here, too: the pelvis' place counts from the
// standing pelvis over the path, and angles from the standing pose's.
template <class V>
struct StrideCellOf {
  Vec<V> pelvis_m{};
  V pelvis_yaw_rad{};
  Vec<V> pelvis_tilt{};  // the rest of its rotation, as a rotation vector, from the standing roll
  std::array<StrideFootOf<V>, 2> foot{};
  std::array<std::array<V, kLegDofs>, 2> leg_rad{};
};
using StrideFoot = StrideFootOf<double>;
using StrideCell = StrideCellOf<double>;

// Where a stride goes.
template <class V>
struct FootprintsOf {
  V stride_m{};
  // Where the heels stand along the path: the left foot's after its strike near phase 0.5, the
  // right foot's after phase 0.
  std::array<Vec<V>, 2> footprint_m{};
};
using Footprints = FootprintsOf<double>;
template <class V>
struct StrideTrackOf : FootprintsOf<V> {
  V low_m{}, high_m{};  // between which the pelvis rises and falls, as in StrideCell
};
using StrideTrack = StrideTrackOf<double>;

// What turns strides of the motion into the character's: all lengths grow by `length`, but those of
// the pelvis by `pelvis`.
struct StrideScale {
  double length = 1.0, pelvis = 1.0;
  vec3 hips_m{0.0};                  // the middle of the hips, from the pelvis, in the motion
  double stand_roll_rad = 0.0;       // of the motion's standing pelvis
  std::array<vec3, 2> standing_m{};  // that middle when standing: in the motion, on the character
  std::array<vec3, 2> apart_m{};     // by Side: what a wider or narrower pelvis moves the feet by
};

// One stride length. All of it may be added and scaled, number by number.
struct StrideTable : StrideTrack {
  // Control points of the periodic uniform cubic B-spline in phase.
  std::array<StrideCell, kCycleSamples> knot{};
};

// stride_family() fills it (gaitpad/clean_strides.h). Metres and radians of the motion's skeleton.
struct StrideFamily {
  double stand_m = 0.0;                  // the pelvis' height when standing,
  double lead_m = 0.0;                   // how far it is before the heels,
  double stand_roll_rad = 0.0;           // its roll, left side up positive,
  std::array<LegAngles, 2> stand_rad{};  // and the legs' angles
  // Walking backwards is walking forwards run back (Thorstensson 1986), but the feet land and leave
  // as Table I has it. These strides have negative lengths.
  std::vector<StrideTable> back;   // kBackRatios
  std::vector<StrideTable> table;  // kStrideRatios
};

// A stride at one phase and ratio.
template <class V>
struct StridePlaceOf {
  StrideTrackOf<V> track;
  StrideCellOf<V> cell;
};
using StridePlace = StridePlaceOf<double>;
// Knots of the spline that goes through these samples of a cycle.
std::array<StrideCell, kCycleSamples> knots_through(
    const std::array<StrideCell, kCycleSamples>& samples) noexcept;
StrideCell mixed(const StrideCell& a, const StrideCell& b, double share_a, double share_b) noexcept;
// A cubic spline in phase, smooth to the second derivative, and cubic in ratio; the ratio is
// clamped to the family's. No heap.
StridePlace stride_at(const std::vector<StrideTable>& table, double phase, double ratio) noexcept;

// The share of the cycle's time that the roll of a foot (Table I (b)) takes in strides of this
// ratio, from its share in the data: double support is longer in short steps.
double roll_time_share(double data_share, double ratio) noexcept;

// The time at which a phase is reached that runs through the four stages of a cycle, each in its
// own time, at a smooth rate: cubic in each stage, and at a border between two the mean of their
// rates.
struct StageClock {
  std::array<double, 4> phase_share{},
      time_share{};                             // roll right, flight left, roll left, flight right
  double time_at(double phase) const noexcept;  // both in cycles
};

}  // namespace gaitpad
