// Acclaim skeleton (ASF) text: bones as the file has them, in the hierarchy's order.
// Files come from strangers: bones are counted, names and numbers checked, nothing is trusted.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

// What a bone's motion consists of, in the order of its `dof` (the root's: its `order`).
enum class AsfChannel : std::uint8_t { rx, ry, rz, tx, ty, tz };
inline constexpr bool is_rotation(AsfChannel c) noexcept { return c <= AsfChannel::rz; }

// A bone turns about its start, which is its parent's end. Its channels count in its own axes;
// direction and axes are the world's in the rest pose.
struct AsfBone {
  std::string name;
  int parent = -1;
  vec3 direction{0.0};    // unit length, towards the bone's end; 0 for the root
  double length = 0.0;    // file units
  quat axes = kIdentity;  // turns the bone's axes to the world's
  std::array<AsfChannel, 6> channel{};
  int channels = 0;
  int first_value = 0;  // of its channels in a frame
  vec3 end() const { return length * direction; }
};

// Bones stand in depth-first order, parents before children; bones[0] is the root.
struct Asf {
  std::vector<AsfBone> bones;
  vec3 root_position{0.0};      // file units; what the root's translation starts from
  double length_unit = 0.0;     // `:units length` as written; 0: absent
  double angle_unit = kDegree;  // rad; `deg` unless the file says `rad`
  int channels = 0;             // numbers a frame
};

// Any order of sections and channels, any case of keywords, CRLF, comments. Limits, masses and
// sections that nobody here needs are passed over. Rotations are applied in the order that is
// written, first one first. Refused are, besides damage, bones that stretch (dof `l`). Errors read
// `NAME:LINE: cause`.
Result<Asf> parse_asf(std::string_view text, const std::string& name);

// Acclaim motion (AMC) text: the numbers of each frame for the bones of its skeleton.
// Files come from strangers: memory grows with the text alone, and up to a bound.

struct Amc {
  int frames = 0;
  double angle_unit = kDegree;  // rad; :DEGREES or :RADIANS, else the skeleton's
  double frame_rate_hz = 0.0;   // 0: not said, as usual
  std::vector<double> values;   // frames x asf.channels; file units
};

// Frames are numbered lines, counted up by one from any number; CRLF, comments and blank lines do
// not matter. A bone that the first frame leaves out rests; one that a later frame leaves out keeps
// its last values, or is damage where the file says :FULLY-SPECIFIED. `asf_name` stands in the
// sentence about a bone that the skeleton does not have. Errors read `NAME:LINE: cause`.
Result<Amc> parse_amc(std::string_view text, const std::string& name, const Asf& asf,
                      const std::string& asf_name);

}  // namespace gaitpad
