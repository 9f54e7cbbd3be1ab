// Imports calibrations in the formats of jscal, evemu, hwdb, evtest and SDL. The expected values
// are derived a second time: with the kernel's formula for jscal, by hand for the others.
#include "stick/calibration_import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "hid/evdev_layout.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

struct Pad {
  DeviceInfo device;
  PadLayout layout;
};

// An event node: X, Y, Z, Rz (two sticks), GAS and BRAKE (right and left trigger), a hat.
Pad pad_of(std::int32_t min, std::int32_t max) {
  const EvdevAbilities abilities{{{0x00, min, max},
                                  {0x01, min, max},
                                  {0x02, min, max},
                                  {0x05, min, max},
                                  {0x09, 0, 1023},
                                  {0x0a, 0, 1023},
                                  {0x10, -1, 1},
                                  {0x11, -1, 1}},
                                 {0x130, 0x131, 0x133, 0x134}};
  Pad pad;
  pad.device.bus = BusType::usb;
  pad.device.vendor = 0x1209;
  pad.device.product = 0x0001;
  pad.device.version = 0x0111;
  pad.device.driver = "evdev";
  pad.device.name = "Node";
  pad.device.descriptor = evdev_layout(abilities, {}).descriptor;
  pad.layout = value_of(pad_layout(pad.device, {}));
  return pad;
}

CalibrationFile imported(const std::string& text, const Pad& pad) {
  return value_of(calibration_import(text, "old.js", pad.device, pad.layout));
}
std::string error_of(const std::string& text, const Pad& pad) {
  return cause_of(calibration_import(text, "old.js", pad.device, pad.layout));
}

// Checks that the calibration can be written to a file and read back.
void expect_loadable(const CalibrationFile& file) {
  EXPECT_EQ(cause_of(parse_calibration(calibration_text(file), "back.toml")), "accepted");
}

// The broken line of Linux's drivers/input/joydev.c.
double joydev(const int (&c)[4], int count) {
  std::int64_t value = 0;
  if (count <= c[0]) value = (std::int64_t{c[2]} * (count - c[0])) >> 14;
  if (count >= c[1]) value = (std::int64_t{c[3]} * (count - c[1])) >> 14;
  if (count > c[0] && count < c[1]) value = 0;
  return static_cast<double>(std::clamp<std::int64_t>(value, -32767, 32767)) / 32767.0;
}

std::string jscal_line(const int (&x)[4], const int (&y)[4]) {
  const auto axis = [](const int(&c)[4]) {
    return ",1,0," + std::to_string(c[0]) + "," + std::to_string(c[1]) + "," +
           std::to_string(c[2]) + "," + std::to_string(c[3]);
  };
  return "jscal -s 8" + axis(x) + axis(y) + ",0,0,0,0,0,0,0,0,0,0,0,0 /dev/input/js0\n";
}
// The slope that jscal writes: 2^29 divided by the counts from the zone to the end.
int slope(int counts) { return (1 << 29) / counts; }

// The raw position (-1 to 1) of a count.
double raw(int count, int min, int max) { return (2.0 * count - min - max) / (max - min); }

TEST(CalibrationImport, AJscalLineMovesTheStickAsTheKernelDid) {
  const Pad pad = pad_of(0, 255);
  // x: 20 .. 240 about 130, y: 13 .. 233 about 123; the zone is 10 to either side.
  const int x[4] = {120, 140, slope(100), slope(100)}, y[4] = {113, 133, slope(100), slope(100)};
  CalibrationFile file = imported(jscal_line(x, y), pad);
  expect_loadable(file);
  StickCalibration c = file.calibration.left;
  EXPECT_NEAR(c.x.centre, raw(130, 0, 255), 1e-12);
  EXPECT_NEAR(c.x.min, raw(20, 0, 255), 1e-3);
  EXPECT_NEAR(c.x.max, raw(240, 0, 255), 1e-3);
  EXPECT_NEAR(c.y.centre, -raw(123, 0, 255), 1e-12) << "forward is towards smaller counts";
  EXPECT_NEAR(c.inner, 10.0 / 110.0, 1e-3);
  c.shape = ZoneShape::axial;
  for (int count = 0; count <= 255; ++count) {
    const vec2 across = stick_position(c, {raw(count, 0, 255), c.y.centre});
    EXPECT_NEAR(across.x, joydev(x, count), 2e-4) << count;
    EXPECT_EQ(across.y, 0.0);
    const vec2 along = stick_position(c, {c.x.centre, -raw(count, 0, 255)});
    EXPECT_NEAR(along.y, -joydev(y, count), 2e-4) << count;
  }
  EXPECT_EQ(file.calibration.right.x.max, 1.0) << "jscal did not correct this stick";
  EXPECT_EQ(file.calibration.right.inner, StickCalibration{}.inner);
}

