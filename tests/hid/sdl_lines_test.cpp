#include "hid/sdl_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// ---- Reading. The lines are rows of SDL's gamecontrollerdb or made in its form. Which field a
// number means was derived by hand: Linux's input-event-codes.h for the codes, SDL's order of them
// (keys from 0x120 on, then those below; axes by code without hats), hid-input for the codes of HID
// usages.

using Usages = std::vector<std::uint32_t>;

Usages buttons(std::uint16_t count) {
  Usages usages;
  for (std::uint16_t i = 1; i <= count; ++i) usages.push_back(usage_of(usage::kButtonPage, i));
  return usages;
}

// A pad whose report has one byte per axis (0..255), one byte per hat (0..7) and one bit per
// button.
class MadePad {
 public:
  MadePad(std::uint32_t application, Usages axes, int hats, Usages buttons)
      : axes_(std::move(axes)), hats_(hats), buttons_(std::move(buttons)) {
    std::vector<std::uint8_t>& d = device.descriptor;
    usage_item(application);
    add({0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 8, 0x95, 1});
    for (const std::uint32_t u : axes_) input(u, 0x02);
    add({0x25, 7, 0x35, 0, 0x46, 0x3b, 0x01, 0x65, 0x14});
    for (int i = 0; i < hats_; ++i) input(usage::kHatSwitch, 0x42);
    add({0x45, 0, 0x65, 0, 0x25, 1, 0x75, 1});
    for (const std::uint32_t u : buttons_) input(u, 0x02);
    const std::size_t left = (8 - buttons_.size() % 8) % 8;
    if (left != 0) add({0x95, static_cast<std::uint8_t>(left), 0x81, 0x03});
    d.push_back(0xc0);
    device.name = "made";
    rest();
  }
  void rest() {
    bytes_.assign(axes_.size(), 128);
    bytes_.insert(bytes_.end(), static_cast<std::size_t>(hats_), 8);
    bytes_.insert(bytes_.end(), (buttons_.size() + 7) / 8, 0);
  }
  void set_axis(std::size_t i, std::uint8_t value) { bytes_[i] = value; }
  void set_hat(std::size_t i, std::uint8_t value) { bytes_[axes_.size() + i] = value; }
  void press(std::size_t i) {
    bytes_[axes_.size() + static_cast<std::size_t>(hats_) + i / 8] |=
        static_cast<std::uint8_t>(1u << (i % 8));
  }
  PadState state(const PadOverrides& overrides = {}) const {
    PadState state;
    EXPECT_TRUE(decode(value_of(pad_layout(device, overrides)), report_of(bytes_), state));
    return state;
  }
  // The control that this button presses; "" for none.
  std::string name_of_button(std::size_t i) {
    rest();
    press(i);
    return names_of(state().buttons);
  }
  std::vector<std::string> names() {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < buttons_.size(); ++i) all.push_back(name_of_button(i));
    rest();
    return all;
  }
  // The pad's axis that moves to its high end with this field; -1: none.
  int axis_of(std::size_t i) {
    rest();
    const PadState before = state();
    set_axis(i, 255);
    const PadState after = state();
    rest();
    int found = -1;
    for (int a = 0; a < kAxisCount; ++a) {
      if (after.axis[a] != before.axis[a]) found = found < 0 ? a : kAxisCount;
    }
    return found;
  }

  DeviceInfo device;

 private:
  void add(std::initializer_list<std::uint8_t> bytes) {
    device.descriptor.insert(device.descriptor.end(), bytes);
  }
  void usage_item(std::uint32_t u) {
    device.descriptor.push_back(0x0b);
    for (int i = 0; i < 4; ++i)
      device.descriptor.push_back(static_cast<std::uint8_t>(u >> (8 * i)));
  }
  void input(std::uint32_t u, std::uint8_t flags) {
    usage_item(u);
    add({0x81, flags});
  }
  Usages axes_;
  int hats_ = 0;
  Usages buttons_;
  std::vector<std::uint8_t> bytes_;
};

// A pad with the axes and keys of an event node and one hat.
MadePad evdev_pad(const EvdevAbilities& node) {
  Usages axes, keys;
  for (const EvdevAxis& axis : node.axes) {
    if (axis.code >= evdev::kAbsHat0X) continue;
    axes.push_back(usage_of_code({EvdevType::absolute, axis.code}, usage::kGamePad));
  }
  for (const std::uint16_t code : node.keys)
    keys.push_back(usage_of_code({EvdevType::key, code}, usage::kGamePad));
  MadePad pad(usage::kGamePad, axes, 1, keys);
  pad.device.driver = "evdev";
  return pad;
}

const std::vector<EvdevAxis> kStick = {{0x00, 0, 255}, {0x01, 0, 255}};
const std::string kAnyGuid = "03000000000000000000000000000000,x,";
const std::string kHat = "dpdown:h0.4,dpleft:h0.8,dpright:h0.2,dpup:h0.1,";
using Names = std::vector<std::string>;

