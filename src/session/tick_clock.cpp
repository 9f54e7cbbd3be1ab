#include "session/tick_clock.h"

#include <utility>

namespace gaitpad {

std::int64_t TickClock::due_ns(std::int64_t tick) const noexcept {
  const std::int64_t ticks = tick - base_tick_;
  return base_ns_ + ticks / rate_hz_ * kSecond_ns + ticks % rate_hz_ * kSecond_ns / rate_hz_;
}

TickClock::Begin TickClock::begin(std::int64_t tick, std::int64_t now_ns) noexcept {
  const std::int64_t late_ns = now_ns - due_ns(tick);
  const std::int64_t before_ns = std::exchange(last_late_ns_, late_ns);
  if (late_ns <= kTooLate_ns) return now_ns > due_ns(tick + 1) ? Begin::late : Begin::on_time;
  base_tick_ = tick;
  base_ns_ = now_ns;
  last_late_ns_ = 0;
  skipped_ns_ += late_ns;
  return late_ns - before_ns > kTooLate_ns / 2 ? Begin::after_standstill : Begin::after_overload;
}

}  // namespace gaitpad
