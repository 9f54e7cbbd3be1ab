#include "session/script.h"

#include <gtest/gtest.h>

#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

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
  EXPECT_EQ(tick_of({2'500'001, "", ""}, 240), 601);  // the first tick that begins after it
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

// The recording is the session: a replay of it needs neither the script nor doubles anything.
class Scripted : public Live {
 protected:
  void SetUp() override {
    Live::SetUp();
    options_.live.clock = SessionSpec::Live::Clock::by_hand;
    options_.live.keyboard = true;
    options_.pad.wish.pad = "0001:fffe";  // nobody has one: the script alone walks
  }
  std::string write(const std::string& name, const std::string& text) {
    return own_.write(name, text);
  }
  std::uint64_t hash_of_live(int ticks) {
    const auto session = started();
    // A recording needs a device.
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
      write("walk.toml", event("1", "style stiff_knee") + event("0.2", "gait speed_m_s 1.2"));
  const std::uint64_t live = hash_of_live(1200);
  EXPECT_EQ(style_, "stiff_knee");
  options_.walk.script.clear();
  const RunSummary run = replayed();
  EXPECT_EQ(run.pose_hash, live);
  EXPECT_EQ(run.walkers[0].style, "stiff_knee");
  EXPECT_EQ(run.bad_commands, 0);
}

// Zones and tiring follow from the state: they stand in no recording and act once in a replay.
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
  EXPECT_EQ(text.find("limp_left_hip"), std::string::npos);
  EXPECT_NE(text.find("set hip_bounce 0.5"), std::string::npos);
  options_.walk.terrain.clear();  // the zone was there indeed
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
  // Behind the end nothing happens.
  EXPECT_EQ(replay_with(write("b.toml", event("99", "style limp_left"))).pose_hash,
            plain.pose_hash);
}

TEST_F(Scripted, WhatASessionCouldNotObeyIsRefusedBeforeItBegins) {
  const auto refusal = [&](const std::string& command) {
    options_.walk.script = write("walk.toml", event("0", "mark") + event("1", command));
    return cause_of(LiveSession::start(options_));
  };
  for (const char* command : {"style no_such", "set hip_sway 9", "style 3 even", "gait speed 1"}) {
    EXPECT_NE(
        refusal(command).find("walk.toml:6: \"" + std::string(command) + "\" cannot be obeyed"),
        std::string::npos)
        << refusal(command);
  }
}

}  // namespace
}  // namespace gaitpad
