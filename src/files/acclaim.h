// Parsers of Acclaim files: the bones of a skeleton (ASF) and the numbers of each frame of a motion
// (AMC), unconverted. Counts, names and numbers are checked, so any text is safe to parse.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

// The channels of a bone, in the order of its `dof` (of the root: its `order`).
enum class AsfChannel : std::uint8_t { rx, ry, rz, tx, ty, tz };
inline constexpr bool is_rotation(AsfChannel c) noexcept { return c <= AsfChannel::rz; }

// A bone turns about its start, which is its parent's end. Its channels are about its own axes.
// `direction` and `axes` are in the world frame, in the rest pose.
struct AsfBone {
  std::string name;
  int parent = -1;
  vec3 direction{0.0};    // unit vector to the bone's end; 0 for the root
  double length = 0.0;    // length of the bone in the file's unit
  quat axes = kIdentity;  // rotation of the bone's axes to the world's
  std::array<AsfChannel, 6> channel{};
  int channels = 0;
  int first_value = 0;  // index of its first channel's value in a frame
  vec3 end() const { return length * direction; }
};

// Bones are in depth-first order, parents before children; bones[0] is the root.
struct Asf {
  std::vector<AsfBone> bones;
  vec3 root_position{0.0};   // file units; the root's translation is added to it
  double length_unit = 0.0;  // `:units length` as written; 0: it is absent
  // Size of the file's angle unit in radians; `deg` unless the file says `rad`.
  double angle_unit = kDegree;
  int channels = 0;  // number of values in a frame
};

// Parses a skeleton: any order of sections and channels, any case of keywords, CRLF, comments.
// Limits, masses and unknown sections are skipped. Rotations are applied in the order in which they
// are written. Stretching bones (dof `l`) are errors. Errors read `NAME:LINE: cause`.
Result<Asf> parse_asf(std::string_view text, const std::string& name);

struct Amc {
  int frames = 0;
  // The file's angle unit in radians; without :DEGREES or :RADIANS the skeleton's.
  double angle_unit = kDegree;
  double frame_rate_hz = 0.0;  // frames a second; 0: not stated, which is usual
  std::vector<double> values;  // values, frame by frame; in the file's units
};

// Parses a motion of the skeleton `asf`. Frame numbers start anywhere and grow by one. A bone
// missing from the first frame rests. A bone missing from a later frame keeps its last values, or
// is an error if the file says :FULLY-SPECIFIED. `asf_name` is named in the error about a bone that
// the skeleton does not have. Errors read `NAME:LINE: cause`.
Result<Amc> parse_amc(std::string_view text, const std::string& name, const Asf& asf,
                      const std::string& asf_name);

}  // namespace gaitpad
