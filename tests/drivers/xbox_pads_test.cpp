// Packets of both Xbox protocols over USB, byte by byte after Linux's xpad (xpad360_process_packet,
// xpadone_process_packet, xpad_play_effect), decoded by the descriptor that the quirks state and
// the shipped files.
#include "drivers/scripted_port.h"
#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

constexpr std::uint16_t kMicrosoft = 0x045e, kXbox360 = 0x028e, kOneS = 0x02ea, kSeries = 0x0b12;
constexpr UsbInterfaceClass kInterface360{0xff, 0x5d, 0x01}, kInterfaceGip{0xff, 0x47, 0xd0};

// Pairs of a byte's place and its value.
using Changes = std::vector<std::pair<std::size_t, std::uint8_t>>;
Packet changed(Packet packet, const Changes& changes) {
  for (const auto& [byte, value] : changes) packet[byte] = value;
  return packet;
}
// A packet with nothing pressed except for these bytes.
Packet of_360(const Changes& changes = {}) {
  return changed(changed(Packet(20), {{1, 0x14}}), changes);
}
Packet of_gip(const Changes& changes = {}, std::size_t size = 18) {
  return changed(
      changed(Packet(size), {{0, 0x20}, {2, 0x01}, {3, static_cast<std::uint8_t>(size - 4)}}),
      changes);
}

class XboxPad : public testing::Test {
 protected:
  void use(bool is_gip, std::uint16_t vendor, std::uint16_t product) {
    DeviceInfo info;
    info.bus = BusType::usb;
    info.vendor = vendor;
    info.product = product;
    info.driver = "usb";
    info.name = "pad";
    VendorPad pad =
        is_gip ? make_gip_pad(kInterfaceGip, info) : make_xbox_360_pad(kInterface360, info);
    info.descriptor = pad.descriptor;
    layout_ = value_of(pad_layout(info, shipped_pads()));
    EXPECT_TRUE(layout_.is_pad);
    EXPECT_TRUE(layout_.unnamed.empty());
    quirks_ = std::move(pad.quirks);
    state_ = {};
  }
  void use_360() { use(false, kMicrosoft, kXbox360); }
  void use_gip() { use(true, kMicrosoft, kOneS); }
  // Decodes a packet as the driver does.
  bool decodes(const Packet& packet) {
    OutPacket reply;
    if (!quirks_->accept(packet, reply)) return false;
    const std::span<const std::uint8_t> input = quirks_->report_of(packet);
    return decode(layout_, report_of(Packet(input.begin(), input.end())), state_);
  }
  bool accepts(const Packet& packet) { return quirks_->accept(packet, reply_); }
  void expect_read(const Packet& packet, const std::string& words) {
    EXPECT_TRUE(decodes(packet)) << words;
    expect_state(state_, words);
  }
  // Expects that each bit of a byte is the named button; "" for none.
  void expect_bits(const Packet& neutral, std::size_t byte, const std::vector<std::string>& names) {
    for (std::size_t bit = 0; bit < 8; ++bit)
      expect_read(changed(neutral, {{byte, static_cast<std::uint8_t>(1u << bit)}}),
                  names[bit].empty() ? "" : "buttons " + names[bit]);
  }

  PadLayout layout_;
  PadState state_;
  std::unique_ptr<PadQuirks> quirks_;
  OutPacket reply_;
};

TEST_F(XboxPad, EveryButtonHasItsBit) {
  use_360();
  expect_bits(of_360(), 2,
              {"dpup", "dpdown", "dpleft", "dpright", "start", "back", "leftstick", "rightstick"});
  expect_bits(of_360(), 3, {"leftshoulder", "rightshoulder", "guide", "", "a", "b", "x", "y"});
  use_gip();
  expect_bits(of_gip(), 4, {"", "", "start", "back", "a", "b", "x", "y"});
  expect_bits(of_gip(), 5,
              {"dpup", "dpdown", "dpleft", "dpright", "leftshoulder", "rightshoulder", "leftstick",
               "rightstick"});
}

