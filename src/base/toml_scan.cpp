#include "base/toml_scan.h"

#include <algorithm>
#include <cstddef>

namespace gaitpad {

namespace {

// The place behind the string that begins at `begin` (a quote), or the end of the text.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const char three[] = {quote, quote, quote};
  const bool is_long = text.substr(begin, 3) == std::string_view(three, 3);
  const std::string_view closing(three, is_long ? 3 : 1);
  std::size_t i = begin + closing.size();
  for (; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text.substr(i, closing.size()) == closing) {
      i += closing.size();
      break;
    } else if (text[i] == '\n' && !is_long) {
      break;
    }
  }
  // A long string may end in up to two quotes of its own before the closing three.
  for (int n = 0; n < 2 && is_long && i < text.size() && text[i] == quote; ++n) ++i;
  return std::min(i, text.size());
}

// Bytes of the UTF-8 character at the front of a non-empty text; 0 where it is none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t size = byte(0) >= 0xf5   ? 0
                           : byte(0) >= 0xf0 ? 4
                           : byte(0) >= 0xe0 ? 3
                           : byte(0) >= 0xc2 ? 2
                                             : 0;
  if (size == 0 || text.size() < size) return 0;
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // Overlong forms, surrogates, beyond U+10FFFF.
  const bool is_bad = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
                      (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f);
  return is_bad ? 0 : size;
}

int line_at(std::string_view text, std::size_t place) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + place, '\n'));
}

// Of the first byte outside strings and comments that `is_wanted`; 0 where there is none.
template <class Wanted>
int first_line(std::string_view text, Wanted is_wanted) {
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
    } else {
      if (is_wanted(c)) return line_at(text, i);
      ++i;
    }
  }
  return 0;
}

}  // namespace

int line_of_overlong_key(std::string_view text) {
  constexpr std::string_view kEndsOfKeys = ",[]{}=\n";
  int dots = 0;
  return first_line(text, [&](char c) {
    if (kEndsOfKeys.find(c) != std::string_view::npos) dots = 0;
    return c == '.' && ++dots >= kMaxKeyParts;
  });
}

int line_of_stray_character(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return first_line(text, [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
}

int line_of_invalid_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = character_bytes(text.substr(i));
    if (bytes == 0) return line_at(text, i);
    i += bytes;
  }
  return 0;
}

}  // namespace gaitpad
