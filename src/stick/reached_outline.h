// The farthest that a live stick was seen in each direction within the last ten seconds.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "stick/outline.h"

namespace gaitpad {

class ReachedOutline {
 public:
  // Takes the raw position of a stick. The directions that it passed since `before` count as well,
  // at radii between the two.
  void add(const vec2& before, const vec2& now, std::int64_t tick, int rate_hz) noexcept;
  // Raw; 0: nothing was seen in this direction. Direction k is k times 7.5 degrees from the right.
  double radius(std::size_t k) const noexcept { return reached_[k].radius; }
  // circularity_error(); none until nearly all directions were reached.
  std::optional<double> error() const noexcept;

 private:
  struct Reached {
    double radius = 0.0;
    std::int64_t tick = 0;
  };
  std::array<Reached, kCircularityBins> reached_{};
};

}  // namespace gaitpad
