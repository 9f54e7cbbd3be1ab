#include "stick/stills.h"

#include <gtest/gtest.h>

#include <limits>

#include "stick/made_stick.h"

namespace gaitpad {
namespace {

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

Stills stills_of(const MadeStick& stick, const MadeMoves& moves) {
  return stills(std::vector<StickTrack>{reported(stick, moves.path())});
}

double seconds_of(const std::vector<Still>& stills) {
  double sum = 0.0;
  for (const Still& still : stills) sum += still.duration_s;
  return sum;
}

// One stick of each kind: noisy, worn, drifting, coarse, silent at rest, slow and fast.
std::vector<MadeStick> every_kind() {
  std::vector<MadeStick> sticks;
  for (const int bits : {8, 16}) {
    for (const double sigma : {0.0, 0.04}) {
      for (const bool is_silent : {false, true}) {
        for (const double rate_hz : {66.0, 1000.0}) {
          MadeStick stick;
          stick.bits = bits;
          stick.sigma = vec2(sigma);
          stick.reports_changes_only = is_silent;
          stick.rate_hz = rate_hz;
          stick.jitter_ms = 200.0 / rate_hz;
          stick.centre = vec2(0.2, -0.15);
          stick.hysteresis = 0.15;
          stick.seed = static_cast<std::uint32_t>(sticks.size() + 1);
          sticks.push_back(stick);
        }
      }
    }
  }
  return sticks;
}

TEST(Stills, TheRestAfterEachReleaseIsFound) {
  for (MadeStick stick : every_kind()) {
    for (const double drift : {0.0, 0.02}) {
      stick.drift_per_s = vec2(drift, 0.0);
      MadeMoves moves(stick);
      std::vector<std::array<double, 2>> truth;
      for (int k = 0; k < 4; ++k) {
        moves.push(1.6 * k);
        moves.hold(0.1);
        moves.release();
        const double from_s = static_cast<double>(moves.path().size()) / stick.rate_hz;
        moves.rest(0.7);
        truth.push_back({from_s, from_s + 0.7});
      }
      moves.push(0.0);
      const Stills found = stills_of(stick, moves);
      ASSERT_GE(found.rests.size(), truth.size()) << name_of(stick) << " drift " << drift;
      EXPECT_GT(seconds_of(found.rests), 0.7 * 4 * 0.7) << name_of(stick);
      for (const Still& rest : found.rests) {
        bool is_inside = false;
        for (const auto& [from_s, to_s] : truth) {
          // The rest of a pad that is silent at rest lasts until the movement shows: after one
          // code, or one report interval.
          const double late_s = 2.0 / stick.rate_hz + 0.02;
          is_inside |= seconds(rest.begin_ns) > from_s && seconds(rest.end_ns) < to_s + late_s;
        }
        EXPECT_TRUE(is_inside) << name_of(stick) << " " << seconds(rest.begin_ns) << " to "
                               << seconds(rest.end_ns);
      }
    }
  }
}

TEST(Stills, AHeldPushIsAPushAndNotARest) {
  for (const MadeStick& stick : every_kind()) {
    MadeMoves moves(stick);
    moves.rest(0.6);
    for (const double angle : {0.5 * kPi, 0.0, -0.5 * kPi, kPi}) {
      moves.push(angle, 0.15, 0.8);
      moves.hold(0.6);
      moves.release();
      moves.rest(0.6);
    }
    for (int k = 0; k < 3; ++k) {  // rests half way for a long time
      moves.push(1.0, 0.2, 0.5);
      moves.hold(4.0);
      moves.release();
      moves.rest(0.5);
    }
    const Stills found = stills_of(stick, moves);
    EXPECT_GE(found.pushes.size(), 4u) << name_of(stick);
    EXPECT_GE(found.rests.size(), 3u) << name_of(stick);
    for (const Still& push : found.pushes) {
      EXPECT_GT(glm::length(push.mean - stick.centre), 0.3) << name_of(stick);
    }
    for (const Still& rest : found.rests) {
      EXPECT_LT(glm::length(rest.mean - stick.centre), 0.12) << name_of(stick);
    }
  }
}

TEST(Stills, AStickThatWasNeverTouchedRestsAllTheTime) {
  for (const MadeStick& stick : every_kind()) {
    // One report is not enough to see a rest.
    if (stick.reports_changes_only && stick.sigma.x == 0.0) continue;
    MadeMoves moves(stick);
    moves.rest(3.0);
    const Stills found = stills_of(stick, moves);
    // The silence at the end does not count: the pad may be unplugged.
    EXPECT_GT(seconds_of(found.rests), stick.reports_changes_only ? 2.0 : 2.9) << name_of(stick);
    EXPECT_TRUE(found.pushes.empty());
  }
}

TEST(Stills, AMeanIsWeightedByTimeNotByReports) {
  // A pad that is silent at rest is at 0.01 for a second and at 0.014 for three seconds.
  const StickTrack track = {{0, {0.01, 0.0}},
                            {1'000'000'000, {0.014, 0.0}},
                            {2'500'000'000, {0.014, 0.01}},
                            {4'000'000'000, {0.9, 0.0}}};
  const Stills found = stills(std::vector<StickTrack>{track});
  ASSERT_EQ(found.rests.size(), 1u);
  EXPECT_NEAR(found.rests[0].mean.x, (0.01 + 3.0 * 0.014) / 4.0, 1e-4);
  EXPECT_EQ(found.rests[0].first, 0u);
  EXPECT_EQ(found.rests[0].last, 2u);
}

// The limit bounds time and memory for any number of silent recordings.
TEST(Stills, OnlyTheFirstDayOfAllTracksCounts) {
  StickTrack silent;
  for (std::int64_t k = 0; k < 30'000; ++k) {
    silent.push_back({k * 2'000'000'000, {0.01 + 0.001 * static_cast<double>(k % 2), 0.0}});
  }
  const Stills found = stills(std::vector<StickTrack>(3, silent));
  EXPECT_NEAR(seconds_of(found.rests), 86400.0, 10.0);
}

TEST(Stills, InvalidSamplesDoNotCrash) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  constexpr auto kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr auto kLast = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(stills({}).rests.empty());
  EXPECT_TRUE(stills(std::vector<StickTrack>(3)).rests.empty());
  EXPECT_TRUE(stills(std::vector<StickTrack>{{{0, {nan, inf}}, {1, {1e300, 0.0}}}}).rests.empty());
  const StickTrack wild = {{kLast, {0.0, 0.0}},  {kFirst, {0.0, 0.0}}, {0, {nan, 0.0}},
                           {kFirst, {0.0, 1e9}}, {kLast, {-inf, 0.1}}, {kLast, {0.1, 0.1}}};
  stills(std::vector<StickTrack>{wild, wild});
  // Many samples have the same time.
  stills(std::vector<StickTrack>{StickTrack(1000, {7, {0.1, 0.1}})});
}

double seconds_of(const std::vector<HandsOff>& times) {
  double sum = 0.0;
  for (const HandsOff& time : times) sum += 0.1 * static_cast<double>(time.places.size());
  return sum;
}

TEST(HandsOffTime, BeginsAfterTheReleaseHasSettledAndEndsWithTheNextPush) {
  for (const MadeStick& stick : every_kind()) {
    MadeMoves moves(stick);
    moves.rest(1.0);
    for (int k = 0; k < 4; ++k) {
      moves.push(1.6 * k);
      moves.hold(0.2);
      moves.release();
      moves.rest(2.0);
    }
    moves.push(0.0);
    const Stills found = stills_of(stick, moves);
    // 9 s less 0.3 s of settling after each release and up to 0.25 s before a push, in blocks of
    // 0.1 s.
    ASSERT_EQ(found.hands_off.size(), 5u) << name_of(stick);
    EXPECT_LT(seconds_of(found.hands_off), 9.0 - 4 * 0.25) << name_of(stick);
    EXPECT_GT(seconds_of(found.hands_off), 9.0 - 4 * 0.3 - 5 * 0.35) << name_of(stick);
    for (const HandsOff& time : found.hands_off) {
      EXPECT_EQ(time.is_released, &time != &found.hands_off.front());
      for (const vec2& place : time.places)
        EXPECT_LT(glm::length(place - stick.centre), 0.5 * stick.hysteresis + 0.06)
            << name_of(stick);
    }
  }
}

TEST(HandsOffTime, AStickThatWandersIsHandsOffAllTheTime) {
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    MadeStick stick;
    stick.sigma = vec2(0.003);
    stick.roam = 0.1;
    stick.seed = seed;
    MadeMoves moves(stick);
    for (int k = 0; k < 4; ++k) {
      moves.push(1.6 * k);
      moves.hold(0.2);
      moves.release();
      moves.rest(3.0);
    }
    const Stills found = stills_of(stick, moves);
    EXPECT_GT(seconds_of(found.hands_off), 7.0) << seed;
    EXPECT_LT(seconds_of(found.hands_off), 12.0) << seed;
  }
}

TEST(HandsOffTime, AStickThatAHandLeadsBackIsNotLetGo) {
  MadeStick stick;
  stick.sigma = vec2(0.003);
  MadeMoves moves(stick);
  moves.push(0.0);
  moves.hold(0.2);
  moves.move({0.05, 0.0}, 1.0);
  moves.hold(2.0);
  EXPECT_EQ(seconds_of(stills_of(stick, moves).hands_off), 0.0);
}

}  // namespace
}  // namespace gaitpad
