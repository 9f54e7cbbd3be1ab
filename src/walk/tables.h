// What does not change while characters of one build walk, in floats: the strides' tables, the body
// above the legs and the legs' bones. A WalkModel has them.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gaitpad/walk_model.h"
#include "walk/block.h"

namespace gaitpad {

// A stride at one knot of its periodic cubic B-spline in phase, at one ratio; in the character's
// metres and radians, 0 when standing (StrideCellOf). Numbers are neighbours so that what is read
// together is summed together.
struct StrideRow {
  std::array<std::array<float, 3>, 2> heel_m;  // by Side; travel frame
  std::array<float, 2> pitch_rad;
  std::array<std::array<float, 2>, 2> edge_rad;  // twist and roll
  std::array<float, 3> pelvis_m;
  float pelvis_yaw_rad;
  std::array<float, 3> pelvis_tilt_rad;
  std::array<std::array<float, kLegAngles>, 2> leg_rad;
  std::array<float, 2> pelvis_span_m;  // its lowest and highest place in the stride
  std::array<float, 5> none;
};
inline constexpr int kRowNumbers = sizeof(StrideRow) / sizeof(float), kHeelNumbers = 8;
static_assert(kRowNumbers == 40);

// As many as a StrideFamily has: half of them are off by 0.17 degrees RMS of a knee, at the
// lift-off.
inline constexpr int kKnots = 128, kRatios = 8, kHarmonics = 2;
template <std::size_t kOf>
using RowsOf = std::array<std::array<StrideRow, kOf>, kKnots + 3>;  // one before, two after
using StrideRows = RowsOf<kRatios>;
using BackRows = RowsOf<kBackRatios>;

// Where strides go: exactly linear in their ratio.
struct FootprintLines {
  std::array<std::array<float, 3>, 2> at_zero_m, per_ratio_m;  // by Side
  float stride_at_zero_m, stride_per_ratio_m;
};

// A critically damped filter of one time constant at one tick length (Damping of curve.h).
struct Filter {
  float pull, keep, tick_s;
};

struct LegBones {
  std::array<float, 3> hip_m, heel_m, toe_m, forward, side, ball_m, tip_m;  // LegBuild
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
  int swings;                             // 0 not; 1, 2: left shoulder, elbow; 3, 4: right ones
  std::array<float, 4> standing, middle;  // x, y, z, w; the middle of an arm's swing
};

// A joint on the way from the pelvis to the head, or to the chest of a skeleton without one, and
// its share of what chest and head are ahead. Of a trunk that does not hang from the pelvis: from
// the root, which has no offset.
struct PathJoint {
  int joint, upper;  // its place among those that the legs do not set
  float of_chest, of_head;
  float bends, of_look;  // shares of the trunk's bend; of the head's turn, with what is below it
  std::array<float, 3> offset_m;  // Joint
};

// A joint of the spine that shares its bend by weight (SpineJoint).
struct SpineBone {
  int at;                         // in the path
  std::array<float, 4> standing;  // w, x, y, z
  float upper;
};

// An arm (ArmBuild): its joints from the pelvis to the wrist.
inline constexpr int kArmAngles = 6;  // shoulder x, z, y; elbow x; wrist x, z
struct ArmBones {
  struct Link {
    int joint;
    std::array<float, 3> offset_m;
  };
  std::vector<Link> path;               // none: the skeleton has no such arm
  int shoulder, elbow;                  // in the path
  int on_trunk;                         // so many of its first joints are the trunk's, too
  bool turns_wrist;                     // the last joint is one that turns
  std::array<float, 4> hanging, chest;  // w, x, y, z
  std::array<float, 3> grip_m;
  std::array<float, kArmAngles> min_rad, max_rad, middle_rad;
};

// Numbers of a build.
struct BuildNumbers {
  float most_ratio, most_back_ratio, size, time_scale, stand_m, stand_roll_rad, rest_lead_m,
      source_step_m, own_step_s;
  float leg_m;          // thigh and shank
  bool legs_are_plain;  // no joint of a leg has a turn before or after its own
  bool has_head;        // it ends the path
  bool on_pelvis;       // the path begins at the pelvis; else at the root, beside it
  int joints, pelvis;
  float arm_m, shoulder_height_m;  // UpperBodyModel
  // How hard chest and head may turn while a walk changes, radians/s^2.
  float most_chest_s2, most_head_s2;
};

// What is the same at all ticks' lengths; a WalkModel has it.
struct BuildTables : BuildNumbers {
  alignas(64) StrideRows forward;
  alignas(64) BackRows back;
  FootprintLines footprints, back_footprints;
  // Of the legs' angles over a stride ahead, by Side: mean, then cosine and sine of each harmonic.
  std::array<std::array<std::array<std::array<float, 1 + 2 * kHarmonics>, kLegAngles>, 2>, kRatios>
      leg_harmonics;
  std::array<LegBones, 2> leg;
  std::array<IkChain, 2> chain;  // of paper mode, by Side
  std::array<float, 4>
      stage_share;  // of the phase: roll right, flight left, roll left, flight right

