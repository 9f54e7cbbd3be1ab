// Made sticks, whose truth is known, and real recordings. The bounds are the issue's.
#include "stick/statistics.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>

#include "hid/decode.h"
#include "hid/trace.h"
#include "stick/made_stick.h"

namespace gaitpad {
namespace {

double step_of(const MadeStick& stick) {
  return stick.bits == 0 ? 0.0 : 2.0 / (std::exp2(stick.bits) - 1.0);
}
StickStatistics statistics_of(const MadeStick& stick, const StickTrack& track) {
  return stick_statistics(std::vector<StickTrack>{track}, vec2(step_of(stick)));
}
StickStatistics statistics_of(const MadeStick& stick) {
  return statistics_of(stick, made_track(stick));
}

std::string name_of(const MadeStick& s) {
  const auto text = [](double x) { return std::to_string(x); };
  return "seed " + text(s.seed) + ", " + text(s.bits) + " bits, sigma " + text(s.sigma.x) + " " +
         text(s.sigma.y) + ", hysteresis " + text(s.hysteresis) + ", " + text(s.rate_hz) +
         " Hz, jitter " + text(s.jitter_ms) + " ms, drops " + text(s.drop_chance) + ", spikes " +
         text(s.spike_chance) + (s.reports_changes_only ? ", changes only" : "");
}

// Sticks of all kinds, each drawn from its own seed.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) { stick_.seed = seed; }
  double within(double least, double most) {
    return least + (most - least) * static_cast<double>(random_()) / 4294967296.0;
  }
  bool chance(double share) { return within(0.0, 1.0) < share; }
  template <std::size_t kCount>
  double one_of(const std::array<double, kCount>& values) {
    return values[random_() % kCount];
  }
  MadeStick stick() {
    MadeStick& s = stick_;
    s.centre = vec2(within(-0.2, 0.2), within(-0.2, 0.2));
    s.bits = static_cast<int>(one_of(std::array{0.0, 8.0, 10.0, 12.0, 16.0}));
    const double sigma = chance(0.2) ? 0.0 : std::exp(within(std::log(5e-4), std::log(0.03)));
    s.sigma = vec2(sigma, sigma * within(0.5, 1.0));
    s.hysteresis = chance(0.5) ? 0.0 : within(0.01, 0.15);
    s.gate = std::array{Gate::circle, Gate::square, Gate::ellipse}[random_() % 3];
    s.reach_x = within(0.85, 1.0);
    s.reach_y = within(0.85, 1.0);
    s.rate_hz = one_of(std::array{66.0, 125.0, 250.0, 1000.0});
    s.jitter_ms = within(0.0, 0.2) * 1000.0 / s.rate_hz;
    s.drop_chance = chance(0.5) ? 0.0 : within(0.0, 0.05);
    s.spike_chance = chance(0.5) ? 0.0 : within(0.0, 0.002);
    s.reports_changes_only = chance(0.4);
    return s;
  }
  vec2 direction() {
    const double angle = within(-kPi, kPi);
    return {std::cos(angle), std::sin(angle)};
  }

