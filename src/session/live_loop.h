// When the ticks of a live session are due.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/latest.h"
#include "base/spsc_ring.h"
#include "gaitpad/live.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/session_frame.h"
#include "session/recording.h"
#include "session/script.h"

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

// How long something took, many times: median and greatest, in a fixed space.

// Counts by size in classes no wider than 1/64 of the value. One thread adds, any reads: both
// wait-free, no heap.
class TimeHistogram {
 public:
  void add(std::int64_t time_ns) noexcept;  // what is negative counts as 0
  double median_us() const noexcept;        // within 1 % of the true one; 0 where there is none
  double max_us() const noexcept;

 private:
  static constexpr int kStepBits = 6;              // classes in an octave: 64
  static constexpr int kOctaves = 40 - kStepBits;  // up to 2^40 ns, 18 minutes
  static constexpr std::size_t kClasses = static_cast<std::size_t>(kOctaves + 2) << kStepBits;
  static std::size_t class_of(std::uint64_t time_ns) noexcept;
  static double middle_ns(std::size_t index) noexcept;

  std::array<std::atomic<std::uint64_t>, kClasses> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

// The reports on their way from the pads to the tick that uses them. No heap, lock or system call.

// While ticks stand still reports gather for the next one. Of those that only move a stick the
// newest is kept; none that presses or releases a button is left out, as long as there is room.
// When there is none they stay with the pads, which keep the newest state (session/pad_queue.h).
class TickReports {
 public:
  static constexpr std::size_t kMaxInTick = 256;  // what is more waits for the next tick

  // Both outlive it.
  TickReports(PadStream& pads, Simulation& simulation);

  // For the tick that begins now. Valid until the next call.
  std::span<const Report> take(std::int64_t now_ns) noexcept;
  // While ticks stand still, as often as one likes. True where something has come.
  bool gather(std::int64_t now_ns) noexcept;
  // What was gathered shows already, though no tick has used it: the driving pad's state and the
  // buttons that were pressed.
  void show(SessionFrame& frame) const noexcept;

  // Any thread: the device was added, what the pads know of it may be read.
  bool is_known(std::uint16_t device) const noexcept;

 private:
  struct Gathered {  // of one device, since the last tick
    PadState state;
    bool has_state = false;
    int newest = -1;  // index in reports_ of its newest report where that may be replaced
    std::array<std::uint32_t, kButtonCount> presses{};
  };

  bool is_of_known_device(const Report& report) noexcept;
  // True: it took the place of an older one.
  bool replaces_older(const Report& report) noexcept;
  void begin_anew() noexcept;

  PadStream& pads_;
  Simulation& simulation_;
  std::vector<Report> reports_;  // kMaxInTick
  std::size_t count_ = 0;
  bool is_used_ = false;  // what stands in reports_ belongs to the last tick
  std::array<Gathered, kMaxPads> gathered_{};
  std::array<std::atomic<bool>, kMaxPads> is_known_{};
};

// What the loop thread of a live session does, tick by tick.

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
