#include "hid/trace_lines.h"

#include <fmt/format.h>

#include <charconv>

#include "base/toml_file.h"

namespace gaitpad {

namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

template <class T>
std::optional<T> whole_number(std::string_view text, int base) {
  T value{};
  const char* end = text.data() + text.size();
  if (text.empty() || text.front() == '-') return std::nullopt;
  const auto [stop, error] = std::from_chars(text.data(), end, value, base);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

}  // namespace

void Words::skip_blanks() {
  const std::size_t at = rest_.find_first_not_of(" \t");
  rest_ = at == std::string_view::npos ? std::string_view{} : rest_.substr(at);
}

std::string_view Words::next() {
  skip_blanks();
  const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t"));
  rest_.remove_prefix(word.size());
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
  constexpr std::int64_t kMaxSeconds = 9'000'000'000;  // nanoseconds still fit
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

}  // namespace gaitpad