 private:
  std::mt19937 random_;
  MadeStick stick_;
};

// The larger of a step and 4 sigma / sqrt(resting reports), with hysteresis a quarter of it.
// Positions are doubles in metres of nothing: 1e-4 is as good as a 14-bit stick.
double centre_bound(const MadeStick& stick, const StickStatistics& s) {
  const double reports = std::max(s.rest_s * stick.rate_hz, 1.0);
  const double sigma = std::max(stick.sigma.x, stick.sigma.y);
  return std::max(
      {step_of(stick), 4.0 * sigma / std::sqrt(reports), 0.25 * stick.hysteresis, 1e-4});
}

void expect_centre(const MadeStick& stick, const StickStatistics& s, const vec2& truth) {
  ASSERT_TRUE(s.centre) << name_of(stick);
  const vec2 off = *s.centre - truth;
  EXPECT_LE(std::max(std::fabs(off.x), std::fabs(off.y)), centre_bound(stick, s)) << name_of(stick);
}

TEST(StickStatistics, CentreSigmaAndRestOfFiveHundredCleanSticksWithoutAFalseAlarm) {
  int sigmas = 0, hidden = 0, wandering = 0;
  for (std::uint32_t seed = 1; seed <= 500; ++seed) {
    const MadeStick stick = Draw(seed).stick();
    const StickStatistics s = statistics_of(stick);
    expect_centre(stick, s, stick.centre);
    ASSERT_TRUE(s.drift_per_s) << name_of(stick);
    EXPECT_EQ(*s.drift_per_s, 0.0) << name_of(stick);
    // 14 rests; the last one is not known of where a pad falls silent.
    EXPECT_GE(s.rests.size(), 12u) << name_of(stick);
    EXPECT_LE(s.rests.size(), 14u) << name_of(stick);
    wandering += s.wander > 0.0;
    ASSERT_TRUE(s.sigma) << name_of(stick);
    for (int axis = 0; axis < 2; ++axis) {
      const double truth = stick.sigma[axis], found = (*s.sigma)[axis];
      if (truth > 1.15 * step_of(stick)) {
        EXPECT_NEAR(found, truth, 0.15 * truth) << name_of(stick);
        ++sigmas;
      }
      if (truth < 0.8 * step_of(stick)) {
        EXPECT_TRUE(s.is_sigma_hidden) << name_of(stick);
        EXPECT_LE(found, step_of(stick)) << name_of(stick);
        ++hidden;
      }
    }
  }
  EXPECT_GT(sigmas, 500);
  EXPECT_GT(hidden, 100);
  EXPECT_LE(wandering, 5);
}

TEST(StickStatistics, DriftIsFoundAlwaysWithItsDirection) {
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    const double speed = std::exp(draw.within(std::log(0.003), std::log(0.02)));
    stick.drift_per_s = speed * draw.direction();
    const StickStatistics s = statistics_of(stick);
    ASSERT_TRUE(s.drift_per_s) << name_of(stick);
    EXPECT_LE(glm::length(s.drift - stick.drift_per_s), 0.0005 + 0.25 * speed)
        << name_of(stick) << " drift " << speed << " found " << *s.drift_per_s;
    EXPECT_DOUBLE_EQ(*s.drift_per_s, glm::length(s.drift));
  }
}

TEST(StickStatistics, CentreOfADriftingStickIsThatOfTheMiddleOfTheTime) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    stick.drift_per_s = 0.01 * draw.direction();
    stick.spike_chance = 0.0;
    const StickStatistics s = statistics_of(stick);
    ASSERT_TRUE(s.centre);
    // Ten milliseconds of it are the ends of the recording.
    EXPECT_LE(glm::length(*s.centre - stick.centre), 2.0 * centre_bound(stick, s) + 1e-3)
        << name_of(stick);
  }
}

TEST(StickStatistics, SettlingAfterReleasesIsNoDrift) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    stick.creep = draw.within(0.005, 0.03);
    EXPECT_EQ(statistics_of(stick).drift_per_s, 0.0) << name_of(stick) << " creep " << stick.creep;
    MadeMoves once(stick);
    once.push(draw.within(-kPi, kPi));
    once.release();
    once.rest(draw.within(0.8, 3.0));
    const StickStatistics s = statistics_of(stick, reported(stick, once.path()));
    EXPECT_EQ(s.drift_per_s.value_or(0.0), 0.0) << name_of(stick) << " creep " << stick.creep;
  }
}

TEST(StickStatistics, DriftOfAStickThatOnlyRests) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    stick.hysteresis = 0.0;
    stick.sigma *= 0.3;
    for (const double speed : {0.0, 0.01}) {
      stick.drift_per_s = speed * draw.direction();
      MadeMoves moves(stick);
      moves.rest(8.0);
      const StickStatistics s = statistics_of(stick, reported(stick, moves.path()));
      if (!s.drift_per_s && speed == 0.0) continue;  // a silent pad
      ASSERT_TRUE(s.drift_per_s) << name_of(stick);
      EXPECT_NEAR(*s.drift_per_s, speed, 0.2 * speed) << name_of(stick);
    }
  }
}

