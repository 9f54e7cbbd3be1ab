#include "gaitpad/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.h"
#include "gaitpad/descriptor.h"
#include "hid/evdev_recording.h"
#include "hid/trace_lines.h"
#include "system/whole_file.h"

namespace gaitpad {

// ---- The words and numbers of a line

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Between the words of a line.
constexpr bool is_gap(char c) { return c == ' ' || c == '\t'; }

template <class T>
std::optional<T> whole_number(std::string_view text, int base) {
  return text.starts_with('-') ? std::nullopt : parse_number<T>(text, base);
}

}  // namespace

void Words::skip_blanks() {
  while (!rest_.empty() && is_gap(rest_.front())) rest_.remove_prefix(1);
}

std::string_view Words::next() {
  skip_blanks();
  std::size_t size = 0;
  while (size < rest_.size() && !is_gap(rest_[size])) ++size;
  const std::string_view word = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return word;
}

bool Words::at_end() {
  skip_blanks();
  return rest_.empty();
}

std::optional<std::int64_t> decimal(std::string_view text, std::int64_t max) {
  const auto value = whole_number<std::int64_t>(text, 10);
  if (!value || *value > max) return std::nullopt;
  return value;
}

std::optional<std::uint32_t> hexadecimal(std::string_view text, std::uint32_t max) {
  const auto value = whole_number<std::uint32_t>(text, 16);
  if (!value || *value > max) return std::nullopt;
  return value;
}

std::optional<std::int64_t> microseconds(std::string_view text) {
  // Most seconds of a time whose nanoseconds fit in 64 bits.
  constexpr std::int64_t kMaxSeconds = 9'000'000'000;
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos || text.size() - point != 7) return std::nullopt;
  const auto seconds = decimal(text.substr(0, point), kMaxSeconds);
  const auto micros = decimal(text.substr(point + 1), 999'999);
  if (!seconds || !micros) return std::nullopt;
  return *seconds * 1'000'000 + *micros;
}

std::optional<std::string> append_bytes(Words& words, std::size_t max_bytes,
                                        std::vector<std::uint8_t>& out) {
  const std::string_view length = words.next();
  const auto count = decimal(length, 1'000'000);
  if (!count) return fmt::format("the length {} is no decimal number", in_quotes(length));
  if (static_cast<std::size_t>(*count) > max_bytes) {
    return fmt::format("{} bytes, at most {} are read", *count, max_bytes);
  }
  const std::size_t begin = out.size();
  std::int64_t found = 0;
  for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++found) {
    const int high = word.size() == 2 ? hex_digit(word[0]) : -1;
    const int low = word.size() == 2 ? hex_digit(word[1]) : -1;
    if (high < 0 || low < 0) {
      out.resize(begin);
      return fmt::format("{} is no byte of two hexadecimal digits", in_quotes(word));
    }
    if (found < *count) out.push_back(static_cast<std::uint8_t>(high * 16 + low));
  }
  if (found == *count) return std::nullopt;
  out.resize(begin);
  return fmt::format("the length says {} but {} bytes follow", *count, found);
}

// ---- Reading

namespace {

using Cause = std::optional<std::string>;  // why a line is damaged, without its line number

// Builds a trace from its lines, in their order, and checks each.
class TraceReader {
 public:
  explicit TraceReader(const std::string& name) { trace_.path = name; }
  Cause add(std::string_view line);
  Cause finish(Damage damage);
  void skip(const std::string& sentence);
  Trace take() { return std::move(trace_); }

 private:
  Cause add_lettered(char letter, std::string_view text);
  Cause version(Words words);
  Cause option(std::string_view text);
  Cause file(std::string_view name);
  Cause file_line(std::string_view text);
  Cause file_bytes(Words words);
  Cause device_index(Words words);
  Cause descriptor(Words words);
  Cause identity(Words words);
  Cause driver(Words words);
  Cause set_text(std::string DeviceInfo::*member, std::string_view text);
  Cause calibration(std::string_view text);
  Cause tick(Words words);
  Cause report(Words words);
  Cause command(Words words);
  Cause plugged(Words words);
  Cause end(Words words);

