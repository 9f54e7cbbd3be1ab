// Numbers: SDL's SDL_hidapi_gamecube.c for the adapter, HID 1.11 for the rest.
#include "drivers/pads/several_pads.h"

#include <gtest/gtest.h>

#include "drivers/scripted_port.h"
#include "tests/hid/made_pads.h"

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
    const auto model = make_pad_model(pads[i].info);
    OutPacket reply;
    for (const std::uint8_t id : {7, 8}) {
      const Packet report = {id, 0xff, 0x80, 0x01};
      const bool is_own = id == (i == 0 ? 7 : 8);
      EXPECT_EQ(model->accept(report, reply), is_own);
      PadState state;
      decode(layout, report_of(report), state);
      EXPECT_EQ(state.axis[kLeftX], is_own ? 1.0f : 0.0f);
    }
    EXPECT_TRUE(model->accept(Packet{9, 1}, reply)) << "keys belong to both";
  }
}

TEST(SeveralPads, OnePadStaysOne) {
  const Packet both = two_pads();
  const Packet one(both.begin(), both.begin() + 40);
  EXPECT_TRUE(split_pads(listed(0x1209, 1, one)).empty());
  EXPECT_FALSE(is_one_of_several(one));
  EXPECT_TRUE(split_pads(listed(0x1209, 1, {})).empty());
  EXPECT_TRUE(split_pads(listed(0x1209, 1, {0xa1, 0x01})).empty());
  // Twins in one report cannot be told apart by its id.
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
  const auto model = make_pad_model(pads[1].info);
  ScriptedPort port;
  model->start(port, StartedBy::us);
  ASSERT_EQ(port.written.size(), 1u);
  EXPECT_EQ(port.written[0], (Packet{0x13, 0x00}));
  OutPacket reply;
  EXPECT_TRUE(model->is_plugged());
  EXPECT_FALSE(model->accept(adapter_report(1, 0x10, {}), reply)) << "another plug";
  EXPECT_FALSE(model->is_plugged());
  EXPECT_TRUE(model->accept(adapter_report(2, 0x22, {}), reply)) << "wireless";
  EXPECT_TRUE(model->is_plugged());
  EXPECT_FALSE(model->accept(Packet{0x21, 0x10}, reply)) << "too short";
  EXPECT_TRUE(model->is_plugged());
  ASSERT_TRUE(model->factory_sticks());
  EXPECT_NEAR(model->factory_sticks()->left_x.max, 0.694, 0.001);
}

TEST(SeveralPads, OnePacketSetsTheMotorsOfAllPlugs) {
  const auto pads = adapter();
  const auto first = make_pad_model(pads[0].info), third = make_pad_model(pads[2].info);
  OutPacket reply;
  EXPECT_EQ(rumble_of(*first, {0xffff, 0}), (Packet{0x11, 0, 0, 0, 0})) << "power is not known";
  for (const std::uint8_t type : {0x10, 0x26}) {  // no second cable, wireless
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
  const auto another = make_pad_model(split_pads(other)[1].info);
  another->accept(adapter_report(2, 0x14, {}), reply);
  EXPECT_EQ(rumble_of(*another, {1, 1}), (Packet{0x11, 0, 1, 0, 0})) << "another adapter";
}

}  // namespace
}  // namespace gaitpad
