#include "stick/guide.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stick/made_hand.h"

namespace gaitpad {
namespace {

// ---- The guide as a whole: its steps, what it keeps, repeating and skipping, pads of all kinds

TEST(CalibrationGuide, HasTheStepsThatThePadHasControlsFor) {
  using enum GuideStep;
  const auto steps = [](Controls controls) {
    const MadeHand hand(controls);
    return std::vector(hand.guide.steps().begin(), hand.guide.steps().end());
  };
  const std::vector<GuideStep> of_sticks = {rest, turn, forward, right, back, left, done};
  EXPECT_EQ(steps(Controls::one_stick), of_sticks);
  EXPECT_EQ(steps(Controls::two_sticks), of_sticks);
  EXPECT_EQ(steps(Controls::two_sticks_and_triggers),
            (std::vector<GuideStep>{rest, turn, forward, right, back, left, triggers, done}));
  const PadLayout none;
  EXPECT_EQ(CalibrationGuide(none).step(), done);
}

TEST(CalibrationGuide, NamesTheControlsThatItWaitsFor) {
  MadeHand hand(Controls::two_sticks_and_triggers);
  ASSERT_EQ(hand.guide.progress().size(), 2u);
  EXPECT_EQ(hand.guide.progress()[1].control, "right stick");
  hand.skip_to(GuideStep::triggers);
  ASSERT_EQ(hand.guide.progress().size(), 2u);
  EXPECT_EQ(hand.guide.progress()[0].control, "left trigger");
  EXPECT_EQ(MadeHand(Controls::one_stick).guide.progress().size(), 1u);
}

TEST(CalibrationGuide, FinishesInEveryFrameWhenItsRequestsAreFollowed) {
  for (const StickFrame& frame : kFrames) {
    MadeHand hand(Controls::two_sticks_and_triggers);
    hand.frame = frame;
    hand.centre = vec2(0.08, -0.05);
    hand.reach = 0.9;
    hand.reports_changes_only = frame.forward == RawDirection::plus_x;
    hand.steps_of_sticks(2);
    EXPECT_EQ(hand.guide.step(), GuideStep::triggers);
    hand.press(1, 1.0);
    hand.press(0, 0.8);
    EXPECT_EQ(hand.guide.step(), GuideStep::done);
    EXPECT_EQ(hand.guide.frame(0), frame);
    EXPECT_EQ(hand.guide.frame(1), frame);
  }
}

TEST(CalibrationGuide, BothSticksMayBeMovedAtOnce) {
  MadeHand hand;
  for (int i = 0; i < 8; ++i) {
    const SinCos angle = sin_cos(i * kPi / 4.0 + 0.2);
    hand.thumb = {vec2(angle.cos, angle.sin), vec2(angle.sin, -angle.cos)};
    hand.wait(0.2);
    hand.thumb = {vec2(0.0), vec2(0.0)};
    hand.wait(0.8);
  }
  EXPECT_EQ(hand.guide.step(), GuideStep::rest);
  EXPECT_EQ(hand.text().substr(0, 32), "6 of 6 releases; leave it alone:") << hand.text();
  hand.wait(1.9);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

// A noisy stick with a shifted centre, and one that reaches less than half of the range.
TEST(CalibrationGuide, AWornStickCompletesEveryStep) {
  for (const auto& [sigma, centre, reach] :
       {std::tuple(0.03, vec2(-0.15, 0.12), 0.75), {0.01, vec2(0.06, -0.05), 0.36}}) {
    for (const bool changes_only : {false, true}) {
      MadeHand hand(Controls::one_stick);
      hand.sigma = sigma;
      hand.centre = centre;
      hand.reach = reach;
      hand.frame = kFrames[6];
      hand.reports_changes_only = changes_only;
      hand.steps_of_sticks(1);
      EXPECT_EQ(hand.guide.step(), GuideStep::done) << hand.text();
      EXPECT_EQ(hand.guide.frame(0), kFrames[6]);
      EXPECT_EQ(hand.guide.frame(1), StickFrame{});
    }
  }
}

TEST(CalibrationGuide, TracksHoldEveryRawReport) {
  MadeHand hand(Controls::two_sticks_and_triggers);
  hand.frame = kFrames[7];
  hand.centre = vec2(0.1, 0.0);
  hand.wait(0.1);
  hand.steps_of_sticks(2);
  hand.press(0, 1.0);
  hand.press(1, 1.0);
  const PadTracks tracks = hand.guide.tracks();
  for (std::size_t side = 0; side < 2; ++side) {
    ASSERT_EQ(tracks.stick[side].size(), 1u);
    ASSERT_EQ(tracks.trigger[side].size(), 1u);
    const StickTrack& track = tracks.stick[side].front();
    EXPECT_NEAR(track.front().raw.x, 0.1, 1e-4);
    for (std::size_t i = 1; i < track.size(); ++i)
      ASSERT_EQ(track[i].time_ns - track[i - 1].time_ns, 4'000'000);
  }
}

TEST(CalibrationGuide, ARepeatedStepForgetsWhatItHasSeen) {
  MadeHand hand(Controls::one_stick);
  hand.rest_step(0);
  ASSERT_EQ(hand.guide.step(), GuideStep::turn);
  const std::size_t kept = hand.samples();
  hand.turn(0, 0.6, 0.9);
  EXPECT_GT(hand.samples(), kept);
  hand.guide.repeat();
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
  EXPECT_LE(hand.samples(), kept);
  EXPECT_NE(hand.text().find("0 of 48"), std::string::npos) << hand.text();
  hand.wait(0.1);
  // The reports between the two parts were dropped.
  EXPECT_EQ(hand.guide.tracks().stick[0].size(), 2u);
}

TEST(CalibrationGuide, BackRestartsThePreviousStep) {
  MadeHand hand(Controls::one_stick);
  hand.rest_step(0);
  const std::size_t of_rest = hand.samples();
  hand.full_turns(0);
  hand.push(0, vec2(0, 1));
  ASSERT_EQ(hand.guide.step(), GuideStep::right);
  hand.guide.back();
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
  hand.guide.back();
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
  EXPECT_LE(hand.samples(), of_rest);
  hand.guide.back();
  hand.guide.back();  // there is no step before the first one
  EXPECT_EQ(hand.guide.step(), GuideStep::rest);
  EXPECT_EQ(hand.samples(), 0u);
  EXPECT_EQ(hand.text(), "0 of 6 releases");
  hand.steps_of_sticks(1);
  EXPECT_EQ(hand.guide.step(), GuideStep::done);
}

TEST(CalibrationGuide, SkippingKeepsWhatWasSeenUpToTheEnd) {
  MadeHand hand(Controls::one_stick);
  hand.wait(1.0);
  hand.skip_to(GuideStep::left);
  EXPECT_EQ(hand.samples(), 250u);
  hand.wait(1.0);
  hand.guide.skip();
  EXPECT_EQ(hand.guide.step(), GuideStep::done);
  hand.guide.skip();
  hand.wait(1.0);  // the finished guide ignores further reports
  EXPECT_EQ(hand.samples(), 500u);
  hand.guide.back();
  EXPECT_EQ(hand.guide.step(), GuideStep::left);
}

TEST(CalibrationGuide, UnpluggingCutsTheTrackAndLosesNothing) {
  MadeHand hand(Controls::one_stick);
  hand.release_around(0, 4);
  const std::string before = hand.text();
  const std::size_t samples = hand.samples();
  hand.thumb[0] = vec2(0.0, 0.95);
  hand.wait(0.1);
  hand.guide.unplugged();
  hand.thumb[0] = vec2(0.0);
  hand.time_ns += 60'000'000'000;
  hand.guide.tick(hand.time_ns);
  EXPECT_EQ(hand.text(), before);
  hand.wait(1.0);
  // A push that was cut off by unplugging does not count as a release.
  EXPECT_EQ(hand.text(), before);
  EXPECT_GT(hand.samples(), samples);
  EXPECT_EQ(hand.guide.tracks().stick[0].size(), 2u);
  hand.push(0, vec2(0, -1));
  hand.push(0, vec2(1, 0), 0.1, 2.7);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
  hand.guide.unplugged();  // unplugged between two steps
  hand.guide.skip();
  hand.wait(0.5);
  EXPECT_EQ(hand.guide.tracks().stick[0].size(), 3u);
}

TEST(CalibrationGuide, TheResultDependsOnTheReportsNotOnTheTicks) {
  MadeHand hand(Controls::one_stick);
  hand.sigma = 0.02;
  hand.frame = kFrames[5];
  CalibrationGuide unwatched(hand.layout);
  hand.copy = &unwatched;
  hand.steps_of_sticks(1);
  ASSERT_EQ(hand.guide.step(), GuideStep::done);
  EXPECT_EQ(unwatched.step(), GuideStep::done);
  EXPECT_EQ(unwatched.frame(0), hand.guide.frame(0));
  EXPECT_EQ(unwatched.tracks().stick[0].front().size(), hand.samples());
}

TEST(CalibrationGuide, ExtremeTimeStampsDoNotCrash) {
  MadeHand hand(Controls::one_stick);
  for (const std::int64_t time : {INT64_MIN, INT64_MAX, std::int64_t{0}, INT64_MIN}) {
    hand.time_ns = time;
    hand.send(hand.report());
    hand.guide.tick(time);
  }
  EXPECT_EQ(hand.guide.step(), GuideStep::rest);
}

TEST(CalibrationGuide, SaysThatItIsFull) {
  MadeHand hand(Controls::one_stick);
  const std::vector<std::uint8_t> bytes = hand.report();
  for (std::int64_t i = 0; i < kMaxGuideReports; ++i) {
    hand.time_ns += 1'000'000;
    hand.send(bytes);
  }
  EXPECT_TRUE(hand.guide.is_full());
  EXPECT_NE(hand.guide.instruction().find("no more is kept"), std::string::npos);
  hand.send(bytes);
  EXPECT_EQ(hand.samples(), static_cast<std::size_t>(kMaxGuideReports));
  hand.guide.repeat();
  EXPECT_FALSE(hand.guide.is_full());
}

TEST(FrameOfPushes, TurnsEachPushInTheDirectionAskedFor) {
  const std::vector<vec2> asked = {vec2(0, 1), vec2(1, 0), vec2(0, -1), vec2(-1, 0)};
  for (const StickFrame& frame : kFrames) {
    std::vector<vec2> pushes;
    for (const vec2& to : asked)
      pushes.push_back(0.8 * (to.x * unit(frame.right) + to.y * unit(frame.forward)) +
                       vec2(0.1, -0.05));
    EXPECT_EQ(frame_of_pushes(pushes, asked), frame);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(in_frame(frame, pushes[i]).x > 0.5, i == 1);
    EXPECT_EQ(frame_of_pushes(std::span(pushes).first(2), std::span(asked).first(2)), frame);
  }
}

TEST(FrameOfPushes, IsUnknownIfThePushesDoNotDetermineIt) {
  const std::vector<vec2> asked = {vec2(0, 1), vec2(1, 0), vec2(0, -1), vec2(-1, 0)};
  const auto frame = [&asked](std::vector<vec2> pushes) { return frame_of_pushes(pushes, asked); };
  EXPECT_FALSE(frame({}));
  EXPECT_FALSE(frame({vec2(0, 1)}));                          // pushes along one axis alone
  EXPECT_FALSE(frame({vec2(0, 1), vec2(0, 1)}));              // both pushes go to the same side
  EXPECT_FALSE(frame({vec2(0, 1), vec2(1, 0), vec2(0, 1)}));  // the push back went forward
  // The push left went right.
  EXPECT_FALSE(frame({vec2(0, 1), vec2(1, 0), vec2(0, -1), vec2(1, 0)}));
  EXPECT_FALSE(frame({vec2(0.7, 0.7), vec2(1, 0)}));  // the first push lies between two axes
  EXPECT_FALSE(frame({vec2(NAN, 1), vec2(1, NAN)}));
  EXPECT_FALSE(frame({vec2(0, 0), vec2(0, 0)}));
}

// ---- What counts for each step: releases, turns, pushes, triggers

TEST(CalibrationGuide, NoiseAndSpikesDoNotCountAsReleases) {
  MadeHand hand;
  hand.sigma = 0.04;
  std::mt19937 random(3);
  for (int i = 0; i < 4000; ++i) {
    hand.pass();
    if (random() % 100 != 0) continue;
    hand.thumb[0] = vec2(1.0, 0.0);  // a deflection of one report
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

TEST(CalibrationGuide, TheStickMayBeHeldSlightlyAsideAtTheStart) {
  MadeHand hand(Controls::one_stick);
  hand.thumb[0] = vec2(0.4, 0.0);
  hand.wait(2.0);
  hand.move(0, vec2(0.0), 0.05);
  hand.wait(1.0);
  hand.rest_step(0);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

TEST(CalibrationGuide, AStickThatNeverStandsStillCanBeReleased) {
  MadeHand hand(Controls::one_stick);
  for (int i = 0; i < 6; ++i) {
    const SinCos side = sin_cos(i * kPi / 3.0 + 0.2);
    hand.move(0, vec2(side.cos, side.sin), 0.1);
    for (int k = 0; k < 700; ++k) {
      hand.thumb[0] = vec2(0.12 * std::sin(k * 0.025), 0.0);  // a movement at rest, once in 1.6 s
      hand.pass();
    }
  }
  EXPECT_EQ(hand.guide.step(), GuideStep::turn) << hand.text();
}

TEST(CalibrationGuide, SilenceCountsAsStandingStill) {
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

TEST(CalibrationGuide, NamesTheHalfCircleThatWasNotTurned) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  for (int i = 0; i < 5; ++i) {  // moves to and fro between right and left, over the front
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

TEST(CalibrationGuide, ACutCornerDoesNotCountAsTheRim) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 0.75, 1.0);
  for (int i = 0; i < 3; ++i) hand.turn(0, 0.25, 0.55, 0.75), hand.turn(0, 0.75, 1.0);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
  EXPECT_NE(hand.text().find("not yet: back right"), std::string::npos) << hand.text();
}

TEST(CalibrationGuide, SmallCirclesAndAHeldRimDoNotCountAsTurns) {
  MadeHand hand(Controls::one_stick);
  hand.sigma = 0.02;
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 4.0, 0.4);
  hand.thumb[0] = vec2(0.7, 0.7);
  hand.wait(20.0);
  EXPECT_NE(hand.text().find("0.0 of 2 turns"), std::string::npos) << hand.text();
  hand.turn(0, 1.2, 0.9);  // one turn is not enough
  EXPECT_NE(hand.text().find("48 of 48 directions, 1."), std::string::npos) << hand.text();
  hand.turn(0, 1.0, 0.9, 0.2);
  EXPECT_EQ(hand.guide.step(), GuideStep::forward);
}

TEST(CalibrationGuide, APushMustBeHeldAndReleased) {
  MadeHand hand(Controls::one_stick);
  hand.wait(0.2);
  hand.skip_to(GuideStep::forward);
  hand.push(0, vec2(0, 1), 0.05);  // a push that is too short
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

TEST(CalibrationGuide, AShortPushIsToldToBeHeldLonger) {
  MadeHand hand(Controls::one_stick);
  hand.wait(0.2);
  hand.skip_to(GuideStep::forward);
  hand.push(0, vec2(0, 1), 0.05);
  EXPECT_EQ(hand.text(), "that was short: hold it a little longer");
  hand.push(0, vec2(0, 1));
  EXPECT_EQ(hand.guide.step(), GuideStep::right);
  EXPECT_EQ(hand.text(), "waiting for it");
}

TEST(CalibrationGuide, ATurnThatItsPushesGoBeyondIsAskedForOnceMore) {
  MadeHand hand(Controls::two_sticks);
  for (int side = 0; side < 2; ++side) hand.rest_step(side);
  hand.turn(0, 3.0, 0.8 * hand.reach);  // along the rim, but at 0.8 of its radius
  hand.move(0, vec2(0.0), 0.05);
  hand.full_turns(1);
  const std::array<vec2, 4> sides = {vec2(0, 1), vec2(1, 0), vec2(0, -1), vec2(-1, 0)};
  for (const vec2& to : sides)
    for (int side = 0; side < 2; ++side) hand.push(side, to);
  ASSERT_EQ(hand.guide.step(), GuideStep::turn);
  EXPECT_TRUE(hand.text().starts_with("it was not pressed to its rim, once more: 0 of 48"))
      << hand.text();
  EXPECT_TRUE(hand.text(1).starts_with("48 of 48")) << hand.text(1);
  hand.full_turns(0);
  hand.wait(0.1);
  EXPECT_EQ(hand.guide.step(), GuideStep::done);  // the pushes that were made before count
}

TEST(CalibrationGuide, AStickThatRestsAsideIsLetGoMoreOften) {
  MadeHand hand(Controls::one_stick);
  hand.centre = vec2(0.12, 0.0);
  hand.reach = 0.85;
  hand.release_around(0, 8);
  hand.wait(2.0);
  EXPECT_EQ(hand.guide.step(), GuideStep::rest);
  EXPECT_EQ(hand.text(),
            "8 of 10 releases; it rests 0.12 off its middle: take your thumb right off");
  EXPECT_NE(hand.guide.instruction().find("; 10 times, "), std::string::npos)
      << hand.guide.instruction();
  hand.release_around(0, 3);
  hand.wait(2.0);
  EXPECT_EQ(hand.guide.step(), GuideStep::turn);
}

TEST(CalibrationGuide, WhatIsHeldWhenAStepBeginsDoesNotCountForIt) {
  MadeHand hand(Controls::one_stick);
  hand.skip_to(GuideStep::turn);
  hand.turn(0, 2.5, 0.9);  // the stick is still at the rim when the step is over
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
  hand.push(0, vec2(1, 0));  // the user pushes to the right by mistake
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
  EXPECT_EQ(hand.guide.frame(0), kFrames[4]);  // two pushes at right angles are enough
}

TEST(CalibrationGuide, ATriggerCountsFromWhereItRests) {
  MadeHand hand(Controls::two_sticks_and_triggers);
  hand.finger[0] = 0.2;
  hand.wait(0.5);
  hand.skip_to(GuideStep::triggers);
  hand.press(0, 0.6);  // 0.6 is not far enough from 0.2
  EXPECT_EQ(hand.text(0), "waiting for it");
  hand.press(0, 0.8);
  EXPECT_EQ(hand.text(0), "seen");
  hand.press(1, 0.6);
  EXPECT_EQ(hand.guide.step(), GuideStep::done);
}

}  // namespace
}  // namespace gaitpad
