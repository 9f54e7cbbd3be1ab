// The poses of a run in a small file beside its expectation (NAME.expect.poses), to locate the
// first difference of two runs. A fingerprint of each joint and tick finds a differing bit exactly;
// values rounded to kAngleStep and kLengthStep_m give its size.
//
// The file: the line `gaitpad poses 1`; the uncompressed length of the rest, 8 bytes; the rest,
// compressed by zlib. All numbers are little-endian; N is a number of 7 bits a byte, the lowest
// first. Rate N, ticks of the run N, pose hash 8 bytes, channels N, ticks kept N; then each
// channel: the character N (0: the crowd), the joint's name (N bytes), a fingerprint of 2 bytes for
// each tick, and three columns of values, each as its second differences N, signs in the lowest
// bit.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/simulation.h"

namespace gaitpad {

inline constexpr double kDegrees = 57.29577951308232;  // 180 / pi

// One joint of one character, or its root's place.
struct PoseChannel {
  int character = 1;  // counted from 1; 0: the whole crowd, as a fingerprint without values
  std::string joint;  // name of the joint; empty: the root's place
  std::vector<std::uint16_t> prints;
  // The root's place in kLengthStep_m, or x, y, z of the rotation with w >= 0 in kAngleStep.
  std::array<std::vector<std::int32_t>, 3> values;
};

class PoseTrack {
 public:
  static constexpr double kLengthStep_m = 1e-4;
  // Step of the stored rotations: 0.007 degrees.
  static constexpr double kAngleStep = 1.0 / 16384.0;

  // `ticks`: the length of the run. Keeps the first ticks, as many as fit into kMaxCells.
  PoseTrack(const Simulation& simulation, int rate_hz, std::int64_t ticks);
  void add(const Simulation& simulation);  // Call it after each tick.

  std::string bytes() const;
  static Result<PoseTrack> parse(std::string_view bytes, const std::string& name);

  int rate_hz() const { return rate_hz_; }
  std::int64_t ticks() const { return ticks_; }      // The run's number of ticks.
  std::size_t kept() const { return kept_; }         // The number of ticks that are kept.
  std::uint64_t pose_hash() const { return hash_; }  // The hash of the run's poses.
  const std::vector<PoseChannel>& channels() const { return channels_; }

 private:
  // Most pairs of a channel and a tick, at 14 bytes each.
  static constexpr std::size_t kMaxCells = std::size_t{1} << 22;
  PoseTrack() = default;

  int rate_hz_ = 0;
  std::int64_t ticks_ = 0;
  std::size_t most_ = 0, kept_ = 0;
  std::uint64_t hash_ = 0;
  std::vector<PoseChannel> channels_;
};

// Value in a tick: the rotation vector in degrees, in the parent's frame, or the root's place in
// metres.
vec3 shown_value(const PoseChannel& channel, std::size_t tick);
// Distance in a tick: degrees, or metres for a root. 0: less than the rounding.
double distance_of(const PoseChannel& a, const PoseChannel& b, std::size_t tick);

struct PoseDifference {
  struct Place {
    std::size_t tick = 0, channel = 0;
    double distance = 0.0;  // distance of the two channels, by distance_of()
  };
  // The first tick with a differing bit, and its channel with the largest distance.
  Place first;
  int others = 0;  // number of other channels that differ in that tick
  Place largest;   // the largest difference of the whole run; of angles only, if an angle differs
};
// Returns nothing if the ticks that both keep are equal. Error: the channels differ.
Result<std::optional<PoseDifference>> difference(const PoseTrack& before, const PoseTrack& after);

}  // namespace gaitpad
