#include "stick/home_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "stick/report_statistics.h"

namespace gaitpad {
namespace {

constexpr double kFarthestHome = 0.5;  // raw; a stick that rests farther out looks held

struct Box {
  vec2 middle{0.0}, half{0.0};
};

std::optional<Box> box_of(std::span<const StickTrack> tracks) noexcept {
  vec2 least(1e9), most(-1e9);
  for (const StickTrack& track : tracks) {
    for (const StickSample& sample : track) {
      least = glm::min(least, sample.raw);
      most = glm::max(most, sample.raw);
    }
  }
  if (least.x > most.x) return {};
  return Box{0.5 * (least + most), 0.5 * (most - least)};
}

// Places are told apart on a grid over +-kFarthestHome; neighbours within 0.19 are one place, so
// that the rests of a stick that drifts, or returns badly, hang together.
class Places {
 public:
  void add(const Still& still) {
    const std::size_t bin = bin_of(still.mean);
    seen_[bin] += std::min(still.duration_s, 0.5);
    sum_[bin] += still.mean;
    count_[bin] += 1.0;
  }
  // Numbers the places and finds the best: often visited, near the middle.
  void choose() {
    double best = 0.0;
    for (int bin = 0; bin < kBins * kBins; ++bin) {
      if (count_[bin] == 0.0 || place_[bin] != 0) continue;
      const double score = flood(bin);
      if (score > best) {
        best = score;
        home_ = places_;
      }
    }
  }
  bool is_home(const Still& still) const {
    return is_inside(still.mean) && home_ != 0 && place_[bin_of(still.mean)] == home_;
  }
  static bool is_inside(const vec2& p) {
    return std::max(std::fabs(p.x), std::fabs(p.y)) < kFarthestHome;
  }

 private:
  static constexpr int kBins = 16, kReach = 3;
  static std::size_t bin_of(const vec2& p) {
    const auto index = [](double x) {
      return std::clamp(static_cast<int>((x / kFarthestHome + 1.0) * 0.5 * kBins), 0, kBins - 1);
    };
    return static_cast<std::size_t>(index(p.y) * kBins + index(p.x));
  }
  // Gives the place of a bin its number and returns how good a home it is.
  double flood(int first) {
    ++places_;
    std::vector<int> open{first};
    place_[first] = places_;
    double seen = 0.0, count = 0.0;
    vec2 sum(0.0);
    while (!open.empty()) {
      const int bin = open.back();
      open.pop_back();
      seen += seen_[bin];
      sum += sum_[bin];
      count += count_[bin];
      for (int y = bin / kBins - kReach; y <= bin / kBins + kReach; ++y) {
        for (int x = bin % kBins - kReach; x <= bin % kBins + kReach; ++x) {
          if (x < 0 || y < 0 || x >= kBins || y >= kBins) continue;
          const int next = y * kBins + x;
          if (count_[next] == 0.0 || place_[next] != 0) continue;
          place_[next] = places_;
          open.push_back(next);
        }
      }
    }
    const vec2 middle = sum / count / 0.25;  // worn sticks rest up to that far off
    return seen * std::exp(-glm::dot(middle, middle));
  }

  std::array<double, kBins * kBins> seen_{}, count_{};
  std::array<vec2, kBins * kBins> sum_{};
  std::array<int, kBins * kBins> place_{};
  int places_ = 0, home_ = 0;
};

// Of a stick that was turned round, which lies well inside of where it went.
bool may_be_home(const Still& still, const std::optional<Box>& turned) noexcept {
  if (!Places::is_inside(still.mean)) return false;
  if (!turned) return true;
  const vec2 off = (still.mean - turned->middle) / turned->half;
  return glm::length(off) < 0.6;
}

// Where the stick went, if it went all the way round.
std::optional<Box> turned_box(std::span<const StickTrack> tracks) {
  const std::optional<Box> box = box_of(tracks);
  if (!box) return {};
  const double least_half = std::min(box->half.x, box->half.y);
  if (least_half <= 0.2 || whole_turns(tracks, box->middle, 0.6 * least_half) == 0) return {};
  return box;
}

double farthest_from(const vec2& home, std::span<const StickTrack> tracks) noexcept {
  double farthest = 0.5;
  for (const StickTrack& track : tracks) {
    for (const StickSample& sample : track) {
      farthest = std::max(farthest, glm::length(sample.raw - home));
    }
  }
  return farthest;
}

}  // namespace

Stills sorted_stills(std::span<const StickTrack> tracks, std::span<const Still> found) {
  const std::optional<Box> turned = turned_box(tracks);
  Places places;
  for (const Still& still : found) {
    if (may_be_home(still, turned)) places.add(still);
  }
  places.choose();
  Stills sorted;
  vec2 home(0.0);
  double weight = 0.0;
  for (const Still& still : found) {
    if (!places.is_home(still) || !may_be_home(still, turned)) continue;
    sorted.rests.push_back(still);
    home += still.duration_s * still.mean;
    weight += still.duration_s;
  }
  if (weight > 0.0) home /= weight;
  const double reach = farthest_from(home, tracks);
  for (const Still& still : found) {
    if (glm::length(still.mean - home) >= 0.5 * reach && !places.is_home(still)) {
      sorted.pushes.push_back(still);
    }
  }
  return sorted;
}

}  // namespace gaitpad
