// Records a session, or pads alone, into a trace that replays to the same poses: it stores which
// tick used which report.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/spsc_ring.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/style.h"
#include "gaitpad/trace.h"
#include "system/growing_file.h"

namespace gaitpad {

// Returns the description of a device that has sent a report.
using RecordedDevices = std::function<const TraceDevice&(std::uint16_t device)>;

// Copies a report's used bytes only and clamps its time to `latest_ns`.
inline void copy_used_bytes(const Report& from, std::int64_t latest_ns, Report& to) noexcept {
  to.time_ns = std::min(from.time_ns, latest_ns);
  to.device = from.device;
  to.kind = from.kind;
  to.size = std::min<std::uint16_t>(from.size, kMaxReportBytes);
  std::memcpy(to.bytes.data(), from.bytes.data(), to.size);
}

// Everything that a session is made of, so that its recording replays on any machine.
struct RecordedSession {
  std::optional<Pace> pace;
  std::vector<std::string> options;  // texts of `O:` lines, as in Trace::options
  std::vector<TraceFile> files;
  // The file of `config/pads` with an entry for the pad; null if no file has one. May be empty.
  std::function<const TraceFile*(const DeviceInfo&)> pad_file;
};

// The lines of a recording, within the limits of the reader of traces: times never decrease; a gap
// of ten minutes or more holds `mark` commands, which do nothing; the end time is late enough for
// all ticks, which may have run faster than the clock; and the recording ends before the file is
// too large.
class RecordingLines {
 public:
  struct Limits {  // leave room for one more tick and for the devices' lines
    std::size_t bytes = kMaxTraceBytes - (std::size_t{4} << 20);
    std::size_t events = kMaxTraceEvents - 8192;
  };
  // Without a rate events have times only, no ticks.
  RecordingLines(std::optional<int> rate_hz, RecordedDevices devices, const Limits& limits,
                 RecordedSession session = {});

  // Says that `tick` began at `time_ns`, and that the next ones follow at rate * pace; at pace 0 it
  // has not begun yet. Called for tick 0 and after each change of the clock or the pace.
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0);
  // Returns false if the recording is full.
  bool add(std::int64_t tick, const Report& report);
  // Sets the style's values from `tick` on, before its reports. Only with a rate.
  void style(std::int64_t tick, const Style& style);
  void end(std::int64_t ticks, std::int64_t time_ns);
  std::string take_text();  // The whole lines that were made since the last call.
  std::size_t text_size() const { return writer_.text().size(); }

  // Full: adding more would make the file too large to read.
  bool is_full() const { return is_full_; }
  bool has_devices() const { return has_devices_; }
  double duration_s() const { return static_cast<double>(latest_us_) * 1e-6; }

 private:
  struct Stream {
    bool is_described = false;
    std::int64_t latest_us = 0;
  };
  bool is_full_before(std::int64_t tick);
  void begin_time(std::int64_t time_ns);
  bool describe(std::uint16_t device);
  void bridge(std::int64_t tick, std::int64_t time_us);
  void event(std::int64_t tick, std::int64_t time_us, const Report& report);
  void mark(std::int64_t tick, std::int64_t time_us);

  std::optional<int> rate_hz_;
  RecordedDevices devices_;
  RecordedSession session_;
  Limits limits_;
  TraceWriter writer_;
  // One stream for each device; that of commands is the last.
  std::array<Stream, kMaxTraceDevices + 1> streams_;
  std::optional<std::int64_t> start_ns_;  // time of tick 0
  std::optional<std::int64_t> zero_ns_;   // time that is 0 in the file
  std::int64_t tick_ = 0;                 // tick of the last event
  std::int64_t latest_us_ = 0;
  std::int64_t end_tick_ = 0;  // is_full(): the first tick that is not recorded
  std::size_t bytes_ = 0, events_ = 0;
  bool is_full_ = false, has_devices_ = false;
  std::set<std::string> pad_files_;  // pad files that were written already
};

// Writes a trace on a thread of its own while the session runs. The file is named FILE.part until
// the end and then renamed to FILE, which replaces an older FILE. If the program is killed,
// FILE.part stays and replays to its last whole line.
class Recording {
 public:
  struct Options {
    std::string path;
    std::optional<int> rate_hz;  // rate of the ticks; none: there is no loop, only times
    RecordingLines::Limits limits;
    RecordedSession session{};
  };
  // `devices` is called on the recording's thread, for devices of reports given to add(). Error:
  // the file cannot be opened, or another session writes to it.
  static Result<std::unique_ptr<Recording>> start(const Options& options, RecordedDevices devices);
  ~Recording();

  // Both functions are called from one thread and never wait. add(): `tick` used the report.
  // clock(): `tick` began at `time_ns`, and the next ones follow at rate * pace (0: they stand
  // still).
  void add(std::int64_t tick, const Report& report) noexcept;
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0) noexcept;
  // Changes the styles from `tick` on. Both lists must outlive the recording.
  void styles(std::int64_t tick, const std::vector<Style>& before,
              const std::vector<Style>& after) noexcept;

  // Number of reports that did not fit into the ring or the file. If > 0 the recording is inexact.
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  // The error of the first failed write; all lines written before it replay. Any thread.
  std::optional<Error> problem() const;
  // Ends the recording after `ticks` ticks and renames the file. Call it once. Returns sentences
  // for the user.
  Result<std::vector<std::string>> finish(std::int64_t ticks, std::int64_t time_ns);

 private:
  struct Item {
    std::int64_t tick = 0;
    // Set: the item is the argument of a call of clock(), not a report.
    std::int64_t clock_ns = kNoClock;
    double pace = 1.0;
    // Set: the item holds the arguments of a call of styles().
    const std::vector<Style>*styles_before = nullptr, *styles = nullptr;
    Report report;
  };
  static constexpr std::int64_t kNoClock = -1;

  Recording(const Options& options, RecordedDevices devices);
  void run();
  void drain_ring();
  void write(std::string_view text);
  void end_thread();
  std::vector<std::string> remarks() const;

  std::string path_, part_;
  GrowingFile file_;
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
