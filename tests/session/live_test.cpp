// Live sessions from start to summary, which equals the summary of a replay of the recording.
#include "gaitpad/live.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>

#include "gaitpad/decode.h"
#include "gaitpad/pad_configuration.h"
#include "system/clock.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

// Sessions run in real time; a recording replaces the pads. The tests wait for what takes time, and
// judge rates only while the session could run, so that they pass on a busy machine.

namespace fs = std::filesystem;

TEST_F(Live, ReportsTheNewestTickAndItsStatus) {
  options_.live.record.clear();
  auto session = started();
  std::int64_t tick = -1;
  bool first_drives = false;
  ASSERT_TRUE(comes_true([&] {
    bool is_new = false;
    const SessionFrame& frame = session->latest(is_new);
    EXPECT_GE(frame.tick, tick);
    tick = frame.tick;
    first_drives |= frame.pad.device == 0 && frame.pad.state.axis[kLeftY] > 0.5f;
    return tick >= 150 && first_drives && session->status().pads.plugged >= 2;
  }));
  const LiveStatus status = session->status();
  EXPECT_GE(status.ticks, 150);
  EXPECT_GT(status.tick_us_median, 0.0);
  EXPECT_GE(status.tick_us_max, 0.99 * status.tick_us_median);
  EXPECT_GT(status.wait_us_median, 0.0);
  ASSERT_TRUE(session->stop());
  EXPECT_FALSE(session->stop()) << "a session stops once";
}

TEST_F(Live, MeasuresFromTheReportToTheFrameThatShowsIt) {
  options_.live.record.clear();
  auto session = started();
  ASSERT_TRUE(comes_true([&] { return session->status().pads.reports > 10; }));
  session->latest_due();
  session->end_frame(FrameEnd::not_shown);
  EXPECT_EQ(session->status().frame_us_p99, 0.0) << "what no frame shows is not measured";
  constexpr int kFrame_ms = 20, kDraw_ms = 5;
  std::int64_t longest_ns = 0, before_ns = now_ns();
  for (int i = 0; i < 40; ++i) {
    session->latest_due();
    sleep_for(kDraw_ms);
    session->end_frame(FrameEnd::handed_over);
    const std::int64_t time_ns = now_ns();
    longest_ns = std::max(longest_ns, time_ns - std::exchange(before_ns, time_ns));
    sleep_for(kFrame_ms - kDraw_ms);
  }
  const LiveStatus status = session->status();
  EXPECT_GE(status.frame_us_p50, 1000.0 * kDraw_ms);
  EXPECT_GE(status.frame_us_p99, status.frame_us_p50);
  // The longest way of a report: it waits for its tick, for the rest of a frame, and for a whole
  // frame to be drawn.
  const double longest_us = static_cast<double>(longest_ns) / 1000.0;
  EXPECT_LE(status.frame_us_p99, 1.01 * (status.wait_us_max + status.tick_us_max + 2 * longest_us));
}

TEST_F(Live, TheFrameBeforeDrawingHasEveryTickThatIsDue) {
  options_.live.record.clear();
  auto session = started();
  ASSERT_TRUE(comes_true([&] { return session->status().ticks > 0; }));
  int complete = 0;
  EXPECT_TRUE(comes_true([&] {
    sleep_for(7);
    const std::int64_t before_ns = now_ns(), tick_ns = 1'000'000'000 / 240;
    complete += session->latest_due().time_ns + tick_ns > before_ns;
    return complete == 25;
  }));
}

TEST_F(Live, TicksMissedInAStandstillAreNotMadeUp) {
  auto session = started();
  sleep_for(600);
  const std::string wake = "sleep 1.6; kill -CONT " + std::to_string(::getpid());
  const char* const words[] = {"sh", "-c", wake.c_str(), nullptr};
  pid_t sleeper = 0;
  ASSERT_EQ(::posix_spawn(&sleeper, "/bin/sh", nullptr, nullptr, const_cast<char* const*>(words),
                          environ),
            0);
  ::kill(::getpid(), SIGSTOP);
  ::waitpid(sleeper, nullptr, 0);
  ASSERT_TRUE(comes_true([&] { return session->status().standstills > 0; }));
  sleep_for(300);
  const LiveStatus status = session->status();
  EXPECT_GT(status.skipped_s, 1.3);
  EXPECT_LE(static_cast<double>(status.ticks), 240 * (status.time_s - status.skipped_s) + 2)
      << "missed ticks are not made up";
  const auto remarks = session->take_remarks();
  EXPECT_GE(std::ranges::count_if(
                remarks, [](const std::string& s) { return s.find("stood still") != s.npos; }),
            1);
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  stopped(*session);
}

