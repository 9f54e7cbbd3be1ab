#include <gtest/gtest.h>

#include "gaitpad/pad_stream.h"
#include "tests/own_folder.h"
#include "tests/session/fake_drivers.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

class PadChoice : public testing::Test {
 protected:
  FakeBus::Pad see(int driver, const std::string& unique_id, const std::string& port,
                   const std::string& name = "Example Walk Pad") {
    auto pad = bus_.make(driver, unique_id, port);
    pad->listing.info.name = name;
    bus_.show(driver, pad);
    return pad;
  }
  std::vector<PadSighting> sightings(const PadWish& wish = {}) {
    return value_of(pad_sightings({}, wish, Drivers::preferred, FakeBus::table()));
  }
  // The nodes to open, with a blank behind each.
  std::string chosen(const PadWish& wish = {}) {
    auto pads = chosen_pads(sightings(wish), wish);
    if (!pads) return pads.error().message;
    std::string nodes;
    for (const PadSighting& s : *pads) nodes += s.listing.node + " ";
    return nodes;
  }
  FakeBus bus_;
};

TEST_F(PadChoice, OnePadIsServedByTheFirstUsableDriver) {
  see(kUsb, "A", "p1")->listing.kernel_driver = "usbhid";
  auto cooked = see(kEvdev, "A", "p1");
  auto raw = see(kHidraw, "A", "p1");
  EXPECT_EQ(chosen(), "/dev/hidraw-p1 ");
  raw->listing.problem = "/dev/hidraw-p1: permission denied";
  EXPECT_EQ(chosen(), "/dev/evdev-p1 ");
  EXPECT_EQ(chosen({"", "hidraw"}), "");
  EXPECT_EQ(chosen({"", "evdev"}), "/dev/evdev-p1 ");
  // The kernel has the pad, so it is not taken from it without being asked.
  cooked->listing.problem = "/dev/evdev-p1: permission denied";
  EXPECT_EQ(chosen(), "");
  EXPECT_EQ(chosen({"", "usb"}), "/dev/usb-p1 ");
  EXPECT_EQ(chosen({"/dev/usb-p1", ""}), "/dev/usb-p1 ");
}

TEST_F(PadChoice, UsbServesAPadThatNoKernelDriverHas) {
  see(kUsb, "A", "p1");
  EXPECT_EQ(chosen(), "/dev/usb-p1 ");
}

TEST_F(PadChoice, AllPadsAreChosenInTheOrderOfTheDrivers) {
  see(kEvdev, "", "p3");
  see(kHidraw, "B", "p2");
  see(kHidraw, "A", "p1");
  EXPECT_EQ(chosen(), "/dev/hidraw-p2 /dev/hidraw-p1 /dev/evdev-p3 ");
}

TEST_F(PadChoice, NodesThatOneDriverShowsOfOneAdapterAreAPadEach) {
  see(kEvdev, "", "p1")->listing.node = "/dev/input/event5";
  see(kEvdev, "", "p1")->listing.node = "/dev/input/event6";
  EXPECT_EQ(chosen(), "/dev/input/event5 /dev/input/event6 ");
  EXPECT_EQ(chosen({"/dev/input/event6", ""}), "/dev/input/event6 ");
  see(kHidraw, "", "p1");
  EXPECT_EQ(chosen(), "/dev/hidraw-p1 ");
  EXPECT_EQ(chosen({"", "evdev"}), "/dev/input/event5 /dev/input/event6 ");
}

TEST_F(PadChoice, APadIsNamedByNodeModelUniqueIdOrAPartOfItsName) {
  see(kHidraw, "aa:bb:cc", "p1", "Sony Wireless Controller");
  auto other = see(kHidraw, "DD:EE:FF", "p2", "Example Gamepad");
  other->listing.info.vendor = 0x0abc;
  other->listing.info.product = 0x001f;
  for (const char* wish : {"/dev/hidraw-p2", "0abc:001f", "ABC:1F", "dd:ee:ff", "Example Gamepad",
                           "example", "GAMEP"}) {
    EXPECT_EQ(chosen({wish, ""}), "/dev/hidraw-p2 ") << wish;
  }
  for (const char* wish : {"/dev/hidraw-p3", "0abc:0020", "dd:ee", "0abc:001f0", ":", "Gamepads"})
    EXPECT_EQ(chosen({wish, ""}), "") << wish;
}

TEST_F(PadChoice, APartThatFitsSeveralPadsIsAnErrorThatNamesThem) {
  see(kHidraw, "A", "p1", "Example Pad");
  see(kHidraw, "", "p2", "Example Pad Two");
  EXPECT_EQ(chosen({"example", ""}),
            "\"example\" fits 2 pads: \"Example Pad\" (1209:0001, unique id \"A\"), "
            "\"Example Pad Two\" (1209:0001, port \"p2\")");
  EXPECT_EQ(chosen({"example pad", ""}), "/dev/hidraw-p1 ") << "the whole name is meant";
  EXPECT_EQ(chosen({"1209:0001", ""}), "/dev/hidraw-p1 /dev/hidraw-p2 ");
}

TEST_F(PadChoice, WhatDriversCallDifferentlyIsOnePad) {
  auto raw = see(kHidraw, "aa:bb", "p1", "Sony Interactive Entertainment Wireless Controller");
  see(kEvdev, "serial7", "p1", "Wireless Controller");
  EXPECT_EQ(chosen({"wireless", ""}), "/dev/hidraw-p1 ");
  EXPECT_EQ(chosen({"Wireless Controller", ""}), "/dev/hidraw-p1 ");
  EXPECT_EQ(chosen({"serial7", ""}), "/dev/hidraw-p1 ");
  raw->listing.problem = "/dev/hidraw-p1: permission denied";
  EXPECT_EQ(chosen({"sony", ""}), "/dev/evdev-p1 ");
}

