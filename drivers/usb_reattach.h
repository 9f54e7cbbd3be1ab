// Gives a USB interface back to its kernel driver, however this process ends.
//
// The kernel does not do that by itself: an interface whose driver was detached stays without one
// when its taker dies. So a small process is started first that waits for our end.
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
  // Before the detaching. `node` is the device's, /dev/bus/usb/BBB/DDD.
  static Result<ReattachWatcher> start(const std::string& node, std::uint8_t interface_number);
  ReattachWatcher(ReattachWatcher&&) noexcept = default;
  ReattachWatcher& operator=(ReattachWatcher&&) = delete;
  ~ReattachWatcher();  // as our death: the watcher re-attaches

  // The driver is attached again, or the device is gone: nothing is left to do.
  void dismiss() noexcept;

 private:
  ReattachWatcher(OwnedFd link, pid_t process) : link_(std::move(link)), process_(process) {}
  OwnedFd link_;  // its closing is what the watcher waits for
  pid_t process_ = -1;
};

}  // namespace gaitpad
