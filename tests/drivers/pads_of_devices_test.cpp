// Numbers: SDL's SDL_hidapi_gamecube.c for the adapter, HID 1.11 for the rest.
#include "drivers/pads/pads_of_devices.h"

#include <gtest/gtest.h>

#include <deque>

#include "drivers/scripted_port.h"
#include "tests/hid/made_pads.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

DeviceListing listed(std::uint16_t vendor, std::uint16_t product, Packet descriptor) {
  DeviceListing listing;
  listing.info.vendor = vendor;
  listing.info.product = product;
  listing.info.name = "Two";
  listing.info.driver = "hidraw";
  listing.info.physical_path = "usb-1/input0";
  listing.info.descriptor = std::move(descriptor);
  listing.node = "/dev/hidraw3";
  return listing;
}

// Two game pads with X, Y and a button each, in reports 7 and 8, and a key in report 9.
Packet two_pads() {
  Packet d;
  for (const std::uint8_t id : {7, 8})
    d.insert(d.end(),
             {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, id,   0x15, 0x00, 0x26, 0xff, 0x00, 0x75,
              0x08, 0x95, 0x02, 0x09, 0x30, 0x09, 0x31, 0x81, 0x02, 0x05, 0x09, 0x09, 0x01, 0x25,
              0x01, 0x75, 0x01, 0x95, 0x01, 0x81, 0x02, 0x95, 0x07, 0x81, 0x03, 0xc0});
  d.insert(d.end(), {0x05, 0x0c, 0x09, 0x01, 0xa1, 0x01, 0x85, 0x09, 0x09, 0xb2, 0x75, 0x08, 0x95,
                     0x01, 0x81, 0x02, 0xc0});
  return d;
}

TEST(SeveralPads, TwoPadCollectionsWithReportsOfTheirOwnAreTwoPads) {
  const auto pads = split_pads(listed(0x17ef, 0x6184, two_pads()));
  ASSERT_EQ(pads.size(), 2u);
  EXPECT_EQ(pads[0].node, "/dev/hidraw3");
  EXPECT_EQ(pads[1].node, "/dev/hidraw3:2");
  EXPECT_EQ(pads[1].info.physical_path, "usb-1/input0:2");
  EXPECT_EQ(without_number(pads[1].node), pads[0].node);
  EXPECT_EQ(without_number("usb-0000:00:14.0-1/input0"), "usb-0000:00:14.0-1/input0");
  for (std::size_t i = 0; i < pads.size(); ++i) {
    EXPECT_TRUE(is_one_of_several(pads[i].info.descriptor));
    const auto layout = value_of(pad_layout(pads[i].info, shipped_pads()));
    EXPECT_TRUE(layout.is_pad);
    const auto quirks = make_pad_quirks(pads[i].info);
    OutPacket reply;
    for (const std::uint8_t id : {7, 8}) {
      const Packet report = {id, 0xff, 0x80, 0x01};
      const bool is_own = id == (i == 0 ? 7 : 8);
      EXPECT_EQ(quirks->accept(report, reply), is_own);
      PadState state;
      decode(layout, report_of(report), state);
      EXPECT_EQ(state.axis[kLeftX], is_own ? 1.0f : 0.0f);
    }
    EXPECT_TRUE(quirks->accept(Packet{9, 1}, reply)) << "keys belong to both";
  }
}

TEST(SeveralPads, OnePadStaysOne) {
  const Packet both = two_pads();
  const Packet one(both.begin(), both.begin() + 40);
  EXPECT_TRUE(split_pads(listed(0x1209, 1, one)).empty());
  EXPECT_FALSE(is_one_of_several(one));
  EXPECT_TRUE(split_pads(listed(0x1209, 1, {})).empty());
  EXPECT_TRUE(split_pads(listed(0x1209, 1, {0xa1, 0x01})).empty());
  // Two pads in one report cannot be separated by its id.
  Packet shared = both;
  shared[40 + 7] = 0x07;
  EXPECT_TRUE(split_pads(listed(0x1209, 1, shared)).empty());
}

std::vector<DeviceListing> adapter() { return split_pads(listed(0x057e, 0x0337, {})); }
// Report 21 with this type, these buttons and axes in one plug.
Packet adapter_report(int plug, std::uint8_t type, std::array<std::uint8_t, 8> rest) {
  Packet report(37);
  report[0] = 0x21;
  const std::size_t at = 1 + 9 * static_cast<std::size_t>(plug - 1);
  report[at] = type;
  std::copy(rest.begin(), rest.end(), report.begin() + static_cast<long>(at) + 1);
  return report;
}

