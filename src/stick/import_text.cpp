#include "stick/import_text.h"

#include <fmt/format.h>

#include <charconv>

#include "base/toml_file.h"
#include "hid/trace_lines.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxTextBytes = 1 << 20;
constexpr std::size_t kMaxMappings = 65536;
constexpr int kMaxAxes = 64;  // ABS_CNT
constexpr std::uint32_t kLastCode = 0x3f;

// What is wrong with a line; empty: nothing.
using Problem = std::string;

std::optional<std::int32_t> number(std::string_view text) {
  std::int32_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string_view next_part(std::string_view& rest, char divider) {
  const std::string_view part = rest.substr(0, rest.find(divider));
  rest.remove_prefix(std::min(rest.size(), part.size() + 1));
  return part;
}

// `6,1,0,127,...`: numbers with commas between, to the end.
Problem read_list(std::string_view text, std::vector<std::int32_t>& list) {
  constexpr std::size_t kMaxNumbers = 2048;
  while (!text.empty()) {
    const std::string_view part = next_part(text, ',');
    const auto value = number(part);
    if (!value) return fmt::format("jscal: {} is no number", in_quotes(part));
    if (list.size() >= kMaxNumbers) return fmt::format("jscal: more than {} numbers", kMaxNumbers);
    list.push_back(*value);
  }
  if (list.empty()) return "jscal: no numbers";
  if (list[0] < 1 || list[0] > kMaxAxes) {
    return fmt::format("jscal: {} axes, 1 to {} there may be", list[0], kMaxAxes);
  }
  return {};
}

// joydev's broken line (Linux drivers/input/joydev.c): 0 from c[0] to c[1], from there on slopes
// c[2] and c[3] of 1/16384, cut at +-32767.
Problem read_broken_line(std::size_t index, const std::int32_t* c, JscalAxis& axis) {
  constexpr double kFull = 32767.0 * 16384.0;
  if (c[0] > c[1]) {
    return fmt::format("jscal: axis {}: its centre begins at {} and ends at {}", index, c[0], c[1]);
  }
  if (c[2] == 0 || c[3] == 0 || (c[2] < 0) != (c[3] < 0)) {
    return fmt::format("jscal: axis {}: slopes {} and {} do not go one way", index, c[2], c[3]);
  }
  axis.is_corrected = true;
  axis.reversed = c[2] < 0;
  axis.low = c[0];
  axis.high = c[1];
  axis.min = axis.low - kFull / std::abs(static_cast<double>(c[2]));
  axis.max = axis.high + kFull / std::abs(static_cast<double>(c[3]));
  return {};
}

// For each axis type, precision and the type's coefficients: none of 0, four of 1.
Problem read_correction(std::string_view text, JscalText& jscal) {
  constexpr std::size_t kHead = 2, kCoefficients = 4;
  std::vector<std::int32_t> list;
  if (Problem problem = read_list(text, list); !problem.empty()) return problem;
  std::size_t at = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(list[0]); ++i) {
    JscalAxis axis;
    const std::int32_t type = at < list.size() ? list[at] : 0;
    if (type != 0 && type != 1) return fmt::format("jscal: axis {}: unknown type {}", i, type);
    const std::size_t size = kHead + (type == 1 ? kCoefficients : 0);
    if (at + size > list.size()) return fmt::format("jscal: axis {}: numbers are missing", i);
    if (type == 1) {
      Problem problem = read_broken_line(i, list.data() + at + kHead, axis);
      if (!problem.empty()) return problem;
    }
    at += size;
    jscal.axes.push_back(axis);
  }
  return at == list.size() ? Problem() : "jscal: more numbers than its axes have";
}

// The codes of the axes, then the buttons.
Problem read_axis_map(std::string_view text, JscalText& jscal) {
  std::vector<std::int32_t> list;
  if (Problem problem = read_list(text, list); !problem.empty()) return problem;
  if (list.size() <= static_cast<std::size_t>(list[0])) return "jscal: codes of axes are missing";
  for (int i = 1; i <= list[0]; ++i) {
    const std::int32_t code = list[static_cast<std::size_t>(i)];
    if (code < 0 || code > static_cast<std::int32_t>(kLastCode)) {
      return fmt::format("jscal: {} is no code of an axis", code);
    }
    jscal.codes.push_back(static_cast<std::uint16_t>(code));
  }
  return {};
}

class Reader {
 public:
  Problem read(std::string_view line, int number) {
    line_ = number;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return {};
    if (is_jscal(line)) return read_jscal(line);
    if (line.starts_with("A:")) return read_evemu(line.substr(2));
    if (line.starts_with("I:")) return read_ids(line.substr(2));
    if (line.starts_with("EVDEV_ABS_")) return read_hwdb(line.substr(10));
    if (line.starts_with("Event ")) return begin_evtest(line);
    if (is_mapping(line)) return add_mapping(line);
    return evtest_ ? read_evtest(line) : Problem();
  }
  ImportText take() { return std::move(text_); }

 private:
  static bool is_jscal(std::string_view line) {
    Words words(line);
    const std::string_view program = words.next();
    return program == "jscal" || program.ends_with("/jscal");
  }
  static bool is_mapping(std::string_view line) {
    constexpr std::size_t kDigits = 32;
    return line.size() > kDigits && line[kDigits] == ',' &&
           line.find_first_not_of("0123456789abcdefABCDEF") == kDigits;
  }

