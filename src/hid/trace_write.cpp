#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <utility>

#include "hid/trace.h"

namespace gaitpad {

namespace {

// A line break inside a name would begin a line of the trace.
std::string one_line(std::string_view text, std::size_t max_bytes = kMaxTraceTextBytes) {
  std::string line(text.substr(0, max_bytes));
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return line;
}

void append_bytes(std::string& out, const std::uint8_t* bytes, std::size_t count) {
  constexpr char kDigits[] = "0123456789abcdef";
  fmt::format_to(std::back_inserter(out), "{}", count);
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(' ');
    out.push_back(kDigits[bytes[i] >> 4]);
    out.push_back(kDigits[bytes[i] & 15]);
  }
  out.push_back('\n');
}

std::string time_text(std::int64_t time_us) {
  return fmt::format("{:06}.{:06}", time_us / 1'000'000, time_us % 1'000'000);
}

void append_calibration(std::string& out, std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    fmt::format_to(std::back_inserter(out), "K: {}\n", text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
}

void append_device(std::string& out, const TraceDevice& device) {
  const DeviceInfo& info = device.info;
  out += "R: ";
  append_bytes(out, info.descriptor.data(), info.descriptor.size());
  fmt::format_to(std::back_inserter(out), "N: {}\n", one_line(info.name));
  if (!info.physical_path.empty()) out += "P: " + one_line(info.physical_path) + "\n";
  fmt::format_to(std::back_inserter(out), "I: {:x} {:04x} {:04x}\n",
                 static_cast<unsigned>(info.bus), info.vendor, info.product);
  if (!info.unique_id.empty()) out += "U: " + one_line(info.unique_id) + "\n";
  if (!info.driver.empty()) {
    fmt::format_to(std::back_inserter(out), "B: {} {:04x}\n", one_line(info.driver), info.version);
  }
  if (!info.mapping.empty()) out += "M: " + one_line(info.mapping) + "\n";
  append_calibration(out, device.calibration);
}

}  // namespace

void TraceWriter::begin(int rate_hz) { text_ += fmt::format("V: 1 rate_hz={}\n", rate_hz); }

void TraceWriter::comment(std::string_view sentence) {
  text_ += "# " + one_line(sentence, sentence.size()) + "\n";
}

void TraceWriter::device(const TraceDevice& device, Index index) {
  if (index == Index::written) text_ += fmt::format("D: {}\n", device.index);
  append_device(text_, device);
  current_ = device.index;
}

void TraceWriter::tick(std::int64_t tick) {
  if (tick_ == tick) return;
  text_ += fmt::format("T: {}\n", tick);
  tick_ = tick;
}

void TraceWriter::event(ReportKind kind, std::int64_t time_us, std::optional<int> index,
                        std::span<const std::uint8_t> bytes) {
  if (index && index != current_) {
    text_ += fmt::format("D: {}\n", *index);
    current_ = index;
  }
  const std::string time = time_text(time_us);
  switch (kind) {
    case ReportKind::input:
      text_ += "E: " + time + " ";
      append_bytes(text_, bytes.data(), bytes.size());
      return;
    case ReportKind::command:
      text_ += "C: " + time + " " +
               one_line({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, bytes.size()) +
               "\n";
      return;
    case ReportKind::added:
      text_ += "H: " + time + " add\n";
      return;
    case ReportKind::removed:
      text_ += "H: " + time + " remove\n";
      return;
  }
}

void TraceWriter::end(std::int64_t time_us, std::int64_t ticks) {
  text_ += fmt::format("Q: {} {}\n", time_text(time_us), ticks);
}

std::string TraceWriter::take_text() { return std::exchange(text_, {}); }

std::string trace_text(const Trace& trace) {
  TraceWriter writer;
  if (trace.rate_hz) writer.begin(*trace.rate_hz);
  const bool plain = trace.devices.size() == 1 && trace.devices.front().index == 0;
  for (const TraceDevice& device : trace.devices) {
    writer.device(device, plain ? TraceWriter::Index::left_out : TraceWriter::Index::written);
  }
  for (const TraceEvent& event : trace.events) {
    if (trace.has_ticks) writer.tick(event.tick);
    std::optional<int> index;
    if (event.device != kNoDevice) index = trace.devices[event.device].index;
    writer.event(event.kind, event.time_us, index,
                 {trace.bytes.data() + event.first_byte, event.size});
  }
  if (trace.end_time_us && trace.end_ticks) writer.end(*trace.end_time_us, *trace.end_ticks);
  return writer.take_text();
}

Result<std::int64_t> write_trace(const Trace& trace, const std::string& path) {
  const std::string text = trace_text(trace);
  std::ofstream out(path, std::ios::binary);
  if (!out) return Error{path + ": cannot be opened for writing"};
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) return Error{path + ": writing failed"};
  return static_cast<std::int64_t>(text.size());
}

Result<std::int64_t> assign_ticks(Trace& trace, int rate_hz) {
  if (rate_hz < 1 || rate_hz > kMaxRateHz) {
    return Error{
        fmt::format("{}: a rate of {} Hz is not within 1 .. {}", trace.path, rate_hz, kMaxRateHz)};
  }
  if (trace.rate_hz && *trace.rate_hz != rate_hz) {
    return Error{fmt::format("{}: was recorded at {} Hz and cannot be replayed at {} Hz",
                             trace.path, *trace.rate_hz, rate_hz)};
  }
  std::int64_t last = 0;
  for (TraceEvent& event : trace.events) {
    if (!trace.has_ticks) {
      // The first k with t_us * rate <= k * 1,000,000.
      const std::int64_t t_us = event.time_us - trace.events.front().time_us;
      event.tick = (t_us * rate_hz + 999'999) / 1'000'000;
    }
    last = event.tick;
  }
  return trace.end_ticks.value_or(last + rate_hz);
}

int replay_rate_hz(const Trace& trace, std::optional<int> asked) {
  if (asked) return *asked;
  return trace.rate_hz.value_or(kDefaultRateHz);
}

void copy_report(const Trace& trace, const TraceEvent& event, Report& report) noexcept {
  report.time_ns = event.time_us * 1000;
  report.device = event.device;
  report.kind = event.kind;
  report.size = event.size;
  if (event.size > 0) std::memcpy(report.bytes.data(), &trace.bytes[event.first_byte], event.size);
}

Report report_of(const Trace& trace, const TraceEvent& event) noexcept {
  Report report;
  copy_report(trace, event, report);
  return report;
}

}  // namespace gaitpad
