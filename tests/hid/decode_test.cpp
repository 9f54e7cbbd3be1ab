#include "gaitpad/decode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

using Bytes = std::vector<std::uint8_t>;

DeviceInfo device_of(const Bytes& descriptor) {
  DeviceInfo device;
  device.descriptor = descriptor;
  return device;
}

PadLayout layout_of(const DeviceInfo& device, const PadOverrides& overrides = {}) {
  return value_of(pad_layout(device, overrides));
}
PadLayout layout_of(const Bytes& descriptor) { return layout_of(device_of(descriptor)); }

PadLayout with_map(const DeviceInfo& device, const std::string& toml) {
  return layout_of(device, value_of(parse_pad_file(toml, "map.toml")));
}

PadState state_of(const PadLayout& layout, const Bytes& bytes) {
  PadState state;
  EXPECT_TRUE(decode(layout, report_of(bytes), state));
  return state;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Bytes pad(std::uint8_t kind, const Bytes& items) {
  return Bytes{0x05, 0x01, 0x09, kind, 0xa1, 0x01} + items + Bytes{0xc0};
}
// Items of 8-bit axes of page 1 with these usages, 0..255.
Bytes axes(const Bytes& usages) {
  Bytes items = {0x05, 0x01};
  for (const std::uint8_t u : usages) items = items + Bytes{0x09, u};
  const auto count = static_cast<std::uint8_t>(usages.size());
  return items + Bytes{0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, count, 0x81, 0x02};
}
// Items of one-bit buttons 1..n and padding to the next byte.
Bytes buttons(std::uint8_t n) {
  const auto rest = static_cast<std::uint8_t>((8 - n % 8) % 8);
  return Bytes{0x05, 0x09, 0x19, 0x01, 0x29, n,    0x15, 0x00, 0x25, 0x01,
               0x75, 0x01, 0x95, n,    0x81, 0x02, 0x95, rest, 0x81, 0x03};
}
Bytes hat(std::uint8_t min, const Bytes& max_item, std::uint8_t bits, const Bytes& physical = {}) {
  return Bytes{0x05, 0x01, 0x09, 0x39, 0x15, min} + max_item + physical +
         Bytes{0x75, bits, 0x95, 0x01, 0x81, 0x42, 0x35, 0x00, 0x45, 0x00};
}

std::uint32_t mask(std::initializer_list<PadButton> names) {
  std::uint32_t bits = 0;
  for (const PadButton b : names) bits |= 1u << b;
  return bits;
}

TEST(Decode, SticksSpanMinusOneToOneWithForwardUp) {
  const PadLayout l = layout_of(pad(0x05, axes({0x30, 0x31})));
  PadState s = state_of(l, {0x00, 0x00});
  EXPECT_EQ(s.axis[kLeftX], -1.0f);
  EXPECT_EQ(s.axis[kLeftY], 1.0f) << "HID's y grows towards the thumb's owner";
  s = state_of(l, {0xff, 0xff});
  EXPECT_EQ(s.axis[kLeftX], 1.0f);
  EXPECT_EQ(s.axis[kLeftY], -1.0f);
  s = state_of(l, {127, 128});
  EXPECT_FLOAT_EQ(s.axis[kLeftX], -1.0f / 255.0f) << "0..255 has no exact centre";
  EXPECT_FLOAT_EQ(s.axis[kLeftY], -1.0f / 255.0f);
}

TEST(Decode, SignedAndTwoBitAxesHaveAnExactCentre) {
  const Bytes signed_axes = {0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15, 0x81,
                             0x25, 0x7f, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02};
  PadState s = state_of(layout_of(pad(0x04, signed_axes)), {0x00, 0x81});
  EXPECT_EQ(s.axis[kLeftX], 0.0f);
  EXPECT_EQ(s.axis[kLeftY], 1.0f);
  const Bytes two_bits = {0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15, 0x00, 0x25, 0x02, 0x75,
                          0x02, 0x95, 0x02, 0x81, 0x02, 0x75, 0x04, 0x95, 0x01, 0x81, 0x03};
  s = state_of(layout_of(pad(0x05, two_bits)), {0b0001});
  EXPECT_EQ(s.axis[kLeftX], 0.0f);
  EXPECT_EQ(s.axis[kLeftY], 1.0f);
  EXPECT_FALSE(std::signbit(state_of(layout_of(pad(0x05, two_bits)), {0b0101}).axis[kLeftY]));
}

TEST(Decode, ValuesOutsideTheLogicalRangeAreClamped) {
  const Bytes small = {0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15, 0x64, 0x26,
                       0xc8, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02};
  const PadState s = state_of(layout_of(pad(0x05, small)), {0x00, 0xff});
  EXPECT_EQ(s.axis[kLeftX], -1.0f);
  EXPECT_EQ(s.axis[kLeftY], -1.0f);
}

TEST(Decode, ChecksIdAndLengthFirst) {
  const PadLayout l = layout_of(pad(0x05, Bytes{0x85, 0x03} + axes({0x30, 0x31})));
  PadState s;
  s.axis[kLeftX] = 0.5f;
  const PadState before = s;
  EXPECT_FALSE(decode(l, report_of({0x03, 0x00}), s)) << "one byte short";
  EXPECT_FALSE(decode(l, report_of({0x04, 0x00, 0x00}), s)) << "unknown id";
  EXPECT_FALSE(decode(l, report_of({}), s));
  Report command = report_of({0x03, 0x00, 0x00});
  command.kind = ReportKind::command;
  EXPECT_FALSE(decode(l, command, s));
  EXPECT_EQ(s, before);
  EXPECT_TRUE(decode(l, report_of({0x03, 0x00, 0x00, 0x77}), s)) << "longer ones are padded";
}

TEST(Decode, AReportLeavesAloneWhatItDoesNotTell) {
  const PadLayout l = layout_of(pad(0x05, Bytes{0x85, 0x01} + axes({0x30, 0x31}) + buttons(8)) +
                                Bytes{0x05, 0x0c, 0x09, 0x01, 0xa1, 0x01, 0x85, 0x02, 0x0a,
                                      0x23, 0x02, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95,
                                      0x01, 0x81, 0x02, 0x95, 0x07, 0x81, 0x03, 0xc0});
  PadState s;
  EXPECT_TRUE(decode(l, report_of({0x02, 0x01}), s));
  EXPECT_TRUE(pressed(s, kButtonGuide));
  EXPECT_TRUE(decode(l, report_of({0x01, 0xff, 0x00, 0x02}), s));
  EXPECT_EQ(s.buttons, mask({kButtonGuide, kButtonA}));
  EXPECT_TRUE(decode(l, report_of({0x02, 0x00}), s));
  EXPECT_EQ(s.buttons, mask({kButtonA}));
  EXPECT_EQ(s.axis[kLeftX], 1.0f);
}

TEST(Decode, HatsOfAllKindsPointTheSameWay) {
  const Bytes xy = axes({0x30, 0x31});
  const Bytes degrees = {0x35, 0x00, 0x46, 0x3b, 0x01};  // a physical range of 0..315
  struct Case {
    const char* what;
    Bytes descriptor;
    int first, step;
    std::vector<int> released;
  };
  const std::vector<Case> cases = {
      {"0..7", hat(0, {0x25, 0x07}, 8, degrees), 0, 1, {8, 15, 255}},
      {"0..7 without physical range", hat(0, {0x25, 0x07}, 8), 0, 1, {8, 15}},
      {"0..7 for 360 degrees", hat(0, {0x25, 0x07}, 8, {0x46, 0x68, 0x01}), 0, 1, {8}},
      {"1..8", hat(1, {0x25, 0x08}, 8, degrees), 1, 1, {0, 9}},
      {"0..8 with 8 released", hat(0, {0x25, 0x08}, 8), 0, 1, {8}},
      {"0..239", hat(0, {0x26, 0xef, 0x00}, 8), 0, 30, {240, 255}},
      {"0..239 for 360 degrees", hat(0, {0x26, 0xef, 0x00}, 8, {0x46, 0x68, 0x01}), 0, 30, {240}},
      {"0..315 degrees", hat(0, {0x26, 0x3b, 0x01}, 16, degrees), 0, 45, {316, 360, 65535}},
      {"0..359 degrees", hat(0, {0x26, 0x67, 0x01}, 16), 0, 45, {360, 65535}},
      {"0..31500", hat(0, {0x26, 0x0c, 0x7b}, 16, degrees), 0, 4500, {36000, 65535}},
  };
  for (const Case& c : cases) {
    const PadLayout l = layout_of(pad(0x05, xy + c.descriptor));
    const auto at = [&](int v) {
      return state_of(
          l, {0x80, 0x80, static_cast<std::uint8_t>(v & 255), static_cast<std::uint8_t>(v >> 8)});
    };
    for (int d = 0; d < 8; ++d) {
      EXPECT_EQ(static_cast<int>(at(c.first + d * c.step).hat), d) << c.what;
    }
    EXPECT_EQ(at(c.first).buttons, mask({kButtonDpadUp})) << c.what;
    EXPECT_EQ(at(c.first + 3 * c.step).buttons, mask({kButtonDpadDown, kButtonDpadRight}))
        << c.what;
    for (const int v : c.released) {
      EXPECT_EQ(at(v).hat, Hat::released) << c.what << " " << v;
      EXPECT_EQ(at(v).buttons, 0u) << c.what << " " << v;
    }
  }
}

TEST(Decode, FourStepHatsHaveNoDiagonals) {
  const PadLayout l = layout_of(pad(0x05, axes({0x30, 0x31}) + hat(0, {0x25, 0x03}, 8)));
  EXPECT_EQ(state_of(l, {0, 0, 1}).hat, Hat::right);
  EXPECT_EQ(state_of(l, {0, 0, 3}).hat, Hat::left);
  EXPECT_EQ(state_of(l, {0, 0, 4}).hat, Hat::released);
}

TEST(Decode, FourDpadUsagesMakeAHat) {
  const Bytes dpad = {0x05, 0x01, 0x09, 0x90, 0x09, 0x91, 0x09, 0x92, 0x09, 0x93, 0x15, 0x00,
                      0x25, 0x01, 0x75, 0x01, 0x95, 0x04, 0x81, 0x02, 0x95, 0x04, 0x81, 0x03};
  const PadLayout l = layout_of(pad(0x05, axes({0x30, 0x31}) + dpad));
  EXPECT_EQ(state_of(l, {0, 0, 0b0101}).hat, Hat::up_right);
  EXPECT_EQ(state_of(l, {0, 0, 0b1000}).hat, Hat::left);
  EXPECT_EQ(state_of(l, {0, 0, 0b0011}).hat, Hat::released) << "up and down cancel out";
}

// Xbox pads in Windows mode have triggers of 10 bits on Z and Rz.
const Bytes kNarrow = {0x09, 0x32, 0x26, 0xff, 0x03, 0x75, 0x10, 0x95,
                       0x01, 0x81, 0x02, 0x09, 0x35, 0x81, 0x02};
// Brake and accelerator imply Android's order of buttons; the accelerator is the right trigger in
// any order.
const Bytes kPedals = {0x05, 0x02, 0x09, 0xc4, 0x09, 0xc5, 0x15, 0x00, 0x26,
                       0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02};
const Bytes kButtonNumbers = {0x05, 0x09, 0x19, 0x01, 0x29, 0x0c, 0x15, 0x01,
                              0x25, 0x0c, 0x75, 0x08, 0x95, 0x02, 0x81, 0x00};

TEST(DefaultMap, ControlsAreNamedByTheUsagesThatAPadHas) {
  struct Row {
    const char* what;
    std::uint8_t kind;
    Bytes items, report;
    const char* words;
  };
  const Bytes four = axes({0x30, 0x31, 0x32, 0x35});
  const Row kRows[] = {
      {"most pads: Z and Rz; button 7 is a trigger where there is no trigger axis",
       0x04,
       four + buttons(12),
       {128, 128, 255, 0, 0x42, 0},
       "right_x 1 right_y 1 left_trigger 1 buttons a"},
      {"Sony: triggers on Rx and Ry, and the digital ones beside them are no control",
       0x05,
       axes({0x30, 0x31, 0x32, 0x35, 0x33, 0x34}) + buttons(15),
       {128, 128, 255, 0, 51, 255, 0x40, 0},
       "right_x 1 right_y 1 left_trigger 0.2 right_trigger 1"},
      {"Xbox in Windows mode: the stick on Rx and Ry",
       0x05,
       axes({0x30, 0x31, 0x33, 0x34}) + kNarrow + buttons(10),
       {128, 128, 255, 255, 0xff, 0x03, 0, 0, 0xc4, 0x03},
       "right_x 1 right_y -1 left_trigger 1 buttons x back start leftstick rightstick"},
      {"Android",
       0x05,
       four + kPedals + buttons(15),
       {128, 128, 128, 128, 255, 0, 0b11011011, 0b01111100},
       "right_trigger 1 buttons a b x y leftshoulder rightshoulder back start guide leftstick "
       "rightstick"},
      {"of several X the one beside Y",
       0x04,
       axes({0x30, 0x30, 0x30, 0x31}),
       {0x80, 0x80, 0xff, 0x00},
       "left_x 1 left_y 1"},
      {"buttons as an array of numbers",
       0x04,
       four + kButtonNumbers,
       {128, 128, 128, 128, 2, 9},
       "buttons a back"},
      {"none of an array", 0x04, four + kButtonNumbers, {128, 128, 128, 128, 0, 0}, ""},
  };
  for (const Row& row : kRows) {
    SCOPED_TRACE(row.what);
    expect_state(state_of(layout_of(pad(row.kind, row.items)), row.report), row.words);
  }
}

TEST(DefaultMap, OnlyTheFirstPadOfAnAdapterDrives) {
  const Bytes first = pad(0x04, Bytes{0x85, 0x01} + axes({0x30, 0x31}));
  const Bytes second = pad(0x04, Bytes{0x85, 0x02} + axes({0x30, 0x31}));
  const PadLayout l = layout_of(first + second);
  PadState s;
  EXPECT_TRUE(decode(l, report_of({0x02, 0xff, 0xff}), s)) << "a known report";
  EXPECT_EQ(s.axis[kLeftX], 0.0f);
  EXPECT_TRUE(decode(l, report_of({0x01, 0xff, 0xff}), s));
  EXPECT_EQ(s.axis[kLeftX], 1.0f);
}

TEST(DefaultMap, MiceAndVendorDevicesAreNoPads) {
  const PadLayout mouse = layout_of(pad(0x02, axes({0x30, 0x31})));
  EXPECT_FALSE(mouse.is_pad);
  PadState s;
  EXPECT_TRUE(decode(mouse, report_of({0xff, 0xff}), s));
  EXPECT_EQ(s, PadState{});
}

TEST(PadOverride, ControlsTakeThePlaceOfTheDefaultOnes) {
  DeviceInfo device = device_of(pad(0x04, axes({0x30, 0x31, 0x32, 0x35}) + buttons(12)));
  const PadLayout l =
      with_map(device,
               "[[pad]]\n[pad.axes]\nleft_y = \"-0001:0031\"\nright_x = \"0001:0035\"\n"
               "right_y = \"\"\n[pad.buttons]\na = \"button 1 | button 12\"\n"
               "paddle1 = \"0001:0032&80\"\n");
  const PadState s = state_of(l, {0x80, 0xff, 0x80, 0x00, 0x03, 0x08});
  EXPECT_EQ(s.axis[kLeftY], 1.0f);
  EXPECT_EQ(s.axis[kRightX], -1.0f);
  EXPECT_EQ(s.axis[kRightY], 0.0f);
  EXPECT_EQ(s.buttons, mask({kButtonA, kButtonPaddle1})) << "button 2 lost its control";
}

TEST(PadOverride, TopFirstIsTheOrderOfPlayStation2Adapters) {
  const DeviceInfo device = device_of(pad(0x04, axes({0x30, 0x31, 0x32, 0x35}) + buttons(12)));
  const PadLayout l = with_map(device, "[[pad]]\nbutton_order = \"top_first\"\n");
  EXPECT_EQ(state_of(l, {0, 0, 0, 0, 0x01, 0}).buttons, mask({kButtonY}));
  EXPECT_EQ(state_of(l, {0, 0, 0, 0, 0x04, 1}).buttons, mask({kButtonA, kButtonBack}));
}

TEST(PadOverride, AReplacedDescriptorHoldsOnlyForReportsOfItsRealLength) {
  DeviceInfo device = device_of(pad(0x05, Bytes{0x85, 0x30} + axes({0x30, 0x31})));
  const PadLayout l = with_map(
      device,
      "[[pad]]\n[pad.replace]\nlengths = [5]\ndescriptor = \"05 01 09 05 a1 01 85 30 75 08 95 02 "
      "81 03 "
      "09 30 09 31 26 ff 00 95 02 81 02 c0\"\n[pad.replace.axes]\nleft_y = \"-0001:0031\"\n");
  PadState s = state_of(l, {0x30, 0x00, 0x00, 0xff, 0xff});
  EXPECT_EQ(s.axis[kLeftX], 1.0f);
  EXPECT_EQ(s.axis[kLeftY], 1.0f);
  s = state_of(l, {0x30, 0x00, 0x00});
  EXPECT_EQ(s.axis[kLeftX], -1.0f);
  EXPECT_EQ(s.axis[kLeftY], 1.0f) << "the own descriptor's y is HID's";
  EXPECT_FALSE(decode(l, report_of({0x31, 0x00, 0x00, 0xff, 0xff}), s));
}

TEST(PadOverride, StreamingCountsOnlyWhereTheDriverHandsOnEverything) {
  DeviceInfo device = device_of(pad(0x05, axes({0x30, 0x31})));
  const std::string map = "[[pad]]\nstreams = true\n";
  EXPECT_TRUE(with_map(device, map).streams) << "a foreign recording comes from hidraw";
  device.driver = "usb";
  EXPECT_TRUE(with_map(device, map).streams);
  device.driver = "evdev";
  EXPECT_FALSE(with_map(device, map).streams);
}

TEST(PadOverride, ConfigCanCallADeviceAPad) {
  const DeviceInfo device = device_of(pad(0x02, axes({0x30, 0x31})));
  EXPECT_TRUE(with_map(device, "[[pad]]\npad = true\n").is_pad);
  const DeviceInfo real = device_of(pad(0x05, axes({0x30, 0x31})));
  EXPECT_FALSE(with_map(real, "[[pad]]\npad = false\n").is_pad);
}

TEST(PadLayout, ADamagedDescriptorIsAnError) {
  DeviceInfo device = device_of({0xa1});
  device.name = "Broken";
  const auto layout = pad_layout(device, {});
  ASSERT_FALSE(layout);
  EXPECT_EQ(layout.error().message,
            "Broken: report descriptor: byte 0: the item runs over the end");
}

}  // namespace
}  // namespace gaitpad
