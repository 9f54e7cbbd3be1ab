// Quirks: the handling that a kind of pad needs beside its report descriptor: packets that start
// it, packets that are no input, rumble. Bytes only; the drivers that carry packets (hidraw, usb)
// share the quirks.
#pragma once
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gaitpad/driver.h"

namespace gaitpad {

// Exchanges packets with an open pad. Packets begin with the report id if the pad has ids.
class PadPort {
 public:
  virtual ~PadPort() = default;
  virtual bool write(std::span<const std::uint8_t> packet) noexcept = 0;
  // Returns the number of bytes received; 0: none came within the time, or the pad is gone.
  virtual std::size_t read(std::span<std::uint8_t> packet,
                           std::chrono::milliseconds timeout) noexcept = 0;
  // Reads a feature report (HID pads only) and returns its size with the id in packet[0]; 0:
  // refused.
  virtual std::size_t feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept = 0;
  // Reads an input report (HID pads only) and returns what feature() returns. It may take five
  // seconds.
  virtual std::size_t input(std::uint8_t, std::span<std::uint8_t>) noexcept { return 0; }
  // Sends a command to the pad's second interface and returns the size of its answer (the driver
  // usb alone); 0: there is no such interface, or no answer.
  virtual std::size_t command(std::span<const std::uint8_t>, std::span<std::uint8_t>) noexcept {
    return 0;
  }
  // Sends a feature report (HID pads only), which begins with its id; 0: the pad has no ids.
  virtual bool send_feature(std::span<const std::uint8_t>) noexcept { return false; }
};

struct OutPacket {
  std::array<std::uint8_t, 128> bytes{};
  std::size_t size = 0;  // number of bytes; 0: nothing to send
  // The packet is a feature report (HID pads only), which begins with its id, or 0.
  bool is_feature = false;
  // The packet is sent again after this time until another packet follows; 0: it is sent once.
  std::chrono::milliseconds repeat{0};

  // Copies the bytes. False: they are too many.
  bool set(std::span<const std::uint8_t> packet) noexcept {
    if (packet.size() > bytes.size()) return false;
    std::copy(packet.begin(), packet.end(), bytes.begin());
    size = packet.size();
    return true;
  }
};

// Who started the pad: some start-up packets are only for a pad without a kernel driver.
enum class StartedBy { kernel, us };

// The same axis of a stick that is turned by 180 degrees.
constexpr FactoryAxis mirrored(const FactoryAxis& axis) noexcept {
  return {-axis.max, -axis.centre, -axis.min};
}

class PadQuirks {
 public:
  virtual ~PadQuirks() = default;
  // Talks to the pad right after it was opened, for at most two seconds. A pad that does not answer
  // still works; take_remarks() says what is missing.
  virtual void start(PadPort&, StartedBy) {}
  // Called at the end, if the pad is still there: restores what start() changed.
  virtual void stop(PadPort&) noexcept {}
  // Called after start(): corrects the pad's own description. A collection that is added at the end
  // of the descriptor marks a kind of pad that its ids do not tell.
  virtual void amend(DeviceInfo&) const {}
  // True if the packet is an input report. `reply` gets an answer to send, or size 0.
  virtual bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept {
    reply.size = 0;
    return !packet.empty();
  }
  // True if accept() may have a reply.
  virtual bool replies() const noexcept { return false; }
  // The report to hand on for a packet that was accepted: the packet itself, or a state put
  // together from several packets.
  virtual std::span<const std::uint8_t> report_of(
      std::span<const std::uint8_t> packet) const noexcept {
    return packet;
  }
  // False while a receiver or an adapter says that no pad is connected.
  virtual bool has_pad() const noexcept { return true; }
  // The packet that sets the motors; size 0: the pad has none.
  virtual void rumble(const Rumble&, OutPacket& packet) noexcept { packet.size = 0; }
  virtual std::optional<FactorySticks> factory_sticks() const { return std::nullopt; }
  virtual std::optional<FactoryGyro> factory_gyro() const { return std::nullopt; }
  // Number of input reports that accept() refused because they are damaged (wrong checksum).
  virtual std::int64_t lost() const noexcept { return 0; }
  virtual std::vector<std::string> take_remarks() { return {}; }
};

// The quirks of a device, by its ids and bus; for pads that need none, quirks that change nothing.
std::unique_ptr<PadQuirks> make_pad_quirks(const DeviceInfo& device);

// Gets the first packet of a HID pad that was just opened and returns its size: what the pad sends
// within 30 ms, else its answer to a request for a report with its stick; 0: none. Without the
// request, a pad that reports only changes would not tell that its stick rests, and its first push
// would not count. An answer of zeros is ignored: some pads give it instead of their state, and it
// would mean a corner of the stick.
std::size_t first_packet(PadPort& port, const std::vector<std::uint8_t>& descriptor,
                         std::span<std::uint8_t> packet) noexcept;

// One function and file for each family; null: the device is of another family.
std::unique_ptr<PadQuirks> make_sony_quirks(const DeviceInfo& device);
std::unique_ptr<PadQuirks> make_switch_quirks(const DeviceInfo& device);
std::unique_ptr<PadQuirks> make_steam_quirks(const DeviceInfo& device);
std::unique_ptr<PadQuirks> make_motor_quirks(const DeviceInfo& device);
std::unique_ptr<PadQuirks> make_one_of_several_quirks(const DeviceInfo& device);

// Vendor-class USB pads (no HID): by the interface's class, subclass and protocol.
struct UsbInterfaceClass {
  std::uint8_t interface_class = 0, subclass = 0, protocol = 0;
};
// The pad's quirks and the descriptor that states its packets; null: another kind of interface.
struct VendorPad {
  std::unique_ptr<PadQuirks> quirks;
  std::vector<std::uint8_t> descriptor;
};
// Class ff, subclass 5d, protocol 01.
VendorPad make_xbox_360_pad(const UsbInterfaceClass& interface, const DeviceInfo&);
VendorPad make_gip_pad(const UsbInterfaceClass& interface,
                       const DeviceInfo& device);  // class ff/47/d0: Xbox One, Series

}  // namespace gaitpad
