#include "hid/evemu.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <span>

#include "gaitpad/decode.h"
#include "tests/hid/made_pads.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

// Output of evemu-record: X, Y of 0..255, a trigger, a hat, BTN_SOUTH and BTN_EAST.
const std::string kHeader =
    "# EVEMU 1.3\n"
    "# Kernel: 6.1.0-56-amd64\n"
    "# Input device name: \"Acme Wireless Controller\"\n"
    "N: Acme Wireless Controller\n"
    "I: 0003 054c 09cc 8111\n"
    "P: 00 00 00 00 00 00 00 00\n"
    "B: 00 0b 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 03 00\n"  // fifth row, byte 6: bits from 0x130 on
    "B: 03 07 00 03 00 00 00 00 00\n"
    "A: 00 0 255 0 15 0\n"
    "A: 01 0 255 0 15 0\n"
    "A: 02 0 255 0 0 0\n"
    "A: 10 -1 1 0 0 0\n"
    "A: 11 -1 1 0 0 0\n"
    "################################\n";

std::string event(const char* time, int type, int code, int value) {
  return fmt::format("E: {} {:04x} {:04x} {:04d}\t# EV_ABS / ABS_X {}\n", time, type, code, value,
                     value);
}
std::string syn(const char* time) { return event(time, 0, 0, 0); }

Trace parsed(const std::string& text) { return value_of(parse_trace(text, "ds4.evemu")); }

// The pad after each report of the trace's first device.
std::vector<PadState> states(const Trace& trace) {
  const PadLayout layout = value_of(pad_layout(trace.devices.front().info, shipped_pads()));
  std::vector<PadState> states;
  PadState state;
  for (const TraceEvent& e : trace.events) {
    if (e.kind != ReportKind::input) continue;
    EXPECT_TRUE(decode(layout, report_of(trace, e), state));
    states.push_back(state);
  }
  return states;
}

// X, Y of 8 bits, a hat and eight buttons: four bytes a report.
DeviceInfo made_simple_pad() {
  DeviceInfo info;
  info.bus = BusType::usb;
  info.vendor = 0x1209;
  info.product = 0x0001;
  info.name = "Example Simple Pad";
  info.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08,
                     0x95, 0x02, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02, 0x25, 0x07, 0x75, 0x04, 0x95,
                     0x01, 0x09, 0x39, 0x81, 0x42, 0x75, 0x04, 0x95, 0x01, 0x81, 0x03, 0x05, 0x09,
                     0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x19, 0x01, 0x29, 0x08, 0x81, 0x02, 0xc0};
  return info;
}

Trace trace_of(const std::vector<std::vector<std::uint8_t>>& reports) {
  Trace trace;
  trace.devices.emplace_back().info = made_simple_pad();
  for (const std::vector<std::uint8_t>& bytes : reports) {
    TraceEvent& e = trace.events.emplace_back();
    e.device = 0;
    e.time_us = 4000 * static_cast<std::int64_t>(trace.events.size());
    e.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
    e.size = static_cast<std::uint16_t>(bytes.size());
    trace.bytes.insert(trace.bytes.end(), bytes.begin(), bytes.end());
  }
  return trace;
}

TEST(Evemu, IsATraceOfTheEvdevDriver) {
  const Trace trace = parsed(kHeader + event("0.000001", 3, 0, 255) + event("0.000001", 3, 1, 0) +
                             syn("0.000001") + event("0.004012", 1, 0x130, 1) + syn("0.004012"));
  ASSERT_EQ(trace.devices.size(), 1u);
  const DeviceInfo& info = trace.devices[0].info;
  EXPECT_EQ(info.name, "Acme Wireless Controller");
  EXPECT_EQ(info.bus, BusType::usb);
  EXPECT_EQ(info.vendor, 0x054c);
  EXPECT_EQ(info.product, 0x09cc);
  EXPECT_EQ(info.version, 0x8111);
  EXPECT_EQ(info.driver, "evdev");
  const auto seen = states(trace);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(trace.events[1].time_us, 4012);
  EXPECT_EQ(seen[0].axis[kLeftX], 1.0f);
  EXPECT_EQ(seen[0].axis[kLeftY], 1.0f) << "0 is forward";
  EXPECT_FALSE(pressed(seen[0], kButtonA));
  EXPECT_TRUE(pressed(seen[1], kButtonA));
  EXPECT_FALSE(pressed(seen[1], kButtonB));
}

