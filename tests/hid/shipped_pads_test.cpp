// config/pads with synthetic reports of pads without recordings. Layouts: dekuNukem's
// Nintendo_Switch_Reverse_Engineering, Linux's hid-nintendo.c.
#include <gtest/gtest.h>

#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

// A joystick with these axes, then buttons, in one report without an id; the report is padded to
// whole bytes.
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

// A descriptor with X and Y alone.
std::vector<std::uint8_t> made_pad_descriptor() {
  MadeStick stick;
  stick.axes = {{usage::kX, 255, 8}, {usage::kY, 255, 8}};
  return stick.descriptor();
}

class ShippedPads : public testing::Test {
 protected:
  void take(std::uint16_t vendor, std::uint16_t product, std::vector<std::uint8_t> descriptor) {
    DeviceInfo info;
    info.vendor = vendor;
    info.product = product;
    info.driver = "hidraw";
    info.descriptor = std::move(descriptor);
    take(info);
  }
  void take(const DeviceInfo& info) {
    layout_ = value_of(pad_layout(info, shipped_pads()));
    state_ = {};
  }
  void expect_read(const std::vector<std::uint8_t>& bytes, const std::string& words) {
    EXPECT_TRUE(decode(layout_, report_of(bytes), state_)) << words;
    expect_state(state_, words);
  }
  PadLayout layout_;
  PadState state_;
};

// The Pro Controller's descriptor; the Switch's other pads have the same.
std::vector<std::uint8_t> switch_descriptor() {
  const auto trace = value_of(read_trace(kGoldenPads + "/057e_2009.hid"));
  return trace.devices.at(0).info.descriptor;
}

constexpr int kMid = 2048, kEnd = 4095;
// Report 0x30 over Bluetooth: three bytes of buttons, then four numbers of 12 bits.
struct SwitchReport {
  std::uint16_t product;
  std::array<std::uint8_t, 3> buttons;
  std::array<int, 4> sticks;
  const char* words;
  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> report = {0x30, 0, 0x8e, buttons[0], buttons[1], buttons[2]};
    for (const std::size_t i : {0u, 2u}) {
      report.push_back(static_cast<std::uint8_t>(sticks[i]));
      report.push_back(static_cast<std::uint8_t>(sticks[i] >> 8 | sticks[i + 1] << 4));
      report.push_back(static_cast<std::uint8_t>(sticks[i + 1] >> 4));
    }
    report.resize(49);
    return report;
  }
};

// Single Joy-Cons are held sideways. Left one: its own right (x) is forward, its own up (y) is
// left. Right one: its own up is right, its own right is backwards. A NES controller has the left
// one's id and a mark of this program.
constexpr std::uint16_t kLeft = 0x2006, kRight = 0x2007, kPair = 0x2008, kSnes = 0x2017,
                        kN64 = 0x2019, kNes = 0;
