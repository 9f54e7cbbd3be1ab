#include "session/script.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

// --- commands

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
  expect("stick steers", Verb::steers, 0, "steers", 0);
  expect("stick points", Verb::points, 0, "points", 0);
  expect("stick points -90.5", Verb::points, 0, "points", -90.5);
  expect("reset", Verb::restart, 0, "", 0);
  expect("ik paper", Verb::ik, 0, "paper", 0);
  expect("ik robust", Verb::ik, 0, "robust", 0);
  expect("mark", Verb::mark, 0, "", 0);
  expect("mark  what ever 1 2 3", Verb::mark, 0, "", 0);
}

TEST(Commands, AStylesNameMayHaveBlanks) {
  expect("style my walk", Verb::style, 0, "my walk", 0);
  expect("style 2  my walk ", Verb::style, 2, "my walk", 0);
  expect("style -1 even", Verb::style, 0, "-1 even", 0);
}

TEST(Commands, WhatIsWrongIsNamedWithWhatIsKnown) {
  const std::vector<std::string> styles = {"even", "my walk"};
  const auto problem = [&](const char* text) {
    return command_problem(text, styles, 2).value_or("none");
  };
  for (const char* sound :
       {"style my walk", "style 2 even", "set hip_sway 1.5", "gait 1 speed_m_s 1", "gait stick",
        "gait speed_m_s stick", "stick points 90", "reset", "mark x"}) {
    EXPECT_EQ(problem(sound), "none") << sound;
  }
  EXPECT_EQ(problem("style limp"), "unknown style \"limp\"; known: even, my walk");
  EXPECT_EQ(problem("foo 1"),
            "unknown command \"foo\"; known: style, set, gait, stick, reset, ik, mark");
  EXPECT_EQ(problem("style 3 even"), "there is no character 3; they are numbered 1 to 2");
  EXPECT_EQ(problem("set hip_sway 9"), "hip_sway of 9 is not within 0 .. 3");
  EXPECT_EQ(problem("set hip_swya 1"),
            "unknown style value \"hip_swya\"; did you mean \"hip_sway\"?");
  EXPECT_NE(problem("gait speed 1").find("unknown gait parameter \"speed\"; known: "),
            std::string::npos);
}

TEST(Commands, ASingleNumberIsAName) { expect("style 1", Verb::style, 0, "1", 0); }

TEST(Commands, MalformedOnesAreRejected) {
  std::istringstream lines(
      "\n \nstyle\nStyle even\nstyles even\nset\nset fatigue\nset 1 fatigue\nset fatigue x\n"
      "set fatigue 0.5x\nset fatigue +0.5\nset fatigue 0,5\nset fatigue nan\nset fatigue inf\n"
      "set fatigue 1e999\nset fatigue 0.5 0.5\nset 0 fatigue 0.5\nset 1 2 fatigue 0.5\n"
      "set 99999999999 fatigue 0.5\ngait\ngait 1\ngait speed_m_s\ngait speed_m_s 1 2\n"
      "gait stick stick 1\nstick\nstick turns\nstick steers 1\nstick points here\nstick points 1 "
      "2\ngait stick 1\ngait stick stick\nreset 1\nreset now\nresets\nsing\nik\nik both\n"
      "ik 1 paper\nik paper 1");
  for (std::string text; std::getline(lines, text);) EXPECT_FALSE(parsed_command(text)) << text;
}

// --- scripts

std::string event(const std::string& at_s, const std::string& command) {
  return "[[event]]\nat_s = " + at_s + "\ncommand = \"" + command + "\"\n";
}

TEST(Script, EventsAreInTheOrderOfTheirTimes) {
  const auto script = parsed_script(
      event("2.5", "style limp_left") + event("0", "mark a") + event("2.5", "mark b"), "walk.toml");
  ASSERT_TRUE(script) << script.error().message;
  ASSERT_EQ(script->events.size(), 3u);
  EXPECT_EQ(script->events[0].command, "mark a");
  EXPECT_EQ(script->events[1].command, "style limp_left");
  EXPECT_EQ(script->events[2].command, "mark b");
  EXPECT_EQ(tick_of(script->events[1], 240), 600);
  // Tick 601 is the first that begins after the event.
  EXPECT_EQ(tick_of({2'500'001, "", ""}, 240), 601);
  EXPECT_EQ(tick_of({0, "", ""}, 240), 0);
}

TEST(Script, ErrorsNameFileAndLine) {
  const auto begins = [](const std::string& text, const std::string& with) {
    const auto script = parsed_script(text, "walk.toml");
    ASSERT_FALSE(script) << text;
    EXPECT_EQ(script.error().message.substr(0, with.size()), with) << script.error().message;
  };
  begins(event("1", "fly"), "walk.toml:3: \"fly\" is no command");
  begins(event("-1", "mark"), "walk.toml:2: ");
  begins(event("1", "mark") + "loud = true\n", "walk.toml:4: unknown key \"loud\"");
  begins("[[event]]\nat_s = 1\n", "walk.toml:1: ");
  begins("[[event]]\ncommand = \"mark\"\n", "walk.toml:1: ");
  begins(event("1", "mark " + std::string(300, 'x')), "walk.toml:3: the command is too long");
}

