#include "hid/evemu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/text.h"
#include "gaitpad/decode.h"
#include "gaitpad/descriptor.h"
#include "hid/evdev_layout.h"
#include "hid/evdev_recording.h"
#include "hid/trace_lines.h"

namespace gaitpad {
namespace {

using Cause = std::optional<std::string>;  // why a line is damaged, without its line number

constexpr std::uint16_t kSyn = 0x00, kKey = 0x01, kAbs = 0x03;  // types of events
constexpr std::uint16_t kSynReport = 0x00;
constexpr std::size_t kMaskBytes = 8;  // number of mask bytes in a B: or P: line

class EvemuReader final : public EvdevReader {
 public:
  EvemuReader() { nodes.emplace_back(); }
  Cause add(std::string_view line) override;

 private:
  Cause identity(Words words);
  Cause mask(Words words);
  Cause axis(Words words);
  EvdevRecording& node() { return nodes.front(); }

  // Number of mask bytes read so far, by the type of event.
  std::map<std::uint16_t, std::size_t> mask_bytes_;
};

Cause EvemuReader::add(std::string_view line) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return std::nullopt;
  if (line.size() < 2 || line[1] != ':')
    return fmt::format("{} is no line of evemu", in_quotes(line));
  std::string_view text = trimmed(line.substr(2));
  if (line.front() == 'N') {
    node().info.name = text.substr(0, kMaxTraceTextBytes);
    return std::nullopt;
  }
  const Words words(text.substr(0, text.find('#')));
  switch (line.front()) {
    case 'I':
      return identity(words);
    case 'B':
      return mask(words);
    case 'A':
      return axis(words);
    case 'E':
      return add_evemu_event(words, node());
    default:
      return std::nullopt;  // properties, LEDs and switches are ignored
  }
}

Cause EvemuReader::identity(Words words) {
  std::array<std::uint16_t, 4> ids{};
  for (std::uint16_t& id : ids) {
    const auto value = hexadecimal(words.next(), 0xffff);
    if (!value)
      return "an I: line holds bus, vendor, product and version as hexadecimal numbers of up to "
             "four digits";
    id = static_cast<std::uint16_t>(*value);
  }
  node().info.bus = static_cast<BusType>(ids[0]);
  node().info.vendor = ids[1];
  node().info.product = ids[2];
  node().info.version = ids[3];
  return std::nullopt;
}

// Reads 64 bits, one for each code of a type of event. The next line of the same type goes on with
// the next code.
Cause EvemuReader::mask(Words words) {
  const auto type = hexadecimal(words.next(), 0xff);
  std::array<std::uint32_t, kMaskBytes> bytes{};
  for (std::uint32_t& byte : bytes) {
    const auto value = hexadecimal(words.next(), 0xff);
    if (!type || !value) return "a B: line holds a type and eight bytes as hexadecimal numbers";
    byte = *value;
  }
  std::size_t& read = mask_bytes_[static_cast<std::uint16_t>(*type)];
  for (std::size_t i = 0; i < 8 * kMaskBytes && *type == kKey; ++i) {
    const std::size_t code = 8 * read + i;
    if (code <= evdev::kKeyMax && ((bytes[i / 8] >> (i % 8)) & 1u) != 0)
      node().add_key(static_cast<std::uint16_t>(code));
  }
  read = std::min<std::size_t>(read + kMaskBytes, evdev::kKeyMax);
  return std::nullopt;
}

Cause EvemuReader::axis(Words words) {
  const auto code = hexadecimal(words.next(), 0xffff);
  const auto min = parse_number<std::int32_t>(words.next());
  const auto max = parse_number<std::int32_t>(words.next());
  if (!code || !min || !max) return "an A: line holds a code, a minimum and a maximum";
  words.next();  // skips the noise
  const auto flat = parse_number<std::int32_t>(words.next());
  return node().add_axis(
      {{static_cast<std::uint16_t>(*code), *min, *max}, flat.value_or(0), line_number});
}

}  // namespace

bool is_evemu(std::string_view text) noexcept { return text.starts_with("# EVEMU "); }

std::optional<std::string> add_evemu_event(Words words, EvdevRecording& node) {
  const std::string_view word = words.next();
  const auto time_us = microseconds(word);
  const auto type = hexadecimal(words.next(), 0xffff), code = hexadecimal(words.next(), 0xffff);
  const auto value = parse_number<std::int32_t>(words.next());
  if (!time_us || !type || !code || !value)
    return "an E: line holds SECONDS.MICROSECONDS, a type, a code and a value";
  return node.add_event(
      {*time_us, static_cast<std::uint16_t>(*type), static_cast<std::uint16_t>(*code), *value},
      word);
}