  std::vector<UpperJoint> upper;
  std::vector<float> upper_rows;  // (kKnots + 3) x upper.size() x 4: x, y, z, w
  std::vector<PathJoint> path;    // from below the pelvis on, or from the root
  std::vector<SpineBone> spine;   // none: it does not bend by weights
  std::array<ArmBones, 2> arm;
  std::array<float, 4> chest_standing, head_standing, spine_base;  // w, x, y, z
  std::array<float, 3> neck_m;
  std::array<float, kBodyNumbers> plain_body;  // UpperBodyParams of no style
  std::array<float, 2> most_elbow_swing;
  std::vector<int> still;                    // always the identity
  std::vector<std::pair<int, quat>> kept;    // twist joints in the legs
  std::vector<ArmBones::Link> above_pelvis;  // from the root to its parent; none: it is the root
  std::array<float, 3> pelvis_offset_m;
  std::array<float, 4> pelvis_standing;  // w, x, y, z
};

// The filters of a build at one tick's length.
struct Filters {
  float tick_s;
  Filter room, ground, slope_lean;  // of uneven ground
  Filter step, first_step, turn_goal, turn, bounce, lean, posture, chest, head;
  Filter weights, loosens, lowers, body, speed, push, rail;
  float mean_pull;  // of the two filters that a leg's running mean goes through
};

// All that a tick reads beside the walks: a build, its ground, and the filters of the tick's
// length.
struct Tables : BuildNumbers, Filters {
  const StrideRows& forward;
  const BackRows& back;
  const FootprintLines &footprints, &back_footprints;
  const decltype(BuildTables::leg_harmonics)& leg_harmonics;
  const std::array<LegBones, 2>& leg;
  const std::array<IkChain, 2>& chain;
  const std::array<float, 4>& stage_share;
  const std::vector<UpperJoint>& upper;
  const std::vector<float>& upper_rows;
  const std::vector<PathJoint>& path;
  const std::vector<SpineBone>& spine;
  const std::array<ArmBones, 2>& arm;
  const std::array<float, 4>&chest_standing, &head_standing, &spine_base;
  const std::array<float, 3>& neck_m;
  const std::array<float, kBodyNumbers>& plain_body;
  const std::array<float, 2>& most_elbow_swing;
  const std::vector<int>& still;
  const std::vector<std::pair<int, quat>>& kept;
  const std::vector<ArmBones::Link>& above_pelvis;
  const std::array<float, 3>& pelvis_offset_m;
  const std::array<float, 4>& pelvis_standing;
  const Terrain* terrain;  // none where the ground is level
};

std::shared_ptr<const BuildTables> build_tables(const WalkModel& model);
// Of a model with its tables, and of a tick of `tick_s` seconds. No heap.
Tables tables_of(const WalkModel& model, double tick_s) noexcept;

}  // namespace gaitpad
