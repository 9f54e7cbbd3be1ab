// Wired Xbox 360 pads of Microsoft and others: vendor-class packets of 20 bytes, no HID.
#include "drivers/pads/pad_quirks.h"

namespace gaitpad {

namespace {

constexpr std::uint8_t kInput = 0x00, kInputBytes = 0x14;

// The descriptor of the input packets, in which y grows upwards: config/pads/microsoft.toml says so
// for every pad that has the collection of the last line.
constexpr std::uint8_t kDescriptor[] = {
    0x05, 0x01, 0x09, 0x05, 0xa1, 0x01,                          // collection: game pad
    0x75, 0x08, 0x95, 0x02, 0x81, 0x03,                          // bytes 0, 1: always 00 14
    0x15, 0x00, 0x25, 0x01, 0x75, 0x01,                          // byte 2, one bit for each of:
    0x09, 0x90, 0x09, 0x91, 0x09, 0x93, 0x09, 0x92,              // D-pad up, down, left, right
    0x95, 0x04, 0x81, 0x02,                                      //
    0x05, 0x09, 0x09, 0x08, 0x09, 0x07, 0x09, 0x09, 0x09, 0x0a,  // start, back, stick buttons
    0x81, 0x02,                                                  // byte 3, one bit for each of:
    0x09, 0x05, 0x09, 0x06, 0x09, 0x0b, 0x95, 0x03, 0x81, 0x02,  // shoulder buttons, guide
    0x95, 0x01, 0x81, 0x03,                                      // an unused bit
    0x19, 0x01, 0x29, 0x04, 0x95, 0x04, 0x81, 0x02,              //   a, b, x, y
    0x05, 0x01, 0x09, 0x32, 0x09, 0x35,                          // bytes 4, 5: triggers
    0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02,        //
    0x09, 0x30, 0x09, 0x31, 0x09, 0x33, 0x09, 0x34,              // bytes 6..13: sticks
    0x16, 0x00, 0x80, 0x26, 0xff, 0x7f, 0x75, 0x10, 0x95, 0x04,  //
    0x81, 0x02,                                                  //
    0x75, 0x08, 0x95, 0x06, 0x81, 0x03, 0xc0,                    // bytes 14..19: always 0
    0x06, 0x5d, 0xff, 0x09, 0x01, 0xa1, 0x01, 0xc0,              // mark of such pads: ff5d:0001
};

class Xbox360Quirks final : public PadQuirks {
 public:
  void start(PadPort& port, StartedBy) override {
    // Lights the first quarter of the ring.
    constexpr std::uint8_t kLightOne[] = {0x01, 0x03, 0x06};
    port.write(kLightOne);
  }

  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    if (packet.empty()) return false;
    const bool is_input = packet[0] == kInput && (packet.size() < 2 || packet[1] == kInputBytes);
    // A short input packet is passed on, so that the decoder counts it.
    if (is_input) return true;
    // An unknown packet is refused and counted: the descriptor has no ids, so the decoder would
    // take it for input.
    if (!is_status(packet)) ++refused_;
    return false;
  }

  void rumble(const Rumble& strengths, OutPacket& packet) noexcept override {
    packet = {};
    packet.bytes = {0x00, 0x08, 0x00, static_cast<std::uint8_t>(strengths.strong >> 8),
                    static_cast<std::uint8_t>(strengths.weak >> 8)};
    packet.size = 8;
  }

  std::int64_t lost() const noexcept override { return refused_; }

 private:
  // True for answers and states: `01 03 06` LED, `02 03 00`, `03 03 03` motors, `08 03 00` headset.
  static bool is_status(std::span<const std::uint8_t> packet) noexcept {
    return packet.size() == 3 && packet[1] == 3 && packet[0] >= 0x01 && packet[0] <= 0x08;
  }

  std::int64_t refused_ = 0;
};

}  // namespace

VendorPad make_xbox_360_pad(const UsbInterfaceClass& interface, const DeviceInfo&) {
  if (interface.interface_class != 0xff || interface.subclass != 0x5d ||
      interface.protocol != 0x01) {
    return {};
  }
  return {std::make_unique<Xbox360Quirks>(), {std::begin(kDescriptor), std::end(kDescriptor)}};
}

}  // namespace gaitpad