// The packets have left x and y 32767, right x -32768 and y -16384; triggers have 8 bits, and 10.
TEST_F(XboxPad, SticksAreSixteenBitsWithYForwardAsThePadSendsIt) {
  use_360();
  expect_read(of_360({{6, 0xff}, {7, 0x7f}, {8, 0xff}, {9, 0x7f}, {11, 0x80}, {13, 0xc0}}),
              "left_x 1 left_y 1 right_x -1 right_y -0.5");
  EXPECT_FLOAT_EQ(state_.axis[kLeftY], 1.0f);
  expect_read(of_360({{4, 0xff}, {5, 0x33}}), "left_trigger 1 right_trigger 0.2");
  EXPECT_FLOAT_EQ(state_.axis[kRightTrigger], 0.2f);
  use_gip();
  expect_read(of_gip({{6, 0xff},
                      {7, 0x03},
                      {9, 0x01},
                      {10, 0xff},
                      {11, 0x7f},
                      {12, 0xff},
                      {13, 0x7f},
                      {15, 0x80},
                      {17, 0xc0}}),
              "left_x 1 left_y 1 right_x -1 right_y -0.5 left_trigger 1 right_trigger 0.25");
  EXPECT_NEAR(state_.axis[kRightTrigger], 256.0f / 1023.0f, 1e-6f);
  EXPECT_NEAR(state_.axis[kRightY], -0.5, 1e-4);
}

TEST_F(XboxPad, OtherMakersPadsAreTheSame) {
  use(false, 0x046d, 0xc21d);  // a Logitech F310
  expect_read(of_360({{8, 0xff}, {9, 0x7f}, {3, 0x04}}), "left_y 1 buttons guide");
  use(true, 0x20d6, 0x2001);  // a PowerA pad
  expect_read(of_gip({{12, 0xff}, {13, 0x7f}, {5, 0x80}}), "left_y 1 buttons rightstick");
}

TEST_F(XboxPad, GuideOfGipComesInAMessageOfItsOwnAndLeavesTheRest) {
  use_gip();
  const Packet a = of_gip({{4, 0x10}});
  ASSERT_TRUE(decodes(a));
  expect_read({0x07, 0x20, 0x02, 0x02, 0x01, 0x5b}, "buttons a guide");
  expect_read(a, "buttons a guide");
  expect_read({0x07, 0x20, 0x03, 0x02, 0x00, 0x5b}, "buttons a");
}

// Byte 22 of 48, by current firmware of the Xbox Series pad (SDL, SDL_hidapi_xboxone.c).
TEST_F(XboxPad, SeriesPadsHaveAShareButton) {
  use(true, kMicrosoft, kSeries);
  expect_read(of_gip({{12, 0xff}, {13, 0x7f}, {22, 0x01}}, 48), "left_y 1 buttons misc1");
  expect_read(of_gip({{4, 0x40}}, 48), "buttons x");
  expect_read({0x07, 0x20, 0x02, 0x02, 0x01, 0x5b}, "buttons x guide");
  EXPECT_TRUE(decodes(of_gip({}, 36)));  // packets of older firmware lack the button
}

// Sizes and places are from SDL_hidapi_xboxone.c, counted from the header on.
TEST_F(XboxPad, TheShareButtonIsWhereThePacketsSizeSays) {
  const std::pair<std::size_t, std::size_t> kPlaces[] = {
      {36, 18}, {44, 18}, {48, 22}, {50, 32}, {64, 46}};
  for (const auto& [size, at] : kPlaces) {
    use(true, 0x0e6f, 0x02d6);
    expect_read(of_gip({{at, 0x01}, {4, 0x10}}, size), "buttons a misc1");
    expect_read(of_gip({{at, 0xfe}}, size), "");
  }
  expect_read(of_gip({{18, 0x01}}, 40), "");
}