// 046d:c216, a HID joystick: buttons 1..12 are BTN_JOYSTICK .. 0x12b, X Y Z Rz are a0 .. a3.
TEST(SdlMapping, NumbersOfAHidPadAreItsButtonsAndAxesInOrder) {
  MadePad pad(usage::kJoystick, {usage::kX, usage::kY, usage::kZ, usage::kRz}, 1, buttons(12));
  pad.device.driver = "hidraw";
  pad.device.mapping =
      "030000006d04000016c2000010010000,Logitech Dual Action,a:b1,b:b2,back:b8," + kHat +
      "leftshoulder:b4,leftstick:b10,lefttrigger:b6,leftx:a0,lefty:a1,rightshoulder:b5,"
      "rightstick:b11,righttrigger:b7,rightx:a2,righty:a3,start:b9,x:b0,y:b3,platform:Linux";
  EXPECT_EQ(pad.names(), (Names{"x", "a", "b", "y", "leftshoulder", "rightshoulder", "", "", "back",
                                "start", "leftstick", "rightstick"}));
  EXPECT_EQ(pad.axis_of(0), kLeftX);
  EXPECT_EQ(pad.axis_of(1), kLeftY);
  EXPECT_EQ(pad.axis_of(2), kRightX);
  EXPECT_EQ(pad.axis_of(3), kRightY);
  pad.press(6);
  pad.set_axis(1, 0);
  pad.set_hat(0, 7);
  const PadState state = pad.state();
  EXPECT_EQ(state.axis[kLeftTrigger], 1.0f);
  EXPECT_EQ(state.axis[kRightTrigger], 0.0f);
  EXPECT_EQ(state.axis[kLeftY], 1.0f) << "HID's y grows towards the thumb's owner, ours away";
  EXPECT_EQ(state.hat, Hat::up_left);
}

// The names of a pad's buttons and axes, in their order.
struct PadRow {
  MadePad pad;
  std::string line;
  Names buttons;
  std::vector<int> axes;
};

TEST(SdlMapping, NumbersAreCountedByTheCodesThatANodeHasOrWouldHave) {
  PadRow kRows[] = {
      // The pads are wired differently: by usages alone the right stick would be Rx, Ry and button
      // 1 the left one. Codes X 0, Y 1, Z 2, Rx 3, Rz 5: a3 is Rx, which no control has, a4 is Rz.
      {MadePad(usage::kJoystick, {usage::kX, usage::kY, usage::kZ, usage::kRx, usage::kRz}, 1,
               buttons(12)),
       "03000000790000000600000010010000,Generic USB "
       "Joystick,x:b3,a:b2,b:b1,y:b0,back:b8,start:b9," +
           kHat +
           "leftshoulder:b4,rightshoulder:b5,lefttrigger:b6,righttrigger:b7,leftstick:b10,"
           "rightstick:b11,leftx:a0,lefty:a1,rightx:a4,righty:a2,platform:Linux,",
       {"y", "b", "a", "x", "leftshoulder", "rightshoulder", "", "", "back", "start", "leftstick",
        "rightstick"},
       {kLeftX, kLeftY, kRightY, -1, kRightX}},
      // xpad has the keys A B X Y TL TR SELECT START MODE THUMBL THUMBR; triggers are on Z and Rz.
      {evdev_pad(xpad_node()),
       "030000005e0400008e02000014010000,X360 Controller,a:b0,b:b1,back:b6," + kHat +
           "guide:b8,leftshoulder:b4,leftstick:b9,lefttrigger:a2,leftx:a0,lefty:a1,"
           "rightshoulder:b5,rightstick:b10,righttrigger:a5,rightx:a3,righty:a4,start:b7,x:b2,"
           "y:b3,platform:Linux",
       {"a", "b", "x", "y", "leftshoulder", "rightshoulder", "back", "start", "guide", "leftstick",
        "rightstick"},
       {kLeftX, kLeftY, kLeftTrigger, kRightX, kRightY, kRightTrigger}},
      // hid-playstation has the keys SOUTH EAST NORTH WEST TL TR TL2 TR2 SELECT START MODE THUMBL
      // THUMBR.
      {evdev_pad(playstation_node()),
       "030000004c050000e60c000011810000,PS5 Controller,a:b0,b:b1,back:b8," + kHat +
           "guide:b10,leftshoulder:b4,leftstick:b11,lefttrigger:a2,leftx:a0,lefty:a1,"
           "rightshoulder:b5,rightstick:b12,righttrigger:a5,rightx:a3,righty:a4,start:b9,x:b3,"
           "y:b2,platform:Linux",
       {"a", "b", "y", "x", "leftshoulder", "rightshoulder", "", "", "back", "start", "guide",
        "leftstick", "rightstick"},
       {kLeftX, kLeftY, kLeftTrigger, kRightX, kRightY, kRightTrigger}},
      // hid-nintendo: EAST is A on the right; capture is BTN_Z 0x135, before the shoulders; codes 3
      // and 4 are the third and the fourth axis.
      {evdev_pad(nintendo_node()),
       "030000007e0500000920000011810000,Nintendo Switch Pro Controller,a:b0,b:b1,back:b9," + kHat +
           "guide:b11,leftshoulder:b5,leftstick:b12,lefttrigger:b7,leftx:a0,lefty:a1,misc1:b4,"
           "rightshoulder:b6,rightstick:b13,righttrigger:b8,rightx:a2,righty:a3,start:b10,x:b3,"
           "y:b2,hint:!SDL_GAMECONTROLLER_USE_BUTTON_LABELS:=1,platform:Linux",
       {"a", "b", "y", "x", "misc1", "leftshoulder", "rightshoulder", "", "", "back", "start",
        "guide", "leftstick", "rightstick"},
       {kLeftX, kLeftY, kRightX, kRightY}},
  };
  for (PadRow& row : kRows) {
    if (row.pad.device.driver.empty()) row.pad.device.driver = "hidraw";
    row.pad.device.mapping = row.line;
    EXPECT_EQ(row.pad.names(), row.buttons) << row.line;
    for (std::size_t i = 0; i < row.axes.size(); ++i)
      EXPECT_EQ(row.pad.axis_of(i), row.axes[i]) << row.line;
  }
}

