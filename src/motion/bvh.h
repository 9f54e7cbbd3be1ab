// BVH text as it stands in the file: joints, channels and numbers, nothing interpreted.
// Files come from strangers: every count is checked against the text before memory is taken for it.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "base/result.h"

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

}  // namespace gaitpad