TEST(SeveralPads, TheGameCubeAdapterIsAPadForEachPlug) {
  const auto pads = split_pads(listed(0x057e, 0x0337, {0x05, 0x05, 0x09, 0x00, 0xa1, 0x01, 0xc0}));
  ASSERT_EQ(pads.size(), 4u);
  for (int plug = 1; plug <= 4; ++plug) {
    const DeviceInfo& info = pads[static_cast<std::size_t>(plug - 1)].info;
    const auto layout = value_of(pad_layout(info, shipped_pads()));
    EXPECT_TRUE(layout.is_pad);
    EXPECT_TRUE(is_one_of_several(info.descriptor));
    const Packet report = adapter_report(plug, 0x14, {0x81, 0x03, 255, 0, 0, 255, 255, 0});
    PadState state;
    ASSERT_TRUE(decode(layout, report_of(report), state));
    expect_state(state,
                 "left_x 1 left_y -1 right_x -1 right_y 1 left_trigger 1 buttons a start "
                 "rightshoulder dpup");
  }
}

TEST(SeveralPads, AnEmptyPlugIsAPadThatIsUnplugged) {
  const auto pads = adapter();
  ASSERT_EQ(pads.size(), 4u);
  const auto quirks = make_pad_quirks(pads[1].info);
  ScriptedPort port;
  quirks->start(port, StartedBy::us);
  ASSERT_EQ(port.written.size(), 1u);
  EXPECT_EQ(port.written[0], (Packet{0x13, 0x00}));
  OutPacket reply;
  EXPECT_TRUE(quirks->has_pad());
  EXPECT_FALSE(quirks->accept(adapter_report(1, 0x10, {}), reply)) << "another plug";
  EXPECT_FALSE(quirks->has_pad());
  EXPECT_TRUE(quirks->accept(adapter_report(2, 0x22, {}), reply)) << "wireless";
  EXPECT_TRUE(quirks->has_pad());
  EXPECT_FALSE(quirks->accept(Packet{0x21, 0x10}, reply)) << "too short";
  EXPECT_TRUE(quirks->has_pad());
  ASSERT_TRUE(quirks->factory_sticks());
  EXPECT_NEAR(quirks->factory_sticks()->left_x.max, 0.694, 0.001);
}

TEST(SeveralPads, OnePacketSetsTheMotorsOfAllPlugs) {
  const auto pads = adapter();
  const auto first = make_pad_quirks(pads[0].info), third = make_pad_quirks(pads[2].info);
  OutPacket reply;
  EXPECT_EQ(rumble_of(*first, {0xffff, 0}), (Packet{0x11, 0, 0, 0, 0})) << "power is not known";
  // Types without the second cable, and of a wireless controller.
  for (const std::uint8_t type : {0x10, 0x26}) {
    first->accept(adapter_report(1, type, {}), reply);
    EXPECT_EQ(rumble_of(*first, {0xffff, 0}), (Packet{0x11, 0, 0, 0, 0}));
  }
  first->accept(adapter_report(1, 0x14, {}), reply);
  third->accept(adapter_report(3, 0x14, {}), reply);
  EXPECT_EQ(rumble_of(*first, {0xffff, 0}), (Packet{0x11, 1, 0, 0, 0}));
  EXPECT_EQ(rumble_of(*third, {0, 1}), (Packet{0x11, 1, 0, 1, 0}));
  EXPECT_EQ(rumble_of(*first, {}), (Packet{0x11, 0, 0, 1, 0}));
  DeviceListing other = listed(0x057e, 0x0337, {});
  other.info.physical_path = "usb-2/input0";
  const auto another = make_pad_quirks(split_pads(other)[1].info);
  another->accept(adapter_report(2, 0x14, {}), reply);
  EXPECT_EQ(rumble_of(*another, {1, 1}), (Packet{0x11, 0, 1, 0, 0})) << "another adapter";
}

// ---- Joy-Cons: report 0x30 of dekuNukem's Nintendo_Switch_Reverse_Engineering

