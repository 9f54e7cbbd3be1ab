#include "session/pad_forward.h"

#include <gtest/gtest.h>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

TEST(PadForward, HasTheCalibratedStickAndTheButtons) {
  PadConfig config = made_pad_config();
  config.calibration.left.inner = 0.5;
  Pads pads({config}, 240);
  Report report = made_report(0xff, 0x80);
  report.bytes[4] = 0x18;  // presses button 1
  ASSERT_TRUE(pads.take_report(report));
  const Stick stick = pads.finish_tick();
  const ForwardedTick tick = forwarded_tick(pads, stick);
  EXPECT_EQ(tick.state.stick.left, stick.left);
  EXPECT_GT(tick.state.stick.left.x, 0.9);
  EXPECT_EQ(tick.state.buttons, pads.driving_state().buttons);
  EXPECT_NE(tick.state.buttons, 0u);
  // A deflection of 0.25, inside the zone of 0.5.
  ASSERT_TRUE(pads.take_report(made_report(0xa0, 0x80)));
  EXPECT_EQ(forwarded_tick(pads, pads.finish_tick()).state.stick.left, vec2(0.0));
}

TEST(PadForward, AnUnpluggedPadIsAtRest) {
  Pads pads({made_pad_config()}, 240);
  Report report = made_report(0xff, 0x00);
  report.bytes[4] = 0x18;
  ASSERT_TRUE(pads.take_report(report));
  pads.finish_tick();
  pads.remove_pad(0);
  const VirtualPadState state = forwarded_tick(pads, pads.finish_tick()).state;
  EXPECT_TRUE(events_between(state, {}).empty());
}

TEST(PadForward, APressBetweenTwoTicksIsNotMissed) {
  ForwardedTick up, down;
  down.state.buttons = 1u << kButtonA;
  down.presses[kButtonA] = 1;
  EXPECT_EQ(between(up, down).buttons, down.state.buttons) << "nothing to add";
  ForwardedTick pressed_and_released = up;
  pressed_and_released.presses[kButtonA] = 1;
  EXPECT_EQ(between(up, pressed_and_released).buttons, 1u << kButtonA);
  ForwardedTick pressed_again = down;
  pressed_again.presses[kButtonA] = 2;
  EXPECT_EQ(between(down, pressed_again).buttons, 0u);
}

TEST(PadForward, ATickThatChangesNothingWakesNobody) {
  ForwardedTick tick;
  EXPECT_TRUE(is_same(tick, ForwardedTick{}));
  ForwardedTick moved = tick, pressed = tick;
  moved.state.stick.right.y = 1e-9;
  pressed.presses[kButtonA] = 1;  // the button was pressed and released
  EXPECT_FALSE(is_same(tick, moved));
  EXPECT_FALSE(is_same(tick, pressed));
}

}  // namespace
}  // namespace gaitpad
