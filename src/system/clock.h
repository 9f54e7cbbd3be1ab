// The clock of the whole program, CLOCK_MONOTONIC.
#pragma once
#include <time.h>

#include <cstdint>

namespace gaitpad {

// The time of CLOCK_MONOTONIC, as in Report::time_ns.
inline std::int64_t now_ns() noexcept {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Sleeps until that time; returns at once if it is over. A signal may end the sleep early.
inline void sleep_until(std::int64_t time_ns) noexcept {
  const timespec until = {static_cast<time_t>(time_ns / 1'000'000'000),
                          static_cast<long>(time_ns % 1'000'000'000)};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

}  // namespace gaitpad