TEST_F(Live, WithoutAPadItStandsAndNothingIsRecorded) {
  options_.pad.selector.pad = "0001:fffe";
  auto session = started();
  sleep_for(200);
  bool is_new = false;
  EXPECT_EQ(session->latest(is_new).walkers[0].walk.steps[kLeftSide], 0);
  const auto run = session->stop();
  ASSERT_FALSE(run);
  EXPECT_EQ(run.error().message, options_.live.record + ": nothing was recorded: there was no pad");
  EXPECT_FALSE(fs::exists(options_.live.record));
}

// Under ThreadSanitizer it shows that everything that pads, loop, stream, recorder and viewer share
// is guarded.
TEST_F(Live, FourPadsAStreamAndARecordingRunAtOnce) {
  Trace trace;
  for (int i = 0; i < 4; ++i) {
    TraceDevice& device = trace.devices.emplace_back();
    device.index = i;
    device.info = made_pad();
    device.info.unique_id = std::to_string(i);
  }
  for (int ms = 0; ms <= 1000; ms += 8) {
    for (std::uint16_t i = 0; i < 4; ++i)
      add_event(trace, ms * 1000, made_report(0x80, ms < 80 ? 0x80 : 0x10 + (ms + i) % 23, i));
  }
  for (std::uint16_t i = 1; i < 4; ++i)
    add_event(trace, 1'000'000, made_plug(ReportKind::removed, i));
  ASSERT_TRUE(write_trace(trace, options_.pad.selector.pad));
  options_.live.stream = "json://127.0.0.1:39599";  // an address where no program listens
  auto session = started();
  EXPECT_TRUE(comes_true([&] {
    bool is_new = false;
    static_cast<void>(session->latest(is_new));
    static_cast<void>(session->status());
    return session->has_ended();
  }));
  const RunSummary run = stopped(*session);
  EXPECT_GE(run.reports, 4 * 126);
  const LiveStatus status = session->status();
  EXPECT_EQ(status.pads.plugged, 4);
  EXPECT_GT(status.streamed, 0);
  EXPECT_EQ(status.recording_lost, 0);
}

TEST_F(Live, DestroyingASessionCompletesItsRecording) {
  {
    auto session = started();
    EXPECT_TRUE(comes_to_be_driven(*session));
  }
  const auto trace = read_trace(options_.live.record);
  EXPECT_TRUE(trace) << trace.error().message;
}

TEST_F(Live, TheSessionGoesOnWhenItsRecordingIsEnded) {
  auto session = started();
  EXPECT_TRUE(comes_to_be_driven(*session));
  EXPECT_FALSE(session->end_recording());
  const std::int64_t ticks = session->status().ticks;
  EXPECT_GT(replayed().ticks, 0);
  EXPECT_LE(replayed().ticks, ticks);
  EXPECT_TRUE(comes_true([&] { return session->status().ticks > ticks + 10; }));
  EXPECT_FALSE(session->end_recording());  // nothing is being recorded
  EXPECT_TRUE(session->stop());
}

TEST_F(Live, InvalidOptionsAreRefused) {
  for (const int rate_hz : {0, kLeastRateHz - 1}) {
    options_.rate_hz = rate_hz;
    EXPECT_EQ(LiveSession::prepare(options_).error().message,
              "SessionSpec: rate_hz is " + std::to_string(rate_hz) + ", outside [10, 10000]");
  }
  options_.rate_hz = 240;
  options_.live.record = (folder_ / "none" / "x.hid").string();
  EXPECT_FALSE(LiveSession::start(options_));
  options_.live.record.clear();
  options_.walk.styles = {"no_such_style"};
  EXPECT_FALSE(LiveSession::start(options_));
}

