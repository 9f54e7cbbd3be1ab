// Byte by byte after Linux's xpad (xpadone_process_packet, xpad_play_effect).
#include "drivers/xbox_pad.h"

namespace gaitpad {
namespace {

constexpr UsbInterfaceClass kGip{0xff, 0x47, 0xd0};
constexpr std::uint16_t kMicrosoft = 0x045e, kOneS = 0x02ea, kSeries = 0x0b12;

class Gip : public XboxPad {
 protected:
  void SetUp() override { use(kMicrosoft, kOneS); }
  void use(std::uint16_t vendor, std::uint16_t product) {
    XboxPad::use(&make_gip_pad, kGip, vendor, product);
  }
  static Packet neutral(std::size_t size = 18) {
    Packet packet(size);
    packet[0] = 0x20, packet[2] = 0x01, packet[3] = static_cast<std::uint8_t>(size - 4);
    return packet;
  }
};

TEST_F(Gip, EveryButtonHasItsBit) {
  constexpr int kByte4[] = {-1,       -1,       kButtonStart, kButtonBack,
                            kButtonA, kButtonB, kButtonX,     kButtonY};
  constexpr int kByte5[] = {kButtonDpadUp,    kButtonDpadDown,     kButtonDpadLeft,
                            kButtonDpadRight, kButtonLeftShoulder, kButtonRightShoulder,
                            kButtonLeftStick, kButtonRightStick};
  for (int bit = 0; bit < 8; ++bit) {
    EXPECT_EQ(buttons_of(neutral(), 4, bit), kByte4[bit] < 0 ? 0u : 1u << kByte4[bit])
        << "byte 4, bit " << bit;
    EXPECT_EQ(buttons_of(neutral(), 5, bit), 1u << kByte5[bit]) << "byte 5, bit " << bit;
  }
}

TEST_F(Gip, GuideComesInAMessageOfItsOwnAndLeavesTheRest) {
  Packet packet = neutral();
  packet[4] = 0x10;
  ASSERT_TRUE(decodes(packet));
  ASSERT_TRUE(decodes({0x07, 0x20, 0x02, 0x02, 0x01, 0x5b}));
  EXPECT_EQ(state_.buttons, 1u << kButtonA | 1u << kButtonGuide);
  ASSERT_TRUE(decodes(packet));
  EXPECT_EQ(state_.buttons, 1u << kButtonA | 1u << kButtonGuide);
  ASSERT_TRUE(decodes({0x07, 0x20, 0x03, 0x02, 0x00, 0x5b}));
  EXPECT_EQ(state_.buttons, 1u << kButtonA);
}

TEST_F(Gip, TriggersAreTenBitsAndSticksSixteenWithYForwardAsThePadSendsIt) {
  Packet packet = neutral();
  packet[6] = 0xff, packet[7] = 0x03;    // left trigger 1023
  packet[8] = 0x00, packet[9] = 0x01;    // right trigger 256
  packet[10] = 0xff, packet[11] = 0x7f;  // left x
  packet[12] = 0xff, packet[13] = 0x7f;  // left y: pushed away
  packet[14] = 0x00, packet[15] = 0x80;  // right x
  packet[16] = 0x00, packet[17] = 0xc0;  // right y: pulled half way
  ASSERT_TRUE(decodes(packet));
  EXPECT_FLOAT_EQ(state_.axis[kLeftTrigger], 1.0f);
  EXPECT_NEAR(state_.axis[kRightTrigger], 256.0f / 1023.0f, 1e-6f);
  EXPECT_FLOAT_EQ(state_.axis[kLeftX], 1.0f);
  EXPECT_FLOAT_EQ(state_.axis[kLeftY], 1.0f);
  EXPECT_FLOAT_EQ(state_.axis[kRightX], -1.0f);
  EXPECT_NEAR(state_.axis[kRightY], -0.5f, 1e-4f);
}

TEST_F(Gip, OtherMakersPadsAreTheSame) {
  use(0x20d6, 0x2001);  // PowerA
  Packet packet = neutral();
  packet[13] = 0x7f, packet[5] = 0x80;
  ASSERT_TRUE(decodes(packet));
  EXPECT_GT(state_.axis[kLeftY], 0.9f);
  EXPECT_EQ(state_.buttons, 1u << kButtonRightStick);
}

// Byte 22 of 48: Xbox Series with current firmware (SDL, SDL_hidapi_xboxone.c).
TEST_F(Gip, SeriesPadsHaveAShareButton) {
  use(kMicrosoft, kSeries);
  Packet packet = neutral(48);
  packet[13] = 0x7f, packet[22] = 0x01;
  ASSERT_TRUE(decodes(packet));
  EXPECT_EQ(state_.buttons, 1u << kButtonMisc1);
  EXPECT_GT(state_.axis[kLeftY], 0.9f);
  packet[22] = 0x00, packet[4] = 0x40;
  ASSERT_TRUE(decodes(packet));
  EXPECT_EQ(state_.buttons, 1u << kButtonX);
  ASSERT_TRUE(decodes({0x07, 0x20, 0x02, 0x02, 0x01, 0x5b}));
  EXPECT_EQ(state_.buttons, 1u << kButtonX | 1u << kButtonGuide);
  EXPECT_TRUE(decodes(neutral(36)));  // older firmware: without it
}

TEST_F(Gip, ItIsSwitchedOnWithoutWaitingForAnAnnouncement) {
  ScriptedPort port;
  model_->start(port, StartedBy::us);
  const std::vector<Packet> expected = {{0x05, 0x20, 1, 0x01, 0x00},
                                        {0x05, 0x20, 2, 0x0f, 0x06},
                                        {0x0a, 0x20, 3, 0x03, 0x00, 0x01, 0x14},
                                        {0x06, 0x20, 4, 0x02, 0x01, 0x00}};
  EXPECT_EQ(port.written, expected);
}

TEST_F(Gip, AnAnnouncementIsAnsweredByPowerOn) {
  Packet announce(32);
  announce[0] = 0x02, announce[1] = 0x20, announce[2] = 0x01, announce[3] = 0x1c;
  EXPECT_FALSE(model_->accept(announce, reply_));
  EXPECT_EQ(bytes_of(reply_), (Packet{0x05, 0x20, 1, 0x01, 0x00}));
}

TEST_F(Gip, WhatAsksForAnAnswerGetsOneUnderItsNumber) {
  EXPECT_TRUE(model_->accept(Packet{0x07, 0x30, 0x2a, 0x02, 0x01, 0x5b}, reply_));
  EXPECT_EQ(bytes_of(reply_), (Packet{0x01, 0x20, 0x2a, 9, 0, 0x07, 0x20, 0x02, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(model_->accept(neutral(), reply_));
  EXPECT_EQ(reply_.size, 0u);
}

TEST_F(Gip, MessagesOfTheProtocolAreNoInput) {
  for (const std::uint8_t command : {0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x08, 0x1e, 0x60}) {
    EXPECT_FALSE(model_->accept(Packet{command, 0x20, 0x01, 0x00}, reply_)) << int{command};
    EXPECT_FALSE(model_->accept(Packet{command}, reply_)) << int{command};
  }
  Packet headset = neutral();
  headset[1] = 0x01;
  EXPECT_FALSE(model_->accept(headset, reply_)) << "of what is plugged into the pad";
}

TEST_F(Gip, PartsOfLongMessagesAreIgnored) {
  EXPECT_FALSE(model_->accept(Packet{0x04, 0xf0, 0x01, 0xba, 0x10, 0x20}, reply_));
  EXPECT_EQ(reply_.size, 0u);
  Packet input = neutral();
  input[1] = 0xa0;
  EXPECT_EQ(model_->lost(), 0);
  EXPECT_FALSE(model_->accept(input, reply_));
  EXPECT_EQ(model_->lost(), 1);
}

TEST_F(Gip, ShortAndUnknownPacketsAreHandedOnAndChangeNothing) {
  Packet packet = neutral();
  packet[4] = 0x10;
  for (std::size_t size = 1; size < packet.size(); ++size) {
    const Packet part(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_TRUE(model_->accept(part, reply_)) << size;
    EXPECT_FALSE(decodes(part)) << size;
  }
  packet[0] = 0x77, packet[1] = 0xff;
  EXPECT_TRUE(model_->accept(packet, reply_));
  EXPECT_EQ(reply_.size, 0u);
  EXPECT_FALSE(decodes(packet));
  EXPECT_FALSE(model_->accept(Packet{}, reply_));
  EXPECT_EQ(state_, PadState{});
}

TEST_F(Gip, RumbleIsScaledAsTheKernelDoes) {
  OutPacket packet;
  model_->rumble({0xc000, 0x4000}, packet);
  EXPECT_EQ(bytes_of(packet),
            (Packet{0x09, 0x00, 1, 0x09, 0x00, 0x0f, 0x00, 0x00, 0x60, 0x20, 0xff, 0x00, 0xff}));
  model_->rumble({}, packet);
  EXPECT_EQ(bytes_of(packet),
            (Packet{0x09, 0x00, 2, 0x09, 0x00, 0x0f, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0xff}));
}

TEST_F(Gip, SequenceNumbersAreNeverZero) {
  OutPacket packet;
  for (int i = 0; i < 600; ++i) {
    model_->rumble({}, packet);
    EXPECT_NE(packet.bytes[2], 0);
  }
}

TEST_F(Gip, OtherInterfacesAreNone) {
  EXPECT_EQ(make_gip_pad({0xff, 0x5d, 0x01}, {}).model, nullptr);
  EXPECT_EQ(make_gip_pad({0x03, 0x01, 0x01}, {}).model, nullptr);
}

}  // namespace
}  // namespace gaitpad
