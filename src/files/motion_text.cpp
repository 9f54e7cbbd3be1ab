#include "files/motion_text.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <fstream>

namespace gaitpad {

namespace {

constexpr std::uintmax_t kMaxFileBytes = 512u << 20;
constexpr double kMaxValue = 1e7;
constexpr std::size_t kMaxShownChars = 40;

std::string_view without_mark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // UTF-8 byte order mark
  return text;
}

}  // namespace

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
  return s;
}

std::string_view take_word(std::string_view& rest) {
  rest = trimmed(rest);
  std::size_t n = 0;
  while (n < rest.size() && !is_blank(rest[n])) ++n;
  const std::string_view word = rest.substr(0, n);
  rest = trimmed(rest.substr(n));
  return word;
}

std::string shown(std::string_view s) {
  std::string out;
  for (char c : s.substr(0, kMaxShownChars)) out += (c >= ' ' && c != 0x7f) ? c : '?';
  return s.size() > kMaxShownChars ? out + "..." : out;
}

std::string lower_case(std::string_view s) {
  std::string out(s);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

std::optional<double> text_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  if (code == std::errc::result_out_of_range) {  // 1e-400 is 0, 1e400 is an error
    const auto e = word.find_first_of("eE");
    const bool tiny = e != word.npos && word.substr(e + 1).starts_with('-');
    return tiny ? std::optional(0.0) : std::nullopt;
  }
  if (code != std::errc() || !(std::abs(value) <= kMaxValue)) return std::nullopt;
  return value;
}

Result<std::string> motion_file_text(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    return Error{fmt::format("{}: no such file", path)};
  }
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code || size > kMaxFileBytes) {
    return Error{fmt::format("{}: larger than {} MB", path, kMaxFileBytes >> 20)};
  }
  std::ifstream in(path, std::ios::binary);
  std::string text(size, '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(size))) {
    return Error{fmt::format("{}: cannot be read", path)};
  }
  return text;
}

namespace {

// Behind a # that begins the line or follows a blank.
std::string_view without_comment(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '#' && (i == 0 || is_blank(line[i - 1]))) return line.substr(0, i);
  }
  return line;
}

}  // namespace

LineReader::LineReader(std::string_view text) : rest_(without_mark(text)) {}

std::string_view LineReader::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    line = trimmed(without_comment(line));
    if (!line.empty()) return line;
  }
  return {};
}

}  // namespace gaitpad