TEST(StickStatistics, HysteresisIsTheSpreadOfTheRests) {
  for (std::uint32_t seed = 1; seed <= 120; ++seed) {
    const MadeStick stick = Draw(seed).stick();
    const StickStatistics s = statistics_of(stick);
    ASSERT_TRUE(s.hysteresis) << name_of(stick);
    const double noise = stick.sigma.x / std::sqrt(0.4 * stick.rate_hz);
    EXPECT_NEAR(*s.hysteresis, stick.hysteresis,
                0.08 * stick.hysteresis + 1.5 * step_of(stick) + 4.0 * noise + 1e-4)
        << name_of(stick);
    if (stick.hysteresis == 0.0 && stick.bits == 0) {
      EXPECT_LE(*s.hysteresis, 4.0 * noise + 1e-4) << name_of(stick);
    }
  }
}

// How a made stick is let go, and how far off its centre may then be found.
struct Handling {
  std::string name;
  double hysteresis;
  std::function<void(MadeMoves&, Draw&)> handle;
};

void let_go_from(MadeMoves& moves, double angle_rad, double rest_s = 0.6) {
  moves.push(angle_rad);
  moves.hold(0.1);
  moves.release();
  moves.rest(rest_s);
}

TEST(StickStatistics, CentreHoweverTheStickIsHandled) {
  const std::vector<Handling> handlings = {
      {"let go mostly from one side", 0.12,
       [](MadeMoves& moves, Draw& draw) {
         for (int k = 0; k < 8; ++k) {
           let_go_from(moves, k < 6 ? draw.within(-0.6, 0.6) : draw.within(2.0, 4.0));
         }
       }},
      {"from one side, then from the other", 0.12,
       [](MadeMoves& moves, Draw& draw) {
         for (int k = 0; k < 12; ++k)
           let_go_from(moves, (k < 6 ? 0.0 : kPi) + draw.within(-0.3, 0.3));
       }},
      {"one rest much longer than the others", 0.12,
       [](MadeMoves& moves, Draw& draw) {
         for (int k = 0; k < 8; ++k) {
           let_go_from(moves, 0.25 * kPi * k, k == 3 ? 15.0 : draw.within(0.4, 0.7));
         }
       }},
      {"no hysteresis, rests of all lengths", 0.0,
       [](MadeMoves& moves, Draw& draw) {
         for (int k = 0; k < 8; ++k) let_go_from(moves, 0.25 * kPi * k, draw.within(0.3, 3.0));
       }},
      {"held half way for long", 0.0,
       [](MadeMoves& moves, Draw& draw) {
         for (int k = 0; k < 4; ++k) {
           let_go_from(moves, draw.within(-kPi, kPi));
           moves.push(draw.within(-kPi, kPi), 0.2, 0.5);
           moves.hold(3.0);
         }
       }},
      {"at rest only at the beginning, then turned", 0.0,
       [](MadeMoves& moves, Draw& draw) {
         moves.rest(1.0);
         moves.push(draw.within(-kPi, kPi));
         moves.turn(4.0, draw.within(0.6, 2.0));
       }},
      {"let go twice", 0.12,
       [](MadeMoves& moves, Draw&) {
         let_go_from(moves, 0.0, 1.0);
         let_go_from(moves, kPi, 1.0);
         moves.push(0.0);  // a silent pad is not known to rest until it moves again
       }},
  };
  for (const Handling& handling : handlings) {
    SCOPED_TRACE(handling.name);
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      Draw draw(seed);
      MadeStick stick = draw.stick();
      stick.hysteresis = handling.hysteresis;
      stick.spike_chance = 0.0;
      MadeMoves moves(stick);
      moves.rest(0.5);
      handling.handle(moves, draw);
      const StickStatistics s = statistics_of(stick, reported(stick, moves.path()));
      expect_centre(stick, s, stick.centre);
      EXPECT_EQ(s.drift_per_s.value_or(0.0), 0.0) << name_of(stick);
    }
  }
}

