#include "base/text.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <locale>
#include <sstream>

#include "base/bits.h"
#include "base/ranges.h"

namespace gaitpad {

std::string_view trimmed(std::string_view text, std::string_view blanks) noexcept {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string_view without_byte_order_mark(std::string_view text) noexcept {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::string_view take_word(std::string_view& rest, std::string_view blanks) noexcept {
  rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(blanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string_view take_part(std::string_view& rest, char divider) noexcept {
  const std::string_view part = rest.substr(0, rest.find(divider));
  rest.remove_prefix(std::min(part.size() + 1, rest.size()));
  return part;
}

namespace {

#ifndef __cpp_lib_to_chars  // libc++ reads doubles by streams only
// Cuts digits off the beginning; false if there are none.
bool take_digits(std::string_view& rest) noexcept {
  const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
  rest.remove_prefix(digits);
  return digits > 0;
}

// Whether all of it is a number such as -1.5e-3, .5 or 2.
bool is_decimal(std::string_view text) noexcept {
  if (text.starts_with('-')) text.remove_prefix(1);
  bool has_digits = take_digits(text);
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    has_digits = take_digits(text) || has_digits;
  }
  if (has_digits && (text.starts_with('e') || text.starts_with('E'))) {
    text.remove_prefix(text.substr(1).starts_with('-') || text.substr(1).starts_with('+') ? 2 : 1);
    has_digits = take_digits(text);
  }
  return has_digits && text.empty();
}
#endif

// The number as a stream writes it in the C locale, whatever locale the program has.
std::string streamed(double value, std::ios_base::fmtflags format, int precision) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.setf(format, std::ios_base::floatfield);
  out.precision(precision);
  out << value;
  return out.str();
}

}  // namespace

std::optional<double> parse_bounded(std::string_view text) noexcept {
  constexpr double kMaxValue = 1e7;
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
#ifdef __cpp_lib_to_chars
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  if (text.empty() || read.ptr != end) return std::nullopt;
  if (read.ec == std::errc::result_out_of_range) {  // 1e-400 is 0, 1e400 is too large
    const std::size_t exponent = text.find_first_of("eE");
    const bool is_tiny = exponent != text.npos && text.substr(exponent + 1).starts_with('-');
    return is_tiny ? std::optional(0.0) : std::nullopt;
  }
  if (read.ec != std::errc()) return std::nullopt;
#else
  if (!is_decimal(text)) return std::nullopt;
  std::istringstream in{std::string(text)};
  in.imbue(std::locale::classic());
  in >> value;  // sets `value` also if the number is too small or too large for a double
#endif
  return std::abs(value) <= kMaxValue ? std::optional(value) : std::nullopt;
}

std::size_t character_bytes(std::string_view text) noexcept {
  if (text.empty()) return 0;
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
  const bool is_bad = (byte(0) == 0xe0 && byte(1) < 0xa0) || (byte(0) == 0xed && byte(1) > 0x9f) ||
                      (byte(0) == 0xf0 && byte(1) < 0x90) || (byte(0) == 0xf4 && byte(1) > 0x8f);
  return is_bad ? 0 : size;
}

std::size_t utf8_bytes(std::string_view text) noexcept {
  std::size_t place = 0;
  while (place < text.size()) {
    if (static_cast<unsigned char>(text[place]) < 0x80) {
      ++place;
      continue;
    }
    const std::size_t bytes = character_bytes(text.substr(place));
    if (bytes == 0) break;
    place += bytes;
  }
  return place;
}

namespace {

// The code point of a whole UTF-8 character.
std::uint32_t code_point(std::string_view character) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0);
  std::uint32_t code = byte(0) & (0x7fu >> character.size());
  for (std::size_t i = 1; i < character.size(); ++i) code = code << 6 | (byte(i) & 0x3fu);
  return code;
}

// False for characters that control a terminal or change the display order of text.
bool is_shown(std::uint32_t code) noexcept {
  const auto is_within = [code](std::uint32_t first, std::uint32_t last) {
    return code >= first && code <= last;
  };
  return !is_within(0, 0x1f) && !is_within(0x7f, 0x9f) && code != 0x61c &&
         !is_within(0x200e, 0x200f) && !is_within(0x2028, 0x202e) && !is_within(0x2066, 0x2069) &&
         code != 0xfeff;
}

}  // namespace

std::string printable(std::string_view text) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string line;
  const auto escape = [&line](char letter, std::uint32_t number, int digits) {
    line += '\\';
    line += letter;
    while (digits-- > 0) line += kDigits[number >> (4 * digits) & 0xf];
  };
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
    const std::uint32_t code =
        bytes == 0 ? static_cast<unsigned char>(text[0]) : code_point(character);
    if (bytes == 0 || (bytes == 1 && !is_shown(code)))
      escape('x', code, 2);
    else if (!is_shown(code))
      escape('u', code, 4);
    else
      line += character;
    text.remove_prefix(character.size());
  }
  return line;
}

std::string printable_lines(std::string_view text) {
  std::string lines;
  while (!text.empty()) {
    const bool has_end = text.find('\n') != std::string_view::npos;
    lines += printable(take_line(text));
    if (has_end) lines += '\n';
  }
  return lines;
}

