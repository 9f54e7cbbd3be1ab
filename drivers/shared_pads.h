// Several pads in one device that can be opened only once, as by the usb driver: each pad gets
// every packet, and its quirks keep those of its own reports.
#pragma once
#include <poll.h>

#include <memory>
#include <mutex>
#include <vector>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/driver.h"

namespace gaitpad {

// The packets of the open device. Its functions are only called under SharedDevice's lock.
class PacketSource {
 public:
  virtual ~PacketSource() = default;
  // The descriptors to poll; they do not change.
  virtual std::span<const pollfd> poll_fds() const noexcept = 0;
  virtual Device::Status read(Report& packet) noexcept = 0;
  virtual bool send(const OutPacket& packet) noexcept = 0;
  virtual std::int64_t lost() const noexcept = 0;
};

class SharedPad;

// The device that the pads share. The finder's threads open and close pads while the I/O thread
// reads others.
struct SharedDevice {
  explicit SharedDevice(std::unique_ptr<PacketSource> packets) : source(std::move(packets)) {}
  std::mutex mutex;  // guards the two members below; not held while waiting
  std::unique_ptr<PacketSource> source;
  std::vector<SharedPad*> pads;
};

// Opens one of the pads; `info` is its description by split_pads().
std::unique_ptr<Device> open_shared_pad(std::shared_ptr<SharedDevice> device, DeviceInfo info);

}  // namespace gaitpad
