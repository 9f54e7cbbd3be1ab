#include "hid/trace_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/toml_file.h"
#include "hid/descriptor.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxCalibrationBytes = 1 << 16;
constexpr int kMaxDeviceIndex = 9999;

Cause bad_time(std::string_view word) {
  return fmt::format("{} is no time SECONDS.MICROSECONDS with six digits behind the point",
                     in_quotes(word));
}

}  // namespace

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
      return std::nullopt;  // as hid-replay does
  }
}

Cause TraceReader::version(Words words) {
  if (words.next() != "1") return "this version of the format is not known, 1 is";
  if (trace_.rate_hz || trace_.has_ticks || !trace_.events.empty())
    return "a V: line stands first, once";
  std::optional<int> rate_hz;
  while (!words.at_end()) {
    const std::string_view word = words.next();
    constexpr std::string_view kRate = "rate_hz=";
    if (!word.starts_with(kRate)) continue;
    const auto rate = decimal(word.substr(kRate.size()), kMaxRateHz);
    if (!rate || *rate < 1) {
      return fmt::format("{} is no rate within 1 .. {}", in_quotes(word), kMaxRateHz);
    }
    rate_hz = static_cast<int>(*rate);
  }
  trace_.rate_hz = rate_hz;
  return std::nullopt;
}

Cause TraceReader::device_index(Words words) {
  const std::string_view word = words.next();
  const auto index = decimal(word, kMaxDeviceIndex);
  current_.reset();  // what stands below a damaged D: line belongs to no device
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

// hid-recorder's own B: lines are reports as a BPF program left them, beside the E: line of each.
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
  if (trace_.end_ticks) return "a line behind the end of the recording (Q:)";
  if (*tick < tick_) return fmt::format("tick {} comes after tick {}", *tick, tick_);
  const std::int64_t last = trace_.events.empty() ? 0 : trace_.events.back().tick;
  if (*tick - last > rate() * (kMaxTraceGapUs / 1'000'000)) {
    return fmt::format("a gap of more than ten minutes: tick {} after tick {}", *tick, last);
  }
  if (!trace_.has_ticks && !trace_.events.empty()) return "the first T: line stands behind events";
  trace_.has_ticks = true;
  tick_ = *tick;
  return std::nullopt;
}

Cause TraceReader::check_place(std::int64_t time_us, std::uint16_t device) const {
  if (trace_.end_ticks) return "a line behind the end of the recording (Q:)";
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

// Their R: line was damaged; no event belongs to them.
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

}  // namespace gaitpad
