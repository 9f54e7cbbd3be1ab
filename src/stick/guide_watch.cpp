#include "stick/guide_watch.h"

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

constexpr std::int64_t kBucketNs = 100 * kMillisecondNs;
constexpr double kStillWithin = 0.04;  // of means over a tenth: three sigma of a very noisy stick
// Shorter stays are spikes: to another place and back within three reports.
constexpr std::int64_t kSpikeNs = 40 * kMillisecondNs;

constexpr std::int64_t kStillNs = 500 * kMillisecondNs;
constexpr std::int64_t kNearNs = 1500 * kMillisecondNs;
constexpr double kAway = 0.3;           // from where it rests
constexpr double kAwayUnknown = 0.5;    // from the middle, where that is not known yet
constexpr double kFarthestRest = 0.45;  // from the middle; beyond it a stick is held
constexpr std::size_t kMaxRests = 64;   // further releases are not needed

constexpr double kOfReach = 0.6;      // of the farthest that was seen: pushed out
constexpr double kOfMedianRim = 0.6;  // less is a cut corner, not a gate (a square has 0.71)
constexpr double kLeastTravel = 15.0 * kDegree, kMostTravel = 90.0 * kDegree;  // noise, spikes

constexpr std::int64_t kHeldNs = 250 * kMillisecondNs;
constexpr double kInOfRim = 0.6;  // nearer it is let go

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2.0;
}

vec2 median(const std::vector<vec2>& points) {
  std::vector<double> x, y;
  for (const vec2& point : points) {
    x.push_back(point.x);
    y.push_back(point.y);
  }
  return {median(std::move(x)), median(std::move(y))};
}

// 0 right, 1 front, 2 left, 3 back.
std::size_t quarter_of(const vec2& v) noexcept {
  if (std::fabs(v.x) >= std::fabs(v.y)) return v.x >= 0.0 ? 0 : 2;
  return v.y >= 0.0 ? 1 : 3;
}

}  // namespace

void StillWatch::hold(const vec2& raw, std::int64_t duration_ns) noexcept {
  while (duration_ns > 0) {
    const std::int64_t part_ns = std::min(duration_ns, kBucketNs - sum_ns_);
    sum_ += raw * static_cast<double>(part_ns);
    sum_ns_ += part_ns;
    duration_ns -= part_ns;
    if (sum_ns_ < kBucketNs) return;
    const vec2 mean = sum_ / static_cast<double>(kBucketNs);
    sum_ = vec2(0.0);
    sum_ns_ = 0;
    if (!(glm::distance(mean, mean_) <= kStillWithin)) still_ns_ = 0;
    const auto buckets = static_cast<double>(still_ns_ / kBucketNs);
    mean_ = (mean_ * buckets + mean) / (buckets + 1.0);
    still_ns_ += kBucketNs;
  }
}

void ReleaseWatch::hold(const vec2& raw, std::int64_t duration_ns) {
  still_.hold(raw, duration_ns);
  const vec2 from_rest = raw - rest_.value_or(vec2(0.0));
  if (glm::length(from_rest) > (rest_ ? kAway : kAwayUnknown)) {
    away_ns_ += duration_ns;
    away_ = from_rest;
    if (away_ns_ > kSpikeNs) {
      if (!is_away_) still_ = StillWatch();  // how it stood before it went
      reach_ = std::max(reach_, glm::length(from_rest));
      is_away_ = true;
      near_ns_ = 0;
      near_sum_ = vec2(0.0);
    }
  } else {
    away_ns_ = 0;
    near_ns_ += duration_ns;
    near_sum_ += raw * static_cast<double>(duration_ns);
  }
  if (is_back()) add_release();
  if (count() >= kWantedReleases && sides() >= kWantedSides && near_ns_ >= kWantedRestNs)
    is_complete_ = true;
}

bool ReleaseWatch::is_held() const noexcept {
  return is_away_ && still_.still_ns() >= kStillNs && !is_back();
}

bool ReleaseWatch::is_back() const noexcept {
  if (near_ns_ >= kNearNs && away_ns_ == 0) return true;
  if (still_.still_ns() < kStillNs || !(glm::length(still_.mean()) < kFarthestRest)) return false;
  // The first rests may each be a stick that was held; two of them tell.
  return rests_.size() < 2 || glm::distance(still_.mean(), *rest_) < kAway;
}