const SwitchReport kSwitchReports[] = {
    {kLeft, {0, 0, 0}, {kEnd, kMid, 0, 0}, "left_y 1"},
    {kLeft, {0, 0, 0}, {kMid, kEnd, 0, 0}, "left_x -1"},
    {kLeft, {0xff, 0, 0}, {kMid, kMid, 0, 0}, ""},  // the buttons of the right Joy-Con do not count
    {kLeft, {0, 0, 0x08}, {kMid, kMid, 0, 0}, "buttons a"},
    {kLeft, {0, 0, 0x01}, {kMid, kMid, 0, 0}, "buttons b"},
    {kLeft, {0, 0, 0x02}, {kMid, kMid, 0, 0}, "buttons x"},
    {kLeft, {0, 0, 0x04}, {kMid, kMid, 0, 0}, "buttons y"},
    {kLeft, {0, 0, 0x20}, {kMid, kMid, 0, 0}, "buttons leftshoulder"},
    {kLeft, {0, 0, 0x10}, {kMid, kMid, 0, 0}, "buttons rightshoulder"},
    {kLeft, {0, 0, 0x40}, {kMid, kMid, 0, 0}, "buttons paddle2"},
    {kLeft, {0, 0, 0x80}, {kMid, kMid, 0, 0}, "buttons paddle4"},
    {kLeft, {0, 0x29, 0}, {kMid, kMid, 0, 0}, "buttons guide start leftstick"},
    {kRight, {0, 0, 0}, {0, 0, kMid, kEnd}, "left_x 1"},
    {kRight, {0, 0, 0}, {0, 0, kEnd, kMid}, "left_y -1"},
    {kRight, {0x08, 0, 0}, {0, 0, kMid, kMid}, "buttons a"},
    {kRight, {0x02, 0, 0}, {0, 0, kMid, kMid}, "buttons b"},
    {kRight, {0x04, 0, 0}, {0, 0, kMid, kMid}, "buttons x"},
    {kRight, {0x01, 0, 0}, {0, 0, kMid, kMid}, "buttons y"},
    {kRight, {0x20, 0, 0}, {0, 0, kMid, kMid}, "buttons leftshoulder"},
    {kRight, {0x10, 0, 0}, {0, 0, kMid, kMid}, "buttons rightshoulder"},
    {kRight, {0x40, 0, 0}, {0, 0, kMid, kMid}, "buttons paddle1"},
    {kRight, {0x80, 0, 0}, {0, 0, kMid, kMid}, "buttons paddle3"},
    {kRight, {0, 0x16, 0}, {0, 0, kMid, kMid}, "buttons guide start leftstick"},
    {kPair, {8, 1, 2}, {kEnd, kMid, kMid, kEnd}, "left_x 1 right_y 1 buttons b back dpup"},
    // The D-pad replaces the stick of a pad without one.
    {kSnes, {0, 0, 0x02}, {}, "left_y 1 buttons dpup"},
    {kSnes,
     {0x40, 0, 0x49},
     {},
     "left_x -1 left_y -1 buttons leftshoulder rightshoulder dpdown dpleft"},
    {kSnes, {0, 0, 0}, {}, ""},
    {kNes, {0x0c, 0x03, 0x04}, {}, "left_x 1 buttons a b back start dpright"},
    // The C buttons of a Nintendo 64 pad are its right stick; left and right at once cancel out.
    {kN64, {0x01, 0, 0x80}, {kMid, kEnd, 0, 0}, "left_y 1 right_y 1 left_trigger 1"},
    {kN64, {0x0a, 0x01, 0}, {kMid, kMid, 0, 0}, "buttons a"},
};

TEST_F(ShippedPads, PadsOfTheSwitchAreReadAsTheyAreHeld) {
  for (const SwitchReport& row : kSwitchReports) {
    SCOPED_TRACE(row.product);
    std::vector<std::uint8_t> descriptor = switch_descriptor();
    if (row.product == kNes)
      descriptor.insert(descriptor.end(), {0x06, 0x57, 0xff, 0x09, 0x09, 0xa1, 0x01, 0xc0});
    take(0x057e, row.product == kNes ? kLeft : row.product, descriptor);
    EXPECT_TRUE(layout_.is_pad);
    EXPECT_TRUE(layout_.streams);
    expect_read(row.bytes(), row.words);
  }
}

TEST_F(ShippedPads, NoButtonIsReadFromTheBytesOfSticks) {
  take(0x057e, 0x2009, switch_descriptor());
  for (const UnnamedButton& button : layout_.unnamed) EXPECT_NE(button.report_id, 0x30);
}

// A report of the Steam Deck: version 1, type 9, 64 bytes.
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
  take(0x28de, 0x1205, {0x06, 0xff, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x09, 0x02, 0x09, 0x03, 0x15,
                        0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x40, 0x81, 0x02, 0xc0});
  EXPECT_TRUE(layout_.is_pad);
  expect_read(deck_report(0x80, {32767, 0, 32767, -32768, 0, 32767}),
              "left_x 1 left_y -1 right_y 1 left_trigger 1 buttons a");
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
    expect_read(deck_report(bits, {0, 0, 0, 0, 0, 0}), std::string("buttons ") + name);
  }
  // The Deck's mouse has the same ids.
  take(0x28de, 0x1205,
       {0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x75, 0x08, 0x95, 0x02, 0x81,
        0x06, 0xc0});
  EXPECT_FALSE(layout_.is_pad);
}

