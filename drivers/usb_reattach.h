// Gives a USB interface back to its kernel driver, however this process ends.
//
// The kernel does not do so: an interface whose driver was detached stays without a driver when the
// process that detached it dies. So a small process is started that waits for our end.
#pragma once
#include <sys/types.h>

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
  ReattachWatcher(ReattachWatcher&&) noexcept = default;
  ReattachWatcher& operator=(ReattachWatcher&&) = delete;
  ~ReattachWatcher();  // like the death of this process: the watcher re-attaches

  // The driver is attached again, or the device is gone: ends the watcher.
  void dismiss() noexcept;

 private:
  ReattachWatcher(OwnedFd link, pid_t process) : link_(std::move(link)), process_(process) {}
  OwnedFd link_;  // the watcher waits until this is closed
  pid_t process_ = -1;
};

}  // namespace gaitpad