// gaitpad has one zone for both sides and takes the wider one. Its output differs from the kernel's
// by less than the two zones do.
TEST(CalibrationImport, UnevenSidesMoveNearlyAsTheKernelDid) {
  const Pad pad = pad_of(-32768, 32767);
  const int x[4] = {-4500, 500, slope(20500), slope(28500)},
            y[4] = {-3000, 3000, slope(27000), slope(27000)};
  CalibrationFile file = imported("#!/bin/sh\n\n/usr/bin/" + jscal_line(x, y), pad);
  expect_loadable(file);
  StickCalibration c = file.calibration.left;
  EXPECT_NEAR(c.inner, 2500.0 / 23000.0, 1e-3);
  c.shape = ZoneShape::axial;
  for (int count = -32768; count <= 32767; count += 97) {
    const double ours = stick_position(c, {raw(count, -32768, 32767), c.y.centre}).x;
    EXPECT_NEAR(ours, joydev(x, count), 0.0307) << count;
    EXPECT_EQ(ours == 0.0 && count < -4500, false) << "the narrow side keeps its zone";
  }
}

TEST(CalibrationImport, ANegativeSlopeReversesTheAxis) {
  const Pad pad = pad_of(0, 255);
  const int x[4] = {118, 138, -slope(100), -slope(100)}, y[4] = {118, 138, slope(90), slope(90)};
  const CalibrationFile file = imported(jscal_line(x, y), pad);
  StickCalibration c = file.calibration.left;
  EXPECT_EQ(c.frame.right, RawDirection::minus_x);
  EXPECT_EQ(c.frame.forward, RawDirection::plus_y);
  c.shape = ZoneShape::axial;
  for (int count = 0; count <= 255; count += 5) {
    EXPECT_NEAR(stick_position(c, {raw(count, 0, 255), -raw(128, 0, 255)}).x, joydev(x, count),
                0.012)
        << count;
  }
  const StickAxes axes = stick_axes(file.calibration);
  EXPECT_EQ(axes[kLeftX].axis, kLeftX);
  EXPECT_TRUE(axes[kLeftX].reversed);
  EXPECT_FALSE(axes[kLeftY].reversed);
}

TEST(CalibrationImport, FramesSayWhichAxisMovesAStick) {
  Calibration c;
  c.right.frame = {RawDirection::minus_y, RawDirection::plus_x};
  const StickAxes axes = stick_axes(c);
  EXPECT_EQ(axes[kRightX].axis, kRightY);
  EXPECT_TRUE(axes[kRightX].reversed);
  EXPECT_EQ(axes[kRightY].axis, kRightX);
  EXPECT_FALSE(axes[kRightY].reversed);
  EXPECT_EQ(axes[kLeftX].axis, kLeftX);
}

// The map swaps codes 0 and 1, so the first correction belongs to Y.
TEST(CalibrationImport, MappedAxesOfJscalAreFollowed) {
  const Pad pad = pad_of(0, 255);
  const int a[4] = {100, 120, slope(80), slope(80)}, b[4] = {118, 138, slope(100), slope(100)};
  const std::string map = "jscal -u 8,1,0,2,5,9,10,16,17,4,304,305,307,308 /dev/input/js0\n";
  const CalibrationFile file = imported(map + jscal_line(a, b), pad);
  EXPECT_NEAR(file.calibration.left.y.centre, -raw(110, 0, 255), 1e-12);
  EXPECT_NEAR(file.calibration.left.x.centre, raw(128, 0, 255), 1e-12);
}

TEST(CalibrationImport, TriggersGetTheirEnds) {
  const Pad pad = pad_of(0, 255);
  // GAS is the fifth axis; it moves from 102 to 921 of 1023.
  const std::string axis =
      ",1,0,511,512," + std::to_string(slope(409)) + "," + std::to_string(slope(409));
  const CalibrationFile file = imported(
      "jscal -s 8,1,0,118,138,5368709,5368709,0,0,0,0,0,0" + axis + ",0,0,0,0,0,0 /dev/input/js0",
      pad);
  EXPECT_NEAR(file.calibration.right_trigger.released, 102.0 / 1023.0, 1e-3);
  EXPECT_NEAR(file.calibration.right_trigger.pressed, 921.0 / 1023.0, 1e-3);
  EXPECT_EQ(file.calibration.left_trigger.pressed, 1.0);
}

