// A live session: pads in, poses out, at a fixed rate on a thread of its own.
//
// The loop thread sleeps until the tick's moment (absolute, CLOCK_MONOTONIC), takes the reports
// that have arrived, calls Simulation::step(), publishes the newest frame and hands what it used to
// the recording. It touches no driver, file, lock, log or heap. A tick that begins late is counted
// and made up for, so that the number of ticks is the time times the rate; only when it is more
// than a second behind (the program stood still, or ticks take longer than their time) the session
// goes on where it stood.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "gaitpad/session_frame.h"
#include "gaitpad/setup.h"

namespace gaitpad {

struct LiveOptions {
  SessionOptions session;
  PadWish wish;
  int rate_hz = kDefaultRateHz;
  std::string record;     // FILE.hid, empty: none
  bool keyboard = false;  // a virtual pad that steer() moves; it counts while no pad is deflected
  // by_hand: no loop thread, ticks run in advance() alone; for pictures and videos.
  enum class Clock { real_time, by_hand } clock = Clock::real_time;
  bool rumble = true;  // a beat at each heel strike, as strong as the walk is fast
};

// Since the beginning. Standing still (set_pace) is no lateness and no wait.
struct LiveStatus {
  static constexpr std::size_t kWaitClasses = 32;
  static constexpr std::int64_t kWaitClass_ns = 250'000;

  std::int64_t ticks = 0;
  double time_s = 0.0;           // of the clock since tick 0 was due, until the stop; 0: by hand
  std::int64_t overruns = 0;     // ticks that began more than one tick late
  std::int64_t standstills = 0;  // of more than a second, after which the clock was set forward
  std::int64_t overloads = 0;    // the same because ticks take longer than their time
  double skipped_s = 0.0;        // by these
  double late_us_median = 0.0, late_us_max = 0.0;  // from when a tick was due to its begin
  double tick_us_median = 0.0, tick_us_max = 0.0;  // one step, without the sleep
  // From a report's arrival to the tick using it, at pace 1.
  double wait_us_median = 0.0, wait_us_max = 0.0;
  std::array<std::int64_t, kWaitClasses> wait_counts{};  // by kWaitClass_ns; the last: more
  // How the loop thread is scheduled: `SCHED_FIFO 20`, `normal priority`, `by hand`.
  std::string time_policy;
  PadStreamCounts pads;
  std::int64_t recording_lost = 0;  // reports that the recording missed: it is then no exact one
};

// Behind what run_summary() writes, units in the keys.
void add_status(const LiveStatus& status, nlohmann::ordered_json& summary);

class LiveSession {
 public:
  static Result<std::unique_ptr<LiveSession>> start(const LiveOptions& options);
  ~LiveSession();

  const Cast& cast() const noexcept;
  // The name of a device that a frame tells of; empty: there is none.
  std::string pad_name(std::uint16_t device) const;

  // From one viewing thread.
  const SessionFrame& latest(bool& is_new) noexcept;
  bool take(TickSample& sample) noexcept;  // the oldest not taken yet; what nobody takes is dropped
  // Ticks in a second of the clock over the rate: 0 stands still, 1 real time, 0.25 slow motion, at
  // most 8; less than 1/1024 stands still. What a tick does is always the same. Counts within 20
  // ms. While it stands still latest() goes on to show the driving pad's state and its presses.
  void set_pace(double pace) noexcept;
  void step(int ticks) noexcept;     // so many at pace 8, while it stands still; else nothing
  void advance(int ticks) noexcept;  // Clock::by_hand: runs them here and now; else nothing
  // The keyboard as a stick: where it is to go, +x right, +y forward, at most 1 long. It moves
  // there smoothly.
  void steer(const vec2& wanted) noexcept;
  // From any thread.
  void command(std::string_view text);
  bool has_ended() const noexcept;  // a recording as a pad, one second behind its end
  LiveStatus status() const noexcept;
  // Pads that cannot be opened, real-time scheduling that is not allowed: each once.
  std::vector<std::string> take_remarks();

  // Ends the threads and the recording. Once. One summary a character, as `replay` writes it.
  Result<std::vector<nlohmann::ordered_json>> stop();

 private:
  LiveSession();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
