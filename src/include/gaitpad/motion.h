// A motion as it stands in a file: a skeleton and its frames, in metres, y up.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {

// A file's reader fills it (gaitpad/motion_file.h), or a program whose motion is no file.
struct MotionFrame {
  vec3 root_m{0.0};  // world position of joint 0
  // One a joint, of length 1: turns its frame into its parent's, the root's into the world.
  std::vector<quat> local;
  // From the parent joint, in its frame: replaces Joint::offset_m in files that move joints below
  // the root. Empty, or one a joint.
  std::vector<vec3> translation_m;
};

// Whose speed and step the stick asks for: the motion's own, or an adult's on the character's legs.
enum class Pace { own, adult };
inline constexpr std::array<const char*, 2> kPaceNames = {"own", "adult"};  // indexed by Pace
constexpr const char* name_of(Pace pace) noexcept {
  return kPaceNames[static_cast<std::size_t>(pace)];
}
constexpr std::optional<Pace> pace_named(std::string_view name) noexcept {
  for (const Pace pace : {Pace::own, Pace::adult}) {
    if (name == name_of(pace)) return pace;
  }
  return std::nullopt;
}

// As MotionFrame.
struct Motion {
  std::string name;   // file name without folder, or "procedural"; error sentences begin with it
  Skeleton skeleton;  // 1 .. kMaxJoints joints
  int pelvis = 0;     // lowest joint above both legs; its ancestors may stand still while it moves
  std::array<LegJoints, 2> legs;  // indexed by Side; of find_legs() (gaitpad/anatomy.h)
  double metres_per_unit = 1.0;   // file units times this are metres, which all numbers here are in
  double frame_time_s = 1.0 / 120.0;  // from one frame to the next, 1e-5 .. 10
  Pace pace = Pace::own;  // of the motion's description; the built-in motion has the adult's
  std::vector<MotionFrame> frames;  // one at least
};

// `NAME: has no frames`. Joints stand parents before children, each frame has a rotation of length
// 1 for each joint, and all numbers are finite. `legs` and `pelvis` may be unset (-1, 0).
std::optional<Error> check(const Motion& motion);

// Whether all joints of both legs are set.
bool has_legs(const Motion& motion) noexcept;

// Forward kinematics of a frame, eq. (1), with the frame's own translations.
void forward_kinematics(const Motion& motion, const MotionFrame& frame,
                        JointFrames& frames) noexcept;

// World positions of some joints over all frames: result[i][frame] belongs to joints[i]; empty for
// an index that is no joint.
std::vector<std::vector<vec3>> joint_tracks_m(const Motion& motion, std::span<const int> joints);

// Hip to knee to ankle in the motion's middle frame; 0 where one of them or the frame is missing.
// Where twist joints bend between them, the length is not constant.
double leg_length_m(const Motion& motion, const LegJoints& leg);

// The mean of both legs.
double leg_length_m(const Motion& motion);

}  // namespace gaitpad
