#include <gtest/gtest.h>

#include "files/toml_file.h"

namespace gaitpad {
namespace {

TEST(TomlScan, InvalidUtf8IsFoundOnItsLine) {
  using namespace std::string_view_literals;
  EXPECT_EQ(line_of_invalid_utf8("a = '\u00e9\u20ac\U0001f6b6'\n"), 0);
  for (const auto bad : {"\x80"sv, "\xc0\x80"sv, "\xc3"sv, "\xc3("sv, "\xe0\x80\x80"sv,
                         "\xed\xa0\x80"sv, "\xf0\x80\x80\x80"sv, "\xf4\x90\x80\x80"sv, "\xff"sv}) {
    EXPECT_EQ(line_of_invalid_utf8("a\nb\n" + std::string(bad)), 3);
  }
}

TEST(TomlScan, StrayCharactersAreFoundOutsideStringsAndComments) {
  const std::string mark = "\ufeff";
  EXPECT_EQ(line_of_stray_character(mark + "a = '\u00e9' # \u00e9\nb = \"\u00e9\""), 0);
  EXPECT_EQ(line_of_stray_character("a = 1\n\u00e9 = 2\n"), 2);
  EXPECT_EQ(line_of_stray_character("\n\nk\ufef7ind = 1"), 3);
}

TEST(TomlScan, KeyPartsAreCountedFromDotsOutsideStringsAndComments) {
  const std::string many = "a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a";
  EXPECT_EQ(line_of_overlong_key("\n" + many + " = 1"), 2);
  EXPECT_EQ(line_of_overlong_key("x = \"" + many + "\" # " + many), 0);
  EXPECT_EQ(line_of_overlong_key("x = \"\\\"" + many + "\"\n" + many), 2);
  EXPECT_EQ(line_of_overlong_key("x = '\\'\n" + many), 2);
  EXPECT_EQ(line_of_overlong_key("x = '''" + many + "'''''\n" + many), 2);
  EXPECT_EQ(line_of_overlong_key("x = \"\"\"\n\\\"\"\"" + many), 0);
}

}  // namespace
}  // namespace gaitpad
