#include "pads/calibrated_copy.h"

#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

namespace gaitpad {
namespace {

using Events = std::vector<VirtualPadEvent>;

// A DualShock 4's event node under hid-playstation: 8-bit sticks and triggers, a hat, buttons.
EvdevAbilities sony_abilities() {
  EvdevAbilities abilities;
  for (const int code : {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ})
    abilities.axes.push_back({static_cast<std::uint16_t>(code), 0, 255});
  abilities.axes.push_back({ABS_HAT0X, -1, 1});
  abilities.axes.push_back({ABS_HAT0Y, -1, 1});
  for (const int code : {BTN_SOUTH, BTN_EAST, BTN_NORTH, BTN_WEST, BTN_MODE})
    abilities.keys.push_back(static_cast<std::uint16_t>(code));
  return abilities;
}

struct CalibratedCopyTest : testing::Test {
  void SetUp() override {
    DeviceInfo info;
    info.driver = "evdev";
    info.descriptor = node.descriptor;
    auto made = pad_layout(info);
    ASSERT_TRUE(made);
    copy.emplace(node, *made);
    for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) raw.axis[code] = 128;
  }
  const EvdevLayout node = evdev_layout(sony_abilities(), {});
  std::optional<CalibratedCopy> copy;
  EvdevState raw;
};

TEST_F(CalibratedCopyTest, HasThePadsCodesAndFinerSticks) {
  const auto axes = copy->axes();
  ASSERT_EQ(axes.size(), 8u);
  const auto axis = [&axes](int code) {
    for (const VirtualPadAxis& a : axes)
      if (a.code == code) return a;
    return VirtualPadAxis{};
  };
  EXPECT_EQ(axis(ABS_RX), (VirtualPadAxis{ABS_RX, -32767, 32767}));
  EXPECT_EQ(axis(ABS_RZ), (VirtualPadAxis{ABS_RZ, 0, 255}));
  EXPECT_EQ(axis(ABS_HAT0Y), (VirtualPadAxis{ABS_HAT0Y, -1, 1}));
  EXPECT_EQ(copy->keys().size(), 5u);
}

TEST_F(CalibratedCopyTest, SendsThePositionNotTheCount) {
  EXPECT_TRUE(copy->events(raw, {}).empty()) << "at rest";
  VirtualPadState state;
  state.stick.left = vec2(0.5, 1.0);  // the stick points right and forward
  state.trigger[1] = 0.5;
  raw.axis[ABS_X] = 177;
  EXPECT_EQ(copy->events(raw, state),
            (Events{{EV_ABS, ABS_X, 16384}, {EV_ABS, ABS_Y, -32767}, {EV_ABS, ABS_RZ, 128}}));
  raw.axis[ABS_X] = 178;
  EXPECT_TRUE(copy->events(raw, state).empty()) << "the same position";
}

TEST_F(CalibratedCopyTest, PassesEverythingElseAsItIs) {
  raw.keys[BTN_MODE] = true;
  raw.axis[ABS_HAT0X] = -1;
  EXPECT_EQ(copy->events(raw, {}), (Events{{EV_ABS, ABS_HAT0X, -1}, {EV_KEY, BTN_MODE, 1}}));
}

TEST_F(CalibratedCopyTest, ComesToRestWhenThePadIsGone) {
  VirtualPadState state;
  state.stick.left = vec2(1.0, 0.0);
  state.trigger[0] = 1.0;
  raw.keys[BTN_EAST] = true;
  raw.axis[ABS_HAT0Y] = 1;
  EXPECT_EQ(copy->events(raw, state).size(), 4u);
  EXPECT_EQ(
      copy->rest(),
      (Events{
          {EV_ABS, ABS_X, 0}, {EV_ABS, ABS_Z, 0}, {EV_ABS, ABS_HAT0Y, 0}, {EV_KEY, BTN_EAST, 0}}));
  EXPECT_TRUE(copy->rest().empty());
}

TEST(CalibratedCopy, AnAxisThatIsTwoTriggersPassesAsItIs) {
  EvdevAbilities abilities;
  for (const int code : {ABS_X, ABS_Y, ABS_Z})
    abilities.axes.push_back({static_cast<std::uint16_t>(code), 0, 255});
  abilities.keys = {BTN_A};
  const EvdevLayout node = evdev_layout(abilities, {});
  DeviceInfo info;
  info.driver = "evdev";
  info.vendor = 0x1209;
  info.product = 0x0009;
  info.bus = BusType::usb;
  info.descriptor = node.descriptor;
  info.mapping =
      "0300000009120000090000000000000,Both,leftx:a0,lefty:a1,lefttrigger:+a2,righttrigger:-a2,a:"
      "b0,";
  const auto pad = pad_layout(info);
  ASSERT_TRUE(pad);
  CalibratedCopy copy(node, *pad);
  EvdevState raw;
  raw.axis[ABS_Z] = 200;
  EXPECT_EQ(copy.events(raw, {}), (Events{{EV_ABS, ABS_Z, 200}}));
}

}  // namespace
}  // namespace gaitpad
