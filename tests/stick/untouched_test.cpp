#include "gaitpad/untouched.h"

#include <gtest/gtest.h>

#include "stick/made_stick.h"

namespace gaitpad {
namespace {

// The calibration of a sound stick: its inner zone is 0.1 raw.
StickCalibration sound_calibration() {
  StickCalibration c;
  c.inner = 0.1;
  return c;
}

// Number of warnings that the stick moved by itself.
int warnings(const StickTrack& track) {
  const StickCalibration c = sound_calibration();
  UntouchedWatch watch;
  int count = 0;
  for (const StickSample& sample : track)
    count += watch.take(sample.time_ns, c, sample.raw, stick_position(c, sample.raw));
  return count;
}

MadeStick noisy_stick(std::uint32_t seed, double rate_hz) {
  MadeStick stick;
  stick.seed = seed;
  stick.sigma = vec2(0.005);
  stick.rate_hz = rate_hz;
  return stick;
}

TEST(Untouched, AHandIsNeverTakenForIt) {
  for (const double rate_hz : {60.0, 125.0, 250.0, 1000.0}) {
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
      MadeStick stick = noisy_stick(seed, rate_hz);
      stick.hysteresis = 0.06;
      for (const bool is_silent : {false, true}) {
        stick.reports_changes_only = is_silent;
        if (is_silent) stick.sigma = vec2(0.0);
        MadeMoves moves(stick);
        for (const double seconds : {0.04, 0.1, 0.3, 1.0, 3.0}) {
          moves.rest(2.0);
          moves.push(seconds, seconds);
          moves.hold(0.4);
          moves.release();
          moves.rest(1.5);
          moves.push(seconds, seconds, 0.3);  // a push of 0.3, as for a slow walk
          moves.hold(0.4);
          moves.release();
        }
        EXPECT_EQ(warnings(reported(stick, moves.path())), 0) << name_of(stick);
      }
    }
  }
}

TEST(Untouched, AStickThatCreepsOutOfItsZoneIsFound) {
  for (const double rate_hz : {60.0, 250.0, 1000.0}) {
    MadeStick stick = noisy_stick(3, rate_hz);
    MadeMoves moves(stick);
    moves.rest(2.0);
    moves.move({0.15, 0.0}, 10.0);
    moves.hold(1.0);
    EXPECT_GE(warnings(reported(stick, moves.path())), 1) << rate_hz;
  }
}

TEST(Untouched, AJumpAtRestIsFoundOnceAndTheFirstSecondTellsNothing) {
  const MadeStick stick = noisy_stick(4, 250.0);
  MadeMoves moves(stick);
  moves.rest(4.0);
  StickTrack track = reported(stick, moves.path());
  EXPECT_EQ(warnings(track), 0);
  track[100].raw = vec2(0.0, 0.9);
  EXPECT_EQ(warnings(track), 0);
  track[500].raw = vec2(0.0, 0.9);
  EXPECT_EQ(warnings(track), 1);
}

TEST(Untouched, TheWarningNamesThePadAndTheCommand) {
  const std::string text = untouched_warning("My Pad (hidraw)");
  EXPECT_NE(text.find("My Pad (hidraw)"), std::string::npos);
  EXPECT_NE(text.find("gaitpad calibrate"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
