// Codes are those of Linux's include/uapi/linux/input-event-codes.h, the rules those of
// drivers/hid/hid-input.c (6.1); both are written out here as numbers.
#include "hid/evdev_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

// ---- Codes of HID usages

ReportDescriptor parsed(const std::vector<std::uint8_t>& bytes) {
  return value_of(parse_descriptor(bytes));
}

// A descriptor: an application collection with X, Y (bytes) and what `items` state.
std::vector<std::uint8_t> pad_with(std::uint8_t application, std::vector<std::uint8_t> items) {
  std::vector<std::uint8_t> bytes = {0x05, 0x01, 0x09, application, 0xa1, 0x01, 0x15,
                                     0x00, 0x26, 0xff, 0x00,        0x75, 0x08, 0x95,
                                     0x02, 0x09, 0x30, 0x09,        0x31, 0x81, 0x02};
  for (const std::uint8_t item : items) bytes.push_back(item);
  bytes.push_back(0xc0);
  return bytes;
}

// The code of each usage except X and Y; -1: none. A repeated usage has the suffix `.2`.
std::map<std::string, int> codes_of(std::uint8_t application,
                                    const std::vector<std::uint8_t>& items) {
  const ReportDescriptor d = parsed(pad_with(application, items));
  const auto codes = evdev_codes(d);
  EXPECT_EQ(codes.size(), d.fields.size());
  std::map<std::string, int> result;
  for (std::size_t i = 2; i < codes.size(); ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "%x:%x", page_of(d.fields[i].usage), id_of(d.fields[i].usage));
    std::string key = name;
    if (result.count(key)) key += ".2";
    result[key] = codes[i] ? codes[i]->code : -1;
  }
  return result;
}
using Map = std::map<std::string, int>;

constexpr std::uint8_t kJoystick = 0x04, kGamePad = 0x05, kMultiAxis = 0x08;
const std::vector<std::uint8_t> kEighteenButtons = {0x05, 0x09, 0x19, 0x01, 0x29, 0x12, 0x25,
                                                    0x01, 0x75, 0x01, 0x95, 0x12, 0x81, 0x02};

// Buttons start at BTN_GAMEPAD, BTN_JOYSTICK or BTN_MISC; from the 17th on, those of a pad or
// joystick are BTN_TRIGGER_HAPPY.
TEST(EvdevCodes, ButtonsBeginWhereTheirApplicationSays) {
  const auto codes = [](std::uint8_t application) {
    const Map all = codes_of(application, kEighteenButtons);
    return std::vector<int>{all.at("9:1"), all.at("9:10"), all.at("9:11"), all.at("9:12")};
  };
  EXPECT_EQ(codes(kGamePad), (std::vector<int>{0x130, 0x13f, 0x2c0, 0x2c1}));
  EXPECT_EQ(codes(kJoystick), (std::vector<int>{0x120, 0x12f, 0x2c0, 0x2c1}));
  EXPECT_EQ(codes(kMultiAxis), (std::vector<int>{0x100, 0x10f, 0x110, 0x111}));
}

TEST(EvdevCodes, AxesAndSimulationControls) {
  // Z, Rz, Rx, Ry, slider, dial, wheel; accelerator, brake
  EXPECT_EQ(codes_of(kGamePad, {0x09, 0x32, 0x09, 0x35, 0x09, 0x33, 0x09, 0x34, 0x09, 0x36,
                                0x09, 0x37, 0x09, 0x38, 0x95, 0x07, 0x81, 0x02, 0x05, 0x02,
                                0x09, 0xc4, 0x09, 0xc5, 0x95, 0x02, 0x81, 0x02}),
            (Map{{"1:32", 2},
                 {"1:35", 5},
                 {"1:33", 3},
                 {"1:34", 4},
                 {"1:36", 6},
                 {"1:37", 7},
                 {"1:38", 8},
                 {"2:c4", 9},
                 {"2:c5", 10}}));
  // rudder, throttle, an aileron that hid-input leaves out
  EXPECT_EQ(
      codes_of(kJoystick, {0x05, 0x02, 0x09, 0xba, 0x09, 0xbb, 0x09, 0xb0, 0x95, 0x03, 0x81, 0x02}),
      (Map{{"2:ba", 7}, {"2:bb", 6}, {"2:b0", -1}}));
}