TEST(StickStatistics, AThumbLeftOnTheStickNowAndThenDoesNotMoveTheCentre) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    stick.hysteresis = 0.0;
    MadeMoves moves(stick);
    moves.rest(0.6);
    for (int k = 0; k < 10; ++k) {
      moves.push(0.2 * kPi * k);
      moves.hold(0.1);
      if (k == 4 || k == 8) {
        moves.move(stick.centre + 0.1 * draw.direction(), 0.1);
        moves.hold(draw.within(0.5, 2.0));
      } else {
        moves.release();
        moves.rest(draw.within(0.4, 1.0));
      }
    }
    expect_centre(stick, statistics_of(stick, reported(stick, moves.path())), stick.centre);
  }
}

TEST(StickStatistics, NothingButTurningHasNoCentre) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    Draw draw(seed);
    const MadeStick stick = draw.stick();
    MadeMoves moves(stick);
    moves.push(draw.within(-kPi, kPi), 0.02);
    moves.turn(3.2, draw.within(0.5, 3.0));
    const StickStatistics s = statistics_of(stick, reported(stick, moves.path()));
    EXPECT_FALSE(s.centre || s.sigma || s.hysteresis || s.drift_per_s) << name_of(stick);
    EXPECT_EQ(s.rest_samples, 0);
    EXPECT_EQ(s.turns, 3) << name_of(stick);
  }
}

TEST(StickStatistics, OneReleaseHasNoHysteresisHoweverLong) {
  MadeStick stick;
  stick.sigma = vec2(0.003);
  stick.bits = 10;
  MadeMoves moves(stick);
  moves.rest(5.0);
  moves.move(stick.centre + vec2(0.05, 0.0), 0.1);  // touched, not moved
  moves.hold(1.0);
  moves.move(stick.centre, 0.1);
  moves.hold(2.0);
  const StickStatistics s = statistics_of(stick, reported(stick, moves.path()));
  EXPECT_EQ(s.rests.size(), 1u);
  EXPECT_FALSE(s.hysteresis);
  expect_centre(stick, s, stick.centre);
}

TEST(StickStatistics, WanderIsToldAndNoiseIsNot) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    MadeStick stick;
    stick.seed = seed;
    stick.sigma = vec2(0.005);
    stick.wander = 0.03;
    MadeMoves moves(stick);
    moves.rest(10.0);
    EXPECT_GT(statistics_of(stick, reported(stick, moves.path())).wander, 0.005) << seed;
    stick.wander = 0.0;
    EXPECT_EQ(statistics_of(stick, reported(stick, moves.path())).wander, 0.0) << seed;
  }
}

