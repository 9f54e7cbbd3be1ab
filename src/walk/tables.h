// A character's strides, bones and upper body in floats, as ticks read them. They do not change
// while it walks. A WalkModel holds them.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "gaitpad/walk_model.h"
#include "walk/block.h"

namespace gaitpad {

// A stride at one knot of its periodic cubic B-spline in phase, at one ratio: a StrideCell in the
// character's metres and radians, 0 in the standing pose. Numbers that are read together are
// neighbours.
struct StrideRow {
  std::array<std::array<float, 3>, 2> heel_m;  // by Side; travel frame
  std::array<float, 2> pitch_rad;
  std::array<std::array<float, 2>, 2> edge_rad;  // twist and roll
  std::array<float, 3> pelvis_m;
  float pelvis_yaw_rad;
  std::array<float, 3> pelvis_tilt_rad;
  std::array<std::array<float, kLegAngles>, 2> leg_rad;
  std::array<float, 2> pelvis_span_m;  // the pelvis' lowest and highest place in the stride
  std::array<float, 5> none;           // makes the row a multiple of 8 numbers
};
// Both heels and pitches; and all up to the pelvis' yaw.
inline constexpr int kRowNumbers = sizeof(StrideRow) / sizeof(float),
                     kHeelNumbers = offsetof(StrideRow, edge_rad) / sizeof(float),
                     kPlanNumbers = offsetof(StrideRow, pelvis_tilt_rad) / sizeof(float);
static_assert(kRowNumbers % 8 == 0 && kHeelNumbers % 8 == 0 && kPlanNumbers % 8 == 0);

// Half as many knots change a knee at the lift-off by 0.17 degrees RMS.
inline constexpr int kKnots = kCycleSamples, kHarmonics = 2;
template <std::size_t kOf>
using RowsOf = std::array<std::array<StrideRow, kOf>, kKnots + 3>;  // one before, two after
using StrideRows = RowsOf<kStrideRatios>;
using BackRows = RowsOf<kBackRatios>;

// Footprints of the strides, which are exactly linear in the ratio.
struct FootprintLines {
  std::array<std::array<float, 3>, 2> at_zero_m, per_ratio_m;  // by Side
  float stride_at_zero_m, stride_per_ratio_m;
};

// A critically damped filter of one time constant at one tick length (Damping of curve.h).
struct Filter {
  float pull, keep, tick_s;
};

// The numbers of a LegBuild that ticks read.
struct LegBones {
  std::array<float, 3> hip_m, heel_m, toe_m, forward, side, ball_m, tip_m;
  float thigh_m, shank_m, elevation_rad, foot_m, toe_rest_m, half_width_m, track_m;
  std::array<float, kLegAngles> stand_rad;
  float own_step_m;
  float stance_m;  // where its heel stands at rest, to the left: below the hip, or on the track
  std::array<int, 4> joint;                           // hip, knee, ankle, toe; -1: none
  std::array<std::array<float, 4>, 4> before, after;  // w, x, y, z
};

// A joint that the legs do not set.
struct UpperJoint {
  int joint;
  int swings;  // 0: it is no arm's joint; 1, 2: left shoulder, elbow; 3, 4: right ones
  std::array<float, 4> standing, middle;  // x, y, z, w; `middle`: of an arm's swing
};

// A joint of the path from the pelvis to the head, or to the chest of a skeleton without a head. If
// the trunk does not hang from the pelvis, the path begins at the root, whose offset is 0.
struct PathJoint {
  int joint, upper;         // index in the skeleton, and in BuildTables::upper
  float of_chest, of_head;  // its shares of the angles by which chest and head are ahead
  float bends, of_look;  // its shares of the trunk's bend and, with the joints below it, of a look
  std::array<float, 3> offset_m;
};

// A joint of the spine that shares its bend by weight (SpineJoint).
struct SpineBone {
  int at;                         // index in the path
  std::array<float, 4> standing;  // w, x, y, z
  float upper;
};

// An arm (ArmBuild): its joints from the pelvis to the wrist.
struct ArmBones {
  struct Link {
    int joint;
    std::array<float, 3> offset_m;
  };
  std::vector<Link> path;               // empty: the skeleton has no such arm
  int shoulder, elbow;                  // indices in the path
  int on_trunk;                         // its first joints up to this one are also the trunk's
  bool turns_wrist;                     // the last joint can turn
  std::array<float, 4> hanging, chest;  // w, x, y, z
  std::array<float, 3> grip_m;
  std::array<float, kArmDofs> min_rad, max_rad, middle_rad;
};

// Numbers of a build.
struct BuildNumbers {
  float most_ratio, most_back_ratio, size, time_scale, stand_m, stand_roll_rad, rest_lead_m,
      source_step_m, own_step_s;
  float leg_m;          // thigh and shank
  bool legs_are_plain;  // no joint of a leg has a turn before or after its own
  bool has_head;        // a head ends the path
  bool on_pelvis;       // the path begins at the pelvis; else at the root, beside it
  int joints, pelvis;
  int neck;  // index in the path of the first joint of neck and head; its end without a head
  float arm_m, shoulder_height_m;  // UpperBodyModel
  // Bounds of the angular acceleration of chest and head while a walk changes, rad/s^2.
  float most_chest_s2, most_head_s2;
  // The stages' shares of the phase: right roll, left flight, left roll, right flight.
  std::array<float, 4> stage_share;
  std::array<float, 4> pelvis_standing, chest_standing, head_standing, spine_base;  // w, x, y, z
  std::array<float, 3> pelvis_offset_m, neck_m;
  std::array<float, 2> most_elbow_swing;  // by Side
};

// The tables of a build, for ticks of any length.
struct BuildTables : BuildNumbers {
  alignas(64) StrideRows forward;
  alignas(64) BackRows back;
  FootprintLines footprints, back_footprints;
  // Harmonics of the legs' angles over a stride ahead, by ratio, Side and angle: the mean, then
  // cosine and sine of each harmonic.
  std::array<std::array<std::array<std::array<float, 1 + 2 * kHarmonics>, kLegAngles>, 2>,
             kStrideRatios>
      leg_harmonics;
  std::array<LegBones, 2> leg;
  std::array<IkChain, 2> chain;  // for IkMode::paper, by Side
  std::vector<UpperJoint> upper;
  std::vector<float> upper_rows;  // (kKnots + 3) x upper.size() x 4: x, y, z, w
  std::vector<PathJoint> path;    // from the pelvis' child on, or from the root
  std::vector<SpineBone> spine;   // empty: it does not bend by weights
  std::array<ArmBones, 2> arm;
  std::array<float, kBodyNumbers> plain_body;  // UpperBodyParams without a style
  std::vector<int> still;                      // joints that are always the identity
  std::vector<std::pair<int, quat>> kept;    // twist joints of the legs, which keep their rotation
  std::vector<ArmBones::Link> above_pelvis;  // root to the pelvis' parent; empty: it is the root
};

// The filters of a build.
struct Smoothing {
  Filter room, ground, slope_lean;  // of uneven ground
  Filter step, first_step, turn_goal, turn, bounce, lean, posture, chest, head;
  Filter weights, loosens, lowers, body, speed, push, rail;
};
// The same at one tick's length, or in several ticks at once, by which a look ahead goes.
struct Filters : Smoothing {
  float tick_s;        // of one tick, which all counts and rates of a walk refer to
  float ticks = 1.0f;  // by which the walks advance at once
  float turn_keep;     // of the filter `turn` in one tick
  float mean_pull;     // of the two filters that make a leg's running mean
};
inline constexpr double kRailSmoothing_s = 0.06;  // time constant of `rail`, at the reference leg

// All that a tick reads beside its walks: the tables of a build, the filters of the tick's length,
// and the ground.
struct Tables : BuildNumbers, Filters {
  const BuildTables& build;
  const std::array<LegBones, 2>& leg;
  const std::vector<PathJoint>& path;
  const std::vector<SpineBone>& spine;
  const std::array<ArmBones, 2>& arm;
  const Terrain* terrain;  // null if the ground is level
};

std::shared_ptr<const BuildTables> build_tables(const WalkModel& model);
// The tables of a model for ticks of `tick_s` seconds; refers to the model. Does not use the heap.
Tables tables_of(const WalkModel& model, double tick_s) noexcept;
// The filters in `ticks` ticks at once. `one`: in one tick.
Filters in_several_ticks(const Filters& one, float ticks) noexcept;

}  // namespace gaitpad