TEST(EvdevCodes, ACodeThatIsTakenIsGivenToNoOther) {
  // a slider and a throttle both want ABS_THROTTLE, two sliders as well
  EXPECT_EQ(codes_of(kJoystick, {0x09, 0x36, 0x09, 0x36, 0x95, 0x02, 0x81, 0x02, 0x05, 0x02, 0x09,
                                 0xbb, 0x95, 0x01, 0x81, 0x02}),
            (Map{{"1:36", 6}, {"1:36.2", -1}, {"2:bb", -1}}));
  // in Z Z Rz, stated by DragonRise's pads, the Z next to Rz gets ABS_Z
  EXPECT_EQ(codes_of(kJoystick, {0x09, 0x32, 0x09, 0x32, 0x09, 0x35, 0x95, 0x03, 0x81, 0x02}),
            (Map{{"1:32", -1}, {"1:32.2", 2}, {"1:35", 5}}));
}

TEST(EvdevCodes, AHatAndDpadUsagesAreAPairAndASecondHatHasNone) {
  EXPECT_EQ(
      codes_of(kGamePad, {0x09, 0x39, 0x09, 0x39, 0x25, 0x07, 0x75, 0x04, 0x95, 0x02, 0x81, 0x42}),
      (Map{{"1:39", 0x10}, {"1:39.2", -1}}));
  EXPECT_EQ(
      codes_of(kGamePad, {0x19, 0x90, 0x29, 0x93, 0x25, 0x01, 0x75, 0x01, 0x95, 0x04, 0x81, 0x02}),
      (Map{{"1:90", 0x10}, {"1:91", 0x10}, {"1:92", 0x10}, {"1:93", 0x10}}));
}

TEST(EvdevCodes, SystemAndConsumerKeys) {
  EXPECT_EQ(codes_of(kGamePad, {0x09, 0x85, 0x09, 0x3d, 0x09, 0x3e, 0x05, 0x0c, 0x0a, 0xb2,
                                0x00, 0x0a, 0x23, 0x02, 0x0a, 0x24, 0x02, 0x0a, 0x81, 0x00,
                                0x25, 0x01, 0x75, 0x01, 0x95, 0x07, 0x81, 0x02}),
            (Map{{"1:85", 139},     // KEY_MENU
                 {"1:3d", 0x13b},   // BTN_START
                 {"1:3e", 0x13a},   // BTN_SELECT
                 {"c:b2", 167},     // KEY_RECORD
                 {"c:223", 172},    // KEY_HOMEPAGE
                 {"c:224", 158},    // KEY_BACK
                 {"c:81", 240}}));  // KEY_UNKNOWN
}

TEST(EvdevCodes, VendorPagesAreLeftOutOrMiscellaneous) {
  // ff00 is Microsoft's and ignored; ff02 is unknown: BTN_MISC if it has one bit, otherwise
  // ABS_MISC
  EXPECT_EQ(codes_of(kGamePad, {0x06, 0x00, 0xff, 0x09, 0x20, 0x95, 0x01, 0x81, 0x02, 0x06, 0x02,
                                0xff, 0x09, 0x21, 0x81, 0x02, 0x09, 0x22, 0x75, 0x01, 0x81, 0x02}),
            (Map{{"ff00:20", -1}, {"ff02:21", 0x28}, {"ff02:22", 0x100}}));
}

TEST(EvdevCodes, RelativeFieldsAndOtherApplicationsHaveNone) {
  EXPECT_EQ(codes_of(kGamePad, {0x09, 0x32, 0x95, 0x01, 0x81, 0x06}), (Map{{"1:32", -1}}));
  auto bytes = pad_with(kGamePad, {});
  bytes.insert(bytes.begin() + 6, {0x85, 0x01});
  // a mouse in a report of its own, then a home key beside the pad
  for (const std::uint8_t b : {0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0x85, 0x02, 0x05, 0x09, 0x09,
                               0x01, 0x95, 0x01, 0x81, 0x02, 0xc0, 0x05, 0x0c, 0x09, 0x01, 0xa1,
                               0x01, 0x85, 0x03, 0x0a, 0x23, 0x02, 0x81, 0x02, 0xc0}) {
    bytes.push_back(b);
  }
  const auto codes = evdev_codes(parsed(bytes));
  ASSERT_EQ(codes.size(), 4u);
  EXPECT_EQ(codes[0], (EvdevCode{EvdevType::absolute, 0}));
  EXPECT_EQ(codes[2], std::nullopt);
  EXPECT_EQ(codes[3], (EvdevCode{EvdevType::key, 172}));
}

