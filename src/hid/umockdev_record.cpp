#include "hid/umockdev_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/text.h"
#include "hid/evemu.h"
#include "hid/trace_lines.h"

namespace gaitpad {
namespace {

using Cause = std::optional<std::string>;  // why a line is damaged, without its line number
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kMaxAnswerBytes = 4096;
constexpr std::int64_t kKey = 0x01;  // type of the events of keys

// Reads hexadecimal digits such as `0BFF00`, at most as many as a request can answer.
std::optional<Bytes> bytes_of(std::string_view digits) {
  if (digits.size() % 2 != 0 || digits.size() > 2 * kMaxAnswerBytes) return std::nullopt;
  Bytes bytes;
  for (; !digits.empty(); digits.remove_prefix(2)) {
    const auto byte = hexadecimal(digits.substr(0, 2), 0xff);
    if (!byte) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(*byte));
  }
  return bytes;
}

std::uint16_t word(std::span<const std::uint8_t> bytes, std::size_t index) {
  return static_cast<std::uint16_t>(bytes[2 * index] | bytes[2 * index + 1] << 8);
}
// The 32-bit number at `index` of the kernel's input_absinfo.
std::int32_t number(std::span<const std::uint8_t> bytes, std::size_t index) {
  const std::uint32_t low = word(bytes, 2 * index), high = word(bytes, 2 * index + 1);
  return static_cast<std::int32_t>(low | high << 16);
}

std::string text_of(std::span<const std::uint8_t> bytes) {
  const std::string text(bytes.begin(), std::ranges::find(bytes, 0));
  return text.substr(0, kMaxTraceTextBytes);
}

class UmockdevReader final : public EvdevReader {
 public:
  Cause add(std::string_view line) override;
  std::string missing() const override {
    return "no axis or key of a device; its events alone do not state them: put the file that "
           "umockdev-record --ioctl wrote of it before them";
  }

 private:
  Cause answer(std::string_view line);
  Cause axis_range(std::uint16_t code, const Bytes& bytes);
  Cause identity(const Bytes& bytes);
  Cause event(Words words);
  void property(std::string_view key, std::string_view value);
  Cause use(std::string_view path);
  // Lines before any path belong to the first node that is named.
  EvdevRecording& node() {
    if (nodes.empty()) static_cast<void>(use(""));
    return nodes[used_];
  }

