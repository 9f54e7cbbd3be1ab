// Steam Controller and Steam Deck: vendor reports, and "lizard mode", in which they act as a mouse
// and a keyboard. The mode is left at the start and restored at the end. Commands, settings and
// messages are from Linux's hid-steam.c and SDL's steam/controller_constants.h, those of Bluetooth
// from SDL's SDL_hidapi_steam.c and steam/controller_structs.h.
#include <algorithm>
#include <initializer_list>
#include <utility>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/descriptor.h"

namespace gaitpad {

namespace {

constexpr std::uint16_t kValve = 0x28de;
enum : std::uint16_t {  // product ids
  kWired = 0x1102,
  kBluetooth = 0x1105,  // the product id 0x1106 means the same
  kWireless = 0x1142,
  kDeck = 0x1205,
};

// A message to the pad is a feature report without id: command, length, data.
constexpr std::size_t kMessageBytes = 64;
enum : std::uint8_t {  // numbers of commands
  kClearMappings = 0x81,
  kDefaultMappings = 0x85,
  kWriteSettings = 0x87,
  kDefaultSettings = 0x8e,
  kAskForPresence = 0xb4,  // the receiver answers with kPresence
};
struct Setting {
  std::uint8_t number = 0;
  std::uint16_t value = 0;
};
enum : std::uint8_t {  // numbers of settings
  kLeftPadMode = 7,
  kRightPadMode = 8,
  kRightPadMargin = 24,  // over Bluetooth: how smoothly the pad moves the mouse
  kPacketVersion = 49,
  kLeftPadClick = 52,
  kRightPadClick = 53,
  kWatchdog = 71,  // restores lizard mode when nothing is sent for a while
};
constexpr std::uint16_t kMouse = 0, kNoMouse = 7, kNeverClicks = 0xffff;

// Places in a message from the pad: version 1, 0, the message's type, its length.
constexpr std::size_t kTypeAt = 2, kPresenceAt = 4;
enum : std::uint8_t { kControllerState = 1, kPresence = 3, kDeckState = 9 };
enum : std::uint8_t { kIsOff = 1, kIsOn = 2 };  // states in a message kPresence

constexpr const char* kStaysMouse = ": stays a mouse and keyboard as well";
std::string name_of(const DeviceInfo& device) {
  return device.name.empty() ? "this pad" : device.name;
}

// A command with the settings that it writes.
struct Message {
  explicit Message(std::uint8_t command, std::initializer_list<Setting> settings = {}) {
    bytes[0] = command;
    bytes[1] = static_cast<std::uint8_t>(3 * settings.size());
    for (const Setting& setting : settings) {
      bytes[size++] = setting.number;
      bytes[size++] = static_cast<std::uint8_t>(setting.value);
      bytes[size++] = static_cast<std::uint8_t>(setting.value >> 8);
    }
  }
  std::array<std::uint8_t, kMessageBytes> bytes{};
  std::size_t size = 2;
};

class SteamQuirks final : public PadQuirks {
 public:
  explicit SteamQuirks(const DeviceInfo& device)
      : name_(name_of(device)),
        is_deck_(device.product == kDeck),
        is_receiver_(device.product == kWireless) {}

  void start(PadPort& port, StartedBy) override {
    const bool has_left =
        send(port, Message(kClearMappings)) &&
        (is_deck_ ? send(port, Message(kWriteSettings, {{kLeftPadMode, kNoMouse},
                                                        {kRightPadMode, kNoMouse},
                                                        {kLeftPadClick, kNeverClicks},
                                                        {kRightPadClick, kNeverClicks},
                                                        {kWatchdog, 0}}))
                  : send(port, Message(kWriteSettings,
                                       {{kRightPadMode, kNoMouse}, {kRightPadMargin, 0}})));
    if (!has_left) remark_ = name_ + kStaysMouse;
    if (is_receiver_) send(port, Message(kAskForPresence));
  }

  void stop(PadPort& port) noexcept override {
    send(port, Message(kDefaultMappings));
    send(port, Message(kDefaultSettings));
    if (!is_deck_) send(port, Message(kWriteSettings, {{kRightPadMargin, 1}}));
  }

