#include "drivers/pads/recorded_packets.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "drivers/driver_rows.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

using Packet = std::vector<std::uint8_t>;

// A recording's head for a wired Steam Controller: hid-steam.c's collection ff00:0001 of 64 bytes
// without ids.
const std::string kSteam =
    "R: 21 06 00 ff 09 01 a1 01 15 00 26 ff 00 75 08 95 40 09 01 81 02 c0\nN: Steam\nI: 3 28de "
    "1102\n";
// A recording's head for the controller over Bluetooth: report 3 of 19 bytes (SDL_hidapi_steam.c).
const std::string kBluetooth =
    "R: 18 06 00 ff 09 01 a1 01 85 03 75 08 95 13 09 01 81 02 c0\nN: Steam\nI: 5 28de 1106\n";
const std::string kAdapter = "R: 7 05 01 09 05 a1 01 c0\nN: Pad\nI: 3 1209 0001\n";

std::string report_line(int ms, Packet bytes, std::size_t size) {
  bytes.resize(size);
  char time[32];
  std::snprintf(time, sizeof time, "E: %06d.%06d %zu", ms / 1000, ms % 1000 * 1000, size);
  std::string line = time;
  for (const std::uint8_t byte : bytes) {
    char hex[4];
    std::snprintf(hex, sizeof hex, " %02x", byte);
    line += hex;
  }
  return line + "\n";
}

Trace accepted(const std::string& text) {
  Trace trace = value_of(parse_trace(text, "t.hid"));
  accept_packets(trace);
  return trace;
}

Packet bytes_of(const Trace& trace, std::size_t event) {
  const TraceEvent& e = trace.events.at(event);
  const auto first = trace.bytes.begin() + e.first_byte;
  return {first, first + e.size};
}

// Type 4 is the battery (hid-steam.c), type 1 a state.
TEST(RecordedPackets, ABatteryMessageIsNoStateOfTheStick) {
  const Trace trace =
      accepted(kSteam + report_line(0, {1, 0, 1, 0x3c, 7}, 64) +
               report_line(4, {1, 0, 4, 0x0b, 9}, 64) + report_line(8, {1, 0, 1, 0x3c, 8}, 64));
  ASSERT_EQ(trace.events.size(), 2u);
  EXPECT_EQ(bytes_of(trace, 1)[4], 8);
  EXPECT_EQ(trace.events[1].time_us, 8000);
}

// The same segment as in SteamBluetooth.AStateIsPutTogetherFromWhatChanged.
const Packet kStickSegment = {3, 0xc0, 0xb4, 0, 0x80, 0, 0x40, 7, 9, 0xff, 0x7f, 0, 0x80},
             kPadSegment = {3, 0xc0, 0x04, 2, 1, 2, 3, 4};

TEST(RecordedPackets, SegmentsBecomeTheStateThatTheyMake) {
  const Trace trace =
      accepted(kBluetooth + report_line(0, kStickSegment, 20) + report_line(4, kPadSegment, 20));
  ASSERT_EQ(trace.events.size(), 2u);
  const Packet state = {3, 0x80, 0, 0x40, 7, 9, 0xff, 0x7f, 0, 0x80, 1, 2, 3, 4, 0, 0, 0, 0};
  EXPECT_EQ(bytes_of(trace, 1), state);
  // Older recordings contain complete states.
  EXPECT_EQ(bytes_of(accepted(kBluetooth + report_line(0, state, 18)), 0), state);
}

TEST(RecordedPackets, ASessionAndOtherDriversStayAsTheyAre) {
  const std::string battery = report_line(0, {1, 0, 4, 0x0b, 9}, 64);
  EXPECT_EQ(accepted("V: 1 rate_hz=240\n" + kSteam + "T: 0\n" + battery).events.size(), 1u);
  EXPECT_EQ(accepted(kSteam + "B: evdev\n" + battery).events.size(), 1u);
  EXPECT_EQ(accepted(kSteam + "B: hidraw\n" + battery).events.size(), 0u);
  EXPECT_EQ(accepted(kAdapter + report_line(0, {1, 2}, 2) + "E: 000000.001000 0\n").events.size(),
            2u)
      << "an empty report is counted as bad";
}

TEST(RecordedPackets, TheTraceDriverHandsOnStates) {
  OwnFolder folder;
  folder.write("steam.hid", kSteam + report_line(0, {1, 0, 4, 0x0b, 9}, 64) +
                                report_line(1, {1, 0, 1, 0x3c, 7}, 64));
  const auto listings = value_of(trace_listings(folder.at("steam.hid")));
  const auto device = value_of(open_trace_device(listings.at(0), Detach::never));
  Report report;
  while (device->read(report) == Device::Status::nothing) {
    pollfd fd = device->poll_fds().front();
    ASSERT_EQ(::poll(&fd, 1, 60'000), 1);
  }
  EXPECT_EQ(report.bytes[2], 1);
}

}  // namespace
}  // namespace gaitpad
