#include "base/text.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>

namespace gaitpad {
namespace {

TEST(Text, WordsAndPartsAreCutOffInTheirOrder) {
  std::string_view rest = " \tfirst  second\r";
  EXPECT_EQ(take_word(rest), "first");
  EXPECT_EQ(take_word(rest), "second");
  EXPECT_EQ(take_word(rest), "");
  rest = "a,,b";
  EXPECT_EQ(take_part(rest, ','), "a");
  EXPECT_EQ(take_part(rest, ','), "");
  EXPECT_EQ(take_part(rest, ','), "b");
  EXPECT_TRUE(rest.empty());
  EXPECT_EQ(trimmed(" \t a b \r"), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
}

TEST(Text, ANumberIsTheWholeTextOrNothing) {
  EXPECT_EQ(parse_number<int>("-12"), -12);
  EXPECT_EQ(parse_number<std::uint16_t>("ffff", 16), 0xffff);
  EXPECT_EQ(parse_number<double>("0.5"), 0.5);
  for (const char* text : {"", " 1", "1 ", "+1", "0x1", "65536", "-1", "1.5"})
    EXPECT_FALSE(parse_number<std::uint16_t>(text)) << text;
  std::string_view rest = "125us";
  EXPECT_EQ(take_number<double>(rest), 125.0);
  EXPECT_EQ(rest, "us");
  EXPECT_FALSE(take_number<double>(rest));
  EXPECT_EQ(rest, "us");
}

TEST(Text, ABoundedNumberIsFinite) {
  EXPECT_EQ(parse_bounded("+1e7"), 1e7);
  EXPECT_EQ(parse_bounded("1e-400"), 0.0);
  for (const char* text : {"", "+", "nan", "inf", "1e400", "1.1e7", "1 2"})
    EXPECT_FALSE(parse_bounded(text)) << text;
}

TEST(Text, Utf8IsWholeCharacters) {
  EXPECT_TRUE(is_utf8("a\xc3\xa4\xe2\x82\xac\xf0\x9f\x8e\xae"));
  EXPECT_EQ(utf8_bytes("ab\xff"), 2u);
  for (const char* text : {"\x80", "\xc3", "\xc0\x80", "\xe0\x80\x80", "\xed\xa0\x80",
                           "\xf4\x90\x80\x80", "\xf5\x80\x80\x80"})
    EXPECT_EQ(character_bytes(text), 0u);
}

TEST(Text, AQuoteIsPrintableAndShort) {
  EXPECT_EQ(in_quotes("a\tb"), "\"a\\x09b\"");
  EXPECT_EQ(in_quotes(std::string(61, 'x')), "\"" + std::string(60, 'x') + "...\"");
  EXPECT_EQ(lower_case("Left\xc3\x84"), "left\xc3\x84");
}

TEST(Text, NothingThatCommandsATerminalIsPrintable) {
  EXPECT_EQ(printable("\x1b[31m\x7f"), "\\x1b[31m\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J \xc2\xa0"),
            "\\u009b2J \xc2\xa0")
      << "C1";
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "a\xe2\x81\xa6\xd8\x9c\xef\xbb\xbf"),
            "\\u202ea\\u2066\\u061c\\ufeff")
      << "directions";
  EXPECT_EQ(printable("\xe2\x80\xa8"), "\\u2028") << "line separator";
  EXPECT_EQ(printable("\x9b\xff\xc3"), "\\x9b\\xff\\xc3") << "no UTF-8";
  EXPECT_EQ(printable("\xc3\xa4\xe2\x82\xac\xf0\x9f\x8e\xae\\"),
            "\xc3\xa4\xe2\x82\xac\xf0\x9f\x8e\xae\\");
  EXPECT_EQ(printable(printable("\x1b")), printable("\x1b"));
  EXPECT_EQ(printable_lines("a\x07\n\nb"), "a\\x07\n\nb");
  std::string quoted;
  for (int i = 0; i < 21; ++i) quoted += "\xe2\x82\xac";
  EXPECT_EQ(in_quotes("x" + quoted), "\"x" + quoted.substr(0, 57) + "...\"");
}

// Printable text is valid UTF-8 without control characters, C1 or direction marks.
TEST(Text, RandomBytesArePrintable) {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string text;
    for (int k = 0; k < 40; ++k) text += static_cast<char>(random() % 3 == 0 ? 0xe2 : random());
    const std::string shown = printable(text);
    EXPECT_TRUE(is_utf8(shown));
    for (std::size_t at = 0; at < shown.size(); ++at) {
      const auto byte = static_cast<unsigned char>(shown[at]);
      EXPECT_FALSE(byte < 0x20 || byte == 0x7f);
      if (byte == 0xc2 && at + 1 < shown.size()) {
        EXPECT_GE(static_cast<unsigned char>(shown[at + 1]), 0xa0);
      }
    }
    EXPECT_EQ(shown.find("\xe2\x80\xae"), std::string::npos);
  }
}

TEST(Text, FixedDigitsAreThoseOfPrintf) {
  std::mt19937_64 random(3);
  std::array<char, 512> digits;
  const auto expect_same = [&](double value) {
    for (const int decimals : {0, 1, 3, 7, 8, 9, 12}) {
      std::snprintf(digits.data(), digits.size(), "%.*f", decimals, value);
      EXPECT_EQ(fixed(value, decimals), digits.data());
    }
  };
  for (int i = 0; i < 1000; ++i)
    expect_same((std::generate_canonical<double, 53>(random) - 0.5) * std::pow(10.0, i % 12));
  for (const double value :
       {0.0, -0.0, 0.5, 2.5, -0.0005, 1e300, -1.7976931348623157e308, 1e-10, -1e-10, 5e-324,
        4.9999999999e-10, 9.9999999995, 999999999.9999999, 1e9, 1e-30})
    expect_same(value);
  // Numbers exactly between two roundings have few binary digits after the point.
  for (int i = 0; i < 2000; ++i)
    expect_same(std::ldexp(static_cast<double>(random() % 100'000) - 50'000.0, -(i % 30)));
  for (int i = 0; i < 1000; ++i)  // numbers next to a decimal
    expect_same(
        std::nextafter(static_cast<double>(random() % 1'000'000) * 5e-10, i % 2 ? 0.0 : 1.0));
}

}  // namespace
}  // namespace gaitpad