std::unique_ptr<EvdevReader> make_evemu_reader() { return std::make_unique<EvemuReader>(); }

// ---- Writing

namespace {

// Computes the events that the kernel's hid-input makes of the fields of one pad.
class EvemuWriter {
 public:
  EvemuWriter(const DeviceInfo& info, ReportDescriptor descriptor)
      : info_(info),
        descriptor_(std::move(descriptor)),
        stated_by_(stated_by(info.driver)),
        codes_(evdev_codes(descriptor_, stated_by_)) {}

  std::string header() const;
  // Appends the events of a report or of an unplugging; nothing if they change nothing.
  void add(std::int64_t time_us, std::span<const std::uint8_t> report, std::string& out);
  void release(std::int64_t time_us, std::string& out);

 private:
  struct Axis {
    std::int64_t min = 0, max = 0;
  };
  std::map<std::uint16_t, Axis> axes() const;
  std::vector<std::uint16_t> keys() const;
  void set(EvdevCode code, std::int64_t value);
  void set_hat(const Field& field, std::int64_t value);
  void write_changes(std::int64_t time_us, std::string& out);

  const DeviceInfo& info_;
  ReportDescriptor descriptor_;
  StatedBy stated_by_;
  std::vector<std::optional<EvdevCode>> codes_;
  using Key = std::pair<std::uint16_t, std::uint16_t>;  // an event's type and code
  std::map<Key, std::int32_t> values_, first_;          // values now, and after the first report
  std::vector<Key> changed_;
};

bool is_hat(const Field& field, const EvdevCode& code) {
  return code.type == EvdevType::absolute && code.code == evdev::kAbsHat0X &&
         (field.usage == usage::kHatSwitch || is_dpad(field));
}

std::map<std::uint16_t, EvemuWriter::Axis> EvemuWriter::axes() const {
  std::map<std::uint16_t, Axis> axes;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    const Field& field = descriptor_.fields[i];
    if (!codes_[i] || codes_[i]->type != EvdevType::absolute) continue;
    if (is_hat(field, *codes_[i])) {
      axes[evdev::kAbsHat0X] = axes[evdev::kAbsHat0X + 1] = {-1, 1};
    } else {
      axes[codes_[i]->code] = {field.logical_min, field.logical_max};
    }
  }
  return axes;
}

std::vector<std::uint16_t> EvemuWriter::keys() const {
  std::vector<std::uint16_t> keys;
  for (const auto& code : codes_) {
    if (code && code->type == EvdevType::key) keys.push_back(code->code);
  }
  return keys;
}

void append_mask(std::uint16_t type, std::span<const std::uint16_t> codes, std::size_t bits,
                 std::string& out) {
  std::vector<unsigned> bytes((bits + 8 * kMaskBytes - 1) / (8 * kMaskBytes) * kMaskBytes);
  for (const std::uint16_t code : codes) bytes[code / 8] |= 1u << (code % 8);
  for (std::size_t i = 0; i < bytes.size(); i += kMaskBytes)
    out += fmt::format("B: {:02x} {:02x}\n", type,
                       fmt::join(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                                 bytes.begin() + static_cast<std::ptrdiff_t>(i + kMaskBytes), " "));
}

std::string EvemuWriter::header() const {
  std::string out = "# EVEMU 1.3\n# written by gaitpad\n";
  out += fmt::format("N: {}\n", printable(info_.name));
  out += fmt::format("I: {:04x} {:04x} {:04x} {:04x}\n", static_cast<unsigned>(info_.bus),
                     info_.vendor, info_.product, info_.version);
  out += "P: 00 00 00 00 00 00 00 00\n";
  const auto all = axes();
  std::vector<std::uint16_t> codes;
  for (const auto& [code, axis] : all) codes.push_back(code);
  constexpr std::array<std::uint16_t, 3> kTypes = {kSyn, kKey, kAbs};
  append_mask(kSyn, kTypes, 0x20, out);
  append_mask(kKey, keys(), evdev::kKeyMax + 1, out);
  append_mask(kAbs, codes, evdev::kAbsMax + 1, out);
  for (const auto& [code, axis] : all) {
    // hid-input sets noise to 1/256 and flat to 1/16 of a pad's range. Those of a recorded node are
    // not known: 0.
    const bool is_flat = stated_by_ == StatedBy::device && axis.max - axis.min > 2;
    const std::int64_t range = is_flat ? axis.max - axis.min : 0;
    out +=
        fmt::format("A: {:02x} {} {} {} {} 0\n", code, axis.min, axis.max, range >> 8, range >> 4);
  }
  return out;
}