// --- the keyboard as a pad

class LiveKeyboard : public Live {
 protected:
  void SetUp() override {
    Live::SetUp();
    options_.live.keyboard = true;
    options_.pad.selector.pad = "0001:fffe";  // ids that no pad has
  }
  static double distance_m(LiveSession& session) {
    bool is_new = false;
    const SessionFrame& frame = session.latest(is_new);
    return frame.tick < 0 ? 0.0 : frame.walkers[0].pose.root_m.z;
  }
  // The recorded left stick after each input report of this driver's device.
  std::vector<vec2> recorded_stick(const std::string& driver) {
    const Trace trace = value_of(read_trace(options_.live.record));
    std::vector<vec2> all;
    for (std::size_t d = 0; d < trace.devices.size(); ++d) {
      if (trace.devices[d].info.driver != driver) continue;
      const PadLayout layout = value_of(pad_layout(trace.devices[d].info, {}));
      PadState state;
      for (const TraceEvent& e : trace.events) {
        if (e.device != d || e.kind != ReportKind::input) continue;
        EXPECT_TRUE(decode(layout, report_of(trace, e), state));
        all.emplace_back(state.axis[kLeftX], state.axis[kLeftY]);
      }
    }
    return all;
  }
};

TEST_F(LiveKeyboard, WalksAndItsRecordingReplaysToTheSamePoses) {
  auto session = started();
  EXPECT_TRUE(comes_true([&] { return session->pad_name(0) == "Keyboard"; }));
  session->steer(vec2(0.0, 1.0));
  EXPECT_TRUE(comes_true([&] { return distance_m(*session) > 1.0; }));
  session->steer(vec2(1.0, 1.0));
  sleep_for(400);
  session->steer(vec2(0.0));
  bool is_new = false;
  EXPECT_TRUE(comes_true([&] { return session->latest(is_new).stick.left == vec2(0.0); }))
      << "exactly at rest";
  const RunSummary run = stopped(*session);
  EXPECT_EQ(run.bad_reports, 0);
  EXPECT_EQ(session->status().pads.plugged, 0) << "the keyboard does not count as a pad";
  const std::vector<vec2> stick = recorded_stick("keyboard");
  ASSERT_GT(stick.size(), 5u);
  EXPECT_EQ(stick.front(), vec2(0.0));
  EXPECT_EQ(stick.back(), vec2(0.0));
  const auto y = [](const vec2& s) { return s.y; };
  EXPECT_EQ(std::ranges::max(stick, {}, y).y, 1.0);
}

TEST_F(LiveKeyboard, TheLargestDeflectionIsOneAndTheSmallestCounts) {
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  bool is_new = false;
  EXPECT_TRUE(comes_true([&] {
    session->steer(vec2(0.0, 1.0));
    session->advance(1);
    return session->latest(is_new).stick.left.y == 1.0;
  }));
  session->steer(vec2(0.002, 0.0));
  EXPECT_TRUE(comes_true([&] {
    session->advance(1);
    return session->latest(is_new).stick.left.y == 0.0;
  }));
  EXPECT_NEAR(session->latest(is_new).stick.left.x, 0.002, 1e-4);
}

// The user's calibration of a pad must not change the keyboard's stick.
TEST_F(LiveKeyboard, ACalibrationOfAPadDoesNotApply) {
  options_.pad.calibration = (folder_ / "pad.toml").string();
  std::ofstream(options_.pad.calibration) << "[left]\ninner = 0.5\nouter = 0.9\n";
  auto session = started();
  session->steer(vec2(0.0, 0.3));
  bool is_new = false;
  EXPECT_TRUE(comes_true([&] { return session->latest(is_new).stick.left.y > 0.29; }));
  stopped(*session);
}

TEST_F(LiveKeyboard, ARecordingAsPadStillEndsTheSession) {
  options_.pad.selector.pad = (folder_ / "pads.hid").string();
  auto session = started();
  session->steer(vec2(1.0, 0.0));
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  stopped(*session);
  EXPECT_EQ(session->status().pads.plugged, 4) << "two pads, plugged in twice each";
}

