// Tests which devices are pads, and their driver, index and calibration.
#include <gtest/gtest.h>

#include "gaitpad/pad_stream.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/pads/fake_drivers.h"
#include "tests/pads/pad_stream_fixture.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

// --- which pad a request selects, and which driver serves it

class PadChoice : public testing::Test {
 protected:
  FakeBus::Pad see(int driver, const std::string& unique_id, const std::string& port,
                   const std::string& name = "Example Walk Pad") {
    auto pad = bus_.make(driver, unique_id, port);
    pad->listing.info.name = name;
    bus_.show(driver, pad);
    return pad;
  }
  std::vector<PadSighting> sightings(const PadSelector& selector = {}) {
    return value_of(pad_sightings({}, selector, Drivers::preferred, FakeBus::table()));
  }
  // The nodes that the finder would open, each followed by a blank.
  std::string chosen(const PadSelector& selector = {}) {
    auto pads = chosen_pads(sightings(selector), selector);
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
  // A kernel driver has the pad, so it is not taken without the user's request.
  cooked->listing.problem = "/dev/evdev-p1: permission denied";
  EXPECT_EQ(chosen(), "");
  EXPECT_EQ(chosen({"", "usb"}), "/dev/usb-p1 ");
  EXPECT_EQ(chosen({"/dev/usb-p1", ""}), "/dev/usb-p1 ");
  see(kUsb, "B", "p2");  // no kernel driver has this pad
  EXPECT_EQ(chosen(), "/dev/usb-p2 ");
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
  for (const char* selector : {"/dev/hidraw-p2", "0abc:001f", "ABC:1F", "dd:ee:ff",
                               "Example Gamepad", "example", "GAMEP"}) {
    EXPECT_EQ(chosen({selector, ""}), "/dev/hidraw-p2 ") << selector;
  }
  for (const char* selector :
       {"/dev/hidraw-p3", "0abc:0020", "dd:ee", "0abc:001f0", ":", "Gamepads"})
    EXPECT_EQ(chosen({selector, ""}), "") << selector;
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

TEST_F(PadChoice, ThePadThatGaitpadItselfForwardsIsNone) {
  auto forwarded = see(kEvdev, "", "p1");
  forwarded->listing.info.vendor = 0x6761;
  forwarded->listing.info.product = 0x7470;
  EXPECT_EQ(chosen(), "");
  see(kHidraw, "A", "p2");
  EXPECT_EQ(chosen(), "/dev/hidraw-p2 ");
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
  const PadSelector selector{kSourceFolder + "/tests/data/pads/046d_c216.hid", ""};
  auto seen = pad_sightings({}, selector, Drivers::preferred);
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_EQ(seen->size(), 1u);
  EXPECT_STREQ(seen->front().driver->name, "trace");
  EXPECT_TRUE(seen->front().is_pad);
  auto pads = chosen_pads(*seen, selector);
  ASSERT_TRUE(pads);
  EXPECT_EQ(pads->size(), 1u);
  EXPECT_EQ(pad_sightings({}, {selector.pad, "evdev"}, Drivers::preferred).error().message,
            selector.pad + ": a recording is not for the driver \"evdev\"");
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

// --- under which index and with which calibration pads are opened

using namespace std::chrono_literals;

TEST_F(PadStreamTest, AnUnplugThatNobodyHadTimeToNoticeKeepsTheIndexToo) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  for (int i = 0; i < 5; ++i) {
    bus_.unplug(pad);
    pad = bus_.plug(kHidraw, "A", i % 2 == 0 ? "port2" : "port1");
  }
  // Some replugs may go unnoticed, but the last one is open in the end, as device 0.
  EXPECT_TRUE(comes_true([&] { return pad->openings > 0; }));
  pad->send_axes(77, 0);
  Report report = next();
  while (report.kind != ReportKind::input) {
    EXPECT_EQ(report.device, 0);
    report = next();
  }
  EXPECT_EQ(report.device, 0);
  EXPECT_EQ(report.bytes[0], 77);
}

TEST_F(PadStreamTest, APadWhoseUniqueIdComesLateIsOpenedOnceAndWithIt) {
  start();
  auto pad = bus_.make(kHidraw, "", "port1");
  pad->listing.kernel_driver = "playstation";
  const auto shown = std::chrono::steady_clock::now();
  bus_.show(kHidraw, pad);
  bus_.plug(kHidraw, "B", "port2");
  expect(ReportKind::added, 0);  // the other pad: the finder has seen both
  EXPECT_EQ(stream_->device(0).info.unique_id, "B");
  bus_.name_id(pad, "A");
  const bool is_in_time = std::chrono::steady_clock::now() - shown < 900ms;
  expect(ReportKind::added, 1);
  if (is_in_time) {
    EXPECT_EQ(stream_->device(1).info.unique_id, "A");
  }
  bus_.plug(kHidraw, "C", "port3");
  expect(ReportKind::added, 2);
  EXPECT_EQ(pad->openings, 1);
  EXPECT_EQ(stream_->counts().plugged, 3);
}

TEST_F(PadStreamTest, APadThatNeverTellsItsUniqueIdIsOpenedAllTheSame) {
  auto pad = bus_.make(kHidraw, "", "port1");
  pad->listing.kernel_driver = "sony";
  bus_.show(kHidraw, pad);
  const auto before = std::chrono::steady_clock::now();
  start();
  expect(ReportKind::added, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - before, 900ms);
  EXPECT_EQ(pad->openings, 1);
}

TEST_F(PadStreamTest, ANodeWhoseUniqueIdChangesWhileItIsOpenIsNotOpenedAgain) {
  auto pad = bus_.plug(kHidraw, "", "port1");
  start();
  expect(ReportKind::added, 0);
  bus_.name_id(pad, "A");
  auto other = plugged("B", "port2", 1);
  EXPECT_EQ(pad->openings, 1);
  pad->send_axes(7, 0);
  expect_x(0, 7);
  take_away(pad, 0);
  EXPECT_EQ(stream_->counts().plugged, 2);
}

// Pads keep their index by unique id even at the other one's port; without ids by port. Clones
// share their id and are still two pads.
TEST_F(PadStreamTest, TwoEqualPadsAreKeptApartByTheirIdsElseByTheirPorts) {
  struct Row {
    const char *id_a, *id_b, *port_of_b_again;
  };
  for (const Row& row :
       {Row{"A", "B", "port1"}, {"", "", "port2"}, {"123456", "123456", "port2"}}) {
    SCOPED_TRACE(row.id_a);
    auto a = bus_.plug(kHidraw, row.id_a, "port1");
    start();
    expect(ReportKind::added, 0);
    auto b = plugged(row.id_b, "port2", 1);
    take_away(a, 0);
    take_away(b, 1);
    b = plugged(row.id_b, row.port_of_b_again, 1);
    if (row.id_a != std::string("123456"))
      a = plugged(row.id_a, row.id_a[0] == 'A' ? "port2" : "port1", 0);
    stream_.reset();
    bus_.unplug(a);
    bus_.unplug(b);
  }
}

TEST_F(PadStreamTest, AnOpeningThatFailsIsTriedAgainWithoutAnyEvent) {
  auto pad = bus_.make(kHidraw, "A", "port1");
  pad->failing_openings = 3;
  start();
  bus_.show(kHidraw, pad);
  expect(ReportKind::added, 0);
  EXPECT_EQ(pad->openings, 4);
  EXPECT_TRUE(stream_->take_remarks().empty());
}

TEST_F(PadStreamTest, APadThatTheFirstDriverCannotOpenIsServedByTheNext) {
  auto raw = bus_.make(kHidraw, "A", "port1");
  raw->failing_openings = 1 << 20;
  auto cooked = bus_.make(kEvdev, "A", "port1");
  bus_.show(kHidraw, raw);
  bus_.show(kEvdev, cooked);
  start();
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info.driver, "evdev");
  EXPECT_EQ(raw->openings, 4);
}

TEST_F(PadStreamTest, WhatNoDriverCanOpenIsToldWithItsCause) {
  auto pad = bus_.make(kHidraw, "A", "port1");
  pad->listing.problem = "/dev/hidraw-port1: permission denied";
  bus_.show(kHidraw, pad);
  start();
  EXPECT_TRUE(is_told("/dev/hidraw-port1: permission denied\n"));
  EXPECT_EQ(pad->openings, 0);
  bus_.unplug(pad);
  pad->listing.problem.clear();
  bus_.show(kHidraw, pad = bus_.make(kHidraw, "A", "port1"));
  expect(ReportKind::added, 0);
}

TEST_F(PadStreamTest, APadIsOpenedThroughOneDriverAlone) {
  auto raw = bus_.make(kHidraw, "A", "port1");
  auto cooked = bus_.make(kEvdev, "A", "port1");
  start();
  bus_.show(kEvdev, cooked);  // as on a real kernel, the preferred node appears later
  bus_.show(kHidraw, raw);
  expect(ReportKind::added, 0);
  for (int i = 0; i < 3; ++i) bus_.tell();
  auto other = plugged("B", "port2", 1);
  EXPECT_EQ(raw->openings + cooked->openings, 1);
}

// An adapter for two pads: one USB interface with an input node for each of its plugs.
TEST_F(PadStreamTest, TwoNodesOfOneAdapterAreTwoPadsAndKeepTheirIndexes) {
  const auto plug = [this](const char* node) {
    auto pad = bus_.make(kEvdev, "", "port1");
    pad->listing.node = node;
    bus_.show(kEvdev, pad);
    return pad;
  };
  auto first = plug("/dev/input/event5"), second = plug("/dev/input/event6");
  start();
  for (int i = 0; i < 3; ++i) {
    expect(ReportKind::added, 0);
    expect(ReportKind::added, 1);
    first->send_axes(1, 0);
    expect_x(0, 1);
    second->send_axes(2, 0);
    expect_x(1, 2);
    take_away(first, 0);
    take_away(second, 1);
    first = plug("/dev/input/event5");
    second = plug("/dev/input/event6");
  }
}

TEST_F(PadStreamTest, WhatHasNoStickIsNotAnnounced) {
  auto keyboard = bus_.make(kHidraw, "K", "port1");
  keyboard->listing.info.descriptor = {0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0};
  bus_.show(kHidraw, keyboard);
  start();
  auto pad = plugged("A", "port2", 0);
  EXPECT_EQ(stream_->device(0).info.unique_id, "A");
  EXPECT_EQ(keyboard->openings, 0);
}

TEST_F(PadStreamTest, APadHasItsUsersCalibrationAndSaysWhetherItBringsItsOwn) {
  PadStreamOptions options;
  options.files.user_calibrations = user_folder("unique_id = 'A'\n[left]\ninner = 0.31\n");
  auto own = bus_.make(kHidraw, "A", "port1");
  own->factory_sticks = FactorySticks();
  bus_.show(kHidraw, own);
  start(options);
  expect(ReportKind::added, 0);
  const PadConfig own_config = stream_->take_config(0);
  EXPECT_EQ(own_config.calibration.left.inner, 0.31);
  EXPECT_TRUE(own_config.has_factory_sticks);
  auto other = plugged("B", "port2", 1);
  const PadConfig other_config = stream_->take_config(1);
  EXPECT_EQ(other_config.calibration.left.inner, kInnerZoneUnknown);
  EXPECT_FALSE(other_config.has_factory_sticks);
}

TEST_F(PadStreamTest, ASelectorThatMakesNoSenseIsAnErrorAtOnceAndOneThatNothingFitsWaits) {
  bus_.plug(kHidraw, "A", "port1");
  bus_.plug(kHidraw, "B", "port2");
  const auto cause = [this](PadSelector selector) -> std::string {
    PadStreamOptions options;
    options.selector = std::move(selector);
    options.drivers = FakeBus::table();
    options.changes_fd = bus_.changes_fd();
    return cause_of(PadStream::start(std::move(options)));
  };
  EXPECT_EQ(cause({"", "sdl"}), "there is no driver \"sdl\" (known: hidraw, evdev, usb)");
  EXPECT_NE(cause({"walk", ""}).find("\"walk\" fits 2 pads"), std::string::npos);
  EXPECT_EQ(cause({"/nonexistent.hid", ""}),
            "there is no driver \"trace\" (known: hidraw, evdev, usb)");
  EXPECT_EQ(cause({"A", ""}), "accepted");
  EXPECT_EQ(cause({"ffff:ffff", ""}), "accepted");
}

TEST_F(PadStreamTest, AKernelsDriverIsDetachedOnlyWhereUsbIsNamed) {
  EXPECT_EQ(detach_asked({"", "usb"}), Detach::allowed);
  EXPECT_EQ(detach_asked({"/dev/bus/usb/001/004", ""}), Detach::never);
  EXPECT_EQ(detach_asked({"", "hidraw"}), Detach::never);
}

// A pad that opens slowly does not delay other pads.
TEST_F(PadStreamTest, APadThatOpensSlowlyKeepsNoOtherWaiting) {
  const auto slow = bus_.make(kHidraw, "A", "port1");
  slow->keeps_opening = true;
  bus_.show(kHidraw, slow);
  start();
  const auto quick = plugged("B", "port2", 0);
  take_away(quick, 0);  // pads are closed meanwhile as well
  slow->keeps_opening = false;
  expect(ReportKind::added, 1);
  EXPECT_EQ(slow->openings, 1) << "it was begun once";
}

TEST_F(PadStreamTest, APadThatGoesWhileItIsOpenedIsNotAnnounced) {
  const auto slow = bus_.make(kHidraw, "A", "port1");
  slow->keeps_opening = true;
  bus_.show(kHidraw, slow);
  start();
  EXPECT_TRUE(comes_true([&] { return slow.use_count() > 2; })) << "it is being opened";
  bus_.unplug(slow);
  plugged("B", "port2", 0);
  slow->keeps_opening = false;
  EXPECT_TRUE(comes_true([&] { return slow->closings == 1; }));
}

TEST_F(PadStreamTest, ARecordersPadHandsOnEveryPacket) {
  PadStreamOptions options;
  options.is_raw = true;
  auto pad = bus_.make(kHidraw, "A", "port1");
  bus_.show(kHidraw, pad);
  start(options);
  expect(ReportKind::added, 0);
  EXPECT_TRUE(pad->is_raw);
  for (int i = 0; i < 40; ++i) {
    ASSERT_TRUE(pad->send({7}));
    std::this_thread::sleep_for(std::chrono::milliseconds(i == 20 ? 1100 : 1));
  }
  EXPECT_TRUE(stream_->take_remarks().empty());
  stream_.reset();
  EXPECT_EQ(pad->openings, 1);
}

// A recording through the real driver.
class RecordingAsPad : public PadStreamTest {
 protected:
  void play(const Trace& trace, PadStreamOptions options = {}) {
    options.selector.pad = own_.at("pad.hid");
    ASSERT_TRUE(write_trace(trace, options.selector.pad));
    stream_ = value_of(PadStream::start(std::move(options)));
  }
  static Trace made_trace() {
    Trace trace;
    trace.devices.resize(1);
    trace.devices[0].info = made_pad();
    for (int i = 0; i < 3; ++i) add_event(trace, 5'000'000 + i * 10'000, made_report(10 + i, 0));
    trace.end_time_us = 5'030'000;
    trace.end_ticks = 8;
    return trace;
  }
};

TEST_F(RecordingAsPad, IsAddedReportsEndsAndIsNotOpenedAgain) {
  play(made_trace());
  EXPECT_FALSE(stream_->has_ended());
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info, made_pad());
  for (int i = 0; i < 3; ++i) expect_x(0, 10 + i);
  expect(ReportKind::removed, 0);
  EXPECT_TRUE(comes_true([&] { return stream_->has_ended(); }));
  EXPECT_TRUE(stream_->take_remarks().empty());
  EXPECT_EQ(stream_->counts().plugged, 1);
}

// A recording plays as its replay does on every machine; if it has no calibration, the user's file
// is used.
TEST_F(RecordingAsPad, KeepsItsOwnCalibrationElseHasTheUsers) {
  Trace trace = made_trace();
  for (const char* own : {"", "[left]\ninner = 0.21\n"}) {
    PadStreamOptions options;
    options.files.user_calibrations = user_folder("devices = ['*:*']\n[left]\ninner = 0.31\n");
    trace.devices[0].calibration = own;
    play(trace, options);
    expect(ReportKind::added, 0);
    EXPECT_EQ(stream_->take_config(0).calibration.left.inner, *own == 0 ? 0.31 : 0.21);
    if (*own != 0) {
      EXPECT_EQ(stream_->device(0).calibration, own);
    }
    stream_.reset();  // starts anew, because a file is played once in a stream
  }
}

TEST_F(RecordingAsPad, WithoutAnyStickIsAnError) {
  Trace trace = made_trace();
  trace.devices[0].info.descriptor = {0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0};
  PadStreamOptions options;
  options.selector.pad = own_.at("pad.hid");
  ASSERT_TRUE(write_trace(trace, options.selector.pad));
  EXPECT_EQ(cause_of(PadStream::start(options)),
            options.selector.pad + ": none of its devices is a pad with a stick");
}

// --- pads that are joined, and pads that do not tell their stick

// Two pads and a device that joins them, as hidraw lists a pair of Joy-Cons.
struct JoinedPads {
  explicit JoinedPads(FakeBus& bus)
      : left(bus.make(kHidraw, "L", "pL")),
        right(bus.make(kHidraw, "R", "pR")),
        pair(bus.make(kHidraw, "L+R", "pair")) {
    pair->listing.parts = {"/sys/pL", "/sys/pR"};
  }
  FakeBus::Pad left, right, pair;
};

TEST_F(PadChoice, APairIsChosenForBothItsPartsUnlessOneIsAskedFor) {
  const JoinedPads pads(bus_);
  bus_.show(kHidraw, pads.pair);
  bus_.show(kHidraw, pads.left);
  bus_.show(kHidraw, pads.right);
  see(kEvdev, "R", "pR");
  EXPECT_EQ(chosen(), "/dev/hidraw-pair ");
  EXPECT_EQ(chosen({"/dev/hidraw-pL", ""}), "/dev/hidraw-pL ");
  EXPECT_EQ(chosen({"walk", ""}), "/dev/hidraw-pair ") << "one pad, not three";
}

TEST_F(PadStreamTest, ASinglePadMakesWayForThePairAndComesBackWithoutIt) {
  const JoinedPads pads(bus_);
  bus_.show(kHidraw, pads.left);
  start();
  expect(ReportKind::added, 0);
  bus_.show(kHidraw, pads.pair);
  bus_.show(kHidraw, pads.right);
  expect(ReportKind::removed, 0);
  expect(ReportKind::added, 1);
  EXPECT_EQ(stream_->device(1).info.unique_id, "L+R");
  pads.pair->send_axes(9, 0);
  expect_x(1, 9);
  // When the right one is unplugged, the pair is as well.
  bus_.unplug(pads.right);
  bus_.unplug(pads.pair);
  expect(ReportKind::removed, 1);
  EXPECT_TRUE(is_told("unplugged"));
  expect(ReportKind::added, 0);
}

// A pad whose report 1 would have the stick, but which sends only vendor data with the id 30.
FakeBus::Pad stickless(FakeBus& bus, int driver) {
  auto pad = bus.make(driver, "A", "port1");
  pad->listing.info.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, 0x01, 0x15,
                                  0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x09,
                                  0x30, 0x09, 0x31, 0x81, 0x02, 0x85, 0x30, 0x06, 0x00,
                                  0xff, 0x09, 0x01, 0x95, 0x04, 0x81, 0x02, 0xc0};
  return pad;
}
void send_vendor_data(const FakeBus::Pad& pad) {
  for (int i = 0; i < 30; ++i) {
    pad->send({0x30, static_cast<std::uint8_t>(i), 0, 0, 0});
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
  }
}

