#include "stick/new_values.h"

namespace gaitpad {

namespace {

// The longest pause within a movement: slow pads send every 45 ms.
constexpr std::uint64_t kPause_ns = 50'000'000;
// Least travel of a movement, raw; less is noise, or so slow that not every report differs.
constexpr double kMovementTravel = 0.5;
constexpr double kOutOfRange = 8.0;

}  // namespace

void NewValueCount::take(std::int64_t time_ns, const vec2& left, const vec2& right) noexcept {
  // Also true if a position is not a number.
  if (!(glm::length(left) + glm::length(right) <= kOutOfRange)) return;
  ++reports_;
  if (has_position_ && left == left_ && right == right_) return;
  // Unsigned, so that a time that goes back counts as a long pause.
  const auto pause_ns =
      static_cast<std::uint64_t>(time_ns) - static_cast<std::uint64_t>(changed_ns_);
  const bool goes_on = has_position_ && pause_ns <= kPause_ns;
  if (!goes_on) {
    add(running_, sum_);
    running_ = {};
  } else {
    running_.time_ns += static_cast<std::int64_t>(pause_ns);
    running_.reports += reports_;
    running_.values += 1;
    running_.travel += glm::length(left - left_) + glm::length(right - right_);
  }
  has_position_ = true;
  left_ = left;
  right_ = right;
  changed_ns_ = time_ns;
  reports_ = 0;
}

void NewValueCount::add(const Movement& movement, Movement& sum) noexcept {
  if (movement.travel < kMovementTravel) return;
  sum.time_ns += movement.time_ns;
  sum.reports += movement.reports;
  sum.values += movement.values;
}

std::optional<MovementRate> NewValueCount::rate() const noexcept {
  Movement all = sum_;
  add(running_, all);
  if (all.time_ns <= 0) return std::nullopt;
  const double seconds = 1e-9 * static_cast<double>(all.time_ns);
  return MovementRate{static_cast<double>(all.reports) / seconds,
                      static_cast<double>(all.values) / seconds};
}

}  // namespace gaitpad
