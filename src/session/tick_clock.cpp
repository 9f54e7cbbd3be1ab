#include "session/tick_clock.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaitpad {

double TickClock::usable_pace(double pace) noexcept {
  if (!(pace >= kMinPace)) return 0.0;
  return std::min(pace, kMaxPace);
}

std::int64_t TickClock::due_ns(std::int64_t tick) const noexcept {
  if (pace_ == 0.0) return kNever_ns;
  const std::int64_t ticks = tick - base_tick_;
  if (pace_ != 1.0) {
    const double tick_ns =
        static_cast<double>(kSecond_ns) / (static_cast<double>(rate_hz_) * pace_);
    return base_ns_ + static_cast<std::int64_t>(std::round(static_cast<double>(ticks) * tick_ns));
  }
  return base_ns_ + ticks / rate_hz_ * kSecond_ns + ticks % rate_hz_ * kSecond_ns / rate_hz_;
}

void TickClock::run_anew(std::int64_t tick, std::int64_t due_ns) noexcept {
  base_tick_ = tick;
  base_ns_ = due_ns;
}

void TickClock::set_pace(double pace, std::int64_t tick, std::int64_t now_ns) noexcept {
  const bool stood_still = pace_ == 0.0;
  const std::int64_t before_ns = due_ns(tick);
  pace_ = pace;
  if (pace_ == 0.0) return;
  run_anew(tick, now_ns);
  if (stood_still) {
    last_late_ns_ = 0;
  } else {
    run_anew(tick, std::min(before_ns, due_ns(tick + 1)));  // not later than a tick from now
  }
}

TickClock::Begin TickClock::begin(std::int64_t tick, std::int64_t now_ns) noexcept {
  const std::int64_t late_ns = now_ns - due_ns(tick);
  const std::int64_t before_ns = std::exchange(last_late_ns_, late_ns);
  if (late_ns <= kTooLate_ns) return now_ns > due_ns(tick + 1) ? Begin::late : Begin::on_time;
  run_anew(tick, now_ns);
  last_late_ns_ = 0;
  skipped_ns_ += late_ns;
  return late_ns - before_ns > kTooLate_ns / 2 ? Begin::after_standstill : Begin::after_overload;
}

}  // namespace gaitpad