void ReleaseWatch::add_release() {
  const bool is_still = still_.still_ns() >= kStillNs;
  const vec2 place = is_still ? still_.mean() : near_sum_ / static_cast<double>(near_ns_);
  if (!is_away_) {
    if (rests_.empty()) rest_ = place;
    return;
  }
  is_away_ = false;
  away_ns_ = 0;
  sides_[quarter_of(away_)] = true;
  if (rests_.size() < kMaxRests) rests_.push_back(place);
  rest_ = median(rests_);
}

void ReleaseWatch::restart() {
  rests_.clear();
  sides_ = {};
  is_complete_ = false;
  lose();
}

void ReleaseWatch::lose() noexcept {
  still_ = StillWatch();
  away_ns_ = near_ns_ = 0;
  near_sum_ = vec2(0.0);
  is_away_ = false;
}

double ReleaseWatch::rim() const noexcept {
  return reach_ > 0.0 ? std::min(kHalfWay, kOfReach * reach_) : kHalfWay;
}

int ReleaseWatch::sides() const noexcept {
  return static_cast<int>(std::ranges::count(sides_, true));
}

void TurnWatch::take(const vec2& from_rest, double rim) noexcept {
  rim_ = rim;
  const double radius = glm::length(from_rest);
  if (!(radius > rim)) return;  // between two circles; not-a-number, too
  const double angle_rad = atan2(from_rest.y, from_rest.x);
  const int bin = static_cast<int>(std::lround(angle_rad / (2.0 * kPi) * kTurnBins));
  double& greatest = radius_[static_cast<std::size_t>((bin + kTurnBins) % kTurnBins)];
  greatest = std::max(greatest, radius);
  const double moved_rad = anchor_rad_ ? std::fabs(wrapped(angle_rad - *anchor_rad_)) : 0.0;
  if (anchor_rad_ && moved_rad < kLeastTravel) return;
  if (moved_rad < kMostTravel) travelled_rad_ += moved_rad;
  anchor_rad_ = angle_rad;
}

double TurnWatch::least_radius() const noexcept {
  std::array<double, kTurnBins> sorted = radius_;
  const auto end = std::remove(sorted.begin(), sorted.end(), 0.0);
  if (end == sorted.begin()) return rim_;
  const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
  std::nth_element(sorted.begin(), middle, end);
  return std::max(rim_, kOfMedianRim * *middle);
}

int TurnWatch::filled() const noexcept {
  const double least = least_radius();
  return static_cast<int>(
      std::ranges::count_if(radius_, [least](double radius) { return radius > least; }));
}

std::optional<vec2> TurnWatch::missing() const noexcept {
  const double least = least_radius();
  int longest = 0, end = 0, run = 0;  // of bins that are not filled, `end` included
  for (int i = 0; i < 2 * kTurnBins; ++i) {
    run = radius_[static_cast<std::size_t>(i % kTurnBins)] > least ? 0 : run + 1;
    if (run > kTurnBins) run = kTurnBins;
    if (run <= longest) continue;
    longest = run;
    end = i;
  }
  if (longest == 0) return std::nullopt;
  const SinCos middle = sin_cos((end - (longest - 1) / 2.0) * 2.0 * kPi / kTurnBins);
  return vec2(middle.cos, middle.sin);
}

void PushWatch::hold(const vec2& from_rest, double rim, std::int64_t duration_ns) noexcept {
  const double radius = glm::length(from_rest);
  const Zone zone = radius > rim ? Zone::out : radius < kInOfRim * rim ? Zone::in : Zone::between;
  zone_ns_ = zone == zone_ ? zone_ns_ + duration_ns : duration_ns;
  zone_ = zone;
  if (zone == Zone::out && is_armed_) {
    out_ns_ += duration_ns;
    sum_ += from_rest * static_cast<double>(duration_ns);
  }
  if (zone != Zone::in || zone_ns_ < kSpikeNs) return;
  if (out_ns_ >= kHeldNs) push_ = sum_ / static_cast<double>(out_ns_);
  out_ns_ = 0;
  sum_ = vec2(0.0);
  is_armed_ = true;
}

void PushWatch::restart() noexcept {
  is_armed_ = zone_ == Zone::in || zone_ == Zone::unknown;
  out_ns_ = 0;
  sum_ = vec2(0.0);
  push_.reset();
}

PushWatch::State PushWatch::state() const noexcept {
  if (out_ns_ >= kHeldNs) return State::held;
  return out_ns_ > kSpikeNs ? State::out : State::waiting;
}

std::optional<vec2> PushWatch::take_push() noexcept {
  const std::optional<vec2> push = push_;
  push_.reset();
  return push;
}

}  // namespace gaitpad
