// What a model of pad needs beside its report descriptor: packets that start it, packets that are
// no input, rumble. Bytes only: the drivers that carry packets (hidraw, usb) share these files.
#pragma once
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

// The way to an open pad, packets with the report id first where there are ids.
class PadPort {
 public:
  virtual ~PadPort() = default;
  virtual bool write(std::span<const std::uint8_t> packet) noexcept = 0;
  // Bytes that came; 0: none within the time, or the pad is gone.
  virtual std::size_t read(std::span<std::uint8_t> packet,
                           std::chrono::milliseconds timeout) noexcept = 0;
  // Bytes of the feature report, the id in packet[0] included; 0: refused. HID pads only.
  virtual std::size_t feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept = 0;
};

struct OutPacket {
  std::array<std::uint8_t, 128> bytes{};
  std::size_t size = 0;  // 0: nothing to send
  // To be sent again after that time, until another packet follows; 0: once does.
  std::chrono::milliseconds repeat{0};
};

// How the pad hangs: some start-up packets are only for a pad that no kernel driver has started.
enum class StartedBy { kernel, us };

class PadModel {
 public:
  virtual ~PadModel() = default;
  // Talks to the pad right after it was opened, at most two seconds. A pad that does not answer
  // works with less; what is then missing is said in take_remarks().
  virtual void start(PadPort&, StartedBy) {}
  // Whether the packet is an input report to hand on. `reply` may be filled with an answer.
  virtual bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept {
    reply.size = 0;
    return !packet.empty();
  }
  // The packet that sets the motors; size 0 where the pad has none.
  virtual void rumble(const Rumble&, OutPacket& packet) noexcept { packet.size = 0; }
  virtual std::optional<FactorySticks> factory_sticks() const { return std::nullopt; }
  // Input reports that accept() refused because they are damaged (a wrong checksum).
  virtual std::int64_t lost() const noexcept { return 0; }
  virtual std::vector<std::string> take_remarks() { return {}; }
};

// The model by ids and bus; a plain one for every pad that needs nothing.
std::unique_ptr<PadModel> make_pad_model(const DeviceInfo& device);

// One file a family; null where the device is not of it.
std::unique_ptr<PadModel> make_sony_model(const DeviceInfo& device);
std::unique_ptr<PadModel> make_switch_model(const DeviceInfo& device);

// Vendor-class USB pads (no HID): by the interface's class, subclass and protocol.
struct UsbInterfaceClass {
  std::uint8_t interface_class = 0, subclass = 0, protocol = 0;
};
// The pad's model and the descriptor that states its packets; null where it is none of them.
struct VendorPad {
  std::unique_ptr<PadModel> model;
  std::vector<std::uint8_t> descriptor;
};
VendorPad make_xbox_360_pad(const UsbInterfaceClass& interface, const DeviceInfo&);  // ff/5d/01
VendorPad make_gip_pad(const UsbInterfaceClass& interface,
                       const DeviceInfo& device);  // ff/47/d0: Xbox One, Series

}  // namespace gaitpad