TEST(CalibrationImport, EvemuHwdbAndEvtestSayTheSame) {
  const Pad pad = pad_of(0, 255);
  const std::string evemu =
      "# EVEMU 1.3\nN: Node\nI: 0003 1209 0001 0111\nP: 00 00 00 00 00 00 00 00\n"
      "B: 00 0b 00 00 00 00 00 00 00\nA: 00 15 240 0 15 0\nA: 01 10 235 0 10 0\n"
      "A: 10 -1 1 0 0 0\n";
  const std::string hwdb =
      "# a remark\nevdev:input:b0003v1209p0001*\n EVDEV_ABS_00=15:240:::15\n"
      " EVDEV_ABS_01=10:235:0:0:10\n";
  const std::string evtest =
      "Input driver version is 1.0.1\nInput device ID: bus 0x3 vendor 0x1209\n"
      "  Event type 3 (EV_ABS)\n    Event code 0 (ABS_X)\n      Value    128\n"
      "      Min       15\n      Max      240\n      Flat      15\n"
      "    Event code 1 (ABS_Y)\n      Value    128\n      Min        10\n      Max      235\n"
      "      Fuzz        0\n      Flat      10\nProperties:\n";
  for (const std::string& text : {evemu, hwdb, evtest}) {
    const CalibrationFile file = imported(text, pad);
    expect_loadable(file);
    const StickCalibration& c = file.calibration.left;
    EXPECT_NEAR(c.x.min, 2.0 * 15 / 255 - 1.0, 1e-12);
    EXPECT_NEAR(c.x.max, 2.0 * 240 / 255 - 1.0, 1e-12);
    EXPECT_NEAR(c.x.centre, 0.0, 1e-12);
    EXPECT_NEAR(c.y.centre, -(2.0 * 122.5 / 255 - 1.0), 1e-12);
    EXPECT_NEAR(c.y.max, -(2.0 * 10 / 255 - 1.0), 1e-12);
    EXPECT_NEAR(c.inner, 15.0 / 112.5, 1e-12) << "the wider of the two zones";
    EXPECT_EQ(c.outer, StickCalibration{}.outer);
    EXPECT_EQ(file.calibration.right.inner, StickCalibration{}.inner);
  }
}

// Kernel drivers that do not know the zone report a flat of 0 (hid-playstation).
TEST(CalibrationImport, AFlatOfZeroOrOneLeavesAnInnerZone) {
  const CalibrationFile file = imported("A: 00 0 255 0 0 0\nA: 01 0 255 0 0 0\n", pad_of(0, 255));
  EXPECT_EQ(file.calibration.left.inner, kInnerZoneUnknown);
  const CalibrationFile narrow = imported("A: 00 0 255 0 1 0\nA: 01 0 255 0 1 0\n", pad_of(0, 255));
  EXPECT_EQ(narrow.calibration.left.inner, 0.05);
}

TEST(CalibrationImport, AnSdlMappingIsKeptWordForWord) {
  const Pad pad = pad_of(0, 255);
  const std::string line =
      "03000000091200000100000011010000,Node,a:b1,b:b0,leftx:a0,lefty:a1,rightx:a2,righty:a3,"
      "platform:Linux,";
  const std::string other = "030000005e0400008e02000014010000,X360 Controller,a:b0,platform:Linux,";
  const std::string mac = "03000000091200000100000000000000,Node,a:b2,leftx:a0,platform:Mac OS X,";
  const CalibrationFile file =
      imported("# mine\r\n" + mac + "\n" + other + "\n" + line + "\r\n", pad);
  EXPECT_EQ(file.mapping, line);
  EXPECT_EQ(file.calibration.left.inner, StickCalibration{}.inner);
  EXPECT_EQ(error_of(other, pad),
            "old.js:1: SDL mapping: it is for 045e:028e, the pad is 1209:0001");
  EXPECT_EQ(error_of(other + "\n" + other, pad),
            "old.js: none of its 2 SDL mappings is for 1209:0001");
  EXPECT_EQ(error_of("\n" + mac, pad),
            "old.js:2: SDL mapping: it is for another platform, which counts otherwise");
  EXPECT_EQ(error_of("03000000091200000100000011010000,Node,a:q1,platform:Linux,", pad),
            "old.js:1: SDL mapping: unknown source \"q1\"");
  EXPECT_EQ(error_of("03000000091200000100000011010000,No\001de,a:b1,platform:Linux,", pad),
            "old.js:1: SDL mapping: it holds a control character");
  EXPECT_EQ(error_of("03000000091200000100000011010000,Node,a:b99,platform:Linux,", pad),
            "old.js:1: SDL mapping: it names no control that the pad has");
  EXPECT_EQ(error_of("03000000091200000100000011810000,Node,a:b1,platform:Linux,", pad),
            "old.js:1: SDL mapping: it counts what the kernel's driver for that pad numbers; give "
            "its event node (/dev/input/event...)");
}

