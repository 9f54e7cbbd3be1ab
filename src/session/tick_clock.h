// When the ticks of a live session are due.
#pragma once
#include <cstdint>
#include <limits>

namespace gaitpad {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Tick k is due k / rate seconds after the start, in whole nanoseconds and without drift, for as
// long as 64 bits last. A late tick moves none of those after it: they are made up for. After more
// than a second the clock is set forward instead: nobody wants a character to race through what was
// missed.
// The pace is ticks in a second over the rate: slower or quicker, what a tick does is the same.
class TickClock {
 public:
  static constexpr std::int64_t kTooLate_ns = kSecond_ns;
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
  static constexpr double kMinPace = 1.0 / 1024.0, kMaxPace = 8.0;
  // 0 where it is less than the least one or no number.
  static double usable_pace(double pace) noexcept;

  TickClock(int rate_hz, std::int64_t start_ns) : rate_hz_(rate_hz), base_ns_(start_ns) {}
  std::int64_t due_ns(std::int64_t tick) const noexcept;  // kNever_ns at pace 0

  // From `tick`, the next one, on; a usable pace. What is late stays late, but after standing still
  // that tick is due now.
  void set_pace(double pace, std::int64_t tick, std::int64_t now_ns) noexcept;
  double pace() const noexcept { return pace_; }

  enum class Begin {
    on_time,  // not more than one tick late
    late,
    // Far too late: from this tick on, which is due now, the clock runs anew.
    after_standstill,  // all at once: the process was stopped
    after_overload,    // later and later: ticks take longer than their time
  };
  // Not at pace 0.
  Begin begin(std::int64_t tick, std::int64_t now_ns) noexcept;
  std::int64_t skipped_ns() const noexcept { return skipped_ns_; }  // by setting it forward

 private:
  void run_anew(std::int64_t tick, std::int64_t due_ns) noexcept;

  std::int64_t rate_hz_;
  std::int64_t base_ns_;
  std::int64_t base_tick_ = 0;
  double pace_ = 1.0;
  std::int64_t last_late_ns_ = 0;
  std::int64_t skipped_ns_ = 0;
};

}  // namespace gaitpad
