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

// Since the beginning. Standing still (pace 0) counts neither as lateness nor as waiting.
struct LiveStatus {
  static constexpr std::size_t kWaitClasses = 32;
  static constexpr std::int64_t kWaitClass_ns = 250'000;

  std::int64_t ticks = 0;
  double time_s = 0.0;        // by the clock from when tick 0 was due to the stop; 0: by hand
  std::int64_t overruns = 0;  // ticks that began more than one tick late
  std::int64_t standstills =
      0;                       // stops of more than a second, after which the clock was set forward
  std::int64_t overloads = 0;  // the clock was set forward because ticks take too long
  double skipped_s = 0.0;      // time that the clock was set forward by
  double late_us_median = 0.0, late_us_max = 0.0;  // from when a tick was due to its begin
  double tick_us_median = 0.0, tick_us_max = 0.0;  // duration of a tick, without the sleep
  // From the arrival of a report to the tick that uses it, at pace 1.
  double wait_us_median = 0.0, wait_us_max = 0.0;
  // From the arrival of a report to the hand-over of the first frame that shows what it did, at
  // pace 1: median and 99th percentile; 0 if nobody shows frames (LiveSession::end_frame()).
  double frame_us_p50 = 0.0, frame_us_p99 = 0.0;
  std::array<std::int64_t, kWaitClasses> wait_counts{};  // by kWaitClass_ns; the last: longer
  // How the loop thread is scheduled: `SCHED_FIFO 20`, `normal priority`, `by hand`.
  std::string time_policy;
  PadStreamCounts pads;
  std::int64_t streamed = 0;        // frames sent to other programs
  std::int64_t recording_lost = 0;  // reports that the recording missed: it is inexact then
};

// How an input report came to its tick.
struct ReportTime {
  std::int64_t tick = 0;
  std::int64_t arrival_ns = 0, begin_ns = 0;  // CLOCK_MONOTONIC: its stamp, and the tick's begin
  std::uint16_t device = kNoDevice;
};

enum class FrameEnd { handed_over, not_shown };

class LiveSession {
 public:
  // Reads the files, opens the recording and starts the threads. Error: a specification that
  // check() refuses, a file that cannot be read, a wish that makes no sense (PadStream::start()).
  static Result<std::unique_ptr<LiveSession>> start(const SessionSpec& spec);
  // The same in two parts, so that a program can end one session only when the files of the next
  // are known to fit together: prepare() reads them and touches no device. `prepared` is used once.
  struct Prepared;
  static Result<std::shared_ptr<Prepared>> prepare(const SessionSpec& spec);
  static Result<std::unique_ptr<LiveSession>> start(const std::shared_ptr<Prepared>& prepared);
  ~LiveSession();

  const SessionSpec& spec() const noexcept;
  const Cast& cast() const noexcept;
  // The name of a device that a frame names; empty: there is none.
  std::string pad_name(std::uint16_t device) const;

  // From one viewing thread.
  const SessionFrame& latest(bool& is_new) noexcept;  // valid until the next call
  // The same, just before drawing: if a tick is due and has not run, waits for it, at most 2 ms.
  const SessionFrame& latest_due() noexcept;
  // What was read last has gone to the display, or will never go there: measures how old the
  // reports are that it shows for the first time.
  void end_frame(FrameEnd end) noexcept;
  // The oldest sample that was not taken yet; false if there is none. When nobody takes samples the
  // newest are dropped.
  bool take_sample(TickSample& sample) noexcept;
  // The oldest that was not taken yet, of a session with SessionSpec::Live::report_times. The
  // newest are dropped when nobody takes them.
  bool take_report_time(ReportTime& time) noexcept;
  // Ticks in a second of the clock over the rate: 0 stands still, 1 is real time, 0.25 slow motion,
  // at most 8; less than 1/1024, or no number, stands still. A tick computes the same at every
  // pace. Takes effect within 20 ms. While the session stands still latest() still shows the
  // driving pad's state and presses.
  void set_pace(double pace) noexcept;
  void step(int ticks) noexcept;     // runs so many at pace 8 if it stands still; else nothing
  void advance(int ticks) noexcept;  // Clock::by_hand: runs them here and now; else nothing
  // Neither does anything for less than one tick.
  // The keyboard as a stick: where it should go, +x right, +y forward, at most 1 long. It moves
  // there smoothly. Not-a-number is the centre.
  void steer(const vec2& wanted) noexcept;
  // From any thread.
  // `style limp_left`; the grammar: config/README.md, `C:`. What is wrong with one is a remark, and
  // it counts as a bad command.
  void command(std::string_view text);
  // A style that commands may name from now on, in cast() too; one of the same name is replaced.
  // From the viewing thread.
  void add_style(const Style& style);
  void rumble() noexcept;  // one beat of the driving pad's motors
  // Ends the recording, if there is one; the session goes on. From the viewing thread; waits for
  // the tick that runs. Error: the file could not be written.
  std::optional<Error> end_recording();
  bool has_ended() const noexcept;  // the pad is a recording that ended a second ago
  LiveStatus status() const noexcept;
  // What users should know (pads that cannot be opened, real-time scheduling that was refused),
  // each once.
  std::vector<std::string> take_remarks();

  // Ends the threads and the recording. Once. Error: the recording could not be written.
  Result<RunSummary> stop();

 private:
  LiveSession();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
