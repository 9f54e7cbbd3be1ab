// What the loop thread of a live session does, tick by tick.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "base/latest.h"
#include "base/spsc_ring.h"
#include "session/live.h"
#include "session/recording.h"
#include "session/script.h"
#include "session/tick_clock.h"
#include "session/tick_reports.h"
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
  LiveLoop(const Options& options, const Script& script, Simulation& simulation, PadStream& pads,
           Recording* recording);

  // One of two. Until stop(), on the calling thread: no heap, lock, file or driver from here on.
  void run() noexcept;
  // Without a clock: begin(), then any number of ticks whenever it is asked for.
  void begin() noexcept;
  void advance(int ticks) noexcept;
  void stop() noexcept { is_stopping_.store(true, std::memory_order_relaxed); }

  // From one thread each, as LiveSession says.
  const SessionFrame& latest(bool& is_new) noexcept { return frames_.read(is_new); }
  bool take(TickSample& sample) noexcept { return samples_.pop(sample); }
  void set_pace(double pace) noexcept;
  void step(int ticks) noexcept;
  // Any thread.
  bool has_ended() const noexcept { return has_ended_.load(std::memory_order_relaxed); }
  bool is_known(std::uint16_t device) const noexcept { return reports_.is_known(device); }
  // Of LiveStatus what the loop itself knows.
  LiveStatus status() const noexcept;

 private:
  bool wait_for_tick() noexcept;
  void follow_orders() noexcept;
  std::int64_t due_ns() const noexcept;
  void look_at_pads(std::int64_t now_ns) noexcept;
  void keep_time(std::int64_t now_ns) noexcept;
  void run_tick(std::int64_t now_ns, std::int64_t shown_ns) noexcept;
  void follow_script(std::int64_t now_ns) noexcept;
  void use(std::span<const Report> reports, std::int64_t now_ns) noexcept;
  void count_wait(std::int64_t wait_ns) noexcept;
  void publish(std::int64_t shown_ns) noexcept;
  void sample(std::int64_t took_ns) noexcept;
  void beat() noexcept;
  void look_for_the_end(bool has_reports) noexcept;

  Options options_;
  const Script& script_;
  std::size_t next_event_ = 0;  // of the script
  Simulation& simulation_;
  PadStream& pads_;
  Recording* recording_;
  TickClock clock_;
  TickReports reports_;
  std::int64_t tick_ = 0;        // the next one
  std::int64_t steps_left_ = 0;  // while it stands still
  std::int64_t last_begin_ns_ = 0;
  std::int64_t shown_ns_ = 0;      // SessionFrame::time_ns of the last tick
  std::int64_t real_time_ns_ = 0;  // since when ticks come at the rate: waits before mean nothing
  std::int64_t ticks_behind_end_ = 0;
  Latest<SessionFrame> frames_;
  TickSample sample_;
  SpscRing<TickSample> samples_;

  std::atomic<bool> is_stopping_{false}, has_ended_{false};
  std::atomic<double> wanted_pace_{1.0};
  std::atomic<std::int64_t> wanted_steps_{0};
  std::atomic<std::int64_t> start_ns_{0}, end_ns_{0};  // of run(); 0: not yet
  std::atomic<std::int64_t> ticks_{0}, overruns_{0}, standstills_{0}, overloads_{0}, skipped_ns_{0};
  std::array<std::atomic<std::int64_t>, LiveStatus::kWaitClasses> wait_counts_{};
  TimeHistogram tick_times_, wait_times_, late_times_;
};

}  // namespace gaitpad