  Cause check_place(std::int64_t time_us, std::uint16_t device) const;
  Cause check_order(std::int64_t time_us, std::uint16_t device) const;
  void append(TraceEvent event);
  Cause current_device(std::size_t& device);
  void drop_undescribed_devices();
  std::int64_t rate() const { return trace_.rate_hz.value_or(kDefaultRateHz); }

  Trace trace_;
  std::optional<std::size_t> current_;  // device of the last `D:` line
  bool has_file_ = false;               // the last `F:` line is sound
  std::int64_t tick_ = 0;               // tick of the last `T:` line
  std::int64_t latest_us_ = 0;          // latest time of all devices
  // Last time of each device; that of commands is the last element.
  std::vector<std::int64_t> device_us_ = std::vector<std::int64_t>(kMaxTraceDevices + 1, -1);
};

constexpr std::size_t kMaxCalibrationBytes = 1 << 16;
constexpr int kMaxDeviceIndex = 9999;
constexpr std::size_t kMaxOptions = 256, kMaxFiles = 4096, kMaxFileNameBytes = 4096;

Cause bad_time(std::string_view word) {
  return fmt::format("{} is no time SECONDS.MICROSECONDS with six digits after the point",
                     in_quotes(word));
}

Cause TraceReader::add(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  if (line.empty() || line.front() == '#') return std::nullopt;
  if (line.find_first_not_of(" \t") == std::string_view::npos) return std::nullopt;
  if (line.find('\r') != std::string_view::npos) return "a carriage return inside the line";
  const bool lettered = line.size() >= 2 && line[1] == ':' && line[0] >= 'A' && line[0] <= 'Z';
  if (!lettered) return fmt::format("{} is no line of a trace", in_quotes(line.substr(0, 60)));
  std::string_view text = line.substr(2);
  if (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  return add_lettered(line[0], text);
}

Cause TraceReader::add_lettered(char letter, std::string_view text) {
  const Words words(text);
  switch (letter) {
    case 'V':
      return version(words);
    case 'O':
      return option(text);
    case 'F':
      return file(text);
    case 'G':
      return file_line(text);
    case 'X':
      return file_bytes(words);
    case 'D':
      return device_index(words);
    case 'R':
      return descriptor(words);
    case 'I':
      return identity(words);
    case 'B':
      return driver(words);
    case 'N':
      return set_text(&DeviceInfo::name, text);
    case 'P':
      return set_text(&DeviceInfo::physical_path, text);
    case 'U':
      return set_text(&DeviceInfo::unique_id, text);
    case 'M':
      return set_text(&DeviceInfo::mapping, text);
    case 'K':
      return calibration(text);
    case 'T':
      return tick(words);
    case 'E':
      return report(words);
    case 'C':
      return command(words);
    case 'H':
      return plugged(words);
    case 'Q':
      return end(words);
    default:
      return std::nullopt;  // the line is ignored, as hid-replay does
  }
}

Cause TraceReader::version(Words words) {
  const auto version = decimal(words.next(), kTraceVersion);
  if (!version || *version < 1) return "unknown version of the format; 1 and 2 are known";
  if (trace_.rate_hz || trace_.has_ticks || !trace_.events.empty())
    return "a V: line must be the first line, and only there";
  std::optional<int> rate_hz;
  while (!words.at_end()) {
    const std::string_view word = words.next();
    constexpr std::string_view kRate = "rate_hz=";
    if (!word.starts_with(kRate)) continue;
    const auto rate = decimal(word.substr(kRate.size()), kMaxRateHz);
    if (!rate || *rate < kLeastRateHz) {
      return fmt::format("{} is no rate within {} .. {}", in_quotes(word), kLeastRateHz,
                         kMaxRateHz);
    }
    rate_hz = static_cast<int>(*rate);
  }
  trace_.version = static_cast<int>(*version);
  trace_.rate_hz = rate_hz;
  return std::nullopt;
}

// `O: pace own`. The session knows what the others mean.
Cause TraceReader::option(std::string_view text) {
  Words words(text);
  if (words.next() != "pace") {
    if (trace_.options.size() == kMaxOptions) return "too many O: lines";
    trace_.options.emplace_back(text);
    return std::nullopt;
  }
  const std::string_view word = words.next();
  const auto pace = pace_named(word);
  if (!pace || !words.at_end()) return fmt::format("{} is no pace: own or adult", in_quotes(word));
  if (trace_.pace || !trace_.events.empty())
    return "an O: line for the pace must come before events, and only once";
  trace_.pace = pace;
  return std::nullopt;
}

Cause TraceReader::file(std::string_view name) {
  has_file_ = false;
  if (name.empty() || name.size() > kMaxFileNameBytes)
    return fmt::format("a file's name has 1 to {} bytes", kMaxFileNameBytes);
  if (trace_.files.size() == kMaxFiles) return fmt::format("more than {} files", kMaxFiles);
  trace_.files.push_back({std::string(name), {}, trace_.has_ticks ? tick_ : -1});
  has_file_ = true;
  return std::nullopt;
}

Cause TraceReader::file_line(std::string_view text) {
  if (!has_file_) return std::nullopt;  // a line of another program
  trace_.files.back().bytes.append(text).push_back('\n');
  return std::nullopt;
}

Cause TraceReader::file_bytes(Words words) {
  if (!has_file_) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  if (Cause cause = append_bytes(words, kMaxReportBytes, bytes)) return "file: " + *cause;
  trace_.files.back().bytes.append(bytes.begin(), bytes.end());
  return std::nullopt;
}

Cause TraceReader::device_index(Words words) {
  const std::string_view word = words.next();
  const auto index = decimal(word, kMaxDeviceIndex);
  current_.reset();  // lines below a damaged D: line belong to no device
  if (!index || !words.at_end()) return fmt::format("{} is no device index", in_quotes(word));
  for (std::size_t i = 0; i < trace_.devices.size(); ++i) {
    if (trace_.devices[i].index != *index) continue;
    current_ = i;
    return std::nullopt;
  }
  if (trace_.devices.size() >= kMaxTraceDevices) {
    return fmt::format("more than {} devices", kMaxTraceDevices);
  }
  current_ = trace_.devices.size();
  TraceDevice device;
  device.index = static_cast<int>(*index);
  trace_.devices.push_back(std::move(device));
  return std::nullopt;
}

// A recording of one device has no `D:` line.
Cause TraceReader::current_device(std::size_t& device) {
  if (!current_) {
    if (Cause cause = device_index(Words("0"))) return cause;
  }
  device = *current_;
  return std::nullopt;
}

Cause TraceReader::descriptor(Words words) {
  std::vector<std::uint8_t> bytes;
  if (Cause cause = append_bytes(words, kMaxDescriptorBytes, bytes)) {
    return "report descriptor: " + *cause;
  }
  if (bytes.empty()) return "the report descriptor is empty";
  std::size_t device = 0;
  if (Cause cause = current_device(device)) return cause;
  DeviceInfo& info = trace_.devices[device].info;
  if (!info.descriptor.empty()) {
    return fmt::format("a second R: line for device {}", trace_.devices[device].index);
  }
  info.descriptor = std::move(bytes);
  return std::nullopt;
}

Cause TraceReader::identity(Words words) {
  const auto bus = hexadecimal(words.next(), 0xffff);
  const auto vendor = hexadecimal(words.next(), 0xffff);
  const auto product = hexadecimal(words.next(), 0xffff);
  if (!bus || !vendor || !product || !words.at_end()) {
    return "an I: line holds bus, vendor and product as hexadecimal numbers of up to four digits";
  }
  std::size_t device = 0;
  if (Cause cause = current_device(device)) return cause;
  DeviceInfo& info = trace_.devices[device].info;
  info.bus = static_cast<BusType>(*bus);
  info.vendor = static_cast<std::uint16_t>(*vendor);
  info.product = static_cast<std::uint16_t>(*product);
  return std::nullopt;
}

// hid-recorder has B: lines of its own: reports as a BPF program left them, beside their E: lines.
Cause TraceReader::driver(Words words) {
  const std::string_view name = words.next();
  if (microseconds(name)) return std::nullopt;
  if (name.empty() || name.size() > kMaxTraceTextBytes) return "a B: line holds a driver's name";
  const std::string_view word = words.next();
  const auto version = hexadecimal(word.empty() ? "0" : word, 0xffff);
  if (!version || !words.at_end()) {
    return fmt::format("{} is no version of four hexadecimal digits", in_quotes(word));
  }
  std::size_t device = 0;
  if (Cause cause = current_device(device)) return cause;
  trace_.devices[device].info.driver = name;
  trace_.devices[device].info.version = static_cast<std::uint16_t>(*version);
  return std::nullopt;
}

Cause TraceReader::set_text(std::string DeviceInfo::*member, std::string_view text) {
  if (text.size() > kMaxTraceTextBytes) {
    return fmt::format("a text of {} bytes, at most {} are read", text.size(), kMaxTraceTextBytes);
  }
  std::size_t device = 0;
  if (Cause cause = current_device(device)) return cause;
  trace_.devices[device].info.*member = text;
  return std::nullopt;
}

Cause TraceReader::calibration(std::string_view text) {
  std::size_t device = 0;
  if (Cause cause = current_device(device)) return cause;
  std::string& all = trace_.devices[device].calibration;
  if (all.size() + text.size() >= kMaxCalibrationBytes) {
    return fmt::format("a calibration of more than {} bytes", kMaxCalibrationBytes);
  }
  all.append(text).push_back('\n');
  return std::nullopt;
}

Cause TraceReader::tick(Words words) {
  const std::string_view word = words.next();
  const auto tick = decimal(word, std::int64_t{1} << 50);
  if (!tick || !words.at_end()) return fmt::format("{} is no tick", in_quotes(word));
  if (trace_.end_ticks) return "a line after the end of the recording (Q:)";
  if (*tick < tick_) return fmt::format("tick {} comes after tick {}", *tick, tick_);
  const std::int64_t last = trace_.events.empty() ? 0 : trace_.events.back().tick;
  if (*tick - last > rate() * (kMaxTraceGapUs / 1'000'000)) {
    return fmt::format("a gap of more than ten minutes: tick {} after tick {}", *tick, last);
  }
  if (!trace_.has_ticks && !trace_.events.empty()) return "the first T: line comes after events";
  trace_.has_ticks = true;
  tick_ = *tick;
  return std::nullopt;
}

Cause TraceReader::check_place(std::int64_t time_us, std::uint16_t device) const {
  if (trace_.end_ticks) return "a line after the end of the recording (Q:)";
  if (trace_.events.size() >= kMaxTraceEvents)
    return fmt::format("more than {} events", kMaxTraceEvents);
  return check_order(time_us, device);
}

Cause TraceReader::check_order(std::int64_t time_us, std::uint16_t device) const {
  if (trace_.events.empty()) return std::nullopt;
  const std::size_t stream = device == kNoDevice ? kMaxTraceDevices : device;
  const std::int64_t before = trace_.has_ticks ? device_us_[stream] : latest_us_;
  if (time_us < before) {
    return fmt::format("time goes back from {}.{:06} to {}.{:06}", before / 1'000'000,
                       before % 1'000'000, time_us / 1'000'000, time_us % 1'000'000);
  }
  if (time_us - latest_us_ > kMaxTraceGapUs) {
    return fmt::format("a gap of more than ten minutes: {} s", (time_us - latest_us_) / 1'000'000);
  }
  if (time_us - trace_.events.front().time_us > kMaxTraceDurationUs) {
    return "a recording of more than a million seconds";
  }
  return std::nullopt;
}

void TraceReader::append(TraceEvent event) {
  event.tick = trace_.has_ticks ? tick_ : 0;
  const std::size_t stream = event.device == kNoDevice ? kMaxTraceDevices : event.device;
  device_us_[stream] = event.time_us;
  latest_us_ = std::max(latest_us_, event.time_us);
  trace_.events.push_back(event);
}

Cause TraceReader::report(Words words) {
  const std::string_view word = words.next();
  const auto time_us = microseconds(word);
  if (!time_us) return bad_time(word);
  if (!current_ || trace_.devices[*current_].info.descriptor.empty()) {
    return "a report before its device's R: line";
  }
  TraceEvent event;
  event.time_us = *time_us;
  event.device = static_cast<std::uint16_t>(*current_);
  event.first_byte = static_cast<std::uint32_t>(trace_.bytes.size());
  if (Cause cause = check_place(*time_us, event.device)) return cause;
  if (Cause cause = append_bytes(words, kMaxReportBytes, trace_.bytes)) return "report: " + *cause;
  event.size = static_cast<std::uint16_t>(trace_.bytes.size() - event.first_byte);
  append(event);
  return std::nullopt;
}

Cause TraceReader::command(Words words) {
  const std::string_view word = words.next();
  const auto time_us = microseconds(word);
  if (!time_us) return bad_time(word);
  if (words.at_end()) return "a command without text";
  const std::string_view text = words.rest();
  if (text.size() > kMaxReportBytes) {
    return fmt::format("a command of {} bytes, at most {} are read", text.size(), kMaxReportBytes);
  }
  if (Cause cause = check_place(*time_us, kNoDevice)) return cause;
  TraceEvent event;
  event.time_us = *time_us;
  event.kind = ReportKind::command;
  event.first_byte = static_cast<std::uint32_t>(trace_.bytes.size());
  event.size = static_cast<std::uint16_t>(text.size());
  trace_.bytes.insert(trace_.bytes.end(), text.begin(), text.end());
  append(event);
  return std::nullopt;
}

Cause TraceReader::plugged(Words words) {
  const std::string_view word = words.next();
  const auto time_us = microseconds(word);
  if (!time_us) return bad_time(word);
  const std::string_view what = words.next();
  if ((what != "add" && what != "remove") || !words.at_end()) {
    return fmt::format("{} is neither add nor remove", in_quotes(what));
  }
  if (!current_ || trace_.devices[*current_].info.descriptor.empty()) {
    return "plugging before the device's R: line";
  }
  TraceEvent event;
  event.time_us = *time_us;
  event.device = static_cast<std::uint16_t>(*current_);
  event.kind = what == "add" ? ReportKind::added : ReportKind::removed;
  event.first_byte = static_cast<std::uint32_t>(trace_.bytes.size());
  if (Cause cause = check_place(*time_us, event.device)) return cause;
  append(event);
  return std::nullopt;
}

Cause TraceReader::end(Words words) {
  const std::string_view word = words.next();
  const auto time_us = microseconds(word);
  if (!time_us) return bad_time(word);
  const std::string_view count = words.next();
  const auto ticks = decimal(count, std::int64_t{1} << 50);
  if (!ticks || !words.at_end()) return fmt::format("{} is no number of ticks", in_quotes(count));
  if (trace_.end_ticks) return "a second Q: line";
  const bool any = !trace_.events.empty();
  if (any && *time_us < latest_us_) return "the recording ends before its last event";
  if (any && *time_us - latest_us_ > kMaxTraceGapUs)
    return "a gap of more than ten minutes at the end";
  if (trace_.has_ticks && *ticks <= tick_) {
    return fmt::format("the recording has {} ticks but tick {} has events", *ticks, tick_);
  }
  const std::int64_t lasted_us = any ? *time_us - trace_.events.front().time_us : 0;
  if (*ticks > (lasted_us + 2 * kMaxTraceGapUs) / 1'000'000 * rate()) {
    return fmt::format("{} ticks do not fit into {} s", *ticks, lasted_us / 1'000'000);
  }
  trace_.end_time_us = *time_us;
  trace_.end_ticks = *ticks;
  return std::nullopt;
}

// Drops devices whose R: line was damaged; no event belongs to them.
void TraceReader::drop_undescribed_devices() {
  std::vector<std::uint16_t> place(trace_.devices.size());
  std::vector<TraceDevice> kept;
  for (std::size_t i = 0; i < trace_.devices.size(); ++i) {
    place[i] = static_cast<std::uint16_t>(kept.size());
    if (!trace_.devices[i].info.descriptor.empty()) kept.push_back(std::move(trace_.devices[i]));
  }
  trace_.devices = std::move(kept);
  for (TraceEvent& event : trace_.events) {
    if (event.device != kNoDevice) event.device = place[event.device];
  }
}

Cause TraceReader::finish(Damage damage) {
  if (damage == Damage::skip) drop_undescribed_devices();
  if (trace_.devices.empty()) return "no device: there is no R: line";
  for (const TraceDevice& d : trace_.devices) {
    if (d.info.descriptor.empty()) return fmt::format("device {} has no R: line", d.index);
  }
  return std::nullopt;
}

void TraceReader::skip(const std::string& sentence) {
  if (trace_.skipped_lines++ == 0) trace_.first_damage = sentence;
}

constexpr std::size_t kMaxLineBytes = 1 << 20;

// Cuts text that arrives in pieces into lines and feeds them to the reader.
class LineFeed {
 public:
  LineFeed(const std::string& name, Damage damage) : reader_(name), name_(name), damage_(damage) {}

  std::optional<Error> add(std::string_view piece) {
    while (!piece.empty()) {
      const std::size_t end = piece.find('\n');
      const std::string_view part = piece.substr(0, end);
      const bool complete = end != std::string_view::npos;
      piece.remove_prefix(complete ? end + 1 : piece.size());
      if (complete && rest_.empty()) {
        if (auto error = line(part)) return error;
        continue;
      }
      // A line that is too long is cut one byte beyond the limit, so that line() still sees it.
      rest_.append(part.substr(0, kMaxLineBytes + 1 - std::min(rest_.size(), kMaxLineBytes + 1)));
      if (complete) {
        const std::string whole = std::move(rest_);
        rest_.clear();
        if (auto error = line(whole)) return error;
      }
    }
    return std::nullopt;
  }

  Result<Trace> finish() {
    if (!rest_.empty()) {
      if (auto error = line(rest_)) return *error;
    }
    const Cause cause = reader_.finish(damage_);
    if (cause) return Error{fmt::format("{}: {}", name_, *cause)};
    return reader_.take();
  }

 private:
  std::optional<Error> line(std::string_view text) {
    ++number_;
    Cause cause;
    const bool comment = !text.empty() && text.front() == '#';
    if (text.size() > kMaxLineBytes && !comment) {
      cause = fmt::format("the line is longer than {} bytes", kMaxLineBytes);
    } else {
      cause = reader_.add(text);
    }
    if (!cause) return std::nullopt;
    const std::string sentence = fmt::format("{}:{}: {}", name_, number_, *cause);
    if (damage_ == Damage::refuse) return Error{sentence};
    reader_.skip(sentence);
    return std::nullopt;
  }

  TraceReader reader_;
  std::string name_;
  Damage damage_;
  std::string rest_;
  std::int64_t number_ = 0;
};

}  // namespace

Result<Trace> parse_trace(std::string_view text, const std::string& name, Damage damage) {
  if (is_evdev_recording(text)) return parse_evdev_recording(text, name, damage);
  LineFeed feed(name, damage);
  if (auto error = feed.add(text)) return *error;
  return feed.finish();
}

Result<Trace> read_trace(const std::string& path, Damage damage) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return Error{path + ": there is no such file"};
  if (auto problem = no_file_problem(path)) return *problem;
  const auto too_large = [&path] {
    return Error{fmt::format("{}: larger than {} MiB", path, kMaxTraceBytes >> 20)};
  };
  if (std::filesystem::file_size(path, ignored) > kMaxTraceBytes && !ignored) return too_large();
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{path + ": cannot be opened for reading"};
  LineFeed feed(path, damage);
  std::string of_nodes;  // the whole text of a recording of event nodes
  std::vector<char> buffer(1 << 16);
  std::size_t total = 0;
  while (in.good()) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const auto got = static_cast<std::size_t>(in.gcount());
    total += got;
    if (total > kMaxTraceBytes) return too_large();
    const std::string_view piece(buffer.data(), got);
    if (!of_nodes.empty() || (total == got && is_evdev_recording(piece))) {
      of_nodes += piece;
    } else if (auto error = feed.add(piece)) {
      return *error;
    }
  }
  if (in.bad()) return Error{path + ": reading failed"};
  if (!of_nodes.empty()) return parse_evdev_recording(of_nodes, path, damage);
  return feed.finish();
}