TEST(StickStatistics, RateJitterStepsAndTurnsOfEveryPad) {
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

TEST(StickStatistics, StepIsMeasuredEvenIfTheFieldIsFiner) {
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

TEST(StickStatistics, LostReportsAreCountedOnAPadThatRepeatsItself) {
  MadeStick stick;
  stick.bits = 8;
  stick.jitter_ms = 0.8;
  EXPECT_LE(statistics_of(stick).gaps, 3);
  stick.drop_chance = 0.02;
  const StickTrack track = made_track(stick);
  const double lost = 0.02 * static_cast<double>(track.size());
  EXPECT_NEAR(static_cast<double>(statistics_of(stick, track).gaps), lost, 0.3 * lost);
  stick.reports_changes_only = true;
  EXPECT_EQ(statistics_of(stick).gaps, 0);
}

TEST(StickStatistics, SpikesAreCountedAndChangeNothingElse) {
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

TEST(StickStatistics, AValueThatFreezesWhileTheStickMovesOnIsStuck) {
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

TEST(StickStatistics, AFrameTurnsWhatIsFound) {
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

TEST(StickStatistics, TooLittleIsNoneNotGuessed) {
  for (const StickTrack& track :
       {StickTrack{}, StickTrack{{0, {0.1, 0.1}}}, StickTrack(3, {5, {0.0, 0.0}})}) {
    const StickStatistics s = stick_statistics(std::vector<StickTrack>{track}, vec2(0.0));
    EXPECT_EQ(s.samples, static_cast<std::int64_t>(track.size()));
    EXPECT_FALSE(s.centre || s.sigma || s.hysteresis || s.drift_per_s || s.rate_hz || s.jitter_ms);
    EXPECT_EQ(s.wander, 0.0);
  }
  EXPECT_EQ(stick_statistics({}, vec2(0.0)).samples, 0);
}

TEST(StickStatistics, AnyNumbersAreTaken) {
  std::mt19937 random(3);
  const double odd[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -1e300,
                        1e300,
                        5e-324,
                        1.0};
  const std::int64_t times[] = {std::numeric_limits<std::int64_t>::min(), -1, 0, 1, 4'000'000,
                                std::numeric_limits<std::int64_t>::max()};
  for (int round = 0; round < 200; ++round) {
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
  const auto begin = std::chrono::steady_clock::now();
  statistics_of(stick, track);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took.count(), 3.0);  // 0.06 s alone; sanitizers and a busy machine take their part
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

TEST(TriggerStatistics, EndsAreWhereItStoodLongest) {
  const TriggerTrack track =
      trigger_track({{0.02, 2.0}, {0.4, 0.1}, {0.97, 0.5}, {0.5, 0.1}, {0.024, 1.0}});
  const TriggerStatistics s = trigger_statistics(std::vector<TriggerTrack>{track});
  EXPECT_EQ(s.samples, static_cast<std::int64_t>(track.size()));
  EXPECT_EQ(s.released, 0.02);
  EXPECT_EQ(s.pressed, 0.97);
}

TEST(TriggerStatistics, PressedIsNoneWhereItWasNeverPressed) {
  for (const double most : {0.0, 0.3, 0.5}) {
    const TriggerStatistics s =
        trigger_statistics(std::vector<TriggerTrack>{trigger_track({{0.0, 1.0}, {most, 0.5}})});
    EXPECT_EQ(s.released, 0.0);
    EXPECT_FALSE(s.pressed) << most;
  }
  EXPECT_FALSE(trigger_statistics({}).released);
}

TEST(TriggerStatistics, AReportOfNonsenseIsNoEnd) {
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
  const auto pads = load_pad_folder(GAITPAD_SOURCE_DIR "/config/pads");
  const auto trace = read_trace(GAITPAD_SHARED_DATA "/hid/" + name);
  EXPECT_TRUE(pads) << (pads ? "" : pads.error().message);
  EXPECT_TRUE(trace) << (trace ? "" : trace.error().message);
  if (!pads || !trace) return {};
  const auto layout = pad_layout(trace->devices[0].info, *pads);
  EXPECT_TRUE(layout) << (layout ? "" : layout.error().message);
  if (!layout) return {};
  PadTracker tracker(*layout);
  for (const TraceEvent& event : trace->events) tracker.take(report_of(*trace, event));
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
  void SetUp() override {
    if (!std::filesystem::exists(GAITPAD_SHARED_DATA "/hid")) {
      GTEST_SKIP() << "no recordings at " GAITPAD_SHARED_DATA "/hid";
    }
  }
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
      EXPECT_EQ(s.jumps + s.stuck + s.turns, 0) << button << side;
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
  EXPECT_NEAR(s.rest_s, 1.05, 0.1);  // it lies still for the first 1.1 s
  EXPECT_FALSE(s.hysteresis);
  EXPECT_GE(s.turns, 4);
  const PadTracks right = recorded("dualsense_usb_right_stick.hid");
  const StickStatistics r = stick_statistics(right.stick[1], vec2(2.0 / 255.0));
  EXPECT_EQ(r.rests.size(), 2u);
  ASSERT_TRUE(r.hysteresis);
  EXPECT_LT(*r.hysteresis, 2.0 / 255.0);
}

TEST_F(RealStickStatistics, APadThatIsSilentAtRestHasCentresToo) {
  const PadTracks tracks = recorded("xbox_elite2_bt_nopaddles.hid");
  for (int side = 0; side < 2; ++side) {
    const StickStatistics s = stick_statistics(tracks.stick[side], vec2(2.0 / 65535.0));
    ASSERT_TRUE(s.centre) << side;
    EXPECT_LT(glm::length(*s.centre), 0.1) << side;
    EXPECT_EQ(s.rests.size(), 2u) << side;
    EXPECT_NEAR(*s.rate_hz, 100.0, 3.0) << side;
    EXPECT_EQ(s.gaps, 0) << side;
  }
}

}  // namespace
}  // namespace gaitpad
