#include "drivers/sdl_reports.h"

#include <gtest/gtest.h>

#include "gaitpad/decode.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

using Control = JoystickReports::Control;

JoystickState resting(std::size_t axes, std::size_t buttons, std::size_t hats) {
  JoystickState state;
  state.axes.resize(axes);
  state.buttons.resize(buttons);
  state.hats.resize(hats);
  return state;
}

// A joystick without a node.
PadLayout layout_of(const JoystickState& state) {
  DeviceInfo device;
  device.driver = "sdl";
  device.descriptor = joystick_reports(state, "", 0).layout().descriptor;
  return value_of(pad_layout(device, {}));
}

PadState decoded(const PadLayout& layout, const JoystickState& state) {
  Report report;
  joystick_reports(state, "", 0).write(0, report);
  PadState pad;
  EXPECT_TRUE(decode(layout, report, pad));
  return pad;
}

// (2 v + 1) / 65535 of a range of -32768 .. 32767.
TEST(SdlReports, TheStatedDescriptorGivesBackWhatWasWritten) {
  JoystickState state = resting(4, 12, 1);
  const PadLayout layout = layout_of(state);
  EXPECT_TRUE(layout.is_pad);
  state.axes = {-32768, -32768, 18632, 32767};
  state.buttons[1] = 1;
  state.hats[0] = 1 | 2;
  const PadState pad = decoded(layout, state);
  EXPECT_EQ(pad.axis[kLeftX], -1.0f);
  EXPECT_EQ(pad.axis[kLeftY], 1.0f) << "SDL's y grows towards the thumb's owner";
  EXPECT_FLOAT_EQ(pad.axis[kRightX], (2.0f * 18632 + 1) / 65535);
  EXPECT_EQ(pad.axis[kRightY], -1.0f);
  EXPECT_EQ(pad.hat, Hat::up_right);
  EXPECT_TRUE(pressed(pad, kButtonA));
}

TEST(SdlReports, ALeftStickIsThereWithAnyNumberOfAxes) {
  for (std::size_t axes = 2; axes <= 64; ++axes) {
    JoystickState state = resting(axes, 255, 4);
    const PadLayout layout = layout_of(state);
    ASSERT_TRUE(layout.is_pad) << axes;
    state.axes[0] = 32767;
    EXPECT_EQ(decoded(layout, state).axis[kLeftX], 1.0f) << axes;
  }
  EXPECT_FALSE(layout_of(resting(0, 1, 1)).is_pad) << "no stick";
}

// Six axes without a mapping: Linux's order of an Xbox pad, X Y Z Rx Ry Rz, triggers on Z and Rz.
TEST(SdlReports, SixAxesAreTwoSticksAndTwoTriggers) {
  JoystickState state = resting(6, 11, 1);
  const PadLayout layout = layout_of(state);
  state.axes = {0, 0, 32767, 32767, -32768, -32768};
  const PadState pad = decoded(layout, state);
  EXPECT_EQ(pad.axis[kLeftTrigger], 1.0f);
  EXPECT_EQ(pad.axis[kRightX], 1.0f);
  EXPECT_EQ(pad.axis[kRightY], 1.0f);
  EXPECT_EQ(pad.axis[kRightTrigger], 0.0f);
}

TEST(SdlReports, AHatHasEightDirectionsAndOppositeOnesAreNone) {
  JoystickState state = resting(2, 0, 1);
  const PadLayout layout = layout_of(state);
  constexpr std::pair<std::uint8_t, Hat> kDirections[] = {
      {0, Hat::released},   {1, Hat::up},       {3, Hat::up_right},   {2, Hat::right},
      {6, Hat::down_right}, {4, Hat::down},     {12, Hat::down_left}, {8, Hat::left},
      {9, Hat::up_left},    {5, Hat::released}, {15, Hat::released}};
  for (const auto& [mask, hat] : kDirections) {
    state.hats[0] = mask;
    EXPECT_EQ(decoded(layout, state).hat, hat) << int{mask};
  }
}

