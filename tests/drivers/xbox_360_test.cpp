// Byte by byte after Linux's xpad (xpad360_process_packet, xpad_play_effect).
#include "drivers/xbox_pad.h"

namespace gaitpad {
namespace {

constexpr UsbInterfaceClass kXbox360{0xff, 0x5d, 0x01};

class Xbox360 : public XboxPad {
 protected:
  void SetUp() override { use(&make_xbox_360_pad, kXbox360, 0x045e, 0x028e); }

  static Packet neutral() {
    Packet packet(20);
    packet[1] = 0x14;
    return packet;
  }
};

TEST_F(Xbox360, EveryButtonHasItsBit) {
  constexpr int kByte2[] = {kButtonDpadUp, kButtonDpadDown, kButtonDpadLeft,  kButtonDpadRight,
                            kButtonStart,  kButtonBack,     kButtonLeftStick, kButtonRightStick};
  constexpr int kByte3[] = {kButtonLeftShoulder,
                            kButtonRightShoulder,
                            kButtonGuide,
                            -1,
                            kButtonA,
                            kButtonB,
                            kButtonX,
                            kButtonY};
  for (int bit = 0; bit < 8; ++bit) {
    EXPECT_EQ(buttons_of(neutral(), 2, bit), 1u << kByte2[bit]) << "byte 2, bit " << bit;
    EXPECT_EQ(buttons_of(neutral(), 3, bit), kByte3[bit] < 0 ? 0u : 1u << kByte3[bit])
        << "byte 3, bit " << bit;
  }
}

TEST_F(Xbox360, SticksAreSixteenBitsWithYForwardAsThePadSendsIt) {
  Packet packet = neutral();
  packet[6] = 0xff, packet[7] = 0x7f;    // left x 32767
  packet[8] = 0xff, packet[9] = 0x7f;    // left y 32767: pushed away
  packet[10] = 0x00, packet[11] = 0x80;  // right x -32768
  packet[12] = 0x00, packet[13] = 0xc0;  // right y -16384: pulled half way
  ASSERT_TRUE(decodes(packet));
  EXPECT_FLOAT_EQ(state_.axis[kLeftX], 1.0f);
  EXPECT_FLOAT_EQ(state_.axis[kLeftY], 1.0f);
  EXPECT_FLOAT_EQ(state_.axis[kRightX], -1.0f);
  EXPECT_NEAR(state_.axis[kRightY], -0.5f, 1e-4f);
}

TEST_F(Xbox360, TriggersAreEightBits) {
  Packet packet = neutral();
  packet[4] = 0xff, packet[5] = 0x33;
  ASSERT_TRUE(decodes(packet));
  EXPECT_FLOAT_EQ(state_.axis[kLeftTrigger], 1.0f);
  EXPECT_FLOAT_EQ(state_.axis[kRightTrigger], 0.2f);
  EXPECT_EQ(state_.buttons, 0u);
}

TEST_F(Xbox360, OtherMakersPadsAreTheSame) {
  use(&make_xbox_360_pad, kXbox360, 0x046d, 0xc21d);  // Logitech F310
  Packet packet = neutral();
  packet[9] = 0x7f, packet[3] = 0x04;
  ASSERT_TRUE(decodes(packet));
  EXPECT_GT(state_.axis[kLeftY], 0.9f);
  EXPECT_EQ(state_.buttons, 1u << kButtonGuide);
}

TEST_F(Xbox360, HandsOnInputAndDropsStates) {
  EXPECT_TRUE(model_->accept(neutral(), reply_));
  EXPECT_FALSE(model_->accept(Packet{0x01, 0x03, 0x06}, reply_));
  EXPECT_FALSE(model_->accept(Packet{0x03, 0x03, 0x03}, reply_));
  EXPECT_FALSE(model_->accept(Packet{0x08, 0x03, 0x00}, reply_));
  EXPECT_FALSE(model_->accept(Packet{}, reply_));
  EXPECT_EQ(reply_.size, 0u);
  EXPECT_EQ(model_->lost(), 0);
}

TEST_F(Xbox360, ShortPacketsAreHandedOnAndChangeNothing) {
  Packet packet = neutral();
  packet[3] = 0x10;
  for (std::size_t size = 1; size < 20; ++size) {
    const Packet part(packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_TRUE(model_->accept(part, reply_)) << size;
    EXPECT_FALSE(decodes(part)) << size;
    EXPECT_EQ(state_, PadState{});
  }
}

TEST_F(Xbox360, LongPacketsAreReadAsFarAsTheyAreKnown) {
  Packet packet = neutral();
  packet.resize(kMaxReportBytes, 0xff);
  packet[3] = 0x10;
  EXPECT_TRUE(model_->accept(packet, reply_));
  ASSERT_TRUE(decodes(packet));
  EXPECT_EQ(state_.buttons, 1u << kButtonA);
}

TEST_F(Xbox360, UnknownPacketsAreRefusedAndCounted) {
  for (int id = 1; id < 256; ++id) {
    Packet packet(20, 0xff);
    packet[0] = static_cast<std::uint8_t>(id);
    EXPECT_FALSE(model_->accept(packet, reply_)) << id;
  }
  EXPECT_FALSE(model_->accept(Packet{0x00, 0x15, 0x00}, reply_));
  EXPECT_EQ(model_->lost(), 256);
}

TEST_F(Xbox360, ItsLightIsSetAtTheStart) {
  ScriptedPort port;
  model_->start(port, StartedBy::us);
  EXPECT_EQ(port.written, (std::vector<Packet>{{0x01, 0x03, 0x06}}));
}

TEST_F(Xbox360, RumbleHasTheStrongMotorFirst) {
  OutPacket packet;
  model_->rumble({0xc000, 0x4000}, packet);
  EXPECT_EQ(bytes_of(packet), (Packet{0x00, 0x08, 0x00, 0xc0, 0x40, 0x00, 0x00, 0x00}));
  model_->rumble({}, packet);
  EXPECT_EQ(bytes_of(packet), (Packet{0x00, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}));
}

TEST_F(Xbox360, OtherInterfacesAreNone) {
  EXPECT_EQ(make_xbox_360_pad({0xff, 0x5d, 0x03}, {}).model, nullptr);  // its headset
  EXPECT_EQ(make_xbox_360_pad({0xff, 0x47, 0xd0}, {}).model, nullptr);
  EXPECT_EQ(make_xbox_360_pad({0x03, 0x00, 0x00}, {}).model, nullptr);
}

}  // namespace
}  // namespace gaitpad