TEST(EvdevCodes, ADescriptorWithoutAPadHasNone) {
  // The application is a mouse.
  const auto codes = evdev_codes(parsed(pad_with(0x02, kEighteenButtons)));
  EXPECT_EQ(codes.size(), 20u);
  EXPECT_TRUE(std::all_of(codes.begin(), codes.end(), [](const auto& c) { return !c; }));
}

TEST(UsageOfCode, NamesTheUsagesThatDefaultPadsAreReadBy) {
  const auto key = [](std::uint16_t code) { return EvdevCode{EvdevType::key, code}; };
  const auto axis = [](std::uint16_t code) { return EvdevCode{EvdevType::absolute, code}; };
  EXPECT_EQ(usage_of_code(key(0x130), usage::kGamePad), 0x00090001u);
  EXPECT_EQ(usage_of_code(key(0x133), usage::kGamePad), 0x00090004u);
  EXPECT_EQ(usage_of_code(key(0x13e), usage::kGamePad), 0x0009000fu);
  EXPECT_EQ(usage_of_code(key(0x120), usage::kJoystick), 0x00090001u);
  EXPECT_EQ(usage_of_code(key(0x2c4), usage::kJoystick), 0x00090015u);  // usage of the 21st button
  EXPECT_EQ(usage_of_code(key(0x13b), usage::kJoystick), usage::kStart);
  EXPECT_EQ(usage_of_code(key(0x130), usage::kJoystick), 0xffe51130u);
  EXPECT_EQ(usage_of_code(key(0x220), usage::kGamePad), usage::kDpadUp);
  EXPECT_EQ(usage_of_code(key(0x223), usage::kGamePad), usage::kDpadRight);
  EXPECT_EQ(usage_of_code(key(30), usage::kGamePad), 0xffe5101eu);  // KEY_A
  EXPECT_EQ(usage_of_code(axis(0x05), usage::kGamePad), usage::kRz);
  EXPECT_EQ(usage_of_code(axis(0x0a), usage::kGamePad), usage::kBrake);
  EXPECT_EQ(usage_of_code(axis(0x18), usage::kGamePad), 0xffe53018u);  // ABS_PRESSURE
}

// States a field for every code of a node and reads it back.
TEST(UsageOfCode, GivesEveryCodeBack) {
  for (const std::uint32_t application : {usage::kGamePad, usage::kJoystick, usage::kMultiAxis}) {
    ReportDescriptor d;
    d.applications = {application};
    std::vector<EvdevCode> codes;
    for (std::uint16_t c = 0; c <= evdev::kKeyMax; ++c) codes.push_back({EvdevType::key, c});
    for (std::uint16_t c = 0; c <= evdev::kAbsMax; ++c) codes.push_back({EvdevType::absolute, c});
    for (const EvdevCode& code : codes) {
      Field field;
      field.application = 0;
      field.usage = usage_of_code(code, application);
      d.fields.push_back(field);
    }
    const auto back = evdev_codes(d, StatedBy::evdev_driver);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      EXPECT_EQ(back[i], codes[i]) << codes[i].code << " on " << application;
    }
  }
}

// ---- Event nodes as HID devices