// Output of `cat /sys/class/input/event*/device/capabilities/{abs,key}`: xpad's ABS_X .. RZ and
// HAT0, keys A B X Y TL TR SELECT START MODE THUMBL THUMBR.
TEST(SdlReports, NumbersAreTheCodesThatTheNodeHas) {
  JoystickState counted = resting(6, 11, 1);
  const auto codes = node_codes("3003f\n", "7cdb000000000000 0 0 0 0\n", counted);
  ASSERT_TRUE(codes);
  EXPECT_EQ(codes->axes, (std::vector<std::uint16_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(codes->hats, (std::vector<std::uint16_t>{0x10}));
  EXPECT_EQ(codes->buttons, (std::vector<std::uint16_t>{0x130, 0x131, 0x133, 0x134, 0x136, 0x137,
                                                        0x13a, 0x13b, 0x13c, 0x13d, 0x13e}));
  // Bit 0 of the fifth word is 0x100: SDL numbers keys below 0x120 last.
  const auto low = node_codes("3", "1000000000001 0 0 0 0", resting(2, 2, 0));
  ASSERT_TRUE(low);
  EXPECT_EQ(low->buttons, (std::vector<std::uint16_t>{0x130, 0x100}));
  // Hats that SDL treats as axes.
  const auto analog = node_codes("30003", "0", resting(4, 0, 0));
  ASSERT_TRUE(analog);
  EXPECT_EQ(analog->axes, (std::vector<std::uint16_t>{0, 1, 0x10, 0x11}));
}

TEST(SdlReports, ANodeThatSdlCountsOtherwiseIsNotTrusted) {
  EXPECT_FALSE(node_codes("3003f", "0", resting(5, 0, 1)));
  EXPECT_FALSE(node_codes("3003f", "1", resting(6, 0, 1)));
  EXPECT_FALSE(node_codes("", "", resting(2, 0, 0)));
  EXPECT_FALSE(node_codes("no hexadecimal", std::string(5000, 'f'), resting(2, 0, 0)));
}

// X Y Z Rz Gas Brake: by these codes the right stick is the third and fourth axis.
TEST(SdlReports, AxesAreNamedByTheCodesOfTheNode) {
  JoystickState state = resting(6, 0, 0);
  state.axes = {0, 0, 32767, -32768, 32767, -32768};
  auto codes = node_codes("627", "0", state);
  ASSERT_TRUE(codes);
  EvdevLayout layout = joystick_layout(*codes, {});
  DeviceInfo device;
  device.driver = "sdl";
  device.descriptor = layout.descriptor;
  const auto pad = pad_layout(device, {});
  ASSERT_TRUE(pad);
  const JoystickReports reports(state, std::move(*codes), std::move(layout));
  Report report;
  reports.write(5, report);
  EXPECT_EQ(report.time_ns, 5);
  PadState decoded;
  ASSERT_TRUE(decode(*pad, report, decoded));
  EXPECT_EQ(decoded.axis[kRightX], 1.0f);
  EXPECT_EQ(decoded.axis[kRightY], 1.0f);
  EXPECT_EQ(decoded.axis[kRightTrigger], 1.0f);
  EXPECT_EQ(decoded.axis[kLeftTrigger], 0.0f);
}

TEST(SdlReports, AStateAllAtTheLowerEndIsNoneYet) {
  JoystickState state = resting(3, 1, 1);
  EXPECT_TRUE(joystick_reports(state, "", 0).is_known());
  state.axes = {-32768, -32768, -32768};
  EXPECT_FALSE(joystick_reports(state, "", 0).is_known());
  state.axes[1] = 0;
  EXPECT_TRUE(joystick_reports(state, "", 0).is_known());
}

TEST(SdlReports, ChangesAreOneReportButTheSecondOfAControlBeginsAnother) {
  JoystickReports reports = joystick_reports(resting(2, 2, 1), "", 0);
  reports.changes = {{1, Control::axis, 0, 100}, {2, Control::button, 1, 1},
                     {3, Control::axis, 0, 100},  // no change
                     {4, Control::axis, 1, 7},   {5, Control::button, 1, 0},
                     {6, Control::hat, 0, 1},    {7, Control::axis, 1, 8}};
  Report report;
  ASSERT_TRUE(reports.next(report));
  EXPECT_EQ(report.time_ns, 4);
  EXPECT_EQ(reports.state().axes, (std::vector<std::int16_t>{100, 7}));
  EXPECT_EQ(reports.state().buttons[1], 1);
  ASSERT_TRUE(reports.next(report));
  EXPECT_EQ(report.time_ns, 7);
  EXPECT_EQ(reports.state().axes[1], 8);
  EXPECT_EQ(reports.state().buttons[1], 0);
  EXPECT_EQ(reports.state().hats[0], 1);
  EXPECT_FALSE(reports.next(report));
}

TEST(SdlReports, ControlsThatTheJoystickDoesNotHaveAreSkipped) {
  JoystickReports reports = joystick_reports(resting(2, 2, 1), "", 0);
  reports.changes = {
      {1, Control::axis, 2, 1}, {1, Control::button, 255, 1}, {1, Control::hat, 9, 1}};
  Report report;
  EXPECT_FALSE(reports.next(report));
  EXPECT_TRUE(reports.changes.empty());
}

}  // namespace
}  // namespace gaitpad