// 0x2c0 is BTN_TRIGGER_HAPPY1, 0x100 BTN_0: below BTN_JOYSTICK, so SDL counts it last.
TEST(SdlMapping, KeysBelowTheJoysticksOwnAreCountedLast) {
  MadePad pad = evdev_pad({kStick, {0x100, 0x130, 0x2c0}});
  pad.device.mapping = kAnyGuid + "a:b0,x:b1,y:b2,leftx:a0,lefty:a1,";
  EXPECT_EQ(pad.names(), (Names{"y", "a", "x"}));
}

// One interface contains the same joystick twice with different report ids: the second stick must
// not move the first.
TEST(SdlMapping, AnAdapterForTwoPadsIsReadAsItsFirst) {
  DeviceInfo adapter;
  for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}}) {
    const std::vector<std::uint8_t> joystick = {
        0x05, 0x01, 0x09, 0x04, 0xa1, 0x01, 0x85, id,   0x15, 0x00, 0x26, 0xff, 0x00,
        0x75, 0x08, 0x95, 0x02, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02, 0x05, 0x09, 0x19,
        0x01, 0x29, 0x08, 0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02, 0xc0};
    adapter.descriptor.insert(adapter.descriptor.end(), joystick.begin(), joystick.end());
  }
  adapter.mapping = kAnyGuid + "a:b0,b:b1,leftx:a0,lefty:a1,";
  const auto layout = pad_layout(adapter, {});
  ASSERT_TRUE(layout);
  PadState state;
  Report report;
  report.size = 4;
  report.bytes = {1, 255, 0, 1};
  EXPECT_TRUE(decode(*layout, report, state));
  report.bytes = {2, 0, 255, 2};
  EXPECT_TRUE(decode(*layout, report, state));
  EXPECT_FLOAT_EQ(state.axis[kLeftX], 1.0f);
  EXPECT_FLOAT_EQ(state.axis[kLeftY], 1.0f);
  EXPECT_TRUE(pressed(state, kButtonA));
  EXPECT_FALSE(pressed(state, kButtonB));
}

// The second hat of a node is stated as two axes of -1, 0, 1, but SDL's name for it is h1.
TEST(SdlMapping, AHatMayBeTwoAxes) {
  MadePad pad = evdev_pad({kStick, {0x130}});
  pad.device.mapping = kAnyGuid + "a:b0,leftx:a0,lefty:a1,x:h0.8,dpup:h1.1,";
  const EvdevAbilities abilities{
      {{0x00, 0, 255}, {0x01, 0, 255}, {0x10, -1, 1}, {0x11, -1, 1}, {0x12, -1, 1}, {0x13, -1, 1}},
      {0x130}};
  const EvdevLayout layout = evdev_layout(abilities, {});
  pad.device.descriptor = layout.descriptor;
  const auto pad_of = pad_layout(pad.device, {});
  ASSERT_TRUE(pad_of);
  const auto name_at = [&](std::int32_t hat0_x, std::int32_t hat1_y) {
    EvdevState node;
    node.axis[0x10] = hat0_x;
    node.axis[0x13] = hat1_y;
    Report report;
    put_state(layout, node, report);
    PadState state;
    EXPECT_TRUE(decode(*pad_of, report, state));
    return names_of(state.buttons);
  };
  EXPECT_EQ(name_at(0, 0), "");
  EXPECT_EQ(name_at(-1, 0), "x");
  EXPECT_EQ(name_at(1, 0), "");
  EXPECT_EQ(name_at(0, -1), "dpup");
  EXPECT_EQ(name_at(0, 1), "");
}

// Half of an axis is 0 up to its middle and 1 at its end. SDL presses a button from the middle of
// that half on.
TEST(SdlMapping, HalvesOfAnAxisAreTriggersAndButtons) {
  MadePad pad(usage::kGamePad, {usage::kX, usage::kY, usage::kZ}, 0, buttons(2));
  pad.device.driver = "sdl";
  pad.device.mapping = kAnyGuid + "dpdown:+a1,dpup:-a1,lefttrigger:+a2,righttrigger:-a2,";
  const auto at = [&pad](std::size_t axis, std::uint8_t value) {
    pad.rest();
    pad.set_axis(axis, value);
    return pad.state();
  };
  EXPECT_EQ(at(2, 128).axis[kLeftTrigger], 0.0f);
  EXPECT_EQ(at(2, 127).axis[kRightTrigger], 0.0f);
  EXPECT_EQ(at(2, 255).axis[kLeftTrigger], 1.0f);
  EXPECT_EQ(at(2, 255).axis[kRightTrigger], 0.0f);
  EXPECT_EQ(at(2, 0).axis[kRightTrigger], 1.0f);
  EXPECT_FLOAT_EQ(at(2, 128 + 64).axis[kLeftTrigger], 64.0f / 127.0f);
  EXPECT_FLOAT_EQ(at(2, 127 - 64).axis[kRightTrigger], 64.0f / 127.0f);
  EXPECT_EQ(at(1, 191).buttons, 0u);
  EXPECT_EQ(names_of(at(1, 192).buttons), "dpdown");
  EXPECT_EQ(at(1, 64).buttons, 0u);
  EXPECT_EQ(names_of(at(1, 63).buttons), "dpup");
}

