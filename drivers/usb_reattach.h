// Gives a USB interface back to its kernel driver, however this process ends.
//
// The kernel does not do so: an interface whose driver was detached stays without a driver when the
// process that detached it dies. So a small process is started that waits for our end.
#pragma once
#include <cstdint>
#include <string>
#include <utility>

#include "drivers/posix.h"
#include "gaitpad/result.h"

namespace gaitpad {

class ReattachWatcher {
 public:
  // Call it before detaching. `node`: the device's, /dev/bus/usb/BBB/DDD.
  static Result<ReattachWatcher> start(const std::string& node, std::uint8_t interface_number);
  // Destroying it is like the death of this process: the watcher re-attaches.
  ReattachWatcher(ReattachWatcher&&) noexcept = default;
  ReattachWatcher& operator=(ReattachWatcher&&) = delete;

  // The driver is attached again, or the device is gone: ends the watcher.
  void dismiss() noexcept;

 private:
  explicit ReattachWatcher(OwnedFd link) : link_(std::move(link)) {}
  OwnedFd link_;  // the watcher waits until this is closed
};

}  // namespace gaitpad
