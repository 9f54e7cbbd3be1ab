// A HID device that the kernel shows to every program, made by uhid: its own descriptor, ids and
// reports, as a recording has them. The kernel binds its drivers to it as to a plugged device.
#pragma once
#include <poll.h>

#include <cstdint>
#include <memory>
#include <span>

#include "drivers/posix.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

class UhidDevice {
 public:
  // Error: there is no /dev/uhid or no permission, or the kernel refuses the descriptor.
  static Result<UhidDevice> create(const DeviceInfo& info);

  // If it is readable, call answer(): the kernel's driver asks for reports when it is bound, and
  // waits for the answer. A recording has no answers, so the driver is told that the device has
  // none.
  pollfd fd() const noexcept { return {fd_.get(), POLLIN, 0}; }
  void answer() noexcept;
  bool is_bound() const noexcept { return is_bound_; }  // True when the kernel's driver has begun.
  // False: the kernel has refused the report.
  bool send(std::span<const std::uint8_t> report) noexcept;

 private:
  explicit UhidDevice(OwnedFd fd) : fd_(std::move(fd)) {}
  OwnedFd fd_;  // closing it unplugs the device
  bool is_bound_ = false;
};

}  // namespace gaitpad