// The recording holds the script's commands: a replay needs no script and runs no command twice.
class Scripted : public Live {
 protected:
  void SetUp() override {
    Live::SetUp();
    options_.live.clock = SessionSpec::Live::Clock::by_hand;
    options_.live.keyboard = true;
    // Ids that no pad has, so only the script drives the walk.
    options_.pad.selector.pad = "0001:fffe";
  }
  std::string write(const std::string& name, const std::string& text) {
    return own_.write(name, text);
  }
  std::uint64_t hash_of_live(int ticks) {
    const auto session = started();
    // The recording needs a device, so wait for the keyboard.
    EXPECT_TRUE(comes_true([&] {
      session->advance(1);
      return !session->pad_name(0).empty();
    }));
    session->advance(ticks);
    const RunSummary run = value_of(session->stop());
    style_ = run.walkers[0].style;
    return run.pose_hash;
  }
  std::string style_;
};

TEST_F(Scripted, EventsAreRecordedAndAReplayNeedsNoScript) {
  options_.walk.script =
      write("walk.toml", event("1", "style stiff_knee") + event("0.2", "gait speed_m_s 1.2") +
                             event("2", "ik paper") + event("3", "ik robust"));
  const std::uint64_t live = hash_of_live(1200);
  EXPECT_EQ(style_, "stiff_knee");
  options_.walk.script.clear();
  const RunSummary run = replayed();
  EXPECT_EQ(run.pose_hash, live);
  EXPECT_EQ(run.walkers[0].style, "stiff_knee");
  EXPECT_EQ(run.bad_commands, 0);
}

// The terrain's zones and fatigue are computed from the state. The recording has the terrain but no
// commands for them; a replay applies them once.
TEST_F(Scripted, ZonesAndTiringActOnceInAReplay) {
  options_.walk.terrain =
      write("zones.toml", "[[zone]]\nfrom_m = 1\nto_m = 2.5\nstyle = \"limp_left_hip\"\n");
  options_.walk.styles = {write("quick.toml",
                                "blend_s = 0.4\nfatigue_model = { per_100_m = 5, "
                                "recovery_per_s = 0.1 }\n")};
  options_.walk.script =
      write("walk.toml", event("0.5", "set hip_bounce 0.5") + event("0.2", "gait speed_m_s 1.2"));
  const std::uint64_t live = hash_of_live(1400);
  options_.walk.script.clear();
  const RunSummary run = replayed();
  EXPECT_EQ(run.pose_hash, live);
  const std::string text = text_in(options_.live.record);
  EXPECT_EQ(text.find("C: style"), std::string::npos);
  EXPECT_NE(text.find("set hip_bounce 0.5"), std::string::npos);
  options_.walk.terrain = "flat";  // flat ground has no zone: shows that the zone had an effect
  EXPECT_NE(replayed().pose_hash, live);
}

TEST_F(Scripted, IsMergedWithTheEventsOfATrace) {
  const std::string trace = (folder_ / "pads.hid").string();
  const auto replay_with = [&](const std::string& script) {
    SessionSpec spec;
    spec.config_folders = options_.config_folders;
    spec.walk.script = script;
    spec.replay.trace = trace;
    return value_of(replay(spec)).summary;
  };
  const auto plain = replay_with("");
  const auto scripted = replay_with(write("a.toml", event("1", "style limp_left")));
  EXPECT_EQ(scripted.walkers[0].style, "limp_left");
  EXPECT_EQ(scripted.reports, plain.reports);
  EXPECT_EQ(scripted.ticks, plain.ticks);
  EXPECT_NE(scripted.pose_hash, plain.pose_hash);
  // Events after the end of the recording have no effect.
  EXPECT_EQ(replay_with(write("b.toml", event("99", "style limp_left"))).pose_hash,
            plain.pose_hash);
}

TEST_F(Scripted, ImpossibleCommandsAreRefusedBeforeTheSessionStarts) {
  const auto refusal = [&](const std::string& command) {
    options_.walk.script = write("walk.toml", event("0", "mark") + event("1", command));
    return cause_of(LiveSession::start(options_));
  };
  using Case = std::pair<const char*, const char*>;
  for (const auto& [command, says] :
       {Case{"style no_such", "unknown style \"no_such\"; known: even"},
        Case{"set hip_sway 9", "hip_sway of 9 is not within 0 .. 3"},
        Case{"style 3 even", "there is no character 3"},
        Case{"gait speed 1", "unknown gait parameter \"speed\""}}) {
    EXPECT_EQ(refusal(command).find(fmt::format("walk.toml:6: {}", says)),
              refusal(command).find("walk.toml"))
        << refusal(command);
  }
}

}  // namespace
}  // namespace gaitpad
