#include "terminal/terminal.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

using Lines = std::vector<std::string>;

TEST(Terminal, LinesBreakAtBlanksAndAWordThatIsTooLongIsCut) {
  EXPECT_EQ(wrapped_lines("push the left stick", 9), (Lines{"push the", "left", "stick"}));
  EXPECT_EQ(wrapped_lines("push", 9), (Lines{"push"}));
  EXPECT_EQ(wrapped_lines("an unbreakable word", 6), (Lines{"an", "unbrea", "kable", "word"}));
}

TEST(Terminal, ATableKeepsItsColumnWhereALineIsBroken) {
  EXPECT_EQ(fitted("name  what it is and does\n", 16), "name  what it is\n      and does\n");
  EXPECT_EQ(fitted("short\n\nlines\n", 16), "short\n\nlines\n");
}

TEST(Terminal, ATablesColumnsAreAsWideAsTheirWidestText) {
  EXPECT_EQ(table_text({{"id", "name"}, {"1234", "pad\x1b"}, {"5", ""}}),
            "id    name\n1234  pad\\x1b\n5\n");
  EXPECT_EQ(table_text({}), "");
}

TEST(Terminal, WhatIsNoTerminalHasNoColumns) { EXPECT_EQ(terminal_columns(-1), std::nullopt); }

}  // namespace
}  // namespace gaitpad