// An event node read through layout and decoder.
class Node {
 public:
  Node(EvdevAbilities abilities, std::uint16_t vendor, std::uint16_t product, std::uint16_t version,
       std::vector<std::uint8_t> own_descriptor = {})
      : abilities_(std::move(abilities)), stated_(evdev_layout(abilities_, own_descriptor)) {
    info_.driver = "evdev";
    info_.vendor = vendor;
    info_.product = product;
    info_.version = version;
    info_.descriptor = stated_.descriptor;
    layout_ = value_of(pad_layout(info_, shipped_pads()));
    for (const EvdevAxis& a : abilities_.axes) {
      state_.axis[a.code] = static_cast<std::int32_t>((std::int64_t{a.min} + a.max) / 2);
    }
  }
  void set_axis(std::uint16_t code, std::int32_t value) { state_.axis[code] = value; }
  void set_key(std::uint16_t code, bool is_pressed) { state_.keys[code] = is_pressed; }
  const PadLayout& layout() const { return layout_; }
  const EvdevLayout& stated() const { return stated_; }
  PadState state() {
    Report report;
    put_state(stated_, state_, report);
    EXPECT_TRUE(decode(layout_, report, pad_));
    return pad_;
  }
  // The buttons that one key presses.
  std::uint32_t buttons_of(std::uint16_t code) {
    set_key(code, true);
    const std::uint32_t buttons = state().buttons;
    set_key(code, false);
    return buttons;
  }

 private:
  EvdevAbilities abilities_;
  EvdevLayout stated_;
  DeviceInfo info_;
  PadLayout layout_;
  EvdevState state_;
  PadState pad_;
};

constexpr std::uint32_t bit(PadButton b) { return 1u << b; }

void expect_sticks(Node& node, std::int32_t min, std::int32_t max) {
  const std::uint16_t codes[] = {0, 1, 3, 4};
  const PadAxis axes[] = {kLeftX, kLeftY, kRightX, kRightY};
  for (int i = 0; i < 4; ++i) {
    const float sign = i % 2 == 1 ? -1.0f : 1.0f;  // evdev's y grows downwards
    node.set_axis(codes[i], max);
    EXPECT_FLOAT_EQ(node.state().axis[axes[i]], sign) << kAxisNames[axes[i]];
    node.set_axis(codes[i], min);
    EXPECT_FLOAT_EQ(node.state().axis[axes[i]], -sign) << kAxisNames[axes[i]];
    node.set_axis(codes[i], (max + min) / 2);
    EXPECT_NEAR(node.state().axis[axes[i]], 0.0f, 0.005f);
  }
}

void expect_triggers(Node& node) {
  for (const auto& [code, trigger] :
       {std::pair<std::uint16_t, PadAxis>{2, kLeftTrigger}, {5, kRightTrigger}}) {
    node.set_axis(code, 255);
    EXPECT_FLOAT_EQ(node.state().axis[trigger], 1.0f);
    node.set_axis(code, 0);
    EXPECT_FLOAT_EQ(node.state().axis[trigger], 0.0f);
  }
}

void expect_hat(Node& node) {
  const Hat kHats[3][3] = {{Hat::up_left, Hat::up, Hat::up_right},
                           {Hat::left, Hat::released, Hat::right},
                           {Hat::down_left, Hat::down, Hat::down_right}};
  for (int y = 1; y >= -1; --y) {
    for (int x = -1; x <= 1; ++x) {
      node.set_axis(0x10, x);
      node.set_axis(0x11, y);
      EXPECT_EQ(node.state().hat, kHats[y + 1][x + 1]);
    }
  }
  node.set_axis(0x10, 0);
  node.set_axis(0x11, 0);
}

using Buttons = std::vector<std::pair<std::uint16_t, PadButton>>;
const Buttons kCommon = {{0x130, kButtonA},
                         {0x131, kButtonB},
                         {0x136, kButtonLeftShoulder},
                         {0x137, kButtonRightShoulder},
                         {0x13a, kButtonBack},
                         {0x13b, kButtonStart},
                         {0x13c, kButtonGuide},
                         {0x13d, kButtonLeftStick},
                         {0x13e, kButtonRightStick}};

EvdevAbilities with_keys(EvdevAbilities node, std::uint16_t first, std::uint16_t last) {
  for (std::uint16_t code = first; code <= last; ++code) node.keys.push_back(code);
  return node;
}

