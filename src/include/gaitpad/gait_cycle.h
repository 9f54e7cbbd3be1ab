// One full stride of a walk, made periodic, with its events: the data module's one output format
// (Meredith & Maddock 2005, section 3.2). Captured and procedural walks look the same from here on.
//
// Frames. The walk is seen in its own *travel frame*: x to the walker's left, y up with the floor
// at 0, z along the direction of travel, moving with the walk's mean speed. Segment rotations are
// counted from the *standing pose*: feet flat at their natural toe-out, legs straight and vertical,
// pelvis in its mean orientation, facing +z. In the standing pose every segment rotation is
// identity.
//
// Phase runs 0..1 from one heel strike of the right foot to the next.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr int kCycleSamples = 128;  // a cycle; sample i stands at phase i / kCycleSamples

// The leg's build in the standing pose. Vectors in the standing pose's axes, metres.
struct LegModel {
  LegJoints joints;
  vec3 hip_m{0.0};                  // from the pelvis joint to the hip joint (pelvis frame)
  double thigh_m = 0, shank_m = 0;  // along -y
  vec3 heel_m{0.0}, toe_m{0.0};     // from the ankle joint (foot frame); heel_m.y = -ankle height
  vec3 toe_end_m{0.0};              // from the toe joint (toe frame); 0 if they are one
  double toe_rest_m = 0, toe_end_rest_m = 0;  // height above the floor when standing
  // Standing rotation of each chain joint's own frame: joint world rotation = segment rotation *
  // standing rotation, seen with the walker facing +z. Order: hip, knee, ankle, toe.
  std::array<quat, 4> standing;
  double length_m() const { return thigh_m + shank_m; }
};

struct LegSample {
  LegAngles angles{};
  double toe_x = 0.0;                    // toe = foot Rx(toe_x); lifting the toe end is negative
  vec3 ankle_m{0.0};                     // travel frame
  quat foot = quat(1.0, 0.0, 0.0, 0.0);  // segment rotation in the travel frame
};

struct CycleSample {
  vec3 pelvis_m{0.0};  // travel frame; z is the fore-aft oscillation, its mean and x's mean are 0
  quat pelvis = quat(1.0, 0.0, 0.0, 0.0);  // segment rotation in the travel frame
  std::array<LegSample, 2> leg;
};

struct GaitCycle {
  std::string name;
  // Metres. The root stands at the pelvis: joints from the root down to it have no offsets.
  Skeleton skeleton;
  int pelvis = 0;
  double metres_per_unit = 1.0;
  quat pelvis_standing = quat(1.0, 0.0, 0.0, 0.0);  // pelvis joint's world rotation when standing
  std::array<LegModel, 2> leg;

  double duration_s = 0.0;  // of the stride in the source
  double stride_m = 0.0;    // travel in it
  // Taken of the heel points while the feet stand flat: from the other foot's along the travel (the
  // two add up to stride_m), and sideways from the pelvis' mean path (+ left).
  std::array<double, 2> step_m{};
  std::array<double, 2> track_m{};
  // Events as phases. A foot strikes heel first (or flat): the heel point is down to a quarter of
  // its greatest speed. Its toe leaves last: the toe point exceeds half the walk's speed.
  std::array<double, 2> strike{};   // right = 0, left about 0.5
  std::array<double, 2> toe_off{};  // left about 0.12, right about 0.62

  std::vector<CycleSample> samples;  // kCycleSamples, periodic
  // kCycleSamples x joints: every joint's local rotation (joint 0: in the travel frame), neighbours
  // in the same hemisphere, periodic. The legs' stand as `samples` say. To turn the whole body,
  // turn local[0]; what hangs on joints between root and pelvis then follows.
  std::vector<quat> local;
  std::vector<quat> standing_local;  // joints: local rotations of the standing pose
};

// Cubic (Catmull-Rom) interpolation at any phase; noexcept, no allocation.
CycleSample sample_at(const GaitCycle& cycle, double phase) noexcept;
// Local rotations of all joints at a phase into pose.local (pose.root_m untouched).
void sample_local(const GaitCycle& cycle, double phase, Pose& pose) noexcept;

// Finds the best full stride of a motion and makes it periodic: heading and travel taken out, the
// seam faded, at most 16 harmonics kept. The model's ankles stand where the captured ones do, but
// for knees nearer to straight than some 3 degrees (fractions of a millimetre) or bent backwards (a
// few). Fails with one sentence, `NAME: cause`, where there is no walk of both feet in it (a run is
// none).
Result<GaitCycle> gait_cycle(const Motion& motion);

// The embedded default: an adult with 0.84 m of thigh + shank, 120 Hz, one exactly periodic and
// left-right symmetric stride from published normative curves; arms after Boulic et al. 1990.
GaitCycle procedural_gait();
// The same walk as a motion of several strides (for `gaitpad motion`, export and tests).
Motion procedural_motion();

// A walk on another skeleton with two legs: retargeting by the leg-length ratio.

// `source` as the skeleton of `character` walks it. How that one stands is measured on its own walk
// where it has one, else on the frame of its file in which it stands straightest. Leg angles and
// foot rotations are taken over, lengths grow by the ratio of the legs; spine, neck, head and arms
// follow their counterparts whatever they are called (cycle_upper_body.h). Error: `NAME: cause`.
Result<GaitCycle> cycle_on_skeleton(const GaitCycle& source, const Motion& character);

// Thigh + shank, the mean of both legs.
double mean_leg_m(const GaitCycle& cycle) noexcept;

}  // namespace gaitpad