TEST_F(XboxPad, ElitePadsHavePaddlesUnlessTheyMapThemThemselves) {
  // Names of P1 .. P4.
  const std::vector<std::string> names = {"paddle1", "paddle3", "paddle2", "paddle4"};
  const auto expect_paddles = [&](const Packet& neutral, std::size_t at, std::array<int, 4> bits) {
    for (std::size_t i = 0; i < names.size(); ++i)
      expect_read(changed(neutral, {{at, static_cast<std::uint8_t>(bits[i])}}),
                  "buttons " + names[i]);
  };
  use(true, kMicrosoft, 0x02e3);  // the first Elite pad
  expect_paddles(of_gip({}, 33), 32, {2, 8, 1, 4});
  // The pad presses its button b for P1.
  expect_read(of_gip({{32, 0x02}, {4, 0x20}, {18, 0x00}}, 33), "buttons b");
  use(true, kMicrosoft, 0x0b00);
  expect_paddles(of_gip({}, 38), 18, {1, 2, 4, 8});
  expect_read(of_gip({{18, 0x0f}, {19, 0x01}}, 38), "");
  expect_paddles(of_gip({}, 50), 22, {1, 2, 4, 8});
  expect_read(of_gip({{32, 0x01}}, 50), "");
}

TEST_F(XboxPad, GipIsSwitchedOnWithoutWaitingForAnAnnouncementAndAnswersOne) {
  use_gip();
  ScriptedPort port;
  quirks_->start(port, StartedBy::us);
  EXPECT_EQ(port.written, (std::vector<Packet>{{0x05, 0x20, 1, 0x01, 0x00},
                                               {0x05, 0x20, 2, 0x0f, 0x06},
                                               {0x0a, 0x20, 3, 0x03, 0x00, 0x01, 0x14},
                                               {0x06, 0x20, 4, 0x02, 0x01, 0x00}}));
  use_gip();
  EXPECT_FALSE(accepts(changed(Packet(32), {{0, 0x02}, {1, 0x20}, {2, 0x01}, {3, 0x1c}})));
  EXPECT_EQ(bytes_of(reply_), (Packet{0x05, 0x20, 1, 0x01, 0x00}));
}

