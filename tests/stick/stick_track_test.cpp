#include "stick/stick_track.h"

#include <gtest/gtest.h>

#include "stick/made_stick.h"
#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A pad whose reports have ids: 1 has the left stick (8 bits each) and the left trigger (10 bits),
// 2 the right stick's x, 3 its y.
PadLayout split_pad() {
  DeviceInfo device;
  device.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01,                    // a game pad
                       0x85, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15, 0x00, 0x26,  // report 1: X, Y
                       0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02,        // range 0..255
                       0x05, 0x02, 0x09, 0xc5, 0x26, 0xff, 0x03, 0x75, 0x0a,  // Brake 0..1023
                       0x95, 0x01, 0x81, 0x02, 0x75, 0x06, 0x81, 0x03,        //
                       0x85, 0x02, 0x05, 0x01, 0x09, 0x32, 0x26, 0xff, 0x00,  // report 2: Z
                       0x75, 0x08, 0x95, 0x01, 0x81, 0x02,                    //
                       0x85, 0x03, 0x09, 0x35, 0x81, 0x02, 0xc0};             // report 3: Rz
  const auto pads = parse_pad_file(
      "[[pad]]\n[pad.axes]\nright_x = \"0001:0032\"\nright_y = \"0001:0035\"\n"
      "left_trigger = \"0002:00c5\"\nright_trigger = \"\"\n",
      "split.toml");
  return value_of(pad_layout(device, value_of(pads)));
}

Report report_at(std::int64_t time_ns, const Bytes& bytes) { return report_of(bytes, time_ns); }

TEST(StickTrack, TheLayoutGivesTheControls) {
  const PadLayout pad = split_pad();
  EXPECT_TRUE(has_stick(pad, 0));
  EXPECT_TRUE(has_stick(pad, 1));
  EXPECT_TRUE(has_trigger(pad, 0));
  EXPECT_FALSE(has_trigger(pad, 1));
  EXPECT_FALSE(has_stick(PadLayout{}, 0));
}

TEST(StickTrack, DeclaredStepIsOneCountOfTheField) {
  const PadLayout pad = split_pad();
  EXPECT_DOUBLE_EQ(declared_step(pad, kLeftX), 2.0 / 255.0);
  EXPECT_DOUBLE_EQ(declared_step(pad, kLeftTrigger), 1.0 / 1023.0);
  EXPECT_EQ(declared_step(pad, kRightTrigger), 0.0);
}

TEST(StickTrack, EachReportAddsToTheControlsInIt) {
  const PadLayout pad = split_pad();
  PadTracker tracker(pad);
  EXPECT_TRUE(tracker.add_report(report_at(10, {1, 255, 0, 0xff, 0x03})));
  EXPECT_TRUE(tracker.add_report(report_at(20, {1, 0, 255, 0x00, 0x00})));
  const PadTracks& tracks = tracker.tracks();
  ASSERT_EQ(tracks.stick[0].size(), 1u);
  ASSERT_EQ(tracks.stick[0][0].size(), 2u);
  EXPECT_EQ(tracks.stick[0][0][0].time_ns, 10);
  // The report's y grows downwards, ours forward.
  EXPECT_EQ(tracks.stick[0][0][0].raw, vec2(1.0, 1.0));
  EXPECT_EQ(tracks.stick[0][0][1].raw, vec2(-1.0, -1.0));
  ASSERT_EQ(tracks.trigger[0].size(), 1u);
  EXPECT_EQ(tracks.trigger[0][0][0].raw, 1.0);
  EXPECT_EQ(tracks.trigger[0][0][1].raw, 0.0);
  EXPECT_TRUE(tracks.stick[1].empty());
}

TEST(StickTrack, AnAxisCountsFromItsFirstReportOn) {
  const PadLayout pad = split_pad();
  PadTracker tracker(pad);
  tracker.add_report(report_at(1, {2, 255}));
  EXPECT_TRUE(tracker.tracks().stick[1].empty());
  tracker.add_report(report_at(2, {3, 255}));
  tracker.add_report(report_at(3, {2, 0}));
  ASSERT_EQ(tracker.tracks().stick[1].size(), 1u);
  ASSERT_EQ(tracker.tracks().stick[1][0].size(), 2u);
  EXPECT_EQ(tracker.tracks().stick[1][0][0].raw, vec2(1.0, -1.0));
  EXPECT_EQ(tracker.tracks().stick[1][0][1].raw, vec2(-1.0, -1.0));
}