  // Accepts states; other messages tell the battery, and that a pad behind the receiver was
  // switched on or off.
  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    if (packet.size() <= kTypeAt) return false;
    const bool is_state = packet[kTypeAt] == (is_deck_ ? kDeckState : kControllerState);
    if (is_receiver_ && packet[kTypeAt] == kPresence && packet.size() > kPresenceAt)
      take_presence(packet[kPresenceAt]);
    if (is_state) has_pad_ = true;
    leave_lizard_mode(reply);
    return is_state;
  }
  bool has_pad() const noexcept override { return has_pad_; }
  bool replies() const noexcept override { return is_receiver_; }

  std::vector<std::string> take_remarks() override {
    if (remark_.empty()) return {};
    return {std::exchange(remark_, {})};
  }

 private:
  // Number of packets from one message to the next: each message is a request that the pad has to
  // answer first.
  static constexpr int kBetweenMessages = 30;

  static bool send(PadPort& port, const Message& message) {
    // A feature report, which begins with the id 0.
    std::array<std::uint8_t, 1 + kMessageBytes> report{};
    std::copy(message.bytes.begin(), message.bytes.end(), report.begin() + 1);
    return port.send_feature(report);
  }

  // A pad that was switched on acts as a mouse and keyboard again, so the start-up messages are
  // sent again.
  void take_presence(std::uint8_t state) noexcept {
    if (state == kIsOff) has_pad_ = false;
    if (state != kIsOn) return;
    has_pad_ = true;
    packets_since_on_ = 0;
  }

  void leave_lizard_mode(OutPacket& reply) noexcept {
    if (packets_since_on_ < 0) return;
    if (packets_since_on_ == 0) put(Message(kClearMappings), reply);
    if (packets_since_on_++ < kBetweenMessages) return;
    put(Message(kWriteSettings, {{kRightPadMode, kNoMouse}, {kRightPadMargin, 0}}), reply);
    packets_since_on_ = -1;
  }
  static void put(const Message& message, OutPacket& reply) noexcept {
    reply = {};
    std::copy(message.bytes.begin(), message.bytes.end(), reply.bytes.begin() + 1);
    reply.size = 1 + kMessageBytes;
    reply.is_feature = true;
  }

  std::string name_;
  bool is_deck_, is_receiver_;
  bool has_pad_ = true;
  // Number of packets since the pad was switched on; -1: no message is to be sent.
  int packets_since_on_ = -1;
  std::string remark_;
};

// The Steam Controller over Bluetooth LE. Messages in both directions are cut into reports of 20
// bytes: the id 3, a header, 18 bytes. A message of the pad contains only what changed, so the
// whole state is put together here and handed on as one report (config/pads/valve.toml).
constexpr std::uint8_t kSegmentId = 3;
constexpr std::size_t kHeaderBytes = 2, kSegmentBytes = 18, kMaxSegments = 8;
// Bits of the header.
enum : std::uint8_t { kIsSegment = 0x80, kIsLast = 0x40, kSegmentNumber = 0x07 };
// Lower half of the first byte of a message with a state.
constexpr std::uint8_t kBluetoothState = 4;

// The parts that such a message may have, in the order of the parts, with the bit of its first two
// bytes that marks each.
struct StatePart {
  unsigned bit = 0;
  std::size_t bytes = 0;
  std::size_t place = 0;  // place in the report that is handed on; 0: the part is left out
};
constexpr StatePart kStateParts[] = {{0x10, 3, 1},     // buttons
                                     {0x20, 2, 4},     // triggers
                                     {0x40, 3, 0},     // buttons that no pad has
                                     {0x80, 4, 6},     // stick
                                     {0x100, 4, 14},   // left pad
                                     {0x200, 4, 10}};  // right pad; the motion sensors follow

class SteamBluetooth final : public PadQuirks {
 public:
  explicit SteamBluetooth(const DeviceInfo& device) : name_(name_of(device)) {
    state_[0] = kSegmentId;
  }

  void start(PadPort& port, StartedBy) override {
    if (!send(port, Message(kClearMappings)) || !send(port, Message(kDefaultSettings)) ||
        !send(port, Message(kWriteSettings, {{kPacketVersion, 2},
                                             {kLeftPadMode, kNoMouse},
                                             {kRightPadMode, kNoMouse},
                                             {kRightPadMargin, 0}})))
      remark_ = name_ + kStaysMouse;
  }

