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
// Distance of neighbouring ratios: 0, 0.2 .. 1.4; 1 is the data's own stride.
inline constexpr double kRatioStep = 0.2;
inline constexpr double kMostRatio = kRatioStep * (kStrideRatios - 1);
// Ratios of backward strides, 0 .. 0.8: backward steps are shorter.
inline constexpr int kBackRatios = 5;

struct StrideFoot {
  vec3 heel_m{0.0};
  // The foot's rotation from flat and straight ahead: first about its transverse axis (toe down
  // positive), then, in the turned foot, by the rotation vector whose parts are about its upward
  // axis and along its length.
  double pitch_rad{}, twist_rad{}, roll_rad{};
};

// A stride at one phase, relative to standing: the pelvis' place from the standing pelvis over the
// path, angles from the standing pose's.
struct StrideCell {
  vec3 pelvis_m{0.0};
  double pelvis_yaw_rad{};
  // The rest of the pelvis' rotation from its standing roll, as a rotation vector.
  vec3 pelvis_tilt{0.0};
  std::array<StrideFoot, 2> foot{};
  std::array<std::array<double, kLegDofs>, 2> leg_rad{};
};

// The length of a stride and the places of its footprints.
struct Footprints {
  double stride_m{};
  // The places of the standing heels along the path: the left foot's after its strike near phase
  // 0.5, the right foot's after phase 0.
  std::array<vec3, 2> footprint_m{};
};
struct StrideTrack : Footprints {
  double low_m{}, high_m{};  // lowest and highest place of the pelvis, as in StrideCell
};

// Scales strides of the motion to the character: lengths of the pelvis by `pelvis`, all others by
// `length`.
struct StrideScale {
  double length = 1.0, pelvis = 1.0;
  vec3 hips_m{0.0};                  // from the pelvis to the middle of the hips, in the motion
  double stand_roll_rad = 0.0;       // roll of the motion's standing pelvis
  std::array<vec3, 2> standing_m{};  // that middle when standing: in the motion, in the character
  std::array<vec3, 2> apart_m{};     // shift of the feet for a wider or narrower pelvis, by Side
};

// The strides of one length. All of it may be added and scaled, number by number.
struct StrideTable : StrideTrack {
  // Control points of the periodic uniform cubic B-spline in phase.
  std::array<StrideCell, kCycleSamples> knot{};
};

// Strides of several lengths; stride_family() fills it (gaitpad/clean_strides.h). Metres and
// radians of the motion's skeleton.
struct StrideFamily {
  double stand_m = 0.0;                  // height of the standing pelvis
  double lead_m = 0.0;                   // distance of the standing pelvis in front of the heels
  double stand_roll_rad = 0.0;           // roll of the standing pelvis, left side up positive
  std::array<LegAngles, 2> stand_rad{};  // angles of the standing legs
  // Walking backwards is walking forwards run back (Thorstensson 1986), but the feet land and leave
  // as Table I has it. These strides have negative lengths.
  std::vector<StrideTable> back;   // kBackRatios tables
  std::vector<StrideTable> table;  // kStrideRatios tables
};

// A stride at one phase and ratio.
struct StridePlace {
  StrideTrack track;
  StrideCell cell;
};
// Knots of the spline through these samples of a cycle.
std::array<StrideCell, kCycleSamples> knots_through(
    const std::array<StrideCell, kCycleSamples>& samples) noexcept;
StrideCell mixed(const StrideCell& a, const StrideCell& b, double share_a, double share_b) noexcept;
// The stride at a phase and a ratio: a cubic spline in phase, smooth to the second derivative, and
// cubic in ratio; the ratio is clamped to the family's. No heap.
StridePlace stride_at(const std::vector<StrideTable>& table, double phase, double ratio) noexcept;

// The share of the cycle's time that the roll of a foot (Table I (b)) takes in strides of this
// ratio, from its share in the data: double support is longer in short steps.
double roll_time_share(double data_share, double ratio) noexcept;
// Double support takes about a quarter of an adult's cycle at an easy pace, a third at a stroll and
// a fifth at a brisk one: relative growth of a roll's share at stride length 0, steepness with
// which it falls for longer strides, and the share's bounds.
inline constexpr double kLongerRoll = 0.9, kShorterRoll = 2.4;
inline constexpr double kLeastRollShare = 0.04, kMostRollShare = 0.22;

// Converts a phase to the time at which it is reached. Each of the four stages of a cycle has a
// duration; the rate is smooth: cubic in each stage, and at a border between two the mean of their
// rates.
struct StageClock {
  // Shares of the cycle's phase and time: roll right, flight left, roll left, flight right.
  std::array<double, 4> phase_share{}, time_share{};
  double time_at(double phase) const noexcept;  // Both numbers are in cycles.
};

}  // namespace gaitpad