TEST_F(PadChoice, ALinkToANodeIsTheNode) {
  const OwnFolder own;
  const std::string node = own.at("node"), link = own.at("link");
  ASSERT_EQ(::mkfifo(node.c_str(), 0600), 0);
  std::filesystem::create_symlink(node, link);
  see(kHidraw, "A", "p1")->listing.node = node;
  see(kHidraw, "B", "p2");
  EXPECT_EQ(chosen({link, ""}), node + " ");
}

TEST_F(PadChoice, SightingsTellWhatIsNoPadAndWhy) {
  auto keyboard = see(kHidraw, "K", "p1", "A Keyboard");
  keyboard->listing.info.descriptor = {0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0};
  auto damaged = see(kHidraw, "D", "p2", "Damaged");
  damaged->listing.info.descriptor = {0x06};
  see(kEvdev, "K", "p1", "A Keyboard")->listing.info.descriptor.clear();
  see(kEvdev, "Q", "p4", "Who Knows")->listing.info.descriptor.clear();
  see(kEvdev, "A", "p3");
  const std::vector<PadSighting> seen = sightings();
  ASSERT_EQ(seen.size(), 5u);
  EXPECT_TRUE(seen[0].is_pad && seen[1].is_pad) << "pads come first";
  EXPECT_EQ(seen[0].listing.node, "/dev/evdev-p4");
  EXPECT_EQ(seen[1].listing.node, "/dev/evdev-p3");
  EXPECT_STREQ(seen[1].driver->name, "evdev");
  EXPECT_EQ(seen[1].problem, "");
  EXPECT_EQ(seen[2].problem,
            "/dev/hidraw-p1: \"A Keyboard\" is no pad: it has no joystick or gamepad with X and Y");
  EXPECT_EQ(seen[3].problem.find("/dev/hidraw-p2: Damaged: report descriptor: "), 0u)
      << seen[3].problem;
  EXPECT_EQ(seen[4].problem, "/dev/evdev-p1: no pad");
}

TEST_F(PadChoice, DriversThatAreUnknownOrWereNotBuiltAreErrors) {
  const DriverEntry table[] = {{"hidraw", "libhidapi-hidraw", nullptr, nullptr}};
  EXPECT_EQ(pad_sightings({}, {"", "hidraw"}, Drivers::all, table).error().message,
            "the driver \"hidraw\" is missing: the program was built without libhidapi-hidraw");
  EXPECT_EQ(pad_sightings({}, {"", "HID"}, Drivers::all, table).error().message,
            "there is no driver \"HID\" (known: hidraw)");
  EXPECT_TRUE(pad_sightings({}, {}, Drivers::all, table)->empty());
}

int sdl_finds = 0;
std::vector<DeviceListing> find_sdl() {
  ++sdl_finds;
  return {};
}

TEST_F(PadChoice, SdlIsAskedOnlyWhereItMustBe) {
  sdl_finds = 0;
  const DriverEntry sdl = {"sdl", "libSDL2", &find_sdl, nullptr};
  const DriverEntry both[] = {FakeBus::table()[kEvdev], sdl}, alone[] = {sdl};
  ASSERT_TRUE(pad_sightings({}, {}, Drivers::preferred, both));
  EXPECT_EQ(sdl_finds, 0);
  ASSERT_TRUE(pad_sightings({}, {}, Drivers::all, both));
  ASSERT_TRUE(pad_sightings({}, {"", "sdl"}, Drivers::preferred, both));
  ASSERT_TRUE(pad_sightings({}, {}, Drivers::preferred, alone));
  EXPECT_EQ(sdl_finds, 3);
}

TEST_F(PadChoice, ARecordingGivesItsDevicesAlone) {
  see(kHidraw, "A", "p1");
  const PadWish wish{GAITPAD_SOURCE_DIR "/tests/data/pads/046d_c216.hid", ""};
  auto seen = pad_sightings({}, wish, Drivers::preferred);
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_EQ(seen->size(), 1u);
  EXPECT_STREQ(seen->front().driver->name, "trace");
  EXPECT_TRUE(seen->front().is_pad);
  auto pads = chosen_pads(*seen, wish);
  ASSERT_TRUE(pads);
  EXPECT_EQ(pads->size(), 1u);
  EXPECT_EQ(pad_sightings({}, {wish.pad, "evdev"}, Drivers::preferred).error().message,
            wish.pad + ": a recording is not for the driver \"evdev\"");
  EXPECT_EQ(pad_sightings({}, {"/nonexistent.hid", ""}, Drivers::preferred).error().message,
            "/nonexistent.hid: there is no such file");
}

TEST(SameDevice, IsToldByUniqueIdElseByPort) {
  DeviceInfo a = made_pad();
  a.driver = "hidraw";
  a.unique_id = "A";
  a.physical_path = "p1";
  DeviceInfo b = a;
  b.physical_path = "p2";
  EXPECT_TRUE(is_same_device(a, b));
  b.unique_id = "B";
  EXPECT_FALSE(is_same_device(a, b));
  b.unique_id.clear();
  EXPECT_FALSE(is_same_device(a, b));
  a.unique_id.clear();
  EXPECT_FALSE(is_same_device(a, b));
  b.physical_path = "p1";
  EXPECT_TRUE(is_same_device(a, b));
  b.driver = "evdev";
  EXPECT_FALSE(is_same_device(a, b));
  b.driver = "hidraw";
  b.product ^= 1;
  EXPECT_FALSE(is_same_device(a, b));
}

}  // namespace
}  // namespace gaitpad