TEST(SdlMapping, APadWithoutAnyLeftStickInTheLineStillWalksByItsAxes) {
  MadePad pad(usage::kGamePad, {usage::kX, usage::kY}, 0, buttons(8));
  pad.device.driver = "hidraw";
  pad.device.mapping =
      "030000003512000012ab000010010000,NES30,a:b1,b:b0,dpdown:+a1,dpleft:-a0,dpright:+a0,dpup:-"
      "a1,";
  pad.set_axis(1, 0);
  const PadState state = pad.state();
  EXPECT_EQ(state.axis[kLeftY], 1.0f);
  EXPECT_EQ(names_of(state.buttons), "dpup");
}

TEST(SdlMapping, AxesMayBeTurnedRoundAndSticksMadeOfButtonsAndHats) {
  MadePad pad(usage::kGamePad, {usage::kX, usage::kY, usage::kZ}, 1, buttons(4));
  pad.device.driver = "sdl";
  pad.device.mapping = kAnyGuid +
                       "leftx:a0~,lefty:a1~,lefttrigger:a2~,-rightx:h0.8,"
                       "+rightx:h0.2,-righty:b0,+righty:b1,";
  pad.set_axis(0, 255);
  pad.set_axis(1, 255);
  pad.set_axis(2, 255);
  pad.set_hat(0, 6);
  pad.press(0);
  PadState state = pad.state();
  EXPECT_EQ(state.axis[kLeftX], -1.0f);
  EXPECT_EQ(state.axis[kLeftY], 1.0f);
  EXPECT_EQ(state.axis[kLeftTrigger], 0.0f);
  EXPECT_EQ(state.axis[kRightX], -1.0f);
  EXPECT_EQ(state.axis[kRightY], 1.0f) << "SDL's negative y is up, ours forward is positive";
  pad.set_hat(0, 2);
  pad.press(1);
  state = pad.state();
  EXPECT_EQ(state.axis[kRightX], 1.0f);
  EXPECT_EQ(state.axis[kRightY], 0.0f) << "both sides at once";
  pad.rest();
  state = pad.state();
  EXPECT_EQ(state.axis[kRightX], 0.0f);
  EXPECT_EQ(state.axis[kRightY], 0.0f);
}

TEST(SdlMapping, AFileThatNamesControlsGoesBeforeIt) {
  MadePad pad(usage::kGamePad, {usage::kX, usage::kY}, 0, buttons(4));
  pad.device.mapping = kAnyGuid + "y:b0,leftx:a0,lefty:a1,";
  const auto name_with = [&pad](const std::string& toml) {
    const auto overrides = parse_pad_file(toml, "map.toml");
    EXPECT_TRUE(overrides);
    pad.rest();
    pad.press(0);
    return names_of(pad.state(*overrides).buttons);
  };
  EXPECT_EQ(name_with("[[pad]]\n[pad.buttons]\nb = \"button 1\"\n"), "b");
  EXPECT_EQ(name_with("[[pad]]\n[pad.buttons]\nguide = \"button 2\"\n"), "x")
      << "an entry wins wholly";
  EXPECT_EQ(name_with("[[pad]]\nbutton_order = \"android\"\n"), "a");
  EXPECT_EQ(name_with("[[pad]]\nstreams = true\n"), "y") << "it says nothing of controls";
  EXPECT_EQ(name_with("[[pad]]\nvendor = 1\n"), "y") << "another pad's";
}

TEST(SdlMapping, ADamagedLineIsNamedAndDoesNotCount) {
  MadePad pad(usage::kGamePad, {usage::kX, usage::kY}, 0, buttons(4));
  const auto descriptor = parse_descriptor(pad.device.descriptor);
  ASSERT_TRUE(descriptor);
  const auto cause = [&](const std::string& line) {
    return cause_of(sdl_controls(line, *descriptor, "hidraw"));
  };
  EXPECT_EQ(cause(kAnyGuid + "a:q3,"), "SDL mapping: unknown source \"q3\"");
  EXPECT_EQ(cause(kAnyGuid + "a:b,"), "SDL mapping: unknown source \"b\"");
  EXPECT_EQ(cause(kAnyGuid + "dpup:h0,"), "SDL mapping: unknown source \"h0\"");
  EXPECT_EQ(cause(kAnyGuid + "dpup:h0.16,"), "SDL mapping: unknown source \"h0.16\"");
  EXPECT_EQ(cause(kAnyGuid + "dpup:h0.0,"), "SDL mapping: unknown source \"h0.0\"");
  EXPECT_EQ(cause(kAnyGuid + "a:b99999999999999999999,"),
            "SDL mapping: unknown source \"b99999999999999999999\"");
  EXPECT_EQ(cause(kAnyGuid + "rubbish"), "SDL mapping: \"rubbish\" is no pair control:source");
  EXPECT_EQ(cause("xinput,x,a:b0"), "SDL mapping: \"xinput\" is no GUID of 32 hexadecimal digits");
  EXPECT_EQ(cause(""), "SDL mapping: \"\" is no GUID of 32 hexadecimal digits");
  EXPECT_EQ(cause(std::string(600, 'a')), "SDL mapping: 600 bytes, at most 512 are read");
  std::string many = kAnyGuid;
  for (int i = 0; i < 9; ++i) many += "a:b0,";
  EXPECT_EQ(cause(many), "SDL mapping: more than 8 sources for \"a\"");
  EXPECT_EQ(cause(kAnyGuid + "a:b0,sdk>=:16,crc:1234,face:b9,type:z,rightx:,,platform:Linux,"),
            "accepted");
  EXPECT_EQ(cause(kAnyGuid + "a:b700,leftx:a31,dpup:h7.1,"), "accepted")
      << "numbers that the device does not have";
  pad.device.mapping = kAnyGuid + "y:b0,a:q3,";
  EXPECT_EQ(pad.name_of_button(0), "x") << "as without a line";
}