std::string in_quotes(std::string_view text) {
  const bool is_cut = text.size() > kMaxQuotedBytes;
  std::size_t size = std::min(text.size(), kMaxQuotedBytes);
  // Do not cut inside a character.
  while (is_cut && size > kMaxQuotedBytes - 3 &&
         (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80)
    --size;
  return "\"" + printable(text.substr(0, size)) + (is_cut ? "...\"" : "\"");
}

namespace {

constexpr int kMostShortDecimals = 9;
constexpr double kShortBelow = 1e9;  // times 10^9 it fits in 64 bits
constexpr std::array<std::uint64_t, kMostShortDecimals + 1> kPowersOfTen = {
    1, 10, 100, 1000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000, 1'000'000'000};

// |value| times 10^decimals, rounded to the nearest integer, ties to even. The product of the
// 53-bit significand and the power of ten has at most 83 bits; it is held exactly in two words, the
// lower one of 32 bits, until it is rounded.
std::uint64_t scaled_exactly(double value, int decimals) noexcept {
  constexpr int kSignificand = 52, kBias = 1023 + kSignificand;
  constexpr std::uint64_t kLower = 0xffffffff;
  const auto bits = bits_as<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> kSignificand & 0x7ff);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << kSignificand) - 1);
  const std::uint64_t significand =
      biased == 0 ? fraction : fraction | std::uint64_t{1} << kSignificand;
  // A shift of at least 23, since the value is below 1e9.
  const int shift = kBias - std::max(biased, 1);
  if (shift > 84) return 0;  // less than half a unit: rounds to 0
  const std::uint64_t power = kPowersOfTen[decimals], lower = (significand & kLower) * power;
  const std::uint64_t upper = (significand >> 32) * power + (lower >> 32);
  const std::uint64_t halves =
      shift > 32 ? upper >> (shift - 33) : upper << (33 - shift) | (lower & kLower) >> (shift - 1);
  const std::uint64_t whole = halves >> 1;
  // 10^decimals has `decimals` trailing zero bits.
  const bool is_beyond_half = std::countr_zero(significand) + decimals < shift - 1;
  return whole + ((halves & 1) == 1 && (is_beyond_half || whole % 2 == 1));
}

// Scales by doubles, if that is exact: a product below 2^40 is off by at most 2^-14, which matters
// only near a tie.
[[gnu::always_inline]] inline std::uint64_t scaled(double value, int decimals) noexcept {
  constexpr double kMostProduct = 1099511627776.0, kNearTie = 1.0 / 4096.0;
  constexpr double kWholes = 4503599627370496.0;  // 2^52: from here on doubles are whole numbers
  const auto power = static_cast<std::int64_t>(kPowersOfTen[decimals]);  // quick to convert
  const double product = std::abs(value) * static_cast<double>(power),
               whole = product + kWholes - kWholes;
  if (!(product < kMostProduct && std::abs(product - whole) < 0.5 - kNearTie))
    return scaled_exactly(value, decimals);
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(whole));
}

// Writes the eight digits of a number below 10^8. Each step halves all groups of digits at once:
// one of eight, two of four, four of two, eight of one. The first half of a group is in its lower
// bits. v / 100 is v * 10486 / 2^20 up to 9999, v / 10 is v * 103 / 2^10 up to 99.
void put_eight_digits(std::uint64_t number, char* out) noexcept {
  const std::uint64_t fours = number / 10'000 | number % 10'000 << 32;
  const std::uint64_t hundreds = fours * 10'486 >> 20 & 0x7f'0000'007f;
  const std::uint64_t twos = hundreds | (fours - 100 * hundreds) << 16;
  const std::uint64_t tens = twos * 103 >> 10 & 0xf'000f'000f'000f;
  const std::uint64_t ones = (tens | (twos - 10 * tens) << 8) + 0x3030'3030'3030'3030;
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) out[i] = static_cast<char>(ones >> 8 * i);
}

[[gnu::always_inline]] inline char* put_number(char* out, double value, int decimals) {
  if (!(std::abs(value) < kShortBelow)) {
    const std::string text = streamed(value, std::ios_base::fixed, decimals);
    return std::copy(text.begin(), text.end(), out);
  }
  *out = '-';
  out += std::signbit(value);
  if (value == 0.0) {  // as a quarter of the numbers in frames.csv are
    std::copy_n("0.000000000", 11, out);
    return out + (decimals == 0 ? 1 : 2 + decimals);
  }
  const std::uint64_t power = kPowersOfTen[decimals];
  auto whole = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::abs(value)));
  std::uint64_t fraction = scaled(value, decimals) - whole * power;
  if (fraction == power) {  // rounded up to the next whole number
    ++whole;
    fraction = 0;
  }
  char* point = out + 1;
  for (std::uint64_t bound = 10; whole >= bound; bound *= 10) ++point;
  char* digit = point;
  for (; whole >= 10; whole /= 10) *--digit = static_cast<char>('0' + whole % 10);
  *out = static_cast<char>('0' + whole);
  if (decimals == 0) return point;
  *point++ = '.';
  constexpr int kEight = 8;
  if (decimals > kEight) {
    *point++ = static_cast<char>('0' + fraction / kPowersOfTen[kEight]);
    fraction %= kPowersOfTen[kEight];
    --decimals;
  }
  // Eight digits are written; those behind the last decimal are zeros and do not count.
  put_eight_digits(fraction * kPowersOfTen[kEight - decimals], point);
  return point + decimals;
}

}  // namespace

char* put_fixed(char* out, double value, int decimals) {
  assert(decimals >= 0 && decimals <= kMostShortDecimals);
  switch (decimals) {  // the numbers of angles and lengths take a fifth less where it is known
    case 7:
      return put_number(out, value, 7);
    case 9:
      return put_number(out, value, 9);
    default:
      return put_number(out, value, decimals);
  }
}

std::string fixed(double value, int decimals) {
  if (decimals < 0 || decimals > kMostShortDecimals)
    return streamed(value, std::ios_base::fixed, std::clamp(decimals, 0, 100));
  std::array<char, kMostFixedBytes> text;
  return {text.data(), put_fixed(text.data(), value, decimals)};
}

std::string short_number(double value) { return streamed(value, {}, 6); }

}  // namespace gaitpad
