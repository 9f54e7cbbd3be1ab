// Pads that describe themselves and only need a packet for their motors: Stadia, Xbox and Luna on
// Bluetooth, 8BitDo. Packets are from SDL's SDL_hidapi_stadia.c, SDL_hidapi_xboxone.c,
// SDL_hidapi_luna.c and SDL_hidapi_8bitdo.c; ids of Xbox pads from Linux's hid-ids.h.
#include "drivers/pads/pad_quirks.h"

namespace gaitpad {

namespace {

struct MotorPad {
  std::uint16_t vendor = 0, product = 0;
  void (*set)(const Rumble&, OutPacket&) noexcept = nullptr;
};

void set_stadia(const Rumble& rumble, OutPacket& packet) noexcept {
  packet.bytes = {
      0x05, static_cast<std::uint8_t>(rumble.strong), static_cast<std::uint8_t>(rumble.strong >> 8),
      static_cast<std::uint8_t>(rumble.weak), static_cast<std::uint8_t>(rumble.weak >> 8)};
  packet.size = 5;
}

// Strengths are 0..100; runs both motors, not those of the triggers, until the next packet.
void set_xbox_bluetooth(const Rumble& rumble, OutPacket& packet) noexcept {
  packet.bytes = {0x03,
                  0x0f,
                  0x00,
                  0x00,
                  static_cast<std::uint8_t>(rumble.strong / 656),
                  static_cast<std::uint8_t>(rumble.weak / 656),
                  0xff,
                  0x00,
                  0xeb};
  packet.size = 9;
}

void set_8bitdo(const Rumble& rumble, OutPacket& packet) noexcept {
  packet.bytes = {0x05, static_cast<std::uint8_t>(rumble.strong >> 8),
                  static_cast<std::uint8_t>(rumble.weak >> 8)};
  packet.size = 5;
}

constexpr MotorPad kPads[] = {{0x18d1, 0x9400, &set_stadia},          // Stadia
                              {0x045e, 0x02e0, &set_xbox_bluetooth},  // Xbox One S
                              {0x045e, 0x02fd, &set_xbox_bluetooth},  // Xbox One S, newer firmware
                              {0x045e, 0x0b20, &set_xbox_bluetooth},  // Xbox One S, Low Energy
                              {0x045e, 0x0b05, &set_xbox_bluetooth},  // Xbox Elite 2
                              {0x045e, 0x0b22, &set_xbox_bluetooth},  // Xbox Elite 2, Low Energy
                              {0x045e, 0x0b13, &set_xbox_bluetooth},  // Xbox Series
                              {0x0171, 0x0419, &set_xbox_bluetooth},  // Luna
                              {0x2dc8, 0x6012, &set_8bitdo}};         // 8BitDo Ultimate 2 Wireless

class MotorQuirks final : public PadQuirks {
 public:
  explicit MotorQuirks(const MotorPad& pad) : pad_(pad) {}
  void rumble(const Rumble& rumble, OutPacket& packet) noexcept override {
    packet = {};
    pad_.set(rumble, packet);
  }

 private:
  const MotorPad& pad_;
};

}  // namespace

std::unique_ptr<PadQuirks> make_motor_quirks(const DeviceInfo& device) {
  for (const MotorPad& pad : kPads) {
    if (pad.vendor == device.vendor && pad.product == device.product)
      return std::make_unique<MotorQuirks>(pad);
  }
  return nullptr;
}

}  // namespace gaitpad
