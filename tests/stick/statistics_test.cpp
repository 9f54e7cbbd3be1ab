// The statistics as a whole, on made sticks and on real recordings; stills, rests, outline and
// reports have their own tests.
#include "stick/statistics.h"

#include <gtest/gtest.h>

#include <ctime>
#include <limits>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "stick/made_stick.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

TEST(StickStatistics, AFrameTurnsTheStatistics) {
  MadeStick stick;
  stick.centre = vec2(0.1, -0.05);
  stick.sigma = vec2(0.004, 0.01);
  stick.frame = {RawDirection::minus_y, RawDirection::plus_x};
  const auto tracks = in_frame(stick.frame, {made_track(stick)});
  const StickStatistics s = stick_statistics(tracks, vec2(0.0));
  ASSERT_TRUE(s.centre && s.sigma);
  EXPECT_NEAR(s.centre->x, 0.1, 1e-3);
  EXPECT_NEAR(s.centre->y, -0.05, 1e-3);
  EXPECT_NEAR(s.sigma->x, 0.004, 0.0006);
  EXPECT_NEAR(s.sigma->y, 0.01, 0.0015);
}

TEST(StickStatistics, TooFewSamplesGiveNoNumbers) {
  for (const StickTrack& track :
       {StickTrack{}, StickTrack{{0, {0.1, 0.1}}}, StickTrack(3, {5, {0.0, 0.0}})}) {
    const StickStatistics s = stick_statistics(std::vector<StickTrack>{track}, vec2(0.0));
    EXPECT_EQ(s.samples, static_cast<std::int64_t>(track.size()));
    EXPECT_FALSE(s.centre || s.sigma || s.hysteresis || s.drift_per_s || s.rate_hz || s.jitter_ms);
    EXPECT_EQ(s.wander, 0.0);
  }
  EXPECT_EQ(stick_statistics({}, vec2(0.0)).samples, 0);
}

TEST(StickStatistics, InvalidNumbersDoNotCrash) {
  std::mt19937 random(3);
  const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -1e300,
                        1e300,
                        5e-324,
                        1.0};
  const std::int64_t times[] = {std::numeric_limits<std::int64_t>::min(), -1, 0, 1, 4'000'000,
                                std::numeric_limits<std::int64_t>::max()};
  for (int round = 0; round < 40; ++round) {
    MadeStick stick;
    stick.seed = static_cast<std::uint32_t>(round);
    StickTrack track = made_track(stick, 2, 0.3, 0.5);
    for (int k = 0; k < 200; ++k) {
      StickSample& sample = track[random() % track.size()];
      if (k % 3 == 0) sample.raw.x = odd[random() % 6];
      if (k % 3 == 1) sample.raw.y = odd[random() % 6];
      if (k % 3 == 2 && round % 2 == 0) sample.time_ns = times[random() % 6];
    }
    const StickStatistics s = stick_statistics(std::vector<StickTrack>{track, track}, vec2(odd[0]));
    if (s.centre) {
      EXPECT_LE(glm::length(*s.centre), 2.0);
    }
  }
}

TEST(StickStatistics, AHundredThousandSamplesTakeATenthOfASecondOrSo) {
  MadeStick stick;
  stick.rate_hz = 1000.0;
  stick.sigma = vec2(0.01);
  stick.bits = 8;
  MadeMoves moves(stick);
  while (moves.path().size() < 100'000) {
    let_go_from(moves, 0.001 * static_cast<double>(moves.path().size()));
    moves.turn(1.0);
  }
  const StickTrack track = reported(stick, moves.path());
  // Measures processor time, which is independent of other load: 0.06 s without sanitizers.
  const std::clock_t begin = std::clock();
  statistics_of(stick, track);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 3.0);
}

// ---- triggers ----

TriggerTrack trigger_track(const std::vector<std::pair<double, double>>& value_and_seconds) {
  TriggerTrack track;
  std::int64_t time_ns = 0;
  for (const auto& [value, seconds] : value_and_seconds) {
    for (int k = 0; k < seconds * 250; ++k) track.push_back({time_ns += 4'000'000, value});
  }
  return track;
}

TEST(TriggerStatistics, EndsAreTheLongestHeldValues) {
  const TriggerTrack track =
      trigger_track({{0.02, 2.0}, {0.4, 0.1}, {0.97, 0.5}, {0.5, 0.1}, {0.024, 1.0}});
  const TriggerStatistics s = trigger_statistics(std::vector<TriggerTrack>{track});
  EXPECT_EQ(s.samples, static_cast<std::int64_t>(track.size()));
  EXPECT_EQ(s.released, 0.02);
  EXPECT_EQ(s.pressed, 0.97);
}

