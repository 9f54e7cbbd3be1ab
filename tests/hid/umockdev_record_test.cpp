#include "hid/umockdev_record.h"

#include <gtest/gtest.h>

#include "tests/hid/made_pads.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

// A DualShock 4 by hid-playstation, shortened: X and Y of 0..255, BTN_SOUTH and BTN_EAST (bits
// 0x130 and 0x131: the lowest two of byte 38). As umockdev 0.17 writes the answers.
const std::string kKeys = std::string(2 * 38, '0') + "03" + std::string(2 * 57, '0');
const std::string kAnswers =
    "@DEV /dev/input/event5\n"
    "EVIOCGVERSION 0 01000100\n"
    "EVIOCGID 0 03004C05CC091181\n"
    "EVIOCGNAME(0) 5 41636D65000000000000\n"
    "EVIOCGUNIQ(0) 3 616200FF\n"
    "EVIOCGBIT(0) 8 0B00000000000000\n"
    "EVIOCGBIT(1) 96 " +
    kKeys +
    "\n"
    "EVIOCGBIT(3) 8 0300000000000000\n"
    "EVIOCGABS 0 8000000000000000FF000000000000000F00000000000000\n"
    "EVIOCGABS(1) 0 7F00000000000000FF000000000000000000000000000000\n"
    "EVIOCGABS(1) 0 8000000000000000FF000000000000000000000000000000\n"
    "EVIOCGMTSLOTS(0) 0 350000000000000000000000\n";
const std::string kEvents =
    "# EVEMU 1.2\n"
    "# device /dev/input/event5\n"
    "E: 1700000000.000001 0003 0000 128\n"
    "E: 1700000000.000001 0000 0000 0\n"
    "E: 1700000001.500001 0003 0000 255\n"
    "E: 1700000001.500001 0001 0130 1\n"
    "E: 1700000001.500001 0000 0000 0\n";
const std::string kDescription =
    "P: /devices/pci0000:00/usb1/1-2/1-2:1.0/0003:054C:09CC.0001/input/input9/event5\n"
    "N: input/event5\n"
    "E: DEVNAME=/dev/input/event5\n"
    "E: SUBSYSTEM=input\n"
    "A: dev=13:69\n"
    "L: device=../../input9\n"
    "\n"
    "P: /devices/pci0000:00/usb1/1-2/1-2:1.0/0003:054C:09CC.0001/input/input9\n"
    "E: NAME=\"Told by sysfs\"\n"
    "E: PRODUCT=3/54c/9cc/8111\n"
    "\n"
    "P: /devices/pci0000:00/usb1/1-2\n"
    "N: bus/usb/001/004=12010002\n"
    "E: PRODUCT=54c/9cc/100\n"
    "\n";

Trace parsed(const std::string& text) { return value_of(parse_trace(text, "bug.umockdev")); }
std::string cause(const std::string& text) { return cause_of(parse_trace(text, "bug.umockdev")); }

TEST(UmockdevRecord, AnswersAndEventsAreATraceOfTheEvdevDriver) {
  const Trace trace = parsed(kAnswers + kEvents);
  PadState rest;
  expect_push_of_dualshock(trace, "Acme", rest);
  EXPECT_EQ(trace.devices[0].info.unique_id, "ab");
}

TEST(UmockdevRecord, ThePartsMayStandInAnyOrder) {
  const Trace trace = parsed(kDescription + kAnswers + kEvents);
  EXPECT_EQ(parsed(kAnswers + kEvents).bytes, trace.bytes);
  EXPECT_EQ(parsed(kEvents + "\n" + kAnswers).bytes, trace.bytes);
  ASSERT_EQ(trace.devices.size(), 1u);
  EXPECT_EQ(trace.devices[0].info.name, "Acme") << "the node's answer is the later one";
}

TEST(UmockdevRecord, TheDescriptionNamesADeviceThatWasNotAsked) {
  std::string answers = kAnswers;
  const auto from = answers.find("EVIOCGID"), to = answers.find("EVIOCGUNIQ");
  answers.erase(from, to - from);
  const DeviceInfo info = parsed(kDescription + answers).devices.at(0).info;
  EXPECT_EQ(info.name, "Told by sysfs");
  EXPECT_EQ(info.product, 0x09cc);
  EXPECT_EQ(info.version, 0x8111);
}

TEST(UmockdevRecord, AnswersWithoutAPathBelongToTheFirstNodeThatIsNamed) {
  const Trace trace = parsed(kAnswers.substr(kAnswers.find('\n') + 1) + kEvents);
  ASSERT_EQ(trace.devices.size(), 1u);
  EXPECT_EQ(trace.events.size(), 2u);
}

TEST(UmockdevRecord, EachNodeIsADevice) {
  std::string second = kAnswers + kEvents;
  for (auto at = second.find("event5"); at != std::string::npos; at = second.find("event5"))
    second.replace(at, 6, "event6");
  const Trace trace = parsed(kAnswers + kEvents + second);
  ASSERT_EQ(trace.devices.size(), 2u);
  EXPECT_EQ(trace.events.size(), 4u);
}

TEST(UmockdevRecord, DamageIsToldWithItsLineOrSkipped) {
  const auto damaged = [](const std::string& was, const std::string& is) {
    std::string text = kAnswers + kEvents;
    text.replace(text.find(was), was.size(), is);
    return text;
  };
  EXPECT_EQ(cause(damaged("EVIOCGABS 0 80", "EVIOCGABS 0 8")),
            "bug.umockdev:9: EVIOCGABS has a number, what it returned, and bytes in hexadecimal "
            "digits");
  EXPECT_EQ(cause(damaged("EVIOCGABS 0 80", "EVIOCGABS 0 8000")),
            "bug.umockdev:9: an axis' range has 24 bytes");
  EXPECT_EQ(cause(damaged("EVIOCGID 0 0300", "EVIOCGID 0 03")),
            "bug.umockdev:3: an id has 8 bytes");
  EXPECT_EQ(
      cause(damaged("8000000000000000FF0000000000000000", "8000000000000000FE0000000000000000")),
      "bug.umockdev:11: a second range for the axis 01");
  EXPECT_EQ(cause(damaged("0003 0000 128", "0003 0000")),
            "bug.umockdev:15: an E: line holds SECONDS.MICROSECONDS, a type, a code and a value");
  EXPECT_EQ(cause(damaged("E: 1700000001.5", "E: 1600000001.5")),
            "bug.umockdev:17: time goes back to 1600000001.500001");
  EXPECT_EQ(cause(damaged("EVIOCGABS(1) 0 7F", "EVIOCGABS(1) -22 7F")), "accepted")
      << "a request that was refused";
  const auto lenient =
      value_of(parse_trace(damaged("0003 0000 128", "0003 0000"), "bug.umockdev", Damage::skip));
  EXPECT_EQ(lenient.skipped_lines, 1);
}

TEST(UmockdevRecord, EventsAloneAreRefusedWithTheFileThatIsMissing) {
  EXPECT_EQ(cause(kEvents),
            "bug.umockdev: no axis or key of a device; its events alone do not state them: put the "
            "file that umockdev-record --ioctl wrote of it before them");
}

}  // namespace
}  // namespace gaitpad
