#include "gaitpad/pads.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

constexpr int kRateHz = 240;
constexpr int kForward = 0x00, kMiddle = 0x80;

Pads one_pad(bool streams = false) {
  PadConfig config = made_pad_config();
  config.streams = streams;
  return Pads({config}, kRateHz);
}

// The stick after this number of ticks without a report.
Stick after_silence(Pads& pads, int ticks) {
  Stick stick;
  for (int i = 0; i < ticks; ++i) stick = pads.finish_tick();
  return stick;
}

TEST(Pads, LastReportOfATickCounts) {
  Pads pads = one_pad();
  EXPECT_TRUE(pads.take_report(made_report(kMiddle, kForward)));
  EXPECT_TRUE(pads.take_report(made_report(0xff, kMiddle)));
  const Stick stick = pads.finish_tick();
  EXPECT_GT(stick.left.x, 0.9);
  EXPECT_NEAR(stick.left.y, 0.0, 0.01);
}

TEST(Pads, SilenceOf100MsMakesAStreamingPadAloneNeutralUntilItsNextReport) {
  Pads changes_only = one_pad();
  changes_only.take_report(made_report(kMiddle, kForward));
  EXPECT_GT(after_silence(changes_only, 10 * kRateHz).left.y, 0.9);
  Pads pads = one_pad(true);
  pads.take_report(made_report(kMiddle, kForward));
  EXPECT_GT(after_silence(pads, kRateHz / 10).left.y, 0.9);
  EXPECT_EQ(after_silence(pads, 1).left, vec2(0.0));
  pads.take_report(made_report(kMiddle, kForward));
  EXPECT_GT(after_silence(pads, 1).left.y, 0.9);
}

TEST(Pads, RemovedIsNeutralAtOnceAndPluggedInAgainCountsOnceItWasNearItsCentre) {
  Pads pads = one_pad();
  pads.take_report(made_report(kMiddle, kForward));
  pads.remove_pad(0);
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.take_report(made_report(kMiddle, kMiddle));  // a report that comes while the pad is gone
  pads.remove_pad(0);
  pads.add_pad(0);
  pads.take_report(made_report(kMiddle, kForward));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.take_report(made_report(kMiddle, 0x7c));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.take_report(made_report(kMiddle, kForward));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

TEST(Pads, NotYetPluggedInIsNeutralAndSoAreNone) {
  PadConfig config = made_pad_config();
  config.is_present = false;
  Pads pads({config}, kRateHz);
  pads.take_report(made_report(kMiddle, kForward));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.add_pad(0);
  pads.take_report(made_report(kMiddle, kForward));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
  EXPECT_EQ(Pads({}, kRateHz).finish_tick().left, vec2(0.0));
}

TEST(Pads, InVersion1TheFirstUsablePadDrivesWhoeverMoves) {
  PadConfig unusable = made_pad_config();
  unusable.is_usable = false;
  Pads pads({unusable, made_pad_config(), made_pad_config()}, kRateHz, PadRules::version_1);
  pads.take_report(made_report(kMiddle, kForward, 0));
  pads.take_report(made_report(0xff, kMiddle, 2));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.take_report(made_report(kMiddle, kForward, 1));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

TEST(Pads, AShortReportAndAnUnknownDeviceAreRefusedAndChangeNothing) {
  Pads pads = one_pad();
  pads.take_report(made_report(kMiddle, kForward));
  Report cut = made_report(kMiddle, kMiddle);
  cut.size = 3;
  EXPECT_FALSE(pads.take_report(cut));
  EXPECT_FALSE(pads.take_report(made_report(kMiddle, kMiddle, 1)));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

// Pushes the left stick in 100 ms, like a thumb, with one report per tick.
void push(Pads& pads, std::uint16_t device, int from_y, int to_y) {
  constexpr int kTicks = 24;
  for (int i = 0; i <= kTicks; ++i) {
    pads.take_report(made_report(kMiddle, from_y + (to_y - from_y) * i / kTicks, device));
    pads.finish_tick();
  }
}

// The second device is a receiver, a virtual pad or the pad's twin: plugged in but never moved.
TEST(Pads, APadThatIsMovedDrivesThoughAnotherIsThereThatNeverReports) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  push(pads, 1, kMiddle, kForward);
  EXPECT_EQ(pads.driving(), 1);
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

TEST(Pads, APadThatReportsAHeldStickAllTheTimeIsNotMoved) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  for (int i = 0; i < kRateHz; ++i) {
    // Zeros and noise, as an adapter without a pad sends them.
    pads.take_report(made_report(i % 2, i % 3, 0));
    pads.finish_tick();
  }
  push(pads, 1, kMiddle, kForward);
  EXPECT_EQ(pads.driving(), 1);
}

TEST(Pads, NoiseOfARestingStickMovesNothing) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  for (int i = 0; i < 10 * kRateHz; ++i) {
    pads.take_report(made_report(kMiddle + i % 5, kMiddle - i % 7, 1));
    pads.finish_tick();
  }
  EXPECT_EQ(pads.driving(), 0);
}

TEST(Pads, APadInUseKeepsTheSeatUntilItHasBeenUntouchedForFiveSeconds) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  push(pads, 0, kMiddle, kForward);
  after_silence(pads, 60 * kRateHz);  // the stick is held, which counts as touched
  push(pads, 1, kMiddle, kForward);
  EXPECT_EQ(pads.driving(), 0);
  push(pads, 1, kForward, kMiddle);
  push(pads, 0, kForward, kMiddle);
  after_silence(pads, 5 * kRateHz - kRateHz / 2);
  push(pads, 1, kMiddle, 0x40);
  EXPECT_EQ(pads.driving(), 0) << "4.6 s";
  after_silence(pads, kRateHz);
  EXPECT_EQ(pads.driving(), 0) << "the other pad is held, not moved";
  push(pads, 1, 0x40, kForward);
  EXPECT_EQ(pads.driving(), 1);
  push(pads, 0, kMiddle, kForward);
  EXPECT_EQ(pads.driving(), 1);
}