TEST(CalibrationImport, ExportedLinesCanBeImported) {
  const Pad pad = pad_of(0, 255);
  Calibration calibration;
  calibration.left.frame = {RawDirection::minus_x, RawDirection::plus_y};
  const auto line = sdl_mapping_text(pad.device, pad.layout, stick_axes(calibration));
  ASSERT_TRUE(line);
  EXPECT_NE(line->find(",leftx:a0~,"), std::string::npos) << *line;
  EXPECT_EQ(imported(*line + "\n", pad).mapping, *line);
}

TEST(CalibrationImport, ErrorsNameTheDamagedLine) {
  const Pad pad = pad_of(0, 255);
  const auto line = [](const std::string& list) {
    return "\njscal -s " + list + " /dev/input/js0";
  };
  const std::string x = "1,0,118,138,5368709,5368709", rest = ",0,0,0,0,0,0,0,0,0,0,0,0,0,0";
  EXPECT_EQ(error_of(line("8," + x + rest), pad), "accepted");
  EXPECT_EQ(error_of(line("8," + x), pad), "old.js:2: jscal: axis 1: numbers are missing");
  EXPECT_EQ(error_of(line("8," + x + rest + ",0"), pad),
            "old.js:2: jscal: more numbers than its axes have");
  EXPECT_EQ(error_of(line("2," + x + ",0,0"), pad), "old.js:2: jscal: 2 axes, the pad has 8");
  EXPECT_EQ(error_of(line("8,2,0" + rest), pad), "old.js:2: jscal: axis 0: unknown type 2");
  EXPECT_EQ(error_of(line("0"), pad), "old.js:2: jscal: 0 axes, 1 to 64 there may be");
  EXPECT_EQ(error_of(line("8,nan"), pad), "old.js:2: jscal: \"nan\" is no number");
  EXPECT_EQ(error_of(line("8,99999999999"), pad), "old.js:2: jscal: \"99999999999\" is no number");
  EXPECT_EQ(error_of("jscal -s", pad), "old.js:1: jscal: no numbers");
  EXPECT_EQ(error_of(line("8,0,0" + rest), pad),
            "old.js:2: jscal: no axis of a stick is corrected");
  EXPECT_EQ(error_of(line("8,1,0,138,118,5368709,5368709" + rest), pad),
            "old.js:2: jscal: axis 0: its centre begins at 138 and ends at 118");
  EXPECT_EQ(error_of(line("8,1,0,118,138,0,5368709" + rest), pad),
            "old.js:2: jscal: axis 0: slopes 0 and 5368709 do not go one way");
  EXPECT_EQ(error_of(line("8,1,0,2000,2100,53687,53687" + rest), pad),
            "old.js:2: jscal: axis 0: its centre 2050 is outside of the pad's 0 to 255");
  EXPECT_EQ(
      error_of(line("8,1,0,127,129,536870912,536870912" + rest), pad),
      "old.js:2: jscal: axis 0: 126 to 130 about 128 is next to nothing of the pad's 0 to 255");
  EXPECT_EQ(error_of(line("8,1,0,20,230,53687091,53687091" + rest), pad),
            "old.js:2: jscal: axis 0: hardly anything is left beside its zone from 20 to 230");
  EXPECT_EQ(error_of(line("8," + x + rest) + line("8," + x + rest), pad),
            "old.js:3: jscal: told a second time");
  EXPECT_EQ(error_of("jscal -u 8,1,0,99,5,9,10,16,17,0", pad),
            "old.js:1: jscal: 99 is no code of an axis");
  EXPECT_EQ(error_of("A: 00 0 255 0 15 0\nA: 00 0 255 0 15 0", pad),
            "old.js:2: axis 00: told a second time");
  EXPECT_EQ(error_of("A: 00 0 x 0 15 0", pad), "old.js:1: axis 00: \"x\" is no number");
  EXPECT_EQ(error_of("A: 00 255 0 0 15 0", pad), "old.js:1: axis 00: 255 to 0 is no range");
  EXPECT_EQ(error_of("A: 00 -32768 32767 0 15 0", pad),
            "old.js:1: axis 00: -32768 to 32767 is more than the pad's 0 to 255");
  EXPECT_EQ(error_of("A: 10 -1 1 0 0 0", pad), "old.js: no axis of a stick of this pad");
  EXPECT_EQ(error_of("EVDEV_ABS_00=0:255:0:0:15:1", pad),
            "old.js:1: EVDEV_ABS_00: more than five numbers");
  EXPECT_EQ(error_of("I: 0003 054c 0ce6 8111\nA: 00 0 255 0 15 0", pad),
            "old.js: it is of 054c:0ce6, the pad is 1209:0001");
  EXPECT_EQ(error_of("A: 00 0 255 0 15 0" + line("8," + x + rest), pad),
            "old.js: of several tools; give one at a time");
  for (const char* nothing : {"", "\n\n# only a remark\n", "hello", "jscal -p /dev/input/js0"}) {
    EXPECT_EQ(error_of(nothing, pad),
              "old.js: no line of jscal, no axis of evemu, evtest or a hwdb file, no SDL mapping");
  }
  EXPECT_EQ(error_of(std::string((1 << 20) + 1, '#'), pad),
            "old.js: 1048577 bytes, at most 1048576 are read");
}