// Reports of a Steam Controller as drivers/pads/steam.cpp passes them on, and of an Ultimate 2 in
// its own mode.
TEST_F(ShippedPads, VendorReportsOverBluetoothAndRadio) {
  take(0x28de, 0x1106, made_pad_descriptor());
  EXPECT_TRUE(layout_.is_pad);
  expect_read(
      {3, 0x81, 0x80, 0x01, 0, 255, 0xff, 0x7f, 0x00, 0x80, 0x00, 0x80, 0xff, 0x7f, 0, 0, 0, 0},
      "left_x 1 left_y -1 right_x -1 right_y 1 right_trigger 1 buttons a paddle1 paddle2");
  take(0x2dc8, 0x6012, made_pad_descriptor());
  std::vector<std::uint8_t> report = {4, 2, 255, 0, 127, 127, 255, 0, 0x21, 0, 0x02};
  report.resize(34);
  expect_read(report, "left_x 1 left_y 1 right_trigger 1 buttons a dpright paddle1 paddle4");
}

// The expected numbers are from lines of the community's data base that SDL's own list does not
// have.
TEST_F(ShippedPads, DragonRisePadsOfEachKind) {
  MadeStick stick;
  stick.buttons = 16;
  stick.axes = {{usage::kX, 255, 8},
                {usage::kY, 255, 8},
                {usage::kZ, 255, 8},
                {usage::kRz, 255, 8},
                {usage_of(0x01, 0x33), 255, 8},
                {usage_of(0x01, 0x34), 255, 8}};
  struct Row {
    std::uint16_t product, pressed;
    const char* buttons;
  };
  for (const Row& row : {Row{0x0006, 0x0102, "b back"},
                         {0x0126, 0x0304, "a back start"},
                         {0x1830, 0x0302, "a back start"},
                         {0x181c, 0x0411, "a y back"},
                         {0x0122, 0x0301, "a back start"},
                         // GameCube adapters in their mode for PCs
                         {0x1844, 0x1282, "a start rightshoulder dpup"}}) {
    take(0x0079, row.product, stick.descriptor());
    expect_read({128, 128, 128, 128, 0, 0, static_cast<std::uint8_t>(row.pressed),
                 static_cast<std::uint8_t>(row.pressed >> 8)},
                std::string("buttons ") + row.buttons);
  }
  expect_read({255, 0, 0, 255, 255, 0, 0, 0},
              "left_x 1 left_y 1 right_x 1 right_y 1 left_trigger 1");
}

// Logitech's Extreme 3D Pro: 10 bits of stick, 8 bits of twist and throttle; the T.16000M: 14
// and 8.
TEST_F(ShippedPads, TwistAndThrottleOfAFlightStickAreNoRightStick) {
  MadeStick stick;
  stick.axes = {{usage::kX, 1023, 10},
                {usage::kY, 1023, 10},
                {usage::kRz, 255, 8},
                {usage_of(0x01, 0x36), 255, 8}};
  take(0x046d, 0xc215, stick.descriptor());
  EXPECT_TRUE(layout_.is_pad);
  expect_read({0xff, 0x03, 0xf0, 0xff, 0xff, 0, 0}, "left_x 1 left_y 1");
  stick.axes = {
      {usage::kX, 65535, 16}, {usage::kY, 65535, 16}, {usage::kZ, 255, 8}, {usage::kRz, 1023, 16}};
  take(0x06a3, 0x0762, stick.descriptor());
  for (const ReportLayout& report : layout_.reports) {
    for (const AxisOp& op : report.axes) EXPECT_LE(op.axis, kLeftY);
  }
}

// hid-nintendo gives a right Joy-Con ABS_RX and ABS_RY alone, y downwards.
TEST_F(ShippedPads, SingleJoyConsAreHeldSidewaysOnTheKernelsNodesToo) {
  const EvdevAbilities right = {
      {{3, -32767, 32767}, {4, -32767, 32767}},
      {0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x138, 0x139, 0x13b, 0x13c, 0x13e}};
  const EvdevLayout nodes = evdev_layout(right, {});
  DeviceInfo info;
  info.vendor = 0x057e;
  info.product = 0x2007;
  info.version = 0x8001;
  info.driver = "evdev";
  info.descriptor = nodes.descriptor;
  take(info);
  EXPECT_TRUE(layout_.is_pad);
  EvdevState state;
  state.axis[4] = -32767;  // up on the Joy-Con itself
  state.keys[0x131] = true;
  Report report;
  put_state(nodes, state, report);
  ASSERT_TRUE(decode(layout_, report, state_));
  expect_state(state_, "left_x 1 buttons a");
}

}  // namespace
}  // namespace gaitpad
