// Reads BVH files without converting them, and writes poses as BVH files. gaitpad/motion_file.h
// converts what was read into a motion in metres.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {

enum class BvhChannel : std::uint8_t {
  x_position,
  y_position,
  z_position,
  x_rotation,
  y_rotation,
  z_rotation,
};
inline constexpr bool is_rotation(BvhChannel c) noexcept { return c >= BvhChannel::x_rotation; }

struct BvhJoint {
  // An End Site has its parent's name and "_End", further ones of the parent "_End2" and so on.
  std::string name;
  int parent = -1;   // index of the parent joint; -1: it is the root
  vec3 offset{0.0};  // place relative to the parent, in file units
  bool is_end_site = false;
  // Channels in the order of the file; the first `channels` count.
  std::array<BvhChannel, 6> channel{};
  int channels = 0;
  int first_value = 0;  // index of its first channel's value in a frame
};

// The content of a BVH file; parse_bvh() fills it. Joints are in the order of the file, which is
// depth-first, parents before children.
struct Bvh {
  std::vector<BvhJoint> joints;
  double frame_time_s = 0.0;
  int frames = 0;
  int channels = 0;            // number of values in a frame
  std::vector<double> values;  // values, frame by frame; file units and degrees
};

// Parses a text. Accepts any order and number of channels of a joint, CRLF, tabs, trailing blanks
// and a last line without its end; every frame needs a line of its own. Counts in the text are
// checked before memory is allocated for them. Errors read `NAME:LINE: cause`.
Result<Bvh> parse_bvh(std::string_view text, const std::string& name);
// Reads a file and parses its text.
Result<Bvh> read_bvh(const std::string& path);

// The order of a joint's three rotations, R = R_first R_second R_third: axes 0 x, 1 y, 2 z, each
// once. At the pole, where the second angle is +-90 degrees, such angles are not unique.
using BvhOrder = std::array<int, 3>;

// For each joint the order whose pole is far from all sampled rotations: z y x if they stay 60
// degrees away from its pole, else the best of the six. The root turns about y first, so that no
// heading is near its pole. `local` holds samples x joints.
std::vector<BvhOrder> euler_orders(const Skeleton& skeleton, std::span<const quat> local);

// Format of a file that is written. The caller fills it.
struct BvhLayout {
  double metres_per_unit = 1.0;       // length of a unit of the file, 1e-9 .. 1e6
  double frame_time_s = 1.0 / 240.0;  // time between two poses, 1e-5 .. 10
  // Joints of the skeleton that are End Sites and are written as joints: a foot's toe, if the
  // skeleton has no toe joint.
  std::vector<int> end_sites_as_joints;
  // Rotation order of each joint; empty: y x z for the root, z y x for the others.
  std::vector<BvhOrder> orders;
};
// Errors read `BvhLayout: frame_time_s is 0, outside [1e-05, 10]`.
std::optional<Error> check(const BvhLayout& layout, const Skeleton& skeleton);

// Writes poses as a BVH file. The root has OFFSET 0 0 0 and six channels, every other joint three
// rotations. If several sets of angles give a rotation, the nearest to the frame before is written,
// so that no channel jumps. Every pose is written at once; finish() fills in the number of frames,
// so `out` must be able to seek.
class BvhWriter {
 public:
  // `out` and `skeleton` must live until finish(). Nothing is written if check() refuses the
  // layout.
  BvhWriter(std::ostream& out, const Skeleton& skeleton, const BvhLayout& layout);
  void write(const Pose& pose);  // Appends a frame.
  bool finish();                 // Completes the file; returns false if anything was not written.

 private:
  // A joint as it was written in the last frame.
  struct Written {
    quat rotation{1.0, 0.0, 0.0, 0.0};
    std::array<double, 3> angles_rad{};
    bool is_settled = false;  // if the next rotation is the same, its angles are the same
    std::string text;         // the text of settled angles
    // Writes the angles of the next frame, a blank after each; returns the end of the text.
    char* put(const BvhOrder& order, const quat& turned, char* out);
  };
  void write_hierarchy();
  void write_joint(int joint, int depth);
  bool is_joint(int joint) const;

  std::ostream& out_;
  const Skeleton& skeleton_;
  BvhLayout layout_;
  std::vector<int> joints_;       // joints with channels, in the order of the file
  std::vector<Written> written_;  // the last frame of each joint
  std::vector<char> line_;        // room for a frame's text
  std::ostream::pos_type count_at_;
  long long frames_ = 0;
  bool is_sound_ = true;  // check() accepts the layout
};

}  // namespace gaitpad