  void stop(PadPort& port) noexcept override {
    send(port, Message(kDefaultMappings));
    send(port, Message(kDefaultSettings));
    send(port, Message(kWriteSettings, {{kRightPadMode, kMouse}}));
  }

  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    // A complete state: earlier versions recorded those.
    if (packet.size() == state_.size() && packet[0] == kSegmentId) {
      std::copy(packet.begin(), packet.end(), state_.begin());
      return true;
    }
    if (packet.size() != kHeaderBytes + kSegmentBytes || packet[0] != kSegmentId ||
        (packet[1] & kIsSegment) == 0)
      return false;
    const std::size_t number = packet[1] & kSegmentNumber;
    const bool is_next = number == next_ || number == 0;
    next_ = 0;
    if (!is_next) return false;  // a segment was lost: wait for the next message
    std::copy(packet.begin() + kHeaderBytes, packet.end(),
              message_.begin() + static_cast<std::ptrdiff_t>(number * kSegmentBytes));
    const std::size_t size = (number + 1) * kSegmentBytes;
    if ((packet[1] & kIsLast) != 0) return take_state(std::span(message_).first(size));
    next_ = number + 1;
    return false;
  }
  std::span<const std::uint8_t> report_of(std::span<const std::uint8_t>) const noexcept override {
    return state_;
  }

  std::vector<std::string> take_remarks() override {
    if (remark_.empty()) return {};
    return {std::exchange(remark_, {})};
  }

 private:
  bool take_state(std::span<const std::uint8_t> message) noexcept {
    if ((message[0] & 0x0f) != kBluetoothState) return false;
    const unsigned parts = (message[0] & 0xf0u) | unsigned{message[1]} << 8;
    std::size_t at = 2;
    for (const StatePart& part : kStateParts) {
      if ((parts & part.bit) == 0) continue;
      if (at + part.bytes > message.size()) return false;
      if (part.place > 0)
        std::copy_n(message.begin() + static_cast<std::ptrdiff_t>(at), part.bytes,
                    state_.begin() + static_cast<std::ptrdiff_t>(part.place));
      at += part.bytes;
    }
    return true;
  }

  static bool send(PadPort& port, const Message& message) noexcept {
    for (std::size_t at = 0; at < message.size; at += kSegmentBytes) {
      std::array<std::uint8_t, kHeaderBytes + kSegmentBytes> report{};
      const std::size_t count = std::min(kSegmentBytes, message.size - at);
      const bool is_last = at + count == message.size;
      report[0] = kSegmentId;
      report[1] =
          static_cast<std::uint8_t>(kIsSegment | (is_last ? kIsLast : 0) | (at / kSegmentBytes));
      std::copy_n(message.bytes.begin() + static_cast<std::ptrdiff_t>(at), count,
                  report.begin() + kHeaderBytes);
      if (!port.send_feature(report)) return false;
    }
    return true;
  }

  std::string name_;
  std::array<std::uint8_t, kSegmentBytes * kMaxSegments> message_{};
  std::size_t next_ = 0;  // number of the next segment
  std::array<std::uint8_t, 18> state_{};
  std::string remark_;
};

}  // namespace

// Null for the interfaces of the mouse and the keyboard, which have the same ids.
std::unique_ptr<PadQuirks> make_steam_quirks(const DeviceInfo& device) {
  constexpr std::uint32_t kPads[] = {usage_of(0xff00, 1), usage_of(0xffff, 1)};
  const std::uint16_t product = device.product;
  if (device.vendor == kValve && (product == kBluetooth || product == kBluetooth + 1))
    return std::make_unique<SteamBluetooth>(device);
  if (device.vendor != kValve || (product != kWired && product != kWireless && product != kDeck))
    return nullptr;
  const auto parsed = parse_descriptor(device.descriptor);
  if (!parsed ||
      std::find_first_of(parsed->applications.begin(), parsed->applications.end(),
                         std::begin(kPads), std::end(kPads)) == parsed->applications.end())
    return nullptr;
  return std::make_unique<SteamQuirks>(device);
}

}  // namespace gaitpad
