// Recordings (`.hid`): the text format of hid-recorder with further lines (config/README.md,
// Traces). Files of hid-recorder are read, and hid-replay plays the files written here. Set-up
// code: it allocates; copy_report() and report_of() are for the loop.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/motion.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr int kDefaultRateHz = 240;
inline constexpr int kLeastRateHz = 10;  // at fewer ticks a second a walk is too coarse to be
                                         // useful
inline constexpr int kMaxRateHz = 10000;
inline constexpr int kTraceVersion = 2;  // PadRules names the changes of each version
inline constexpr std::size_t kMaxTraceDevices = 16;
inline constexpr std::size_t kMaxTraceBytes = std::size_t{512} << 20;  // most bytes of a file
inline constexpr std::size_t kMaxTraceEvents = std::size_t{1} << 24;
// Most bytes of a name, a path, an id or a mapping.
inline constexpr std::size_t kMaxTraceTextBytes = 512;
inline constexpr std::int64_t kMaxTraceGapUs = 600'000'000;
inline constexpr std::int64_t kMaxTraceDurationUs = 1'000'000'000'000;

// Times are in microseconds of the recording's own clock.

// read_trace() fills these structs, or a program that records by other means.

struct TraceDevice {
  int index = 0;  // number in its `D:` line
  DeviceInfo info;
  std::string calibration;  // TOML text of its `K:` lines; empty: none
  bool operator==(const TraceDevice&) const = default;
};

// A report, a command, plugging in or unplugging. Its bytes are in Trace::bytes.
struct TraceEvent {
  std::int64_t time_us = 0;  // time since an arbitrary moment, as in the file
  std::int64_t tick = 0;     // the tick that uses it: from a `T:` line, else by assign_ticks()
  std::uint32_t first_byte = 0;
  std::uint16_t size = 0;
  std::uint16_t device = kNoDevice;  // index in Trace::devices
  ReportKind kind = ReportKind::input;
  bool operator==(const TraceEvent&) const = default;
};

// A file that a session was made of, as its recording contains it.
struct TraceFile {
  std::string name;        // name with the folders by which other files refer to it
  std::string bytes;       // content; of a text: its lines, each with a line feed
  std::int64_t tick = -1;  // first tick in which it is used; -1: from the start
  bool operator==(const TraceFile&) const = default;
};

struct Trace {
  std::string path;  // error sentences begin with it
  // Number in the `V:` line; a file without one replays by today's rules.
  int version = kTraceVersion;
  std::optional<int> rate_hz;        // rate in the `V:` line
  std::optional<Pace> pace;          // pace in the `O: pace` line
  std::vector<std::string> options;  // the texts of the other `O:` lines
  std::vector<TraceFile> files;      // in the order of their `F:` lines
  bool has_ticks = false;            // the file has `T:` lines, so TraceEvent::tick is set
  std::vector<TraceDevice> devices;
  std::vector<TraceEvent> events;  // in the order of the file; ticks never decrease
  std::vector<std::uint8_t> bytes;
  std::optional<std::int64_t> end_time_us;  // time in the `Q:` line
  std::optional<std::int64_t> end_ticks;
  std::int64_t skipped_lines = 0;  // number of damaged lines; Damage::skip only
  std::string first_damage;        // the sentence about the first of them
};

// Errors read `walk.hid: events[3].device is 7, but there are 2 devices`. Checks that the rate is
// valid, and that devices, bytes, ticks and times of events exist and are in order.
std::optional<Error> check(const Trace& trace);

// The answer to a damaged line: refuse the whole file, or skip the line and count it.
enum class Damage { refuse, skip };

// Reads a file. Errors: `walk.hid:12: the report length says 64 but 63 bytes follow`.
Result<Trace> read_trace(const std::string& path, Damage damage = Damage::refuse);
// Reads a file's text from memory; `name` replaces the path in errors.
Result<Trace> parse_trace(std::string_view text, const std::string& name,
                          Damage damage = Damage::refuse);
// `3 damaged lines were skipped, the first: ...`; nothing if there were none.
std::optional<std::string> damage_remark(const Trace& trace);

// Gives every event its tick and returns the number n of ticks of a replay: ticks 0 .. n-1. Without
// `T:` lines an event belongs to the first tick that starts at or after its time; tick k starts
// k / rate_hz seconds after the first event, compared in whole numbers. The end is that of the `Q:`
// line, else one second after the last event; events of tick n and later are not used. Error if the
// trace states another rate.
Result<std::int64_t> assign_ticks(Trace& trace, int rate_hz);
// The rate to replay at: `asked`, else the trace's, else kDefaultRateHz.
int replay_rate_hz(const Trace& trace, std::optional<int> asked);
// The pace to replay at: `asked`, else the trace's. A session that was recorded before it said its
// pace, which shows by its `T:` lines, had the adult's. Nothing: the motion's.
std::optional<Pace> replay_pace(const Trace& trace, std::optional<Pace> asked);

// Copies the event as a driver would have delivered it. check() must accept `trace`.
void copy_report(const Trace& trace, const TraceEvent& event, Report& report) noexcept;
Report report_of(const Trace& trace, const TraceEvent& event) noexcept;

// Writes a trace line by line in the order of the calls.
class TraceWriter {
 public:
  // Writes the `V:` line, before anything else.
  void begin(int rate_hz, int version = kTraceVersion);
  void pace(Pace pace);                // Writes `O: pace`, before any event.
  void option(std::string_view text);  // Writes an `O:` line.
  // Writes an `F:` line and the file's lines.
  void file(std::string_view name, std::string_view bytes);
  void comment(std::string_view sentence);
  // The lines that describe the device; texts are cut to the reader's limits. The only device of a
  // recording needs no `D:` line if its index is 0.
  enum class Index { written, left_out };
  void device(const TraceDevice& device, Index index);
  void tick(std::int64_t tick);  // Writes a `T:` line if the tick differs from the last one.
  // Writes an event. `index`: of a device that was written before; none for a command.
  void event(ReportKind kind, std::int64_t time_us, std::optional<int> index,
             std::span<const std::uint8_t> bytes);
  void end(std::int64_t time_us, std::int64_t ticks);  // Writes the `Q:` line.

  // Whole lines that were written since the last take_text().
  const std::string& text() const { return text_; }
  std::string take_text();

 private:
  std::string text_;
  std::optional<std::int64_t> tick_;
  std::optional<int> current_;  // device of the last `D:` line
};

// The text of a trace: parse_trace() reads the same devices and events from it, and hid-replay
// plays it. `trace` is one that check() accepts; write_trace() calls it. It has `T:` lines if
// has_ticks is set, `V:` if rate_hz is, `Q:` if both ends are.
std::string trace_text(const Trace& trace);
// Returns the number of bytes written.
Result<std::int64_t> write_trace(const Trace& trace, const std::string& path);

}  // namespace gaitpad
