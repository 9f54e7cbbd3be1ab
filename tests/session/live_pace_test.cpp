// When ticks run: standing still, steps, slow motion, by hand; what a viewer is told of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "gaitpad/live.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

class LivePace : public Live {
 protected:
  // Until no tick has run for a tenth of a second.
  static std::int64_t ticks_when_still(LiveSession& session) {
    std::int64_t before = -1, ticks = session.status().ticks;
    while (ticks != before) {
      sleep_for(100);
      before = std::exchange(ticks, session.status().ticks);
    }
    return ticks;
  }
};

TEST_F(LivePace, StandingStillIsNoLatenessAndNothingIsMadeUpFor) {
  auto session = started();
  sleep_for(200);
  session->set_pace(0.0);
  const std::int64_t still = ticks_when_still(*session);
  const LiveStatus before = session->status();
  sleep_for(1300);
  EXPECT_EQ(session->status().ticks, still);
  session->set_pace(1.0);
  sleep_for(300);
  const LiveStatus after = session->status();
  EXPECT_GT(after.ticks, still);
  EXPECT_LT(after.ticks - still, 240) << "more than a second was not run";
  EXPECT_EQ(after.standstills + after.overloads, 0);
  EXPECT_EQ(after.skipped_s, 0.0);
  EXPECT_LT(after.late_us_max, 1e6);
  EXPECT_LT(after.wait_us_max, 1e6) << "what came meanwhile has waited for nobody";
  EXPECT_EQ(after.pads.lost, 0);
  EXPECT_EQ(session->take_remarks(), std::vector<std::string>());
  ASSERT_TRUE(session->stop());
  EXPECT_EQ(session->status().recording_lost, 0);
}

TEST_F(LivePace, AStepIsOneTickAndCountsOnlyWhileItStandsStill) {
  options_.live.record.clear();
  auto session = started();
  session->step(100'000);  // of no effect: it runs
  sleep_for(100);
  session->set_pace(0.0);
  session->step(1);  // at once behind it, before the loop has seen either
  const std::int64_t still = ticks_when_still(*session);
  EXPECT_LT(still, 240);
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

TEST_F(LivePace, AtAQuarterOfThePaceThereIsAQuarterOfTheTicks) {
  options_.live.record.clear();
  auto session = started();
  ASSERT_TRUE(comes_true([&] { return session->status().ticks > 0; }));
  for (const double pace : {0.25, 4.0}) {
    session->set_pace(pace);
    sleep_for(50);
    const LiveStatus before = session->status();
    sleep_for(1000);
    const LiveStatus after = session->status();
    const double seconds = after.time_s - before.time_s;
    const auto ticks = static_cast<double>(after.ticks - before.ticks);
    EXPECT_NEAR(ticks, 240.0 * pace * seconds, 25.0 * pace) << pace;
  }
}

TEST_F(LivePace, NoNumberAndLessThanNothingStandStill) {
  options_.live.record.clear();
  auto session = started();
  for (const double pace : {-1.0, std::nan(""), 1e-12}) {
    session->set_pace(pace);
    const std::int64_t still = ticks_when_still(*session);
    session->set_pace(1e300);  // 8 is the most
    EXPECT_TRUE(comes_true([&] { return session->status().ticks > still; }));
  }
}

TEST_F(LivePace, AStopWaitsForNoTickThatIsFarAway) {
  options_.live.record.clear();
  options_.rate_hz = 1;
  auto session = started();
  session->set_pace(1.0 / 1024.0);
  sleep_for(100);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(session->stop());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5)) << "not 17 minutes";
}

TEST_F(LivePace, ARecordingOfPausesStepsAndSlowMotionReplaysToTheSamePoses) {
  auto session = started();
  sleep_for(300);
  session->set_pace(0.0);
  sleep_for(100);
  session->command("style 2 tired");
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
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
  EXPECT_EQ(run->walkers[1].style, "tired");
  EXPECT_GT(run->walkers[0].steps[kLeftSide], 0);
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

TEST_F(LivePace, SamplesThatNobodyTakesAreDroppedAndNothingElse) {
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

TEST_F(LivePace, TheTimeIsTheTicksOverTheRate) {
  options_.live.record.clear();
  auto session = started();
  sleep_for(700);
  ASSERT_TRUE(session->stop());
  const LiveStatus status = session->status();
  // The last one may have been late, and the stop is seen within a nap.
  EXPECT_NEAR(static_cast<double>(status.ticks), 240.0 * status.time_s, 12.0);
  EXPECT_GT(status.late_us_max, 0.0);
  EXPECT_LE(status.late_us_median, status.late_us_max);
  std::int64_t waits = 0;
  for (const std::int64_t count : status.wait_counts) waits += count;
  EXPECT_GT(waits, 80) << "125 reports a second of two pads";
  EXPECT_LE(waits, status.pads.reports);
  EXPECT_TRUE(status.time_policy == "normal priority" ||
              status.time_policy.starts_with("SCHED_FIFO "))
      << status.time_policy;
}

TEST_F(LivePace, ByHandNothingRunsButWhatIsAskedFor) {
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
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
  EXPECT_EQ(run->walkers[0].style, "tired");
  EXPECT_EQ(run->ticks, 1601);
  EXPECT_GT(run->reports, 50);
  session->advance(1);
  EXPECT_EQ(session->status().ticks, 1601) << "it was stopped";
  EXPECT_FALSE(session->stop());
}

TEST_F(LivePace, HalfAnHourByHandIsARecordingThatReads) {
  options_.rate_hz = 20;
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  sleep_for(50);
  session->advance(20 * 1800);
  sleep_for(50);
  session->advance(1);
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
}

TEST_F(LivePace, ByTheClockNobodyElseRunsTicks) {
  options_.live.record.clear();
  options_.rate_hz = 1;
  auto session = started();
  session->advance(1000);
  EXPECT_LT(session->status().ticks, 100);
}

TEST_F(LivePace, TheCastAndTheNamesOfPadsAreTold) {
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