// A pad that rests for four seconds and is then held to the right for one.
Trace late_pad_trace() {
  Trace trace;
  trace.devices.emplace_back().info = made_pad();
  for (int ms = 0; ms <= 5000; ms += 8) {
    add_event(trace, ms * 1000, made_report(ms < 4000 ? 0x80 : 0xff, 0x80));
  }
  return trace;
}

TEST_F(LiveKeyboard, DrivesWhileThePadRests) {
  options_.pad.selector.pad = (folder_ / "late.hid").string();
  ASSERT_TRUE(write_trace(late_pad_trace(), options_.pad.selector.pad));
  auto session = started();
  session->steer(vec2(0.0, 1.0));
  vec2 stick(0.0);
  std::string driving;
  const auto look = [&] {
    bool is_new = false;
    const SessionFrame& frame = session->latest(is_new);
    stick = frame.stick.left;
    driving = session->pad_name(frame.pad.device);
  };
  EXPECT_TRUE(comes_true([&] { return look(), stick == vec2(0.0, 1.0); }));
  EXPECT_TRUE(comes_true([&] { return look(), stick.x > 0.99; }));
  EXPECT_EQ(driving, "Example Walk Pad");
  stopped(*session);
}

TEST_F(LiveKeyboard, SteeringDoesNothingWithoutAKeyboard) {
  options_.live.keyboard = false;
  options_.live.record.clear();
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  session->steer(vec2(0.0, 1.0));
  sleep_for(50);
  session->advance(10);
  bool is_new = false;
  EXPECT_EQ(session->latest(is_new).stick.left, vec2(0.0));
}

// --- when ticks run: standing still, steps, slow motion, by hand

class LivePace : public Live {
 protected:
  // Waits until no tick has run for nearly half a second; returns the number of ticks.
  static std::int64_t ticks_when_still(LiveSession& session) {
    std::int64_t before = -1, ticks = session.status().ticks;
    while (ticks != before) {
      sleep_for(400);
      before = std::exchange(ticks, session.status().ticks);
    }
    return ticks;
  }
  // Waits about 200 ms and returns true if the session runs that number of ticks a second. It tries
  // again, because a busy machine may disturb a measurement.
  static bool runs_at(const LiveSession& session, double rate_hz) {
    return comes_true([&] {
      const std::int64_t before = session.status().ticks, begin_ns = now_ns();
      sleep_for(200);
      const auto ticks = static_cast<double>(session.status().ticks - before);
      const double due = rate_hz * static_cast<double>(now_ns() - begin_ns) * 1e-9;
      return std::abs(ticks - due) < 0.1 * due + 2.0;
    });
  }
};

TEST_F(LivePace, TicksFollowTheRateAndThePace) {
  options_.live.record.clear();
  options_.rate_hz = 500;
  auto session = started();
  EXPECT_TRUE(runs_at(*session, 500));
  for (const double pace : {0.25, 4.0}) {
    session->set_pace(pace);
    EXPECT_TRUE(runs_at(*session, 500 * pace)) << pace;
  }
}

TEST_F(LivePace, StandingStillIsNotLatenessAndIsNotMadeUp) {
  auto session = started();
  sleep_for(200);
  session->set_pace(0.0);
  const std::int64_t still = ticks_when_still(*session);
  sleep_for(1300);
  EXPECT_EQ(session->status().ticks, still);
  session->set_pace(1.0);
  const std::int64_t begin_ns = now_ns();
  ASSERT_TRUE(comes_true([&] { return session->status().ticks > still + 50; }));
  const LiveStatus after = session->status();
  EXPECT_LE(static_cast<double>(after.ticks - still),
            240e-9 * static_cast<double>(now_ns() - begin_ns) + 2)
      << "the ticks of the pause are not made up";
  EXPECT_EQ(after.standstills + after.overloads, 0);
  EXPECT_EQ(after.skipped_s, 0.0);
  EXPECT_LT(after.late_us_max, 1e6);
  EXPECT_LT(after.wait_us_max, 1e6)
      << "reports that arrive during the pause do not count as waiting";
  EXPECT_EQ(after.pads.lost, 0);
  EXPECT_EQ(session->take_remarks(), std::vector<std::string>());
  ASSERT_TRUE(session->stop());
  EXPECT_EQ(session->status().recording_lost, 0);
}

