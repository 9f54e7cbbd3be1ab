// What is written must be what SDL's data base says of the same pads (lines made by other people on
// other machines) and what the reader reads back.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "gaitpad/trace.h"
#include "hid/sdl_mapping.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

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
      if (!layout || !layout->is_pad) continue;
      pads.push_back({path, trace->devices[0].info, std::move(*layout)});
    }
  }
  return pads;
}

// Control to its sources.
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

// The buttons that a line tells of.
std::uint32_t told(const Controls& controls) {
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
  for (int i = 0; i < 2000; ++i) {
    for (const ReportLayout& r : pad.layout.reports) {
      const Report report = random_report(r, random);
      // A replaced report is not what the kernel reads.
      if (!layout_of(pad.layout, report)->exact_sizes.empty()) continue;
      ASSERT_TRUE(decode(pad.layout, report, own));
      ASSERT_TRUE(decode(*layout, report, read_back));
      for (int a = 0; a < kAxisCount; ++a) {
        constexpr std::array<const char*, kAxisCount> kNames = {
            "leftx", "lefty", "rightx", "righty", "lefttrigger", "righttrigger"};
        if (!controls.count(kNames[a])) continue;
        ASSERT_EQ(own.axis[a], read_back.axis[a]) << kNames[a];
      }
      ASSERT_EQ(own.buttons & told(controls), read_back.buttons & told(controls));
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

// Lines of the data base for the same bus and ids whose version has no kernel mark: these count the
// pad's own controls, as the recordings here do.
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
    // Its only line leaves the sticks out, which the pad's own descriptor has.
    const bool is_pokken = pad.device.vendor == 0x0f0d && pad.device.product == 0x0092;
    EXPECT_TRUE(is_known || is_pokken || lines.empty()) << pad.path << "\n" << *line;
  }
  // Least significant byte first: DualShock 4, DualSense, Edge, Dual Action and F310, PlayStation
  // Classic, DualShock 3, Xbox One S, Elite 2 and Series on Bluetooth.
  for (const char* ids : {"4c05cc09", "4c05e60c", "4c05f20d", "6d0416c2", "4c05da0c", "4c056802",
                          "5e04fd02", "5e04050b", "5e04130b"}) {
    EXPECT_TRUE(agreed.count(ids)) << ids;
  }
}

// As the evdev driver states the node of a DualSense under hid-playstation.
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

// The data base's own line, `030000004c050000e60c000011810000,PS5 Controller,...`.
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
  sticks[kLeftX] = {kLeftX, true};     // right is where the layout's x falls
  sticks[kRightX] = {kRightY, false};  // right is where the layout says forward
  sticks[kRightY] = {kRightX, true};   // forward is where the layout says left
  const auto line = sdl_mapping_text(pad.device, pad.layout, sticks);
  ASSERT_TRUE(line);
  const Controls controls = controls_of(*line);
  EXPECT_EQ(controls.at("leftx"), std::set<std::string>{"a0~"});
  EXPECT_EQ(controls.at("lefty"), std::set<std::string>{"a1"});
  // ABS_RY grows towards the thumb's owner, who holds "forward" as its low end: right falls with
  // it.
  EXPECT_EQ(controls.at("rightx"), std::set<std::string>{"a4~"});
  // SDL's righty grows backwards, which is where x grows.
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

// Written, read and written again: every form that a line can have.
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

// SDL 2.26: bus, checksum 0, then the name where there are no ids.
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
}

}  // namespace
}  // namespace gaitpad