TEST_F(PadStreamTest, APadThatNeverTellsItsStickIsNamedAndTheNextDriverServesIt) {
  auto raw = stickless(bus_, kHidraw);
  bus_.show(kHidraw, raw);
  auto cooked = bus_.plug(kEvdev, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  send_vendor_data(raw);
  EXPECT_TRUE(
      is_told("\"Example Walk Pad\" (hidraw, /dev/hidraw-port1): sends reports without a "
              "stick (id 0x30)"));
  Report report = next();
  while (report.kind == ReportKind::input) report = next();
  EXPECT_EQ(report.kind, ReportKind::removed);
  expect(ReportKind::added, 1);
  EXPECT_EQ(stream_->device(1).info.driver, "evdev");
  cooked->send_axes(7, 0);
  expect_x(1, 7);
}

TEST_F(PadStreamTest, AStickThatIsToldLateOrASilentPadIsNoCauseForARemark) {
  auto pad = stickless(bus_, kHidraw);
  bus_.show(kHidraw, pad);
  start();
  expect(ReportKind::added, 0);
  for (int i = 0; i < 3; ++i) {
    pad->send({0x30, 0, 0, 0, 0});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  pad->send({0x01, 0x80, 0x80});
  send_vendor_data(pad);
  for (int i = 0; i < 34; ++i) next();
  for (const std::string& remark : stream_->take_remarks()) ADD_FAILURE() << remark;
}

}  // namespace
}  // namespace gaitpad
