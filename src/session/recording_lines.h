// The lines of a recording: what was used by which tick, as a trace that replays to the same poses.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "hid/report.h"
#include "hid/trace.h"

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

}  // namespace gaitpad
