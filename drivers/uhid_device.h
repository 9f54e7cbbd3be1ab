// A HID device that the kernel shows to every program, made by uhid: its own descriptor, ids and
// reports, as a recording has them. The kernel binds its drivers to it as to a plugged device.
#pragma once
#include <poll.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/trace.h"
#include "system/descriptors.h"

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

// The devices of a recording, with their recorded descriptors and ids.
class UhidDevices {
 public:
  // `recorded` must outlive this object.
  explicit UhidDevices(const std::vector<TraceDevice>& recorded)
      : recorded_(recorded), devices_(recorded.size()) {}

  std::optional<Error> plug_all();
  std::vector<pollfd> fds() const;
  void answer() noexcept;  // calls UhidDevice::answer() of every device
  bool are_bound()
      const noexcept;  // true if the kernel's drivers of all plugged devices have begun
  // Plugs, unplugs or sends, as the report says. Error: the kernel refuses it.
  std::optional<Error> take(const Report& report);

 private:
  std::optional<Error> plug(std::size_t device);

  const std::vector<TraceDevice>& recorded_;
  std::vector<std::optional<UhidDevice>> devices_;
};

}  // namespace gaitpad
