// Live sessions in real time; a trace is the pad.
#include "gaitpad/live.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>

#include "drivers/posix.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

TEST_F(Live, ReplaysToTheSamePoses) {
  auto session = started();
  sleep_for(700);
  session->command("style tired");
  sleep_for(500);
  session->command("style 2 stiff_hip\n");
  session->command("   ");
  session->command("no such command");
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_EQ(run->walkers.size(), 2u);
  const WalkerSummary& first = run->walkers.front();
  EXPECT_EQ(*run, replayed());
  EXPECT_EQ(first.style, "tired");
  EXPECT_GT(run->ticks, 3 * 240) << "2.4 s and a second more";
  EXPECT_GT(run->reports, 400);
  EXPECT_EQ(run->bad_reports, 0);
  EXPECT_GT(first.steps[kLeftSide] + first.steps[kRightSide], 1);
  EXPECT_EQ(session->status().recording_lost, 0);
  EXPECT_EQ(session->status().pads.lost, 0);
}

TEST_F(Live, TellsTheNewestTickAndHowItGoes) {
  options_.live.record.clear();
  auto session = started();
  std::int64_t tick = -1;
  std::uint16_t driving = kNoDevice;
  float forward = 0.0f;
  ASSERT_TRUE(comes_true([&] {
    bool is_new = false;
    const SessionFrame& frame = session->latest(is_new);
    EXPECT_GE(frame.tick, tick);
    tick = frame.tick;
    driving = frame.pad.device;
    forward = std::max(forward, frame.pad.state.axis[kLeftY]);
    return tick >= 150;
  }));
  EXPECT_EQ(driving, 0);
  EXPECT_GT(forward, 0.5f);
  const LiveStatus status = session->status();
  EXPECT_GE(status.ticks, 150);
  EXPECT_GT(status.tick_us_median, 0.0);
  EXPECT_GE(status.tick_us_max, 0.99 * status.tick_us_median);
  EXPECT_GT(status.wait_us_median, 0.0);
  EXPECT_EQ(status.pads.plugged, 2);
  ASSERT_TRUE(session->stop());
  EXPECT_FALSE(session->stop()) << "once";
}

TEST_F(Live, TicksAreTheTimeTimesTheRate) {
  options_.live.record.clear();
  options_.rate_hz = 500;
  auto session = started();
  ASSERT_TRUE(comes_true([&] { return session->status().ticks > 0; }));
  const std::int64_t before = session->status().ticks;
  const std::int64_t begin_ns = now_ns();
  sleep_for(1000);
  const std::int64_t ticks = session->status().ticks - before;
  const double seconds = static_cast<double>(now_ns() - begin_ns) * 1e-9;
  EXPECT_NEAR(static_cast<double>(ticks), 500.0 * seconds, 100.0);
}

TEST_F(Live, AfterAStandstillTheSessionGoesOnWhereItStood) {
  auto session = started();
  sleep_for(600);
  const std::int64_t before = session->status().ticks;
  const std::string wake = "sleep 1.6; kill -CONT " + std::to_string(::getpid());
  const char* const words[] = {"sh", "-c", wake.c_str(), nullptr};
  pid_t sleeper = 0;
  ASSERT_EQ(::posix_spawn(&sleeper, "/bin/sh", nullptr, nullptr, const_cast<char* const*>(words),
                          environ),
            0);
  ::kill(::getpid(), SIGSTOP);
  ::waitpid(sleeper, nullptr, 0);
  sleep_for(300);
  const LiveStatus status = session->status();
  EXPECT_GE(status.standstills, 1);
  EXPECT_EQ(status.overloads, 0);
  EXPECT_GT(status.skipped_s, 1.3);
  EXPECT_LT(status.ticks - before, 240) << "nothing is made up for";
  const auto remarks = session->take_remarks();
  EXPECT_EQ(std::ranges::count_if(
                remarks, [](const std::string& s) { return s.find("stood still") != s.npos; }),
            1);
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  const auto run = session->stop();
  ASSERT_TRUE(run);
  EXPECT_EQ(*run, replayed());
}

TEST_F(Live, WithoutAPadItStandsAndRecordsNothing) {
  options_.pad.wish.pad = "0001:fffe";
  auto session = started();
  sleep_for(200);
  const auto run = session->stop();
  ASSERT_TRUE(run);
  EXPECT_EQ(run->walkers[0].steps[kLeftSide], 0);
  EXPECT_FALSE(fs::exists(options_.live.record));
}

TEST_F(Live, EndsWithItsRecordingWhereItIsNotStopped) {
  {
    auto session = started();
    sleep_for(300);
  }
  EXPECT_TRUE(read_trace(options_.live.record));
}

TEST_F(Live, WrongWishesAreRefused) {
  options_.rate_hz = 0;
  EXPECT_EQ(LiveSession::start(options_).error().message,
            "a rate of 0 Hz is not within 1 .. 10000");
  options_.rate_hz = 240;
  options_.live.record = (folder_ / "none" / "x.hid").string();
  EXPECT_FALSE(LiveSession::start(options_));
  options_.live.record.clear();
  options_.walk.styles = {"no_such_style"};
  EXPECT_FALSE(LiveSession::start(options_));
}

}  // namespace
}  // namespace gaitpad
