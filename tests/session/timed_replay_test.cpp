#include "session/timed_replay.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kStart_ns = 5'000'000'000;

// A pad whose stick goes right after 0.25 s; a command in between; it is unplugged after 0.5 s.
Trace made_trace() {
  Trace trace;
  trace.path = "made.hid";
  trace.devices.push_back({.index = 0, .info = made_pad(), .calibration = ""});
  add_event(trace, 1'000'000, made_report(0x80, 0x80));
  Report command = made_command("pause");
  command.device = kNoDevice;
  add_event(trace, 1'100'000, command);
  add_event(trace, 1'250'000, made_report(0xff, 0x80));
  add_event(trace, 1'500'000, made_plug(ReportKind::removed));
  return trace;
}

// Waits for nothing and notes the times.
struct Clock {
  std::vector<std::int64_t> times_ns;
  std::size_t most = 1'000'000;  // the user ends the playback after this number of waits
  WaitUntil wait() {
    return [this](std::int64_t time_ns) {
      times_ns.push_back(time_ns - kStart_ns);
      return times_ns.size() <= most;
    };
  }
};

TEST(TimedReplay, ReportsAreTakenAtTheirTimesAndCommandsAreNot) {
  Clock clock;
  std::vector<Report> taken;
  const auto reports =
      play_reports(made_trace(), kStart_ns, clock.wait(), [&](const Report& report) {
        taken.push_back(report);
        return std::optional<Error>();
      });
  EXPECT_EQ(value_of(reports), 2);
  EXPECT_EQ(clock.times_ns, (std::vector<std::int64_t>{0, 250'000'000, 500'000'000}));
  ASSERT_EQ(taken.size(), 3u);
  EXPECT_EQ(taken[1].bytes[0], 0xff);
  EXPECT_EQ(taken[2].kind, ReportKind::removed);
}

TEST(TimedReplay, AUserEndsItBetweenReports) {
  Clock clock{.times_ns = {}, .most = 1};
  const auto reports = play_reports(made_trace(), kStart_ns, clock.wait(),
                                    [](const Report&) { return std::optional<Error>(); });
  EXPECT_EQ(value_of(reports), 1);
  EXPECT_EQ(clock.times_ns.size(), 2u);
}

TEST(TimedReplay, AReportThatIsRefusedEndsItWithItsError) {
  Clock clock;
  const auto reports = play_reports(made_trace(), kStart_ns, clock.wait(),
                                    [](const Report&) { return std::optional(Error{"refused"}); });
  ASSERT_FALSE(reports);
  EXPECT_EQ(reports.error().message, "refused");
  EXPECT_EQ(clock.times_ns.size(), 1u);
}

TEST(TimedReplay, EachTickSendsTheCalibratedPadAndAnUnpluggedOneIsAtRest) {
  SessionSpec spec;
  spec.rate_hz = 100;
  TickedReplay replay = value_of(ticked_replay(spec, made_trace()));
  EXPECT_EQ(replay.ticks, 150);  // one second longer than the last event
  Clock clock;
  std::vector<double> x;
  const auto reports = play_ticks(replay, kStart_ns, clock.wait(), [&](const VirtualPadState& s) {
    x.push_back(s.stick.left.x);
    return true;
  });
  EXPECT_EQ(reports, 2);
  ASSERT_EQ(clock.times_ns.size(), 150u);
  EXPECT_EQ(clock.times_ns[37], 370'000'000);
  ASSERT_EQ(x.size(), 300u);  // two states a tick, equal unless a press would be lost
  EXPECT_EQ(x[2 * 24 + 1], 0.0);
  EXPECT_GT(x[2 * 26 + 1], 0.9);
  EXPECT_EQ(x[2 * 51 + 1], 0.0);
}

TEST(TimedReplay, APadThatTheKernelRefusesEndsIt) {
  SessionSpec spec;
  TickedReplay replay = value_of(ticked_replay(spec, made_trace()));
  Clock clock;
  EXPECT_EQ(play_ticks(replay, kStart_ns, clock.wait(), [](const auto&) { return false; }),
            std::nullopt);
  EXPECT_EQ(clock.times_ns.size(), 1u);
}

TEST(TimedReplay, ARecordingWithoutAPadIsRefused) {
  Trace trace = made_trace();
  trace.devices[0].info.descriptor = {0x05, 0x0c, 0x09, 0x01, 0xa1, 0x01, 0xc0};
  const auto replay = ticked_replay({}, std::move(trace));
  ASSERT_FALSE(replay);
  EXPECT_EQ(replay.error().message, "made.hid: none of its devices is a pad");
}

}  // namespace
}  // namespace gaitpad
