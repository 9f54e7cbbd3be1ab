// Text from files, devices and users: splits it, parses numbers and makes it printable. Uses the
// standard library only and does not depend on the locale.
#pragma once
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

namespace gaitpad {

// Blanks inside a line; the end of the line is not one of them.
inline constexpr std::string_view kBlanks = " \t\r\f\v";
constexpr bool is_blank(char c) noexcept { return kBlanks.find(c) != kBlanks.npos; }

// The text without the blanks at both ends.
std::string_view trimmed(std::string_view text, std::string_view blanks = kBlanks) noexcept;
// ASCII letters in lower case; all other bytes stay.
std::string lower_case(std::string_view text);
// The text without a UTF-8 byte order mark at its beginning.
std::string_view without_byte_order_mark(std::string_view text) noexcept;

// Removes the first word, and the blanks before it, from `rest` and returns the word; empty at the
// end.
std::string_view take_word(std::string_view& rest, std::string_view blanks = kBlanks) noexcept;
// Removes the text before the first `divider`, and the divider, from `rest` and returns the text;
// without a divider all of `rest`.
std::string_view take_part(std::string_view& rest, char divider) noexcept;
// Cuts off the first line, and its '\n'.
inline std::string_view take_line(std::string_view& rest) noexcept { return take_part(rest, '\n'); }

// Cuts a number off the beginning of `rest`, in the format of std::from_chars: no leading blank or
// '+', no 0x. Returns nothing and keeps `rest` if there is none or T cannot hold it.
template <class T>
std::optional<T> take_number(std::string_view& rest, int base = 10) noexcept {
  T value{};
  const char* end = rest.data() + rest.size();
  std::from_chars_result read{};
  if constexpr (std::is_floating_point_v<T>) {
    read = std::from_chars(rest.data(), end, value);
  } else {
    read = std::from_chars(rest.data(), end, value, base);
  }
  if (read.ec != std::errc()) return std::nullopt;
  rest.remove_prefix(static_cast<std::size_t>(read.ptr - rest.data()));
  return value;
}
// The whole text as a number, otherwise nothing.
template <class T>
std::optional<T> parse_number(std::string_view text, int base = 10) noexcept {
  const std::optional<T> value = take_number<T>(text, base);
  return text.empty() ? value : std::nullopt;
}
// The whole text as a number within +-1e7, so that all later arithmetic is finite. It may begin
// with '+'; a number too small for a double is 0. Nothing for `nan`, `inf` and larger numbers.
std::optional<double> parse_bounded(std::string_view text) noexcept;

// Length in bytes of the UTF-8 character at the beginning of the text, 0 if there is no valid one.
// Overlong forms, surrogates and code points beyond U+10FFFF are invalid.
std::size_t character_bytes(std::string_view text) noexcept;
// Length in bytes of the text's longest valid UTF-8 prefix.
std::size_t utf8_bytes(std::string_view text) noexcept;
inline bool is_utf8(std::string_view text) noexcept { return utf8_bytes(text) == text.size(); }

// The text for one line of output. All foreign text (names of devices and files, contents of files,
// user input) passes through this before a terminal: control characters including C1, characters
// that change the direction of text, and invalid UTF-8 are escaped as \x1b or \u202e.
std::string printable(std::string_view text);
// Makes several lines printable; keeps their '\n'.
std::string printable_lines(std::string_view text);
// The text in double quotes for an error sentence: printable, of at most 60 bytes, then "...".
inline constexpr std::size_t kMaxQuotedBytes = 60;
std::string in_quotes(std::string_view text);
// The value with `decimals` digits after the point, as printf's %.*f writes it in the C locale.
std::string fixed(double value, int decimals);
// The same for 0 to 9 decimals, written to a buffer with room for kMostFixedBytes; returns the end.
// Takes a few nanoseconds for values below 1e9.
inline constexpr std::size_t kMostFixedBytes = 320;  // sign, 309 digits, point, 9 digits
char* put_fixed(char* out, double value, int decimals);

}  // namespace gaitpad
