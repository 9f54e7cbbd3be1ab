#include "session/playback.h"

#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <random>

#include "gaitpad/hash.h"
#include "gaitpad/replay.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

constexpr int kRateHz = 240;
const std::string kConfig = kSourceFolder + "/config";
const std::string kRound = kConfig + "/traces/round.hid";

// A session with the paper's four styles on this recording.
SessionSpec paper_cast(const std::string& trace, Damage damage = Damage::refuse) {
  SessionSpec spec;
  spec.config_folders = {kConfig};
  spec.walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
  spec.replay.trace = trace;
  spec.replay.damage = damage;
  return spec;
}

// Hashes of all drawn fields of a frame and of all fields of a sample.
std::uint64_t print_of(const SessionFrame& frame) {
  WordHash hash;
  const auto add = [&hash](const vec3& v) {
    for (const double x : {v.x, v.y, v.z}) hash.add(x);
  };
  for (int i = 0; i < frame.walker_count; ++i) {
    const WalkerFrame& w = frame.walkers[i];
    for (const Pose* pose : {&w.before, &w.pose}) {
      add(pose->root_m);
      for (int j = 0; j < pose->joint_count; ++j) {
        for (int k = 0; k < 4; ++k) hash.add(pose->local[j][k]);
      }
    }
    for (const vec3& heel_m : w.walk.heel_m) add(heel_m);
    add({w.phase, w.params.hip_sway, w.style.fatigue});
  }
  for (const double x :
       {static_cast<double>(frame.tick), frame.stick.left.x, frame.stick.left.y,
        static_cast<double>(frame.pad.reports), static_cast<double>(frame.pad.is_present),
        static_cast<double>(frame.presses[kButtonA]), static_cast<double>(frame.counts.commands)})
    hash.add(x);
  return hash.value();
}
std::uint64_t print_of(const TickSample& sample) {
  WordHash hash;
  hash.add(static_cast<double>(sample.tick));
  for (int i = 0; i < sample.walker_count; ++i) {
    const WalkerSample& w = sample.walkers[i];
    for (const Side side : {kLeftSide, kRightSide}) {
      for (const float x : w.joint_rad[side]) hash.add(static_cast<double>(x));
      hash.add(w.heel_m[side].y);
    }
  }
  return hash.value();
}

// A run from beginning to end, and the hash of each tick's frame and sample.
struct Straight {
  std::vector<std::uint64_t> frames, samples;
  std::uint64_t pose_hash = 0;
};
Straight straight_run(const std::string& path) {
  Straight straight;
  const auto prepared = value_of(prepared_trace(paper_cast(path)));
  TraceRun run = TraceRun::begin(prepared);
  auto frame = std::make_unique<SessionFrame>();
  TickSample sample;
  for (std::int64_t tick = 0; tick < prepared.ticks; ++tick) {
    run.step(prepared);
    copy_frame(run.simulation(), *frame);
    copy_sample(run.simulation(), sample);
    straight.frames.push_back(print_of(*frame));
    straight.samples.push_back(print_of(sample));
  }
  straight.pose_hash = run.simulation().pose_hash();
  return straight;
}

class PlaybackTest : public testing::Test {
 protected:
  void open(const std::string& path) { playback_ = value_of(Playback::open(paper_cast(path))); }
  // Writes the recording of a session of `ticks` ticks with walking, commands, buttons and
  // unplugging.
  std::string write_session(std::int64_t ticks, int rate_hz = kRateHz) {
    TraceWriter writer;
    TraceDevice device;
    device.info = made_pad();
    writer.begin(rate_hz);
    writer.device(device, TraceWriter::Index::written);
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      for (const Report& r : session_tick(static_cast<int>(tick % 6000))) {
        writer.tick(tick);
        const std::optional<int> index =
            r.kind == ReportKind::command ? std::nullopt : std::optional(0);
        writer.event(r.kind, tick * 1'000'000 / rate_hz, index, {r.bytes.data(), r.size});
      }
    }
    writer.end(ticks * 1'000'000 / rate_hz, ticks);
    std::ofstream(path_) << writer.text();
    return path_;
  }
  static std::vector<Report> session_tick(int tick) {
    std::vector<Report> reports = made_tick(tick);
    if (tick == 0) reports.push_back(made_plug(ReportKind::added));
    if (tick == 900) reports.push_back(made_command("style 1 limp_left"));
    if (tick % 200 == 50) {
      reports.push_back(made_report(0x70, 0x10 + tick % 64));
      reports.back().bytes[4] = 0x18;
    }
    return reports;
  }
  void reach(std::int64_t tick, int budget) {
    int calls = 0;
    while (!playback_->seek(tick, budget)) ASSERT_LT(++calls, 1'000'000);
  }

  OwnFolder own_;
  const std::string path_ = own_.at("session.hid");
  std::unique_ptr<Playback> playback_;
};