TEST_F(XboxPad, WhatAsksForAnAnswerGetsOneUnderItsNumber) {
  use_gip();
  EXPECT_TRUE(accepts({0x07, 0x30, 0x2a, 0x02, 0x01, 0x5b}));
  EXPECT_EQ(bytes_of(reply_), (Packet{0x01, 0x20, 0x2a, 9, 0, 0x07, 0x20, 0x02, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(accepts(of_gip()));
  EXPECT_EQ(reply_.size, 0u);
}

TEST_F(XboxPad, MessagesOfTheProtocolAreNoInput) {
  use_360();
  EXPECT_TRUE(accepts(of_360()));
  for (const Packet& state : {Packet{0x01, 0x03, 0x06}, {0x03, 0x03, 0x03}, {0x08, 0x03, 0x00}, {}})
    EXPECT_FALSE(accepts(state));
  EXPECT_EQ(reply_.size, 0u);
  EXPECT_EQ(quirks_->lost(), 0);
  use_gip();
  for (const std::uint8_t command : {0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x08, 0x1e, 0x60}) {
    EXPECT_FALSE(accepts({command, 0x20, 0x01, 0x00})) << int{command};
    EXPECT_FALSE(accepts({command})) << int{command};
  }
  EXPECT_FALSE(accepts(of_gip({{1, 0x01}}))) << "of what is plugged into the pad";
}

TEST_F(XboxPad, PartsOfLongMessagesAreIgnored) {
  use_gip();
  EXPECT_FALSE(accepts({0x04, 0xf0, 0x01, 0xba, 0x10, 0x20}));
  EXPECT_EQ(reply_.size, 0u);
  EXPECT_EQ(quirks_->lost(), 0);
  EXPECT_FALSE(accepts(of_gip({{1, 0xa0}})));
  EXPECT_EQ(quirks_->lost(), 1);
}

TEST_F(XboxPad, ShortPacketsAreHandedOnAndChangeNothing) {
  for (const bool is_gip : {false, true}) {
    is_gip ? use_gip() : use_360();
    const Packet packet = is_gip ? of_gip({{4, 0x10}}) : of_360({{3, 0x10}});
    for (std::size_t size = 1; size < packet.size(); ++size) {
      const Packet part(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_TRUE(accepts(part)) << size;
      EXPECT_FALSE(decodes(part)) << size;
    }
    EXPECT_EQ(state_, PadState{});
    EXPECT_FALSE(accepts({}));
  }
}

TEST_F(XboxPad, LongPacketsAreReadAsFarAsTheyAreKnown) {
  use_360();
  Packet packet = of_360({{3, 0x10}});
  packet.resize(kMaxReportBytes, 0xff);
  EXPECT_TRUE(accepts(packet));
  expect_read(packet, "buttons a");
}

TEST_F(XboxPad, UnknownPacketsChangeNothing) {
  use_360();
  for (int id = 1; id < 256; ++id)
    EXPECT_FALSE(accepts(changed(Packet(20, 0xff), {{0, static_cast<std::uint8_t>(id)}}))) << id;
  EXPECT_FALSE(accepts({0x00, 0x15, 0x00}));
  EXPECT_EQ(quirks_->lost(), 256);
  use_gip();
  const Packet unknown = of_gip({{0, 0x77}, {1, 0xff}, {4, 0x10}});
  EXPECT_TRUE(accepts(unknown)) << "handed on";
  EXPECT_EQ(reply_.size, 0u);
  EXPECT_FALSE(decodes(unknown));
  EXPECT_EQ(state_, PadState{});
}

TEST_F(XboxPad, TheLightOfA360IsSetAtTheStart) {
  use_360();
  ScriptedPort port;
  quirks_->start(port, StartedBy::us);
  EXPECT_EQ(port.written, (std::vector<Packet>{{0x01, 0x03, 0x06}}));
}

TEST_F(XboxPad, RumbleIsScaledAsTheKernelDoesWithTheStrongMotorFirst) {
  constexpr Rumble kRumble{0xc000, 0x4000};
  use_360();
  EXPECT_EQ(rumble_of(*quirks_, kRumble), (Packet{0x00, 0x08, 0x00, 0xc0, 0x40, 0x00, 0x00, 0x00}));
  EXPECT_EQ(rumble_of(*quirks_, {}), (Packet{0x00, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}));
  use_gip();
  const auto gip = [](std::uint8_t number, std::uint8_t strong, std::uint8_t weak) {
    return Packet{0x09, 0x00, number, 0x09, 0x00, 0x0f, 0x00, 0x00, strong, weak, 0xff, 0x00, 0xff};
  };
  EXPECT_EQ(rumble_of(*quirks_, kRumble), gip(1, 0x60, 0x20));
  EXPECT_EQ(rumble_of(*quirks_, {}), gip(2, 0, 0));
  for (int i = 0; i < 600; ++i) EXPECT_NE(rumble_of(*quirks_, {})[2], 0) << "no number is zero";
}

TEST(XboxPads, OtherInterfacesAreNone) {
  // Interface of the pad's headset.
  EXPECT_EQ(make_xbox_360_pad({0xff, 0x5d, 0x03}, {}).quirks, nullptr);
  EXPECT_EQ(make_xbox_360_pad(kInterfaceGip, {}).quirks, nullptr);
  EXPECT_EQ(make_xbox_360_pad({0x03, 0x00, 0x00}, {}).quirks, nullptr);
  EXPECT_EQ(make_gip_pad(kInterface360, {}).quirks, nullptr);
  EXPECT_EQ(make_gip_pad({0x03, 0x01, 0x01}, {}).quirks, nullptr);
}

}  // namespace
}  // namespace gaitpad
