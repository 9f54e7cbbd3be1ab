// config/pads with made-up reports of pads that nobody here has recorded. Layouts: dekuNukem's
// Nintendo_Switch_Reverse_Engineering, Linux's hid-nintendo.c.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

// A joystick of these axes, then buttons, in one report without an id, filled up to bytes.
struct MadeStick {
  struct Axis {
    std::uint32_t usage;
    std::uint16_t max;
    std::uint8_t bits;
  };
  std::vector<Axis> axes;
  std::uint8_t buttons = 0;
  std::vector<std::uint8_t> descriptor() const {
    std::vector<std::uint8_t> d = {0x05, 0x01, 0x09, 0x04, 0xa1, 0x01, 0x15, 0x00, 0x95, 0x01};
    int bits = 0;
    for (const Axis& a : axes) {
      d.insert(d.end(),
               {0x09, static_cast<std::uint8_t>(a.usage), 0x27, static_cast<std::uint8_t>(a.max),
                static_cast<std::uint8_t>(a.max >> 8), 0, 0, 0x75, a.bits, 0x81, 0x02});
      bits += a.bits;
    }
    if (buttons > 0)
      d.insert(d.end(), {0x05, 0x09, 0x19, 0x01, 0x29, buttons, 0x25, 0x01, 0x75, 0x01, 0x95,
                         buttons, 0x81, 0x02, 0x95, 0x01});
    bits += buttons;
    if (bits % 8 != 0)
      d.insert(d.end(), {0x75, static_cast<std::uint8_t>(8 - bits % 8), 0x81, 0x03});
    d.push_back(0xc0);
    return d;
  }
};

// X and Y alone.
std::vector<std::uint8_t> made_pad_descriptor() {
  MadeStick stick;
  stick.axes = {{usage::kX, 255, 8}, {usage::kY, 255, 8}};
  return stick.descriptor();
}

class ShippedPads : public testing::Test {
 protected:
  static DeviceInfo pad(std::uint16_t vendor, std::uint16_t product, const std::string& driver,
                        std::vector<std::uint8_t> descriptor) {
    DeviceInfo info;
    info.vendor = vendor;
    info.product = product;
    info.driver = driver;
    info.descriptor = std::move(descriptor);
    return info;
  }
  void take(const DeviceInfo& info) {
    layout_ = value_of(pad_layout(info, shipped_pads()));
    state_ = {};
  }
  void decode_bytes(const std::vector<std::uint8_t>& bytes) {
    EXPECT_TRUE(decode(layout_, report_of(bytes), state_));
  }
  void expect_left(double x, double y) {
    EXPECT_NEAR(state_.axis[kLeftX], x, 0.01);
    EXPECT_NEAR(state_.axis[kLeftY], y, 0.01);
  }
  PadLayout layout_;
  PadState state_;
};

// The Pro Controller's, which the other pads of the Switch have too.
std::vector<std::uint8_t> switch_descriptor() {
  const auto trace = value_of(read_trace(kGoldenPads + "/057e_2009.hid"));
  return trace.devices.at(0).info.descriptor;
}

// Report 0x30 over Bluetooth: three bytes of buttons, four numbers of 12 bits.
std::vector<std::uint8_t> switch_report(std::array<std::uint8_t, 3> buttons,
                                        std::array<int, 4> sticks = {2048, 2048, 2048, 2048}) {
  std::vector<std::uint8_t> report = {0x30, 0, 0x8e, buttons[0], buttons[1], buttons[2]};
  for (const std::size_t i : {0u, 2u}) {
    report.push_back(static_cast<std::uint8_t>(sticks[i]));
    report.push_back(static_cast<std::uint8_t>(sticks[i] >> 8 | sticks[i + 1] << 4));
    report.push_back(static_cast<std::uint8_t>(sticks[i + 1] >> 4));
  }
  report.resize(49);
  return report;
}

TEST_F(ShippedPads, ALeftJoyConIsHeldSideways) {
  take(pad(0x057e, 0x2006, "hidraw", switch_descriptor()));
  EXPECT_TRUE(layout_.is_pad);
  EXPECT_TRUE(layout_.streams);
  // Its own right (x) is forward, its own up (y) is left.
  decode_bytes(switch_report({0, 0, 0}, {4095, 2048, 0, 0}));
  expect_left(0, 1);
  decode_bytes(switch_report({0, 0, 0}, {2048, 4095, 0, 0}));
  expect_left(-1, 0);
  EXPECT_EQ(state_.axis[kRightX], 0.0f);
  EXPECT_EQ(state_.axis[kRightY], 0.0f);
  decode_bytes(switch_report({0xff, 0, 0}));
  EXPECT_EQ(names_of(state_.buttons), "") << "those of the right one";
  const std::pair<std::uint8_t, const char*> own[] = {{0x08, "a"},
                                                      {0x01, "b"},
                                                      {0x02, "x"},
                                                      {0x04, "y"},
                                                      {0x20, "leftshoulder"},
                                                      {0x10, "rightshoulder"},
                                                      {0x40, "paddle2"},
                                                      {0x80, "paddle4"}};
  for (const auto& [bit, name] : own) {
    decode_bytes(switch_report({0, 0, bit}));
    EXPECT_EQ(names_of(state_.buttons), name);
  }
  decode_bytes(switch_report({0, 0x29, 0}));
  EXPECT_EQ(names_of(state_.buttons), "guide start leftstick");
}

