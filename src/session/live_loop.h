// The loop thread of a live session: TickClock says when a tick is due, TickReports which reports
// it uses, and LiveLoop runs the ticks. No heap, lock, file or driver.
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
#include "pads/newest_reports.h"
#include "session/pad_forward.h"
#include "session/pose_stream.h"
#include "session/recording.h"
#include "session/script.h"

namespace gaitpad {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Computes when ticks are due. At pace 1 tick k is due k / rate seconds after the start, in whole
// nanoseconds and without drift. A late tick does not move the later ones, so lost time is made up
// for. If a tick is more than a second late, the clock is set forward instead, so that the
// character does not race. The pace is (ticks per second) / rate; it does not change a tick's
// result.
class TickClock {
 public:
  static constexpr std::int64_t kTooLate_ns = kSecond_ns;
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();
  static constexpr double kMinPace = 1.0 / 1024.0, kMaxPace = 8.0;
  // Clamps to kMaxPace; returns 0 if `pace` is less than kMinPace or not a number.
  static double usable_pace(double pace) noexcept;

  TickClock(int rate_hz, std::int64_t start_ns) : rate_hz_(rate_hz), base_ns_(start_ns) {}
  // The time at which a tick is due; kNever_ns at pace 0.
  std::int64_t due_ns(std::int64_t tick) const noexcept;

  // Sets the pace from `tick`, the next one, on. A late tick stays late; after pace 0 it is due
  // now.
  void set_pace(double pace, std::int64_t tick, std::int64_t now_ns) noexcept;
  double pace() const noexcept { return pace_; }

  enum class Begin {
    on_time,  // the tick began at most one tick late
    late,
    // More than a second late: this tick is due now, and the clock restarts with it.
    after_standstill,  // suddenly, because the process was stopped
    after_overload,    // gradually, because ticks take longer than their time
  };
  // Must not be called at pace 0.
  Begin begin(std::int64_t tick, std::int64_t now_ns) noexcept;
  // Total time by which the clock was set forward.
  std::int64_t skipped_ns() const noexcept { return skipped_ns_; }

 private:
  void run_anew(std::int64_t tick, std::int64_t due_ns) noexcept;

  std::int64_t rate_hz_;
  std::int64_t base_ns_;
  std::int64_t base_tick_ = 0;
  double pace_ = 1.0;
  std::int64_t last_late_ns_ = 0;
  std::int64_t skipped_ns_ = 0;
};

// Percentiles and maximum of any number of durations in a fixed space: counts durations in classes
// no wider than 1/64 of the value. One thread adds, any thread reads; both are wait-free.
class TimeHistogram {
 public:
  void add(std::int64_t time_ns) noexcept;  // Counts a time; a negative one counts as 0.
  // Smallest duration that this share of all does not exceed, within 1 %; 0 without durations.
  double percentile_us(double share) const noexcept;
  double median_us() const noexcept { return percentile_us(0.5); }
  double max_us() const noexcept;
  // Counts the durations in each step of `width_ns`, the longer ones in the last step, within 1 %.
  void count_steps(std::int64_t width_ns, std::span<std::int64_t> counts) const noexcept;

 private:
  static constexpr int kStepBits = 6;              // each octave has 2^kStepBits = 64 classes
  static constexpr int kOctaves = 40 - kStepBits;  // up to 2^40 ns, 18 minutes
  static constexpr std::size_t kClasses = static_cast<std::size_t>(kOctaves + 2) << kStepBits;
  static std::size_t class_of(std::uint64_t time_ns) noexcept;
  static double middle_ns(std::size_t index) noexcept;

  std::array<std::atomic<std::uint64_t>, kClasses> counts_{};
  std::atomic<std::int64_t> max_ns_{0};
};

// Collects the reports of the pads until a tick uses them. No system call.
//
// While ticks stand still, reports gather for the next tick. If several reports only move a stick,
// the newest is kept; reports that press or release a button are all kept. When kMaxInTick have
// gathered, the rest stays in the PadStream, which keeps the newest state of each device.
class TickReports {
 public:
  // Most reports that a tick uses; the others wait for the next.
  static constexpr std::size_t kMaxInTick = 256;

  // `pads` and `simulation` must outlive this object.
  TickReports(PadStream& pads, Simulation& simulation);

  // Reports of the tick that begins now. Valid until the next call.
  std::span<const Report> take_reports(std::int64_t now_ns) noexcept;
  // Gathers reports while ticks stand still; can be called any number of times. True: there was
  // one.
  bool gather(std::int64_t now_ns) noexcept;
  // Shows the gathered reports in the frame although no tick has used them: the driving pad's state
  // and the pressed buttons.
  void show(SessionFrame& frame) const noexcept;

  // Any thread. True: the device was added, so its description in the PadStream may be read.
  bool is_known(std::uint16_t device) const noexcept;

 private:
  struct Gathered {  // reports of one device since the last tick
    PadState state;
    bool has_state = false;
    PressCounts presses{};
  };

  bool is_of_known_device(const Report& report) noexcept;
  // Returns true if `report`, which stands in reports_, replaced an older one.
  bool replaces_older(Report& report) noexcept;
  void begin_anew() noexcept;