TEST(SdlMapping, HostileLinesDoNoHarm) {
  MadePad pad(usage::kGamePad, {usage::kX, usage::kY, usage::kHatSwitch}, 2, buttons(20));
  std::mt19937 random(1);
  constexpr std::string_view kAlphabet = "0123456789abh+-~.:,leftxlefty\x01\xff";
  for (int i = 0; i < 5000; ++i) {
    std::string line = kAnyGuid;
    const std::size_t length = random() % 80;
    for (std::size_t k = 0; k < length; ++k) line += kAlphabet[random() % kAlphabet.size()];
    pad.device.mapping = line;
    pad.device.driver = i % 2 == 0 ? "sdl" : "hidraw";
    const std::size_t axis = random() % 3;
    pad.set_axis(axis, static_cast<std::uint8_t>(random()));
    for (const float value : pad.state().axis) EXPECT_LE(std::abs(value), 1.0f);
  }
}

// The driver sdl of version 0.2 stated the event node that SDL reads. Such a recording brings its
// descriptor and its line of the data base: here a Switch Pro Controller in the rig.
TEST(SdlMapping, ARecordingOfTheFormerSdlDriverIsReadAsItWas) {
  const std::string text =
      "R: 124 05 01 09 05 a1 01 05 01 09 30 16 00 80 26 ff 7f 75 10 95 01 81 02 05 01 09 "
      "31 16 00 80 26 ff 7f 75 10 95 01 81 02 05 01 09 33 16 00 80 26 ff 7f 75 10 95 01 81 "
      "02 05 01 09 34 16 00 80 26 ff 7f 75 10 95 01 81 02 05 01 09 39 15 00 25 07 35 00 46 "
      "3b 01 75 04 95 01 81 42 45 00 75 04 95 01 81 03 15 00 25 01 05 09 19 01 29 02 19 04 "
      "29 0f 75 01 95 0e 81 02 75 02 95 01 81 03 c0\n"
      "N: Nintendo Switch Pro Controller\n"
      "I: 3 057e 2009\n"
      "B: sdl 8111\n"
      "M: 030000007e0500000920000011810000,Nintendo Switch Pro Controller,a:b0,b:b1,"
      "back:b9,dpdown:h0.4,dpleft:h0.8,dpright:h0.2,dpup:h0.1,guide:b11,leftshoulder:b5,"
      "leftstick:b12,lefttrigger:b7,leftx:a0,lefty:a1,misc1:b4,rightshoulder:b6,"
      "rightstick:b13,righttrigger:b8,rightx:a2,righty:a3,start:b10,x:b3,y:b2,"
      "hint:!SDL_GAMECONTROLLER_USE_BUTTON_LABELS:=1,\n"
      "E: 000000.139410 11 ff 5f aa 2d ab a8 55 da 08 00 00\n"
      "E: 000000.509746 11 00 00 ff 7f 00 00 00 00 08 00 00\n"
      "E: 000000.996556 11 00 00 00 00 00 00 00 00 08 02 00\n";
  const Trace trace = value_of(parse_trace(text, "old.hid"));
  const PadLayout layout = value_of(pad_layout(trace.devices.at(0).info, shipped_pads()));
  std::vector<PadState> states(3);
  for (std::size_t i = 0; i < states.size(); ++i)
    ASSERT_TRUE(decode(layout, report_of(trace, trace.events.at(i)), states[i]));
  EXPECT_FLOAT_EQ(states[0].axis[kLeftX], (2.0f * 0x5fff + 1) / 65535);
  EXPECT_FLOAT_EQ(states[0].axis[kRightX], (2.0f * (0xa8ab - 0x10000) + 1) / 65535);
  EXPECT_EQ(states[1].axis[kLeftY], -1.0f) << "towards the player";
  EXPECT_EQ(names_of(states[2].buttons), "b");
}

// ---- Writing. A written line must agree with SDL's data base on the same pads (lines made by
// other people on other machines) and with what the reader reads back.

struct KnownPad {
  std::string path;
  DeviceInfo device;
  PadLayout layout;
};