TEST(CalibrationImport, CountsOfAKernelDriverAreRefusedForAHidrawPad) {
  Pad pad = pad_of(0, 255);
  pad.device.driver = "hidraw";
  pad.device.version = 0x8111;
  EXPECT_EQ(error_of("A: 00 0 255 0 15 0", pad),
            "Node: a kernel driver of its own numbers its controls; give its event node "
            "(/dev/input/event...)");
}

// Valid texts with a few bytes changed, cut out or doubled must not crash the import. Accepted
// calibrations can be saved.
TEST(CalibrationImport, DamagedTextsDoNotCrash) {
  const Pad pads[] = {pad_of(0, 255), pad_of(-32768, 32767)};
  const std::string seeds[] = {
      "jscal -u 8,1,0,2,5,9,10,16,17,4,304,305,307,308 /dev/input/js0\n"
      "jscal -s 8,1,0,118,138,5368709,5368709,1,0,118,138,5368709,5368709,0,0,0,0,0,0,0,0,0,0,0,0 "
      "x",
      "I: 0003 1209 0001 0111\nA: 00 15 240 0 15 0\nA: 01 10 235 0 10 0\nA: 02 10 235 0 10 0\n",
      " EVDEV_ABS_00=15:240:::15\n EVDEV_ABS_01=10:235:0:0:10\n",
      "Event type 3 (EV_ABS)\nEvent code 0 (ABS_X)\n Value 128\n Min 15\n Max 240\n Flat 15\n",
      "03000000091200000100000011010000,Node,a:b1,b:b0,leftx:a0,lefty:a1,platform:Linux,\n"};
  constexpr std::string_view kBytes = "0123456789-,: \nabAE.~+\x00\xff(";
  std::mt19937 random(11);
  int accepted = 0;
  for (int i = 0; i < 15000; ++i) {
    std::string text = seeds[random() % std::size(seeds)];
    for (unsigned k = random() % 4; k > 0 && !text.empty(); --k) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = kBytes[random() % kBytes.size()];
          break;
        case 1:
          text.erase(at, random() % 8);
          break;
        case 2: {
          const std::size_t from = random() % text.size();
          text.insert(at, text.substr(from, random() % 12));
          break;
        }
        default:
          text.insert(at, 1, kBytes[random() % kBytes.size()]);
      }
    }
    const Pad& pad = pads[random() % 2];
    const auto file = calibration_import(text, "junk", pad.device, pad.layout);
    if (!file) {
      ASSERT_EQ(file.error().message.find('\n'), std::string::npos) << file.error().message;
      continue;
    }
    ++accepted;
    const auto back = parse_calibration(calibration_text(*file), "back.toml");
    ASSERT_TRUE(back) << text << "\n" << back.error().message;
    const vec2 p = stick_position(file->calibration.left, {0.3, -0.9});
    ASSERT_LE(p.x * p.x + p.y * p.y, 1.0 + 1e-9);
  }
  EXPECT_GT(accepted, 250);
}

}  // namespace
}  // namespace gaitpad
