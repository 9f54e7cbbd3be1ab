#include "hid/libinput_record.h"

#include <gtest/gtest.h>

#include "tests/hid/made_pads.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

// Output of libinput 1.22 for a DualShock 4 under hid-playstation, shortened.
const std::string kHead =
    "# libinput record\n"
    "version: 1\n"
    "ndevices: 1\n"
    "libinput:\n"
    "  version: \"1.22.1\"\n"
    "system:\n"
    "  os: \"debian:12\"\n"
    "  kernel: \"6.1.0-56-amd64\"\n"
    "devices:\n";
const std::string kNode =
    "- node: /dev/input/event5\n"
    "  evdev:\n"
    "    # Name: Acme Wireless Controller\n"
    "    # Supported Events:\n"
    "    #   Event code 304 (BTN_SOUTH)\n"
    "    name: \"Acme Wireless Controller\"\n"
    "    id: [3, 1356, 2508, 33041]\n"
    "    codes:\n"
    "      0: [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15] # EV_SYN\n"
    "      1: [304, 305] # EV_KEY\n"
    "      3: [0, 1] # EV_ABS\n"
    "    absinfo:\n"
    "      0: [0, 255, 0, 0, 0]\n"
    "      1: [0, 255, 0, 0, 0]\n"
    "    properties: []\n"
    "  hid: [\n"
    "    0x05, 0x01, 0x09, 0x05\n"
    "  ]\n"
    "  udev:\n"
    "    properties:\n"
    "    - ID_INPUT=1\n"
    "  quirks:\n"
    "  events:\n"
    "  # Current time is 12:00:00\n";
const std::string kEvents =
    "  - evdev:\n"
    "    - [  0,      0,   3,   0,     128] # EV_ABS / ABS_X                  128\n"
    "    - [  0,      0,   0,   0,       0] # ------------ SYN_REPORT (0) ---------- +0ms\n"
    "  - libinput:\n"
    "    - {time: 0.0, type: DEVICE_ADDED, [not: an, event]}\n"
    "  - evdev:\n"
    "    - [  1, 500000,   3,   0,     255] # EV_ABS / ABS_X                  255\n"
    "    - [  1, 500000,   1, 304,       1] # EV_KEY / BTN_SOUTH                1\n"
    "    - [  1, 500000,   0,   0,       0] # ------------ SYN_REPORT (0) ---------- +1500ms\n";

TEST(LibinputRecord, IsATraceOfTheEvdevDriver) {
  const Trace trace = value_of(parse_trace(kHead + kNode + kEvents, "bug.yml"));
  PadState rest;
  expect_push_of_dualshock(trace, "Acme Wireless Controller", rest);
  EXPECT_NEAR(rest.axis[kLeftY], -1.0 / 255.0, 1e-6) << "its middle: no event tells it";
}

TEST(LibinputRecord, SeveralNodesShareOneTime) {
  std::string second = kNode;
  second.replace(second.find("Acme"), 4, "Bcme");
  const std::string later =
      "  - evdev:\n"
      "    - [  0, 700000,   3,   0,       0]\n"
      "    - [  0, 700000,   0,   0,       0]\n";
  const Trace trace = value_of(parse_trace(kHead + kNode + kEvents + second + later, "bug.yml"));
  ASSERT_EQ(trace.devices.size(), 2u);
  ASSERT_EQ(trace.events.size(), 3u);
  EXPECT_EQ(trace.events[1].device, 1);
  EXPECT_EQ(trace.events[1].time_us, 700'000);
  EXPECT_EQ(trace.events[2].device, 0);
}

TEST(LibinputRecord, DamageIsToldWithItsLineOrSkipped) {
  const auto damaged = [](const std::string& was, const std::string& is) {
    std::string text = kHead + kNode + kEvents;
    text.replace(text.find(was), was.size(), is);
    return text;
  };
  const auto cause = [](const std::string& text) { return cause_of(parse_trace(text, "bug.yml")); };
  EXPECT_EQ(cause(damaged("[  1, 500000,   1, 304,       1]", "[  1, 500000,   1, 304]")),
            "bug.yml:41: an event is a list of seconds, microseconds, type, code and value");
  EXPECT_EQ(cause(damaged("[  1, 500000,   1", "[  1, 400000,   1")),
            "bug.yml:41: time goes back to 1.400000");
  EXPECT_EQ(cause(damaged("1: [0, 255, 0, 0, 0]", "0: [0, 255, 0, 0, 0]")),
            "bug.yml:23: a second range for the axis 00");
  EXPECT_EQ(cause(damaged("[3, 1356, 2508, 33041]", "[3, 1356]")),
            "bug.yml:16: an id is a list of bus, vendor, product and version");
  EXPECT_EQ(cause(kHead), "bug.yml: no device with an axis or a key");
  const auto lenient =
      parse_trace(damaged("[  1, 500000,   1, 304,       1]", "[  1, 500000,   1, 304]"), "bug.yml",
                  Damage::skip);
  ASSERT_TRUE(lenient);
  EXPECT_EQ(lenient->skipped_lines, 1);
  EXPECT_EQ(lenient->events.size(), 2u);
}

}  // namespace
}  // namespace gaitpad