  std::vector<std::string> paths_;  // paths of the nodes
  std::size_t used_ = 0;            // number of the node that the lines belong to
  std::string block_, described_;   // sysfs paths: of the block, of the last event node
};

Cause UmockdevReader::add(std::string_view line) {
  constexpr std::string_view kDevice = "# device ", kAnswersOf = "@DEV ";
  line = trimmed(line);
  if (line.starts_with(kDevice)) return use(line.substr(kDevice.size()));
  if (line.starts_with(kAnswersOf)) return use(Words(line.substr(kAnswersOf.size())).next());
  if (line.starts_with("EVIOC")) return answer(line);
  if (line.size() < 3 || line[1] != ':') return std::nullopt;
  std::string_view text = trimmed(line.substr(2));
  if (line.front() == 'P') block_ = text;
  if (line.front() == 'N') {
    const std::string_view name = take_part(text, '=');
    if (!name.starts_with("input/event")) return std::nullopt;
    described_ = block_;
    return use("/dev/" + std::string(name));
  }
  if (line.front() != 'E') return std::nullopt;
  if (Words(text).next().find('=') == std::string_view::npos) return event(Words(text));
  const std::string_view key = take_part(text, '=');
  if (described_.starts_with(block_ + "/")) property(key, text);  // the node's parents follow it
  return std::nullopt;
}

Cause UmockdevReader::use(std::string_view path) {
  if (nodes.size() == 1 && paths_[0].empty()) paths_[0] = path;
  const auto known = std::ranges::find(paths_, path);
  used_ = static_cast<std::size_t>(known - paths_.begin());
  if (known != paths_.end()) return std::nullopt;
  if (nodes.size() >= kMaxTraceDevices) {
    used_ = nodes.size() - 1;
    return fmt::format("more than {} devices", kMaxTraceDevices);
  }
  nodes.emplace_back();
  paths_.emplace_back(path);
  return std::nullopt;
}

// `EVIOCGABS(1) 0 0D0F...`: a request with its number (no number: 0), what the call returned, and
// the bytes that it filled in. Calls for names and keys return the number of these bytes.
Cause UmockdevReader::answer(std::string_view line) {
  Words words(line);
  std::string_view index = words.next();
  const std::string_view request = take_part(index, '(');
  const bool is_range = request == "EVIOCGABS", is_id = request == "EVIOCGID",
             is_text = request == "EVIOCGNAME" || request == "EVIOCGUNIQ";
  const auto code = index.empty() ? std::optional<std::int64_t>(0)
                                  : decimal(take_part(index, ')'), evdev::kAbsMax);
  const bool is_keys = request == "EVIOCGBIT" && code == kKey;
  if (!is_range && !is_id && !is_text && !is_keys) return std::nullopt;
  const auto returned = parse_number<std::int32_t>(words.next());
  auto bytes = bytes_of(words.next());
  if (!code || !returned || !bytes)
    return fmt::format("{} has a number, what it returned, and bytes in hexadecimal digits",
                       request);
  if (*returned < 0) return std::nullopt;  // the call was refused
  if (is_range) return axis_range(static_cast<std::uint16_t>(*code), *bytes);
  if (is_id) return identity(*bytes);
  bytes->resize(std::min(bytes->size(), static_cast<std::size_t>(*returned)));
  if (request == "EVIOCGNAME") node().info.name = text_of(*bytes);
  if (request == "EVIOCGUNIQ") node().info.unique_id = text_of(*bytes);
  for (std::size_t i = 0; is_keys && i < 8 * bytes->size(); ++i) {
    if (((*bytes)[i / 8] >> (i % 8) & 1) != 0) node().add_key(static_cast<std::uint16_t>(i));
  }
  return std::nullopt;
}

// Value, minimum, maximum, noise, flat, resolution. The file repeats the request when the answer
// has changed.
Cause UmockdevReader::axis_range(std::uint16_t code, const Bytes& bytes) {
  constexpr std::size_t kBytes = 24;
  if (bytes.size() != kBytes) return fmt::format("an axis' range has {} bytes", kBytes);
  const RecordedAxis axis{
      {code, number(bytes, 1), number(bytes, 2)}, number(bytes, 4), line_number};
  const RecordedAxis* known = node().axis(code);
  if (known && known->min == axis.min && known->max == axis.max) return std::nullopt;
  return node().add_axis(axis);
}

Cause UmockdevReader::identity(const Bytes& bytes) {
  constexpr std::size_t kBytes = 8;
  if (bytes.size() != kBytes) return fmt::format("an id has {} bytes", kBytes);
  DeviceInfo& info = node().info;
  info.bus = static_cast<BusType>(word(bytes, 0));
  info.vendor = word(bytes, 1);
  info.product = word(bytes, 2);
  info.version = word(bytes, 3);
  return std::nullopt;
}

// A property of the input device, the first parent of an event node.
void UmockdevReader::property(std::string_view key, std::string_view value) {
  DeviceInfo& info = node().info;
  if (key == "NAME") info.name = trimmed(value, "\"").substr(0, kMaxTraceTextBytes);
  if (key == "UNIQ") info.unique_id = trimmed(value, "\"").substr(0, kMaxTraceTextBytes);
  if (key != "PRODUCT") return;
  std::array<std::uint16_t, 4> ids{};
  for (std::uint16_t& id : ids) {
    const auto part = hexadecimal(take_part(value, '/'), 0xffff);
    if (!part) return;  // a USB device has three parts
    id = static_cast<std::uint16_t>(*part);
  }
  info.bus = static_cast<BusType>(ids[0]);
  info.vendor = ids[1];
  info.product = ids[2];
  info.version = ids[3];
}

// `E: SECONDS.MICROSECONDS TYPE CODE VALUE`, as evemu has it.
Cause UmockdevReader::event(Words words) { return add_evemu_event(words, node()); }

}  // namespace

bool is_umockdev_record(std::string_view text) noexcept {
  constexpr std::string_view kEventsHead = "# EVEMU ", kDevice = "# device ";
  if (text.starts_with("@DEV ") || text.starts_with("EVIOC") || text.starts_with("P: /devices/"))
    return true;
  if (!text.starts_with(kEventsHead)) return false;
  take_line(text);
  return text.starts_with(kDevice);
}

std::unique_ptr<EvdevReader> make_umockdev_reader() { return std::make_unique<UmockdevReader>(); }

}  // namespace gaitpad
