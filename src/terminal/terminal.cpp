#include "terminal/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "system/descriptors.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxTypedBytes = 256;
constexpr char kEscape = 0x1b, kEndOfInput = 0x04;
constexpr int kMaxEscapeBytes = 16;

}  // namespace

// Reads only one byte: later bytes may be for the next reader.
std::optional<char> TerminalKeys::byte() {
  if (is_at_end_) return std::nullopt;
  char value = 0;
  const auto count = read_ready(0, {&value, 1});
  if (count == 0u) is_at_end_ = true;
  return count == 1u ? std::optional(value) : std::nullopt;
}

std::optional<char> TerminalKeys::take_key() {
  while (const std::optional<char> next = byte()) {
    if (!mode_.is_terminal() && *next != '\n') {
      if (line_.size() < kMaxTypedBytes && *next != '\r') line_ += *next;
      continue;
    }
    if (!mode_.is_terminal()) {
      const std::string line = std::exchange(line_, {});
      return line.empty() ? '\n' : line.front();
    }
    if (*next == kEndOfInput) is_at_end_ = true;
    for (int i = 0; *next == kEscape && i < kMaxEscapeBytes && byte(); ++i) continue;
    if (*next != kEscape && *next != kEndOfInput) return *next == '\r' ? '\n' : *next;
  }
  if (!is_at_end_ || line_.empty()) return std::nullopt;
  // The rest of the input, a last line without a line break.
  return std::exchange(line_, {}).front();
}

ScreenSize screen_size() noexcept {
  const auto size = terminal_size(2);
  if (!size || size->columns < 2 || size->rows < 2) return {};
  return {size->columns - 1, size->rows};
}

std::optional<std::size_t> terminal_columns(int descriptor) noexcept {
  const auto size = terminal_size(descriptor);
  if (!size || size->columns == 0) return std::nullopt;
  return size->columns;
}

namespace {

// Number of bytes of the first `count` characters.
std::size_t bytes_of(std::string_view text, std::size_t count) {
  std::size_t at = 0;
  for (; at < text.size() && count > 0; --count)
    at += std::max<std::size_t>(character_bytes(text.substr(at)), 1);
  return std::min(at, text.size());
}

// Removes and returns the first line of at most `width` characters. A longer word is broken after a
// comma, or else anywhere.
std::string_view take_fitting(std::string_view& rest, std::size_t width) {
  const std::size_t most = bytes_of(rest, std::max<std::size_t>(width, 1));
  std::size_t end = most;
  if (most < rest.size()) {
    const std::size_t blank = rest.rfind(' ', most);
    const std::size_t comma = most > 0 ? rest.rfind(',', most - 1) : std::string_view::npos;
    if (blank != std::string_view::npos && blank > 0) {
      end = blank;
    } else if (comma != std::string_view::npos) {
      end = comma + 1;
    }
  }
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end);
  if (rest.starts_with(' ')) rest.remove_prefix(1);
  return line;
}

// Start of the last column in the left half of the width; 2 if the line has no columns.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  std::size_t indent = 0;
  for (std::size_t i = 2; i < line.size() && i <= width / 2; ++i) {
    if (line[i] != ' ' && line[i - 1] == ' ' && line[i - 2] == ' ') indent = i;
  }
  return indent > 0 ? indent : std::min<std::size_t>(2, width / 2);
}

}  // namespace

std::vector<std::string> wrapped_lines(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::string_view rest = text;
  do {
    lines.emplace_back(take_fitting(rest, width));
  } while (!rest.empty());
  return lines;
}

std::string fitted(std::string_view text, std::size_t width) {
  std::string all;
  while (!text.empty()) {
    const bool is_whole = text.find('\n') != std::string_view::npos;
    std::string_view line = take_line(text);
    const std::size_t indent = hanging_indent(line, width);
    // Do not break at the blanks before the first word.
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t lead = std::min(begin, width / 2);
    all.append(lead, ' ');
    line.remove_prefix(begin);
    all += take_fitting(line, width - lead);
    while (!line.empty()) {
      line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
      all.append("\n").append(indent, ' ');
      all += take_fitting(line, width - indent);
    }
    if (is_whole) all += '\n';
  }
  return all;
}

std::string table_text(const std::vector<TableRow>& table) {
  if (table.empty()) return "";
  std::vector<std::size_t> widths(table.front().size(), 0);
  for (const TableRow& row : table) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const TableRow& row : table) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += fmt::format("{:<{}}  ", row[c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += printable(line) + "\n";
  }
  return text;
}

}  // namespace gaitpad
