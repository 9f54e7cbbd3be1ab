// A motion from a file: a skeleton and its frames, in metres, y up.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {

// One pose of a motion. A file's reader fills it (gaitpad/motion_file.h), or a program whose motion
// is no file.
struct MotionFrame {
  vec3 root_m{0.0};  // world position of joint 0
  // One rotation of length 1 for each joint: turns its frame into its parent's, the root's into the
  // world.
  std::vector<quat> local;
  // Places relative to the parent joint, in its frame: they replace Joint::offset_m in files that
  // move joints below the root. Empty, or one for each joint.
  std::vector<vec3> translation_m;
};

// The gait that the stick scales: the motion's own, or an adult's on the character's legs.
enum class Pace { own, adult };
// Names, indexed by Pace.
inline constexpr std::array<const char*, 2> kPaceNames = {"own", "adult"};
constexpr const char* name_of(Pace pace) noexcept {
  return kPaceNames[static_cast<std::size_t>(pace)];
}
constexpr std::optional<Pace> pace_named(std::string_view name) noexcept {
  for (const Pace pace : {Pace::own, Pace::adult}) {
    if (name == name_of(pace)) return pace;
  }
  return std::nullopt;
}

// A skeleton and its frames, filled by the same as MotionFrame.
struct Motion {
  // Name of the file without folder, or "procedural"; error sentences begin with it.
  std::string name;
  Skeleton skeleton;  // 1 .. kMaxJoints joints
  int pelvis = 0;     // lowest joint above both legs; joints above it may stand still while it
                      // moves
  // Joints of both legs by find_legs() (gaitpad/anatomy.h), indexed by Side.
  std::array<LegJoints, 2> legs;
  double metres_per_unit = 1.0;       // unit of the file; the numbers here are in metres already
  double frame_time_s = 1.0 / 120.0;  // time from one frame to the next, 1e-5 .. 10
  // The pace that the motion's description states; adult for the built-in motion.
  Pace pace = Pace::own;
  std::vector<MotionFrame> frames;  // at least one frame
};

// Errors read `NAME: has no frames`. Parents have to precede their children, each frame has a
// rotation of length 1 for each joint, and all numbers are finite. `legs` and `pelvis` may be unset
// (-1, 0).
std::optional<Error> check(const Motion& motion);

// True if all joints of both legs are set.
bool has_legs(const Motion& motion) noexcept;

// Forward kinematics of a frame, eq. (1), with the frame's own translations.
void forward_kinematics(const Motion& motion, const MotionFrame& frame,
                        JointFrames& frames) noexcept;

// World positions of some joints over all frames: result[i][frame] belongs to joints[i]; empty for
// an index that is no joint.
std::vector<std::vector<vec3>> joint_tracks_m(const Motion& motion, std::span<const int> joints);

// The length from hip to knee to ankle in the motion's middle frame; 0 if one of them or the frame
// is missing. If twist joints between them bend, the length is not constant.
double leg_length_m(const Motion& motion, const LegJoints& leg);

// The mean length of both legs.
double leg_length_m(const Motion& motion);

}  // namespace gaitpad
