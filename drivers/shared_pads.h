// Several pads in one device that can be opened only once, as by the usb driver: each takes every
// packet, and its quirks keep those of its own reports.
#pragma once
#include <poll.h>

#include <memory>
#include <mutex>
#include <vector>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/driver.h"

namespace gaitpad {

// The packets of the open device. It is only called under SharedDevice's lock.
class PacketSource {
 public:
  virtual ~PacketSource() = default;
  virtual std::span<const pollfd> poll_fds() const noexcept = 0;  // do not change
  virtual Device::Status read(Report& packet) noexcept = 0;
  virtual bool send(const OutPacket& packet) noexcept = 0;
  virtual std::int64_t lost() const noexcept = 0;
};

class SharedPad;

// Pads are opened and closed on the finder's threads while the I/O thread reads the others.
struct SharedDevice {
  explicit SharedDevice(std::unique_ptr<PacketSource> packets) : source(std::move(packets)) {}
  std::mutex mutex;  // of the two below; never held while waiting
  std::unique_ptr<PacketSource> source;
  std::vector<SharedPad*> pads;
};

// One of the pads; `info` is what split_pads() states.
std::unique_ptr<Device> open_shared_pad(std::shared_ptr<SharedDevice> device, DeviceInfo info);

}  // namespace gaitpad