// ---- Writing

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

std::string_view without_return(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

// Whether lines of a trace can hold it. Their line ends are all LF then.
bool is_plain_text(std::string_view bytes) {
  if (bytes.find('\0') != bytes.npos) return false;
  while (!bytes.empty()) {
    const std::string_view line = without_return(take_line(bytes));
    if (line.size() > kMaxLineBytes / 2 || line.find('\r') != line.npos) return false;
  }
  return true;
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

void TraceWriter::begin(int rate_hz, int version) {
  text_ += fmt::format("V: {} rate_hz={}\n", version, rate_hz);
}

void TraceWriter::pace(Pace pace) { text_ += fmt::format("O: pace {}\n", name_of(pace)); }

void TraceWriter::option(std::string_view text) {
  text_ += "O: " + one_line(text, text.size()) + "\n";
}

void TraceWriter::file(std::string_view name, std::string_view bytes) {
  text_ += "F: " + one_line(name, name.size()) + "\n";
  if (is_plain_text(bytes)) {
    while (!bytes.empty()) {
      text_ += "G: ";
      text_ += without_return(take_line(bytes));
      text_ += '\n';
    }
    return;
  }
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kMaxReportBytes))) {
    const std::string_view part = bytes.substr(0, kMaxReportBytes);
    text_ += "X: ";
    append_bytes(text_, reinterpret_cast<const std::uint8_t*>(part.data()), part.size());
  }
}

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
  if (trace.rate_hz) writer.begin(*trace.rate_hz, trace.version);
  if (trace.pace) writer.pace(*trace.pace);
  for (const std::string& option : trace.options) writer.option(option);
  auto file = trace.files.begin();
  const auto add_files = [&](std::int64_t tick) {
    for (; file != trace.files.end() && file->tick <= tick; ++file) {
      if (file->tick >= 0) writer.tick(file->tick);
      writer.file(file->name, file->bytes);
    }
  };
  add_files(-1);
  const bool plain = trace.devices.size() == 1 && trace.devices.front().index == 0;
  for (const TraceDevice& device : trace.devices) {
    writer.device(device, plain ? TraceWriter::Index::left_out : TraceWriter::Index::written);
  }
  for (const TraceEvent& event : trace.events) {
    add_files(event.tick);
    if (trace.has_ticks) writer.tick(event.tick);
    std::optional<int> index;
    if (event.device != kNoDevice) index = trace.devices[event.device].index;
    writer.event(event.kind, event.time_us, index,
                 {trace.bytes.data() + event.first_byte, event.size});
  }
  if (trace.end_time_us && trace.end_ticks) writer.end(*trace.end_time_us, *trace.end_ticks);
  return writer.take_text();
}

