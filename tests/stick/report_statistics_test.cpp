#include "stick/drawn_stick.h"
#include "stick/statistics.h"

namespace gaitpad {
namespace {

TEST(ReportStatistics, RateJitterStepsAndTurnsOfEveryPad) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    MadeStick stick = Draw(seed).stick();
    stick.spike_chance = 0.0;
    // A thousand reports a second of coarse codes are not all told.
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
    EXPECT_EQ(s.stuck, 0) << name_of(stick);
    EXPECT_EQ(s.jumps, 0) << name_of(stick);
  }
}

TEST(ReportStatistics, StepIsMeasuredEvenIfTheFieldIsFiner) {
  MadeStick stick;
  stick.bits = 8;
  stick.sigma = vec2(0.01);
  const StickStatistics s =
      stick_statistics(std::vector<StickTrack>{made_track(stick)}, vec2(2.0 / 65535.0));
  EXPECT_NEAR(s.step_x, 2.0 / 255.0, 1e-9);
  // One value tells of no step.
  const StickTrack still(100, {0, {0.1, 0.1}});
  EXPECT_EQ(stick_statistics(std::vector<StickTrack>{still}, vec2(0.25, 0.125)).step_y, 0.125);
}

TEST(ReportStatistics, LostReportsAreCountedOnAPadThatRepeatsItself) {
  MadeStick stick;
  stick.bits = 8;
  stick.jitter_ms = 0.8;
  EXPECT_LE(statistics_of(stick).gaps.value_or(99), 3);
  stick.drop_chance = 0.02;
  const StickTrack track = made_track(stick);
  const double lost = 0.02 * static_cast<double>(track.size());
  EXPECT_NEAR(static_cast<double>(statistics_of(stick, track).gaps.value_or(0)), lost, 0.3 * lost);
  stick.reports_changes_only = true;
  EXPECT_FALSE(statistics_of(stick).gaps);
}

TEST(ReportStatistics, SpikesAreCountedAndChangeNothingElse) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    MadeStick stick = Draw(seed).stick();
    stick.reports_changes_only = false;
    stick.drop_chance = 0.0;
    stick.sigma = glm::min(stick.sigma, vec2(0.01));
    stick.spike_chance = 0.004;
    const StickTrack track = made_track(stick);
    const StickStatistics s = statistics_of(stick, track);
    // Each lasts two reports on average.
    const double spikes = 0.004 * static_cast<double>(track.size());
    EXPECT_NEAR(static_cast<double>(s.jumps), spikes, 0.2 * spikes + 3.0 * std::sqrt(spikes))
        << name_of(stick);
    expect_centre(stick, s, stick.centre);
    EXPECT_EQ(s.drift_per_s, 0.0) << name_of(stick);
  }
}

TEST(ReportStatistics, AValueThatFreezesWhileTheStickMovesOnIsStuck) {
  MadeStick stick;
  stick.bits = 8;
  MadeMoves moves(stick);
  moves.rest(0.5);
  moves.move({0.9, 0.0}, 0.4);
  moves.rest(0.1);
  StickTrack track = reported(stick, moves.path());
  EXPECT_EQ(statistics_of(stick, track).stuck, 0);
  const std::size_t from = 125 + 40;  // in the middle of the movement, 80 ms
  for (std::size_t i = from; i < from + 20; ++i) track[i].raw = track[from].raw;
  EXPECT_EQ(statistics_of(stick, track).stuck, 1);
}

}  // namespace
}  // namespace gaitpad
