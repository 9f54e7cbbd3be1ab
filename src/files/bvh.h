// BVH text as it stands in the file: joints, channels and numbers, nothing interpreted.
// Files come from strangers: every count is checked against the text before memory is taken for it.
#pragma once
#include <array>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"
#include "gaitpad/skeleton.h"
#include "motion/euler.h"

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
  std::string name;  // an End Site: its parent's name + "_End", then "_End2" ... for further ones
  int parent = -1;
  vec3 offset{0.0};  // file units
  bool is_end_site = false;
  std::array<BvhChannel, 6> channel{};  // in the order of the file
  int channels = 0;
  int first_value = 0;  // of its channels in a frame
};

// Joints stand in the order of the file, which is depth-first, parents before children.
struct Bvh {
  std::vector<BvhJoint> joints;
  double frame_time_s = 0.0;
  int frames = 0;
  int channels = 0;            // numbers a frame
  std::vector<double> values;  // frames x channels; file units and degrees
};

// Any order and number of channels a joint, CRLF, tabs, trailing blanks, no newline at the end.
// Every frame stands on a line of its own. Errors read `NAME:LINE: cause`.
Result<Bvh> parse_bvh(std::string_view text, const std::string& name);
Result<Bvh> read_bvh(const std::string& path);

// Poses as a BVH file that Blender and others open.

// For each joint the rotation order whose pole is far from all sampled rotations: z y x where that
// stays below 30 degrees, else the best of the six. The root turns about y first, so that a heading
// has no pole. `local` holds samples x joints.
std::vector<EulerOrder> euler_orders(const Skeleton& skeleton, std::span<const quat> local);

struct BvhLayout {
  double metres_per_unit = 1.0;
  double frame_time_s = 1.0 / 240.0;
  // End Sites to be written as joints (a foot's toe, where the skeleton has no toe joint).
  std::vector<int> end_sites_as_joints;
  std::vector<EulerOrder> orders;  // one a joint; empty: y x z for the root, z y x for the others
};

// Root OFFSET 0 0 0 and six channels, three rotations for every other joint. Of the equal Euler
// triples the one nearest to the frame before is written, so that no channel flips. Writes as it
// goes; the number of frames is filled in by finish(), so `out` must be able to seek.
class BvhWriter {
 public:
  BvhWriter(std::ostream& out, const Skeleton& skeleton, const BvhLayout& layout);
  void write(const Pose& pose);  // appends a frame
  bool finish();                 // false if anything could not be written

 private:
  void write_hierarchy();
  void write_joint(int joint, int depth);
  bool is_joint(int joint) const;

  std::ostream& out_;
  const Skeleton& skeleton_;  // the caller's, alive until finish()
  BvhLayout layout_;
  std::vector<int> joints_;  // those with channels, in the order of the file
  std::vector<EulerAngles> previous_rad_;
  std::string line_;
  std::ostream::pos_type count_at_;
  long long frames_ = 0;
};

}  // namespace gaitpad