  // `jscal -s 2,1,0,... /dev/input/js0`; anything but the two options that set is skipped.
  Problem read_jscal(std::string_view line) {
    Words words(line);
    words.next();
    while (!words.at_end()) {
      const std::string_view word = words.next();
      const bool is_map = word == "-u" || word == "--set-mappings";
      if (!is_map && word != "-s" && word != "--set-correction") continue;
      if (is_map ? !text_.jscal.codes.empty() : text_.jscal.line != 0) {
        return "jscal: told a second time";
      }
      const std::string_view list = words.next();
      if (is_map) return read_axis_map(list, text_.jscal);
      text_.jscal.line = line_;
      return read_correction(list, text_.jscal);
    }
    return {};
  }

  Problem begin_axis(std::uint32_t code, AbsInfo*& axis) {
    const auto [it, is_new] = text_.axes.try_emplace(static_cast<std::uint16_t>(code));
    if (!is_new) return fmt::format("axis {:02x}: told a second time", code);
    it->second.line = line_;
    axis = &it->second;
    return {};
  }

  // `A: 00 0 255 0 15 0`: code, minimum, maximum, fuzz, flat, and since its version 1.1 resolution.
  Problem read_evemu(std::string_view rest) {
    Words words(rest);
    const std::string_view word = words.next();
    const auto code = hexadecimal(word, kLastCode);
    if (!code) return fmt::format("{} is no code of an axis", in_quotes(word));
    std::optional<std::int32_t> numbers[4];
    for (auto& n : numbers) {
      const std::string_view text = words.next();
      n = number(text);
      if (!n) return fmt::format("axis {:02x}: {} is no number", *code, in_quotes(text));
    }
    AbsInfo* axis = nullptr;
    if (Problem problem = begin_axis(*code, axis); !problem.empty()) return problem;
    axis->min = numbers[0];
    axis->max = numbers[1];
    axis->flat = numbers[3];
    return {};
  }

  // `I: 0003 054c 0ce6 8111`: bus, vendor, product, version.
  Problem read_ids(std::string_view rest) {
    Words words(rest);
    words.next();
    const auto vendor = hexadecimal(words.next(), 0xffff),
               product = hexadecimal(words.next(), 0xffff),
               version = hexadecimal(words.next(), 0xffff);
    if (!vendor || !product || !version) return {};  // not evemu's
    text_.ids = *vendor << 16 | *product;
    text_.version = static_cast<std::uint16_t>(*version);
    return {};
  }

  // `00=0:255:0:0:15`: minimum, maximum, resolution, fuzz, flat; any may be left out.
  Problem read_hwdb(std::string_view rest) {
    const std::string_view word = next_part(rest, '=');
    const auto code = hexadecimal(word, kLastCode);
    if (!code) return fmt::format("EVDEV_ABS_{}: no code of an axis", in_quotes(word));
    std::optional<std::int32_t> numbers[5];
    for (auto& n : numbers) {
      const std::string_view part = trimmed(next_part(rest, ':'));
      n = number(part);
      if (!n && !part.empty()) {
        return fmt::format("EVDEV_ABS_{:02x}: {} is no number", *code, in_quotes(part));
      }
    }
    if (!rest.empty()) return fmt::format("EVDEV_ABS_{:02x}: more than five numbers", *code);
    AbsInfo* axis = nullptr;
    if (Problem problem = begin_axis(*code, axis); !problem.empty()) return problem;
    axis->min = numbers[0];
    axis->max = numbers[1];
    axis->flat = numbers[4];
    return {};
  }

  // `Event code 0 (ABS_X)`; `Event type` and other codes end what is told of an axis.
  Problem begin_evtest(std::string_view line) {
    evtest_ = nullptr;
    Words words(line);
    words.next();
    if (words.next() != "code") return {};
    const auto code = decimal(words.next(), kLastCode);
    if (!code || !words.next().starts_with("(ABS_")) return {};
    return begin_axis(static_cast<std::uint32_t>(*code), evtest_);
  }
  // `Min  0`
  Problem read_evtest(std::string_view line) {
    Words words(line);
    const std::string_view key = words.next(), text = words.next();
    std::optional<std::int32_t>* value = key == "Min"    ? &evtest_->min
                                         : key == "Max"  ? &evtest_->max
                                         : key == "Flat" ? &evtest_->flat
                                                         : nullptr;
    if (value == nullptr) return {};
    *value = number(text);
    return *value ? Problem() : fmt::format("{}: {} is no number", key, in_quotes(text));
  }

  Problem add_mapping(std::string_view line) {
    if (text_.mappings.size() >= kMaxMappings) {
      return fmt::format("more than {} mappings", kMaxMappings);
    }
    text_.mappings.push_back({line_, std::string(line)});
    return {};
  }

  ImportText text_;
  AbsInfo* evtest_ = nullptr;  // the axis of which evtest's lines tell
  int line_ = 0;
};

}  // namespace

Result<ImportText> import_text(std::string_view text, const std::string& source) {
  if (text.size() > kMaxTextBytes) {
    return Error{
        fmt::format("{}: {} bytes, at most {} are read", source, text.size(), kMaxTextBytes)};
  }
  Reader reader;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = next_part(text, '\n');
    const Problem problem = reader.read(line, number);
    if (!problem.empty()) return Error{fmt::format("{}:{}: {}", source, number, problem)};
  }
  ImportText told = reader.take();
  const int kinds = (told.jscal.line != 0) + !told.axes.empty() + !told.mappings.empty();
  if (kinds == 0) {
    return Error{source +
                 ": no line of jscal, no axis of evemu, evtest or a hwdb file, no SDL mapping"};
  }
  if (kinds > 1) return Error{source + ": of several tools; give one at a time"};
  return told;
}

}  // namespace gaitpad
