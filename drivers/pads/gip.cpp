// Xbox One and Series pads on USB speak GIP: each message begins with command, options, sequence
// number and length. The command serves as the report id.
#include <algorithm>

#include "drivers/pads/pad_quirks.h"

namespace gaitpad {

namespace {

constexpr std::size_t kHeaderBytes = 4;
constexpr std::uint8_t kAcknowledge = 0x01, kAnnounce = 0x02, kPower = 0x05, kGuide = 0x07,
                       kRumble = 0x09, kInput = 0x20;
// Bits of the options. kClient: the sender, which is the pad (0) or an accessory plugged into it.
constexpr std::uint8_t kClient = 0x0f;
constexpr std::uint8_t kWantsAnswer = 0x10, kInternal = 0x20, kChunk = 0x80;

// The descriptor of the input packets, in which y grows upwards: config/pads/microsoft.toml says so
// for every pad that has the collection of the last line.
constexpr std::uint8_t kDescriptor[] = {
    0x05, 0x01, 0x09, 0x05, 0xa1, 0x01,                          // collection: game pad
    0x85, 0x20, 0x75, 0x08, 0x95, 0x03, 0x81, 0x03,              // input: options, number, length
    0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x02, 0x81, 0x03,  // byte 4: pairing, unused
    0x05, 0x09, 0x09, 0x08, 0x09, 0x07, 0x81, 0x02,              // buttons: start (menu), back
    0x19, 0x01, 0x29, 0x04, 0x95, 0x04, 0x81, 0x02,              // buttons: a, b, x, y
    0x05, 0x01, 0x09, 0x90, 0x09, 0x91, 0x09, 0x93, 0x09, 0x92,  // byte 5: up, down, left, right
    0x81, 0x02,                                                  //
    0x05, 0x09, 0x09, 0x05, 0x09, 0x06, 0x09, 0x09, 0x09, 0x0a,  // shoulder buttons, stick buttons
    0x81, 0x02,                                                  //
    0x05, 0x01, 0x09, 0x32, 0x09, 0x35, 0x26, 0xff, 0x03,        // bytes 6..9: triggers, 10 bits
    0x75, 0x10, 0x95, 0x02, 0x81, 0x02,                          //
    0x09, 0x30, 0x09, 0x31, 0x09, 0x33, 0x09, 0x34,              // bytes 10..17: sticks
    0x16, 0x00, 0x80, 0x26, 0xff, 0x7f, 0x95, 0x04, 0x81, 0x02,  //
    0x05, 0x0c, 0x09, 0xb2, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01,  // byte 18: the share button
    0x95, 0x01, 0x81, 0x02,                                      //
    0x05, 0x09, 0x19, 0x0c, 0x29, 0x0f, 0x95, 0x04, 0x81, 0x02,  //   paddles P1 .. P4
    0x95, 0x03, 0x81, 0x03,                                      //
    0x85, 0x07, 0x75, 0x08, 0x95, 0x03, 0x81, 0x03,              // guide: options, number, length
    0x05, 0x09, 0x09, 0x0b, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01,  // byte 4: pressed
    0x95, 0x01, 0x81, 0x02, 0x95, 0x0f, 0x81, 0x03, 0xc0,        // byte 5: 5b, the key's code
    0x06, 0x47, 0xff, 0x09, 0xd0, 0xa1, 0x01, 0xc0,              // mark of such pads: ff47:00d0
};

// Start-up messages; the third byte, the sequence number, is set when they are sent. From Linux's
// xpad.
struct StartMessage {
  std::uint32_t only = 0;  // vendor and product of the pads that get the message; 0: all
  std::uint8_t size = 0;
  std::array<std::uint8_t, 13> bytes{};
};
constexpr std::uint32_t pad_id(std::uint16_t vendor, std::uint16_t product) {
  return std::uint32_t{vendor} << 16 | product;
}
constexpr std::uint32_t kElite1 = pad_id(0x045e, 0x02e3), kElite2 = pad_id(0x045e, 0x0b00);

// After the state that all pads send, each firmware sends more; the packet's size tells what. Sizes
// and places, which count the header, are from SDL's SDL_hidapi_xboxone.c.
constexpr std::size_t kStateBytes = 18;
struct SharePlace {
  std::size_t size, at;
};
constexpr SharePlace kSharePlaces[] = {{36, 18},
                                       {44, 18},
                                       {48, 22},   // Xbox Series 5.0, 5.1, 5.5
                                       {50, 32},   // Victrix Gambit
                                       {64, 46}};  // ThrustMaster eSwap
// Bits of byte 18 in the report that is handed on.
constexpr std::uint8_t kShare = 0x01, kPaddles[] = {0x02, 0x04, 0x08, 0x10};  // paddles P1 .. P4

// Converts the paddles' bits of `byte`, which are listed in `bits`, to kPaddles.
std::uint8_t paddles(std::uint8_t byte, const std::array<std::uint8_t, 4>& bits) noexcept {
  std::uint8_t pressed = 0;
  for (std::size_t i = 0; i < bits.size(); ++i) pressed |= (byte & bits[i]) != 0 ? kPaddles[i] : 0;
  return pressed;
}

// The share button and the paddles. A paddle that the pad itself maps to another button presses
// that button alone.
std::uint8_t extra_buttons(std::uint32_t id, std::span<const std::uint8_t> p) noexcept {
  if (id == kElite1) {
    const bool is_mapped = p.size() == 33 && (p[4] != p[18] || p[5] != p[19]);
    return p.size() == 33 && !is_mapped ? paddles(p[32], {0x02, 0x08, 0x01, 0x04}) : 0;
  }
  if (id == kElite2) {
    const std::size_t at = p.size() == 38 ? 18 : p.size() == 50 ? 22 : 0;
    return at != 0 && p[at + 1] == 0 ? paddles(p[at], {0x01, 0x02, 0x04, 0x08}) : 0;
  }
  for (const SharePlace& place : kSharePlaces) {
    if (p.size() == place.size) return (p[place.at] & 0x01) != 0 ? kShare : 0;
  }
  return 0;
}

constexpr StartMessage kStartMessages[] = {
    // These two pads wait until their announcement is acknowledged.
    {pad_id(0x0e6f, 0x0165),
     13,
     {kAcknowledge, kInternal, 0, 9, 0, 4, kInternal, 0x3a, 0, 0, 0, 0x80}},
    {pad_id(0x0f0d, 0x0067),
     13,
     {kAcknowledge, kInternal, 0, 9, 0, 4, kInternal, 0x3a, 0, 0, 0, 0x80}},
    {0, 5, {kPower, kInternal, 0, 1, 0}},  // power on
    // Xbox One S and Elite 2 after they were used on Bluetooth.
    {pad_id(0x045e, 0x02ea), 5, {kPower, kInternal, 0, 0x0f, 0x06}},
    {pad_id(0x045e, 0x0b00), 5, {kPower, kInternal, 0, 0x0f, 0x06}},
    {0, 7, {0x0a, kInternal, 0, 3, 0, 1, 0x14}},  // the light of the guide button
    {0, 6, {0x06, kInternal, 0, 2, 1, 0}},        // says that no authentication is requested
};

// True for messages of the protocol itself, which are no input.
bool is_of_protocol(std::uint8_t command) noexcept {
  constexpr std::uint8_t kCommands[] = {kAcknowledge, kAnnounce, 0x03, 0x04, kPower, 0x06, 0x08,
                                        0x0a,         0x0b,      0x0c, 0x1e, 0x1f,   0x60};
  return std::find(std::begin(kCommands), std::end(kCommands), command) != std::end(kCommands);
}

class GipQuirks final : public PadQuirks {
 public:
  explicit GipQuirks(std::uint32_t id) : id_(id) {}

