// The recording of a session, or of pads alone, into a trace that replays to the same poses: which
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
#include "drivers/posix.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/style.h"
#include "gaitpad/trace.h"

namespace gaitpad {

// What is known of a device whose first report has come.
using RecordedDevices = std::function<const TraceDevice&(std::uint16_t device)>;

// Copies a report without the bytes that it does not use, stamped no later than `latest_ns`.
inline void copy_used_bytes(const Report& from, std::int64_t latest_ns, Report& to) noexcept {
  to.time_ns = std::min(from.time_ns, latest_ns);
  to.device = from.device;
  to.kind = from.kind;
  to.size = std::min<std::uint16_t>(from.size, kMaxReportBytes);
  std::memcpy(to.bytes.data(), from.bytes.data(), to.size);
}

// What a session is made of, so that its recording replays wherever it is.
struct RecordedSession {
  std::optional<Pace> pace;
  std::vector<std::string> options;  // as Trace::options
  std::vector<TraceFile> files;
  // That of `config/pads` which has an entry for the pad; null: none. May be empty.
  std::function<const TraceFile*(const DeviceInfo&)> pad_file;
};

// The lines of a recording. They stay within what the reader of traces accepts: times never go
// back; a gap of ten minutes or more holds commands `mark`, which do nothing; the end is late
// enough for its ticks, which may have run faster than the clock; and it ends before the file is
// too large.
class RecordingLines {
 public:
  struct Limits {  // with room for one more tick and for the devices' lines
    std::size_t bytes = kMaxTraceBytes - (std::size_t{4} << 20);
    std::size_t events = kMaxTraceEvents - 8192;
  };
  // Without a rate there are no ticks, only times.
  RecordingLines(std::optional<int> rate_hz, RecordedDevices devices, const Limits& limits,
                 RecordedSession session = {});

  // `tick` began at `time_ns`, and the next ones follow at the rate times the pace; at pace 0 it
  // has not begun yet. For tick 0, and whenever the clock was set forward or the pace has changed.
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0);
  // False: the recording cannot hold it.
  bool add(std::int64_t tick, const Report& report);
  // From `tick` on, before its reports, a style of this name has these values. Only with a rate.
  void style(std::int64_t tick, const Style& style);
  void end(std::int64_t ticks, std::int64_t time_ns);
  std::string take_text();  // whole lines, since the last call
  std::size_t text_size() const { return writer_.text().size(); }

  // Nothing more is added: a larger file could not be read.
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
  RecordedSession session_;
  Limits limits_;
  TraceWriter writer_;
  std::array<Stream, kMaxTraceDevices + 1> streams_;  // one a device, commands last
  std::optional<std::int64_t> start_ns_;              // of tick 0
  std::optional<std::int64_t> zero_ns_;               // time 0 of the file
  std::int64_t tick_ = 0;                             // of the last event
  std::int64_t latest_us_ = 0;
  std::int64_t end_tick_ = 0;  // is_full(): the first tick that is left out
  std::size_t bytes_ = 0, events_ = 0;
  bool is_full_ = false, has_devices_ = false;
  std::set<std::string> pad_files_;  // that were written
};

// Writes a trace while the session runs, on a thread of its own. The file is FILE.part until the
// end, then it is renamed to FILE; an older FILE stays until then. A program that is killed leaves
// FILE.part, which replays as far as it goes.
class Recording {
 public:
  struct Options {
    std::string path;
    std::optional<int> rate_hz;  // of the ticks; none: there is no loop, only times
    RecordingLines::Limits limits;
    RecordedSession session{};
  };
  // `devices` is called on the recording's thread, for devices of reports given to add(). Error:
  // the file cannot be opened, or another session writes to it.
  static Result<std::unique_ptr<Recording>> start(const Options& options, RecordedDevices devices);
  ~Recording();

  // From one thread, wait-free: `tick` used the report; `tick` began at that time, and the next
  // ones follow at the rate times the pace (0: they stand still).
  void add(std::int64_t tick, const Report& report) noexcept;
  void clock(std::int64_t tick, std::int64_t time_ns, double pace = 1.0) noexcept;
  // From `tick` on the styles are others. Both lists outlive the recording.
  void styles(std::int64_t tick, const std::vector<Style>& before,
              const std::vector<Style>& after) noexcept;

  // Missing reports: there was no room for them in the ring or the file. The recording is inexact.
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }
  // Why the file cannot be written, once it could not; what stands in it replays. Any thread.
  std::optional<Error> problem() const;
  // Ends the recording after so many ticks and renames the file. Once. Sentences for the user.
  Result<std::vector<std::string>> finish(std::int64_t ticks, std::int64_t time_ns);

 private:
  struct Item {
    std::int64_t tick = 0;
    std::int64_t clock_ns = kNoClock;  // set: a clock() instead of a report
    double pace = 1.0;
    const std::vector<Style>*styles_before = nullptr, *styles = nullptr;  // set: a styles()
    Report report;
  };
  static constexpr std::int64_t kNoClock = -1;

  Recording(const Options& options, RecordedDevices devices, OwnedFd file);
  void run();
  void drain_ring();
  void write(std::string_view text);
  void end_thread();
  std::vector<std::string> remarks() const;

  std::string path_, part_;
  OwnedFd file_;
  std::int64_t written_ = 0;     // bytes of whole lines
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
