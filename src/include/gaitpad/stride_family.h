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
struct StrideTrackOf {
  V stride_m{};
  // Where the heels stand along the path: the left foot's after its strike near phase 0.5, the
  // right foot's after phase 0.
  std::array<Vec<V>, 2> footprint_m{};
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

// What a style can ask of a stride.
enum class StrideWish : std::uint8_t {
  // A joint flexes less, its curve nears its mean. Of both legs: the pelvis gives way.
  stiff_hips,
  stiff_knees,
  stiff_ankles,
  // Of one leg: neither the pelvis nor the other leg changes.
  stiff_left_hip,
  stiff_left_knee,
  stiff_left_ankle,
  stiff_right_hip,
  stiff_right_knee,
  stiff_right_ankle,
  low_left,
  low_right,    // the heel is lifted kLowLift as high
  more_bounce,  // the pelvis' vertical travel is doubled: it sinks deeper
  less_bounce,  // it is gone: the pelvis stays as low as it was at its lowest
};
inline constexpr int kStrideWishes = 13;
inline constexpr double kLowLift = 0.5;  // how high a heel is lifted then

// The factor on the heel's height at a share of the flight, for a foot whose lift has the factor
// `lift`, at most 1. At the lift-off it acts in part, since the leg has to reach the floor, and
// near its strike the foot comes down as ever.
template <class V>
V low_lift(const V& u, const V& lift) noexcept {
  constexpr double kAll = 0.5, kUntil = 0.6;  // shares of the flight
  return mix(1.0, lift,
             smootherstep(u / kAll) * (1.0 - smootherstep((u - kUntil) / (1.0 - kUntil))));
}

// What a stride changes by at one phase when a wish is granted. The feet stand where they did. A
// low lift's heels are not in here (low_lift).
template <class V>
struct StrideChangeOf {
  Vec<V> pelvis_m{};
  std::array<Vec<V>, 2> heel_m{};  // in flight
  std::array<V, 2> pitch_rad{};    // of the feet
  std::array<std::array<V, kLegDofs>, 2> leg_rad{};
};
using StrideChange = StrideChangeOf<double>;
// Of a stride of ratio 1. In other strides it is smaller or larger with the ratio. Knots as in
// StrideTable.
struct StrideResponse {
  std::array<StrideChange, kCycleSamples> knot{};
};
// How much of each wish is granted, by StrideWish.
using StrideWishes = std::array<double, kStrideWishes>;

struct StrideFamily {
  double stand_m = 0.0;                  // the pelvis' height when standing,
  double lead_m = 0.0;                   // how far it is before the heels,
  double stand_roll_rad = 0.0;           // its roll, left side up positive,
  std::array<LegAngles, 2> stand_rad{};  // and the legs' angles
  // Walking backwards is walking forwards run back (Thorstensson 1986), but the feet land and leave
  // as Table I has it. These strides have negative lengths.
  std::vector<StrideTable> back;         // kBackRatios
  std::vector<StrideTable> table;        // kStrideRatios
  std::vector<StrideResponse> response;  // kStrideWishes; for walking forwards
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
std::array<StrideChange, kCycleSamples> knots_through(
    const std::array<StrideChange, kCycleSamples>& samples) noexcept;
// What all wishes that are granted change at a phase. No heap.
StrideChange change_at(const std::vector<StrideResponse>& response, const StrideWishes& granted,
                       double phase) noexcept;
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
