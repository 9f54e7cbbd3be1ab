// Gives a USB interface back to its kernel driver, however this process ends.
//
// The kernel does not do so: an interface whose driver was detached stays without a driver when the
// process that detached it dies. So a small process is started that waits for our end.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "gaitpad/result.h"
#include "system/descriptors.h"

namespace gaitpad {

class ReattachWatcher {
 public:
  // Call it before detaching. `node`: node of the USB device, /dev/bus/usb/BBB/DDD.
  static Result<ReattachWatcher> start(const std::string& node, std::uint8_t interface_number);
  // Destroying the object has the same effect as the death of this process: the watcher
  // re-attaches.
  ReattachWatcher(ReattachWatcher&&) noexcept = default;
  ReattachWatcher& operator=(ReattachWatcher&&) = delete;

  // Ends the watcher. Call it when the driver is attached again, or the device is gone.
  void dismiss() noexcept;

 private:
  explicit ReattachWatcher(OwnedFd link) : link_(std::move(link)) {}
  OwnedFd link_;  // pipe to the watcher, which waits until this end is closed
};

}  // namespace gaitpad
