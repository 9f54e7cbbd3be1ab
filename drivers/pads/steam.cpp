// Steam Controller and Steam Deck: vendor reports, and "lizard mode", in which they are a mouse and
// a keyboard. It is left at the start and restored at the end. Commands, settings and messages are
// from Linux's hid-steam.c and SDL's steam/controller_constants.h.
#include <algorithm>
#include <initializer_list>
#include <utility>

#include "drivers/pads/pad_model.h"
#include "gaitpad/descriptor.h"

namespace gaitpad {

namespace {

constexpr std::uint16_t kValve = 0x28de;
enum : std::uint16_t { kWired = 0x1102, kWireless = 0x1142, kDeck = 0x1205 };  // products

// A message to the pad is a feature report without id: command, length, data.
constexpr std::size_t kMessageBytes = 64;
enum : std::uint8_t {  // commands
  kClearMappings = 0x81,
  kDefaultMappings = 0x85,
  kWriteSettings = 0x87,
  kDefaultSettings = 0x8e,
};
struct Setting {
  std::uint8_t number = 0;
  std::uint16_t value = 0;
};
enum : std::uint8_t {  // settings
  kLeftPadMode = 7,
  kRightPadMode = 8,
  kRightPadMargin = 24,
  kLeftPadClick = 52,
  kRightPadClick = 53,
  kWatchdog = 71,  // restores lizard mode when nothing is sent for a while
};
constexpr std::uint16_t kNoMouse = 7, kNeverClicks = 0xffff;

// A message from the pad: version 1, 0, its type, its length.
constexpr std::size_t kTypeAt = 2;
enum : std::uint8_t { kControllerState = 1, kDeckState = 9 };

class SteamModel final : public PadModel {
 public:
  explicit SteamModel(const DeviceInfo& device)
      : name_(device.name.empty() ? "this pad" : device.name), is_deck_(device.product == kDeck) {}

  void start(PadPort& port, StartedBy) override {
    const bool has_left =
        send(port, kClearMappings) &&
        (is_deck_ ? write(port, {{kLeftPadMode, kNoMouse},
                                 {kRightPadMode, kNoMouse},
                                 {kLeftPadClick, kNeverClicks},
                                 {kRightPadClick, kNeverClicks},
                                 {kWatchdog, 0}})
                  : write(port, {{kRightPadMode, kNoMouse}, {kRightPadMargin, 0}}));
    if (!has_left) remark_ = name_ + ": stays a mouse and keyboard as well";
  }

  void stop(PadPort& port) noexcept override {
    send(port, kDefaultMappings);
    send(port, kDefaultSettings);
    if (!is_deck_) write(port, {{kRightPadMargin, 1}});
  }

  // Other messages tell the battery, and that a wireless pad came or went.
  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    return packet.size() > kTypeAt && packet[kTypeAt] == (is_deck_ ? kDeckState : kControllerState);
  }

  std::vector<std::string> take_remarks() override {
    if (remark_.empty()) return {};
    return {std::exchange(remark_, {})};
  }

 private:
  static bool send(PadPort& port, std::uint8_t command, std::span<const Setting> settings = {}) {
    std::array<std::uint8_t, 1 + kMessageBytes> message{};  // begins with the id 0
    message[1] = command;
    message[2] = static_cast<std::uint8_t>(3 * settings.size());
    std::size_t at = 3;
    for (const Setting& setting : settings) {
      message[at++] = setting.number;
      message[at++] = static_cast<std::uint8_t>(setting.value);
      message[at++] = static_cast<std::uint8_t>(setting.value >> 8);
    }
    return port.send_feature(message);
  }
  static bool write(PadPort& port, std::initializer_list<Setting> settings) {
    return send(port, kWriteSettings, {settings.begin(), settings.size()});
  }

  std::string name_;
  bool is_deck_;
  std::string remark_;
};

}  // namespace

// The interfaces of the mouse and the keyboard have the same ids.
std::unique_ptr<PadModel> make_steam_model(const DeviceInfo& device) {
  constexpr std::uint32_t kPads[] = {usage_of(0xff00, 1), usage_of(0xffff, 1)};
  const std::uint16_t product = device.product;
  if (device.vendor != kValve || (product != kWired && product != kWireless && product != kDeck))
    return nullptr;
  const auto parsed = parse_descriptor(device.descriptor);
  if (!parsed ||
      std::find_first_of(parsed->applications.begin(), parsed->applications.end(),
                         std::begin(kPads), std::end(kPads)) == parsed->applications.end())
    return nullptr;
  return std::make_unique<SteamModel>(device);
}

}  // namespace gaitpad
