// Imports calibrations from recordings of event nodes and from lines of SDL. The expected values
// are derived by hand.
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

// A pad with an event node: X, Y, Z, Rz (two sticks), GAS and BRAKE (right and left trigger), a
// hat.
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
  return value_of(calibration_import(text, "bug.txt", pad.device, pad.layout));
}
std::string error_of(const std::string& text, const Pad& pad) {
  return cause_of(calibration_import(text, "bug.txt", pad.device, pad.layout));
}

// Checks that the calibration can be written to a file and read back.
void expect_loadable(const CalibrationFile& file) {
  EXPECT_EQ(cause_of(parse_calibration(calibration_text(file), "back.toml")), "accepted");
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

// The file that evemu-record writes for a node with these ranges. The map swaps codes 0 and 1, so
// the first correction belongs to Y.
std::string evemu(const std::string& ranges) {
  return "# EVEMU 1.3\nN: Node\nI: 0003 1209 0001 0111\nP: 00 00 00 00 00 00 00 00\n"
         "B: 00 0b 00 00 00 00 00 00 00\n" +
         ranges;
}

TEST(CalibrationImport, TriggersGetTheirEnds) {
  const CalibrationFile file = imported(
      evemu("A: 00 0 255 0 15 0\nA: 01 0 255 0 15 0\nA: 09 102 921 0 0 0\n"), pad_of(0, 255));
  EXPECT_NEAR(file.calibration.right_trigger.released, 102.0 / 1023.0, 1e-3);
  EXPECT_NEAR(file.calibration.right_trigger.pressed, 921.0 / 1023.0, 1e-3);
  EXPECT_EQ(file.calibration.left_trigger.pressed, 1.0);
}

// A file of libinput. The recording of a pad of hid-playstation also has the motion sensors: the
// same ids, other ranges.
const std::string kLibinput =
    "# libinput record\ndevices:\n"
    "- node: /dev/input/event6\n  evdev:\n    name: \"Node Motion Sensors\"\n"
    "    id: [3, 4617, 1, 273]\n    codes:\n      3: [0, 1] # EV_ABS\n    absinfo:\n"
    "      0: [-32768, 32767, 16, 0, 8192]\n      1: [-32768, 32767, 16, 0, 8192]\n"
    "- node: /dev/input/event5\n  evdev:\n    name: \"Node\"\n    id: [3, 4617, 1, 273]\n"
    "    codes:\n      3: [0, 1] # EV_ABS\n    absinfo:\n"
    "      0: [15, 240, 0, 15, 0]\n      1: [10, 235, 0, 10, 0]\n  events:\n";
// 15, 240, 0, 15 and 10, 235, 0, 10 as umockdev has them.
const std::string kUmockdev =
    "@DEV /dev/input/event5\nEVIOCGID 0 0300091201001101\n"
    "EVIOCGABS 0 800000000F000000F0000000000000000F00000000000000\n"
    "EVIOCGABS(1) 0 800000000A000000EB000000000000000A00000000000000\n";

TEST(CalibrationImport, RecordingsOfEveryToolSayTheSame) {
  const Pad pad = pad_of(0, 255);
  const std::string ranges = "A: 00 15 240 0 15 0\nA: 01 10 235 0 10 0\nA: 10 -1 1 0 0 0\n";
  for (const std::string& text : {evemu(ranges), kLibinput, kUmockdev}) {
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
  const CalibrationFile file =
      imported(evemu("A: 00 0 255 0 0 0\nA: 01 0 255 0 0 0\n"), pad_of(0, 255));
  EXPECT_EQ(file.calibration.left.inner, kInnerZoneUnknown);
  const CalibrationFile narrow =
      imported(evemu("A: 00 0 255 0 1 0\nA: 01 0 255 0 1 0\n"), pad_of(0, 255));
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
            "bug.txt:1: SDL mapping: it is for 045e:028e, the pad is 1209:0001");
  EXPECT_EQ(error_of(other + "\n" + other, pad),
            "bug.txt: none of its 2 SDL mappings is for 1209:0001");
  EXPECT_EQ(
      error_of("\n" + mac, pad),
      "bug.txt:2: SDL mapping: it is for another platform, where controls have other numbers");
  EXPECT_EQ(error_of("03000000091200000100000011010000,Node,a:q1,platform:Linux,", pad),
            "bug.txt:1: SDL mapping: unknown source \"q1\"");
  EXPECT_EQ(error_of("03000000091200000100000011010000,No\001de,a:b1,platform:Linux,", pad),
            "bug.txt:1: SDL mapping: it holds a control character");
  EXPECT_EQ(error_of("03000000091200000100000011010000,Node,a:b99,platform:Linux,", pad),
            "bug.txt:1: SDL mapping: it names no control that the pad has");
  EXPECT_EQ(error_of("03000000091200000100000011810000,Node,a:b1,platform:Linux,", pad),
            "bug.txt:1: SDL mapping: it counts what the kernel's driver for that pad numbers; give "
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
  const auto error = [&pad](const std::string& ranges) { return error_of(evemu(ranges), pad); };
  EXPECT_EQ(error("A: 00 0 255 0 15 0"), "accepted");
  EXPECT_EQ(error("A: 00 0 255 0 15 0\nA: 00 0 255 0 15 0"),
            "bug.txt:7: a second range for the axis 00");
  EXPECT_EQ(error("A: 00 0 x 0 15 0"),
            "bug.txt:6: an A: line holds a code, a minimum and a maximum");
  EXPECT_EQ(error("A: 00 255 0 0 15 0"), "bug.txt:6: axis 00: the range 255 to 0 is empty");
  EXPECT_EQ(error("A: 00 -32768 32767 0 15 0"),
            "bug.txt:6: axis 00: the range -32768 to 32767 is wider than the pad's 0 to 255");
  EXPECT_EQ(error("A: 00 126 130 0 0 0"),
            "bug.txt:6: axis 00: the range 126 to 130 about 128 is too small a part of the pad's 0 "
            "to 255");
  EXPECT_EQ(error("A: 00 20 230 0 104 0"),
            "bug.txt:6: axis 00: its dead zone from 21 to 229 leaves hardly any range");
  EXPECT_EQ(error("A: 00 300 500 0 0 0"),
            "bug.txt:6: axis 00: its centre 400 is outside of the pad's 0 to 255");
  EXPECT_EQ(error("A: 10 -1 1 0 0 0"), "bug.txt: it states no axis of this pad's sticks");
  EXPECT_EQ(error_of("# EVEMU 1.3\nI: 0003 054c 0ce6 8111\nA: 00 0 255 0 15 0", pad),
            "bug.txt: it was recorded from 054c:0ce6, the pad is 1209:0001");
  for (const char* nothing : {"", "\n\n# only a remark\n", "hello", "A: 00 0 255 0 15 0"}) {
    EXPECT_EQ(error_of(nothing, pad),
              "bug.txt: no SDL mapping, and not a recording of evemu, libinput or umockdev");
  }
  EXPECT_EQ(error_of(std::string((1 << 20) + 1, '#'), pad),
            "bug.txt: 1048577 bytes, at most 1048576 are read");
}

TEST(CalibrationImport, CountsOfAKernelDriverAreRefusedForAHidrawPad) {
  Pad pad = pad_of(0, 255);
  pad.device.driver = "hidraw";
  pad.device.version = 0x8111;
  EXPECT_EQ(error_of(evemu("A: 00 0 255 0 15 0"), pad),
            "Node: a kernel driver of its own numbers its controls; give its event node "
            "(/dev/input/event...)");
}

// Valid texts with a few bytes changed, cut out or doubled must not crash the import. Accepted
// calibrations can be saved.
TEST(CalibrationImport, DamagedTextsDoNotCrash) {
  const Pad pads[] = {pad_of(0, 255), pad_of(-32768, 32767)};
  const std::string seeds[] = {
      evemu("A: 00 15 240 0 15 0\nA: 01 10 235 0 10 0\nA: 02 10 235 0 10 0\n"), kLibinput,
      kUmockdev,
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