// BTN_NORTH is 0x133, BTN_WEST 0x134: top and left, except for xpad, which uses them for X and Y.
// Paddles of an Elite pad are numbered as in SDL.
TEST(EvdevLayout, PadsOnTheirKernelDriversAreNamedByPosition) {
  const Buttons xbox = {{0x133, kButtonX}, {0x134, kButtonY}};
  const Buttons sony = {{0x133, kButtonY}, {0x134, kButtonX}};
  const Buttons elite = {{0x2c4, kButtonPaddle1},
                         {0x2c5, kButtonPaddle3},
                         {0x2c6, kButtonPaddle2},
                         {0x2c7, kButtonPaddle4},
                         {0x133, kButtonX}};
  const Buttons nintendo = {{0x133, kButtonY}, {0x134, kButtonX}, {0x135, kButtonMisc1}};
  struct Row {
    EvdevAbilities node;
    std::uint16_t vendor, product, version;
    std::int32_t min, max;
    const Buttons& own;
    bool has_triggers;
  };
  for (const Row& row :
       {Row{xpad_node(), 0x045e, 0x028e, 0x0114, -32768, 32767, xbox, true},
        {with_keys(xpad_node(), 0x2c4, 0x2c7), 0x045e, 0x0b00, 0x0500, -32768, 32767, elite, true},
        {playstation_node(), 0x054c, 0x09cc, 0x8111, 0, 255, sony, true},
        {playstation_node(), 0x054c, 0x0ce6, 0x8111, 0, 255, sony, true},
        {playstation_node(), 0x054c, 0x05c4, 0x8111, 0, 255, sony, true},
        {nintendo_node(), 0x057e, 0x2009, 0x8111, -32767, 32767, nintendo, false}}) {
    SCOPED_TRACE(row.product);
    Node node(row.node, row.vendor, row.product, row.version);
    EXPECT_TRUE(node.layout().is_pad);
    EXPECT_FALSE(node.layout().streams);
    expect_sticks(node, row.min, row.max);
    expect_hat(node);
    for (const Buttons& buttons : {kCommon, row.own})
      for (const auto& [code, button] : buttons)
        EXPECT_EQ(node.buttons_of(code), bit(button)) << code;
    if (row.has_triggers) {
      expect_triggers(node);
    } else {  // other pads' triggers are keys
      node.set_key(0x138, true);
      node.set_key(0x139, true);
      EXPECT_FLOAT_EQ(node.state().axis[kLeftTrigger], 1.0f);
      EXPECT_FLOAT_EQ(node.state().axis[kRightTrigger], 1.0f);
    }
  }
}

TEST(EvdevLayout, DpadKeysAreADpad) {
  EvdevAbilities abilities = with_keys(playstation_node(), 0x220, 0x223);
  abilities.axes.resize(6);  // hid-sony's DualShock 3 has no hat
  Node node(abilities, 0x054c, 0x0268, 0x8111);
  for (const auto& [code, button] : Buttons{{0x220, kButtonDpadUp},
                                            {0x221, kButtonDpadDown},
                                            {0x222, kButtonDpadLeft},
                                            {0x223, kButtonDpadRight}})
    EXPECT_EQ(node.buttons_of(code), bit(button));
}

TEST(EvdevLayout, AJoystickIsStatedAsOne) {
  EvdevAbilities abilities;
  abilities.axes = {{0, 0, 1023}, {1, 0, 1023}, {5, 0, 255}, {6, 0, 255}};
  for (std::uint16_t code = 0x120; code < 0x12c; ++code) abilities.keys.push_back(code);
  Node node(abilities, 0x046d, 0xc215, 0x0110);
  ASSERT_EQ(node.layout().descriptor.applications.size(), 1u);
  EXPECT_EQ(node.layout().descriptor.applications[0], usage::kJoystick);
  EXPECT_TRUE(node.layout().is_pad);
  node.set_axis(0, 1023);
  node.set_axis(5, 0);  // the axis of a flight stick's twist
  EXPECT_FLOAT_EQ(node.state().axis[kLeftX], 1.0f);
  EXPECT_FLOAT_EQ(node.state().axis[kRightX], 0.0f) << "a twist is no right stick";
}

