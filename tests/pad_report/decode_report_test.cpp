#include "pad_report/decode_report.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/made_pad.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

DecodedDevice device() {
  DecodedDevice device;
  device.source.info = made_pad();
  device.layout = value_of(pad_layout(device.source.info, PadOverrides{}));
  return device;
}

// X to the right end, the other axes in the middle, the hat released, buttons 1 and 3.
Report report() {
  Report report;
  constexpr std::array<std::uint8_t, 6> kBytes = {0xff, 0x80, 0x80, 0x80, 0x58, 0x00};
  std::ranges::copy(kBytes, report.bytes.begin());
  report.size = kBytes.size();
  report.time_ns = 1'500'000'000;
  return report;
}

TEST(DecodeReport, EqualNeighboursInADescriptorAreOneRow) {
  const std::string text = descriptor_text(device());
  EXPECT_EQ(text.rfind("device 0: Example Walk Pad (bus 3, 1209:0001), a pad, ", 0), 0u) << text;
  // The four axes are of different usages; so are the twelve buttons.
  EXPECT_EQ(std::ranges::count(text, '\n'), 2 + 4 + 1 + 12) << text;
}

TEST(DecodeReport, JsonListsEachFieldWithItsPlace) {
  const auto json = descriptor_json(device());
  EXPECT_EQ(json["device"]["vendor"], 0x1209);
  EXPECT_EQ(json["pad"], true);
  ASSERT_EQ(json["fields"].size(), 4u + 1u + 12u);
  EXPECT_EQ(json["fields"][1]["bit_offset"], 8);
  EXPECT_EQ(json["fields"][1]["bit_size"], 8);
  EXPECT_EQ(json["fields"][1]["usage"], 0x31);
  EXPECT_EQ(json["fields"][1]["logical_max"], 255);
}

TEST(DecodeReport, AReportHasItsValuesByUsageAndTheDecodedPad) {
  DecodedDevice made = device();
  const Report sent = report();
  ASSERT_TRUE(decode(made.layout, sent, made.state));
  const auto json = report_json(made, sent, true);
  EXPECT_EQ(json["time_s"], 1.5);
  EXPECT_EQ(json["values"]["0001:0030"], 255) << json;
  EXPECT_EQ(json["axes"]["left_x"], 1.0);
  EXPECT_EQ(json["buttons"].size(), 2u) << json;
  EXPECT_FALSE(json.contains("bad"));
  const std::string text = report_text(made, sent, true);
  EXPECT_EQ(text.rfind("    1.500000 device 0 report  0  left +1.000 ", 0), 0u) << text;
  EXPECT_EQ(text.back(), '\n');
}

TEST(DecodeReport, AReportThatTheDeviceCannotSendIsMarkedAndHasNoValues) {
  const DecodedDevice made = device();
  Report cut = report();
  cut.size = 2;
  const auto json = report_json(made, cut, false);
  EXPECT_EQ(json["bad"], true);
  EXPECT_TRUE(json["values"].empty());
  EXPECT_TRUE(json["buttons"].empty());
  EXPECT_NE(report_text(made, cut, false).find("2 bytes: too short, or an unknown id"),
            std::string::npos);
}

TEST(DecodeReport, WhatABatteryDoesNotReportIsNull) {
  EXPECT_TRUE(battery_json(std::nullopt).is_null());
  Battery battery;
  battery.percent = 40;
  const auto json = battery_json(battery);
  EXPECT_EQ(json["percent"], 40);
  EXPECT_TRUE(json["level"].is_null());
}

}  // namespace
}  // namespace gaitpad