// Two pads, both plugged in; the first drives and is held forward.
Pads two_pads(int second_y) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  push(pads, 0, kMiddle, kForward);
  pads.take_report(made_report(kMiddle, second_y, 1));
  pads.finish_tick();
  return pads;
}

TEST(Pads, ARestingPadTakesOverAndKeepsDrivingUntilItIsLostItself) {
  Pads pads = two_pads(kMiddle);
  EXPECT_EQ(pads.driving(), 0);
  pads.remove_pad(0);
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  EXPECT_EQ(pads.driving(), 1);
  pads.take_report(made_report(kMiddle, kForward, 1));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
  EXPECT_GT(pads.driving_state().axis[kLeftY], 0.9f);
  pads.take_report(made_report(kMiddle, kMiddle, 1));
  pads.add_pad(0);
  pads.take_report(made_report(kMiddle, kMiddle, 0));
  pads.take_report(made_report(0xff, kMiddle, 0));
  EXPECT_EQ(pads.driving(), 1);
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.take_report(made_report(kMiddle, kMiddle, 0));
  pads.remove_pad(1);
  EXPECT_EQ(pads.driving(), 0);
  pads.take_report(made_report(0xff, kMiddle, 0));
  EXPECT_GT(pads.finish_tick().left.x, 0.9);
}