  PadStream& pads_;
  Simulation& simulation_;
  std::vector<Report> reports_;  // room for kMaxInTick reports
  std::size_t count_ = 0;
  bool is_used_ = false;  // the last tick has used reports_
  std::array<Gathered, kMaxPads> gathered_{};
  NewestReports newest_;  // newest replaceable report of each device, in reports_
  std::array<std::atomic<bool>, kMaxPads> is_known_{};
};

// The rumble of a heel strike at this walking speed.
Rumble heel_beat(double speed_m_s) noexcept;

class LiveLoop {
 public:
  struct Options {
    int rate_hz = kDefaultRateHz;
    bool rumble = true;
    int frame_ticks = 1;  // number of ticks between two frames, as in SessionSpec::Live
    // Receives each tick for other programs; may be null.
    Latest<StreamedTick>* stream = nullptr;
    ForwardMail* forward = nullptr;
  };
  // All must outlive the loop; `recording` may be null.
  LiveLoop(const Options& options, const Script& script, Simulation& simulation, PadStream& pads,
           Recording* recording);

  // Use either run(), which runs ticks by the clock on the calling thread until stop(); or, without
  // a clock, begin() and then advance() at any time.
  void run() noexcept;
  void begin() noexcept;
  void advance(int ticks) noexcept;
  void stop() noexcept { is_stopping_.store(true, std::memory_order_relaxed); }

  // Call these from one thread, the viewing one; see LiveSession.
  const SessionFrame& latest(bool& is_new) noexcept;
  const SessionFrame& latest_due() noexcept;
  void end_frame(FrameEnd end) noexcept;
  bool take_sample(TickSample& sample) noexcept { return samples_.pop(sample); }
  bool take_report_time(ReportTime& time) noexcept;
  void set_pace(double pace) noexcept;
  void step(int ticks) noexcept;
  // Takes effect at the next tick, before its commands. Swaps `styles`, which must outlive the
  // loop.
  void set_styles(std::shared_ptr<const std::vector<Style>>& styles) noexcept {
    new_styles_.store(&styles, std::memory_order_release);
  }
  void beat_once() noexcept { wants_beat_.store(true, std::memory_order_relaxed); }
  // Ends the recording before the next tick. Then recorded_ticks() is the number of ticks that it
  // holds; -1 before that.
  void leave_recording() noexcept { leaves_recording_.store(true, std::memory_order_release); }
  std::int64_t recorded_ticks() const noexcept {
    return recorded_ticks_.load(std::memory_order_acquire);
  }
  // Call these from any thread.
  bool has_ended() const noexcept { return has_ended_.load(std::memory_order_relaxed); }
  bool is_known(std::uint16_t device) const noexcept { return reports_.is_known(device); }
  // Fills the fields of LiveStatus that the loop itself knows.
  LiveStatus status() const noexcept;

 private:
  bool wait_for_tick() noexcept;
  void read_pace_and_steps() noexcept;
  void drop_recording() noexcept;
  std::int64_t due_ns() const noexcept;
  void show_new_reports(std::int64_t now_ns) noexcept;
  void note_lateness(std::int64_t now_ns) noexcept;
  void run_tick(std::int64_t now_ns, std::int64_t shown_ns) noexcept;
  void follow_script(std::int64_t now_ns) noexcept;
  void use(std::span<const Report> reports, std::int64_t now_ns) noexcept;
  void publish(std::int64_t shown_ns) noexcept;
  void sample(std::int64_t took_ns) noexcept;
  void beat() noexcept;
  void look_for_the_end(bool has_reports) noexcept;

  Options options_;
  const Script& script_;
  std::size_t next_event_ = 0;  // index of the script's next event
  Simulation& simulation_;
  PadStream& pads_;
  Recording* recording_;
  TickClock clock_;
  TickReports reports_;
  std::int64_t tick_ = 0;        // number of the next tick
  std::int64_t steps_left_ = 0;  // ticks to run at pace 0
  std::int64_t last_begin_ns_ = 0;
  std::int64_t shown_ns_ = 0;  // SessionFrame::time_ns of the last tick
  // Time of the last change of pace; waits that began earlier are not measured.
  std::int64_t real_time_ns_ = 0;
  std::int64_t ticks_behind_end_ = 0;
  Latest<SessionFrame> frames_;
  TickSample sample_;
  SpscRing<TickSample> samples_;

  // Reports that a tick has used and no frame has shown yet.
  struct UsedReport {
    ReportTime time;
    // False: the session was not at real-time pace all the way from the report's arrival to this
    // tick.
    bool is_real_time = false;
  };
  SpscRing<UsedReport> used_;
  // Tick and time of the last frame read; viewing thread only.
  std::int64_t viewed_tick_ = -1, viewed_ns_ = 0;

  std::atomic<bool> is_stopping_{false}, has_ended_{false};
  std::atomic<double> wanted_pace_{1.0};
  std::atomic<std::int64_t> wanted_steps_{0};
  std::atomic<std::shared_ptr<const std::vector<Style>>*> new_styles_{nullptr};
  std::atomic<bool> wants_beat_{false};
  std::atomic<bool> leaves_recording_{false};
  std::atomic<std::int64_t> recorded_ticks_{-1};
  std::atomic<std::int64_t> start_ns_{0}, end_ns_{0};  // begin and end of run(); 0: not yet
  std::atomic<std::int64_t> ticks_{0}, overruns_{0}, standstills_{0}, overloads_{0}, skipped_ns_{0};
  TimeHistogram tick_times_, wait_times_, late_times_, frame_times_;
};

}  // namespace gaitpad