std::vector<KnownPad> known_pads() {
  const PadOverrides overrides = shipped_pads();
  std::vector<KnownPad> pads;
  for (const std::string& folder : {kGoldenPads, kPadRecordings}) {
    for (const std::string& path : files_in(folder, ".hid")) {
      const auto trace = read_trace(path);
      if (!trace || trace->devices.size() != 1) continue;
      auto layout = pad_layout(trace->devices[0].info, overrides);
      // A pad whose descriptor has only vendor data has no numbers.
      if (!layout || !layout->is_pad || !pad_application(layout->descriptor)) continue;
      pads.push_back({path, trace->devices[0].info, std::move(*layout)});
    }
  }
  return pads;
}

// Controls by name, and the sources of each.
using Controls = std::map<std::string, std::set<std::string>>;
Controls controls_of(const std::string& line) {
  Controls controls;
  std::istringstream parts(line);
  std::string part;
  for (int i = 0; std::getline(parts, part, ','); ++i) {
    const std::size_t colon = part.find(':');
    if (i >= 2 && colon != std::string::npos) {
      controls[part.substr(0, colon)].insert(part.substr(colon + 1));
    }
  }
  controls.erase("platform");
  return controls;
}

Report random_report(const ReportLayout& layout, std::mt19937& random) {
  Report report;
  report.size = layout.min_size;
  for (std::size_t i = 0; i < report.size; ++i) {
    report.bytes[i] = static_cast<std::uint8_t>(random());
  }
  if (layout.numbered) report.bytes[0] = layout.report_id;
  return report;
}

// The buttons that a line names.
std::uint32_t buttons_in(const Controls& controls) {
  std::uint32_t buttons = 0;
  for (int b = 0; b < kButtonCount; ++b) {
    if (controls.count(std::string(kButtonNames[b]))) buttons |= 1u << b;
  }
  return buttons;
}

void expect_same_reading(const KnownPad& pad, const std::string& line) {
  DeviceInfo mapped = pad.device;
  mapped.mapping = line;
  const auto layout = pad_layout(mapped, {});
  ASSERT_TRUE(layout);
  const Controls controls = controls_of(line);
  std::mt19937 random(7);
  PadState own, read_back;
  for (int i = 0; i < 300; ++i) {
    for (const ReportLayout& r : pad.layout.reports) {
      const Report report = random_report(r, random);
      // The kernel reads a report whose descriptor is replaced differently.
      if (!layout_of(pad.layout, report)->exact_sizes.empty()) continue;
      ASSERT_TRUE(decode(pad.layout, report, own));
      ASSERT_TRUE(decode(*layout, report, read_back));
      for (int a = 0; a < kAxisCount; ++a) {
        constexpr std::array<const char*, kAxisCount> kNames = {
            "leftx", "lefty", "rightx", "righty", "lefttrigger", "righttrigger"};
        if (!controls.count(kNames[a])) continue;
        ASSERT_EQ(own.axis[a], read_back.axis[a]) << kNames[a];
      }
      ASSERT_EQ(own.buttons & buttons_in(controls), read_back.buttons & buttons_in(controls));
    }
  }
}

TEST(SdlMappingWrite, WhatIsWrittenReadsBackToTheSameControlsOfEveryKnownPad) {
  int pads = 0;
  for (const KnownPad& pad : known_pads()) {
    SCOPED_TRACE(pad.path);
    const auto line = sdl_mapping_text(pad.device, pad.layout);
    ASSERT_TRUE(line) << line.error().message;
    EXPECT_LE(line->size(), kMaxTraceTextBytes);
    const Controls controls = controls_of(*line);
    EXPECT_TRUE(controls.count("leftx") && controls.count("lefty"));
    EXPECT_GE(controls.size(), 8u);
    expect_same_reading(pad, *line);
    ++pads;
  }
  EXPECT_GE(pads, 12);
}

// Mappings of the data base for the same bus and ids without the kernel's mark in the version:
// these number the pad's own controls, like the recordings here.
std::vector<Controls> data_base_lines(const std::string& guid) {
  std::vector<Controls> lines;
  std::ifstream file(kPadRecordings + "gamecontrollerdb.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.find("platform:Linux") == std::string::npos || line.size() < 32) continue;
    if (line.compare(0, 20, guid, 0, 20) != 0 || line.compare(28, 4, "0000") != 0) continue;
    if (std::stoi(line.substr(26, 2), nullptr, 16) < 0x80) lines.push_back(controls_of(line));
  }
  return lines;
}

bool agrees(const Controls& mine, const Controls& theirs) {
  for (const char* key : {"leftx", "lefty", "rightx", "righty", "a", "b", "x", "y", "start",
                          "leftshoulder", "rightshoulder", "dpup", "dpleft"}) {
    const auto a = mine.find(key), b = theirs.find(key);
    if ((a == mine.end()) != (b == theirs.end())) return false;
    if (a != mine.end() && a->second != b->second) return false;
  }
  return true;
}