TEST(Evemu, AnAxisBeginsWithItsFirstEventOrInItsMiddle) {
  const auto seen = states(parsed(kHeader + event("0.000001", 1, 0x130, 1) + syn("0.000001") +
                                  event("0.100000", 3, 1, 51) + syn("0.100000")));
  EXPECT_NEAR(seen[0].axis[kLeftX], 0.0f, 0.01f) << "it has none";
  EXPECT_EQ(seen[0].axis[kLeftY], seen[1].axis[kLeftY]);
  EXPECT_NEAR(seen[0].axis[kLeftY], 0.6f, 1e-6f);
}

TEST(Evemu, DamageIsOneSentenceWithItsLine) {
  const auto cause = [](const std::string& text) {
    return cause_of(parse_trace(text, "ds4.evemu"));
  };
  EXPECT_EQ(cause(kHeader + "E: 0.1 0003 0000 0127\n"),
            "ds4.evemu:20: an E: line holds SECONDS.MICROSECONDS, a type, a code and a value");
  EXPECT_EQ(cause("# EVEMU 1.3\nI: 0003 054c 09cc\n"),
            "ds4.evemu:2: an I: line holds bus, vendor, product and version as hexadecimal numbers "
            "of up to four digits");
  EXPECT_EQ(cause(kHeader + syn("2.000000") + syn("1.000000")),
            "ds4.evemu:21: time goes back to 1.000000");
  EXPECT_EQ(cause(kHeader + "A: 00 0 255 0 15 0\n"),
            "ds4.evemu:20: a second range for the axis 00");
  EXPECT_EQ(cause("# EVEMU 1.3\nN: x\n"), "ds4.evemu: no device with an axis or a key");
  EXPECT_EQ(cause("# EVEMU 1.3\nN: a\rb\n"), "ds4.evemu:2: a carriage return inside the line");
  const Trace lenient = value_of(parse_trace(kHeader + "x\n" + syn("0.000001"), "t", Damage::skip));
  EXPECT_EQ(lenient.skipped_lines, 1);
  EXPECT_EQ(lenient.events.size(), 1u);
}

TEST(Evemu, WrittenFromReportsHasTheKernelsCodes) {
  const Trace trace =
      trace_of({{0x80, 0x80, 0x08, 0}, {0xff, 0x80, 0x02, 1}, {0xff, 0x80, 0x02, 1}});
  const std::string text = value_of(evemu_text(trace));
  EXPECT_NE(text.find("\nI: 0003 1209 0001 0000\n"), text.npos) << text;
  EXPECT_NE(text.find("\nA: 00 0 255 0 15 0\n"), text.npos)
      << "256 counts >> 8 and >> 4, as hid-input";
  EXPECT_NE(text.find("\nA: 10 -1 1 0 0 0\n"), text.npos);
  EXPECT_NE(text.find("\nE: 0.000001 0003 0000 0128\nE: 0.000001 0003 0001 0128\nE: 0.000001 0000 "
                      "0000 0000\n"),
            text.npos);
  EXPECT_TRUE(
      text.ends_with("E: 0.004001 0003 0000 0255\nE: 0.004001 0003 0010 0001\nE: 0.004001 "
                     "0001 0130 0001\nE: 0.004001 0000 0000 0000\n"))
      << "the third report changes nothing" << text;
}

TEST(Evemu, WrittenAndReadAgainItIsTheSamePad) {
  std::vector<std::vector<std::uint8_t>> reports;
  for (int i = 1; i < 200; ++i) {
    const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
    reports.push_back({byte(i), byte(255 - i), byte(i % 9), byte(i)});
  }
  const Trace trace = trace_of(reports);
  const auto before = states(trace), after = states(parsed(value_of(evemu_text(trace))));
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace gaitpad