std::optional<Error> check(const Trace& trace) {
  const auto problem = [&trace](const std::string& cause) {
    return Error{trace.path + ": " + cause};
  };
  if (trace.rate_hz && (*trace.rate_hz < kLeastRateHz || *trace.rate_hz > kMaxRateHz)) {
    return problem(
        fmt::format("rate_hz is {}, outside [{}, {}]", *trace.rate_hz, kLeastRateHz, kMaxRateHz));
  }
  if (trace.devices.size() > kMaxTraceDevices)
    return problem(
        fmt::format("devices: there are {}, at most {}", trace.devices.size(), kMaxTraceDevices));
  std::int64_t tick = 0;
  for (std::size_t i = 0; i < trace.events.size(); ++i) {
    const TraceEvent& event = trace.events[i];
    if (event.device != kNoDevice && event.device >= trace.devices.size()) {
      return problem(fmt::format("events[{}].device is {}, but there are {} devices", i,
                                 event.device, trace.devices.size()));
    }
    if (event.size > kMaxReportBytes)
      return problem(
          fmt::format("events[{}].size is {}, outside [0, {}]", i, event.size, kMaxReportBytes));
    if (event.first_byte > trace.bytes.size() ||
        event.size > trace.bytes.size() - event.first_byte) {
      return problem(fmt::format("events[{}].first_byte is {}, its {} bytes are not in bytes", i,
                                 event.first_byte, event.size));
    }
    if (trace.has_ticks && event.tick < tick)
      return problem(fmt::format("events[{}].tick is {}, before {}", i, event.tick, tick));
    tick = event.tick;
    const std::int64_t time_us = event.time_us - trace.events.front().time_us;
    if (time_us < -kMaxTraceDurationUs || time_us > kMaxTraceDurationUs)
      return problem(fmt::format("events[{}].time_us is {} us from the first, at most {} are", i,
                                 time_us, kMaxTraceDurationUs));
  }
  return std::nullopt;
}