TEST_F(PlaybackTest, TheHashAtTheEndIsThatOfAReplay) {
  for (const std::string& path : {kRound, write_session(4000)}) {
    const auto replayed = replay(paper_cast(path));
    ASSERT_TRUE(replayed) << replayed.error().message;
    open(path);
    EXPECT_EQ(playback_->ticks(), replayed->summary.ticks);
    reach(playback_->ticks(), 100);
    EXPECT_EQ(playback_->pose_hash(), replayed->summary.pose_hash);
    EXPECT_EQ(playback_->summary(), replayed->summary);
  }
}

TEST_F(PlaybackTest, AnyTickIsTheSameAsInAStraightRun) {
  for (const std::string& path : {kRound, write_session(14000)}) {
    const Straight straight = straight_run(path);
    open(path);
    std::mt19937 random(3);
    TickSample sample;
    for (int i = 0; i < 30; ++i) {
      const auto tick = static_cast<std::int64_t>(random() % straight.frames.size());
      reach(tick, i % 3 == 0 ? 37 : 5000);
      ASSERT_EQ(playback_->frame().tick, tick);
      ASSERT_EQ(print_of(playback_->frame()), straight.frames[tick]) << "tick " << tick;
      while (playback_->take_sample(sample)) {
        ASSERT_EQ(print_of(sample), straight.samples[sample.tick]) << "sample " << sample.tick;
      }
    }
    reach(playback_->ticks(), 1 << 20);
    EXPECT_EQ(playback_->pose_hash(), straight.pose_hash);
  }
}

TEST_F(PlaybackTest, AnInterruptedSeekMakesNoDifference) {
  const Straight straight = straight_run(write_session(9000));
  open(path_);
  std::mt19937 random(4);
  for (int i = 0; i < 150; ++i) {
    const auto tick = static_cast<std::int64_t>(random() % straight.frames.size());
    playback_->seek(tick, 1 + static_cast<int>(random() % 900));
    const std::int64_t reached = playback_->frame().tick;
    ASSERT_GE(reached, 0);
    ASSERT_EQ(print_of(playback_->frame()), straight.frames[reached]) << reached;
  }
}

// At 10 Hz there is a snapshot every ten ticks, so the playback has to drop every other one twice.
TEST_F(PlaybackTest, AnyTickOfALongRecordingIsTheSameAsInAStraightRun) {
  const Straight straight = straight_run(write_session(25000, 10));
  open(path_);
  reach(24999, 1 << 20);
  EXPECT_EQ(playback_->pose_hash(), straight.pose_hash);
  std::mt19937 random(6);
  for (int i = 0; i < 30; ++i) {
    const auto tick = static_cast<std::int64_t>(random() % straight.frames.size());
    // The nearest snapshot is at most 40 ticks before the history.
    ASSERT_TRUE(playback_->seek(tick, Playback::kHistoryTicks + 40)) << tick;
    ASSERT_EQ(print_of(playback_->frame()), straight.frames[tick]) << tick;
  }
}