TEST(TriggerStatistics, PressedIsUnknownIfItWasNeverPressed) {
  for (const double most : {0.0, 0.3, 0.5}) {
    const TriggerStatistics s =
        trigger_statistics(std::vector<TriggerTrack>{trigger_track({{0.0, 1.0}, {most, 0.5}})});
    EXPECT_EQ(s.released, 0.0);
    EXPECT_FALSE(s.pressed) << most;
  }
  EXPECT_FALSE(trigger_statistics({}).released);
}

TEST(TriggerStatistics, AnOutlierIsNotAnEnd) {
  TriggerTrack track = trigger_track({{0.1, 2.0}, {0.9, 1.0}, {0.1, 2.0}});
  track[100].raw = std::numeric_limits<double>::quiet_NaN();
  track[200].raw = 0.0;
  track[300].raw = 1.0;
  const TriggerStatistics s = trigger_statistics(std::vector<TriggerTrack>{track});
  EXPECT_EQ(s.released, 0.1);
  EXPECT_EQ(s.pressed, 0.9);
}

// ---- real recordings ----

PadTracks recorded(const std::string& name) {
  const auto [trace, layout] = recorded_pad(kPadRecordings + name, shipped_pads());
  PadTracker tracker(layout);
  for (const TraceEvent& event : trace.events) tracker.add_report(report_of(trace, event));
  return tracker.tracks();
}

vec2 median_of(const StickTrack& track) {
  std::vector<double> x, y;
  for (const StickSample& sample : track) {
    x.push_back(sample.raw.x);
    y.push_back(sample.raw.y);
  }
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  return {x[x.size() / 2], y[y.size() / 2]};
}

class RealStickStatistics : public testing::Test {
 protected:
  void SetUp() override { GAITPAD_NEEDS(kPadRecordings); }
};

TEST_F(RealStickStatistics, AnUntouchedStickRestsAtItsMedian) {
  constexpr double kCode = 2.0 / 255.0;
  for (const char* button : {"circle", "dpad_down", "dpad_left", "dpad_right", "dpad_up", "l2",
                             "r1", "r2", "square", "start", "x"}) {
    const PadTracks tracks = recorded("dualsense_usb_" + std::string(button) + ".hid");
    for (int side = 0; side < 2; ++side) {
      const StickStatistics s = stick_statistics(tracks.stick[side], vec2(kCode));
      ASSERT_TRUE(s.centre && s.sigma) << button << side;
      const vec2 off = *s.centre - median_of(tracks.stick[side][0]);
      EXPECT_LT(std::max(std::fabs(off.x), std::fabs(off.y)), kCode) << button << side;
      EXPECT_EQ(s.rest_samples, s.samples) << button << side;
      EXPECT_TRUE(s.is_sigma_hidden) << button << side;
      EXPECT_EQ(s.drift_per_s, 0.0) << button << side;
      EXPECT_EQ(s.wander, 0.0) << button << side;
      EXPECT_FALSE(s.hysteresis) << button << side;
      EXPECT_EQ(s.jump_count + s.stuck_count + s.turns, 0) << button << side;
      EXPECT_NEAR(*s.rate_hz, 250.0, 15.0) << button << side;
    }
  }
}

TEST_F(RealStickStatistics, ATurnedStickRestsOnlyBeforeAndAfter) {
  const PadTracks left = recorded("dualsense_usb_left_stick.hid");
  const StickStatistics s = stick_statistics(left.stick[0], vec2(2.0 / 255.0));
  ASSERT_TRUE(s.centre);
  EXPECT_NEAR(s.centre->x, (131.0 - 127.5) / 127.5, 0.5 / 127.5);
  EXPECT_NEAR(s.centre->y, -(128.0 - 127.5) / 127.5, 0.5 / 127.5);
  EXPECT_NEAR(s.rest_s, 1.05, 0.1);  // the stick lies still for the first 1.1 s
  EXPECT_FALSE(s.hysteresis);
  EXPECT_GE(s.turns, 4);
  const PadTracks right = recorded("dualsense_usb_right_stick.hid");
  const StickStatistics r = stick_statistics(right.stick[1], vec2(2.0 / 255.0));
  EXPECT_EQ(r.rests.size(), 2u);
  ASSERT_TRUE(r.hysteresis);
  EXPECT_LT(*r.hysteresis, 2.0 / 255.0);
}

TEST_F(RealStickStatistics, APadThatIsSilentAtRestHasCentres) {
  const PadTracks tracks = recorded("xbox_elite2_bt_nopaddles.hid");
  for (int side = 0; side < 2; ++side) {
    const StickStatistics s = stick_statistics(tracks.stick[side], vec2(2.0 / 65535.0));
    ASSERT_TRUE(s.centre) << side;
    EXPECT_LT(glm::length(*s.centre), 0.1) << side;
    EXPECT_EQ(s.rests.size(), 2u) << side;
    EXPECT_NEAR(*s.rate_hz, 100.0, 3.0) << side;
    EXPECT_FALSE(s.gap_count) << side;
  }
}

}  // namespace
}  // namespace gaitpad
