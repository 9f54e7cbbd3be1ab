#include "stick/rests.h"

#include <functional>

#include "stick/made_stick.h"
#include "stick/pad_analysis.h"

namespace gaitpad {
namespace {

TEST(RestStatistics, CentreSigmaHysteresisAndRestOfCleanSticksWithoutAFalseAlarm) {
  int sigmas = 0, hidden = 0, wandering = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    const MadeStick stick = Draw(seed).stick();
    const StickStatistics s = statistics_of(stick);
    expect_centre(stick, s, stick.centre);
    EXPECT_EQ(s.drift_per_s, 0.0) << name_of(stick);
    // There are 14 rests. A pad that reports changes only does not show the last one.
    EXPECT_GE(s.rests.size(), 12u) << name_of(stick);
    EXPECT_LE(s.rests.size(), 14u) << name_of(stick);
    wandering += s.wander > 0.0;
    ASSERT_TRUE(s.sigma && s.hysteresis) << name_of(stick);
    for (int axis = 0; axis < 2; ++axis) {
      const double truth = stick.sigma[axis], found = (*s.sigma)[axis];
      if (truth > 0.0 && truth >= step_of(stick)) {
        EXPECT_NEAR(found, truth, 0.15 * truth) << name_of(stick);
        ++sigmas;
      }
      if (truth < 0.8 * step_of(stick)) {
        EXPECT_TRUE(s.is_sigma_hidden) << name_of(stick);
        EXPECT_LE(found, step_of(stick)) << name_of(stick);
        ++hidden;
      }
    }
    const double noise = stick.sigma.x / std::sqrt(0.4 * stick.rate_hz);
    EXPECT_NEAR(*s.hysteresis, stick.hysteresis,
                0.08 * stick.hysteresis + 1.5 * step_of(stick) + 4.0 * noise + 1e-4)
        << name_of(stick);
  }
  EXPECT_GT(sigmas, 150);
  EXPECT_GT(hidden, 30);
  EXPECT_LE(wandering, 2);
}

TEST(RestStatistics, DriftIsFoundWithItsDirectionAndTheCentreAtHalfTime) {
  for (std::uint32_t seed = 1; seed <= 50; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    const double speed = std::exp(draw.within(std::log(0.003), std::log(0.02)));
    stick.drift_per_s = speed * draw.direction();
    const StickStatistics s = statistics_of(stick);
    ASSERT_TRUE(s.drift_per_s && s.centre) << name_of(stick);
    EXPECT_LE(glm::length(s.drift - stick.drift_per_s), 0.0005 + 0.25 * speed)
        << name_of(stick) << " drift " << speed << " found " << *s.drift_per_s;
    EXPECT_DOUBLE_EQ(*s.drift_per_s, glm::length(s.drift));
    if (stick.spike_chance == 0.0 && speed < 0.01) expect_centre(stick, s, stick.centre);
  }
}

TEST(RestStatistics, SettlingAfterReleasesIsNotDrift) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
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

TEST(RestStatistics, DriftOfAStickThatOnlyRests) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    Draw draw(seed);
    MadeStick stick = draw.stick();
    stick.hysteresis = 0.0;
    stick.sigma *= 0.3;
    for (const double speed : {0.0, 0.01}) {
      stick.drift_per_s = speed * draw.direction();
      MadeMoves moves(stick);
      moves.rest(8.0);
      const StickStatistics s = statistics_of(stick, reported(stick, moves.path()));
      if (!s.drift_per_s && speed == 0.0) continue;  // a pad that is silent at rest shows no drift
      ASSERT_TRUE(s.drift_per_s) << name_of(stick);
      EXPECT_NEAR(*s.drift_per_s, speed, 0.2 * speed) << name_of(stick);
    }
  }
}

// A hand's way to handle a made stick and to release it.
struct Handling {
  std::string name;
  double hysteresis;
  std::function<void(MadeMoves&, Draw&)> handle;
};

