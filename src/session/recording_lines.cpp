#include "session/recording_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "hid/descriptor.h"
#include "session/tick_clock.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kBridge_us = kMaxTraceGapUs / 2;
constexpr std::size_t kCommands = kMaxTraceDevices;  // index in streams_

std::string seconds(std::int64_t time_ns) {
  return fmt::format("{}.{:09}", time_ns / kSecond_ns, time_ns % kSecond_ns);
}

// The reader wants words in a command.
bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

}  // namespace

RecordingLines::RecordingLines(std::optional<int> rate_hz, RecordedDevices devices,
                               const Limits& limits)
    : rate_hz_(rate_hz), devices_(std::move(devices)), limits_(limits) {
  if (rate_hz_) writer_.begin(*rate_hz_);
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
  if (is_over(tick)) return false;
  const bool is_command = report.kind == ReportKind::command;
  if (is_command && is_blank(text_of(report))) return true;
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

// A tick is recorded whole or not at all.
bool RecordingLines::is_over(std::int64_t tick) {
  if (is_full_ || (rate_hz_ && events_ > 0 && tick == tick_)) return is_full_;
  if (bytes_ + text_size() < limits_.bytes && events_ < limits_.events) return false;
  is_full_ = true;
  end_tick_ = tick;
  return true;
}

// Time 0 is the first event's; where that comes late, the first tick's, which is marked then.
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
  const bool may_be_alone = device == 0 && !has_devices_;
  writer_.device(described,
                 may_be_alone ? TraceWriter::Index::left_out : TraceWriter::Index::written);
  streams_[device].is_described = has_devices_ = true;
  return true;
}

// Marks in a gap that would be too long, each half of the longest away from the one before.
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

}  // namespace gaitpad
