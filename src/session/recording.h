// The lines of a recording: what was used by which tick, as a trace that replays to the same poses.
#pragma once
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/spsc_ring.h"
#include "drivers/posix.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// Tells of a device once a report of it has come.
using RecordedDevices = std::function<const TraceDevice&(std::uint16_t device)>;

// Keeps within what the reader takes: times that do not go back, no gap of ten minutes (a command
// `mark`, which does nothing, stands in a longer one), an end that is late enough for its ticks
// (they may have run faster than the time), and one before the file is too large.
class RecordingLines {
 public:
  struct Limits {  // with room for what one tick and the devices' lines may add
    std::size_t bytes = kMaxTraceBytes - (std::size_t{4} << 20);
    std::size_t events = kMaxTraceEvents - 8192;
  };
  // Without a rate there are no ticks: times alone count.
  RecordingLines(std::optional<int> rate_hz, RecordedDevices devices, const Limits& limits);

  // `tick` began at `time_ns` and the next ones follow at the rate times the pace: of tick 0, where
  // the clock was set forward, and where the pace is another from then on (0: it is still to come).
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0);
  // False: it has no place in the recording.
  bool add(std::int64_t tick, const Report& report);
  void end(std::int64_t ticks, std::int64_t time_ns);
  std::string take_text();  // whole lines, since the last call
  std::size_t text_size() const { return writer_.text().size(); }

  // No more is taken: a larger file could not be read.
  bool is_full() const { return is_full_; }
  bool has_devices() const { return has_devices_; }
  double duration_s() const { return static_cast<double>(latest_us_) * 1e-6; }

 private:
  struct Stream {
    bool is_described = false;
    std::int64_t latest_us = 0;
  };
  bool is_over(std::int64_t tick);
  void begin_time(std::int64_t time_ns);
  bool describe(std::uint16_t device);
  void bridge(std::int64_t tick, std::int64_t time_us);
  void event(std::int64_t tick, std::int64_t time_us, const Report& report);
  void mark(std::int64_t tick, std::int64_t time_us);

  std::optional<int> rate_hz_;
  RecordedDevices devices_;
  Limits limits_;
  TraceWriter writer_;
  std::array<Stream, kMaxTraceDevices + 1> streams_;  // one a device, commands last
  std::optional<std::int64_t> start_ns_;              // of tick 0
  std::optional<std::int64_t> zero_ns_;               // time 0 of the file
  std::int64_t tick_ = 0;                             // of the last event
  std::int64_t latest_us_ = 0;
  std::int64_t end_tick_ = 0;  // is_full(): the first that has no place
  std::size_t bytes_ = 0, events_ = 0;
  bool is_full_ = false, has_devices_ = false;
};

// Records a session, or pads alone, into a trace while it runs, on a thread of its own.

// Written to FILE.part, which takes FILE's name at the end; what stood there before is kept until
// then. A program that is killed leaves FILE.part behind: it replays as far as it goes.
class Recording {
 public:
  struct Options {
    std::string path;
    std::optional<int> rate_hz;  // of the ticks; none: there is no loop, times alone count
    RecordingLines::Limits limits;
  };
  // `devices` is called on the recording's thread, for devices of reports that were given to add().
  static Result<std::unique_ptr<Recording>> start(const Options& options, RecordedDevices devices);
  ~Recording();

  // All from one thread, wait-free: `tick` used the report; it began at that time and the next ones
  // follow at the rate times the pace (0: they stand still).
  void add(std::int64_t tick, const Report& report) noexcept;
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0) noexcept;

  // Reports that are missing: found no room here or in the file. It is then no exact recording.
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  // One sentence once the file could not be written; what stands in it replays. Any thread.
  std::optional<Error> problem() const;
  // Ends with so many ticks run; sentences that a user should know. Once.
  Result<std::vector<std::string>> finish(std::int64_t ticks, std::int64_t time_ns);

 private:
  struct Item {
    std::int64_t tick = 0;
    std::int64_t clock_ns = kNoClock;  // else there is no report
    double pace = 1.0;
    Report report;
  };
  static constexpr std::int64_t kNoClock = -1;

  Recording(const Options& options, RecordedDevices devices, OwnedFd file);
  void run();
  void take_all();
  void write(std::string_view text);
  void end_thread();
  std::vector<std::string> remarks() const;

  std::string path_, part_;
  OwnedFd file_;
  std::int64_t written_ = 0;     // bytes, whole lines
  std::atomic<int> problem_{0};  // errno of the first write that failed
  RecordingLines lines_;
  SpscRing<Item> ring_;
  std::atomic<std::int64_t> lost_{0};
  std::mutex mutex_;
  std::condition_variable ending_;
  bool is_ending_ = false;
  std::thread thread_;
};

}  // namespace gaitpad