TEST(StickTrack, ReportsThatDoNotDecodeAddNothing) {
  const PadLayout pad = split_pad();
  PadTracker tracker(pad);
  EXPECT_FALSE(tracker.add_report(report_at(1, {1, 255})));
  EXPECT_FALSE(tracker.add_report(report_at(2, {9, 0, 0, 0, 0})));
  EXPECT_FALSE(tracker.add_report(report_at(3, {})));
  EXPECT_TRUE(tracker.tracks().stick[0].empty());
}

TEST(StickTrack, UnpluggingEndsATrack) {
  const PadLayout pad = split_pad();
  PadTracker tracker(pad);
  tracker.add_report(report_at(1, {1, 0, 0, 0, 0}));
  tracker.cut();
  EXPECT_EQ(tracker.state().axis[kLeftX], PadState{}.axis[kLeftX]);
  tracker.cut();  // a second cut has no effect
  tracker.add_report(report_at(2, {1, 0, 0, 0, 0}));
  tracker.add_report(report_at(3, {1, 0, 0, 0, 0}));
  ASSERT_EQ(tracker.tracks().stick[0].size(), 2u);
  EXPECT_EQ(tracker.tracks().stick[0][0].size(), 1u);
  EXPECT_EQ(tracker.tracks().stick[0][1].size(), 2u);
  EXPECT_EQ(tracker.tracks().trigger[0].size(), 2u);
}

TEST(StickTrack, TimeNeverGoesBackWithinATrack) {
  const PadLayout pad = split_pad();
  PadTracker tracker(pad);
  for (const std::int64_t time_ns : {5, 3, 7})
    tracker.add_report(report_at(time_ns, {1, 0, 0, 0, 0}));
  const StickTrack& track = tracker.tracks().stick[0][0];
  EXPECT_EQ(track[1].time_ns, 5);
  EXPECT_EQ(track[2].time_ns, 7);
  EXPECT_EQ(tracker.tracks().trigger[0][0][1].time_ns, 5);
}

TEST(StickTrack, AFrameTurnsEverySample) {
  const StickFrame frame{RawDirection::minus_y, RawDirection::plus_x};
  const auto turned = in_frame(frame, {{{1, {0.25, -0.5}}}, {{2, {1.0, 0.0}}, {3, {0.0, 1.0}}}});
  ASSERT_EQ(turned.size(), 2u);
  EXPECT_EQ(turned[0][0].raw, vec2(0.5, 0.25));
  EXPECT_EQ(turned[0][0].time_ns, 1);
  EXPECT_EQ(turned[1][0].raw, vec2(0.0, 1.0));
  EXPECT_EQ(turned[1][1].raw, vec2(-1.0, 0.0));
}

TEST(ReportStatistics, RateJitterStepsAndTurnsOfEveryPad) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    MadeStick stick = Draw(seed).stick();
    stick.spike_chance = 0.0;
    // At 1000 Hz a pad that reports changes only and has coarse codes omits too many reports.
    if (stick.reports_changes_only && stick.rate_hz > 500.0) stick.rate_hz = 500.0;
    const StickStatistics s = statistics_of(stick);
    ASSERT_TRUE(s.rate_hz && s.jitter_ms) << name_of(stick);
    EXPECT_NEAR(*s.rate_hz, stick.rate_hz, 0.02 * stick.rate_hz) << name_of(stick);
    EXPECT_NEAR(*s.jitter_ms, stick.jitter_ms, 0.15 * stick.jitter_ms + 20.0 / stick.rate_hz)
        << name_of(stick);
    EXPECT_EQ(s.turns, 3) << name_of(stick);
    if (stick.bits > 0) {
      EXPECT_NEAR(s.step_x, step_of(stick), 1e-3 * step_of(stick)) << name_of(stick);
      EXPECT_NEAR(s.step_y, step_of(stick), 1e-3 * step_of(stick)) << name_of(stick);
    }
    EXPECT_EQ(s.stuck_count, 0) << name_of(stick);
    EXPECT_EQ(s.jump_count, 0) << name_of(stick);
  }
}

