// The poses of a run, kept small beside its expectation (NAME.expect.poses), and where two runs
// part. A fingerprint of each joint in each tick tells exactly when and where a bit differs; values
// rounded to kAngleStep and kLengthStep_m tell by how much.
//
// The file: the line `gaitpad poses 1`, the length of what follows before compression, 8 bytes, and
// that as zlib packs it. All numbers are little-endian; N is a number of 7 bits a byte, the lowest
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

inline constexpr double kDegrees = 57.29577951308232;  // of a radian

// One joint of one character, or its root's place.
struct PoseChannel {
  int character = 1;  // from 1; 0: all of the crowd, fingerprints alone
  std::string joint;  // empty: the place of the root
  std::vector<std::uint16_t> prints;
  // The root's place in kLengthStep_m, else x, y, z of the rotation with w >= 0 in kAngleStep.
  std::array<std::vector<std::int32_t>, 3> values;
};

class PoseTrack {
 public:
  static constexpr double kLengthStep_m = 1e-4;
  static constexpr double kAngleStep = 1.0 / 16384.0;  // 0.007 degrees

  // `ticks`: of the run. A long run's first ticks are kept, as many as kMaxCells hold.
  PoseTrack(const Simulation& simulation, int rate_hz, std::int64_t ticks);
  void add(const Simulation& simulation);  // after each tick

  std::string bytes() const;
  static Result<PoseTrack> parse(std::string_view bytes, const std::string& name);

  int rate_hz() const { return rate_hz_; }
  std::int64_t ticks() const { return ticks_; }      // of the run
  std::size_t kept() const { return kept_; }         // ticks
  std::uint64_t pose_hash() const { return hash_; }  // of the run
  const std::vector<PoseChannel>& channels() const { return channels_; }

 private:
  static constexpr std::size_t kMaxCells = std::size_t{1} << 22;  // a channel in a tick, 14 bytes
  PoseTrack() = default;

  int rate_hz_ = 0;
  std::int64_t ticks_ = 0;
  std::size_t most_ = 0, kept_ = 0;
  std::uint64_t hash_ = 0;
  std::vector<PoseChannel> channels_;
};

// In a tick: the rotation vector in degrees, in the parent's frame; the root's place in metres.
vec3 shown_value(const PoseChannel& channel, std::size_t tick);
// How far apart a channel is in a tick: degrees, of a root metres. 0: less than the steps tell.
double distance_of(const PoseChannel& a, const PoseChannel& b, std::size_t tick);

struct PoseDifference {
  struct Place {
    std::size_t tick = 0, channel = 0;
    double distance = 0.0;  // distance_of()
  };
  // The first tick in which a bit differs; of the channels that do, the one that is farthest off.
  Place first;
  int others = 0;  // further channels that differ in that tick
  Place largest;   // of the whole run; angles alone where one differs
};
// Nothing: all that both keep is the same. Error: the channels are not the same.
Result<std::optional<PoseDifference>> difference(const PoseTrack& before, const PoseTrack& after);

}  // namespace gaitpad