  // Sends the start-up messages at once: a pad announces itself when it gets power, usually long
  // before it is opened.
  void start(PadPort& port, StartedBy) override {
    for (const StartMessage& message : kStartMessages) {
      if (message.only != 0 && message.only != id_) continue;
      OutPacket packet;
      std::copy_n(message.bytes.begin(), message.size, packet.bytes.begin());
      packet.size = message.size;
      number(packet);
      port.write({packet.bytes.data(), packet.size});
    }
  }

  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    if (packet.empty()) return false;
    // Without a complete header the message is unknown: pass it on, so that the decoder counts it.
    if (packet.size() < kHeaderBytes) return !is_of_protocol(packet[0]);
    const bool is_known = packet[0] == kInput || packet[0] == kGuide || is_of_protocol(packet[0]);
    if (!is_known) return true;  // an unknown message is passed on and counted as well
    const std::uint8_t options = packet[1];
    const bool is_input = !is_of_protocol(packet[0]);
    if ((options & kChunk) != 0) {  // a part of a long message is no input, which is never long
      refused_ += is_input ? 1 : 0;
      return false;
    }
    if ((options & kWantsAnswer) != 0) acknowledge(packet, reply);
    if (packet[0] == kAnnounce && (options & kClient) == 0) power_on(reply);
    if (!is_input || (options & kClient) != 0) return false;
    if (has_state(packet)) {
      std::copy_n(packet.begin(), kStateBytes, state_.begin());
      state_[kStateBytes] = extra_buttons(id_, packet);
    }
    return true;
  }
  std::span<const std::uint8_t> report_of(
      std::span<const std::uint8_t> packet) const noexcept override {
    return has_state(packet) ? std::span<const std::uint8_t>(state_) : packet;
  }

