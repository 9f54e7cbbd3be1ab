#include <gtest/gtest.h>

#include <string>

#include "session/script.h"

namespace gaitpad {
namespace {

using Verb = Command::Verb;

void expect(std::string_view text, Verb verb, int walker, std::string_view name, double value) {
  const auto command = parsed_command(text);
  ASSERT_TRUE(command) << text;
  EXPECT_EQ(command->verb, verb) << text;
  EXPECT_EQ(command->walker, walker) << text;
  EXPECT_EQ(command->name, name) << text;
  EXPECT_EQ(command->value, value) << text;
}

TEST(Commands, AreForAllOrForOne) {
  expect("style limp", Verb::style, 0, "limp", 0);
  expect("style 2 limp", Verb::style, 2, "limp", 0);
  expect("set fatigue 0.25", Verb::set, 0, "fatigue", 0.25);
  expect("\t set  16 legs.weight.hip \t 1e-1 ", Verb::set, 16, "legs.weight.hip", 0.1);
  expect("gait speed_m_s 1.5", Verb::gait, 0, "speed_m_s", 1.5);
  expect("gait 3 turn_rate_rad_s -0.5", Verb::gait, 3, "turn_rate_rad_s", -0.5);
  expect("gait speed_m_s stick", Verb::release, 0, "speed_m_s", 0);
  expect("gait 1 speed_m_s stick", Verb::release, 1, "speed_m_s", 0);
  expect("gait stick", Verb::stick, 0, "stick", 0);
  expect("gait 4 stick", Verb::stick, 4, "stick", 0);
  expect("reset", Verb::restart, 0, "", 0);
  expect("mark", Verb::mark, 0, "", 0);
  expect("mark  what ever 1 2 3", Verb::mark, 0, "", 0);
}

TEST(Commands, ALoneNumberIsAName) { expect("style 1", Verb::style, 0, "1", 0); }

TEST(Commands, MalformedOnesAreNone) {
  const char* const bad[] = {"",
                             " ",
                             "style",
                             "style 0 even",
                             "style -1 even",
                             "style 1 even now",
                             "style x even",
                             "Style even",
                             "styles even",
                             "set",
                             "set fatigue",
                             "set 1 fatigue",
                             "set fatigue x",
                             "set fatigue 0.5x",
                             "set fatigue +0.5",
                             "set fatigue 0,5",
                             "set fatigue nan",
                             "set fatigue inf",
                             "set fatigue 1e999",
                             "set fatigue 0.5 0.5",
                             "set 0 fatigue 0.5",
                             "set 1 2 fatigue 0.5",
                             "set 99999999999 fatigue 0.5",
                             "gait",
                             "gait 1",
                             "gait speed_m_s",
                             "gait speed_m_s 1 2",
                             "gait stick stick 1",
                             "gait stick 1",
                             "gait stick stick",

                             "reset 1",
                             "reset now",
                             "resets",
                             "sing"};
  for (const char* text : bad) EXPECT_FALSE(parsed_command(text)) << text;
}

}  // namespace
}  // namespace gaitpad