TEST_F(ShippedPads, ARightJoyConIsHeldSideways) {
  take(pad(0x057e, 0x2007, "hidraw", switch_descriptor()));
  // Its own up is right, its own right is backwards.
  decode_bytes(switch_report({0, 0, 0}, {0, 0, 2048, 4095}));
  expect_left(1, 0);
  decode_bytes(switch_report({0, 0, 0}, {0, 0, 4095, 2048}));
  expect_left(0, -1);
  const std::pair<std::uint8_t, const char*> own[] = {{0x08, "a"},
                                                      {0x02, "b"},
                                                      {0x04, "x"},
                                                      {0x01, "y"},
                                                      {0x20, "leftshoulder"},
                                                      {0x10, "rightshoulder"},
                                                      {0x40, "paddle1"},
                                                      {0x80, "paddle3"}};
  for (const auto& [bit, name] : own) {
    decode_bytes(switch_report({bit, 0, 0}));
    EXPECT_EQ(names_of(state_.buttons), name);
  }
  decode_bytes(switch_report({0, 0x16, 0}));
  EXPECT_EQ(names_of(state_.buttons), "guide start leftstick");
}

TEST_F(ShippedPads, APairOfJoyConsIsReadAsAProController) {
  take(pad(0x057e, 0x2008, "hidraw", switch_descriptor()));
  decode_bytes(switch_report({0x08, 0x01, 0x02}, {4095, 2048, 2048, 4095}));
  expect_left(1, 0);
  EXPECT_NEAR(state_.axis[kRightY], 1, 0.01);
  EXPECT_EQ(names_of(state_.buttons), "b back dpup");
}

TEST_F(ShippedPads, TheDPadOfAPadWithoutAStickWalks) {
  take(pad(0x057e, 0x2017, "hidraw", switch_descriptor()));
  EXPECT_TRUE(layout_.is_pad);
  decode_bytes(switch_report({0, 0, 0x02}));
  expect_left(0, 1);
  EXPECT_EQ(names_of(state_.buttons), "dpup");
  decode_bytes(switch_report({0x40, 0, 0x49}));
  expect_left(-1, -1);
  EXPECT_EQ(names_of(state_.buttons), "leftshoulder rightshoulder dpdown dpleft");
  decode_bytes(switch_report({0, 0, 0}));
  expect_left(0, 0);
  std::vector<std::uint8_t> nes = switch_descriptor();
  nes.insert(nes.end(), {0x06, 0x57, 0xff, 0x09, 0x09, 0xa1, 0x01, 0xc0});
  take(pad(0x057e, 0x2006, "hidraw", nes));
  decode_bytes(switch_report({0x0c, 0x03, 0x04}));
  expect_left(1, 0);
  EXPECT_EQ(names_of(state_.buttons), "a b back start dpright");
}

TEST_F(ShippedPads, TheCButtonsOfANintendo64PadAreItsRightStick) {
  take(pad(0x057e, 0x2019, "hidraw", switch_descriptor()));
  decode_bytes(switch_report({0x01, 0, 0x80}, {2048, 4095, 0, 0}));
  expect_left(0, 1);
  EXPECT_EQ(state_.axis[kRightY], 1.0f);
  EXPECT_EQ(state_.axis[kRightX], 0.0f);
  EXPECT_EQ(state_.axis[kLeftTrigger], 1.0f);
  decode_bytes(switch_report({0x0a, 0x01, 0}));
  EXPECT_EQ(state_.axis[kRightX], 0.0f) << "left and right at once";
  EXPECT_EQ(names_of(state_.buttons), "a");
}

TEST_F(ShippedPads, NoButtonIsReadFromTheBytesOfSticks) {
  take(pad(0x057e, 0x2009, "hidraw", switch_descriptor()));
  for (const UnnamedButton& button : layout_.unnamed) EXPECT_NE(button.report_id, 0x30);
}