TEST_F(PlaybackTest, SamplesHaveNoGapsAndRestartAfterAJump) {
  open(write_session(9000));
  TickSample sample;
  std::int64_t next = 0;
  const auto expect_up_to = [&](std::int64_t last) {
    while (playback_->take_sample(sample)) ASSERT_EQ(sample.tick, next++);
    EXPECT_EQ(next, last + 1);
  };
  for (std::int64_t tick = 7; tick < 3000; tick += 8) {
    reach(tick, 3);
    expect_up_to(tick);
  }
  reach(2000, 100);  // seeks back
  next = 2001 - Playback::kHistoryTicks;
  expect_up_to(2000);
  reach(2000 + Playback::kHistoryTicks, 100);  // goes on without a seek
  expect_up_to(2000 + Playback::kHistoryTicks);
  reach(8000, 100);  // seeks forward, beyond all ticks that were played so far
  next = 8001 - Playback::kHistoryTicks;
  expect_up_to(8000);
  reach(100, 100);  // seeks to a tick with fewer ticks before it than the history holds
  next = 0;
  expect_up_to(100);
  // A seek to an earlier tick interrupts one to a later tick: the history is complete.
  playback_->seek(5000, 1 << 20);
  playback_->seek(8000, 1500);
  reach(7000, 100);
  next = 7001 - Playback::kHistoryTicks;
  expect_up_to(7000);
}

TEST_F(PlaybackTest, SeeksBeyondTheEndsAreClamped) {
  open(write_session(500));
  EXPECT_EQ(playback_->frame().tick, -1);
  EXPECT_EQ(playback_->frame().walker_count, 4);
  EXPECT_FALSE(playback_->seek(1 << 30, 499));
  EXPECT_TRUE(playback_->seek(1 << 30, 1));
  EXPECT_EQ(playback_->frame().tick, 499);
  EXPECT_TRUE(playback_->seek(-5, 1));
  EXPECT_EQ(playback_->frame().tick, 0);
  EXPECT_FALSE(playback_->seek(3, 0));
  EXPECT_EQ(playback_->frame().tick, 0);
}

TEST_F(PlaybackTest, CommandsAndPluggingAreMarked) {
  open(write_session(2400));
  std::vector<std::pair<std::int64_t, std::string>> marks;
  for (const PlaybackMark& mark : playback_->marks()) marks.emplace_back(mark.tick, mark.text);
  const std::vector<std::pair<std::int64_t, std::string>> expected = {
      {0, "plugged in"},
      {900, "style 1 limp_left"},
      {1000, "style 1 limp"},
      {1300, "set 2 legs.weight.knee 0.8"},
      {1500, "gait 2 stride_left_m 0.3"},
      {1500, "gait hip_bounce 1.5"},
      {1700, "style even"},
      {2100, "unplugged"},
      {2300, "plugged in"},
      {2301, "gait 1 speed_m_s 0.8"}};
  EXPECT_EQ(marks, expected);
}

TEST_F(PlaybackTest, TheNumberOfMarksIsBounded) {
  std::string text = trace_text([] {
    Trace trace;
    trace.devices.emplace_back().info = made_pad();
    return trace;
  }());
  for (std::size_t i = 0; i < Playback::kMaxMarks + 10; ++i)
    text += "C: 000000.000000 mark\nC: 000000.000000 mark me\n";
  std::ofstream(path_) << text;
  open(path_);
  EXPECT_EQ(playback_->marks().size(), Playback::kMaxMarks);
  EXPECT_EQ(playback_->marks().back().text, "mark me");
}

TEST_F(PlaybackTest, ErrorsAndRemarksMatchAReplay) {
  write_session(100);
  std::ofstream(path_, std::ios::app) << "nonsense\n";
  EXPECT_EQ(Playback::open(paper_cast(path_)).error().message,
            replay(paper_cast(path_)).error().message);
  auto lenient = Playback::open(paper_cast(path_, Damage::skip));
  ASSERT_TRUE(lenient);
  ASSERT_EQ((*lenient)->remarks().size(), 1u);
  EXPECT_EQ((*lenient)->remarks()[0].substr(0, 33), "1 damaged lines were skipped, the");
  SessionSpec slower = paper_cast(path_, Damage::skip);
  slower.rate_hz = 120;
  EXPECT_FALSE(Playback::open(slower)) << "the recording states 240 Hz";
  EXPECT_FALSE(Playback::open(paper_cast("no/such.hid")));
}

}  // namespace
}  // namespace gaitpad