  std::int64_t lost() const noexcept override { return refused_; }

  void rumble(const Rumble& strengths, OutPacket& packet) noexcept override {
    packet = {};
    // Sets all four motors, those of the triggers to 0. Strengths are 0..127; on for 255 x 10 ms,
    // without a pause, 255 times, which lasts until the next message.
    packet.bytes = {kRumble,
                    0,
                    0,
                    9,
                    0,
                    0x0f,
                    0,
                    0,
                    static_cast<std::uint8_t>(strengths.strong >> 9),
                    static_cast<std::uint8_t>(strengths.weak >> 9),
                    0xff,
                    0,
                    0xff};
    packet.size = 13;
    number(packet);
  }

 private:
  static bool has_state(std::span<const std::uint8_t> packet) noexcept {
    return packet.size() >= kStateBytes && packet[0] == kInput;
  }

  void number(OutPacket& packet) noexcept {
    if (++sequence_ == 0) sequence_ = 1;
    packet.bytes[2] = sequence_;
  }

  // Called when the pad has just got power or restarted.
  void power_on(OutPacket& reply) noexcept {
    reply = {};
    reply.bytes = {kPower, kInternal, 0, 1, 0};
    reply.size = 5;
    number(reply);
  }

  // Acknowledges a message by its sequence number, its command, and the number of its bytes that
  // arrived.
  static void acknowledge(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept {
    const auto client = static_cast<std::uint8_t>(packet[1] & kClient);
    const auto options = static_cast<std::uint8_t>(kInternal | client);
    reply = {};
    reply.bytes = {kAcknowledge, options, packet[2], 9, 0, packet[0], options, packet[3]};
    reply.size = 13;
  }

  std::uint32_t id_;
  std::array<std::uint8_t, kStateBytes + 1> state_{};
  std::uint8_t sequence_ = 0;
  std::int64_t refused_ = 0;
};

}  // namespace

VendorPad make_gip_pad(const UsbInterfaceClass& interface, const DeviceInfo& device) {
  if (interface.interface_class != 0xff || interface.subclass != 0x47 ||
      interface.protocol != 0xd0) {
    return {};
  }
  return {std::make_unique<GipQuirks>(pad_id(device.vendor, device.product)),
          {std::begin(kDescriptor), std::end(kDescriptor)}};
}

}  // namespace gaitpad
