#include "stick/reached_outline.h"

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

constexpr double kTurn_rad = 2.0 * kPi;
// Least raw radius at which a stick can be turning along its rim; the limit of dualshock-tools.
constexpr double kLeastRimRadius = 0.2;

}  // namespace

void ReachedOutline::add(const vec2& before, const vec2& now, std::int64_t tick,
                         int rate_hz) noexcept {
  constexpr std::int64_t kKept_s = 10;
  constexpr int kParts = 8;
  // Largest turn between two frames; a larger one may have crossed the middle.
  constexpr double kMostTurn_rad = 1.0;
  for (Reached& r : reached_)
    if (tick - r.tick > kKept_s * rate_hz) r.radius = 0.0;
  if (!std::isfinite(before.x + before.y + now.x + now.y)) return;
  const double from = std::atan2(before.y, before.x), radius = glm::length(now);
  double turn = std::remainder(std::atan2(now.y, now.x) - from, kTurn_rad);
  const bool is_along = std::fabs(turn) < kMostTurn_rad && glm::length(before) > kLeastRimRadius;
  for (int part = is_along ? 1 : kParts; part <= kParts; ++part) {
    const double share = static_cast<double>(part) / kParts;
    const double angle = from + share * turn;
    const double r = glm::length(before) + share * (radius - glm::length(before));
    const auto count = static_cast<long>(kCircularityBins);
    const long k = std::lround(angle / kTurn_rad * static_cast<double>(count));
    Reached& to = reached_[static_cast<std::size_t>(((k % count) + count) % count)];
    if (r < to.radius) continue;
    to = {r, tick};
  }
}

std::optional<double> ReachedOutline::error() const noexcept {
  CircularityBins greatest;
  std::ranges::transform(reached_, greatest.begin(), &Reached::radius);
  return circularity_error(greatest);
}

}  // namespace gaitpad