Result<std::int64_t> write_trace(const Trace& trace, const std::string& path) {
  if (auto problem = check(trace)) return *problem;
  const std::string text = trace_text(trace);
  if (auto problem = write_file(path, text)) return *problem;
  return static_cast<std::int64_t>(text.size());
}

// ---- Replaying

std::optional<std::string> damage_remark(const Trace& trace) {
  if (trace.skipped_lines == 0) return std::nullopt;
  return fmt::format("{} damaged lines were skipped, the first: {}", trace.skipped_lines,
                     trace.first_damage);
}

Result<std::int64_t> assign_ticks(Trace& trace, int rate_hz) {
  if (auto problem = check(trace)) return *problem;
  if (rate_hz < kLeastRateHz || rate_hz > kMaxRateHz) {
    return Error{fmt::format("{}: a rate of {} Hz is not within {} .. {}", trace.path, rate_hz,
                             kLeastRateHz, kMaxRateHz)};
  }
  if (trace.rate_hz && *trace.rate_hz != rate_hz) {
    return Error{fmt::format("{}: was recorded at {} Hz and cannot be replayed at {} Hz",
                             trace.path, *trace.rate_hz, rate_hz)};
  }
  std::int64_t last = 0;
  for (TraceEvent& event : trace.events) {
    if (!trace.has_ticks) {
      // The first tick at or after the event: the least k with t_us * rate <= k * 1,000,000.
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

std::optional<Pace> replay_pace(const Trace& trace, std::optional<Pace> asked) {
  if (asked || trace.pace) return asked ? asked : trace.pace;
  return trace.has_ticks ? std::optional(Pace::adult) : std::nullopt;
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
