#include "session/set_up.h"

#include <gtest/gtest.h>

#include "gaitpad/replay.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

// Replays of recordings in an own folder, in the style mine.toml.
class SetUpTest : public testing::Test {
 protected:
  SetUpTest() {
    spec_.config_folders = {own_.at("config")};
    spec_.walk.styles = {own_.write("mine.toml", "hip_sway = 1\n")};
    own_.write("config/styles/even.toml", "\n");
  }
  // Pushes the stick forward for a second.
  static Trace walk() {
    Trace trace;
    trace.devices.emplace_back().info = made_pad();
    add_event(trace, 0, made_report(0x80, 0x10));
    add_event(trace, 1'000'000, made_report(0x80, 0x80));
    return trace;
  }
  // The session of a recording with this content.
  SessionSpec of(const std::string& name, const Trace& trace = walk()) const {
    SessionSpec spec = spec_;
    spec.replay.trace = own_.at(name);
    value_of(write_trace(trace, spec.replay.trace));
    return spec;
  }
  static std::uint64_t hash_of(const Result<ReplayResult>& result) {
    return value_of(result).summary.pose_hash;
  }

  OwnFolder own_;
  SessionSpec spec_;
  Replayer replayer_;
};

TEST_F(SetUpTest, AFileThatRecordingsShareIsReadOnce) {
  const std::uint64_t first = hash_of(replayer_.replay(of("a.hid")));
  own_.write("mine.toml", "hip_sway = 3\n");
  EXPECT_EQ(hash_of(replayer_.replay(of("b.hid"))), first);
  EXPECT_NE(hash_of(replay(of("b.hid"))), first);
}

TEST_F(SetUpTest, AnotherSessionReadsItsFilesAgain) {
  SessionSpec asked = of("a.hid");
  const std::uint64_t before = hash_of(replayer_.replay(asked));
  own_.write("mine.toml", "hip_sway = 3\n");
  const std::uint64_t after = hash_of(replay(asked));
  ASSERT_NE(after, before);
  // One change at a time makes another session.
  asked.walk.crowd = 0;
  EXPECT_EQ(hash_of(replayer_.replay(asked)), after);
  asked.replay.user_styles = true;
  own_.write("mine.toml", "hip_sway = 1\n");
  EXPECT_EQ(hash_of(replayer_.replay(asked)), before);
  asked.config_folders = {own_.at("config"), own_.at("more")};
  own_.write("mine.toml", "hip_sway = 3\n");
  EXPECT_EQ(hash_of(replayer_.replay(asked)), after);
  asked.rate_hz = 120;
  own_.write("mine.toml", "hip_sway = 1\n");
  EXPECT_EQ(hash_of(replayer_.replay(asked)), hash_of(replay(asked)));
}

TEST_F(SetUpTest, PadFilesAreReadAgainForAnotherMap) {
  SessionSpec asked = of("a.hid");
  const std::uint64_t unmapped = hash_of(replayer_.replay(asked));
  asked.pad.map = own_.write("map.toml",
                             "[[pad]]\nvendor = 0x1209\n[pad.axes]\nleft_y = \"0001:0031\"\n"
                             "left_x = \"-0001:0031\"\n");
  const std::uint64_t mapped = hash_of(replay(asked));
  ASSERT_NE(mapped, unmapped);
  EXPECT_EQ(hash_of(replayer_.replay(asked)), mapped);
  asked.pad.map.clear();
  EXPECT_EQ(hash_of(replayer_.replay(asked)), unmapped);
}

TEST_F(SetUpTest, ARecordingWithOtherFilesWalksInItsOwn) {
  Trace trace = walk();
  const auto holding = [&](const std::string& style) {
    trace.options = {"style styles/own.toml"};
    trace.files = {{"styles/own.toml", style}};
    return trace;
  };
  spec_.walk.styles.clear();
  const SessionSpec swaying = of("a.hid", holding("hip_sway = 1\n"));
  const SessionSpec limping = of("b.hid", holding("[left_leg]\nstride_length = 0.5\n"));
  const SessionSpec again = of("c.hid", holding("hip_sway = 1\n"));
  const SessionSpec none = of("d.hid");
  for (const SessionSpec& spec : {swaying, again, limping, none, swaying})
    EXPECT_EQ(hash_of(replayer_.replay(spec)), hash_of(replay(spec))) << spec.replay.trace;
}

TEST_F(SetUpTest, SentencesNameTheirOwnRecording) {
  Trace trace = walk();
  trace.files = {{"styles/broken.toml", "hip_sway = \n"}};
  spec_.walk.styles.clear();
  for (const std::string name : {"a.hid", "b.hid"}) {
    const auto result = value_of(replayer_.replay(of(name, trace)));
    ASSERT_EQ(result.remarks.size(), 1u);
    EXPECT_TRUE(result.remarks[0].starts_with(own_.at(name) + "/styles/broken.toml:1: "))
        << result.remarks[0];
  }
  trace.options = {"terrain ground.toml"};
  trace.files = {{"ground.toml",
                  "[[section]]\nkind = \"flat\"\nlength_m = 9\n"
                  "[[zone]]\nfrom_m = 1\nto_m = 2\nstyle = \"nowhere\"\n"}};
  for (const std::string name : {"a.hid", "b.hid"}) {
    const std::string cause = cause_of(replayer_.replay(of(name, trace)));
    EXPECT_TRUE(cause.starts_with(own_.at(name) + "/ground.toml:7: ")) << cause;
  }
}

TEST_F(SetUpTest, AFailureDoesNotChangeTheNextReplay) {
  const SessionSpec good = of("a.hid");
  SessionSpec wrong = good;
  wrong.walk.styles = {own_.at("nowhere.toml")};
  EXPECT_FALSE(replayer_.replay(wrong));
  EXPECT_EQ(hash_of(replayer_.replay(good)), hash_of(replay(good)));
  wrong = good;
  wrong.replay.trace = own_.at("nowhere.hid");
  EXPECT_FALSE(replayer_.replay(wrong));
  EXPECT_EQ(hash_of(replayer_.replay(good)), hash_of(replay(good)));
}

}  // namespace
}  // namespace gaitpad