TEST(ReportStatistics, StepIsMeasuredEvenIfTheFieldIsFiner) {
  MadeStick stick;
  stick.bits = 8;
  stick.sigma = vec2(0.01);
  const StickStatistics s =
      stick_statistics(std::vector<StickTrack>{made_track(stick)}, vec2(2.0 / 65535.0));
  EXPECT_NEAR(s.step_x, 2.0 / 255.0, 1e-9);
  // A single value has no step.
  const StickTrack still(100, {0, {0.1, 0.1}});
  EXPECT_EQ(stick_statistics(std::vector<StickTrack>{still}, vec2(0.25, 0.125)).step_y, 0.125);
}

TEST(ReportStatistics, LostReportsAreCountedOnAPadThatRepeatsItself) {
  MadeStick stick;
  stick.bits = 8;
  stick.jitter_ms = 0.8;
  EXPECT_LE(statistics_of(stick).gap_count.value_or(99), 3);
  stick.drop_chance = 0.02;
  const StickTrack track = made_track(stick);
  const double lost = 0.02 * static_cast<double>(track.size());
  EXPECT_NEAR(static_cast<double>(statistics_of(stick, track).gap_count.value_or(0)), lost,
              0.3 * lost);
  stick.reports_changes_only = true;
  EXPECT_FALSE(statistics_of(stick).gap_count);
}

TEST(ReportStatistics, SpikesAreCountedAndChangeNothingElse) {
  for (std::uint32_t seed = 1; seed <= 15; ++seed) {
    MadeStick stick = Draw(seed).stick();
    stick.reports_changes_only = false;
    stick.drop_chance = 0.0;
    stick.sigma = glm::min(stick.sigma, vec2(0.01));
    stick.spike_chance = 0.004;
    const StickTrack track = made_track(stick);
    const StickStatistics s = statistics_of(stick, track);
    // A spike lasts two reports on average.
    const double spikes = 0.004 * static_cast<double>(track.size());
    EXPECT_NEAR(static_cast<double>(s.jump_count), spikes, 0.2 * spikes + 3.0 * std::sqrt(spikes))
        << name_of(stick);
    expect_centre(stick, s, stick.centre);
    EXPECT_EQ(s.drift_per_s, 0.0) << name_of(stick);
  }
}

MadeStick faulty_stick(std::uint32_t seed, double rate_hz) {
  MadeStick stick;
  stick.seed = seed;
  stick.sigma = vec2(0.003);
  stick.bits = 12;
  stick.rate_hz = rate_hz;
  return stick;
}

TEST(ReportStatistics, DropOutsAreCountedInTimeAtEveryRate) {
  for (const double rate_hz : {125.0, 250.0, 1000.0}) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      MadeStick stick = faulty_stick(seed, rate_hz);
      EXPECT_EQ(statistics_of(stick, made_session(stick)).drop_out_count, 0) << name_of(stick);
      stick.drop_outs = 6;
      stick.drop_out_s = 0.04;
      const StickStatistics s = statistics_of(stick, made_session(stick));
      EXPECT_NEAR(static_cast<double>(s.drop_out_count), 6.0, 2.0) << name_of(stick);
      EXPECT_NEAR(s.drop_out_s / static_cast<double>(std::max<std::int64_t>(s.drop_out_count, 1)),
                  0.04, 0.015)
          << name_of(stick);
    }
  }
}

TEST(ReportStatistics, FreezesOfOneAxisOrBothAreCounted) {
  for (const int axes : {1, 2, 3}) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      MadeStick stick = faulty_stick(seed, 250.0);
      EXPECT_EQ(statistics_of(stick, made_session(stick)).stuck_count, 0) << name_of(stick);
      stick.freezes = 4;
      stick.freeze_s = 0.15;
      stick.frozen_axes = axes;
      EXPECT_GE(statistics_of(stick, made_session(stick)).stuck_count, 2) << name_of(stick);
    }
  }
}

TEST(ReportStatistics, JumpsOfSingleReportsAreToldFromLongerOnes) {
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    MadeStick stick = faulty_stick(seed, 250.0);
    stick.spike_chance = 0.006;
    for (const int reports : {1, 3}) {
      stick.spike_reports = reports;
      const StickStatistics s = statistics_of(stick, made_session(stick));
      // Longer jumps that stay at one place also count as drop-outs.
      const std::int64_t longer = s.long_jump_count + s.drop_out_count;
      EXPECT_GT(s.jump_count, 8) << name_of(stick);
      EXPECT_TRUE(reports == 1 ? longer <= 2 : longer >= 5) << longer << " " << name_of(stick);
    }
  }
}

}  // namespace
}  // namespace gaitpad
