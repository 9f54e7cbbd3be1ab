// One full stride of a walk, made periodic, with its events: the data module's one output format
// (Meredith & Maddock 2005, section 3.2). Captured, procedural and key-framed walks look the same
// from here on.
//
// Frames. The walk is seen in its own *travel frame*: x to the walker's left, y up with the floor
// at 0, z along the direction of travel, moving with the walk's mean speed. Segment rotations are
// counted from the *standing pose*: feet flat at their natural toe-out, legs straight and vertical,
// pelvis in its mean orientation, facing +z. In the standing pose every segment rotation is
// identity.
//
// Phase runs 0 .. 1 from one heel strike of the right foot to the next.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/result.h"

namespace gaitpad {

// Samples of a cycle; sample i has the phase i / kCycleSamples.
inline constexpr int kCycleSamples = 128;

// gait_cycle(), procedural_gait() and cycle_on_skeleton() fill the structs below.

// A leg's build in the standing pose. Vectors are along the standing pose's axes, in metres.
struct LegModel {
  LegJoints joints;
  vec3 hip_m{0.0};                  // from the pelvis joint to the hip joint, in the pelvis' frame
  double thigh_m = 0, shank_m = 0;  // lengths of the bones, which point along -y
  // From the ankle joint, in the foot's frame; heel_m.y = -ankle height.
  vec3 heel_m{0.0}, toe_m{0.0};
  vec3 toe_end_m{0.0};  // from the toe joint, in the toe's frame; 0 if they are one
                        // joint
  double toe_rest_m = 0, toe_end_rest_m = 0;  // heights above the floor when standing
  // Standing rotation of each chain joint's own frame: joint world rotation = segment rotation *
  // standing rotation, seen with the walker facing +z. Order: hip, knee, ankle, toe.
  std::array<quat, 4> standing;
  double length_m() const { return thigh_m + shank_m; }
};

// One leg at one phase. The angles put the model's ankle and foot where ankle_m and foot say.
struct LegSample {
  LegAngles angles{};
  double toe_x = 0.0;                    // angle of the toes, radians: toe = foot Rx(toe_x); toe
                                         // end up is negative
  vec3 ankle_m{0.0};                     // place of the ankle in the travel frame
  quat foot = quat(1.0, 0.0, 0.0, 0.0);  // the foot's segment rotation in the travel frame
};

struct CycleSample {
  // Place in the travel frame; z is the fore-aft oscillation; the means of z and x are 0.
  vec3 pelvis_m{0.0};
  quat pelvis = quat(1.0, 0.0, 0.0, 0.0);  // the pelvis' segment rotation in the travel frame
  std::array<LegSample, 2> leg;
};

struct StrideFamily;

struct GaitCycle {
  std::string name;  // name of the motion, with which error sentences begin
  // The skeleton in metres. Its root is at the pelvis: joints from the root down to it have no
  // offsets.
  Skeleton skeleton;
  int pelvis = 0;                // index of the pelvis joint
  double metres_per_unit = 1.0;  // unit of the motion's file
  // World rotation of the pelvis joint when standing.
  quat pelvis_standing = quat(1.0, 0.0, 0.0, 0.0);
  std::array<LegModel, 2> leg;

  double duration_s = 0.0;  // duration of the stride in the source, 0.05 .. 60
  double stride_m = 0.0;    // distance travelled in the stride, 0.001 .. 1000
  // The stride's place in the source: from `first_frame` on, `frames` long; neither has to be a
  // whole number, and phase 0 is somewhere in it. Frames count from 0 in the file; loading drops
  // none.
  double first_frame = 0.0, frames = 0.0;
  double turn_rad = 0.0;  // change of heading in the stride, + left; the cycle itself is straight
  // Step lengths and track widths by Side, measured on the heels while the feet stand flat: from
  // the other foot's heel along the travel (the two add up to stride_m), and sideways from the
  // pelvis' mean path (+ left).
  std::array<double, 2> step_m{};
  std::array<double, 2> track_m{};
  // Events as phases, in the order right strike, left toe-off, left strike, right toe-off. A foot
  // strikes when its heel is down and still; its toe is off when it begins to leave the place from
  // which it pushes. (The built-in walk has those of its published curves.)
  // Strikes of the left and the right foot: right = 0, left about 0.5.
  std::array<double, 2> strike{};
  std::array<double, 2> toe_off{};  // toe-offs: left about 0.12, right about 0.62

  std::vector<CycleSample> samples;  // kCycleSamples of them, periodic
  // kCycleSamples x joints: every joint's local rotation (joint 0: in the travel frame), periodic,
  // neighbours in the same hemisphere. The legs' rotations are those of `samples`. Turning local[0]
  // turns the whole body.
  std::vector<quat> local;
  std::vector<quat> standing_local;  // local rotations of the standing pose, one for each joint

  Pace pace = Pace::own;  // the motion's pace
  // True if the samples are data, as gait_cycle() sets it: clean strides keep the hips' forward
  // speed within a step as far as the legs allow. The built-in walk's comes from a formula.
  bool captured = false;

  // The tables that a walk reads (gaitpad/stride_family.h); with_clean_strides() fills them.
  std::shared_ptr<const StrideFamily> strides;
};

// Errors read `NAME: samples are 0, not 128`. Checks that lists have their lengths, joints exist,
// numbers are finite.
std::optional<Error> check(const GaitCycle& cycle);

// Interpolates the cycle at any phase, also beyond 0 .. 1: Catmull-Rom between samples. No
// allocation.
CycleSample sample_at(const GaitCycle& cycle, double phase) noexcept;
// Interpolates the local rotations of all joints. Sets pose.local and pose.joint_count, not
// pose.root_m.
void sample_local(const GaitCycle& cycle, double phase, Pose& pose) noexcept;

// The forward deflection that gives the source's own gait, at the motion's own pace.
inline constexpr double kOwnStick = 0.8;

// Finds the best full stride of a motion and makes it periodic: heading and travel taken out, the
// seam faded, at most 16 harmonics kept. The model's ankles stand where the captured ones do,
// except where a knee is nearer to straight than about 3 degrees (off by fractions of a millimetre)
// or bent backwards (off by a few millimetres). Error `NAME: cause` where the motion holds no walk
// of both feet: both are in the air (a run), their events are not in a walk's order, or the hips do
// not travel. If speed or cadence suggest a wrong frame time, it names frame_rate_hz.
Result<GaitCycle> gait_cycle(const Motion& motion);

// The embedded default: an adult with 0.84 m of thigh + shank, 120 Hz, one exactly periodic and
// left-right symmetric stride from published normative curves, arms after Boulic et al. 1990.
GaitCycle procedural_gait();
// The built-in walk as a motion of several strides (for `gaitpad motion`, export and tests).
Motion procedural_motion();

// Retargets a walk (section 3.2): returns `source` as the skeleton of `character` walks it. The
// character's standing pose is measured on its own walk if it has one, else on the straightest
// frame of its file. Leg angles and foot rotations are taken over, and lengths grow by the ratio of
// the legs. Spine, neck, head and arms follow their counterparts, whatever their names are; other
// joints follow those of equal name. Error `NAME: cause`.
Result<GaitCycle> cycle_on_skeleton(const GaitCycle& source, const Motion& character);

// Length of thigh + shank, the mean of both legs.
double mean_leg_m(const GaitCycle& cycle) noexcept;

}  // namespace gaitpad
