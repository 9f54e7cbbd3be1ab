// A replay depends on its recording alone: the session's files are gone or changed when it replays.
#include "session/recorded_session.h"

#include <algorithm>

#include "gaitpad/config_files.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class RecordedSessionTest : public Live {
 protected:
  void SetUp() override {
    Live::SetUp();
    options_.live.clock = SessionSpec::Live::Clock::by_hand;
    fs::copy(kSourceFolder + "/config", folder_ / "config", fs::copy_options::recursive);
    options_.config_folders = {own_.at("config")};
  }
  // Runs until the recording that replaces the pads has ended.
  static void walk(LiveSession& session) {
    ASSERT_TRUE(comes_true([&] {
      session.advance(8);
      return session.has_ended();
    }));
  }
  // Replays the recording after all files of the session were removed.
  RunSummary replayed_alone() const {
    fs::remove_all(folder_ / "config");
    fs::remove_all(folder_ / "own");
    SessionSpec spec;
    spec.replay.trace = options_.live.record;
    return value_of(replay(spec)).summary;
  }
};

TEST_F(RecordedSessionTest, ReplaysWithoutAnyOtherFile) {
  SessionSpec made;
  made.replay.trace = kSourceFolder + "/config/traces/walk.hid";
  made.replay.out = own_.at("own/motion");
  made.replay.fps = 60;
  ASSERT_TRUE(replay(made));
  fs::copy(folder_ / "config/terrain/hills.png", folder_ / "own/hills.png");
  options_.walk.motion =
      own_.write("own/walk.toml", "file = \"motion/pose.bvh\"\npace = \"adult\"\n");
  options_.walk.characters = {
      "child", own_.write("own/other.toml",
                          "scale = 0.9\nskeleton = \"" + own_.at("own/motion/pose.bvh") + "\"\n")};
  options_.walk.styles = {own_.write("own/mine.toml", "hip_sway = 1.5\n"), "limp_left"};
  options_.walk.terrain = own_.write(
      "own/ground.toml",
      "[[section]]\nkind = \"picture\"\npicture = \"hills.png\"\nlow_m = 0\nhigh_m = 0.05\n"
      "metres_per_pixel = 0.1\n[[zone]]\nfrom_m = 0.3\nto_m = 0.8\nstyle = \"tired\"\n");
  options_.walk.ik = IkMode::paper;
  options_.walk.crowd = 5;
  options_.pad.map = own_.write("own/pad.toml",
                                "[[pad]]\nvendor = 0x1209\n[pad.axes]\n"
                                "left_x = \"-0001:0030\"\n");
  auto session = started();
  walk(*session);
  session->command("style 1 stiff_hip");
  for (int i = 0; i < 200; ++i) session->advance(1);
  const RunSummary run = value_of(session->stop());
  EXPECT_GT(run.walkers[0].steps[kLeftSide], 0);
  EXPECT_EQ(run, replayed_alone());
}

TEST_F(RecordedSessionTest, AStyleSavedOnTheWayCountsFromItsTickOn) {
  auto session = started();
  Style mine;
  mine.name = "mine";
  mine.hip_sway = 2.0;
  session->advance(40);
  session->command("style mine");  // there is no style of this name yet
  sleep_for(50);
  session->advance(40);
  session->add_style(mine);
  session->command("style mine");
  sleep_for(50);
  session->advance(100);
  mine.hip_sway = 0.5;
  session->add_style(mine);
  session->advance(20);
  session->command("style 1 mine");
  sleep_for(50);
  walk(*session);
  const RunSummary run = value_of(session->stop());
  EXPECT_EQ(run.walkers[0].style, "mine");
  EXPECT_EQ(run.bad_commands, 1);
  EXPECT_EQ(run, replayed_alone());
}

TEST_F(RecordedSessionTest, WhatAnOptionNamesGoesBeforeTheRecording) {
  options_.walk.styles = {"limp_left"};
  auto session = started();
  walk(*session);
  const RunSummary run = value_of(session->stop());
  SessionSpec spec;
  spec.config_folders = options_.config_folders;
  spec.replay.trace = options_.live.record;
  spec.walk.styles = {"even"};
  EXPECT_NE(value_of(replay(spec)).summary.pose_hash, run.pose_hash);
  EXPECT_EQ(value_of(replay(spec)).summary.walkers.at(0).style, "even");
}

TEST_F(RecordedSessionTest, OnlyFilesOfPadsThatAreThereAreHeld) {
  own_.write("config/pads/a.toml", "[[pad]]\nvendor = 0x1209\nname = \"a\"\n");
  auto session = started();
  walk(*session);
  ASSERT_TRUE(session->stop());
  const Trace trace = value_of(read_trace(options_.live.record));
  std::vector<std::string> pads;
  for (const TraceFile& file : trace.files) {
    if (file.name.starts_with("pads/")) pads.push_back(file.name);
  }
  EXPECT_EQ(pads, std::vector<std::string>{"pads/a.toml"});
}

bool is_not_held(const std::string& cause) {
  return cause.ends_with(": the recording does not hold this file");
}

// Files that a recording names are searched for in the recording alone, never on the disk.
TEST_F(RecordedSessionTest, NoNameLeadsOutOfARecording) {
  const std::string secret = own_.write("own/secret.toml", "hip_sway = 1\n");
  Trace trace = two_pads_trace();
  SessionSpec spec;
  spec.replay.trace = own_.at("hostile.hid");
  for (const std::string& way :
       {secret, std::string("../own/secret.toml"), std::string("a/../../own/secret.toml")}) {
    trace.options = {"style " + way};
    trace.files = {{"styles/x.toml", "\n"}};
    ASSERT_TRUE(write_trace(trace, spec.replay.trace));
    EXPECT_TRUE(is_not_held(cause_of(replay(spec)))) << way << ": " << cause_of(replay(spec));
    trace.options = {"motion m.toml"};
    trace.files = {{"m.toml", "file = \"" + way + "\"\n"}};
    ASSERT_TRUE(write_trace(trace, spec.replay.trace));
    EXPECT_TRUE(is_not_held(cause_of(replay(spec)))) << way << ": " << cause_of(replay(spec));
  }
  trace.options = {"crowd -1"};
  ASSERT_TRUE(write_trace(trace, spec.replay.trace));
  EXPECT_EQ(cause_of(replay(spec)), spec.replay.trace + ": \"-1\" is no crowd of 0 to 100000");
}

TEST_F(RecordedSessionTest, ADamagedStyleThatNobodyNamesIsLeftOutWithARemark) {
  own_.write("config/styles/broken.toml", "hip_sway = \n");
  SessionSpec spec = options_;
  spec.replay.trace = options_.pad.selector.pad;
  const auto result = value_of(replay(spec));
  ASSERT_EQ(result.remarks.size(), 1u);
  EXPECT_EQ(result.remarks[0].find(own_.at("config/styles/broken.toml") + ":1: "), 0u);
  spec.walk.styles = {"broken"};
  EXPECT_FALSE(replay(spec));
}

}  // namespace
}  // namespace gaitpad
