// Numbers: Linux's hid-steam.c, SDL's steam/controller_constants.h, SDL_hidapi_steam.c,
// SDL_hidapi_stadia.c and others.
#include <gtest/gtest.h>

#include "drivers/pads/pads_of_devices.h"
#include "drivers/scripted_port.h"

namespace gaitpad {
namespace {

// Keeps the feature reports that are sent.
class FeaturePort final : public PadPort {
 public:
  bool write(std::span<const std::uint8_t>) noexcept override { return false; }
  std::size_t read(std::span<std::uint8_t>, std::chrono::milliseconds) noexcept override {
    return 0;
  }
  std::size_t feature(std::uint8_t, std::span<std::uint8_t>) noexcept override { return 0; }
  bool send_feature(std::span<const std::uint8_t> packet) noexcept override {
    sent.emplace_back(packet.begin(), packet.end());
    return is_there;
  }
  std::vector<Packet> sent;
  bool is_there = true;
};

DeviceInfo steam(std::uint16_t product, std::uint8_t page) {
  DeviceInfo info;
  info.vendor = 0x28de;
  info.product = product;
  info.descriptor = {0x06, page, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x09, 0x02, 0x15, 0x00,
                     0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x40, 0x81, 0x02, 0xc0};
  return info;
}

Packet begin_of(const Packet& packet, std::size_t size) {
  return {packet.begin(), packet.begin() + static_cast<long>(size)};
}

TEST(Steam, LeavesLizardModeAndRestoresIt) {
  FeaturePort port;
  const auto deck = make_steam_quirks(steam(0x1205, 0xff));
  ASSERT_NE(deck, nullptr);
  deck->start(port, StartedBy::kernel);
  ASSERT_EQ(port.sent.size(), 2u);
  EXPECT_EQ(port.sent[0].size(), 65u);
  EXPECT_EQ(begin_of(port.sent[0], 3), (Packet{0, 0x81, 0}));
  EXPECT_EQ(begin_of(port.sent[1], 18),
            (Packet{0, 0x87, 15, 7, 7, 0, 8, 7, 0, 52, 0xff, 0xff, 53, 0xff, 0xff, 71, 0, 0}));
  deck->stop(port);
  ASSERT_EQ(port.sent.size(), 4u);
  EXPECT_EQ(begin_of(port.sent[2], 3), (Packet{0, 0x85, 0}));
  EXPECT_EQ(begin_of(port.sent[3], 3), (Packet{0, 0x8e, 0}));
  EXPECT_TRUE(deck->take_remarks().empty());

  FeaturePort other;
  const auto controller = make_steam_quirks(steam(0x1102, 0x00));
  ASSERT_NE(controller, nullptr);
  controller->start(other, StartedBy::us);
  controller->stop(other);
  ASSERT_EQ(other.sent.size(), 5u);
  EXPECT_EQ(begin_of(other.sent[1], 9), (Packet{0, 0x87, 6, 8, 7, 0, 24, 0, 0}));
  EXPECT_EQ(begin_of(other.sent[4], 6), (Packet{0, 0x87, 3, 24, 1, 0}));
}

TEST(Steam, APadThatRefusesIsToldOf) {
  FeaturePort port;
  port.is_there = false;
  const auto deck = make_steam_quirks(steam(0x1205, 0xff));
  deck->start(port, StartedBy::us);
  EXPECT_EQ(deck->take_remarks().size(), 1u);
}

TEST(Steam, OnlyStatesAreInput) {
  OutPacket reply;
  const auto deck = make_steam_quirks(steam(0x1205, 0xff));
  EXPECT_TRUE(deck->accept(Packet{1, 0, 9, 64}, reply));
  EXPECT_FALSE(deck->accept(Packet{1, 0, 1, 60}, reply));
  EXPECT_FALSE(deck->accept(Packet{1, 0}, reply));
  const auto controller = make_steam_quirks(steam(0x1142, 0x00));
  EXPECT_TRUE(controller->accept(Packet{1, 0, 1, 60}, reply));
  EXPECT_FALSE(controller->accept(Packet{1, 0, 4, 11}, reply)) << "battery";
}

TEST(Steam, ItsMouseAndKeyboardAreLeftAlone) {
  DeviceInfo mouse = steam(0x1205, 0xff);
  mouse.descriptor = {0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0xc0};
  EXPECT_EQ(make_steam_quirks(mouse), nullptr);
}

// hid-steam.c: a message of 64 bytes is 1, 0, its type, its length; type 3: the pad behind the
// receiver left (1) or arrived (2).
Packet steam_message(std::uint8_t type, std::uint8_t first) {
  Packet message(64);
  message[0] = 1;
  message[2] = type;
  message[4] = first;
  return message;
}

TEST(SteamReceiver, IsAskedWhetherAPadIsOnAndTellsWhenThatChanges) {
  FeaturePort port;
  const auto receiver = make_steam_quirks(steam(0x1142, 0x00));
  ASSERT_NE(receiver, nullptr);
  receiver->start(port, StartedBy::us);
  EXPECT_EQ(begin_of(port.sent.back(), 3), (Packet{0, 0xb4, 0}));
  PlugWatch plug;
  Report event;
  OutPacket reply;
  EXPECT_FALSE(receiver->accept(steam_message(3, 1), reply));
  ASSERT_TRUE(plug.has_changed(*receiver, event));
  EXPECT_EQ(event.kind, ReportKind::removed);
  EXPECT_FALSE(receiver->accept(steam_message(4, 0), reply)) << "battery";
  EXPECT_FALSE(plug.has_changed(*receiver, event));
  EXPECT_FALSE(receiver->accept(steam_message(3, 2), reply));
  ASSERT_TRUE(plug.has_changed(*receiver, event));
  EXPECT_EQ(event.kind, ReportKind::added);
}

TEST(SteamReceiver, APadThatIsSwitchedOnLeavesLizardModeAgain) {
  const auto receiver = make_steam_quirks(steam(0x1142, 0x00));
  EXPECT_TRUE(receiver->replies());
  std::vector<Packet> sent;
  const auto take = [&](const Packet& packet) {
    OutPacket reply;
    receiver->accept(packet, reply);
    if (reply.size == 0) return;
    EXPECT_TRUE(reply.is_feature);
    EXPECT_EQ(reply.size, 65u);
    sent.emplace_back(reply.bytes.begin(), reply.bytes.begin() + 9);
  };
  for (int i = 0; i < 100; ++i) take(steam_message(1, 0));
  EXPECT_TRUE(sent.empty());
  take(steam_message(3, 2));
  for (int i = 0; i < 100; ++i) take(steam_message(1, 0));
  EXPECT_EQ(sent,
            (std::vector<Packet>{{0, 0x81, 0, 0, 0, 0, 0, 0, 0}, {0, 0x87, 6, 8, 7, 0, 24, 0, 0}}));
  EXPECT_FALSE(make_steam_quirks(steam(0x1102, 0x00))->replies());
}

// A report of 20 bytes over Bluetooth: the id, this header, these bytes of a message.
Packet segment(std::uint8_t header, Packet message) {
  message.insert(message.begin(), {3, header});
  message.resize(20);
  return message;
}
Packet handed_on(PadQuirks& pad, const Packet& packet) {
  OutPacket reply;
  if (!pad.accept(packet, reply)) return {};
  const auto report = pad.report_of(packet);
  return {report.begin(), report.end()};
}

TEST(SteamBluetooth, AStateIsPutTogetherFromWhatChanged) {
  for (const std::uint16_t product : {0x1105, 0x1106}) {
    const auto pad = make_steam_quirks(steam(product, 0x00));
    ASSERT_NE(pad, nullptr);
    // A message with buttons, triggers and stick: bits 10, 20 and 80 of the first byte, whose lower
    // half is 4.
    EXPECT_EQ(handed_on(*pad, segment(0xc0, {0xb4, 0, 0x80, 0, 0x40, 7, 9, 0xff, 0x7f, 0, 0x80})),
              (Packet{3, 0x80, 0, 0x40, 7, 9, 0xff, 0x7f, 0, 0x80, 0, 0, 0, 0, 0, 0, 0, 0}));
    // A message with the right pad only, bit 200: the other values stay.
    EXPECT_EQ(handed_on(*pad, segment(0xc0, {0x04, 2, 1, 2, 3, 4})),
              (Packet{3, 0x80, 0, 0x40, 7, 9, 0xff, 0x7f, 0, 0x80, 1, 2, 3, 4, 0, 0, 0, 0}));
    EXPECT_TRUE(handed_on(*pad, segment(0xc0, {0x05, 0, 90})).empty()) << "battery";
    EXPECT_TRUE(handed_on(*pad, segment(0x00, {0xb4})).empty()) << "an empty segment";
    EXPECT_TRUE(handed_on(*pad, Packet{3, 0xc0, 0x14, 0, 0xff}).empty()) << "too short";
    EXPECT_TRUE(handed_on(*pad, Packet{2, 0, 0, 0}).empty()) << "the mouse";
  }
}

TEST(SteamBluetooth, AMessageOfSeveralReportsIsReadOnlyWhole) {
  const auto pad = make_steam_quirks(steam(0x1106, 0x00));
  // A message with all parts: two bytes, then 3 + 2 + 3 + 4 + 4 = 16, and the right pad in the
  // second report.
  const Packet first = {0xf4, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  EXPECT_TRUE(handed_on(*pad, segment(0x80, first)).empty());
  EXPECT_EQ(handed_on(*pad, segment(0xc1, {17, 18, 19, 20})),
            (Packet{3, 1, 2, 3, 4, 5, 9, 10, 11, 12, 17, 18, 19, 20, 13, 14, 15, 16}));
  // A lost report voids the message, and the next one starts a new one.
  EXPECT_TRUE(handed_on(*pad, segment(0xc1, {1, 1, 1, 1})).empty());
  EXPECT_TRUE(handed_on(*pad, segment(0x80, first)).empty());
  EXPECT_TRUE(handed_on(*pad, segment(0xc2, {1, 1, 1, 1})).empty());
  EXPECT_EQ(handed_on(*pad, segment(0xc0, {0x24, 0, 0, 0})).size(), 18u);
  // A message whose end never comes, and one that ends within a part.
  for (int i = 0; i < 20; ++i)
    EXPECT_TRUE(handed_on(*pad, segment(static_cast<std::uint8_t>(0x80 | (i & 7)), {})).empty());
  EXPECT_TRUE(handed_on(*pad, segment(0xc0, {0xf4, 3})).empty());
}

TEST(SteamBluetooth, LeavesLizardModeInReportsOf20Bytes) {
  FeaturePort port;
  const auto pad = make_steam_quirks(steam(0x1106, 0x00));
  pad->start(port, StartedBy::us);
  ASSERT_EQ(port.sent.size(), 3u);
  EXPECT_EQ(port.sent[0], segment(0xc0, {0x81, 0}));
  EXPECT_EQ(port.sent[2], segment(0xc0, {0x87, 12, 49, 2, 0, 7, 7, 0, 8, 7, 0, 24, 0, 0}));
  pad->stop(port);
  ASSERT_EQ(port.sent.size(), 6u);
  EXPECT_EQ(port.sent[3], segment(0xc0, {0x85, 0}));
  EXPECT_EQ(port.sent[5], segment(0xc0, {0x87, 3, 8, 0, 0}));
  EXPECT_TRUE(pad->take_remarks().empty());
  port.is_there = false;
  pad->start(port, StartedBy::us);
  EXPECT_EQ(pad->take_remarks().size(), 1u);
}

TEST(MotorPads, GetTheirOwnPackets) {
  const auto rumble = [](std::uint16_t vendor, std::uint16_t product) {
    DeviceInfo info;
    info.vendor = vendor;
    info.product = product;
    return rumble_of(*make_pad_quirks(info), {0xc0ff, 0x4001});
  };
  EXPECT_EQ(rumble(0x18d1, 0x9400), (Packet{0x05, 0xff, 0xc0, 0x01, 0x40}));
  EXPECT_EQ(rumble(0x0171, 0x0419), (Packet{0x03, 0x0f, 0, 0, 75, 24, 0xff, 0, 0xeb}));
  for (const std::uint16_t xbox : {0x02e0, 0x02fd, 0x0b05, 0x0b13, 0x0b20, 0x0b22})
    EXPECT_EQ(rumble(0x045e, xbox), rumble(0x0171, 0x0419)) << xbox;
  EXPECT_EQ(rumble(0x2dc8, 0x6012), (Packet{0x05, 0xc0, 0x40, 0, 0}));
  EXPECT_TRUE(rumble(0x1209, 0x0001).empty());
}

}  // namespace
}  // namespace gaitpad