// Report of the Deck: version 1, type 9, 64 bytes.
std::vector<std::uint8_t> deck_report(std::uint64_t buttons, std::array<int, 6> axes) {
  std::vector<std::uint8_t> report(64);
  report[0] = 1;
  report[2] = 9;
  for (int i = 0; i < 8; ++i) report[8 + i] = static_cast<std::uint8_t>(buttons >> (8 * i));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    report[44 + 2 * i] = static_cast<std::uint8_t>(axes[i]);
    report[45 + 2 * i] = static_cast<std::uint8_t>(axes[i] >> 8);
  }
  return report;
}

TEST_F(ShippedPads, TheSteamDeckIsReadFromItsVendorReports) {
  const std::vector<std::uint8_t> own = {0x06, 0xff, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x09,
                                         0x02, 0x09, 0x03, 0x15, 0x00, 0x26, 0xff, 0x00,
                                         0x75, 0x08, 0x95, 0x40, 0x81, 0x02, 0xc0};
  take(pad(0x28de, 0x1205, "hidraw", own));
  EXPECT_TRUE(layout_.is_pad);
  decode_bytes(deck_report(0x80, {32767, 0, 32767, -32768, 0, 32767}));
  expect_left(1, -1);
  EXPECT_NEAR(state_.axis[kRightY], 1, 0.01);
  EXPECT_NEAR(state_.axis[kLeftTrigger], 1, 0.01);
  EXPECT_NEAR(state_.axis[kRightTrigger], 0, 0.01);
  EXPECT_EQ(names_of(state_.buttons), "a");
  const std::pair<std::uint64_t, const char*> others[] = {{0x20, "b"},
                                                          {0x40, "x"},
                                                          {0x10, "y"},
                                                          {8, "leftshoulder"},
                                                          {4, "rightshoulder"},
                                                          {0x100, "dpup"},
                                                          {0x1000, "back"},
                                                          {0x2000, "guide"},
                                                          {0x4000, "start"},
                                                          {1ull << 22, "leftstick"},
                                                          {1ull << 26, "rightstick"},
                                                          {1ull << 42, "paddle1"},
                                                          {1ull << 41, "paddle2"},
                                                          {1ull << 16, "paddle3"},
                                                          {1ull << 15, "paddle4"},
                                                          {1ull << 50, "misc1"},
                                                          {3, ""}};
  for (const auto& [bits, name] : others) {
    decode_bytes(deck_report(bits, {}));
    EXPECT_EQ(names_of(state_.buttons), name);
  }
  // Its mouse has the same ids.
  take(pad(0x28de, 0x1205, "hidraw",
           {0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x75, 0x08, 0x95, 0x02,
            0x81, 0x06, 0xc0}));
  EXPECT_FALSE(layout_.is_pad);
}

// A recording of a real one.
TEST_F(ShippedPads, TheSteamControllerWalksWithItsStick) {
  const std::string path = kSharedData + "/hid/steam_controller_vendor.hid";
  if (!std::filesystem::exists(path)) GTEST_SKIP();
  const auto [trace, layout] = recorded_pad(path, shipped_pads());
  EXPECT_TRUE(layout.is_pad);
  PadState state;
  std::uint32_t seen = 0;
  float widest = 0.0f;
  Report report;
  for (const TraceEvent& event : trace.events) {
    copy_report(trace, event, report);
    ASSERT_TRUE(decode(layout, report, state));
    seen |= state.buttons;
    widest = std::max(widest, std::abs(state.axis[kLeftX]));
  }
  EXPECT_NE(seen, 0u);
  EXPECT_GT(widest, 0.5f);
}

// What drivers/pads/steam.cpp hands on.
TEST_F(ShippedPads, TheSteamControllerOverBluetooth) {
  take(pad(0x28de, 0x1106, "hidraw", made_pad_descriptor()));
  EXPECT_TRUE(layout_.is_pad);
  decode_bytes(
      {3, 0x81, 0x80, 0x01, 0, 255, 0xff, 0x7f, 0x00, 0x80, 0x00, 0x80, 0xff, 0x7f, 0, 0, 0, 0});
  expect_left(1, -1);
  EXPECT_EQ(state_.axis[kRightX], -1.0f);
  EXPECT_EQ(state_.axis[kRightY], 1.0f);
  EXPECT_EQ(state_.axis[kLeftTrigger], 0.0f);
  EXPECT_EQ(state_.axis[kRightTrigger], 1.0f);
  EXPECT_EQ(names_of(state_.buttons), "a paddle1 paddle2");
}