TEST(SdlMappingWrite, AxesAndButtonsAreThoseOfSdlsDataBase) {
  if (!std::filesystem::exists(kPadRecordings + "gamecontrollerdb.txt")) {
    GTEST_SKIP() << "no data base at " << kPadRecordings;
  }
  std::set<std::string> agreed;
  for (const KnownPad& pad : known_pads()) {
    const auto line = sdl_mapping_text(pad.device, pad.layout);
    ASSERT_TRUE(line);
    const auto lines = data_base_lines(line->substr(0, 32));
    const Controls mine = controls_of(*line);
    const bool is_known =
        std::any_of(lines.begin(), lines.end(), [&](const Controls& c) { return agrees(mine, c); });
    if (is_known) agreed.insert(line->substr(8, 4) + line->substr(16, 4));
    // The data base's only mapping of this pad lacks the sticks, which the pad's descriptor has.
    const bool is_pokken = pad.device.vendor == 0x0f0d && pad.device.product == 0x0092;
    EXPECT_TRUE(is_known || is_pokken || lines.empty()) << pad.path << "\n" << *line;
  }
  // Vendor and product, least significant byte first: DualShock 4, DualSense, Edge, Dual Action and
  // F310, PlayStation Classic, DualShock 3, Xbox One S, Elite 2 and Series on Bluetooth.
  for (const char* ids : {"4c05cc09", "4c05e60c", "4c05f20d", "6d0416c2", "4c05da0c", "4c056802",
                          "5e04fd02", "5e04050b", "5e04130b"}) {
    EXPECT_TRUE(agreed.count(ids)) << ids;
  }
}

// The event node of a DualSense under hid-playstation.
KnownPad dualsense_node() {
  KnownPad pad;
  pad.device.bus = BusType::usb;
  pad.device.vendor = 0x054c;
  pad.device.product = 0x0ce6;
  pad.device.version = 0x8111;
  pad.device.driver = "evdev";
  pad.device.name = "PS5 Controller";
  pad.device.descriptor = evdev_layout(playstation_node(), {}).descriptor;
  pad.layout = value_of(pad_layout(pad.device, shipped_pads()));
  return pad;
}

// The expected line is the data base's own, `030000004c050000e60c000011810000,PS5 Controller,...`.
TEST(SdlMappingWrite, AnEventNodeUnderItsKernelDriverGivesTheLineOfTheDataBase) {
  const KnownPad pad = dualsense_node();
  const auto line = sdl_mapping_text(pad.device, pad.layout);
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(*line,
            "030000004c050000e60c000011810000,PS5 Controller,a:b0,b:b1,back:b8,dpdown:h0.4,"
            "dpleft:h0.8,dpright:h0.2,dpup:h0.1,guide:b10,leftshoulder:b4,leftstick:b11,"
            "lefttrigger:a2,leftx:a0,lefty:a1,rightshoulder:b5,rightstick:b12,righttrigger:a5,"
            "rightx:a3,righty:a4,start:b9,x:b3,y:b2,platform:Linux,");
}

TEST(SdlMappingWrite, TurnedSticksAreWrittenAsTheyLie) {
  const KnownPad pad = dualsense_node();
  StickAxes sticks = kAxesAsLaidOut;
  sticks[kLeftX] = {kLeftX, true};     // the stick's right is where the layout's x falls
  sticks[kRightX] = {kRightY, false};  // the stick's right is where the layout says forward
  sticks[kRightY] = {kRightX, true};   // the stick's forward is where the layout says left
  const auto line = sdl_mapping_text(pad.device, pad.layout, sticks);
  ASSERT_TRUE(line);
  const Controls controls = controls_of(*line);
  EXPECT_EQ(controls.at("leftx"), std::set<std::string>{"a0~"});
  EXPECT_EQ(controls.at("lefty"), std::set<std::string>{"a1"});
  // ABS_RY grows backwards, so "forward" is its low end, and right falls with it.
  EXPECT_EQ(controls.at("rightx"), std::set<std::string>{"a4~"});
  // SDL's righty grows backwards, as this pad's x does here.
  EXPECT_EQ(controls.at("righty"), std::set<std::string>{"a3"});

  DeviceInfo mapped = pad.device;
  mapped.mapping = *line;
  const auto turned = pad_layout(mapped, {});
  ASSERT_TRUE(turned);
  std::mt19937 random(3);
  PadState before, after;
  for (int i = 0; i < 200; ++i) {
    const Report report = random_report(pad.layout.reports[0], random);
    ASSERT_TRUE(decode(pad.layout, report, before));
    ASSERT_TRUE(decode(*turned, report, after));
    EXPECT_EQ(after.axis[kLeftX], 0.0f - before.axis[kLeftX]);
    EXPECT_EQ(after.axis[kLeftY], before.axis[kLeftY]);
    EXPECT_EQ(after.axis[kRightX], before.axis[kRightY]);
    EXPECT_EQ(after.axis[kRightY], 0.0f - before.axis[kRightX]);
  }
}

// Writes, reads and writes every form of a mapping again.
TEST(SdlMappingWrite, HalvesSidesAndHatsComeBackAsTheyWere) {
  KnownPad pad = dualsense_node();
  const std::string line =
      "030000004c050000e60c000011810000,PS5 "
      "Controller,a:+a5,b:-a5,back:h0.2,dpdown:+a1,dpleft:-a0,lefttrigger:+a2,+leftx:b0,-leftx:b1,"
      "+lefty:h0.4,-lefty:h0.1,righttrigger:-a2,rightx:a3~,righty:b5,x:b3,y:b2,platform:Linux,";
  pad.device.mapping = line;
  auto layout = pad_layout(pad.device, {});
  ASSERT_TRUE(layout);
  const auto written = sdl_mapping_text(pad.device, *layout);
  ASSERT_TRUE(written);
  EXPECT_EQ(controls_of(*written), controls_of(line));
}

