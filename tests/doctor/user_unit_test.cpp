#include "doctor/user_unit.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

TEST(UserUnit, AWordIsQuotedForSystemd) {
  EXPECT_EQ(unit_word("Pro Controller"), "\"Pro Controller\"");
  EXPECT_EQ(unit_word("100% $HOME"), "\"100%% $$HOME\"") << "specifiers and variables";
  EXPECT_EQ(unit_word("a\"b\\c"), "\"a\\\"b\\\\c\"");
  EXPECT_EQ(unit_word("a\nb\x7f"), "\"a\\x0ab\\x7f\"") << "a line break would end the line";
}

TEST(UserUnit, StartsThisProgramAtLogin) {
  const std::string unit = user_unit_text({"forward", "my pad"});
  EXPECT_NE(unit.find("ExecStart=\"/"), std::string::npos);
  EXPECT_NE(unit.find("test_doctor\" \"forward\" \"my pad\"\n"), std::string::npos);
  EXPECT_NE(unit.find("[Install]\nWantedBy=default.target\n"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