TEST(EvdevLayout, AxesOfWidestRangesAndValuesOutsideThem) {
  constexpr std::int32_t kLowest = std::numeric_limits<std::int32_t>::min(),
                         kHighest = std::numeric_limits<std::int32_t>::max();
  Node node({{{0, kLowest, kHighest}, {1, 0, kHighest}, {3, -100, 100}, {4, 5, 5}}, {0x130}},
            0x1209, 1, 1);
  node.set_axis(0, kLowest);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftX], -1.0f);
  node.set_axis(0, kHighest);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftX], 1.0f);
  node.set_axis(1, -1);  // an uninitialised value below the axis's range
  EXPECT_FLOAT_EQ(node.state().axis[kLeftY], 1.0f);
  node.set_axis(1, kHighest);
  EXPECT_FLOAT_EQ(node.state().axis[kLeftY], -1.0f);
  node.set_axis(3, 32767);
  EXPECT_FLOAT_EQ(node.state().axis[kRightX], 1.0f);
  node.set_axis(4, 77);  // the axis has no range, so it has no position
  EXPECT_FLOAT_EQ(node.state().axis[kRightY], 0.0f);
}

TEST(EvdevLayout, WhateverANodeClaimsItIsADescriptorAndAShortReport) {
  EvdevAbilities all, gaps;
  for (std::uint16_t code = 0; code < 0x400; ++code) {
    if (code <= 0x50) all.axes.push_back({code, std::numeric_limits<std::int32_t>::min(), 70000});
    all.keys.push_back(code);
    if (code % 3 != 2) gaps.keys.push_back(code);
  }
  gaps.axes = all.axes;
  for (const EvdevAbilities& abilities : {all, gaps, EvdevAbilities{}}) {
    const EvdevLayout layout = evdev_layout(abilities, {});
    const auto parsed = parse_descriptor(layout.descriptor);
    ASSERT_TRUE(parsed) << parsed.error().message;
    EXPECT_EQ(report_bytes(*parsed, FieldKind::input, 0), layout.report_bytes);
    EXPECT_LE(layout.report_bytes, kMaxReportBytes);
    EvdevState state;
    state.keys.set();
    Report report;
    put_state(layout, state, report);
    EXPECT_EQ(report.size, layout.report_bytes);
  }
}

TEST(EvdevLayout, EveryCodeStandsWhereTheDescriptorSaysSo) {
  EvdevAbilities abilities = playstation_node();
  abilities.axes.push_back({0x12, -1, 1});  // the axes of a second hat
  abilities.axes.push_back({0x13, -1, 1});
  abilities.axes.push_back({0x28, 0, 70000});
  abilities.keys.insert(abilities.keys.begin(), {30, 158, 172, 240});
  abilities.keys.push_back(0x2ff);
  const EvdevLayout layout = evdev_layout(abilities, {});
  const auto parsed = parse_descriptor(layout.descriptor);
  ASSERT_TRUE(parsed) << parsed.error().message;
  const auto codes = evdev_codes(*parsed, StatedBy::evdev_driver);
  ASSERT_EQ(parsed->fields.size(), layout.fields.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    EXPECT_EQ(codes[i], layout.fields[i].code) << i;
    EXPECT_EQ(parsed->fields[i].bit_offset, layout.fields[i].bit_offset) << i;
    EXPECT_EQ(parsed->fields[i].bit_size, layout.fields[i].bit_size) << i;
  }
}

