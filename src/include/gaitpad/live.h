// A live session: pads in, poses out, at a fixed rate on a thread of its own.
//
// The loop thread sleeps until a tick is due (absolute time, CLOCK_MONOTONIC), takes the reports
// that have arrived, calls Simulation::step(), publishes the newest frame and hands the reports to
// the recording. It touches no driver, file, lock, log or heap. A tick that begins late is counted,
// and the ticks after it come sooner, so that the number of ticks is the time times the rate. Only
// if the loop is more than a second behind (the program was stopped, or ticks take longer than
// their time) the clock is set forward instead.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "gaitpad/session_frame.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/summary.h"

namespace gaitpad {

// The state of a live session, counted since its beginning. Time at pace 0 counts neither as
// lateness nor as waiting.
struct LiveStatus {
  static constexpr std::size_t kWaitClasses = 32;
  static constexpr std::int64_t kWaitClass_ns = 250'000;

  std::int64_t ticks = 0;
  double time_s = 0.0;           // time from when tick 0 was due to the stop; 0: by hand
  std::int64_t overruns = 0;     // number of ticks that began more than one tick late
  std::int64_t standstills = 0;  // number of stops of more than a second, after which the clock was
                                 // set forward
  // Number of times that the clock was set forward because ticks take too long.
  std::int64_t overloads = 0;
  double skipped_s = 0.0;                          // total time by which the clock was set forward
  double late_us_median = 0.0, late_us_max = 0.0;  // delays from when a tick was due until it began
  double tick_us_median = 0.0, tick_us_max = 0.0;  // duration of a tick, without the sleep
  // Times from the arrival of a report to the tick that uses it, at pace 1.
  double wait_us_median = 0.0, wait_us_max = 0.0;
  // Times from the arrival of a report to the hand-over of the first frame that shows its effect,
  // at pace 1: median and 99th percentile; 0 if no frames are shown (LiveSession::end_frame()).
  double frame_us_p50 = 0.0, frame_us_p99 = 0.0;
  // Number of waits in each class of kWaitClass_ns; the last class holds all longer ones.
  std::array<std::int64_t, kWaitClasses> wait_counts{};
  // The scheduling of the loop thread: `SCHED_FIFO 20`, `normal priority`, `by hand`.
  std::string time_policy;
  PadStreamCounts pads;
  std::int64_t streamed = 0;  // number of frames sent to other programs
  // Number of reports that are missing in the recording, which is then inexact.
  std::int64_t recording_lost = 0;
};

// The times at which an input report arrived and was used.
struct ReportTime {
  std::int64_t tick = 0;
  // The report's stamp and the tick's begin, CLOCK_MONOTONIC.
  std::int64_t arrival_ns = 0, begin_ns = 0;
  std::uint16_t device = kNoDevice;
};

enum class FrameEnd { handed_over, not_shown };

class LiveSession {
 public:
  // Reads the files, opens the recording and starts the threads. Error: a specification that
  // check() refuses, a file that cannot be read, an impossible selector (PadStream::start()).
  static Result<std::unique_ptr<LiveSession>> start(const SessionSpec& spec);
  // Starting in two parts, so that a program can end one session only when the files of the next
  // are known to fit together: prepare() reads them and touches no device. `prepared` is used once.
  struct Prepared;
  static Result<std::shared_ptr<Prepared>> prepare(const SessionSpec& spec);
  static Result<std::unique_ptr<LiveSession>> start(const std::shared_ptr<Prepared>& prepared);
  ~LiveSession();

  const SessionSpec& spec() const noexcept;
  const Cast& cast() const noexcept;
  // The name of a device by its number in a frame; empty: there is none.
  std::string pad_name(std::uint16_t device) const;

  // The newest frame. Call it from one viewing thread.
  const SessionFrame& latest(bool& is_new) noexcept;  // Valid until the next call.
  // The newest frame just before drawing: if a tick is due and has not run, waits for it, at most 2
  // ms.
  const SessionFrame& latest_due() noexcept;
  // Call it when the last frame that was read is on the display, or will never be. It measures the
  // age of the reports whose effect the frame shows first.
  void end_frame(FrameEnd end) noexcept;
  // Takes the oldest sample; false if there is none. If samples are not taken, new ones are
  // dropped.
  bool take_sample(TickSample& sample) noexcept;
  // Takes the oldest report time; false if there is none. For a program that does not call
  // end_frame(), which takes those that its frame shows. If times are not taken, new ones are
  // dropped.
  bool take_report_time(ReportTime& time) noexcept;
  // Sets the pace, ticks per second over the rate: 0 stands still, 1 is real time, 0.25 slow
  // motion, at most 8; a pace below 1/1024 or not-a-number stands still. A tick computes the same
  // at every pace. Takes effect within 20 ms. While the session stands still, latest() still shows
  // the driving pad's state and presses.
  void set_pace(double pace) noexcept;
  // Runs this number of ticks at pace 8, if the session stands still; does nothing for less than
  // one.
  void step(int ticks) noexcept;
  // Runs this number of ticks in the calling thread, with Clock::by_hand only; does nothing for
  // less than one.
  void advance(int ticks) noexcept;
  // Sets the goal of the keyboard's stick, +x right, +y forward, at most 1 long. The stick moves
  // there smoothly. Not-a-number is the centre.
  void steer(const vec2& wanted) noexcept;
  // Sends a command such as `style limp_left` (grammar: config/README.md, `C:`), from any thread. A
  // command that cannot be carried out gives a remark and counts as bad.
  void command(std::string_view text);
  // Adds a style that commands may name from now on, also to cast(); one of the same name is
  // replaced. Call it from the viewing thread.
  void add_style(const Style& style);
  void rumble() noexcept;  // Runs the driving pad's motors for one beat.
  // Ends the recording, if there is one; the session goes on. Call it from the viewing thread; it
  // waits for the running tick. Error: the file could not be written.
  std::optional<Error> end_recording();
  bool has_ended() const noexcept;  // True if the pad is a recording that ended a second ago.
  LiveStatus status() const noexcept;
  // Remarks for users (pads that cannot be opened, real-time scheduling that was refused). Each is
  // returned once.
  std::vector<std::string> take_remarks();

  // Ends the threads and the recording. Call it once. Error: the recording could not be written.
  Result<RunSummary> stop();

 private:
  LiveSession();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
