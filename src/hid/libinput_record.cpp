#include "hid/libinput_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/text.h"
#include "hid/evdev_recording.h"

namespace gaitpad {
namespace {

using Cause = std::optional<std::string>;  // why a line is damaged, without its line number

constexpr std::int64_t kSecond_us = 1'000'000;
constexpr std::uint16_t kKey = 0x01;

// `[3, 1356, 2508, 33041] # a comment`; none: it is no list of numbers.
std::optional<std::vector<std::int64_t>> numbers_of(std::string_view text) {
  constexpr std::size_t kMaxNumbers = 1024;
  text = trimmed(text);
  const std::size_t end = text.find(']');
  if (!text.starts_with('[') || end == std::string_view::npos) return std::nullopt;
  std::vector<std::int64_t> numbers;
  for (std::string_view inside = text.substr(1, end - 1); !trimmed(inside).empty();) {
    const auto number = parse_number<std::int64_t>(trimmed(take_part(inside, ',')));
    if (!number || numbers.size() >= kMaxNumbers) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

bool is_within(std::int64_t number, std::int64_t least, std::int64_t most) {
  return least <= number && number <= most;
}
bool is_word(std::int64_t number) { return is_within(number, 0, 0xffff); }
bool is_value(std::int64_t number) { return is_within(number, INT32_MIN, INT32_MAX); }

class LibinputReader final : public EvdevReader {
 public:
  Cause add(std::string_view line) override;

 private:
  enum class Part { none, evdev, codes, ranges, events };
  Cause identity(std::string_view text);
  Cause codes_of_type(std::string_view type, std::string_view text);
  Cause range(std::string_view code, std::string_view text);
  Cause event(std::string_view text);
  EvdevRecording& node() { return nodes.back(); }

  Part part_ = Part::none;
};

Cause LibinputReader::add(std::string_view line) {
  line = trimmed(line);
  if (line.empty() || line.front() == '#') return std::nullopt;
  if (line.starts_with("- node:")) {
    if (nodes.size() >= kMaxTraceDevices)
      return fmt::format("more than {} devices", kMaxTraceDevices);
    nodes.emplace_back();
    part_ = Part::none;
    return std::nullopt;
  }
  if (nodes.empty()) return std::nullopt;
  if (line.starts_with("- evdev:")) {
    part_ = Part::events;
  } else if (line.starts_with("- [")) {
    return part_ == Part::events ? event(line.substr(2)) : std::nullopt;
  } else if (line.starts_with("- ")) {
    part_ = Part::none;  // a part about udev, or an event of libinput's, is ignored
  } else {
    std::string_view text = line;
    const std::string_view key = take_part(text, ':');
    const bool is_number = parse_number<std::uint16_t>(key).has_value();
    if (is_number && part_ == Part::codes) return codes_of_type(key, text);
    if (is_number && part_ == Part::ranges) return range(key, text);
    const bool is_of_evdev = part_ != Part::none && part_ != Part::events;
    if (key == "name" && is_of_evdev) {
      node().info.name = trimmed(text, " \"").substr(0, kMaxTraceTextBytes);
    } else if (key == "id" && is_of_evdev) {
      return identity(text);
    } else {
      part_ = key == "evdev"                    ? Part::evdev
              : key == "codes" && is_of_evdev   ? Part::codes
              : key == "absinfo" && is_of_evdev ? Part::ranges
                                                : Part::none;
    }
  }
  return std::nullopt;
}

Cause LibinputReader::identity(std::string_view text) {
  const auto ids = numbers_of(text);
  if (!ids || ids->size() != 4 || !std::ranges::all_of(*ids, is_word))
    return "an id is a list of bus, vendor, product and version";
  DeviceInfo& info = node().info;
  info.bus = static_cast<BusType>((*ids)[0]);
  info.vendor = static_cast<std::uint16_t>((*ids)[1]);
  info.product = static_cast<std::uint16_t>((*ids)[2]);
  info.version = static_cast<std::uint16_t>((*ids)[3]);
  return std::nullopt;
}

// Only keys are taken: the list of ranges names the axes again.
Cause LibinputReader::codes_of_type(std::string_view type, std::string_view text) {
  const auto codes = numbers_of(text);
  if (!codes || !std::ranges::all_of(*codes, is_word))
    return fmt::format("the codes of type {} are a list of numbers", type);
  if (parse_number<std::uint16_t>(type) != kKey) return std::nullopt;
  for (const std::int64_t code : *codes) node().add_key(static_cast<std::uint16_t>(code));
  return std::nullopt;
}

Cause LibinputReader::range(std::string_view code, std::string_view text) {
  const auto range = numbers_of(text);
  if (!range || range->size() < 2 || !std::ranges::all_of(*range, is_value))
    return "an axis' range is a list that begins with its minimum and maximum";
  const auto number = [&range](std::size_t i) {  // minimum, maximum, noise, flat, resolution
    return i < range->size() ? static_cast<std::int32_t>((*range)[i]) : 0;
  };
  return node().add_axis(
      {{*parse_number<std::uint16_t>(code), number(0), number(1)}, number(3), line_number});
}

// `[seconds, microseconds, type, code, value]`
Cause LibinputReader::event(std::string_view text) {
  const auto e = numbers_of(text);
  const bool is_sound = e && e->size() == 5 && is_within((*e)[0], 0, INT32_MAX) &&
                        is_within((*e)[1], 0, kSecond_us - 1) && is_word((*e)[2]) &&
                        is_word((*e)[3]) && is_value((*e)[4]);
  if (!is_sound) return "an event is a list of seconds, microseconds, type, code and value";
  return node().add_event({(*e)[0] * kSecond_us + (*e)[1], static_cast<std::uint16_t>((*e)[2]),
                           static_cast<std::uint16_t>((*e)[3]), static_cast<std::int32_t>((*e)[4])},
                          fmt::format("{}.{:06}", (*e)[0], (*e)[1]));
}

}  // namespace

bool is_libinput_record(std::string_view text) noexcept {
  return text.starts_with("# libinput record");
}

std::unique_ptr<EvdevReader> make_libinput_reader() { return std::make_unique<LibinputReader>(); }

}  // namespace gaitpad