// One Joy-Con that returns the reports that the test queues.
class OneSide final : public Device {
 public:
  OneSide(std::uint16_t product, FactorySticks sticks) : sticks_(sticks) {
    info_.vendor = 0x057e;
    info_.product = product;
    info_.name = product == 0x2006 ? "Joy-Con (L)" : "Joy-Con (R)";
    info_.unique_id = product == 0x2006 ? "aa" : "bb";
    fd_.fd = product;
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&fd_, 1}; }
  Status read(Report& report) noexcept override {
    if (reports.empty()) return is_gone ? Status::gone : Status::nothing;
    report.size = 49;
    report.bytes.fill(0);
    std::copy(reports.front().begin(), reports.front().end(), report.bytes.begin());
    reports.pop_front();
    return Status::report;
  }
  bool rumble(const Rumble& rumble) noexcept override {
    strong = rumble.strong;
    return true;
  }
  std::optional<FactorySticks> factory_sticks() const override { return sticks_; }
  std::optional<FactoryGyro> factory_gyro() const override { return gyro; }

  std::deque<std::vector<std::uint8_t>> reports;
  bool is_gone = false;
  std::uint16_t strong = 0;
  std::optional<FactoryGyro> gyro;

 private:
  DeviceInfo info_;
  FactorySticks sticks_;
  pollfd fd_{-1, POLLIN, 0};
};

class JoyCons : public testing::Test {
 protected:
  JoyCons() {
    // The sticks are turned, as a single Joy-Con reports them.
    FactorySticks left_sticks, right_sticks;
    left_sticks.left_x = {-0.7, 0.01, 0.6};
    left_sticks.left_y = {-0.5, 0.02, 0.4};
    right_sticks.left_x = {-0.9, 0.03, 0.8};
    right_sticks.left_y = {-0.55, 0.04, 0.45};
    auto left = std::make_unique<OneSide>(0x2006, left_sticks);
    auto right = std::make_unique<OneSide>(0x2007, right_sticks);
    left_ = left.get();
    right_ = right.get();
    pair_ = value_of(join_joy_cons(std::move(right), std::move(left)));
  }
  std::vector<std::uint8_t> next() {
    Report report;
    if (pair_->read(report) != Device::Status::report) return {};
    side_ = report.bytes[12];
    return {report.bytes.begin(), report.bytes.begin() + 12};
  }
  OneSide* left_;
  OneSide* right_;
  std::unique_ptr<Device> pair_;
  std::uint8_t side_ = 0;  // byte 12 of the last report, which names a side
};

TEST_F(JoyCons, EachReportHasTheNewestOfBothSides) {
  EXPECT_EQ(pair_->info().product, 0x2008);
  EXPECT_EQ(pair_->info().unique_id, "aa+bb");
  EXPECT_EQ(pair_->poll_fds().size(), 2u);
  // The left one presses minus and its D-pad; its values for the right half are ignored.
  left_->reports.push_back({0x30, 1, 0x8e, 0xff, 0xff, 0x02, 0x11, 0x22, 0x33, 0xff, 0xff, 0xff});
  const std::vector<std::uint8_t> first = {0x30, 1,    0x8e, 0x00, 0x29, 0x02,
                                           0x11, 0x22, 0x33, 0x00, 0x08, 0x80};
  EXPECT_EQ(next(), first);
  right_->reports.push_back({0x30, 7, 0x8c, 0x08, 0x02, 0xff, 0, 0, 0, 0x44, 0x55, 0x66});
  const std::vector<std::uint8_t> second = {0x30, 7,    0x8c, 0x08, 0x2b, 0x02,
                                            0x11, 0x22, 0x33, 0x44, 0x55, 0x66};
  EXPECT_EQ(next(), second);
  EXPECT_TRUE(next().empty());
}

TEST_F(JoyCons, OtherReportsAreLeftOutBothRumbleAndOneThatIsGoneEndsThePair) {
  left_->reports.push_back({0x3f, 0, 0, 8});
  right_->reports.push_back({0x30, 7, 0x8c, 0x08, 0x00, 0x00, 0, 0, 0, 0x44, 0x55, 0x66});
  EXPECT_EQ(next()[3], 0x08);
  EXPECT_TRUE(pair_->rumble({40000, 0}));
  EXPECT_EQ(left_->strong, 40000);
  EXPECT_EQ(right_->strong, 40000);
  right_->is_gone = true;
  Report report;
  EXPECT_EQ(pair_->read(report), Device::Status::gone);
}