void EvemuWriter::set(EvdevCode code, std::int64_t value) {
  const Key key(static_cast<std::uint16_t>(code.type), code.code);
  std::int32_t& known = values_[key];  // a value is 0 at first, as in the kernel
  if (known == static_cast<std::int32_t>(value)) return;
  known = static_cast<std::int32_t>(value);
  changed_.push_back(key);
}

// Sets both axes of the hat. The hat's value counts clockwise from up; y grows downwards.
void EvemuWriter::set_hat(const Field& field, std::int64_t value) {
  constexpr std::array<std::array<int, 2>, 9> kPlaces = {
      {{0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, 0}}};
  // Number of the hat's directions, 4 or 8.
  const std::int64_t steps = field.logical_max - field.logical_min + 1;
  const bool is_released = value < field.logical_min || value > field.logical_max || steps < 2;
  const std::int64_t place =
      is_released ? 8 : std::min<std::int64_t>((value - field.logical_min) * 8 / steps, 7);
  const auto& [x, y] = kPlaces[static_cast<std::size_t>(place)];
  set({EvdevType::absolute, evdev::kAbsHat0X}, x);
  set({EvdevType::absolute, evdev::kAbsHat0X + 1}, y);
}

void EvemuWriter::add(std::int64_t time_us, std::span<const std::uint8_t> report,
                      std::string& out) {
  if (report.empty()) return;
  const std::uint8_t id = descriptor_.numbered ? report[0] : 0;
  const auto data = descriptor_.numbered ? report.subspan(1) : report;
  std::array<int, 4> dpad{};  // the buttons up, down, right, left
  bool has_dpad = false;
  for (std::size_t i = 0; i < codes_.size(); ++i) {
    const Field& field = descriptor_.fields[i];
    const bool is_read = codes_[i] && field.kind == FieldKind::input && field.report_id == id &&
                         !field.is_array && field.bit_offset + field.bit_size <= 8 * data.size();
    if (!is_read) continue;
    const std::int64_t value = field_value(field, data);
    if (!is_hat(field, *codes_[i])) {
      set(*codes_[i], codes_[i]->type == EvdevType::key ? value != 0 : value);
    } else if (is_dpad(field)) {
      has_dpad = true;
      dpad[field.usage - usage::kDpadUp] = value != 0;
    } else {
      set_hat(field, value);
    }
  }
  if (has_dpad) {
    set({EvdevType::absolute, evdev::kAbsHat0X}, dpad[2] - dpad[3]);
    set({EvdevType::absolute, evdev::kAbsHat0X + 1}, dpad[1] - dpad[0]);
  }
  write_changes(time_us, out);
}

void EvemuWriter::release(std::int64_t time_us, std::string& out) {
  for (const auto& [key, value] : first_)
    set({static_cast<EvdevType>(key.first), key.second}, value);
  write_changes(time_us, out);
}

void EvemuWriter::write_changes(std::int64_t time_us, std::string& out) {
  if (first_.empty()) first_ = values_;
  if (changed_.empty()) return;
  const std::string time = fmt::format("{}.{:06}", time_us / 1'000'000, time_us % 1'000'000);
  for (const auto& key : changed_)
    out += fmt::format("E: {} {:04x} {:04x} {:04}\n", time, key.first, key.second, values_[key]);
  out += fmt::format("E: {} {:04x} {:04x} {:04}\n", time, kSyn, kSynReport, 0);
  changed_.clear();
}

}  // namespace

Result<std::string> evemu_text(const Trace& trace) {
  for (std::size_t d = 0; d < trace.devices.size(); ++d) {
    const DeviceInfo& info = trace.devices[d].info;
    auto descriptor = parse_descriptor(info.descriptor);
    if (!descriptor || !pad_application(*descriptor)) continue;
    EvemuWriter writer(info, std::move(*descriptor));
    std::string out = writer.header();
    std::optional<std::int64_t> start_us;
    for (const TraceEvent& event : trace.events) {
      if (event.device != d) continue;
      if (!start_us) start_us = event.time_us;
      // Times in evemu begin at 0.000001.
      const std::int64_t time_us = event.time_us - *start_us + 1;
      if (event.kind == ReportKind::input) {
        writer.add(time_us, std::span(trace.bytes).subspan(event.first_byte, event.size), out);
      } else if (event.kind == ReportKind::removed) {
        writer.release(time_us, out);
      }
    }
    return out;
  }
  return Error{trace.path + ": none of its devices is a pad"};
}

}  // namespace gaitpad
