#include "session/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "gaitpad/config_files.h"
#include "gaitpad/descriptor.h"
#include "session/live_loop.h"
#include "system/clock.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kBridge_us = kMaxTraceGapUs / 2;
constexpr std::size_t kCommands = kMaxTraceDevices;  // index of the commands' stream in streams_

std::string seconds(std::int64_t time_ns) {
  return fmt::format("{}.{:09}", time_ns / kSecond_ns, time_ns % kSecond_ns);
}

}  // namespace

// --- the lines

RecordingLines::RecordingLines(std::optional<int> rate_hz, RecordedDevices devices,
                               const Limits& limits, RecordedSession session)
    : rate_hz_(rate_hz),
      devices_(std::move(devices)),
      session_(std::move(session)),
      limits_(limits) {
  if (rate_hz_) writer_.begin(*rate_hz_);
  if (session_.pace) writer_.pace(*session_.pace);
  for (const std::string& option : session_.options) writer_.option(option);
  for (const TraceFile& file : session_.files) writer_.file(file.name, file.bytes);
  session_.files.clear();
  writer_.comment(rate_hz_ ? "recorded by gaitpad: a session" : "recorded by gaitpad: pads alone");
}

void RecordingLines::clock(std::int64_t tick, std::int64_t time_ns, double pace) {
  if (!start_ns_) start_ns_ = time_ns;
  if (is_full_ || bytes_ + text_size() >= limits_.bytes) return;
  const std::string when = seconds(time_ns);
  if (pace == 0.0) {
    writer_.comment(
        fmt::format("before tick {} it stood still from CLOCK_MONOTONIC {}", tick, when));
  } else {
    const std::string how = pace == 1.0 ? "" : fmt::format(", pace {} from here", pace);
    writer_.comment(fmt::format("tick {} began at CLOCK_MONOTONIC {}{}", tick, when, how));
  }
}

bool RecordingLines::add(std::int64_t tick, const Report& report) {
  if (is_full_before(tick)) return false;
  const bool is_command = report.kind == ReportKind::command;
  // A blank command is left out.
  if (is_command && trimmed(text_of(report), " \t\r\n").empty()) return true;
  if (!is_command && !describe(report.device)) return false;
  begin_time(report.time_ns);
  const Stream& stream = streams_[is_command ? kCommands : report.device];
  const std::int64_t floor_us = rate_hz_ ? stream.latest_us : latest_us_;
  const std::int64_t time_us = std::max(floor_us, (report.time_ns - *zero_ns_) / 1000);
  if (time_us > kMaxTraceDurationUs) {
    is_full_ = true;
    end_tick_ = std::max(tick, tick_ + 1);
    return false;
  }
  bridge(tick, time_us);
  event(tick, time_us, report);
  return true;
}

void RecordingLines::style(std::int64_t tick, const Style& style) {
  if (is_full_before(tick)) return;
  bridge(tick, latest_us_);
  writer_.tick(tick);
  writer_.file("styles/" + style.name + ".toml", style_text(style));
}

// True if the recording is full before this tick: a tick is recorded completely or not at all.
bool RecordingLines::is_full_before(std::int64_t tick) {
  if (is_full_ || (rate_hz_ && events_ > 0 && tick == tick_)) return is_full_;
  if (bytes_ + text_size() < limits_.bytes && events_ < limits_.events) return false;
  is_full_ = true;
  end_tick_ = tick;
  return true;
}

// Time 0 is the first event. If that comes late, time 0 is tick 0, where a `mark` is written.
void RecordingLines::begin_time(std::int64_t time_ns) {
  if (zero_ns_) return;
  const bool is_late = start_ns_ && time_ns - *start_ns_ > kBridge_us * 1000;
  zero_ns_ = is_late ? *start_ns_ : time_ns;
  writer_.comment("time 0 is CLOCK_MONOTONIC " + seconds(*zero_ns_));
  if (is_late) mark(0, 0);
}

