// Gives a USB interface back to its kernel driver, however this process ends.
//
// The kernel does not do that by itself: an interface whose driver was detached stays without one
// when its taker dies. So a small process is started first that waits for our end.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <utility>

#include "base/result.h"

namespace gaitpad {

class ReattachWatcher {
 public:
  // Before the detaching. `node` is the device's, /dev/bus/usb/BBB/DDD.
  static Result<ReattachWatcher> start(const std::string& node, std::uint8_t interface_number);
  ReattachWatcher(ReattachWatcher&& other) noexcept
      : link_(std::exchange(other.link_, -1)), process_(std::exchange(other.process_, -1)) {}
  ReattachWatcher& operator=(ReattachWatcher&&) = delete;
  ~ReattachWatcher();  // as our death: the watcher re-attaches

  // The driver is attached again, or the device is gone: nothing is left to do.
  void dismiss() noexcept;

 private:
  ReattachWatcher(int link, pid_t process) : link_(link), process_(process) {}
  int link_ = -1;  // its closing is what the watcher waits for
  pid_t process_ = -1;
};

}  // namespace gaitpad