TEST(SdlMappingWrite, ANameCannotBreakTheLine) {
  KnownPad pad = dualsense_node();
  pad.device.name = "Stick, or\npad: " + std::string(600, 'x') + "\xc3\xa4";
  const auto line = sdl_mapping_text(pad.device, pad.layout);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->size(), kMaxTraceTextBytes);
  EXPECT_EQ(line->find("Stick  or pad: x"), 33u);
  EXPECT_TRUE(sdl_controls(*line, pad.layout.descriptor, "evdev"));
  EXPECT_EQ(controls_of(*line).size(), 21u);
}

// The GUID in SDL 2.26: bus, checksum 0, then the name if there are no ids.
TEST(SdlMappingWrite, APadWithoutIdsIsKnownByItsName) {
  KnownPad pad = dualsense_node();
  pad.device.vendor = pad.device.product = 0;
  pad.device.name = "Twelve and more";
  const auto line = sdl_mapping_text(pad.device, pad.layout);
  ASSERT_TRUE(line);
  EXPECT_EQ(line->substr(0, 32),
            "03000000"
            "5477656c766520616e642000");
}

TEST(SdlMappingWrite, WhatTheKernelsOwnDriverNumbersIsNotGuessed) {
  KnownPad pad = dualsense_node();
  pad.device.driver = "hidraw";
  const auto line = sdl_mapping_text(pad.device, pad.layout);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().message,
            "PS5 Controller: a kernel driver of its own numbers its controls; give its event node "
            "(/dev/input/event...)");
  pad.device.version = 0x0111;
  EXPECT_TRUE(sdl_mapping_text(pad.device, pad.layout));
  pad.device.driver = "sdl";
  EXPECT_EQ(
      sdl_mapping_text(pad.device, pad.layout).error().message,
      "PS5 Controller: SDL names its controls and does not tell their numbers; give its event "
      "node (/dev/input/event...)");
}

// ---- Choosing a line

constexpr const char* kDataBase =
    "# Game Controller DB\r\n"
    "03000000091200000100000010010000,By position,a:b0,b:b1,hint:!SDL_GAMECONTROLLER_USE_BUTTON_"
    "LABELS:=1,platform:Linux,\r\n"
    "03000000091200000100000010010000,By "
    "label,a:b1,b:b0,hint:SDL_GAMECONTROLLER_USE_BUTTON_LABELS:="
    "1,platform:Linux,\r\n"
    "03000000091200000100000011810000,The kernel's,a:b4,platform:Linux,\n"
    "03000000091200000200000010010000,Of one name,a:b5,crc:9f49,platform:Linux,\n"
    "03000000091200000200000000000000,Other version,a:b6,platform:Linux,\n"
    "03000000091200000300000000006800,SDL's own driver,a:b7,platform:Linux,\n"
    "03000000091200000400000010010000,Windows,a:b8,platform:Windows,\n"
    "05000000091200000400000010010000,Bluetooth,a:b9,platform:Linux,\n"
    "no line at all\n";

DeviceInfo pad_of(std::uint16_t product, std::uint16_t version, BusType bus = BusType::usb) {
  DeviceInfo info;
  info.bus = bus;
  info.vendor = 0x1209;
  info.product = product;
  info.version = version;
  info.name = "Example Walk Pad";
  info.driver = "evdev";
  return info;
}

std::string name_in(const std::string& line) {
  const std::size_t comma = line.find(',');
  return comma == std::string::npos ? line
                                    : line.substr(comma + 1, line.find(',', comma + 1) - comma - 1);
}

TEST(SdlDataBase, ALineIsChosenAsSdlChoosesIt) {
  const auto lines = mapping_lines(kDataBase);
  EXPECT_EQ(lines.size(), 7u) << "comments, Windows and junk are left out";
  const auto chosen = [&lines](const DeviceInfo& info) {
    return name_in(fitting_mapping(lines, info));
  };
  EXPECT_EQ(chosen(pad_of(1, 0x0110)), "By position");
  EXPECT_EQ(chosen(pad_of(1, 0x0200)), "By position") << "of another version";
  EXPECT_EQ(chosen(pad_of(1, 0x8111)), "The kernel's");
  EXPECT_EQ(chosen(pad_of(2, 0x0110)), "Of one name");
  DeviceInfo other = pad_of(2, 0x0110);
  other.name = "Another";
  EXPECT_EQ(chosen(other), "Other version");
  EXPECT_EQ(chosen(pad_of(3, 0)), "");
  EXPECT_EQ(chosen(pad_of(4, 0x0110)), "");
  EXPECT_EQ(chosen(pad_of(4, 0x0110, BusType::bluetooth)), "Bluetooth");
  DeviceInfo raw = pad_of(1, 0x8111);
  raw.driver = "hidraw";
  EXPECT_EQ(chosen(raw), "By position") << "the pad's own controls, not the kernel's";
}

TEST(SdlDataBase, AnImportReplacesLinesOfTheSamePadAlone) {
  const std::vector<std::string> own = {std::string(31, '0') + "1,mine",
                                        std::string(31, '0') + "2,mine"};
  const std::vector<std::string> given = {std::string(31, '0') + "2,given"};
  EXPECT_EQ(merged_mappings(given, own), (std::vector<std::string>{given[0], own[0]}));
}

}  // namespace
}  // namespace gaitpad
