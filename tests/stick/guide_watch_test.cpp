// What counts for each step, as the guide sees and tells it: releases, turns, pushes, triggers.
#include <gtest/gtest.h>

#include <cmath>

#include "stick/made_hand.h"

namespace gaitpad {
namespace {

TEST(CalibrationGuide, NoiseAndSpikesAreNoReleases) {
  MadeHand hand;
  hand.sigma = 0.04;
  std::mt19937 random(3);
  for (int i = 0; i < 4000; ++i) {
    hand.pass();
    if (random() % 100 != 0) continue;
    hand.thumb[0] = vec2(1.0, 0.0);  // for one report
    hand.pass();
    hand.thumb[0] = vec2(0.0);
  }
  EXPECT_EQ(hand.text(), "0 of 6 releases");
}

TEST(CalibrationGuide, ReleasesFromTwoSidesAreNotEnough) {
  MadeHand hand(Controls::one_stick);
  for (int i = 0; i < 4; ++i) {
    hand.push(0, vec2(1, 0));
    hand.push(0, vec2(0, 1));
  }
  EXPECT_EQ(hand.guide.step(), GuideStep::rest);
  EXPECT_EQ(hand.text(), "6 of 6 releases; only from 2 of 3 sides");
  hand.push(0, vec2(0, -1), 0.1, 2.7);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

TEST(CalibrationGuide, AStickThatHasRestedEnoughMayBeBumpedWhileTheOtherIsMoved) {
  MadeHand hand;
  hand.rest_step(0);
  hand.thumb[0] = vec2(0.5, 0.0);
  hand.wait(0.1);
  hand.thumb[0] = vec2(0.0);
  hand.rest_step(1);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

TEST(CalibrationGuide, AStickThatIsHeldIsNotReleased) {
  MadeHand hand(Controls::one_stick);
  for (int i = 0; i < 8; ++i) {
    hand.move(0, vec2(0.0, 0.9), 0.1);
    hand.wait(1.0);
    hand.move(0, vec2(0.0, 0.6), 0.1);
    hand.wait(1.0);
  }
  EXPECT_EQ(hand.text(), "0 of 6 releases; it is held, let go");
}

TEST(CalibrationGuide, StartingWithTheStickHeldALittleDoesNotHinder) {
  MadeHand hand(Controls::one_stick);
  hand.thumb[0] = vec2(0.4, 0.0);
  hand.wait(2.0);
  hand.move(0, vec2(0.0), 0.05);
  hand.wait(1.0);
  hand.rest_step(0);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

TEST(CalibrationGuide, AStickThatNeverStandsStillIsReleasedAllTheSame) {
  MadeHand hand(Controls::one_stick);
  for (int i = 0; i < 6; ++i) {
    const SinCos side = sin_cos(i * kPi / 3.0 + 0.2);
    hand.move(0, vec2(side.cos, side.sin), 0.1);
    for (int k = 0; k < 700; ++k) {
      hand.thumb[0] = vec2(0.12 * std::sin(k * 0.025), 0.0);  // once a second
      hand.pass();
    }
  }
  EXPECT_EQ(hand.guide.step(), GuideStep::turn) << hand.text();
}

TEST(CalibrationGuide, SilenceIsHoldingStill) {
  MadeHand hand(Controls::one_stick);
  hand.reports_changes_only = true;
  for (int i = 0; i < 6; ++i) {
    const SinCos side = sin_cos(i * kPi / 3.0 + 0.2);
    hand.thumb[0] = vec2(side.cos, side.sin);
    hand.pass();
    hand.time_ns += 200'000'000;
    hand.guide.tick(hand.time_ns);
    hand.thumb[0] = vec2(0.0);
    hand.pass();
    hand.time_ns += 700'000'000;
    hand.guide.tick(hand.time_ns);
  }
  hand.guide.tick(hand.time_ns + 1'900'000'000);
  EXPECT_EQ(hand.samples(), 12u);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

TEST(CalibrationGuide, HalfACircleIsMissingWhereItWasNotTurned) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  for (int i = 0; i < 5; ++i) {  // to and fro from the right over the front to the left
    hand.turn(0, 0.5, 0.9);
    for (double t = 0.5; t > 0.0; t -= 0.003) {
      const SinCos angle = sin_cos(t * 2.0 * kPi);
      hand.thumb[0] = 0.9 * vec2(angle.cos, angle.sin);
      hand.pass();
    }
  }
  EXPECT_EQ(
      hand.text(),
      "25 of 48 directions, 2.0 of 2 turns; not yet: back by its axes (Enter goes on without)");
}

TEST(CalibrationGuide, ACutCornerIsNotTheRim) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 0.75, 1.0);
  for (int i = 0; i < 3; ++i) hand.turn(0, 0.25, 0.55, 0.75), hand.turn(0, 0.75, 1.0);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
  EXPECT_NE(hand.text().find("not yet: back right"), std::string::npos) << hand.text();
}

TEST(CalibrationGuide, CirclesInTheMiddleAndAStickHeldAtTheRimAreNoTurns) {
  MadeHand hand(Controls::one_stick);
  hand.sigma = 0.02;
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 4.0, 0.4);
  hand.thumb[0] = vec2(0.7, 0.7);
  hand.wait(20.0);
  EXPECT_NE(hand.text().find("0.0 of 2 turns"), std::string::npos) << hand.text();
}

TEST(CalibrationGuide, OneTurnIsNotTwo) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 1.2, 0.9);
  EXPECT_NE(hand.text().find("48 of 48 directions, 1."), std::string::npos) << hand.text();
  hand.turn(0, 1.0, 0.9, 0.2);
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
}

TEST(CalibrationGuide, APushMustBeHeldAndLetGo) {
  MadeHand hand(Controls::one_stick);
  hand.wait(0.2);
  hand.skip_to(GuideStep::forward);
  hand.push(0, vec2(0, 1), 0.05);  // a flick
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
  hand.move(0, vec2(0.0, 0.9), 0.1);
  hand.wait(0.15);
  EXPECT_EQ(hand.text(), "hold it");
  hand.wait(0.3);
  EXPECT_EQ(hand.text(), "now let go");
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
  hand.move(0, vec2(0.0), 0.05);
  hand.wait(0.2);
  EXPECT_EQ(hand.guide.step(), GuideStep::right);
}

TEST(CalibrationGuide, WhatIsHeldWhenAStepBeginsDoesNotCountForIt) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 2.5, 0.9);  // still at the rim when the step is over
  ASSERT_EQ(hand.guide.step(), GuideStep::forward);
  hand.thumb[0] = vec2(0.9, 0.0);
  hand.wait(1.0);
  hand.move(0, vec2(0.0), 0.05);
  hand.wait(0.5);
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
  EXPECT_EQ(hand.text(), "waiting for it");
}

