// Codes are those of Linux's include/uapi/linux/input-event-codes.h, the rules those of
// drivers/hid/hid-input.c (6.1), both written out here as numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "hid/evdev_layout.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

ReportDescriptor parsed(const std::vector<std::uint8_t>& bytes) {
  return value_of(parse_descriptor(bytes));
}

// An application collection around X, Y (bytes) and what `items` states.
std::vector<std::uint8_t> pad_with(std::uint8_t application, std::vector<std::uint8_t> items) {
  std::vector<std::uint8_t> bytes = {0x05, 0x01, 0x09, application, 0xa1, 0x01, 0x15,
                                     0x00, 0x26, 0xff, 0x00,        0x75, 0x08, 0x95,
                                     0x02, 0x09, 0x30, 0x09,        0x31, 0x81, 0x02};
  for (const std::uint8_t item : items) bytes.push_back(item);
  bytes.push_back(0xc0);
  return bytes;
}

// Code by usage, -1 for none; X and Y left out. A usage that occurs again gets `.2` behind it.
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

TEST(EvdevCodes, ButtonsOfAGamePadBeginAtBtnGamepadAndGoOnAtTriggerHappy) {
  const auto codes = codes_of(kGamePad, kEighteenButtons);
  EXPECT_EQ(codes.at("9:1"), 0x130);
  EXPECT_EQ(codes.at("9:10"), 0x13f);
  EXPECT_EQ(codes.at("9:11"), 0x2c0);
  EXPECT_EQ(codes.at("9:12"), 0x2c1);
}

TEST(EvdevCodes, ButtonsOfAJoystickBeginAtBtnJoystickAndGoOnAtTriggerHappy) {
  const auto codes = codes_of(kJoystick, kEighteenButtons);
  EXPECT_EQ(codes.at("9:1"), 0x120);
  EXPECT_EQ(codes.at("9:10"), 0x12f);
  EXPECT_EQ(codes.at("9:11"), 0x2c0);
}

TEST(EvdevCodes, ButtonsOfAnotherApplicationBeginAtBtnMisc) {
  const auto codes = codes_of(kMultiAxis, kEighteenButtons);
  EXPECT_EQ(codes.at("9:1"), 0x100);
  EXPECT_EQ(codes.at("9:12"), 0x111);
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
}

TEST(EvdevCodes, OfSeveralZTheOneBesideRzHasTheCode) {
  // Z Z Rz, as DragonRise's pads state them
  EXPECT_EQ(codes_of(kJoystick, {0x09, 0x32, 0x09, 0x32, 0x09, 0x35, 0x95, 0x03, 0x81, 0x02}),
            (Map{{"1:32", -1}, {"1:32.2", 2}, {"1:35", 5}}));
}

TEST(EvdevCodes, AHatIsAPairAndASecondOneHasNone) {
  EXPECT_EQ(
      codes_of(kGamePad, {0x09, 0x39, 0x09, 0x39, 0x25, 0x07, 0x75, 0x04, 0x95, 0x02, 0x81, 0x42}),
      (Map{{"1:39", 0x10}, {"1:39.2", -1}}));
}

TEST(EvdevCodes, DpadUsagesAreAHat) {
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
  // ff00 is Microsoft's and ignored; ff02 nobody knows: BTN_MISC where it is one bit, else ABS_MISC
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
  const auto codes = evdev_codes(parsed(pad_with(0x02, kEighteenButtons)));  // a mouse
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
  EXPECT_EQ(usage_of_code(key(0x2c4), usage::kJoystick), 0x00090015u);  // the 21st
  EXPECT_EQ(usage_of_code(key(0x13b), usage::kJoystick), usage::kStart);
  EXPECT_EQ(usage_of_code(key(0x130), usage::kJoystick), 0xffe51130u);
  EXPECT_EQ(usage_of_code(key(0x220), usage::kGamePad), usage::kDpadUp);
  EXPECT_EQ(usage_of_code(key(0x223), usage::kGamePad), usage::kDpadRight);
  EXPECT_EQ(usage_of_code(key(30), usage::kGamePad), 0xffe5101eu);  // KEY_A
  EXPECT_EQ(usage_of_code(axis(0x05), usage::kGamePad), usage::kRz);
  EXPECT_EQ(usage_of_code(axis(0x0a), usage::kGamePad), usage::kBrake);
  EXPECT_EQ(usage_of_code(axis(0x18), usage::kGamePad), 0xffe53018u);  // ABS_PRESSURE
}

// Every code of a node, one field each, stated and read again.
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

}  // namespace
}  // namespace gaitpad