TEST(RestStatistics, CentreIsFoundForEveryWayOfHandling) {
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
      {"a thumb left on it now and then", 0.0,
       [](MadeMoves& moves, Draw& draw) {
         for (int k = 0; k < 10; ++k) {
           if (k != 4 && k != 8) {
             let_go_from(moves, 0.2 * kPi * k, draw.within(0.4, 1.0));
             continue;
           }
           moves.push(0.2 * kPi * k);
           moves.push(draw.within(-kPi, kPi), 0.1, 0.1);
           moves.hold(draw.within(0.5, 2.0));
         }
       }},
      {"let go twice", 0.12,
       [](MadeMoves& moves, Draw&) {
         let_go_from(moves, 0.0, 1.0);
         let_go_from(moves, kPi, 1.0);
         moves.push(0.0);  // until it moves again, a silent pad is not known to rest
       }},
  };
  for (const Handling& handling : handlings) {
    SCOPED_TRACE(handling.name);
    for (std::uint32_t seed = 1; seed <= 15; ++seed) {
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

TEST(RestStatistics, TurningAloneGivesNoCentre) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
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

TEST(RestStatistics, OneReleaseGivesNoHysteresis) {
  MadeStick stick;
  stick.sigma = vec2(0.003);
  stick.bits = 10;
  MadeMoves moves(stick);
  moves.rest(5.0);
  moves.move(stick.centre + vec2(0.05, 0.0), 0.1);  // the stick is touched, but not moved
  moves.hold(1.0);
  moves.move(stick.centre, 0.1);
  moves.hold(2.0);
  const StickStatistics s = statistics_of(stick, reported(stick, moves.path()));
  EXPECT_EQ(s.rests.size(), 1u);
  EXPECT_FALSE(s.hysteresis);
  expect_centre(stick, s, stick.centre);
}

// Between two tracks (two recordings, or the pad was unplugged) the stick may not have been
// touched.
TEST(RestStatistics, RestsOfSeveralTracksGiveHysteresisOnlyAfterARelease) {
  MadeStick stick;
  stick.sigma = vec2(0.003);
  MadeMoves still(stick), pushed(stick);
  still.rest(2.0);
  pushed.rest(2.0);
  pushed.push(0.0);
  const StickTrack rest = reported(stick, still.path()), away = reported(stick, pushed.path());
  const auto hysteresis = [](const StickTrack& first, const StickTrack& second) {
    return stick_statistics(std::vector<StickTrack>{first, second}, vec2(0.0)).hysteresis;
  };
  EXPECT_FALSE(hysteresis(rest, rest));
  EXPECT_FALSE(hysteresis(rest, away));
  EXPECT_TRUE(hysteresis(away, rest));
}

MadeStick usual_stick(std::uint32_t seed) {
  MadeStick stick;
  stick.seed = seed;
  stick.sigma = vec2(0.003);
  stick.hysteresis = 0.02;
  stick.bits = 12;
  return stick;
}

TEST(RestStatistics, WanderHidesInNoReleaseHoweverSlowItIs) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    MadeStick stick = usual_stick(seed);
    EXPECT_EQ(statistics_of(stick, made_session(stick)).wander, 0.0) << seed;
    for (const double roam_s : {1.0, 3.0, 5.0}) {
      stick.roam_s = roam_s;
      stick.roam = 0.06;
      // A stick with this spread and time constant changes its position by at most 0.06 sqrt(2 /
      // tau) in a second.
      const double wander = statistics_of(stick, made_session(stick)).wander;
      EXPECT_GT(wander, 0.4 * 0.06 * std::sqrt(2.0 / roam_s)) << seed << " " << roam_s;
      EXPECT_LT(wander, 2.5 * 0.06 * std::sqrt(2.0 / roam_s)) << seed << " " << roam_s;
    }
  }
}

TEST(RestStatistics, DisplacedRestsAreCounted) {
  int found = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    MadeStick stick = usual_stick(seed);
    EXPECT_EQ(statistics_of(stick, made_session(stick)).displaced, 0) << seed;
    stick.displaced = 0.15;
    stick.displaced_times = 1 + static_cast<int>(seed % 5);
    const StickStatistics s = statistics_of(stick, made_session(stick));
    found += s.displaced == stick.displaced_times;
    EXPECT_GE(s.displaced, std::min(stick.displaced_times, 2)) << seed;
    EXPECT_NEAR(s.displaced_by, 0.15, 0.05) << seed;
  }
  EXPECT_GE(found, 8);
}

// Two of twelve releases are displaced; the last release ends the recording.
TEST(RestStatistics, TheLastHandsOffTimeCountsToo) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    MadeStick stick = usual_stick(seed);
    stick.displaced = 0.1 + 0.005 * seed;
    stick.displaced_times = 2;
    stick.reports_changes_only = seed % 3 == 0;
    const StickStatistics s = statistics_of(stick, made_track(stick, 7));
    EXPECT_GE(s.displaced, 1) << seed;
    EXPECT_NE(stick_advice(s, {}).verdict, Verdict::good) << seed << stick_advice(s, {}).reason;
  }
}

}  // namespace
}  // namespace gaitpad