// Emulates hid-input: the event node of a HID pad without a special driver.
class HidInput {
 public:
  explicit HidInput(const std::vector<std::uint8_t>& descriptor)
      : descriptor_(*parse_descriptor(descriptor)), codes_(evdev_codes(descriptor_)) {
    std::array<std::optional<EvdevAxis>, evdev::kAbsMax + 1> axes;
    std::bitset<evdev::kKeyMax + 1> keys;
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      if (!codes_[i]) continue;
      const Field& f = descriptor_.fields[i];
      const std::uint16_t code = codes_[i]->code;
      if (codes_[i]->type == EvdevType::key) {
        keys.set(code);
      } else if (code == evdev::kAbsHat0X) {
        axes[code] = {code, -1, 1};
        axes[code + 1] = {static_cast<std::uint16_t>(code + 1), -1, 1};
      } else {
        axes[code] = {code, static_cast<std::int32_t>(f.logical_min),
                      static_cast<std::int32_t>(f.logical_max)};
      }
    }
    for (const auto& a : axes) {
      if (a) abilities_.axes.push_back(*a);
    }
    for (std::uint16_t code = 0; code < keys.size(); ++code) {
      if (keys[code]) abilities_.keys.push_back(code);
    }
  }
  const EvdevAbilities& abilities() const { return abilities_; }

  void take(const Report& report, EvdevState& state) const {
    const std::size_t skip = descriptor_.numbered ? 1 : 0;
    const std::span<const std::uint8_t> data(report.bytes.data() + skip, report.size - skip);
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      const Field& f = descriptor_.fields[i];
      if (!codes_[i] || (descriptor_.numbered && f.report_id != report.bytes[0])) continue;
      const std::int64_t value = field_value(f, data);
      const std::uint16_t code = codes_[i]->code;
      if (codes_[i]->type == EvdevType::key) {
        state.keys[code] = value != 0;
      } else if (code == evdev::kAbsHat0X) {
        take_hat(f, value, state);
      } else {
        state.axis[code] = static_cast<std::int32_t>(value);
      }
    }
  }

 private:
  static void take_hat(const Field& f, std::int64_t value, EvdevState& state) {
    constexpr std::int32_t kX[] = {0, 0, 1, 1, 1, 0, -1, -1, -1};
    constexpr std::int32_t kY[] = {0, -1, -1, 0, 1, 1, 1, 0, -1};
    std::int64_t direction = (value - f.logical_min) * 8 / (f.logical_max - f.logical_min + 1) + 1;
    if (value < f.logical_min || direction < 0 || direction > 8) direction = 0;
    state.axis[evdev::kAbsHat0X] = kX[direction];
    state.axis[evdev::kAbsHat0X + 1] = kY[direction];
  }
  ReportDescriptor descriptor_;
  std::vector<std::optional<EvdevCode>> codes_;
  EvdevAbilities abilities_;
};

// Bits on a vendor page, which hid-input leaves out.
constexpr std::uint32_t kPaddles =
    bit(kButtonPaddle1) | bit(kButtonPaddle2) | bit(kButtonPaddle3) | bit(kButtonPaddle4);

// True if an override replaces the report's descriptor: the kernel reads something else.
bool is_replaced(const PadLayout& layout, const Report& report) {
  return std::any_of(layout.reports.begin(), layout.reports.end(), [&](const ReportLayout& r) {
    return std::find(r.exact_sizes.begin(), r.exact_sizes.end(), report.size) !=
           r.exact_sizes.end();
  });
}

// The same entry of config/pads, or none, must give the same state through both nodes of a pad.
void expect_same_through_evdev(const std::string& path, const PadOverrides& overrides,
                               int& compared) {
  SCOPED_TRACE(path);
  const auto trace = read_trace(path);
  ASSERT_TRUE(trace) << trace.error().message;
  DeviceInfo info = trace->devices[0].info;
  const auto raw_layout = pad_layout(info, overrides);
  ASSERT_TRUE(raw_layout);
  const HidInput kernel(info.descriptor);
  const EvdevLayout stated = evdev_layout(kernel.abilities(), info.descriptor);
  info.driver = "evdev";
  info.version = 0x0111;
  info.descriptor = stated.descriptor;
  const auto layout = pad_layout(info, overrides);
  ASSERT_TRUE(layout) << layout.error().message;
  if (layout->override_origin != raw_layout->override_origin) return;
  ++compared;
  EvdevState state;
  PadState raw, through;
  for (const TraceEvent& event : trace->events) {
    const Report report = report_of(*trace, event);
    if (report.size < 2 || is_replaced(*raw_layout, report)) continue;
    if (!decode(*raw_layout, report, raw)) continue;
    kernel.take(report, state);
    Report evdev_report;
    put_state(stated, state, evdev_report);
    ASSERT_TRUE(decode(*layout, evdev_report, through));
    for (int a = 0; a < kAxisCount; ++a) {
      EXPECT_NEAR(through.axis[a], raw.axis[a], 1e-6f) << kAxisNames[a];
    }
    EXPECT_EQ(through.buttons & ~kPaddles, raw.buttons & ~kPaddles);
    EXPECT_EQ(through.hat, raw.hat);
  }
}

TEST(EvdevLayout, AHidPadIsTheSameThroughHidrawAndThroughEvdev) {
  const PadOverrides overrides = shipped_pads();
  int compared = 0;
  for (const std::string& path : files_in(kGoldenPads, ".hid"))
    expect_same_through_evdev(path, overrides, compared);
  EXPECT_GE(compared, 8);
}

}  // namespace
}  // namespace gaitpad