TEST_F(JoyCons, AReportSaysWhoseSensorsItHasAndTheFactorysAreTheRightOnes) {
  // Both sides answer 0x0b for their motors.
  left_->reports.push_back({0x30, 1, 0x8e, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x0b, 0x77});
  EXPECT_FALSE(next().empty());
  EXPECT_EQ(side_, 'L');
  right_->reports.push_back({0x30, 1, 0x8e, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x0b, 0x55});
  EXPECT_FALSE(next().empty());
  EXPECT_EQ(side_, 'R');
  left_->gyro = FactoryGyro{{1.0, 2.0, 3.0}, {}};
  EXPECT_FALSE(pair_->factory_gyro());
  right_->gyro = FactoryGyro{{4.0, 5.0, 6.0}, {}};
  EXPECT_EQ(pair_->factory_gyro().value().zero, (std::array<double, 3>{4.0, 5.0, 6.0}));
}

TEST_F(JoyCons, TheSticksAreThoseOfJoyConsHeldUpright) {
  const FactorySticks sticks = pair_->factory_sticks().value();
  EXPECT_DOUBLE_EQ(sticks.left_x.min, -0.5);
  EXPECT_DOUBLE_EQ(sticks.left_y.min, -0.6);
  EXPECT_DOUBLE_EQ(sticks.left_y.centre, -0.01);
  EXPECT_DOUBLE_EQ(sticks.left_y.max, 0.7);
  EXPECT_DOUBLE_EQ(sticks.right_x.min, -0.45);
  EXPECT_DOUBLE_EQ(sticks.right_x.max, 0.55);
  EXPECT_DOUBLE_EQ(sticks.right_y.max, 0.8);
}

TEST(JoyConPairs, TwoOfOneSideAreNoPair) {
  auto joined = join_joy_cons(std::make_unique<OneSide>(0x2006, FactorySticks()),
                              std::make_unique<OneSide>(0x2006, FactorySticks()));
  EXPECT_FALSE(joined);
}

DeviceListing listed(std::uint16_t product, const std::string& node,
                     const std::string& name = "Joy-Con") {
  DeviceListing listing;
  listing.info.vendor = 0x057e;
  listing.info.product = product;
  listing.info.name = name;
  listing.node = node;
  listing.pad_path = "/sys" + node;
  return listing;
}

TEST(JoyConPairs, ALeftAndARightOneThatCanBeOpenedAreListedAsAPair) {
  std::vector<DeviceListing> singles = {listed(0x2006, "/a"), listed(0x2009, "/p"),
                                        listed(0x2007, "/b"), listed(0x2006, "/c")};
  auto pairs = joy_con_pairs(singles);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].node, "/a+/b");
  EXPECT_EQ(pairs[0].parts, (std::vector<std::string>{"/sys/a", "/sys/b"}));
  EXPECT_EQ(pairs[0].info.product, 0x2008);
  singles[2].problem = "/b: permission denied";
  EXPECT_TRUE(joy_con_pairs(singles).empty());
}

TEST(JoyConPairs, NesControllersStaySingleAndTheHalvesOfAGripArePaired) {
  EXPECT_TRUE(joy_con_pairs(
                  {listed(0x2006, "/a", "NES Controller"), listed(0x2007, "/b", "NES Controller")})
                  .empty());
  EXPECT_EQ(
      joy_con_pairs({listed(0x200e, "/a"), listed(0x200e, "/b"), listed(0x200e, "/c")}).size(), 1u);
}

// ---- Receivers

// xpad.c writes the port of the device and `/input0`; an Xbox 360 receiver's pads are on interfaces
// 0, 2, 4, 6. xone has a GIP client for each pad below the dongle's one interface.
TEST(PadsOfDevices, PadsBehindAReceiverHaveAPortAndAPathEach) {
  const std::string port = "usb-0000:00:14.0-2/input0", path = "/sys/x/1-2/1-2:1.0";
  EXPECT_EQ(port_behind_receiver(port, "xpad", 0), port);
  EXPECT_EQ(port_behind_receiver(port, "xpad", 2), "usb-0000:00:14.0-2/input2");
  EXPECT_EQ(port_behind_receiver(port, "hid-generic", 2), port);
  EXPECT_EQ(path_behind_receiver(path, "xone-dongle", path + "/gip1/gip1.0"),
            path + "/gip1/gip1.0");
  EXPECT_EQ(path_behind_receiver(path, "xpad", "/sys/x"), path);
}

}  // namespace
}  // namespace gaitpad