TEST(CalibrationGuide, APushBetweenTwoDirectionsIsAskedForAgain) {
  MadeHand hand(Controls::one_stick);
  hand.wait(0.2);
  hand.skip_to(GuideStep::forward);
  hand.push(0, vec2(0.6, 0.8));
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
  EXPECT_EQ(hand.text(), "that was between two directions, hold it straighter");
  hand.push(0, vec2(0.3, 0.9));
  EXPECT_EQ(hand.guide.step(), GuideStep::right);
}

TEST(CalibrationGuide, APushThatContradictsAnEarlierOneIsAskedForAgain) {
  MadeHand hand(Controls::one_stick);
  hand.wait(0.2);
  hand.skip_to(GuideStep::forward);
  hand.push(0, vec2(1, 0));  // the hand's mistake: right
  hand.push(0, vec2(1, 0));
  EXPECT_EQ(hand.guide.step(), GuideStep::right);
  EXPECT_EQ(hand.text(), "that contradicts \"push forward\": once more, or back to that step");
  hand.guide.back();
  ASSERT_EQ(hand.guide.step(), GuideStep::forward);
  for (const vec2& to : {vec2(0, 1), vec2(1, 0), vec2(0, 1)}) hand.push(0, to);
  EXPECT_EQ(hand.guide.step(), GuideStep::back);
  EXPECT_EQ(hand.text(), "that contradicts \"push forward\": once more, or back to that step");
  hand.push(0, vec2(0, -1));
  hand.push(0, vec2(-1, 0));
  EXPECT_EQ(hand.guide.step(), GuideStep::done);
  EXPECT_EQ(hand.guide.frame(0), StickFrame{});
}

TEST(CalibrationGuide, SkippedPushesLeaveTheFrameOfTheLayout) {
  MadeHand hand(Controls::one_stick);
  hand.frame = kFrames[4];
  hand.wait(0.2);
  hand.skip_to(GuideStep::forward);
  hand.push(0, vec2(0, 1));
  EXPECT_EQ(hand.guide.frame(0), StickFrame{});
  hand.guide.skip();
  hand.guide.skip();
  hand.push(0, vec2(-1, 0));
  EXPECT_EQ(hand.guide.step(), GuideStep::done);
  EXPECT_EQ(hand.guide.frame(0), kFrames[4]);  // two neighbours tell
}

TEST(CalibrationGuide, ATriggerCountsFromWhereItRests) {
  MadeHand hand(Controls::two_sticks_and_triggers);
  hand.finger[0] = 0.2;
  hand.wait(0.5);
  hand.skip_to(GuideStep::triggers);
  hand.press(0, 0.6);  // not far enough from 0.2
  EXPECT_EQ(hand.text(0), "waiting for it");
  hand.press(0, 0.8);
  EXPECT_EQ(hand.text(0), "seen");
  hand.press(1, 0.6);
  EXPECT_EQ(hand.guide.step(), GuideStep::done);
}

}  // namespace
}  // namespace gaitpad