TEST_F(LivePace, AStepIsOneTickAndWorksOnlyWhileStandingStill) {
  options_.live.record.clear();
  auto session = started();
  session->step(100'000);  // a step has no effect while the session runs
  sleep_for(100);
  session->set_pace(0.0);
  session->step(1);  // another step at once, before the loop has seen the first one
  const std::int64_t still = ticks_when_still(*session);
  EXPECT_LT(still, 100'000);
  for (const int steps : {1, 4, 60}) {
    const std::int64_t before = session->status().ticks;
    session->step(steps);
    EXPECT_EQ(ticks_when_still(*session), before + steps);
  }
  session->step(0);
  session->step(-5);
  EXPECT_EQ(ticks_when_still(*session), still + 65);
  bool is_new = false;
  EXPECT_EQ(session->latest(is_new).tick, still + 64);
}

TEST_F(LivePace, NotANumberAndNegativePacesStandStill) {
  options_.live.record.clear();
  auto session = started();
  for (const double pace : {-1.0, std::nan(""), 1e-12}) {
    session->set_pace(pace);
    const std::int64_t still = ticks_when_still(*session);
    session->set_pace(1e300);  // the pace is limited to 8
    EXPECT_TRUE(comes_true([&] { return session->status().ticks > still; }));
  }
}

TEST_F(LivePace, StoppingDoesNotWaitForADistantTick) {
  options_.live.record.clear();
  options_.rate_hz = kLeastRateHz;
  auto session = started();
  session->set_pace(1.0 / 1024.0);
  sleep_for(100);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(session->stop());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kPatience) << "not 100 s";
}

TEST_F(LivePace, ARecordingOfCommandsPausesStepsAndSlowMotionReplaysToTheSamePoses) {
  auto session = started();
  sleep_for(300);
  session->set_pace(0.0);
  sleep_for(100);
  session->command("style tired");
  session->command("style 2 stiff_hip\n");
  session->command("   ");
  session->command("no such command");
  for (int i = 0; i < 5; ++i) {
    session->step(i);
    sleep_for(30);
  }
  session->set_pace(0.25);
  sleep_for(400);
  session->set_pace(3.0);
  sleep_for(200);
  session->set_pace(1.0);
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  session->set_pace(0.0);
  sleep_for(50);
  const RunSummary run = stopped(*session);
  ASSERT_EQ(run.walkers.size(), 2u);
  EXPECT_EQ(run.walkers[0].style, "tired");
  EXPECT_EQ(run.walkers[1].style, "stiff_hip");
  EXPECT_GT(run.walkers[0].steps[kLeftSide] + run.walkers[0].steps[kRightSide], 0);
  EXPECT_GT(run.reports, 100);
  EXPECT_EQ(run.bad_reports, 0);
  EXPECT_EQ(session->status().recording_lost, 0);
  EXPECT_EQ(session->status().pads.lost, 0);
}

TEST_F(LivePace, AViewerGetsASampleOfEveryTickInOrder) {
  options_.live.record.clear();
  auto session = started();
  std::int64_t next = 0;
  TickSample sample;
  const auto take_all = [&] {
    while (session->take_sample(sample)) {
      ASSERT_EQ(sample.tick, next++);
      EXPECT_EQ(sample.walker_count, 2);
      EXPECT_GT(sample.step_us, 0.0f);
    }
  };
  while (next < 200) {
    take_all();
    sleep_for(10);
  }
  ASSERT_TRUE(session->stop());
  take_all();
  EXPECT_EQ(next, session->status().ticks);
}

TEST_F(LivePace, AFrameIsMadeOnlyAsOftenAsItIsAskedFor) {
  options_.live.record.clear();
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  for (const int ticks : {0, 1, 10}) {
    options_.live.frame_ticks = ticks;
    auto session = started();
    int frames = 0;
    for (int i = 0; i < 40; ++i) {
      session->advance(1);
      bool is_new = false;
      static_cast<void>(session->latest(is_new));
      frames += is_new ? 1 : 0;
    }
    EXPECT_EQ(frames, ticks == 0 ? 0 : 40 / ticks);
  }
}

TEST_F(LivePace, OnlySamplesThatNobodyTakesAreDropped) {
  options_.live.record.clear();
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  session->advance(5000);
  TickSample sample;
  std::int64_t count = 0;
  while (session->take_sample(sample)) EXPECT_EQ(sample.tick, count++);
  EXPECT_GE(count, 1000);
  EXPECT_LT(count, 5000);
  EXPECT_EQ(session->status().ticks, 5000);
  session->advance(1);
  ASSERT_TRUE(session->take_sample(sample));
  EXPECT_EQ(sample.tick, 5000);
}

TEST_F(LivePace, LatenessWaitsAndThePolicyAreToldAfterTheEnd) {
  options_.live.record.clear();
  auto session = started();
  const auto waits = [&] {
    std::int64_t sum = 0;
    for (const std::int64_t count : session->status().wait_counts) sum += count;
    return sum;
  };
  EXPECT_TRUE(comes_true([&] { return waits() > 80; }))
      << "two pads send 125 reports a second each";
  ASSERT_TRUE(session->stop());
  const LiveStatus status = session->status();
  EXPECT_LE(static_cast<double>(status.ticks), 240.0 * status.time_s + 1.0);
  EXPECT_GT(status.late_us_max, 0.0);
  EXPECT_LE(status.late_us_median, status.late_us_max);
  EXPECT_LE(waits(), status.pads.reports);
  EXPECT_TRUE(status.time_policy == "normal priority" ||
              status.time_policy.starts_with("SCHED_FIFO "))
      << status.time_policy;
}

TEST_F(LivePace, ByHandOnlyRequestedTicksRun) {
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  sleep_for(100);
  bool is_new = true;
  EXPECT_EQ(session->latest(is_new).tick, -1);
  session->advance(0);
  session->advance(-3);
  session->set_pace(0.0);
  session->step(7);
  EXPECT_EQ(session->status().ticks, 0);
  for (int i = 0; i < 400; ++i) {
    session->advance(4);
    EXPECT_EQ(session->latest(is_new).tick, 4 * i + 3);
    sleep_for(2);
  }
  session->command("style 1 tired");
  sleep_for(50);
  session->advance(1);
  const LiveStatus status = session->status();
  EXPECT_EQ(status.ticks, 1601);
  EXPECT_EQ(status.overruns, 0);
  EXPECT_EQ(status.time_policy, "by hand");
  const RunSummary run = stopped(*session);
  EXPECT_EQ(run.walkers[0].style, "tired");
  EXPECT_EQ(run.ticks, 1601);
  EXPECT_GT(run.reports, 50);
  session->advance(1);
  EXPECT_EQ(session->status().ticks, 1601) << "a stopped session runs no tick";
  EXPECT_FALSE(session->stop());
}

TEST_F(LivePace, AdvanceDoesNothingWhileTheClockRunsTicks) {
  options_.live.record.clear();
  options_.rate_hz = kLeastRateHz;
  auto session = started();
  session->advance(1000);
  EXPECT_LT(session->status().ticks, 100);
}

TEST_F(LivePace, GivesTheCastAndTheNamesOfPads) {
  options_.live.record.clear();
  auto session = started();
  const Cast& cast = session->cast();
  ASSERT_EQ(cast.members.size(), 2u);
  EXPECT_EQ(cast.members[0].style, "even");
  EXPECT_EQ(cast.members[1].style, "limp_left");
  EXPECT_EQ(cast.rate_hz, 240);
  EXPECT_TRUE(std::ranges::find(cast.styles, "tired") != cast.styles.end());
  EXPECT_TRUE(comes_true([&] { return session->pad_name(1) == "Example Walk Pad"; }));
  EXPECT_EQ(session->pad_name(2), "");
  EXPECT_EQ(session->pad_name(kNoDevice), "");
}

}  // namespace
}  // namespace gaitpad
