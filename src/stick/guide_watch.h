// What the guide watches one stick or trigger for: standing still, releases, turns, pushes. It goes
// by how long a position held, so a pad that reports changes only and one that streams look the
// same, and by means, so noise and single wrong reports do not count. Positions are raw.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/math.h"
#include "stick/outline.h"

namespace gaitpad {

inline constexpr std::int64_t kMillisecondNs = 1'000'000;

// For how long the position has stood still. It may wander slowly, within 0.04.
class StillWatch {
 public:
  void hold(const vec2& raw, std::int64_t duration_ns) noexcept;
  std::int64_t still_ns() const noexcept { return still_ns_; }  // in whole tenths of a second
  const vec2& mean() const noexcept { return mean_; }           // while it stood still

 private:
  vec2 sum_{0.0};  // of the running tenth, times nanoseconds
  std::int64_t sum_ns_ = 0;
  vec2 mean_{0.0};
  std::int64_t still_ns_ = 0;
};

inline constexpr double kHalfWay = 0.5;  // from rest; beyond it a control is pushed out

inline constexpr int kWantedReleases = 6, kWantedSides = 3;
inline constexpr std::int64_t kWantedRestNs = 2500 * kMillisecondNs;  // for drift, at the end

// A release: it was away from where it rests, then stood still there for half a second, or was
// there for one and a half (a stick that wanders at rest).
class ReleaseWatch {
 public:
  void hold(const vec2& raw, std::int64_t duration_ns);
  void restart();        // releases are forgotten, where it rests is not
  void lose() noexcept;  // unplugged: the running one does not count

  int count() const noexcept { return static_cast<int>(rests_.size()); }
  int sides() const noexcept;  // quarters that it was let go from
  bool is_away() const noexcept { return is_away_; }
  std::int64_t rested_ns() const noexcept { return near_ns_; }  // since the last release
  // Stays so, whatever the other stick still needs.
  bool is_complete() const noexcept { return is_complete_; }
  // It stands still, but too far out to be at rest.
  bool is_held() const noexcept;
  // The median of the rests, else where it stood when it was first seen; none: not seen at rest.
  std::optional<vec2> rest() const noexcept { return rest_; }
  // What counts as pushed out in the other steps, as a distance from rest: half of the way, less
  // where the stick was never seen to reach far.
  double rim() const noexcept;

 private:
  bool is_back() const noexcept;
  void add_release();

  StillWatch still_;
  std::vector<vec2> rests_;
  std::array<bool, 4> sides_{};  // right, front, left, back, of raw axes
  std::optional<vec2> rest_;
  vec2 away_{0.0};            // from rest, where it was last seen away
  double reach_ = 0.0;        // the farthest of these, spikes left out
  std::int64_t away_ns_ = 0;  // without a break
  std::int64_t near_ns_ = 0;  // since it was away, spikes left out
  vec2 near_sum_{0.0};        // meanwhile, times nanoseconds
  bool is_away_ = false, is_complete_ = false;
};

inline constexpr int kTurnBins = kCircularityBins;
inline constexpr double kWantedTurns = 2.0;

// Full circles along the rim.
class TurnWatch {
 public:
  void take(const vec2& from_rest, double rim) noexcept;
  void restart() noexcept { *this = TurnWatch(); }
  void lose() noexcept { anchor_rad_.reset(); }

  int filled() const noexcept;
  double turns() const noexcept { return travelled_rad_ / (2.0 * kPi); }  // either way
  bool is_complete() const noexcept { return filled() == kTurnBins && turns() >= kWantedTurns; }
  // The middle of the greatest gap, unit length; none without gaps.
  std::optional<vec2> missing() const noexcept;

 private:
  double least_radius() const noexcept;

  double rim_ = 0.0;
  std::array<double, kTurnBins> radius_{};  // greatest; bin k is centred on k times 7.5 degrees
  std::optional<double> anchor_rad_;
  double travelled_rad_ = 0.0;
};

// A push: beyond the rim for a quarter of a second, then back near the rest.
class PushWatch {
 public:
  enum class State : std::uint8_t { waiting, out, held };
  void hold(const vec2& from_rest, double rim, std::int64_t duration_ns) noexcept;
  void restart() noexcept;  // what is out now does not count
  void lose() noexcept { *this = PushWatch(); }

  State state() const noexcept;
  // The mean while it was out, from rest. Once each.
  std::optional<vec2> take_push() noexcept;

 private:
  enum class Zone : std::uint8_t { unknown, in, between, out };
  Zone zone_ = Zone::unknown;
  std::int64_t zone_ns_ = 0, out_ns_ = 0;
  bool is_armed_ = true;  // it has been let go since the step began
  vec2 sum_{0.0};
  std::optional<vec2> push_;
};

}  // namespace gaitpad
