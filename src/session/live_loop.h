// What the loop thread of a live session does, tick by tick.
#pragma once
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "base/latest.h"
#include "session/live.h"
#include "session/recording.h"
#include "session/tick_clock.h"
#include "session/time_histogram.h"

namespace gaitpad {

// What is felt of a heel that strikes the floor at this speed of walking.
Rumble heel_beat(double speed_m_s) noexcept;

class LiveLoop {
 public:
  struct Options {
    int rate_hz = kDefaultRateHz;
    bool rumble = true;
  };
  // All outlive the loop; `recording` may be null.
  LiveLoop(const Options& options, Simulation& simulation, PadStream& pads, Recording* recording);

  // Until stop(), on the calling thread: no heap, lock, file or driver from here on.
  void run() noexcept;
  void stop() noexcept { is_stopping_.store(true, std::memory_order_relaxed); }

  const SessionFrame& latest(bool& is_new) noexcept { return frames_.read(is_new); }
  bool has_ended() const noexcept { return has_ended_.load(std::memory_order_relaxed); }
  // Of LiveStatus what the loop itself knows.
  LiveStatus status() const noexcept;

 private:
  bool sleep_until(std::int64_t due_ns) const noexcept;
  void keep_time(std::int64_t tick, std::int64_t now_ns) noexcept;
  void run_tick(std::int64_t tick, std::int64_t now_ns) noexcept;
  void take_reports(std::int64_t tick, std::int64_t now_ns) noexcept;
  bool is_known(const Report& report) noexcept;
  void publish(std::int64_t tick) noexcept;
  void beat() noexcept;
  void look_for_the_end() noexcept;

  Options options_;
  Simulation& simulation_;
  PadStream& pads_;
  Recording* recording_;
  TickClock clock_;
  std::vector<Report> reports_;  // of the running tick; room for the most
  std::size_t report_count_ = 0;
  std::array<bool, kMaxPads> is_known_{};
  std::int64_t ticks_behind_end_ = 0;
  Latest<SessionFrame> frames_;

  std::atomic<bool> is_stopping_{false}, has_ended_{false};
  std::atomic<std::int64_t> ticks_{0}, overruns_{0}, standstills_{0}, overloads_{0}, skipped_ns_{0};
  TimeHistogram tick_times_, wait_times_;
};

}  // namespace gaitpad