bool RecordingLines::describe(std::uint16_t device) {
  if (device >= kMaxTraceDevices) return false;
  if (streams_[device].is_described) return true;
  TraceDevice described = devices_(device);
  const std::vector<std::uint8_t>& descriptor = described.info.descriptor;
  if (descriptor.empty() || descriptor.size() > kMaxDescriptorBytes) return false;
  described.index = device;
  const TraceFile* map = session_.pad_file ? session_.pad_file(described.info) : nullptr;
  if (map != nullptr && pad_files_.insert(map->name).second) writer_.file(map->name, map->bytes);
  const bool may_be_alone = device == 0 && !has_devices_;
  writer_.device(described,
                 may_be_alone ? TraceWriter::Index::left_out : TraceWriter::Index::written);
  streams_[device].is_described = has_devices_ = true;
  return true;
}

// Fills a gap that is too long with marks, half the longest permitted gap apart.
void RecordingLines::bridge(std::int64_t tick, std::int64_t time_us) {
  const std::int64_t from_us = latest_us_, from_tick = tick_;
  std::int64_t pieces = 1 + (time_us - from_us) / kBridge_us;
  if (rate_hz_) {
    const std::int64_t longest = *rate_hz_ * (kBridge_us / 1'000'000);
    pieces = std::max(pieces, 1 + (tick - from_tick) / longest);
  }
  for (std::int64_t i = 1; i < pieces; ++i) {
    mark(from_tick + (tick - from_tick) / pieces * i, from_us + (time_us - from_us) / pieces * i);
  }
}

void RecordingLines::mark(std::int64_t tick, std::int64_t time_us) {
  constexpr std::string_view kText = "mark";
  Report report;
  report.kind = ReportKind::command;
  report.size = static_cast<std::uint16_t>(kText.size());
  std::copy(kText.begin(), kText.end(), report.bytes.begin());
  event(tick, std::max(time_us, streams_[kCommands].latest_us), report);
}

void RecordingLines::event(std::int64_t tick, std::int64_t time_us, const Report& report) {
  const bool is_command = report.kind == ReportKind::command;
  if (rate_hz_) writer_.tick(tick);
  std::optional<int> index;
  if (!is_command) index = report.device;
  writer_.event(report.kind, time_us, index, {report.bytes.data(), report.size});
  streams_[is_command ? kCommands : report.device].latest_us = time_us;
  latest_us_ = std::max(latest_us_, time_us);
  tick_ = tick;
  ++events_;
}

void RecordingLines::end(std::int64_t ticks, std::int64_t time_ns) {
  if (!rate_hz_) return;
  begin_time(time_ns);
  const std::int64_t last = is_full_ ? end_tick_ : ticks;
  std::int64_t time_us = latest_us_;
  if (!is_full_) time_us = std::max(time_us, (time_ns - *zero_ns_) / 1000);
  time_us = std::max(time_us, last * 1'000'000 / *rate_hz_ - kMaxTraceGapUs);
  if (time_us <= kMaxTraceDurationUs) bridge(std::max(tick_, last - 1), time_us);
  writer_.end(time_us, std::max(last, events_ > 0 ? tick_ + 1 : 0));
}

std::string RecordingLines::take_text() {
  std::string text = writer_.take_text();
  bytes_ += text.size();
  return text;
}

// --- the file and its thread

namespace {

bool is_same(const Style& a, const Style& b) {
  return a.name == b.name && static_cast<const StyleValues&>(a) == b;
}

constexpr std::size_t kRingItems = 4096;
constexpr std::chrono::milliseconds kPause{20};  // pause between two looks at the ring
constexpr std::size_t kWriteBytes = std::size_t{1} << 18;

}  // namespace

Result<std::unique_ptr<Recording>> Recording::start(const Options& options,
                                                    RecordedDevices devices) {
  std::error_code ignored;
  const fs::file_status status = fs::status(options.path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return Error{options.path + ": not a regular file; choose another name"};
  }
  std::unique_ptr<Recording> recording(new Recording(options, std::move(devices)));
  const std::string& part = recording->part_;
  const int problem = recording->file_.create(part);
  if (problem == EWOULDBLOCK) return Error{part + ": another session is recording into it"};
  if (problem != 0) return write_error(part, problem);
  recording->thread_ = std::thread([r = recording.get()] { r->run(); });
  return recording;
}