// Lines of the community's data base that SDL's own list does not have.
TEST_F(ShippedPads, DragonRisePadsOfEachKind) {
  MadeStick stick;
  stick.buttons = 16;
  stick.axes = {{usage::kX, 255, 8},
                {usage::kY, 255, 8},
                {usage::kZ, 255, 8},
                {usage::kRz, 255, 8},
                {usage_of(0x01, 0x33), 255, 8},
                {usage_of(0x01, 0x34), 255, 8}};
  const auto buttons = [&](std::uint16_t product, std::uint16_t pressed) {
    take(pad(0x0079, product, "hidraw", stick.descriptor()));
    decode_bytes({128, 128, 128, 128, 0, 0, static_cast<std::uint8_t>(pressed),
                  static_cast<std::uint8_t>(pressed >> 8)});
    return names_of(state_.buttons);
  };
  EXPECT_EQ(buttons(0x0006, 0x0102), "b back");
  EXPECT_EQ(buttons(0x0126, 0x0304), "a back start");
  EXPECT_EQ(buttons(0x1830, 0x0302), "a back start");
  EXPECT_EQ(buttons(0x181c, 0x0411), "a y back");
  EXPECT_EQ(buttons(0x0122, 0x0301), "a back start");
  // GameCube adapters in their mode for PCs.
  EXPECT_EQ(buttons(0x1844, 0x1282), "a start rightshoulder dpup");
  decode_bytes({255, 0, 0, 255, 255, 0, 0, 0});
  expect_left(1, 1);
  EXPECT_EQ(state_.axis[kRightX], 1.0f);
  EXPECT_EQ(state_.axis[kRightY], 1.0f);
  EXPECT_EQ(state_.axis[kLeftTrigger], 1.0f);
  EXPECT_EQ(state_.axis[kRightTrigger], 0.0f);
}

TEST_F(ShippedPads, AnUltimate2InItsOwnMode) {
  take(pad(0x2dc8, 0x6012, "hidraw", made_pad_descriptor()));
  std::vector<std::uint8_t> report = {4, 2, 255, 0, 127, 127, 255, 0, 0x21, 0, 0x02};
  report.resize(34);
  decode_bytes(report);
  expect_left(1, 1);
  EXPECT_EQ(state_.axis[kRightTrigger], 1.0f);
  EXPECT_EQ(state_.axis[kLeftTrigger], 0.0f);
  EXPECT_EQ(names_of(state_.buttons), "a dpright paddle1 paddle4");
}

// Logitech's Extreme 3D Pro: 10 bits of stick, 8 bits of twist and throttle; the T.16000M: 14
// and 8.
TEST_F(ShippedPads, TwistAndThrottleOfAFlightStickAreNoRightStick) {
  MadeStick stick;
  stick.axes = {{usage::kX, 1023, 10},
                {usage::kY, 1023, 10},
                {usage::kRz, 255, 8},
                {usage_of(0x01, 0x36), 255, 8}};
  take(pad(0x046d, 0xc215, "hidraw", stick.descriptor()));
  EXPECT_TRUE(layout_.is_pad);
  decode_bytes({0xff, 0x03, 0xf0, 0xff, 0xff, 0, 0});
  EXPECT_EQ(state_.axis[kLeftX], 1.0f);
  EXPECT_EQ(state_.axis[kRightX], 0.0f);
  EXPECT_EQ(state_.axis[kRightY], 0.0f);
  stick.axes = {
      {usage::kX, 65535, 16}, {usage::kY, 65535, 16}, {usage::kZ, 255, 8}, {usage::kRz, 1023, 16}};
  take(pad(0x06a3, 0x0762, "hidraw", stick.descriptor()));
  for (const ReportLayout& report : layout_.reports) {
    for (const AxisOp& op : report.axes) EXPECT_LE(op.axis, kLeftY);
  }
}

DeviceInfo node_of(const EvdevAbilities& abilities, std::uint16_t vendor, std::uint16_t product) {
  DeviceInfo info;
  info.vendor = vendor;
  info.product = product;
  info.version = 0x8001;
  info.driver = "evdev";
  info.descriptor = evdev_layout(abilities, {}).descriptor;
  return info;
}

// hid-nintendo gives a right Joy-Con ABS_RX and ABS_RY alone, y downwards.
TEST_F(ShippedPads, SingleJoyConsAreHeldSidewaysOnTheKernelsNodesToo) {
  const EvdevAbilities right = {
      {{3, -32767, 32767}, {4, -32767, 32767}},
      {0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x138, 0x139, 0x13b, 0x13c, 0x13e}};
  const EvdevLayout nodes = evdev_layout(right, {});
  take(node_of(right, 0x057e, 0x2007));
  EXPECT_TRUE(layout_.is_pad);
  EvdevState state;
  state.axis[4] = -32767;  // its own up
  state.keys[0x131] = true;
  Report report;
  put_state(nodes, state, report);
  ASSERT_TRUE(decode(layout_, report, state_));
  expect_left(1, 0);
  EXPECT_EQ(names_of(state_.buttons), "a");
}

}  // namespace
}  // namespace gaitpad