TEST(Pads, AHeldPadTakesOverOnceItIsSeenNearItsCentre) {
  Pads pads = two_pads(kForward);
  pads.remove_pad(0);
  pads.take_report(made_report(0x10, kForward, 1));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  EXPECT_EQ(pads.driving(), 0);
  EXPECT_EQ(pads.driving_state(), PadState{});
  pads.take_report(made_report(kMiddle, 0x7c, 1));
  pads.take_report(made_report(kMiddle, kForward, 1));
  EXPECT_EQ(pads.driving(), 1);
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

TEST(Pads, TheOldPadDrivesAgainIfNoneHasTakenOver) {
  Pads pads = two_pads(kForward);
  pads.remove_pad(0);
  pads.add_pad(0);
  pads.take_report(made_report(kMiddle, kForward + 4, 1));  // the first pad is still held
  EXPECT_EQ(pads.driving(), 0);
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  pads.take_report(made_report(kMiddle, kMiddle, 0));
  pads.take_report(made_report(kMiddle, kForward, 0));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

TEST(Pads, WhatIsUnusableUnpluggedOrSilentDoesNotTakeOver) {
  PadConfig unusable = made_pad_config(), streaming = made_pad_config();
  unusable.is_usable = false;
  streaming.streams = true;
  Pads pads({made_pad_config(), unusable, made_pad_config(), streaming, made_pad_config()},
            kRateHz);
  for (std::uint16_t device : {1, 2, 3}) pads.take_report(made_report(kMiddle, kMiddle, device));
  pads.remove_pad(2);
  after_silence(pads, kRateHz);
  pads.remove_pad(0);
  EXPECT_EQ(pads.driving(), 0) << "nor one that has not reported yet";
  pads.take_report(made_report(kMiddle, kMiddle, 4));
  EXPECT_EQ(pads.driving(), 4);
}

TEST(Pads, OfSeveralRestingPadsTheOneThatWasPluggedInFirstTakesOver) {
  PadConfig later = made_pad_config();
  later.is_present = false;
  Pads pads({later, later, later}, kRateHz);
  for (std::uint16_t device : {2, 1, 0}) {
    pads.add_pad(device);
    pads.take_report(made_report(kMiddle, kMiddle, device));
  }
  EXPECT_EQ(pads.driving(), 2);
  pads.remove_pad(2);
  EXPECT_EQ(pads.driving(), 1);
}

TEST(Pads, OfPadsPluggedInLaterTheFirstUsableOneDrives) {
  Pads pads(unknown_pads(3), kRateHz);
  EXPECT_EQ(pads.driving(), kNoDevice);
  EXPECT_EQ(pads.driving_state(), PadState{});
  PadConfig unusable = made_pad_config(), first = made_pad_config(), second = made_pad_config();
  unusable.is_usable = false;
  pads.set_pad(0, unusable);
  pads.set_pad(1, first);
  pads.set_pad(2, second);
  pads.set_pad(3, second);
  EXPECT_EQ(pads.driving(), kNoDevice) << "not plugged in yet";
  for (std::uint16_t device : {0, 2, 1}) pads.add_pad(device);
  EXPECT_EQ(pads.driving(), 2);
  pads.take_report(made_report(kMiddle, kForward, 2));
  EXPECT_GT(pads.finish_tick().left.y, 0.9);
}

PadConfig made_keyboard() {
  PadConfig config = made_pad_config();
  config.is_fallback = true;
  return config;
}
constexpr std::uint16_t kKeys = 0, kPad = 1;

// The keyboard is there first and held to the right; the pad comes later and rests.
Pads keys_and_pad() {
  PadConfig pad = made_pad_config();
  pad.is_present = false;
  Pads pads({made_keyboard(), pad, pad}, kRateHz);
  pads.take_report(made_report(0xff, kMiddle, kKeys));
  return pads;
}

TEST(Pads, AFallbackDrivesUntilAPadIsPluggedIn) {
  Pads pads = keys_and_pad();
  EXPECT_EQ(pads.driving(), kKeys);
  EXPECT_GT(pads.finish_tick().left.x, 0.9);
  pads.add_pad(kPad);
  EXPECT_EQ(pads.driving(), kPad);
  pads.take_report(made_report(kMiddle, kForward, kPad));
  const Stick stick = pads.finish_tick();
  EXPECT_GT(stick.left.y, 0.9);
  EXPECT_NEAR(stick.left.x, 0.0, 0.01) << "the keys do not count";
  Pads other_order({made_keyboard(), made_pad_config()}, kRateHz);
  EXPECT_EQ(other_order.driving(), kPad);
}

TEST(Pads, BothSticksOfAFallbackCountWhileTheDrivingOneRestsExactly) {
  Pads pads = keys_and_pad();
  pads.add_pad(kPad);
  Report right = made_report(kMiddle, kMiddle, kPad);
  right.bytes[2] = 0xff;
  pads.take_report(right);
  EXPECT_GT(pads.finish_tick().left.x, 0.9);
  EXPECT_EQ(pads.finish_tick().right.x, 0.0) << "the right one is the fallback's, too";
  pads.take_report(made_report(kMiddle, kMiddle, kKeys));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
  EXPECT_GT(pads.finish_tick().right.x, 0.9);
  pads.take_report(made_report(0xff, kMiddle, kKeys));
  pads.take_report(made_report(kMiddle, 0x60, kPad));  // a position just beyond the inner zone
  const Stick stick = pads.finish_tick();
  EXPECT_GT(stick.left.y, 0.0);
  EXPECT_EQ(stick.left.x, 0.0);
  EXPECT_EQ(pads.driving(), kPad) << "whose buttons are shown";
}

TEST(Pads, AFallbackDrivesAgainWhenTheLastPadIsLostAndNotBefore) {
  Pads pads = keys_and_pad();
  pads.add_pad(kPad);
  push(pads, kPad, kMiddle, kForward);
  pads.add_pad(kPad + 1);
  pads.take_report(made_report(kMiddle, kForward, kPad + 1));
  pads.remove_pad(kPad);
  EXPECT_EQ(pads.driving(), kPad) << "the other pad is held, but it is there";
  EXPECT_GT(pads.finish_tick().left.x, 0.9) << "the keys count";
  pads.take_report(made_report(0xff, kMiddle, kKeys));
  EXPECT_EQ(pads.driving(), kPad);
  pads.remove_pad(kPad + 1);
  EXPECT_EQ(pads.driving(), kKeys);
  pads.add_pad(kPad);
  EXPECT_EQ(pads.driving(), kPad);
  pads.take_report(made_report(kMiddle, kForward, kPad));
  EXPECT_NEAR(pads.finish_tick().left.y, 0.0, 0.01) << "not yet seen near its centre";
}

TEST(Pads, AnUnusableOrUnpluggedFallbackDoesNotCount) {
  PadConfig unusable = made_keyboard(), absent = made_keyboard();
  unusable.is_usable = false;
  absent.is_present = false;
  Pads pads({unusable, absent, made_pad_config()}, kRateHz);
  for (std::uint16_t device : {0, 1}) pads.take_report(made_report(0xff, kMiddle, device));
  EXPECT_EQ(pads.finish_tick().left, vec2(0.0));
}

Report made_buttons(std::uint16_t pressed, std::uint16_t device = 0) {
  Report report = made_report(kMiddle, kMiddle, device);
  report.bytes[4] = static_cast<std::uint8_t>(0x08 | (pressed & 0x0f) << 4);
  report.bytes[5] = static_cast<std::uint8_t>(pressed >> 4);
  return report;
}

// A report with the hat of made_pad() in a direction: clockwise from 0, up; 8 is none.
Report made_hat(int hat, int x = kMiddle, int y = kMiddle) {
  Report report = made_report(x, y);
  report.bytes[4] = static_cast<std::uint8_t>(hat);
  return report;
}

TEST(Pads, TheDPadIsTheStickUntilTheStickHasMoved) {
  Pads pads = one_pad();
  const auto left = [&pads](int hat) {
    pads.take_report(made_hat(hat));
    return pads.finish_tick().left;
  };
  EXPECT_EQ(left(0), vec2(0.0, 1.0));
  EXPECT_EQ(left(6), vec2(-1.0, 0.0));
  EXPECT_NEAR(glm::length(left(3) - vec2(std::sqrt(0.5), -std::sqrt(0.5))), 0.0, 1e-12);
  EXPECT_EQ(left(8), vec2(0.0));
  after_silence(pads, 2 * kRateHz);
  left(0);
  after_silence(pads, kRateHz);
  EXPECT_EQ(pads.untouched(), 0);
  push(pads, 0, kMiddle, kForward);
  push(pads, 0, kForward, kMiddle);
  EXPECT_EQ(left(4), vec2(0.0)) << "a pad with a stick";
  pads.remove_pad(0);
  pads.add_pad(0);
  left(8);
  EXPECT_EQ(left(4), vec2(0.0, -1.0)) << "another one may be plugged in now";
  Pads before({made_pad_config()}, kRateHz, PadRules::version_1);
  before.take_report(made_hat(0));
  EXPECT_EQ(before.finish_tick().left, vec2(0.0));
}

TEST(Pads, AButtonTakesTheSeatToo) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  pads.take_report(made_buttons(0, 1));
  EXPECT_EQ(pads.driving(), 0);
  pads.take_report(made_buttons(1, 1));
  EXPECT_EQ(pads.driving(), 1);
  Pads digital({made_pad_config(), made_pad_config()}, kRateHz);
  digital.take_report(made_report(kMiddle, kForward, 1));  // the pad's first report is the push
  EXPECT_EQ(digital.driving(), 1);
  EXPECT_GT(digital.finish_tick().left.y, 0.9);
}

TEST(Pads, PressesOfTheDrivingPadAreCountedByEveryReport) {
  Pads pads({made_pad_config(), made_pad_config()}, kRateHz);
  PadState first;
  ASSERT_TRUE(decode(*made_pad_config().layout, made_buttons(1), first));
  const int button = std::countr_zero(first.buttons);
  for (int i = 0; i < 3; ++i) {
    pads.take_report(made_buttons(1));
    pads.take_report(made_buttons(1));
    pads.take_report(made_buttons(0));
    pads.take_report(made_buttons(1, 1));
    pads.take_report(made_buttons(0, 1));
  }
  for (int b = 0; b < kButtonCount; ++b) EXPECT_EQ(pads.presses()[b], b == button ? 3u : 0u) << b;
}

TEST(Pads, WhatIsKnownOfTheDrivingPadIsItsOwn) {
  PadConfig second = made_pad_config();
  second.calibration.left.inner = 0.3;
  Pads pads({made_pad_config(), second}, kRateHz);
  for (int i = 0; i < 5; ++i) pads.take_report(made_report(kMiddle, kMiddle, 1));
  Report cut = made_report(kMiddle, kMiddle);
  cut.size = 1;
  pads.take_report(cut);
  EXPECT_EQ(pads.driving_reports(), 1u);
  EXPECT_TRUE(pads.driving_pad()->is_present);
  pads.remove_pad(0);
  EXPECT_EQ(pads.driving_reports(), 5u);
  EXPECT_EQ(pads.driving_pad()->calibration.left.inner, 0.3);
  pads.remove_pad(1);
  EXPECT_FALSE(pads.driving_pad()->is_present);
  EXPECT_EQ(Pads({}, kRateHz).driving_pad(), nullptr);
}

TEST(Pads, AFilteredStickIgnoresASingleReportAndIsNotBehindInSilence) {
  PadConfig config = made_pad_config();
  config.calibration.left.filters_jumps = true;
  Pads pads({config}, kRateHz);
  const auto tick = [&pads](int y) {
    pads.take_report(made_report(kMiddle, y));
    return pads.finish_tick().left;
  };
  EXPECT_EQ(tick(kMiddle), vec2(0.0));
  EXPECT_EQ(tick(kForward), vec2(0.0));
  EXPECT_EQ(tick(kMiddle), vec2(0.0));
  EXPECT_EQ(tick(kMiddle), vec2(0.0));
  // The pad reports only changes: the push is held, and no report follows it.
  EXPECT_EQ(tick(kForward), vec2(0.0));
  EXPECT_EQ(after_silence(pads, 4).left, vec2(0.0));
  EXPECT_GT(after_silence(pads, 1).left.y, 0.9);  // the push has lasted for 20 ms, so it counts
  // A jump of one report is filtered at these report rates as well.
  for (const int report_hz : {20, 60, 125}) {
    Pads slow({config}, kRateHz);
    for (int n = 0; n < 20; ++n) {
      slow.take_report(made_report(kMiddle, n == 15 ? kForward : kMiddle));
      EXPECT_EQ(after_silence(slow, kRateHz / report_hz).left, vec2(0.0)) << report_hz << " " << n;
    }
  }
}

TEST(Pads, AWalkThatBeginsUntouchedIsCounted) {
  Pads pads = one_pad();
  pads.take_report(made_report(kMiddle, kMiddle));
  after_silence(pads, 3 * kRateHz);
  pads.take_report(made_report(kMiddle, kForward));
  pads.finish_tick();
  pads.take_report(made_report(kMiddle, kMiddle));  // one report of a jump, 4 ms long
  after_silence(pads, kRateHz);
  EXPECT_EQ(pads.untouched(), 1);
  pads.take_report(made_report(kMiddle, kForward));
  after_silence(pads, kRateHz);  // a push that is held is no jump
  EXPECT_EQ(pads.untouched(), 1);
}

}  // namespace
}  // namespace gaitpad
