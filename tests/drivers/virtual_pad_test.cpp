#include "drivers/virtual_pad.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

namespace gaitpad {
namespace {

using Events = std::vector<VirtualPadEvent>;

VirtualPadState with_button(PadButton button) { return {.buttons = 1u << button}; }

TEST(VirtualPad, ChangesAreSentWithLinuxsCountsAndDirections) {
  VirtualPadState state;
  state.stick.left = vec2(1.0, 1.0);  // the stick points right and forward
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

TEST(VirtualPad, AnXbox360PadHasTheKernelsCodesAndTriggers) {
  const VirtualPadShape shape = shape_of(XboxKind::xbox_360);
  EXPECT_EQ(shape.keys.size(), 11u);
  for (const VirtualPadAxis& axis : shape.axes) {
    if (axis.code == ABS_RZ) EXPECT_EQ(axis.max, 255);
  }
  EXPECT_EQ(events_between({}, {.trigger = {1.0, 0.0}}, XboxKind::xbox_360),
            (Events{{EV_ABS, ABS_Z, 255}}));
  EXPECT_TRUE(events_between({}, with_button(kButtonPaddle1), XboxKind::xbox_360).empty());
}

TEST(VirtualPad, IsKnownByItsPortWhateverItsIds) {
  DeviceInfo info;
  info.vendor = 0x045e;
  info.product = 0x028e;
  info.physical_path = "usb-0000:00:14.0-1/input0";
  EXPECT_FALSE(is_virtual_pad(info));
  info.physical_path = std::string(kVirtualPort) + info.physical_path;
  EXPECT_TRUE(is_virtual_pad(info));
}

}  // namespace
}  // namespace gaitpad
