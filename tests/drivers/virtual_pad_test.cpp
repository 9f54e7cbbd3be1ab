#include "drivers/virtual_pad.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

namespace gaitpad {
namespace {

using Events = std::vector<VirtualPadEvent>;

VirtualPadState with_button(PadButton button) { return {.buttons = 1u << button}; }

TEST(VirtualPad, ChangesAreSentWithLinuxsCountsAndDirections) {
  VirtualPadState state;
  state.stick.left = vec2(1.0, 1.0);  // right and forward
  state.stick.right = vec2(-0.5, 0.0);
  EXPECT_EQ(events_between({}, state),
            (Events{{EV_ABS, ABS_X, 32767}, {EV_ABS, ABS_Y, -32767}, {EV_ABS, ABS_RX, -16384}}));
  EXPECT_EQ(events_between(state, {}),
            (Events{{EV_ABS, ABS_X, 0}, {EV_ABS, ABS_Y, 0}, {EV_ABS, ABS_RX, 0}}));
  EXPECT_EQ(events_between({}, {.trigger = {1.0, 0.5}}),
            (Events{{EV_ABS, ABS_Z, 1023}, {EV_ABS, ABS_RZ, 512}}));
  const VirtualPadState same = {.stick = {vec2(0.3, -0.7), vec2(0.0)}, .trigger = {0.5, 1.0}};
  EXPECT_TRUE(events_between(same, same).empty());
}

TEST(VirtualPad, ButtonsHaveTheCodesOfTheXboxPadsAndTheDpadIsAHat) {
  for (const auto& [button, code] :
       {std::pair(kButtonA, BTN_A), {kButtonX, BTN_X}, {kButtonTouchpad, BTN_TRIGGER_HAPPY6}})
    EXPECT_EQ(events_between({}, with_button(button)),
              (Events{{EV_KEY, static_cast<std::uint16_t>(code), 1}}));
  EXPECT_EQ(events_between(with_button(kButtonRightShoulder), {}), (Events{{EV_KEY, BTN_TR, 0}}));
  const VirtualPadState up_right = {.buttons = 1u << kButtonDpadUp | 1u << kButtonDpadRight};
  EXPECT_EQ(events_between({}, up_right),
            (Events{{EV_ABS, ABS_HAT0X, 1}, {EV_ABS, ABS_HAT0Y, -1}}));
}

}  // namespace
}  // namespace gaitpad