Recording::Recording(const Options& options, RecordedDevices devices)
    : path_(options.path),
      part_(options.path + ".part"),
      lines_(options.rate_hz, std::move(devices), options.limits, options.session),
      ring_(kRingItems) {}

Recording::~Recording() { end_thread(); }

void Recording::add(std::int64_t tick, const Report& report) noexcept {
  Item item;
  item.tick = tick;
  // Not later than now: a time far ahead would end the recording.
  copy_used_bytes(report, now_ns(), item.report);
  if (!ring_.push(item)) lost_.fetch_add(1, std::memory_order_relaxed);
}

// Writes a comment for readers; the recording is exact without it.
void Recording::clock(std::int64_t tick, std::int64_t time_ns, double pace) noexcept {
  Item item;
  item.tick = tick;
  item.clock_ns = time_ns;
  item.pace = pace;
  static_cast<void>(ring_.push(item));
}

void Recording::styles(std::int64_t tick, const std::vector<Style>& before,
                       const std::vector<Style>& after) noexcept {
  Item item;
  item.tick = tick;
  item.styles_before = &before;
  item.styles = &after;
  if (!ring_.push(item)) lost_.fetch_add(1, std::memory_order_relaxed);
}

void Recording::run() {
  bool is_last = false;
  while (!is_last) {
    {
      std::unique_lock lock(mutex_);
      is_last = ending_.wait_for(lock, kPause, [this] { return is_ending_; });
    }
    drain_ring();
    write(lines_.take_text());
  }
}

void Recording::drain_ring() {
  while (const Item* item = ring_.front()) {
    if (item->clock_ns != kNoClock) {
      lines_.clock(item->tick, item->clock_ns, item->pace);
    } else if (item->styles != nullptr) {
      for (std::size_t i = 0; i < item->styles->size(); ++i) {
        const Style& style = (*item->styles)[i];
        if (i >= item->styles_before->size() || !is_same(style, (*item->styles_before)[i]))
          lines_.style(item->tick, style);
      }
    } else if (problem_ != 0 || !lines_.add(item->tick, item->report)) {
      lost_.fetch_add(1, std::memory_order_relaxed);
    }
    ring_.pop();
    if (lines_.text_size() >= kWriteBytes) write(lines_.take_text());
  }
}

// Half a line would damage the trace. If the file still ends with one, `replay --lenient` skips it.
void Recording::write(std::string_view text) {
  if (problem_ == 0) problem_ = file_.append(text);
}

void Recording::end_thread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ending_.notify_one();
  thread_.join();
}

Result<std::vector<std::string>> Recording::finish(std::int64_t ticks, std::int64_t time_ns) {
  end_thread();
  lines_.end(ticks, time_ns);
  write(lines_.take_text());
  if (auto failed = problem()) return *failed;
  if (!lines_.has_devices()) {
    std::error_code ignored;
    fs::remove(part_, ignored);
    return Error{path_ + ": nothing was recorded: there was no pad"};
  }
  if (std::rename(part_.c_str(), path_.c_str()) != 0) return write_error(path_, errno);
  return remarks();
}

std::optional<Error> Recording::problem() const {
  if (problem_ == 0) return std::nullopt;
  return write_error(part_, problem_);
}

std::vector<std::string> Recording::remarks() const {
  std::vector<std::string> remarks;
  if (lines_.is_full()) {
    remarks.push_back(fmt::format("{}: ends after {:.0f} s: a longer recording could not be read",
                                  path_, lines_.duration_s()));
  } else if (lost() > 0) {
    remarks.push_back(fmt::format(
        "{}: {} reports are missing, so it will not replay to the same poses", path_, lost()));
  }
  return remarks;
}

}  // namespace gaitpad
